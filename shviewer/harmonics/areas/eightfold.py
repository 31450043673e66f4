"""Sums over points and their images under the eight symmetries of a square about the polar axis, against many bands.

The images of a point have its theta, and but for signs their azimuths are phi or pi/2 - phi, where
    cos(m (pi/2 - phi)) = q cos(m phi),   sin(m (pi/2 - phi)) = -q sin(m phi),   q = (-1)^(m/2),       for even m,
                        = q sin(m phi),                       =  q cos(m phi),   q = (-1)^((m-1)/2),   for odd m.
So eight points need the waves in phi of one. Those in theta are not needed at all: on a strip of angles, small against the
shortest wave, every cos(k theta) is a polynomial of low degree to rounding, and a strip is summed with so few of them. The
Chebyshev series of a wave e^(i k t) over an interval of half-width a ends like the Bessel functions J(j)(k a), which is where
DEGREES comes from (Rivlin, "Chebyshev Polynomials", 2nd ed., chapter 3).
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil, pi

import numpy as np

from shviewer.harmonics.areas.chebyshev import chebyshev_points, chebyshev_values, point_count, points_from_series
from shviewer.harmonics.basis import Array
from shviewer.harmonics.projection.row_transform import by_parity
from shviewer.harmonics.quadrature import angles_from_directions

PHASE = 4.6
"""The phase, in radians, of the shortest wave from the middle of a strip to its edge."""

DEGREES = 24
"""Polynomials on a strip: twice J(24)(4.6) and what follows it is 2e-15; a multiple of 8 multiplies faster."""

MOST_POINTS = 1024
"""The most points that are summed at a time, so that their waves stay in the cache."""


def eightfold_waves(directions: Array, own: Array, exchanged: Array, n_bands: int) -> Array:
    """Sums of value times {cos, sin}(m phi) times cos(k theta), for odd m sin(k theta): as `from_waves` takes them.

    directions: (j, 3), any length. own: (2, 2, channels, j), what counts for functions that are even or odd in x, and in y: the
    sum or the difference of the values at x and -x, and so for y. exchanged: the same at the points with x and y exchanged, for
    the first of the channels. Returns (m, {cos, sin}, channel, k by parity).
    """
    theta, phi = angles_from_directions(directions)
    strips = max(1, ceil((n_bands - 1) * pi / (2 * PHASE)))
    strip = np.minimum((theta * (strips / pi)).astype(np.int64), strips - 1)
    order = np.argsort(strip, kind="stable")
    edges = np.searchsorted(strip[order], np.arange(strips + 1))
    own, exchanged = own[..., order], exchanged[..., order]
    channels, some = own.shape[2], slice(exchanged.shape[2])
    q = 1 - np.arange(n_bands)[:, None, None] % 4 // 2 * 2
    moments = np.zeros((n_bands, 2, channels, strips, DEGREES))
    for row in range(strips):
        for start in range(edges[row], edges[row + 1], MOST_POINTS):
            points = slice(start, min(start + MOST_POINTS, edges[row + 1]))
            here = order[points]
            north = chebyshev_values(2 * (theta[here] * (strips / pi) - row) - 1, DEGREES)
            most = min(n_bands, point_count(n_bands * float(np.sin(theta[here]).max())))  # more are 0 so near a pole
            functions = waves(np.cos(phi[here]), np.sin(phi[here]), most)
            at = moments[:most, ..., row, :]
            for part, half in np.ndindex(2, 2):
                columns = own[part, part, :, points].copy()
                columns[some] += (1 - 2 * (part ^ half)) * exchanged[part, part, :, points]
                at[2 * half :: 4, part] += _products(functions[part][2 * half :: 4], columns, north)
            for part in (0, 1):
                columns = np.concatenate([own[1 - part, part, :, points], exchanged[part, 1 - part, :, points]])
                found = _products(functions[part][1::2], columns, north)
                at[1::2, part] += found[:, :channels]
                at[1::2, 1 - part, some] += q[1:most:2] * found[:, channels:]
    sums = np.empty((n_bands, 2, channels, n_bands))
    for parity, series in enumerate(_wave_series(n_bands, strips)):
        part_sums = moments[parity::2]
        sums[parity::2] = (part_sums.reshape(-1, len(series)) @ series).reshape(*part_sums.shape[:3], n_bands)
    return sums


def _products(functions: Array, columns: Array, north: Array) -> Array:
    """Sums over points of a function (m, points), a column (any, points) and a polynomial: (m, any, DEGREES)."""
    weighted = (columns[:, None] * north).reshape(-1, north.shape[1])
    return np.asarray((functions @ weighted.T).reshape(len(functions), len(columns), DEGREES))


def waves(cosine: Array, sine: Array, n: int) -> tuple[Array, Array]:
    """cos(j t) and sin(j t) for j < n at angles given by their cosine and sine (points,), (n, points) each.

    By the powers of e^it, whose error grows like j roundings.
    """
    cosines, sines = np.empty((2, n, len(cosine)))
    cosines[0], sines[0] = 1.0, 0.0
    cosines[1:2], sines[1:2] = cosine, sine
    last = 1
    while last + 1 < n:  # those of 1 to `last` times that of `last`
        some, more = slice(1, min(last, n - 1 - last) + 1), slice(last + 1, 2 * last + 1)
        cosines[more] = cosines[some] * cosines[last] - sines[some] * sines[last]
        sines[more] = sines[some] * cosines[last] + cosines[some] * sines[last]
        last *= 2
    return cosines, sines


@lru_cache(maxsize=8)
def _wave_series(n_bands: int, strips: int) -> tuple[Array, Array]:
    """The Chebyshev series of cos(k t) and of sin(k t) in each strip of half a turn: (strips * DEGREES, k by parity) each."""
    nodes = (np.arange(strips)[:, None] + (1 + chebyshev_points(DEGREES)) / 2) * (pi / strips)
    phase = by_parity(n_bands)[:, None, None] * nodes
    cosines, sines = (
        np.ascontiguousarray((function(phase) @ points_from_series(DEGREES)).reshape(n_bands, -1).T)
        for function in (np.cos, np.sin)
    )
    return cosines, sines
