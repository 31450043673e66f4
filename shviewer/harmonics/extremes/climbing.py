"""The search for an extreme in ever smaller patches of a function: what it finds is a value that the function takes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, row_angles
from shviewer.harmonics.synthesis import Synthesis

PATCH = np.stack(np.meshgrid(np.arange(-2.0, 3.0), np.arange(-2.0, 3.0), indexing="ij"), axis=-1).reshape(-1, 2)
PARABOLOID = np.linalg.pinv(
    np.stack([np.ones(25), *PATCH.T, PATCH[:, 0] ** 2 / 2, PATCH[:, 0] * PATCH[:, 1], PATCH[:, 1] ** 2 / 2], axis=1)
)
"""The matrix (6, 25) from values on a patch to value, slopes and curvatures of the paraboloid of least squares."""

ON_RIM = np.append(np.abs(PATCH).max(axis=1) == 2, True)
"""Whether the next patch is as wide if this point is the best, (26,): points of the patch, and last the vertex."""

DISPLAY_ROUNDS = 3
"""The number of patches for a figure on display: down to an eighth of a grid cell, and to vertices of paraboloids."""

SEARCH_ROUNDS = 22

Objective = Callable[[Array], Array]
"""A function to maximise: unit directions (k, 3) -> (k,)."""


def valleys(
    coefficients: Array, rounds: int = SEARCH_ROUNDS, most: int | None = None
) -> tuple[Array, Array, NDArray[np.int64]]:
    """The lowest local minima of each channel of a reconstruction (n**2, 3): values (k,), directions (k, 3), channels (k,).

    Valleys are no narrower than about pi/n, and the grid has 6 rows in each. All of them, or at most `most` a channel,
    are followed down; after SEARCH_ROUNDS most patches are 1e-4 of a cell wide and the values are good to about 1e-9 of the
    peak. A channel that equals an earlier one is left out.
    """
    synthesis = Synthesis(coefficients)
    n_rows = max(32, 6 * count_bands(coefficients))
    theta, phi = row_angles(n_rows), column_azimuths(2 * n_rows)
    grid = synthesis.on_rows(theta, len(phi))

    def negated(directions: Array, channel: int) -> Array:
        return -synthesis.in_directions(directions)[:, channel]

    found: list[tuple[Array, Array, NDArray[np.int64]]] = []
    for channel in range(3):
        if any(np.array_equal(coefficients[:, channel], coefficients[:, earlier]) for earlier in range(channel)):
            continue
        rows, columns, depth = _grid_valleys(grid[:, channel])
        candidates = directions_from_angles(theta[rows], phi[columns])
        starts = candidates[_spread_out(candidates, depth, np.pi / synthesis.n_bands, most)]
        heights, places = climb(partial(negated, channel=channel), starts, float(np.pi / n_rows), rounds)
        found.append((-heights, places, np.full(len(places), channel)))
    values, places, channels = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return values, places, channels


def _grid_valleys(values: Array) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Rows, columns and estimated depth of the local minima of a lat-long grid (rows, columns).

    The estimate is the vertex of the paraboloid through the neighbours: on the grid itself a narrow deep valley may look
    shallower than a wide one.
    """
    tall = np.pad(values, ((1, 1), (0, 0)), mode="edge")
    wide = np.pad(tall, ((0, 0), (1, 1)), mode="wrap")
    up, down, left, right = wide[:-2, 1:-1], wide[2:, 1:-1], wide[1:-1, :-2], wide[1:-1, 2:]
    rows, columns = np.nonzero((values <= up) & (values <= down) & (values <= left) & (values <= right))
    here, up, down, left, right = (part[rows, columns] for part in (values, up, down, left, right))
    across = (wide[2:, 2:] - wide[2:, :-2] - wide[:-2, 2:] + wide[:-2, :-2])[rows, columns] / 4
    slope_r, slope_c = (down - up) / 2, (right - left) / 2
    bend_r, bend_c = down - 2 * here + up, right - 2 * here + left
    determinant = bend_r * bend_c - across**2
    with np.errstate(divide="ignore", invalid="ignore"):
        both = (slope_r**2 * bend_c - 2 * slope_r * slope_c * across + slope_c**2 * bend_r) / (2 * determinant)
        along = slope_r**2 / (2 * bend_r)
    fall = np.where(determinant > 1e-12 * bend_r**2, both, np.where(bend_r > 0, along, 0))
    return rows, columns, here - np.clip(np.nan_to_num(fall), 0, None)


def _spread_out(candidates: Array, depth: Array, apart: float, most: int | None) -> NDArray[np.int64]:
    """Indices of the candidates (k, 3) to follow: the lowest first, but no two within `apart` radians or of equal depth.

    Equal depths are copies by symmetry, such as all points of a ring about z; a ring about another axis keeps many points.
    """
    order = np.argsort(depth, kind="stable")
    chosen: list[int] = []
    open_ = np.ones(len(order), dtype=bool)
    same = 1e-12 * float(np.ptp(depth)) if len(depth) else 0.0
    for at in order:
        if open_[at]:
            chosen.append(int(at))
            if len(chosen) == most:
                break
            open_ &= (candidates @ candidates[at] < np.cos(apart)) & (np.abs(depth - depth[at]) > same)
    return np.array(chosen)


def climb(objective: Objective, starts: Array, step: float, rounds: int) -> tuple[Array, Array]:
    """Climb from each of the unit vectors `starts`, (k, 3), in 5 x 5 patches that reach `step` at first.

    The next patch is half as wide unless the best point is on the rim. It also contains the vertex of the paraboloid fitted to
    the patch before, which follows narrow slanted ridges where the best of a few points would crawl. Returns the values (k,)
    and directions (k, 3) reached.
    """
    everyone = np.arange(len(starts))
    places = vertices = starts
    reach = np.full((len(starts), 1), step / 2)
    for _ in range(rounds):
        right, up = _tangents(places)
        right, up = reach * right, reach * up
        patches = places[:, None] + PATCH[:, :1] * right[:, None] + PATCH[:, 1:] * up[:, None]
        patches = np.concatenate([patches, vertices[:, None]], axis=1)
        patches /= np.linalg.norm(patches, axis=2, keepdims=True)
        values = objective(patches.reshape(-1, 3)).reshape(patches.shape[:2])
        a, b = _vertex(values[:, :-1])
        vertices = places + a[:, None] * right + b[:, None] * up
        best = values.argmax(axis=1)
        places = patches[everyone, best]
        reach[~ON_RIM[best]] /= 2
    return values[everyone, best], places


def _vertex(values: Array) -> tuple[Array, Array]:
    """Places in the patch (units of PATCH) where paraboloids fitted to values (k, 25) are highest; 0, 0 for no maximum."""
    _, slope_a, slope_b, bend_a, across, bend_b = PARABOLOID @ values.T
    determinant = bend_a * bend_b - across**2
    peaked = (bend_a < 0) & (determinant > 0)
    determinant = np.where(peaked, determinant, 1.0)
    a = np.where(peaked, (across * slope_b - bend_b * slope_a) / determinant, 0.0)
    b = np.where(peaked, (across * slope_a - bend_a * slope_b) / determinant, 0.0)
    return np.clip(a, -4, 4), np.clip(b, -4, 4)


def _tangents(places: Array) -> tuple[Array, Array]:
    """Two unit vectors (k, 3) at right angles to each of the unit vectors (k, 3) and to each other.

    [T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017]: no pole, no square root.
    """
    x, y, z = places.T
    sign = np.where(z < 0, -1.0, 1.0)
    a = -1 / (sign + z)
    b = x * y * a
    right = np.stack([1 + sign * x * x * a, sign * b, -sign * x], axis=-1)
    return right, np.stack([b, sign + y * y * a, -y], axis=-1)
