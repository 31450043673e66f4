"""Frames for tests: where the spheres stand, and in which direction each pixel looks, in float64 without shviewer."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands, evaluate_basis
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, Sphere, whole_sphere_in
from shviewer.viewer.drawn import DirectSum, SplineMap
from shviewer.viewer.picture import Picture

SIDE = 128
MAP_SIZE = (1025, 2048)
"""The largest map that is drawn from."""


def square_frame(side: int = SIDE) -> Composition:
    """Two spheres that fill their halves, their centres off every pixel's centre and edge."""
    left = Sphere(0.5 * side + 0.27, 0.5 * side - 0.13, 0.48 * side, Box(0, 0, side, side))
    right = Sphere(1.5 * side - 0.38, 0.5 * side + 0.31, 0.47 * side, Box(side, 0, 2 * side, side))
    return Composition(2 * side, side, 1.0, (left, right))


@dataclass(frozen=True)
class View:
    """The pixels of one sphere: their mask in the frame, and of each its direction in the light and its normal's z."""

    mask: NDArray[np.bool_]
    directions: Array
    facing: Array


def positions(composition: Composition, sphere: Sphere) -> Array:
    """Pixel centres in radii of the sphere, right and up from its centre, (height, width, 2)."""
    x = (np.arange(composition.width) + 0.5 - sphere.x) / sphere.radius
    y = (sphere.y - np.arange(composition.height) - 0.5) / sphere.radius
    return np.stack(np.meshgrid(x, y), axis=-1)


def view(composition: Composition, side: int, light_from_world: Array, world_from_view: Array) -> View:
    """Pixels whose centre is inside, by more than the rounding of float32 could turn."""
    sphere = composition.spheres[side]
    place = positions(composition, sphere)
    facing_squared = 1 - (place**2).sum(axis=-1)
    rows, columns = np.indices(facing_squared.shape) + 0.5
    mask = (facing_squared > 1e-5) & (columns > sphere.clip.left) & (columns < sphere.clip.right)
    mask &= (rows > sphere.clip.top) & (rows < sphere.clip.bottom)
    facing = np.sqrt(facing_squared[mask])
    normals = np.column_stack([place[mask], facing])
    return View(mask, normals @ (light_from_world @ world_from_view).T, facing)


def picture_view(composition: Composition, side: int, picture: Picture) -> View:
    return view(composition, side, picture.light_from_world, picture.world_from_view)


def rounding(seen: View) -> Array:
    """By how many radians float32 may turn each pixel's direction, (k,).

    The normal's third component is sqrt(1 - p.p): with p.p wrong by an eps (1.2e-7) the normal turns by eps / (2 facing),
    and the position itself, the matrix and the normalisation add about as much. Measured on llvmpipe: 1.2e-7 / facing.
    """
    return 2e-7 / seen.facing


def lobes(*parts: Lobe) -> LobeLight:
    return LobeLight(parts)


def reconstructing(picture: Picture, coefficients: Array) -> Picture:
    """The same picture with other coefficients on the right, and above 32 bands with the map that viewer/ makes of them."""
    if count_bands(coefficients) <= 32:
        return replace(picture, coefficients=coefficients, drawn=DirectSum(coefficients))
    splines = Synthesis(coefficients).spline_map(*MAP_SIZE)
    return replace(picture, coefficients=coefficients, drawn=SplineMap(splines))


def sum_of_harmonics(directions: Array, coefficients: Array) -> Array:
    """The sum of c(l, m) Y(l, m) in float64, in blocks that fit."""
    n_bands = count_bands(coefficients)
    blocks = np.array_split(directions, 1 + len(directions) * n_bands**2 // 2**25)
    return np.concatenate([evaluate_basis(block, n_bands) @ coefficients for block in blocks])


def map_frame(
    width: int = 2 * SIDE, zoom: float = 1.0, centre: tuple[float, float] = (0.0, 0.0), count: int = 2
) -> Composition:
    """Maps of the whole sphere beside each other, each `width` pixels wide."""
    boxes = (Box(number * width, 0, (number + 1) * width, width // 2) for number in range(count))
    maps = tuple(whole_sphere_in(box, zoom, centre) for box in boxes)
    return Composition(count * width, width // 2, 1.0, maps)


def map_directions(composition: Composition, side: int) -> tuple[slice, Array]:
    """The columns of a map in the frame, and the world direction of each of its pixels (height, width, 3)."""
    pane = composition.maps[side]
    columns = slice(round(pane.clip.left), round(pane.clip.right))
    azimuth = (pane.x - np.arange(columns.start, columns.stop) - 0.5) * 2 * np.pi / pane.width
    elevation = ((pane.y - np.arange(composition.height) - 0.5) * 2 * np.pi / pane.width)[:, None]
    flat = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth)
    return columns, np.stack([*flat, np.broadcast_to(np.sin(elevation), flat[0].shape)], axis=-1)
