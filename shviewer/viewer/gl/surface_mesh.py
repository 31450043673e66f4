"""The surface of radius |f(u)| in every direction u as triangles, few where it is flat and many where it bends.

The values of f lie on a lat-long grid of 2^k + 1 rows from pole to pole and 2^(k+1) columns: two squares side by side, which
are halved along their diagonals again and again into right triangles. Every point of the grid but the corners is the middle
of the long side of the two triangles that it halves, and it is used only if the surface is farther from that side than a
tolerance. A point counts as at least as far as all the points that could not be used without it. So no triangle gets a
corner in the middle of a neighbour's side, and there are no cracks.

Source
    [EKT] W. Evans, D. Kirkpatrick, G. Townsend, "Right-triangulated irregular networks", Algorithmica 30, 264 (2001).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles

Floats = NDArray[np.float32]
Points = NDArray[np.float32]
"""Vectors or directions; the first axis holds x, y, z."""

Part = tuple[slice, slice]
"""Rows and columns of a grid."""

BLOCK_VALUES = 2**14
"""Points of the grid that are measured at a time, so that they stay in the cache."""

JUMP = 1 / 16
"""A second difference beyond this is a jump and no curvature: with 16 bands it is 1/100 on 513 rows."""

TINY = np.float32(1e-30)

MAX_TRIANGLES = 2**20
"""The most triangles of a surface, even if its tolerance needs more, as that of a photograph does."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """vertices (k, 7): the signed value f, the direction u, and the normal f u - grad f, to be negated where f < 0.

    The vertex is at |f| u. triangles (t, 3): counterclockwise seen from outside.
    """

    vertices: Floats
    triangles: NDArray[np.uint32]


def surface_mesh(values: Floats, tolerance: float, most: int = MAX_TRIANGLES) -> Mesh:
    """Make the mesh. values: (2^k + 1, 2^(k+1)); tolerance: a length in their units. ValueError for another shape."""
    rows, columns = values.shape
    size = rows - 1
    if size < 2 or size & (size - 1) or columns != 2 * size:
        raise ValueError(f"a grid of {rows} x {columns}: it must be 2^k + 1 rows and 2^(k+1) columns")
    directions = grid_directions(rows)
    normals = values * directions - gradient(values)
    error = _saturate(_deviations(values, directions, normals))
    fewest = error.size - (most - 4) // 2
    if fewest > 0:
        tolerance = max(tolerance, float(np.partition(error, fewest, axis=None)[fewest]))
    corners = _triangles(error > tolerance)
    used = np.zeros(values.size, dtype=bool)
    used[corners] = True
    number = np.cumsum(used, dtype=np.uint32) - np.uint32(1)
    parts = values, *directions, *normals
    vertices = np.stack([part.ravel()[used] for part in parts], axis=1)
    return _pinched(vertices, number[corners])


@lru_cache(maxsize=2)
def grid_directions(rows: int) -> Points:
    """Directions of a lat-long grid with rows on the poles and twice as many columns as intervals: (3, rows, 2 (rows - 1))."""
    theta = np.linspace(0, np.pi, rows)[:, None]
    last = directions_from_angles(theta, column_azimuths(2 * (rows - 1)))
    directions = np.ascontiguousarray(np.moveaxis(last, -1, 0), dtype=np.float32)
    directions.flags.writeable = False
    return directions


def gradient(values: Floats) -> Points:
    """The gradient of a function on the unit sphere, tangential, (3, rows, columns); values: on a grid with rows on the poles.

    Central differences, but at a jump only towards the larger radius: the rim of a wall is shaded as the ground above it,
    and its foot as the wall. At a pole, the first harmonic of the row beside it.
    """
    rows, columns = values.shape
    step = np.pi / (rows - 1)
    theta, phi = np.linspace(0, np.pi, rows)[1:-1, None], column_azimuths(columns)
    southward = _difference(values[:-2], values[1:-1], values[2:]) / np.float32(step)
    turned = (np.roll(values[1:-1], way, axis=1) for way in (-1, 1))  # columns run against phi
    eastward = _difference(next(turned), values[1:-1], next(turned))
    eastward *= (columns / (2 * np.pi) / np.sin(theta)).astype(np.float32)
    sine, cosine, along, across = (f(angle).astype(np.float32) for angle in (theta, phi) for f in (np.sin, np.cos))
    slope = np.zeros((3, rows, columns), dtype=np.float32)
    slope[0, 1:-1] = southward * cosine * across - eastward * along
    slope[1, 1:-1] = southward * cosine * along + eastward * across
    slope[2, 1:-1] = -southward * sine
    for pole, beside in ((0, 1), (-1, -2)):
        towards = np.stack([across, along]) @ values[beside] * (2 / columns / np.sin(step))
        slope[:2, pole] = towards[:, None]
    return slope


def _difference(before: Floats, here: Floats, after: Floats) -> Floats:
    """The derivative per step of the grid."""
    behind, ahead = here - before, after - here
    sign = np.sign(here)
    onward = np.where(sign == 0, np.abs(after) > np.abs(before), sign * after > sign * before)
    jump = np.abs(ahead - behind) > JUMP
    return np.where(jump, np.where(onward, ahead, behind), (behind + ahead) / 2)


def _deviations(values: Floats, directions: Points, normals: Points) -> Floats:
    """The distance of the surface, at each point of the grid, from the middle of the side that the point would halve.

    If it is more, half of that side times the error of the normal there: a crease must not be shaded across a side.
    """
    size, columns = len(values) - 1, values.shape[1]
    error = np.zeros_like(values)
    points, facing = (
        np.concatenate([part, part[..., :1]], axis=-1) for part in (np.abs(values) * directions, normals)
    )  # once round, to the first column again
    step = 1
    while 2 * step <= size:
        for at, start, end in _halvings(size, columns, step):
            of_points = [grid[..., at[0], at[1]] for grid in (error, values, directions, normals)]
            of_ends = [grid[:, rows, across] for grid in (points, facing) for rows, across in (start, end)]
            height = max(1, BLOCK_VALUES // max(1, of_points[0].shape[1]))
            for first in range(0, len(of_points[0]), height):
                _measure(*(grid[..., first : first + height, :] for grid in (*of_points, *of_ends)))
        step *= 2
    return error


def _halvings(size: int, columns: int, step: int) -> Iterator[tuple[Part, Part, Part]]:
    """Points `step` from the ends of the sides that they halve, and those ends, which may lie in column `columns`."""
    side = 2 * step

    def every(stride: int, first: int, stop: int) -> tuple[slice, slice]:
        """Every `stride`-th point from `first` to `stop`, and the same one side further."""
        return slice(first, stop, stride), slice(first + side, stop + side, stride)

    (north, south), (west, east) = every(side, 0, size), every(side, 0, columns)
    rows, between = slice(0, size + 1, side), slice(step, None, side)
    yield (between, slice(0, columns, side)), (north, west), (south, west)
    yield (rows, between), (rows, west), (rows, east)
    for down, right in ((0, 0), (0, 1), (1, 0), (1, 1)):  # one square's diagonal falls, its neighbour's rises
        top, left = side * down, side * right
        (north, south), (west, east) = every(2 * side, top, size), every(2 * side, left, columns)
        if down != right:
            west, east = east, west
        yield (slice(top + step, None, 2 * side), slice(left + step, None, 2 * side)), (north, west), (south, east)


def _measure(
    error: Floats,
    value: Floats,
    direction: Points,
    normal: Points,
    start: Points,
    end: Points,
    start_normal: Points,
    end_normal: Points,
) -> None:
    """Write into `error` the distance from the middle of a side to the surface, to first order; in a pinch, to its walls."""
    middle, side, facing = (start + end) / 2, start - end, start_normal + end_normal
    turned = 1 - _dot(normal, facing) / np.maximum(np.sqrt(_dot(normal, normal) * _dot(facing, facing)), TINY)
    radius = np.abs(value)
    outward = np.maximum(np.sqrt(_dot(middle, middle)) - radius, 0)
    wall = normal + np.copysign(outward, value) * direction
    distance = np.abs(_dot(middle - radius * direction, wall)) / np.maximum(np.sqrt(_dot(wall, wall)), TINY)
    np.maximum(distance, np.sqrt(_dot(side, side) * np.maximum(turned, 0) / 2), out=error)


def _dot(a: NDArray[np.floating], b: NDArray[np.floating]) -> Floats:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], dtype=np.float32)


def _saturate(error: Floats) -> Floats:
    """Raise each point to the largest error among those that are only reached through it; in place."""
    size, step = len(error) - 1, 1
    while 2 * step <= size:
        even, odd = slice(0, None, 2 * step), slice(step, None, 2 * step)
        above, left, centre = error[even, odd], error[odd, even], error[odd, odd]
        for sides in (above[:-1], above[1:], left, np.roll(left, -1, axis=1)):
            np.maximum(centre, sides, out=centre)
        if (
            4 * step <= size
        ):  # a centre needs the two corners of its square that are middles of the next larger one's sides
            corner, middle = slice(0, None, 4 * step), slice(2 * step, None, 4 * step)
            around = np.maximum(centre, np.roll(centre, 1, axis=1))[:, 0::2]
            below = np.maximum(centre[:, 0::2], centre[:, 1::2])
            for sides, part in ((around[0::2], error[middle, corner]), (around[1::2], error[middle, corner])):
                np.maximum(part, sides, out=part)
            on_rows = error[corner, middle]
            np.maximum(on_rows[:-1], below[0::2], out=on_rows[:-1])
            np.maximum(on_rows[1:], below[1::2], out=on_rows[1:])
        step *= 2
    return error


def _triangles(split: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Triangles as indices into the flat grid, (t, 3), the long side's ends first. split: the points where one is halved."""
    rows, columns = split.shape
    size = rows - 1
    north, south = (0, size)
    triangles = np.array(
        [
            [(north, 0), (south, size), (south, 0)],
            [(south, size), (north, 0), (north, size)],
            [(north, columns), (south, size), (north, size)],
            [(south, size), (north, columns), (south, columns)],
        ]
    )
    done = []
    for _ in range(2 * (size.bit_length() - 1)):
        first, second, apex = triangles.transpose(1, 0, 2)
        middle = (first + second) // 2
        halved = split[middle[:, 0], middle[:, 1] % columns]
        done.append(triangles[~halved])
        first, second, apex, middle = (point[halved] for point in (first, second, apex, middle))
        halves = [np.stack(half, axis=1) for half in ((apex, first, middle), (second, apex, middle))]
        triangles = np.concatenate(halves)
    found = np.concatenate([*done, triangles])
    return np.asarray(found[..., 0] * columns + found[..., 1] % columns)


def _pinched(vertices: Floats, triangles: NDArray[np.uint32]) -> Mesh:
    """The mesh without triangles of both signs. There the surface goes through the origin, and so does the lone corner."""
    negative = vertices[triangles, 0] < 0
    mixed = (negative.any(axis=1) & (vertices[triangles, 0] > 0).any(axis=1)).nonzero()[0]
    few = negative[mixed].sum(axis=1) == 1
    lone = np.where(few[:, None], negative[mixed], ~negative[mixed]).argmax(axis=1)
    first, second, third = (vertices[triangles[mixed, (lone + i) % 3]] for i in range(3))
    across = (second + third) / 2
    at_zero = first + (across - first) * (first[:, :1] / (first[:, :1] - across[:, :1]))
    at_zero[:, 0] = 0
    triangles = triangles.copy()
    triangles[mixed, lone] = len(vertices) + np.arange(len(mixed), dtype=np.uint32)
    return Mesh(np.concatenate([vertices, at_zero]), triangles)
