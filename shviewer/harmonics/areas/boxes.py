"""Sums over points anywhere on the sphere against all of many bands, through few moments.

On a box of angles, small against the shortest wave, every cos(k theta) and cos(m phi) is a polynomial of low degree to
rounding. So a point gives its box only the moments of low degree, a cost that does not depend on the number of bands; the
moments meet the waves once for each box. The Chebyshev series of a wave e^(i k t) over an interval of half-width a ends like
the Bessel functions J(j)(k a), which is where DEGREES comes from (Rivlin, "Chebyshev Polynomials", 2nd ed., chapter 3).

Mirrored points share everything but their values, so all points are reflected into the octant where x, y and z are not
negative, and the octants' moments are added up by parity, as the waves are even or odd in each coordinate.
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.chebyshev import chebyshev_points, chebyshev_values, points_from_series
from shviewer.harmonics.basis import Array, normalise

PHASE = 5.0
"""The phase, in radians, of the shortest wave from the middle of a box to its edge."""

DEGREES = 25
"""Moments along each side of a box: twice J(25)(5) and what follows it is 1e-15."""

BOX_POINTS = 256
"""The most points in one product, whose factors stay in the cache."""

STRIP_POINTS = 2**16
"""The most points whose polynomials are held at a time."""


def wave_sums(directions: Array, values: Array, n_bands: int) -> Array:
    """Sums of value times {cos, sin}(m phi) times cos(k theta), for odd m sin(k theta): as `from_waves` takes them.

    directions: (k, 3), any length. values: (x, y, z, k, channels) with 1 or 2 along each of the first three axes; index 1 is
    the value in the direction whose coordinate of that name is negated. Returns (m, {cos, sin}, channel, k by parity).
    """
    channels = values.shape[-1]
    x, y, z = normalise(directions).T
    octant = (x < 0) * 4 + (y < 0) * 2 + (z < 0)
    theta, phi = np.arctan2(np.hypot(x, y), np.abs(z)), np.arctan2(np.abs(y), np.abs(x))
    boxes = max(1, ceil((n_bands - 1) * pi / (4 * PHASE)))
    width = pi / 2 / boxes
    strip, box = (np.minimum((angle / width).astype(np.int64), boxes - 1) for angle in (theta, phi))
    order = np.argsort((strip * boxes + box) * 8 + octant, kind="stable")
    place = ((strip * boxes + box) * 8 + octant)[order]
    columns = np.ascontiguousarray(values.reshape(-1, len(x), channels).transpose(0, 2, 1)).reshape(-1, len(x))
    mirrors = [4 * i + 2 * j + k for i, j, k in np.ndindex(values.shape[:3])]
    edges = np.searchsorted(place, np.arange(boxes + 1) * (boxes * 8))
    result = np.zeros((n_bands, 2, channels, n_bands))
    memory = np.empty((8, boxes, DEGREES, channels, DEGREES)) if len(x) else np.empty(0)
    for row in range(boxes):
        if edges[row] == edges[row + 1]:
            continue
        used = np.unique(place[edges[row] : edges[row + 1]] // 8) - row * boxes
        moments = memory.reshape(-1)[: memory.size // boxes * len(used)].reshape(8, len(used), *memory.shape[2:])
        moments[:] = 0
        for start in range(edges[row], edges[row + 1], STRIP_POINTS):
            stop = min(start + STRIP_POINTS, edges[row + 1])
            here = order[start:stop]
            north = chebyshev_values(2 * (theta[here] / width - row) - 1, DEGREES)
            around = chebyshev_values(2 * (phi[here] / width - box[here]) - 1, DEGREES)
            where = np.searchsorted(used, box[here]) * 8 + octant[here]
            _add_moments(moments, where, north, around, columns[:, here], mirrors)
        _add_waves(result, moments, row, used, boxes)
    return result


def _add_moments(
    moments: Array, where: NDArray[np.int64], north: Array, around: Array, columns: Array, mirrors: list[int]
) -> None:
    """Add points of one strip, sorted by `where`: the box along phi times 8, and the octant."""
    starts = np.concatenate([[0], np.flatnonzero(np.diff(where)) + 1, [len(where)]])
    memory = np.empty(DEGREES * len(columns) * min(BOX_POINTS, len(where)))
    product = np.empty((DEGREES * len(columns), DEGREES))
    by_mirror = product.reshape(DEGREES, len(mirrors), -1, DEGREES)
    for first, last in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True):
        box, octant = divmod(int(where[first]), 8)
        for start in range(first, last, BOX_POINTS):
            points = slice(start, min(start + BOX_POINTS, last))
            count = points.stop - start
            weighted = memory[: len(product) * count].reshape(DEGREES, -1, count)
            np.multiply(around[:, None, points], columns[:, points], out=weighted)
            np.matmul(weighted.reshape(-1, count), north[:, points].T, out=product)
            for i, mirror in enumerate(mirrors):
                moments[octant ^ mirror, box] += by_mirror[:, i]


def _add_waves(result: Array, moments: Array, row: int, used: NDArray[np.int64], boxes: int) -> None:
    """Turn the moments of a strip's boxes into sums with waves, and add them to the result of `wave_sums`."""
    n_bands, values = len(result), len(used) * DEGREES
    n_even = (n_bands + 1) // 2
    octants = moments.reshape(2, 2, 2, values, -1)
    for axis in range(3):
        first, second = np.moveaxis(octants, axis, 0)
        difference = first - second
        first += second
        second[:] = difference
    series = _wave_series(n_bands, boxes)
    for parity, sine, odd_k in np.ndindex(2, 2, 2):
        if max(parity, odd_k) >= n_bands:
            continue
        folded = octants[(parity + sine) % 2, sine, (parity + odd_k) % 2]
        around = series[sine, parity::2, used].swapaxes(0, 1).reshape(-1, values) @ folded
        product = around.reshape(-1, DEGREES) @ series[parity, odd_k::2, row].T
        kept = slice(n_even, None) if odd_k else slice(0, n_even)
        result[parity::2, sine, :, kept] += product.reshape(-1, result.shape[2], product.shape[-1])


@lru_cache(maxsize=8)
def _wave_series(n_bands: int, boxes: int) -> Array:
    """The Chebyshev series of cos(k t) and sin(k t) in each box of a quarter turn: ({cos, sin}, k, box, degree)."""
    nodes = (np.arange(boxes)[:, None] + (1 + chebyshev_points(DEGREES)) / 2) * (pi / 2 / boxes)
    phase = np.arange(n_bands)[:, None, None] * nodes
    series = np.stack([np.cos(phase), np.sin(phase)]) @ points_from_series(DEGREES)
    series.flags.writeable = False
    return series
