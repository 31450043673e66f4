"""More bands of cells than their roots hold: their points are spread onto a regular grid, whose waves are Fourier transforms.

A point is spread over WIDTH steps of the grid along theta and along phi, with the bump exp(b (sqrt(1 - x^2) - 1)), |x| < 1
[Barnett]; each wave of the grid over that of the bump is the wave of the points, to 1e-7 of all their magnitudes. There are
twice as many steps as the shortest wave needs. Theta goes on beyond the poles, where cosines and sines go on as well.

[Barnett] A. Barnett, J. Magland, L. af Klinteberg, "A Parallel Nonuniform Fast Fourier Transform Library Based on an
          'Exponential of Semicircle' Kernel", SIAM J. Sci. Comput. 41 (2019): b = 2.3 WIDTH at twice the steps.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.projection.row_transform import by_parity
from shviewer.harmonics.quadrature import gauss_unit
from shviewer.harmonics.sampling.cells import POINTS, Cells, sectors, shares
from shviewer.harmonics.sampling.look import N_STRIPS
from shviewer.harmonics.theta_series import from_waves

WIDTH = 8
SHARPNESS = 2.3 * WIDTH

ROOT_POINTS = 16
"""Points along a side of a root, which has up to four waves of 512 bands: its polynomial is read there."""

BLOCK_VALUES = 2**21
"""Values on the grid that are made at a time."""


def project_points(layers: Iterable[tuple[Cells, Array]], n_bands: int) -> Array:
    """Coefficients (n_bands**2, 3) from weighted values (n, POINTS, POINTS, 3) at the Gauss points of cells."""
    steps = 4 * n_bands
    edge = WIDTH + 1  # rows beyond each pole
    rows = steps // 2 + 2 * edge
    grid = np.zeros((3, rows * steps))
    for cells, weighted in layers:
        for count in np.unique(sectors()[cells.strip]):
            here = sectors()[cells.strip] == count
            _add(cells[here], weighted[here], steps, edge, grid)
    wave = _bump_wave(n_bands, steps)
    order = by_parity(n_bands)
    along = 2 * np.pi / steps * (np.arange(rows) - edge) * order[:, None]
    theta = [np.ascontiguousarray(function(along) / wave[order, None]) for function in (np.cos, np.sin)]
    sign = (-1.0) ** np.arange(n_bands) / wave  # the first column is phi = pi
    sums = np.empty((n_bands, 2, 3, n_bands))
    for channel, values in enumerate(grid.reshape(3, rows, steps)):
        azimuth = np.fft.rfft(values, axis=1)[:, :n_bands] * sign
        for odd, functions in enumerate(theta):
            for part, parts in enumerate((azimuth.real, azimuth.imag)):
                sums[odd::2, part, channel] = (functions @ parts[:, odd::2]).T
    return from_waves(sums)


def _add(cells: Cells, weighted: Array, steps: int, edge: int, grid: Array) -> None:
    """Spread cells whose roots are equally wide onto the grid (3, rows of `steps`), `edge` rows of it before theta = 0."""
    count = POINTS if cells.depth else ROOT_POINTS
    at, share = gauss_unit(count)
    before = gauss_unit(POINTS)[1]
    finer = shares(at, POINTS) * share[:, None] / before
    a_turn = steps / (2 * np.pi)
    reach = [int(a_turn * side) + WIDTH + 2 for side in (np.pi / (N_STRIPS * 2.0**cells.depth), cells.width[0])]
    block = max(1, BLOCK_VALUES // (reach[0] * reach[1] * 3))
    for start in range(0, len(cells), block):
        some, values = cells[start : start + block], weighted[start : start + block]
        if cells.depth == 0:
            values = np.einsum("ip,npqc,jq->nijc", finer, values, finer, optimize=True)
        rows, row_bumps = _bumps(some.theta(at) * a_turn + edge, reach[0])
        columns, column_bumps = _bumps((np.pi - some.phi(at)) * a_turn, reach[1])
        down = row_bumps @ values.reshape(len(some), count, -1)
        spread = column_bumps[:, None] @ down.reshape(len(some), reach[0], count, 3)
        place = (rows[:, :, None] * steps + columns[:, None, :] % steps).ravel()
        for channel in range(3):
            np.add.at(grid[channel], place, spread[..., channel].ravel())


def _bumps(places: Array, reach: int) -> tuple[Indices, Array]:
    """The `reach` steps about places (n, k) that lie close together: (n, reach), and the bumps of each there, (n, reach, k)."""
    first = np.ceil(places[:, :1] - WIDTH / 2).astype(np.int64)
    steps = first + np.arange(reach)
    x = (steps[:, :, None] - places[:, None]) * (2 / WIDTH)
    inside = np.maximum(1 - x * x, 0.0)
    return steps, np.where(inside > 0, np.exp(SHARPNESS * (np.sqrt(inside) - 1)), 0.0)


def _bump_wave(n_bands: int, steps: int) -> Array:
    """The integral of the bump times cos(k x), x in radians of which there are `steps` to a turn, per step: (n_bands,)."""
    at, share = gauss_unit(64)
    x = 2 * at - 1
    bump = np.exp(SHARPNESS * (np.sqrt(1 - x * x) - 1))
    return np.asarray(WIDTH * np.cos(np.arange(n_bands)[:, None] * (np.pi * WIDTH / steps) * x) @ (share * bump))
