"""From a pixel to a direction and back, on spheres and on the map of the whole sphere."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import random_directions

from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles
from shviewer.viewer.camera import world_from_view
from shviewer.viewer.composing.panes import Box, Pane, Sphere, WholeSphere, whole_sphere_in

SEEN_FROM = world_from_view(25.0, -40.0)
SPHERE = Sphere(120.3, 90.8, 80.0, Box(0, 0, 240, 180))
MAP = whole_sphere_in(Box(24, 46, 628, 348))
ZOOMED = whole_sphere_in(Box(24, 46, 628, 348), 3.0, (170.0, 40.0))


@pytest.mark.parametrize("pane", [SPHERE, MAP, ZOOMED], ids=["sphere", "map", "zoomed map"])
def test_the_place_of_the_direction_of_a_pixel_is_the_pixel(pane: Pane) -> None:
    for x, y in np.random.default_rng(0).uniform((25, 47), (238, 179), (200, 2)):
        direction = pane.direction(x, y, SEEN_FROM)
        if direction is not None:
            assert np.linalg.norm(direction) == pytest.approx(1, abs=1e-12)
            assert pane.place(direction, SEEN_FROM) == pytest.approx((x, y, False), abs=1e-7)


@pytest.mark.parametrize("pane", [MAP, ZOOMED], ids=["map", "zoomed map"])
def test_the_direction_of_the_place_of_a_direction_is_the_direction(pane: WholeSphere) -> None:
    seen = 0
    for direction in random_directions(300):
        x, y, behind = pane.place(direction, SEEN_FROM)
        assert not behind
        found = pane.direction(x, y, SEEN_FROM)
        assert (found is not None) == pane.clip.contains(x, y)
        if found is not None:
            seen += 1
            np.testing.assert_allclose(found, direction, rtol=0, atol=1e-12)
    assert seen > 20


def test_a_map_without_zoom_has_the_directions_of_a_lat_long_image() -> None:
    """Directions of columns and rows at texel centres, as the lights' reader counts them."""
    pane = whole_sphere_in(Box(0, 0, 16, 8))
    wanted = directions_from_angles(row_angles(8)[:, None], column_azimuths(16))
    found = [[pane.direction(x + 0.5, y + 0.5, SEEN_FROM) for x in range(16)] for y in range(8)]
    np.testing.assert_allclose(np.array(found), wanted, rtol=0, atol=1e-14)


@pytest.mark.parametrize("zoom", [0.25, 1.0, 1.7, 16.0])
@pytest.mark.parametrize("centre", [(0.0, 0.0), (179.0, 89.0), (-300.0, -90.0)])
def test_all_of_a_maps_box_has_a_direction(zoom: float, centre: tuple[float, float]) -> None:
    box = Box(10, 20, 210, 120)
    pane = whole_sphere_in(box, zoom, centre)
    corners = [(x, y) for x in (10, 209.999) for y in (20, 119.999)]
    assert all(pane.direction(x, y, SEEN_FROM) is not None for x, y in corners)
    assert pane.outline == pytest.approx(box)
    assert pane.direction(5, 50, SEEN_FROM) is None


def test_the_middle_of_a_zoomed_map_is_where_it_is_asked_to_be() -> None:
    direction = ZOOMED.direction(326, 197, SEEN_FROM)
    azimuth, elevation = np.radians([170.0, 40.0])
    wanted = [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)]
    np.testing.assert_allclose(direction, wanted, atol=1e-12)


def test_a_place_behind_the_sphere_is_the_one_seen_through_it() -> None:
    front = SPHERE.direction(150.0, 60.0, SEEN_FROM)
    assert front is not None
    through = front - 2 * (front @ SEEN_FROM[:, 2]) * SEEN_FROM[:, 2]
    assert SPHERE.place(through, SEEN_FROM) == pytest.approx((150.0, 60.0, True))
