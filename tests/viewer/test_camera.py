"""The camera against formulas that share nothing with pyrr."""

from __future__ import annotations

import numpy as np
import pytest

from shviewer.harmonics.basis import Array
from shviewer.viewer import camera


def rodrigues(axis: Array, degrees: float) -> Array:
    """v cos + (k x v) sin + k (k . v)(1 - cos), as a matrix."""
    k = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    angle = np.radians(degrees)
    return np.cos(angle) * np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * np.outer(k, k)


def direction(azimuth: float, elevation: float) -> Array:
    a, e = np.radians([azimuth, elevation])
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])


def random_rotations(count: int) -> list[tuple[tuple[float, float, float], float]]:
    rng = np.random.default_rng(0)
    return [(tuple(rng.normal(size=3)), float(rng.uniform(-360, 360))) for _ in range(count)]


def test_a_rotation_is_the_one_of_rodrigues() -> None:
    for axis, degrees in random_rotations(50):
        np.testing.assert_allclose(
            camera.matrix(camera.about_axis(axis, degrees)), rodrigues(axis, degrees), rtol=0, atol=1e-14
        )


def test_a_quarter_turn_about_z_takes_x_to_y() -> None:
    """With whole numbers as the axis, of which pyrr makes a quaternion of zeros unless told otherwise."""
    turned = camera.matrix(camera.about_axis((0, 0, 1), 90)) @ [1, 0, 0]
    np.testing.assert_allclose(turned, [0, 1, 0], rtol=0, atol=1e-15)


def test_composing_applies_the_second_after_the_first() -> None:
    rotations = random_rotations(40)
    for (axis, degrees), (other, angle) in zip(rotations[::2], rotations[1::2], strict=True):
        both = camera.compose(camera.about_axis(other, angle), camera.about_axis(axis, degrees))
        wanted = rodrigues(other, angle) @ rodrigues(axis, degrees)
        np.testing.assert_allclose(camera.matrix(both), wanted, rtol=0, atol=1e-14)


def test_ten_thousand_compositions_stay_a_rotation() -> None:
    rng = np.random.default_rng(0)
    total = camera.IDENTITY
    for axis, degrees in zip(rng.normal(size=(10_000, 3)), rng.uniform(-180, 180, 10_000), strict=True):
        total = camera.compose(camera.about_axis(tuple(axis), degrees), total)
    turned = camera.matrix(total)
    np.testing.assert_allclose(turned @ turned.T, np.eye(3), rtol=0, atol=1e-12)
    assert np.linalg.det(turned) == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("azimuth", [0.0, 78.0, 180.0, 271.5])
@pytest.mark.parametrize("elevation", [-90.0, -35.0, 0.0, 22.0, 90.0])
def test_the_cameras_columns_are_right_up_and_to_the_viewer(azimuth: float, elevation: float) -> None:
    columns = camera.world_from_view(azimuth, elevation)
    a = np.radians(azimuth)
    right = np.array([-np.sin(a), np.cos(a), 0])
    to_viewer = direction(azimuth, elevation)
    wanted = np.stack([right, np.cross(to_viewer, right), to_viewer], axis=1)
    np.testing.assert_allclose(columns, wanted, rtol=0, atol=1e-15)
    assert np.linalg.det(columns) == pytest.approx(1, abs=1e-14)
    assert columns[2, 1] >= -1e-15  # +z never points down


@pytest.mark.parametrize(("azimuth", "elevation"), [(0, 0), (90, 0), (30, 45), (200, -60), (0, 90)])
def test_turning_a_light_points_its_x_axis_there(azimuth: int, elevation: int) -> None:
    turned = camera.matrix(camera.towards(azimuth, elevation))
    np.testing.assert_allclose(turned @ [1, 0, 0], direction(azimuth, elevation), rtol=0, atol=1e-15)


def test_light_from_world_undoes_the_lights_rotation() -> None:
    rotation = camera.compose(camera.towards(40, 10), camera.about_axis((1, 2, 3), 77))
    product = camera.light_from_world(rotation) @ camera.matrix(rotation)
    np.testing.assert_allclose(product, np.eye(3), rtol=0, atol=1e-15)
    assert abs(camera.matrix(rotation) - np.eye(3)).max() > 0.5


@pytest.mark.parametrize(("right", "up"), [(0.01, 0.0), (0.0, 0.01), (-0.01, 0.004)])
@pytest.mark.parametrize("view", [(0.0, 0.0), (78.0, 22.0), (200.0, -70.0)])
def test_dragging_a_light_moves_its_front_with_the_mouse(right: float, up: float, view: tuple[float, float]) -> None:
    """A point at the front, one radian of turn per radius of the sphere; second order is left out (0.01 squared)."""
    before = camera.compose(camera.towards(33, 20), camera.about_axis((1, 1, 0), 50))
    after = camera.turned_by_drag(before, view, right, up)
    front = camera.light_from_world(before) @ direction(*view)  # in the frame of the light
    moved = camera.world_from_view(*view).T @ camera.matrix(after) @ front
    np.testing.assert_allclose(moved, [right, up, 1], rtol=0, atol=2e-4)


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, -1, 0), (0.3, -0.5, 0.7), (0, 0, 1), (0, 0, -1), (-1, 1e-9, 0)])
def test_a_camera_that_faces_a_direction_has_it_in_front(direction: tuple[float, float, float]) -> None:
    unit = np.array(direction) / np.linalg.norm(direction)
    azimuth, elevation = camera.facing(unit)
    assert 0 <= azimuth < 360
    assert -90 <= elevation <= 90
    np.testing.assert_allclose(camera.world_from_view(azimuth, elevation).T @ unit, [0, 0, 1], atol=1e-8)
