"""The numbers under the mouse are those of the light and of the figures."""

from __future__ import annotations

import numpy as np
import pytest
from helpers import frame_of, picture_of

from shviewer.viewer.composing.composition import compose
from shviewer.viewer.overlay.directions.marks import place_marks
from shviewer.viewer.overlay.directions.probe import _number, probe, probe_layers


def test_at_the_marks_the_probe_reads_the_figures() -> None:
    composition = compose(1280, 640, n_spheres=3)
    extremes = picture_of().figures.extremes
    for name, direction in (("minimum", extremes.minimum_direction), ("largest", extremes.max_error_direction)):
        x, y, z = direction
        camera = float(np.degrees(np.arctan2(y, x))) % 360 + 5, float(np.degrees(np.arcsin(z))) * 0.9
        shown = picture_of(error="signed", camera=camera)
        mark = place_marks(shown, composition)[name]
        assert not mark.behind
        found = probe(shown, composition, mark.x, mark.y)
        assert found is not None
        if name == "minimum":
            assert found.reconstruction.min() == pytest.approx(extremes.minimum, abs=1e-9)
            np.testing.assert_allclose(found.direction, extremes.minimum_direction, atol=1e-6)
        else:
            assert np.abs(found.error).max() == pytest.approx(extremes.max_error, rel=1e-6)


def test_every_sphere_reads_the_same_in_the_same_place() -> None:
    shown = picture_of("venice_sunset", n_bands=9, error="absolute")
    composition = compose(1280, 640, n_spheres=3)
    readings = [
        probe(shown, composition, sphere.x + 0.3 * sphere.radius, sphere.y - 0.4 * sphere.radius)
        for sphere in composition.spheres
    ]
    for reading in readings[1:]:
        assert reading is not None
        assert readings[0] is not None
        np.testing.assert_allclose(reading.direction, readings[0].direction, atol=1e-12)
        np.testing.assert_allclose(reading.original, readings[0].original, rtol=1e-9)


def test_the_middle_of_a_sphere_is_the_direction_of_the_camera_in_the_frame_of_the_light() -> None:
    shown = picture_of(camera=(30.0, 40.0))
    composition = compose(1280, 640)
    sphere = composition.spheres[0]
    found = probe(shown, composition, sphere.x, sphere.y)
    assert found is not None
    assert found.theta_phi_degrees == pytest.approx((50.0, 30.0), abs=1e-9)
    turned = picture_of(
        camera=(30.0, 40.0), light_rotation=(0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))
    )  # by 90 degrees about z
    found = probe(turned, composition, sphere.x, sphere.y)
    assert found is not None
    assert found.theta_phi_degrees == pytest.approx((50.0, -60.0), abs=1e-9)


def test_error_is_reconstruction_minus_original_and_the_suns_are_in_both() -> None:
    composition = compose(1280, 640)
    sphere = composition.spheres[1]
    whole = probe(picture_of(n_bands=4), composition, sphere.x + 20, sphere.y - 30)
    assert whole is not None
    np.testing.assert_allclose(whole.error, whole.reconstruction - whole.original, atol=1e-15)
    split = picture_of("sun-sky", split_sun=True, n_bands=4)
    (sun,) = split.suns
    at_sun = split.rest_at(sun.axis[None])[0] + sun.radiance
    np.testing.assert_allclose(split.rest_at(sun.axis[None]) + split.suns_at(sun.axis[None]), at_sun[None])


def test_beside_the_spheres_and_over_surfaces_there_is_nothing_to_read() -> None:
    composition = compose(1280, 640)
    sphere = composition.spheres[0]
    assert probe(picture_of(), composition, 5.0, 5.0) is None
    assert probe(picture_of(), composition, sphere.x + 1.01 * sphere.radius, sphere.y) is None
    assert probe(picture_of(lobe_view=True), composition, sphere.x, sphere.y) is None


@pytest.mark.parametrize("size", [(640, 320), (1280, 640), (900, 1200)])
@pytest.mark.parametrize("light", ["green", "venice_sunset"])
def test_the_numbers_stay_in_the_frame_and_off_the_pixel_they_are_of(size: tuple[int, int], light: str) -> None:
    shown = picture_of(light, error="signed")
    composition = compose(*size, n_spheres=3)
    for sphere in composition.spheres:
        for across in (-0.9, 0.0, 0.9):
            for down in (-0.3, 0.3):
                x, y = sphere.x + across * sphere.radius, sphere.y + down * sphere.radius
                found = probe(shown, composition, x, y)
                assert found is not None
                *dots, table = probe_layers(found, shown, composition, x, y)
                height, width = table.image.shape[:2]
                assert table.left >= 0
                assert table.left + width <= size[0]
                assert table.top >= 0
                assert table.top + height <= size[1]
                assert not (table.left <= x < table.left + width and table.top <= y < table.top + height)
                assert len(dots) == 2


def test_the_values_of_a_second_reconstruction_stand_below() -> None:
    """They are those of the picture without the window."""
    picture, plain = picture_of(window="hann", beside="no-window"), picture_of(error="signed")
    frame = frame_of(picture)
    pane = frame.spheres[2]
    found, other = (probe(one, frame, pane.x + 20.5, pane.y - 10.5) for one in (picture, plain))
    assert found is not None
    assert other is not None
    assert other.beside is None
    np.testing.assert_allclose(found.beside, other.reconstruction, rtol=0, atol=1e-15)
    assert not np.allclose(found.beside, found.reconstruction)
    taller, smaller = (probe_layers(one, picture, frame, pane.x, pane.y)[-1].image for one in (found, other))
    assert taller.shape[0] > smaller.shape[0]


@pytest.mark.parametrize(
    ("value", "text"), [(0.0, "0"), (-0.0763, "−0.07630"), (1000.0, "1000"), (12345.6, "12346"), (1.6e9, "1.600 × 10⁹")]
)
def test_a_value_has_four_digits_whatever_its_size(value: float, text: str) -> None:
    assert _number(value) == text
