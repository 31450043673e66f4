"""The shared camera and the light's rotation. The only module that imports pyrr.

pyrr turns some matrices the wrong way round; only its quaternion functions are used, in float64, and
tests/viewer/test_camera.py holds them to independent formulas. A quaternion is (x, y, z, w); rotations are v_out = M v_in.
"""

from __future__ import annotations

import warnings
from functools import lru_cache
from typing import cast

import numpy as np

with warnings.catch_warnings():  # its docstrings have escapes that Python warns of when it compiles them
    warnings.simplefilter("ignore")
    from pyrr import quaternion

from shviewer.harmonics.basis import Array

Quaternion = tuple[float, float, float, float]

IDENTITY: Quaternion = (0.0, 0.0, 0.0, 1.0)
VIEW_AXES: Quaternion = (0.5, 0.5, 0.5, 0.5)
"""The rotation from the view's x (right), y (up), z (to the viewer) to the world's y, z, x: a camera on +x with +z up."""


def about_axis(axis: tuple[float, float, float], degrees: float) -> Quaternion:
    """The rotation by `degrees`, counterclockwise seen from the tip of `axis`."""
    turned = quaternion.create_from_axis_rotation(
        np.array(axis, dtype=np.float64), np.radians(degrees), dtype=np.float64
    )
    return _normalised(turned)


def compose(second: Quaternion, first: Quaternion) -> Quaternion:
    """The rotation by `first` and then by `second`."""
    return _normalised(quaternion.cross(np.array(second), np.array(first)))


def matrix(rotation: Quaternion) -> Array:
    """The 3 x 3 matrix M of a rotation, v_out = M v_in."""
    columns = [quaternion.apply_to_vector(np.array(rotation), unit) for unit in np.eye(3)]
    return np.asarray(np.stack(columns, axis=1), dtype=np.float64)


def towards(azimuth_degrees: float, elevation_degrees: float) -> Quaternion:
    """The rotation that takes +x to an azimuth (from +x towards +y) and an elevation above the x-y plane."""
    return compose(about_axis((0, 0, 1), azimuth_degrees), about_axis((0, 1, 0), -elevation_degrees))


def rolled_towards(azimuth_degrees: float, elevation_degrees: float, roll_degrees: float) -> Quaternion:
    """`towards`, after a turn by `roll_degrees` about +x: every rotation is one of these."""
    return compose(towards(azimuth_degrees, elevation_degrees), about_axis((1, 0, 0), roll_degrees))


def azimuth_elevation_roll(rotation: Quaternion) -> tuple[float, float, float]:
    """The angles, degrees, from which `rolled_towards` makes a rotation."""
    azimuth, elevation = facing(matrix(rotation)[:, 0])
    x, y, z, w = towards(azimuth, elevation)
    roll = compose((-x, -y, -z, w), rotation)
    return azimuth, elevation, float(np.degrees(2 * np.arctan2(roll[0], roll[3])))


def facing(direction: Array) -> tuple[float, float]:
    """Azimuth in [0, 360) and elevation, in degrees, of the camera that has the world direction (3,) in front."""
    x, y, z = (float(part) for part in direction)
    return float(np.degrees(np.arctan2(y, x))) % 360, float(np.degrees(np.arctan2(z, np.hypot(x, y))))


@lru_cache(maxsize=64)
def world_from_view(azimuth_degrees: float, elevation_degrees: float) -> Array:
    """The 3 x 3 matrix of a camera that stands in that direction and looks at the centre: columns right, up, to the viewer."""
    axes = matrix(compose(towards(azimuth_degrees, elevation_degrees), VIEW_AXES))
    axes.flags.writeable = False
    return axes


@lru_cache(maxsize=64)
def light_from_world(light_rotation: Quaternion) -> Array:
    """The 3 x 3 matrix from world directions to the frame in which the light was defined: its rotation inverted."""
    turn = matrix(light_rotation).T
    turn.flags.writeable = False
    return turn


def turn_of(light_rotation: Quaternion) -> tuple[float, ...]:
    """The same, row by row: `Recipe.turn`."""
    return tuple(light_from_world(light_rotation).ravel().tolist())


def turned_by_drag(rotation: Quaternion, camera: tuple[float, float], right: float, up: float) -> Quaternion:
    """`rotation` followed by the turn that moves the front of a sphere `right` and `up`, in radii of the sphere."""
    azimuth, elevation = camera
    axes = world_from_view(azimuth, elevation)
    turn = compose(
        about_axis(_triple(axes[:, 1]), float(np.degrees(right))),
        about_axis(_triple(axes[:, 0]), -float(np.degrees(up))),
    )
    return compose(turn, rotation)


def _normalised(value: Array) -> Quaternion:
    return cast(Quaternion, tuple(float(part) for part in quaternion.normalize(value)))


def _triple(vector: Array) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])
