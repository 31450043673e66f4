"""Marks stand where the values are."""

from __future__ import annotations

import numpy as np
import pytest
from helpers import frame_of, picture_of
from viewer.overlay.collisions import faults

from shviewer.harmonics.basis import Array
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Sphere
from shviewer.viewer.overlay.directions.marks import mark_layers, marks_of, place_marks
from shviewer.viewer.overlay.directions.probe import probe
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import Picture


def facing(direction: Array) -> tuple[float, float]:
    """A camera that looks straight at a direction of an unrotated light."""
    x, y, z = direction
    return float(np.degrees(np.arctan2(y, x))) % 360, float(np.degrees(np.arcsin(z)))


def test_a_mark_that_is_looked_at_stands_in_the_middle_of_its_sphere() -> None:
    found = picture_of(error="signed")
    for name, place in (
        ("minimum", found.figures.extremes.minimum_direction),
        ("largest", found.figures.extremes.max_error_direction),
    ):
        shown = picture_of(error="signed", camera=facing(np.array(place)))
        composition = frame_of(shown)
        mark = place_marks(shown, composition)[name]
        sphere = composition.spheres[1 if name == "minimum" else 2]
        assert (mark.x, mark.y) == pytest.approx((sphere.x, sphere.y), abs=1e-6)
        assert not mark.behind


def test_the_value_at_the_pixel_of_the_mark_is_the_figure() -> None:
    """By the frame's own arithmetic, through camera and light rotation."""
    for light_rotation in ((0.0, 0.0, 0.0, 1.0), (0.5, 0.1, 0.3, np.sqrt(0.65))):
        shown = picture_of("studio", n_bands=6, error="absolute", light_rotation=light_rotation)
        composition = frame_of(shown)
        placed = place_marks(shown, composition)
        for name in ("minimum", "largest"):
            mark = placed[name]
            sphere = composition.spheres[1 if name == "minimum" else 2]
            right, up = (mark.x - sphere.x) / sphere.radius, (sphere.y - mark.y) / sphere.radius
            towards = np.sqrt(max(0.0, 1 - right**2 - up**2)) * (-1 if mark.behind else 1)
            direction = (shown.light_from_world @ shown.world_from_view @ [right, up, towards])[None]
            reconstruction = shown.rest_at(direction)
            if name == "minimum":
                assert reconstruction.min() == pytest.approx(shown.figures.extremes.minimum, abs=1e-9)
            else:
                error = np.abs(reconstruction - shown.light.radiance(direction)).max()
                assert error == pytest.approx(shown.figures.extremes.max_error, rel=1e-6)


def circle(shown: Picture, composition: Composition, name: str) -> Sphere:
    return composition.spheres[{"peak": 0, "minimum": 1, "largest": 2}[name]]


@pytest.mark.parametrize("turn", range(0, 360, 40))
@pytest.mark.parametrize("size", [(1280, 720), (1280, 640), (640, 320), (500, 1000)])
def test_what_is_behind_is_told_outside_the_limb_in_its_direction(size: tuple[int, int], turn: int) -> None:
    """A triangle there, nothing on any sphere, and the words clear of spheres, of other text and of the frame's edge."""
    shown = picture_of("studio", n_bands=6, error="signed", camera=(float(turn), -20.0))
    composition = frame_of(shown, *size)
    obstacles = draw_overlay(shown, composition).boxes.values()
    placed = place_marks(shown, composition, obstacles)
    for name, mark in placed.items():
        sphere = circle(shown, composition, name)
        if not mark.behind:
            continue
        for layer in mark.layers:
            rows, columns = np.nonzero(layer.image[..., 3] > 100)
            x, y = columns + layer.left + 0.5, rows + layer.top + 0.5
            for other in composition.spheres:
                assert np.hypot(x - other.x, y - other.y).min() > other.radius
            assert min(x.min(), y.min()) > 0
            assert x.max() < size[0]
            assert y.max() < size[1]
        triangle = mark.layers[-2] if mark.label else mark.layers[-1]
        height, width = triangle.image.shape[:2]
        right, down = triangle.left + width / 2 - sphere.x, triangle.top + height / 2 - sphere.y
        towards = np.array([mark.x - sphere.x, mark.y - sphere.y])
        assert np.array([right, down]) @ towards / np.hypot(right, down) / np.linalg.norm(towards) > np.cos(0.08)
        assert np.hypot(right, down) < sphere.radius + 12 * composition.scale
        if mark.label:
            assert not any(mark.label.overlaps(other) for other in obstacles)
            assert not any(other.touches(mark.label) for other in composition.spheres)


def test_words_of_a_mark_behind_have_room_whichever_way_the_spheres_are_turned() -> None:
    """They go along the limb, with a line from the triangle, to where there is room."""
    labels = 0
    for turn in range(0, 360, 15):
        shown = picture_of(error="signed", camera=(float(turn), -10.0))
        placed = place_marks(
            shown, frame_of(shown, 1280, 720), draw_overlay(shown, frame_of(shown, 1280, 720)).boxes.values()
        )
        assert set(placed) == {"minimum", "largest"}
        assert all(mark.label for mark in placed.values())
        labels += sum(mark.behind for mark in placed.values())
    assert labels > 12


def test_nothing_of_a_whole_sphere_is_behind() -> None:
    for centre in ((0.0, 0.0), (170.0, 0.0)):
        shown = picture_of("venice_sunset", n_bands=9, error="signed", whole_sphere=True, map_centre=centre)
        composition = frame_of(shown)
        placed = place_marks(shown, composition)
        assert set(placed) == {"peak", "minimum", "largest"}
        assert not any(mark.behind for mark in placed.values())
        found = probe(shown, composition, placed["minimum"].x, placed["minimum"].y)
        assert found is not None
        assert found.reconstruction.min() == pytest.approx(shown.figures.extremes.minimum, abs=1e-9)


def test_a_peak_is_marked_where_it_is_over_twenty_times_the_mean() -> None:
    peaks = {
        light: next((mark for mark in marks_of(picture_of(light)) if mark.name == "peak"), None)
        for light in ("venice_sunset", "green", "constant", "mud_road_puresky", "sun-sky")
    }
    assert [light for light, mark in peaks.items() if mark] == ["venice_sunset", "sun-sky"]
    venice, mark = find_light("venice_sunset"), peaks["venice_sunset"]
    assert mark is not None
    assert mark.text == "peak 776"
    assert venice.radiance(mark.direction[None]).max() == pytest.approx(venice.map.texels.max(), rel=1e-6)
    mean = venice.coefficients(1).mean() / np.sqrt(4 * np.pi)
    for level, marked in ((19.0, False), (21.0, True)):
        pixels = np.ones((32, 64, 3), np.float32)
        pixels[12, 20, 1] = level * (1 + 3e-3)
        names = {mark.name for mark in marks_of(picture_of(EnvironmentLight(pixels, name=f"level {level}")))}
        assert ("peak" in names) == marked
    assert venice.map.texels.max() > 20 * mean


def test_marks_name_their_values_with_a_sign() -> None:
    texts = {mark.name: mark.text for mark in marks_of(picture_of(error="signed"))}
    assert texts == {"minimum": "minimum −0.137", "largest": "largest +0.266"}


@pytest.mark.parametrize(
    "changes",
    [{"marks": False}, {"lobe_view": True}, {"help_visible": True}, {"light": "constant"}],
    ids=["X", "surfaces", "help", "nothing negative"],
)
def test_there_are_no_marks_where_none_are_wanted(changes: dict[str, object]) -> None:
    shown = picture_of(**changes)
    assert mark_layers(shown, frame_of(shown)) == ()


@pytest.mark.parametrize("size", [(640, 320), (1280, 640), (2560, 1440), (900, 1200)])
@pytest.mark.parametrize("camera", [(0.0, 0.0), (120.0, 45.0), (300.0, 80.0)])
@pytest.mark.parametrize("whole_sphere", [False, True])
def test_the_words_of_a_mark_in_front_stand_beside_its_ring_in_its_pane(
    size: tuple[int, int], camera: tuple[float, float], whole_sphere: bool
) -> None:
    shown = picture_of(error="signed", camera=camera, whole_sphere=whole_sphere, map_centre=camera)
    composition = frame_of(shown, *size)
    obstacles = draw_overlay(shown, composition).boxes.values()
    placed = place_marks(shown, composition, obstacles)
    for name, mark in placed.items():
        if mark.behind or mark.label is None:
            continue
        assert not any(mark.label.overlaps(other) for other in obstacles)
        clip = composition.panes[1 if name == "minimum" else 2].clip
        assert clip.left <= mark.label.left
        assert mark.label.right <= clip.right
        assert not whole_sphere or (clip.top <= mark.label.top and mark.label.bottom <= clip.bottom)
        assert mark.label.right < mark.x - 3 or mark.x + 3 < mark.label.left  # beside the ring
        (layer,) = mark.layers
        height, width = layer.image.shape[:2]
        assert layer.left <= mark.x <= layer.left + width
        assert layer.top <= mark.y <= layer.top + height


def test_no_ring_is_drawn_on_words() -> None:
    """A low frame whose enlarged spheres reach under their captions: the camera brings the minimum under each of them."""
    met = 0
    for azimuth in range(0, 360, 3):
        shown = picture_of(n_bands=6, zoom=1.5, camera=(float(azimuth), -40.0))
        at = frame_of(shown, 1016, 264)
        drawn = draw_overlay(shown, at)
        assert faults(shown, at, drawn) == [], azimuth
        met += "minimum" not in place_marks(shown, at, drawn.boxes.values())
    assert met > 0


def test_turning_draws_no_mark_anew() -> None:
    images = set()
    for azimuth in (70.0, 75.0, 80.0):
        shown = picture_of(camera=(azimuth, 20.0))
        images |= {id(layer.image) for layer in mark_layers(shown, frame_of(shown))}
    assert len(images) == 1
