"""Marks stand where the values are."""

from __future__ import annotations

import numpy as np
import pytest
from helpers import frame_of, picture_of

from shviewer.harmonics.basis import Array
from shviewer.viewer.overlay.marks import mark_layers, marks_of, place_marks
from shviewer.viewer.overlay.overlay import draw_overlay

TOWARDS_MINIMUM = (230.0, -30.0)


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
        assert set(placed) == {"minimum", "largest"}
        for name, mark in placed.items():
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


def test_a_mark_on_the_far_side_is_broken_and_says_so() -> None:
    azimuth, elevation = facing(np.array(picture_of().figures.extremes.minimum_direction))
    behind = picture_of(camera=((azimuth + 150) % 360, -elevation))
    mark = place_marks(behind, frame_of(behind))["minimum"]
    assert mark.behind
    front = picture_of(camera=(azimuth, elevation))
    wide, narrow = mark.layer.image.shape[1], place_marks(front, frame_of(front))["minimum"].layer.image.shape[1]
    assert wide > narrow  # it says ", behind"


def test_marks_name_their_values_with_a_sign() -> None:
    texts = {mark.name: mark.text for mark in marks_of(picture_of(error="signed"))}
    assert texts == {"minimum": "minimum -0.137", "largest": "largest +0.266"}


@pytest.mark.parametrize(
    "changes",
    [{"marks": False}, {"lobe_view": True}, {"help_visible": True}, {"light": "constant"}],
    ids=["X", "surfaces", "help", "nothing negative"],
)
def test_there_are_no_marks_where_none_are_wanted(changes: dict[str, object]) -> None:
    shown = picture_of(**changes)
    assert mark_layers(shown, frame_of(shown)) == ()


@pytest.mark.parametrize("size", [(640, 320), (1280, 640), (2560, 1440), (900, 1200)])
@pytest.mark.parametrize("camera", [(0.0, 0.0), (120.0, 45.0), (240.0, -45.0), (300.0, 80.0)])
def test_the_words_of_a_mark_stay_in_the_cell_of_its_sphere(size: tuple[int, int], camera: tuple[float, float]) -> None:
    shown = picture_of(error="signed", camera=camera)
    composition = frame_of(shown, *size)
    obstacles = draw_overlay(shown, composition).obstacles
    placed = place_marks(shown, composition, obstacles)
    assert set(placed) == {"minimum", "largest"}
    for name, mark in placed.items():
        if mark.label.right - mark.label.left < 3:
            continue  # no room for words, and none written
        assert not any(mark.label.overlaps(other) for other in obstacles)
        cell = composition.spheres[1 if name == "minimum" else 2].clip
        assert cell.left <= mark.label.left
        assert mark.label.right <= cell.right
        assert mark.label.right < mark.x - 3 or mark.x + 3 < mark.label.left  # beside the ring
        height, width = mark.layer.image.shape[:2]
        assert mark.layer.left <= mark.x <= mark.layer.left + width
        assert mark.layer.top <= mark.y <= mark.layer.top + height


def test_turning_draws_no_mark_anew() -> None:
    images = set()
    for azimuth in (70.0, 75.0, 80.0):
        shown = picture_of(camera=(azimuth, 20.0))
        images |= {id(layer.image) for layer in mark_layers(shown, frame_of(shown))}
    assert len(images) == 1
