"""Hard cases of projecting radiance: images, suns, cancelling and endless sums.

Each function returns the error of the code under test, or of other code that a test passes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from shviewer.benchmark.hard_cases import exact
from shviewer.benchmark.hard_cases.outcome import Case, largest, worst
from shviewer.benchmark.hard_cases.shader import SEED, SKY, SUN, cancelling_views, sun_views
from shviewer.harmonics.basis import Array, evaluate_basis, index
from shviewer.harmonics.projection.rows import project_image
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import DirectionSet, Radiance
from shviewer.harmonics.zonal import Disc

MANY = 10_000_000
BLAS_SUM = 5.6e-12
"""Relative error of 1e7 equal terms summed by BLAS in float64, measured; one by one it is 1.6e-10, in float32 9 %."""

ANY_SIZE = ((1, 1), (2, 3), (3, 2), (5, 7), (1, 64), (64, 1), (1, 2), (17, 5), (33, 66), (512, 1024))
"""Rows and columns of the test images."""

CHOSEN = ((0, 0), (1, 0), (1, -1), (2, 2), (3, -2), (7, 5), (7, -7), (7, 0))
"""Degrees and orders that are summed term by term."""

ProjectImage = Callable[[NDArray[np.floating], int], Array]
ProjectSamples = Callable[[Radiance, DirectionSet, int], Array]
Zonal = Callable[[float, int], Array]
"""Half angle in radians and bands -> lambda(l)."""


@worst
def constant_image(project: ProjectImage = project_image) -> Iterator[Array]:
    """Radiance 1 on images of any size: c(0, 0) = sqrt(4 pi), all others 0, relative to the first, in 8 bands.

    Bound: 1e-14, three times what rounding leaves of exactly integrated texels (two kernels of OpenBLAS tried); point
    weights are off by up to 2.5.
    """
    for height, width in ANY_SIZE:
        coefficients = project(np.ones((height, width, 3), dtype=np.float32), 8) / np.sqrt(4 * np.pi)
        coefficients[0] -= 1
        yield coefficients


def image_error(
    project: ProjectImage, image: NDArray[np.floating], n_bands: int, chosen: Sequence[tuple[int, int]] = CHOSEN
) -> float:
    """The error of some coefficients against sums of texel times integral, relative to the sums of the magnitudes.

    The integrals are by Gauss-Legendre within each row and column, the sum of all products is exact (fsum).
    """
    ours = project(image, n_bands)
    pixels = image[..., 0].astype(np.float64)
    scale = _fsum_image(np.abs(pixels), 0, 0) if pixels.any() else 1.0
    return max(largest((ours[index(l, m), 0] - _fsum_image(pixels, l, m)) / scale) for l, m in chosen)


def _fsum_image(pixels: Array, l: int, m: int) -> float:
    height, width = pixels.shape
    nodes, weights = np.polynomial.legendre.leggauss(24)
    theta = np.pi / height * (np.arange(height)[:, None] + (nodes + 1) / 2)
    phi = np.pi * (1 - 2 * (np.arange(width)[:, None] + (nodes + 1) / 2) / width)
    meridian = np.stack([np.sin(theta), np.zeros_like(theta), np.cos(theta)], axis=-1)
    along = np.concatenate(
        [evaluate_basis(part, l + 1)[..., index(l, abs(m))] for part in np.array_split(meridian, 16)]
    )
    row = (along * np.sin(theta)) @ weights * (np.pi / (2 * height))
    column = (np.cos(m * phi) if m >= 0 else np.sin(-m * phi)) @ weights * (np.pi / width)
    return float(math.fsum((row[:, None] * (pixels * column)).ravel().tolist()))


def odd_sizes(project: ProjectImage = project_image) -> float:
    """Noise on images of other aspects than 2:1. Bound: 4e-15, measured between two ways of projecting exactly."""
    random = np.random.default_rng(SEED)
    sizes = [size for size in ANY_SIZE if size[0] < 100]
    return max(image_error(project, random.random((*size, 3)).astype(np.float32), 8) for size in sizes)


def sun_and_sky(project: ProjectImage = project_image) -> float:
    """A sun of 1.6e9 in a sky of 1e3 on 512 x 1024 texels, 16 bands: float32 sums lose the sky.

    Bound: as for odd_sizes, since the sums are no longer than what BLAS adds up by blocks.
    """
    image = np.full((512, 1024, 3), SKY, dtype=np.float32)
    image[100:102, 300:302] = SUN
    chosen = [*CHOSEN, (15, 0), (15, 15), (15, -8)]
    return image_error(project, image * _speckle((512, 1024)), 16, chosen)


def dynamic_range(project: ProjectImage = project_image) -> float:
    """Texels from 1e-6 to 1e6, log-uniform, 256 x 512, 8 bands. Bound: as for odd_sizes; float32 sums have 6e-5."""
    random = np.random.default_rng(SEED)
    return image_error(project, (10 ** random.uniform(-6, 6, (256, 512, 3))).astype(np.float32), 8)


def cancellation(project: ProjectImage = project_image) -> float:
    """Texels of +-1e6, at random, plus 1e-3, relative to the sum of magnitudes. Bound: as for odd_sizes.

    No float64 sum of products can do better: the input's own rounding is 6e-11 of 1e6.
    """
    signs = np.random.default_rng(SEED).choice([1e6, -1e6], size=(512, 1024))
    return image_error(project, np.repeat((signs + 1e-3)[..., None], 3, axis=2), 16)


def _speckle(shape: tuple[int, int]) -> NDArray[np.float32]:
    """Factors 0.5 to 1.5, so that nothing cancels by symmetry, (*shape, 1)."""
    return (0.5 + np.random.default_rng(SEED).random((*shape, 1))).astype(np.float32)


def many_samples(project: ProjectSamples = project_samples) -> float:
    """1e7 samples of radiance 0.1 towards +z, relative to the exact coefficients of 2 bands. Bound: BLAS_SUM."""
    wanted = np.array([1, 0, math.sqrt(3), 0]) * (0.1 * math.sqrt(4 * math.pi))
    found = project(lambda directions: np.full((len(directions), 3), 0.1), _many_samples_north(), 2)
    return largest((found - wanted[:, None]) / wanted[0])


def many_cancelling_samples(project: ProjectSamples = project_samples) -> float:
    """5e6 samples of 1e6 + 1e-3, then as many of -1e6 + 1e-3, relative to 1e6 times the sphere.

    Bound: BLAS_SUM, relative to the magnitudes. Any plain float64 sum loses the remaining 1e-3 in their rounding.
    """
    seen = 0

    def radiance(directions: Array) -> Array:
        nonlocal seen
        number = seen + np.arange(len(directions))
        seen += len(directions)
        return np.repeat((np.where(number < MANY // 2, 1e6, -1e6) + 1e-3)[:, None], 3, axis=1)

    wanted = ((1e6 + 1e-3) + (-1e6 + 1e-3)) / 2 * math.sqrt(4 * math.pi)
    found = project(radiance, _many_samples_north(), 1)
    return largest(found - wanted) / (1e6 * math.sqrt(4 * math.pi))


def _many_samples_north() -> DirectionSet:
    """MANY samples in the direction +z, in the memory of one."""
    north, weight = np.array([0.0, 0.0, 1.0]), np.float64(4 * np.pi / MANY)
    return DirectionSet(np.broadcast_to(north, (MANY, 3)), np.broadcast_to(weight, (MANY,)))


@worst
def suns(degrees: Sequence[float], zonal: Zonal = lambda angle, n: Disc(angle).zonal(n)) -> Iterator[Array]:
    """Coefficients of discs to l = 31, each relative to itself.

    Bound: l steps of the recurrence of four roundings each, 32 * 4 * 2^-53 = 1.4e-14. The usual P(l-1) - P(l+1) loses
    twelve bits at 0.265 degrees and all of them at 1e-6.
    """
    for half_angle in np.radians(degrees).tolist():
        wanted = np.array(exact.disc(half_angle, 32), dtype=np.float64)
        yield np.asarray(zonal(half_angle, 32)) / wanted - 1


DISC, FSUM = "60-digit decimal, relative", "exactly rounded sums"

CASES = (
    Case("constant light, images from 1 x 1", "sqrt(4 pi), else 0", 1e-14, constant_image),
    Case("odd aspect ratios", FSUM, 4e-15, odd_sizes),
    Case("tiny suns, 1e-6 to 0.265 degrees", DISC, 1.4e-14, lambda: suns((1e-6, 1e-4, 0.01, 0.265))),
    Case("huge suns, 179 to 179.9 degrees", DISC, 1.4e-14, lambda: suns((179.0, 179.735, 179.9))),
    Case("sun and sky, 512 x 1024", FSUM, 4e-15, sun_and_sky, sun_views),
    Case("1e7 samples of a constant 0.1", "closed form, relative", BLAS_SUM, many_samples),
    Case("+-1e6 cancellation, image", FSUM, 4e-15, cancellation, cancelling_views),
    Case("+-1e6 cancellation, 1e7 samples", "closed form, relative to 1e6", BLAS_SUM, many_cancelling_samples),
    Case("dynamic range 1e-6 to 1e6", FSUM, 4e-15, dynamic_range),
)
