"""Exact integrals of images of constant texels against the basis, on curved patches of the sphere.

A patch is a square on which direction and density (steradians per unit area) are analytic functions of the two image
coordinates. There the kernel K = density * Y is a polynomial of moderate degree up to rounding, so it is known from its values
at a few points, and the weight of the image at each of them is a closed form:
    integral of I K = sum over i, j of K(x_i, y_j) W_ij,      W = R I C^T,
    R[i, r] = integral over row r of the polynomial that is 1 at x_i and 0 at the other points, and C likewise for columns.
With Chebyshev points and polynomials (T. J. Rivlin, "Chebyshev Polynomials", 2nd ed., chapters 1 and 2) the integrals are
differences of cosines, and two matrix products are the only pass over the image. The error is that of the interpolation
of K, rho**-points with rho of the Bernstein ellipse in which K is analytic; it does not depend on the size of the texels.

The four quadrants of an image that is symmetric about its centre are mirror images on the sphere, and so are opposite faces of
a cube. Mirroring only changes signs of Y, so one quadrant of the points is enough.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.boxes import folded, wave_sums
from shviewer.harmonics.areas.chebyshev import chebyshev_points, chebyshev_values, integrate_series, points_from_series
from shviewer.harmonics.areas.eightfold import waves
from shviewer.harmonics.basis import Array, check_bands, normalise
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS, from_waves

DIRECT_BANDS = 32
"""The most bands for which each point meets each wave."""

BLOCK_VALUES = 2**21
"""Eight times the basis values that are held at a time."""

BLOCK_TEXELS = 2**17
"""How many texels are held in float64 at a time, 3 MiB."""


def texel_weights(edges: Array, n_points: int) -> tuple[Array, Array]:
    """Points (n_points,) in the interval that `edges` (texels + 1,) divide, and the matrix (n_points, texels) above.

    Row i applied to the texels, times K at point i, adds up to the integral of texel * K for every polynomial K of degree
    below n_points.
    """
    middle, half = (edges[0] + edges[-1]) / 2, (edges[-1] - edges[0]) / 2
    points = middle + half * chebyshev_points(n_points)
    primitives = integrate_series(chebyshev_values(np.clip((edges - middle) / half, -1, 1), n_points + 1))
    return points, half * (points_from_series(n_points) @ np.diff(primitives, axis=1))


def quadrant_points(n_texels: int, n_points: int) -> tuple[Array, Array]:
    """`texel_weights` for the half [0, 1] of n_texels equal texels on [-1, 1]: n_texels - n_texels // 2 texels.

    The middle one of an odd number counts half. The half [-1, 0] is the same, mirrored.
    """
    return texel_weights(quadrant_edges(n_texels), n_points)


def quadrant_edges(n_texels: int) -> Array:
    """The edges, from 0 to 1, of the texels in the half [0, 1], (n_texels - n_texels // 2 + 1,).

    The middle one of an odd number begins at 0.
    """
    return np.maximum((2 * np.arange(n_texels // 2, n_texels + 1) - n_texels) / n_texels, 0.0)


def four_quadrants(quadrant: Array, n_texels: int) -> Array:
    """The values of a quadrant for the whole image (n_texels, n_texels), with the halves of middle texels added up."""
    odd = n_texels % 2
    if odd:
        twice = np.where(np.arange(len(quadrant)) == 0, 2, 1)
        quadrant = quadrant * twice * twice[:, None]
    whole = np.empty((n_texels, n_texels))
    towards, away = slice((n_texels - 1) // 2, None, -1), slice(n_texels // 2, None)
    for rows in (towards, away):
        for columns in (towards, away):
            whole[rows, columns] = quadrant
    return whole


def above_the_middle(n_texels: int) -> Array:
    """The share of each row of n_texels that lies above the middle of the image, (n_texels, 1): half of a middle one."""
    return np.asarray(np.clip(n_texels / 2 - np.arange(n_texels), 0.0, 1.0)[:, None])


def quadrant_weights(
    image: NDArray[np.floating], n_points: int, spans: NDArray[np.int64] | None = None
) -> tuple[Array, Array]:
    """W for the four quadrants of an image (height, width, 3) on the square [-1, 1]^2, rows downwards.

    spans: (height, 2), first and last-plus-one column of each row; texels outside count as 0. None for all.
    Returns the points (n_points,) in [0, 1] and W, shape (2, 2, n_points, n_points, 3). Its axes: upper and lower half, left
    and right half, distance from the centre up or down, distance sideways, channel.
    """
    height, width = image.shape[:2]
    points, rows = quadrant_points(height, n_points)
    columns = rows if width == height else quadrant_points(width, n_points)[1]
    result = np.empty((2, 2, n_points, n_points, 3))
    for down, (row_weights, part) in enumerate(_halves(rows, height)):
        sums = _sum_rows(row_weights, image[part], None if spans is None else spans[part])
        by_column = np.ascontiguousarray(sums.reshape(n_points, width, 3).transpose(1, 0, 2)).reshape(width, -1)
        for right, (column_weights, half) in enumerate(_halves(columns, width)):
            product = column_weights @ by_column[half]
            result[down, right] = product.reshape(n_points, n_points, 3).transpose(1, 0, 2)
    return points, result


def _halves(weights: Array, n_texels: int) -> tuple[tuple[Array, slice], tuple[Array, slice]]:
    """The weights and the texels of [-1, 0] and of [0, 1]."""
    return (weights[:, ::-1], slice(0, n_texels - n_texels // 2)), (weights, slice(n_texels // 2, n_texels))


def _sum_rows(weights: Array, image: NDArray[np.floating], spans: NDArray[np.int64] | None) -> Array:
    """weights (n, rows) times image (rows, width, 3): (n, width * 3), float64, in blocks of rows."""
    height, width = image.shape[:2]
    sums = np.zeros((len(weights), width * 3))
    block = min(height, max(1, BLOCK_TEXELS // width))
    memory = np.empty(block * width * 3)
    for start in range(0, height, block):
        rows = slice(start, min(start + block, height))
        left, right = (0, width) if spans is None else (int(spans[rows, 0].min()), int(spans[rows, 1].max()))
        some = image[rows, left:right]
        wide = memory[: some.size].reshape(some.shape)
        np.copyto(wide, some)
        if spans is not None:
            for row, (first, last) in zip(wide, (spans[rows] - left).tolist(), strict=True):
                row[:first] = row[last:] = 0.0
        sums[:, 3 * left : 3 * right] += weights[:, rows] @ wide.reshape(len(wide), -1)
    return sums


def project_mirrored(directions: Array, values: Array, n_bands: int) -> Array:
    """Sum of value * Y over directions and their mirror images, (n_bands**2, channels).

    directions: (k, 3), any length. values: (x, y, z, k, channels) with 1 or 2 along each of the first three axes; index 1 is
    the value in the direction whose coordinate of that name is negated.
    """
    check_bands(n_bands, MAX_SEPARABLE_BANDS)
    return from_waves(mirrored_waves(directions, values, n_bands))


def mirrored_waves(directions: Array, values: Array, n_bands: int) -> Array:
    """`wave_sums` of boxes.py, whose cost is no longer n^2, or for few bands directly.

    Every Y is a sum of products of {cos, sin}(m phi) and, for even m, cos(k theta), for odd m, sin(k theta)
    (theta_series.py), each even or odd in every coordinate. So the values are summed with the products alone, and each kind
    needs only the sum or the difference of mirror images.
    """
    if n_bands > DIRECT_BANDS:
        return wave_sums(directions, values, n_bands)
    channels = values.shape[-1]
    values = folded(values)
    last = np.array(values.shape[:3]) - 1
    n_even = (n_bands + 1) // 2
    sums = np.zeros((n_bands, 2, channels, n_bands))  # m, {cos, sin}(m phi), channel, k by parity
    block = max(64, BLOCK_VALUES // (8 * n_bands))
    for start in range(0, len(directions), block):
        points = slice(start, start + block)
        x, y, z = normalise(directions[points]).T
        from_axis = np.hypot(x, y)
        off_axis = from_axis > 0
        phi = np.where(off_axis, x, 1.0), np.where(off_axis, y, 0.0)
        azimuth = waves(
            phi[0] / np.where(off_axis, from_axis, 1.0), phi[1] / np.where(off_axis, from_axis, 1.0), n_bands
        )
        polar = waves(z, from_axis, n_bands)
        polar[1][0] = -np.arctan2(z, from_axis)
        for parity, sine, odd_k in np.ndindex(2, 2, 2):
            if max(parity, odd_k) >= n_bands:
                continue
            odd = np.array([(parity + sine) % 2, sine, (parity + odd_k) % 2])
            mirrored = values[(*(odd * last), points)]
            along_theta = polar[parity][odd_k::2, None] * mirrored.T  # k, channel, point
            product = azimuth[sine][parity::2] @ along_theta.reshape(-1, len(x)).T
            kept = slice(n_even, None) if odd_k else slice(0, n_even)
            sums[parity::2, sine, :, kept] += product.reshape(len(product), -1, channels).swapaxes(1, 2)
            if parity and odd_k:  # as in boxes.py
                sums[1::2, sine, :, 0] -= np.pi / 2 * azimuth[sine][1::2] @ mirrored
    return sums
