"""Where the camera stands before anybody moves it: so that what matters is seen."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import sphere_rule
from helpers import picture_of

from shviewer.lights.function import FunctionLight
from shviewer.viewer.camera import light_from_world, towards
from shviewer.viewer.control.placing import rotate_light
from shviewer.viewer.derived import camera_of
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import changed
from shviewer.viewer.view import View

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize(
    ("light", "azimuth", "elevation"),
    [
        ("venice_sunset", -27.2, 12.0),
        ("st_fagans_interior", 54.7, 12.0),
        ("green", 98.2, 22.0),
        ("constant", 0.0, 22.0),
        ("hemisphere", 0.0, 22.0),
    ],
)
def test_a_camera_faces_the_bright_side_of_a_map_and_sees_the_sides_of_lobes(
    light: str, azimuth: float, elevation: float
) -> None:
    assert camera_of(View(), picture_of(light).light) == pytest.approx((azimuth % 360, elevation), abs=0.05)


def test_the_side_is_that_of_the_mean_luminance_by_quadrature() -> None:
    """A light of three colours that look apart; in front is where the mean of its directions points."""

    def radiance(directions: np.ndarray) -> np.ndarray:
        x, y, z = directions.T
        return np.stack([1 + x, 1 + 0.8 * y, 1.1 - x - 0.1 * y * z], axis=1) ** 2

    directions, weights = sphere_rule(64)
    mean = (weights * (radiance(directions) @ LUMINANCE)) @ directions
    azimuth, _ = camera_of(View(), FunctionLight(radiance, "three"))
    assert azimuth == pytest.approx(np.degrees(np.arctan2(mean[1], mean[0])) % 360, abs=1e-3)


@pytest.mark.parametrize(("share", "azimuth"), [(0.021, 90.0), (0.019, 0.0), (0.0, 0.0)])
def test_light_from_no_side_is_seen_from_the_middle_of_its_map(share: float, azimuth: float) -> None:
    """share: of band 1 in band 0. The mean direction is that times the square root of a third, which y has."""
    light = FunctionLight(
        lambda directions: np.repeat(1 + np.sqrt(3) * share * directions[:, 1:2], 3, axis=1), f"side {share}"
    )
    assert camera_of(View(), light) == pytest.approx((azimuth, 12.0), abs=1e-6)


def test_irradiance_is_seen_from_where_its_light_is() -> None:
    for light in ("green", "venice_sunset"):
        radiance, irradiance = (picture_of(light, quantity=quantity) for quantity in ("radiance", "irradiance"))
        np.testing.assert_array_equal(radiance.world_from_view, irradiance.world_from_view)


def test_a_turned_light_is_faced_where_it_is_and_turning_it_moves_no_camera() -> None:
    turned = picture_of("venice_sunset", light_rotation=towards(50.0, 0.0))
    start = turned.placed(turned.state)
    assert start.view.camera == pytest.approx((22.775, 12.0), abs=0.01)
    more = prepare(rotate_light(start, 0.4, 0.1))
    np.testing.assert_array_equal(more.world_from_view, turned.world_from_view)
    assert not np.allclose(more.light_from_world, light_from_world(turned.state.view.light_rotation))


def test_a_camera_that_is_given_stays_whatever_the_light() -> None:
    given = picture_of("venice_sunset", camera=(1.0, 2.0))
    assert given.placed(given.state) == given.state
    other = picture_of("green", camera=(1.0, 2.0))
    np.testing.assert_array_equal(given.world_from_view, other.world_from_view)
    assert given.seen(changed(given.state, camera=None)).placed(given.state).view.camera == (1.0, 2.0)


def test_black_light_is_seen_from_the_middle() -> None:
    black = FunctionLight(lambda directions: np.zeros((len(directions), 3)), "black")
    assert camera_of(View(), black) == (0.0, 12.0)
