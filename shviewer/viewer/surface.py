"""The surfaces of the lobe view: values on the sphere become radii, in one scale where they are compared.

Those of a light are the square roots of magnitudes: linear ones are needles that hide what is negative. Basis functions keep
their shape.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log2, sqrt

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.cache import remember
from shviewer.analysis.figures import sums
from shviewer.analysis.projections import Projection
from shviewer.analysis.recipe import Shown
from shviewer.analysis.reconstruction import Reconstruction
from shviewer.harmonics.basis import Array, count_bands, index
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quadrature import angles_from_directions, column_azimuths, directions_from_angles
from shviewer.harmonics.quantities.encodings import Stored
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.light import Light
from shviewer.viewer.view import View

Floats = NDArray[np.float32]

FEWEST_ROWS, MOST_ROWS = 129, 1025
"""Limits for the rows of a grid: 2^k + 1 from pole to pole, with 2^(k+1) columns."""

LIGHT_ROWS = 513
"""Rows for a light that has no bands: cells of 0.35 degrees, so that no sun falls between the points."""

TIP_PIXELS = 0.25
"""How much may be cut off the tip of the finest lobe between two points of a grid, in pixels."""

ASIDE = 1e-7
"""Radians by which rows are shifted, so that rounding does not decide point by point on which side of an edge they are."""

BLOCK_ROWS = 64

RADIUS = 222.0
"""The radius in pixels, at zoom 1, for which surfaces are fine enough: that of the 1280 x 640 design."""


@dataclass(frozen=True, eq=False)
class Surface:
    """values (2^k + 1, 2^(k+1)) float32, signed: magnitudes are radii, 1 at most. Drawings are kept by identity."""

    values: Floats
    clipped: bool
    """Whether larger magnitudes were cut off at radius 1."""


def surfaces(
    view: View, light: Light, projection: Projection, shown: Shown, other: Reconstruction | None = None
) -> tuple[Surface, ...]:
    """The surfaces of the light, of its reconstruction (or a basis function in its place), and perhaps of the error.

    other: a second reconstruction, in place of the error.
    """
    radius = RADIUS * view.zoom
    rows = max(LIGHT_ROWS, rows_for(shown.n_bands, radius))
    original, reconstruction, error, unit = _compared_surfaces(light, projection, shown, rows)
    if other is not None:
        error = surface(sample_reconstruction(other.coefficients, rows, other.stored), unit, root=True)
    if view.basis is not None:
        l, m = view.basis
        reconstruction = basis_surface(l, m, rows_for(l + 1, radius))
    return (original, reconstruction, error)[: view.n_spheres]


@remember(most=4, doing="making surfaces")
def _compared_surfaces(
    light: Light, projection: Projection, shown: Shown, rows: int
) -> tuple[Surface, Surface, Surface, float]:
    coefficients, figures = sums(light, projection, shown)
    stored = projection.stored_as(figures.factors)
    original, reconstruction = sample_light(light, rows), sample_reconstruction(coefficients, rows, stored)
    unit = unit_radius(original, reconstruction)
    first, second, third = (
        surface(values, unit, root=True) for values in (original, reconstruction, reconstruction - original)
    )
    return first, second, third, unit


def rows_for(n_bands: int, radius: float) -> int:
    """Rows of a grid on which n bands, drawn with a radius in pixels, are smooth to TIP_PIXELS; at most MOST_ROWS.

    A lobe of degree l = n - 1 has at its tip a second derivative of at most l^2 times its length; a chord over an angle h
    cuts off h^2/8 times that.
    """
    intervals = float(np.pi) * (n_bands - 1) * sqrt(radius / (8 * TIP_PIXELS))
    return max(FEWEST_ROWS, min(int(2 ** ceil(log2(max(intervals, 1.0)))) + 1, MOST_ROWS))


def sample_reconstruction(coefficients: Array, rows: int, stored: Stored | None = None) -> Floats:
    """Rec. 709 luminance on the grid, (rows, 2 (rows - 1)): of the sum with coefficients (n**2, 3), or of an encoding."""
    return _synthesise(coefficients @ LUMINANCE, rows) if stored is None else _sampled(stored.irradiance, rows)


def sample_basis(l: int, m: int, rows: int) -> Floats:
    """Y(l, m) on the grid. ValueError unless |m| <= l."""
    if not -l <= m <= l:
        raise ValueError(f"Y({l},{m}): the order goes from -l to l")
    coefficients = np.zeros((l + 1) ** 2)
    coefficients[index(l, m)] = 1
    return _synthesise(coefficients, rows)


@remember(most=2)
def sample_light(light: Light, rows: int) -> Floats:
    """Rec. 709 luminance of a light on the grid; remembered with the light."""
    values = _sampled(light.radiance, rows)
    _raise_landmarks(values, light)
    values.flags.writeable = False
    return values


def unit_radius(original: Floats, reconstruction: Floats) -> float:
    """The magnitude that gets radius 1: the largest of the reconstruction, or where that is nothing, of the original.

    An original with a sun is longer, and cut: it would shrink everything else to nothing.
    """
    return float(np.abs(reconstruction).max()) or float(np.abs(original).max())


def surface(values: Floats, unit: float, *, root: bool = False) -> Surface:
    """The surface of values in units of that magnitude, cut off at 1. root: of their square roots, which show the small."""
    if unit <= 0:
        return Surface(np.zeros_like(values), False)
    scaled = values / np.float32(unit)
    longest = float(np.abs(scaled).max())
    radii = np.copysign(np.sqrt(np.abs(scaled)), scaled) if root else scaled
    return Surface(np.clip(radii, -1, 1), longest > 1 + 1e-5)


@lru_cache(maxsize=8)
def basis_surface(l: int, m: int, rows: int) -> Surface:
    """The surface of Y(l, m), its largest magnitude being the radius 1."""
    values = sample_basis(l, m, rows)
    return surface(values, float(np.abs(values).max()))


def _sampled(radiance_at: Callable[[Array], Array], rows: int) -> Floats:
    """Rec. 709 luminance of a function of directions (k, 3) on the grid."""
    theta, phi = np.linspace(0, np.pi, rows), column_azimuths(2 * (rows - 1))
    theta[1:-1] += ASIDE
    values = np.empty((rows, len(phi)), dtype=np.float32)
    for start in range(0, rows, BLOCK_ROWS):
        directions = directions_from_angles(theta[start : start + BLOCK_ROWS, None], phi)
        radiance = radiance_at(directions.reshape(-1, 3))
        values[start : start + BLOCK_ROWS] = (radiance @ LUMINANCE).reshape(directions.shape[:2])
    values[[0, -1]] = values[[0, -1], :1]  # one direction each
    return values


def _synthesise(coefficients: Array, rows: int) -> Floats:
    wide = np.zeros((count_bands(coefficients) ** 2, 3))
    wide[:, 0] = coefficients
    return np.ascontiguousarray(Synthesis(wide).pole_to_pole(rows, 2 * (rows - 1))[..., 0])


def _raise_landmarks(values: Floats, light: Light) -> None:
    """Widen features smaller than a grid cell, such as a sun, in place: a point that stands alone has no width."""
    cell = np.pi / (len(values) - 1)
    theta, phi = np.linspace(0, np.pi, len(values)), column_azimuths(values.shape[1])
    places = light.landmarks()
    for place, peak in zip(places, light.radiance(places) @ LUMINANCE, strict=True):
        row = round(float(angles_from_directions(place)[0]) / cell)
        rows = slice(max(row - 3, 0), row + 4)
        chord = np.linalg.norm(directions_from_angles(theta[rows, None], phi) - place, axis=-1)
        values_there = values[rows]
        filled = np.abs(values_there[chord < 3 * cell]) > abs(peak) / 2
        if filled.mean() < 0.25:
            values_there[(chord < cell) & (np.abs(values_there) < abs(peak))] = peak
