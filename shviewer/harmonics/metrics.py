"""Error metrics of a reconstruction, from coefficients alone.

Shown coefficients s(l, m) need not be the exact ones c(l, m): bands may be muted or windowed, or a sampled method
estimates them. Since the basis is orthonormal, the squared L2 error splits without any quadrature (Parseval):
    ||f - sum of s Y||^2 = (||f||^2 - sum of c^2) + sum of (c - s)^2.
The first bracket is what the bands left out hold (truncation); the last sum is what muting, windows and sampling add. With a
window h the latter is (1 - h)^2 c^2, so that the whole is ||f||^2 - sum of (2h - h^2) c^2.

A light's *products* are the 3 x 3 integrals of f_i f_j over its channels. They give ||f||^2 of every linear combination of
channels; the figures are made for R, G, B, their sum and Rec. 709 luminance.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shviewer.harmonics.basis import Array, count_bands, degrees

ROUNDING = 1e-11
"""How far a sum of squared coefficients may exceed ||f||^2, relative to it: rounding of up to 128**2 terms."""

SMALLEST = 1e-300
"""How far it may exceed it in addition, absolutely: smaller squares lose their digits where float64 ends."""

PARSEVAL_FLOOR = 1e-7
"""Relative errors below this are lost in rounding, since they come from a difference of squares in float64."""

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Rec. 709 luminance of linear RGB [ITU-R BT.709-6, item 3.2]."""

CHANNELS = ("red", "green", "blue", "luminance")


def band_power(coefficients: Array) -> Array:
    """The power of each band, the sum over m of c(l, m)^2, which no rotation changes: (n**2, 3) -> (n, 3)."""
    first = np.arange(count_bands(coefficients)) ** 2
    return np.asarray(np.add.reduceat(coefficients**2, first, axis=0))


def band_weights(n_bands: int, muted: frozenset[int]) -> Array:
    """A weight per coefficient, (n_bands**2, 1): 1 in a band that is on, 0 in a muted one."""
    return np.isin(degrees(n_bands), list(muted), invert=True).astype(np.float64)[:, None]


def squared_error(
    norm_squared: Array, exact: Array, shown: Array, magnitude: Array | None = None
) -> tuple[float, float]:
    """(left-out, added) squared L2 error over all channels: the two terms of the module docstring.

    norm_squared: (k,) for k channels; exact, shown: (n**2, k); magnitude: (k,), the sum of magnitudes, if norm_squared is
    a sum that may cancel. ValueError if `exact` holds more energy than the light: then the two come from different
    quadratures, and no error follows from them.
    """
    missing = norm_squared - (exact**2).sum(axis=0)
    if (missing < -SMALLEST - ROUNDING * (norm_squared if magnitude is None else magnitude)).any():
        raise ValueError(f"coefficients hold {-missing.min():.3g} more energy than the light: mixed quadratures")
    return float(missing.clip(min=0).sum()), float(((exact - shown) ** 2).sum())


def relative(squared: float, norm_squared: Array) -> float:
    """sqrt(squared / ||f||^2) over all channels; for a black light 0 if nothing is shown, else infinity."""
    total = float(norm_squared.sum())
    if total == 0:
        return 0.0 if squared == 0 else float("inf")
    return float(np.sqrt(squared / total))


@dataclass(frozen=True)
class ChannelFigures:
    """Relative L2 errors and PSNR, in decibels, of one channel or of all together."""

    relative_l2: float
    left_out: float
    """The part of relative_l2 that the bands left out cause; relative_l2^2 = left_out^2 + added^2."""
    added: float
    """The part that muted bands, windows and sampling add."""
    psnr: float
    """10 log10(peak^2 / mean square error over the sphere); infinite for no error."""


def channel_figures(products: Array, exact: Array, shown: Array, peak: float) -> dict[str, ChannelFigures]:
    """Figures "all", "red", "green", "blue" and "luminance".

    products: (3, 3); exact, shown: (n**2, 3); peak: the largest |radiance|, to which PSNR refers; all in one unit.
    """
    mixes = {"all": np.eye(3)} | {
        name: row[:, None] for name, row in zip(CHANNELS, [*np.eye(3), LUMINANCE], strict=True)
    }
    figures = {}
    for name, mix in mixes.items():
        norm = np.maximum(np.einsum("ik,ij,jk->k", mix, products, mix), 0)
        magnitude = np.einsum("ik,ij,jk->k", np.abs(mix), np.abs(products), np.abs(mix))
        left_out, added = squared_error(norm, exact @ mix, shown @ mix, magnitude)
        mean = (left_out + added) / (4 * np.pi * mix.shape[1])
        psnr = 10 * np.log10(peak**2 / mean) if mean > 0 and peak > 0 else np.inf if mean == 0 else -np.inf
        figures[name] = ChannelFigures(
            relative(left_out + added, norm), relative(left_out, norm), relative(added, norm), float(psnr)
        )
    return figures


def errors_by_band_count(products: Array, exact: Array, shown: Array) -> Array:
    """Relative L2 error over all channels with the first n bands of `shown`, for n = 1 ... N: (N,).

    products: (3, 3); exact, shown: (N**2, 3). ValueError for mixed quadratures.
    """
    norm = float(np.trace(products))
    kept = np.cumsum(band_power(exact).sum(axis=1))
    added = np.cumsum(band_power(exact - shown).sum(axis=1))
    if norm == 0:
        return np.where(added > 0, np.inf, 0.0)
    if kept[-1] > norm * (1 + ROUNDING) + SMALLEST:
        raise ValueError(f"coefficients hold {kept[-1] / norm - 1:.3g} more energy than the light: mixed quadratures")
    return np.asarray(np.sqrt(((norm - kept).clip(min=0) + added) / norm))


def smallest_band_count(errors: Array, tolerance: float) -> int | None:
    """The smallest n whose error is within `tolerance`; None if there is none. ValueError unless 0 < tolerance < 1.

    errors: (N,) for n = 1 ... N bands.
    """
    if not 0 < tolerance < 1:
        raise ValueError(f"tolerance {tolerance:g}: it must be between 0 and 1, such as 0.05 or 5%")
    within = np.nonzero(errors <= tolerance * (1 + 1e-12))[0]
    return int(within[0]) + 1 if len(within) else None


@dataclass(frozen=True)
class SampleEstimate:
    """The band count estimated from samples alone: the likely one, and the fewest and most that their noise allows."""

    likely: int | None
    fewest: int | None
    most: int | None

    @property
    def decided(self) -> bool:
        return self.fewest == self.most


def split_half_estimate(
    first: Array, second: Array, norm_squared: float, norm_deviation: float, tolerance: float
) -> SampleEstimate:
    """Choose a band count from two independent projections of a light, (n**2, 3) each, without knowing the light.

    A squared coefficient holds the variance of its estimate, too, and would make every band look needed; products of
    two halves do not. ||f||^2 - sum of first * second therefore estimates what is left out without bias, and with
    d = first - second, s = first + second the variance of one product is about d^2 s^2 / 4 + d^4 / 4. `norm_squared` over
    all channels comes from the same samples, with the standard deviation `norm_deviation`. None: no count is enough.
    """
    starts = np.arange(count_bands(first)) ** 2
    difference, total = first - second, first + second
    kept = np.cumsum(np.add.reduceat((first * second).sum(axis=1), starts))
    variance = np.add.reduceat(((difference * total) ** 2 / 4 + difference**4 / 4).sum(axis=1), starts)
    deviation = np.sqrt(np.cumsum(variance) + norm_deviation**2)
    left_out = norm_squared - kept

    def count(excess: Array) -> int | None:
        within = np.nonzero(left_out + excess <= tolerance**2 * norm_squared)[0]
        return int(within[0]) + 1 if len(within) else None

    return SampleEstimate(count(0 * deviation), count(-2 * deviation), count(2 * deviation))


def pareto_front(points: Sequence[tuple[float, float]]) -> list[int]:
    """Indices of the Pareto front of points (time, error), by time: no other point is as good in both and better in one.

    Of equal points the front has the first.
    """
    front: list[int] = []
    for i in sorted(range(len(points)), key=lambda i: (points[i], i)):
        if not front or points[i][1] < points[front[-1]][1]:
            front.append(i)
    return front
