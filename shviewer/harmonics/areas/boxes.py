"""Sums over points anywhere on the sphere against all of many bands, through few moments.

On a box of angles, small against the shortest wave, every cos(k theta) and cos(m phi) is a polynomial of low degree to
rounding. So a point gives its box only the moments of low degree, a cost that does not depend on the number of bands; the
moments meet the waves once for each box. The Chebyshev series of a wave e^(i k t) over an interval of half-width a ends like
the Bessel functions J(j)(k a), which is where DEGREES comes from (Rivlin, "Chebyshev Polynomials", 2nd ed., chapter 3).

All points are reflected into the octant where x, y and z are not negative, as the waves are even or odd in each coordinate.
Along an axis with mirrored points the values are folded into their sum and difference first; along one without, the moments of
its two sides are.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.chebyshev import chebyshev_points, chebyshev_values, points_from_series
from shviewer.harmonics.basis import Array, normalise
from shviewer.harmonics.quadrature import angles_from_directions

PHASE = 4.6
"""The phase, in radians, of the shortest wave from the middle of a box to its edge."""

DEGREES = 24
"""Moments along each side of a box: twice J(24)(4.6) and what follows it is 2e-15; a multiple of 8 multiplies faster."""

BOX_POINTS = 256
"""The most points in one product, whose factors stay in the cache."""

STRIP_POINTS = 2**16
"""The most points whose polynomials are held at a time."""


def folded(values: Array) -> Array:
    """The values and those at mirrored points, along an axis of 2, as their sum and difference: (x, y, z, ...) each."""
    for axis in range(3):
        if values.shape[axis] == 2:
            first, second = np.take(values, 0, axis), np.take(values, 1, axis)
            values = np.stack([first + second, first - second], axis)
    return values


def wave_sums(directions: Array, values: Array, n_bands: int) -> Array:
    """Sums of value times {cos, sin}(m phi) times cos(k theta), for odd m sin(k theta): as `from_waves` takes them.

    In place of sin(0 theta) stands theta - pi, of which boundary.py makes use.

    directions: (k, 3), any length. values: (x, y, z, k, channels) with 1 or 2 along each of the first three axes; index 1 is
    the value in the direction whose coordinate of that name is negated. Returns (m, {cos, sin}, channel, k by parity).
    """
    channels, mirrors = values.shape[-1], np.array(values.shape[:3])
    units = normalise(directions)
    theta, phi = angles_from_directions(np.abs(units))
    boxes = max(1, ceil((n_bands - 1) * pi / (4 * PHASE)))
    width = pi / 2 / boxes
    strip, box = (np.minimum((angle / width).astype(np.int64), boxes - 1) for angle in (theta, phi))
    negative = (units < 0).T
    sides = np.zeros_like(box)
    columns = np.ascontiguousarray(folded(values).swapaxes(3, 4))
    for axis in range(3):
        if mirrors[axis] == 1:
            sides = 2 * sides + negative[axis]
        elif negative[axis].any():
            np.negative(
                columns, out=columns, where=np.indices(columns.shape[:3])[axis][..., None, None] * negative[axis] > 0
            )
    n_sides = int(np.prod(3 - mirrors))
    place = (strip * boxes + box) * n_sides + sides
    order = np.argsort(place, kind="stable")
    place, columns = place[order], columns.reshape(-1, len(units))
    edges = np.searchsorted(place, np.arange(boxes + 1) * (boxes * n_sides))
    result = np.zeros((n_bands, 2, channels, n_bands))
    memory = np.empty((n_sides, boxes, DEGREES, len(columns), DEGREES)) if len(units) else np.empty(0)
    for row in np.flatnonzero(np.diff(edges)).tolist():
        first, last = (int(place[i]) // n_sides - row * boxes for i in (edges[row], edges[row + 1] - 1))
        used = slice(first, last + 1)
        moments = memory[:, used]
        moments[:] = 0
        for start in range(edges[row], edges[row + 1], STRIP_POINTS):
            stop = min(start + STRIP_POINTS, edges[row + 1])
            here = order[start:stop]
            north = chebyshev_values(2 * (theta[here] / width - row) - 1, DEGREES)
            around = chebyshev_values(2 * (phi[here] / width - box[here]) - 1, DEGREES)
            where = place[start:stop] - (row * boxes + first) * n_sides
            _add_moments(moments, where, north, around, columns[:, here])
        _add_waves(result, moments, mirrors, row, used, boxes)
    return result


def _add_moments(moments: Array, where: NDArray[np.int64], north: Array, around: Array, columns: Array) -> None:
    """Add points of one strip, sorted by `where`: the box along phi times the number of sides, and the side."""
    starts = np.concatenate([[0], np.flatnonzero(np.diff(where)) + 1, [len(where)]])
    memory = np.empty(DEGREES * len(columns) * min(BOX_POINTS, len(where)))
    product = np.empty((DEGREES * len(columns), DEGREES))
    for first, last in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True):
        box, side = divmod(int(where[first]), len(moments))
        for start in range(first, last, BOX_POINTS):
            points = slice(start, min(start + BOX_POINTS, last))
            count = points.stop - start
            weighted = memory[: len(product) * count].reshape(DEGREES, -1, count)
            np.multiply(around[:, None, points], columns[:, points], out=weighted)
            np.matmul(weighted.reshape(-1, count), north[:, points].T, out=product)
            moments[side, box] += product.reshape(moments.shape[2:])


def _add_waves(result: Array, moments: Array, mirrors: NDArray[np.int64], row: int, used: slice, boxes: int) -> None:
    """Turn the moments of a strip's boxes into sums with waves, and add them to the result of `wave_sums`."""
    n_bands, channels = len(result), result.shape[2]
    n_even = (n_bands + 1) // 2
    by_side = moments.reshape(*(3 - mirrors), *moments.shape[1:])
    for axis in np.flatnonzero(mirrors == 1):
        first, second = np.moveaxis(by_side, axis, 0)
        difference = first - second
        first += second
        second[:] = difference
    series = _wave_series(n_bands, boxes)
    for parity, sine, odd_k in np.ndindex(2, 2, 2):
        if max(parity, odd_k) >= n_bands:
            continue
        odd = np.array([(parity + sine) % 2, sine, (parity + odd_k) % 2])
        table = by_side[tuple(odd * (2 - mirrors))]
        table = table.reshape(len(table) * DEGREES, -1, channels * DEGREES)
        table = table[:, np.ravel_multi_index(tuple(odd * (mirrors - 1)), tuple(mirrors))]
        around = series[sine, parity::2, used].reshape(-1, len(table)) @ table
        product = around.reshape(-1, DEGREES) @ series[parity, odd_k::2, row].T
        kept = slice(n_even, None) if odd_k else slice(0, n_even)
        result[parity::2, sine, :, kept] += product.reshape(-1, channels, product.shape[-1])
        if parity and odd_k:  # theta - pi is theta - pi/2, odd about the equator, and a constant, which is even
            result[1::2, sine, :, 0] -= pi / 2 * around.reshape(-1, channels, DEGREES) @ series[0, 0, row]


@lru_cache(maxsize=8)
def _wave_series(n_bands: int, boxes: int) -> Array:
    """The Chebyshev series of cos(k t) and sin(k t) in each box of a quarter turn: ({cos, sin}, k, box, degree).

    In place of sin(0 t) that of t - pi/2.
    """
    nodes = (np.arange(boxes)[:, None] + (1 + chebyshev_points(DEGREES)) / 2) * (pi / 2 / boxes)
    phase = np.arange(n_bands)[:, None, None] * nodes
    series = np.stack([np.cos(phase), np.sin(phase)])
    series[1, 0] = nodes - pi / 2
    series = series @ points_from_series(DEGREES)
    series.flags.writeable = False
    return series
