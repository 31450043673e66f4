"""The integrals of any function of directions, with what they may be off by.

A Gauss-Legendre rule is compared with two rules in other places: the look, and a rule turned into another frame. If they agree,
the function is smooth and the rule exact. If not, cells are divided where it is not smooth (adaptive.py). All of them are
compared in the scale of the function: integrals of f with those of |f|, of f^2 with themselves.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.harmonics.projection.rows import project_product
from shviewer.harmonics.quadrature import Radiance, gauss_legendre
from shviewer.harmonics.sampling.adaptive import resolve
from shviewer.harmonics.sampling.cells import Cells
from shviewer.harmonics.sampling.look import SEEN_DEGREES, Integrals, Watched, look, turned
from shviewer.harmonics.sampling.spread import project_points

ROWS = (160, 320)
"""Gauss-Legendre rows, tried in turn; the first are exact for products of two functions of 160 bands."""

AGREEMENT = 3e-5
"""A Gauss-Legendre rule is enough if the uncertainty that follows from the other rules is no larger."""

GAIN = 4.0
"""The least that twice the rows improve the figures by, where they improve; a kink gains more."""

FOLDED = 0.1
"""The part of what 128 bands leave out that the bands above them, which the first rule mistakes for lower ones, may change."""


@dataclass(frozen=True, eq=False)
class Sampled:
    """The integrals of a function, and what is known of it."""

    texels: NDArray[np.float32]
    """Its raster, from pole to pole."""
    coefficients: Array
    products: Array
    """Integrals of f_i f_j, (3, 3): never less than the coefficients hold."""
    accuracy: float
    """What coefficients may be off by, over the integral of |f|, the L2 norm, over itself, and relative L2 errors."""
    rows: int | None
    """The rows of the Gauss-Legendre rule that was enough; None if cells were divided."""
    evaluations: int
    """All of them, those for comparison, too."""
    peak: float
    """The largest |f| seen."""
    places: Array
    """Directions (k, 3) of the brightest points where cells were divided."""
    seen_degrees: float
    """The width of features that cannot have been missed."""
    layers: tuple[tuple[Cells, Array], ...] = ()
    """The cells, and their values times the weights of their points (adaptive.py)."""

    @property
    def left_out(self) -> float:
        """The relative L2 error of the coefficients."""
        return _left_out(self.coefficients, self.products)

    def with_more_bands(self, radiance: Radiance, n_bands: int) -> Array:
        """Coefficients (n_bands**2, 3), those there are and more of the same cells, or of a rule that has as many bands."""
        if self.layers:
            found = project_points(self.layers, n_bands)
        else:
            found = project_product(radiance, gauss_legendre(2 * n_bands**2), n_bands)[0]
        found[: len(self.coefficients)] = self.coefficients
        return found


def sample(radiance: Radiance, n_bands: int) -> Sampled:
    """Integrate a function for n_bands bands, at least two."""
    watched = Watched(radiance)
    texels, looked = look(radiance)
    other, *points = turned(radiance)
    evaluations = looked.evaluations + other.evaluations
    before: Array | None = None
    for rows in ROWS:
        coefficients, products = project_product(watched, gauss_legendre(2 * rows**2), n_bands)
        evaluations += 2 * rows**2
        rule = _integrals(coefficients, products)
        left_out = _left_out(coefficients, products)
        errors = np.maximum(_differences(rule, looked), _differences(rule, other))
        accuracy = _uncertainty(errors, _scales(looked, products), left_out)
        figures = errors_by_band_count(products, coefficients, coefficients)
        folded = FOLDED * left_out if before is None else float(np.abs(figures - before).max()) / GAIN
        accuracy, before = max(accuracy, folded), figures
        if accuracy <= AGREEMENT:
            peak, nowhere = max(looked.peak, other.peak), np.zeros((0, 3))
            return Sampled(texels, coefficients, products, accuracy, rows, evaluations, peak, nowhere, SEEN_DEGREES)
    left_out = max(left_out, _left_out(coefficients, looked.products))
    directions, values = (np.concatenate(pair) for pair in zip(points, watched.seen, strict=True))
    found = resolve(radiance, texels, (directions, values), _scales(looked, looked.products), left_out, n_bands)
    products, lifted = _no_less(found.products, found.coefficients)
    cells = _integrals(found.coefficients, products)
    cells.magnitude = found.magnitude
    errors = found.errors + lifted * (np.arange(7) == 6)
    accuracy = _uncertainty(errors, _scales(cells, products), _left_out(found.coefficients, products))
    return Sampled(
        texels,
        found.coefficients,
        products,
        accuracy,
        None,
        evaluations + found.evaluations,
        max(looked.peak, other.peak, found.peak),
        found.places,
        max(SEEN_DEGREES, found.widest_left / 2),
        tuple(found.layers),
    )


def _integrals(coefficients: Array, products: Array) -> Integrals:
    """The integrals of f, x f, y f and z f that are in the first two bands."""
    x, y, z = -coefficients[3], -coefficients[1], coefficients[2]
    factors = np.sqrt(4 * np.pi / np.array([1, 3, 3, 3]))[:, None]
    return Integrals(moments=factors * np.stack([coefficients[0], x, y, z]), products=products)


def _differences(one: Integrals, two: Integrals) -> Array:
    """How far two rules differ, (7,): in the integrals of f, of f^2, and of f^2 over all channels."""
    energy = np.abs(one.products - two.products)
    common = min(len(one.moments), len(two.moments))
    return np.concatenate(
        [np.abs(one.moments[:common] - two.moments[:common]).max(axis=0), energy.diagonal(), [energy.trace()]]
    )


def _scales(integrals: Integrals, products: Array) -> Array:
    """What such differences refer to, (7,)."""
    return np.concatenate([integrals.magnitude, products.diagonal(), [products.trace()]])


def _left_out(coefficients: Array, products: Array) -> float:
    """The relative L2 error of all bands."""
    total = float(products.trace())
    return float(np.sqrt(max(0.0, 1 - (coefficients**2).sum() / total))) if total > 0 else 0.0


def _uncertainty(errors: Array, scales: Array, left_out: float) -> float:
    """The accuracy of `Sampled` for errors (7,) of integrals of these scales (7,)."""
    share = np.divide(errors, scales, out=np.where(errors > 0, 1.0, 0.0), where=scales > 0)
    figure = np.sqrt(left_out**2 + share[6]) - left_out
    return float(max(share[:3].max(), share[3:6].max() / 2, figure))


def _no_less(products: Array, coefficients: Array) -> tuple[Array, float]:
    """Products (3, 3) raised where a sum of channels has less energy than its coefficients, and by how much in all."""
    held = coefficients.T @ coefficients
    values, vectors = np.linalg.eigh(products - held)
    lifted = float(-values.clip(max=0).sum())
    return (products, 0.0) if lifted == 0 else (held + vectors @ (values.clip(min=0)[:, None] * vectors.T), lifted)
