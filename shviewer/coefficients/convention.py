"""Conventions: what one has to know of a list of spherical-harmonic coefficients to use it, and conversions.

Ours (basis.py): orthonormal, Condon-Shortley phase kept, z polar and up, right-handed, index l(l+1) + m. With c(l, m) our
coefficients of a function, those of another program are, step by step,
    quantity   times A(l) for irradiance (filters.py), then over pi where the program does not divide by pi itself;
    axes       the same function in the program's axes (axes.py);
    phase      times (-1)^m where the program's basis has no Condon-Shortley phase;
    scale      times f(l, m) of SCALES, since the program's basis functions are ours over f;
    index      c(l, m) at the index l(l+1) + m, or at l(l+1) - m;
    complex    c(l, +-m) of both signs of m as one complex number and its partner (SciPy).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.axes import Axes, alternating, mirrored_orders, orders, turn
from shviewer.harmonics.basis import Array, count_bands, degrees, normalisation
from shviewer.harmonics.filters import irradiance_factors, per_coefficient

RADIANCE, IRRADIANCE, OVER_PI = QUANTITIES = ("radiance", "irradiance", "irradiance-over-pi")
"""The quantities that coefficients can hold. The last is the radiance of a white Lambertian surface."""

POLYNOMIAL_BANDS = 3

UNREAL = 1e-6
"""How far complex coefficients may be from those of a real function, relative to the largest of them."""


def _orthonormal(n_bands: int) -> Array:
    return np.ones(n_bands**2)


def _four_pi(n_bands: int) -> Array:
    """The factors for basis functions of mean square 1, which are sqrt(4 pi) times ours."""
    return np.full(n_bands**2, 1 / np.sqrt(4 * np.pi))


def _sn3d(n_bands: int) -> Array:
    """The factors for ambisonics: integrals of the function with SN3D functions, which are ours times sqrt(4 pi/(2l+1))."""
    return np.sqrt(4 * np.pi / (2 * degrees(n_bands) + 1))


def _polynomial(n_bands: int) -> Array:
    """The factors for 1, y, z, x, xy, yz, 3z^2-1, xz and x^2-y^2: the coefficient holds the constant in front of each.

    ValueError for more than three bands.
    """
    if n_bands > POLYNOMIAL_BANDS:
        raise ValueError(f"{n_bands} bands: coefficients of polynomials are defined for 1 to {POLYNOMIAL_BANDS}")
    l, m = degrees(n_bands), np.abs(orders(n_bands))
    leading = np.array(
        [1.0, 1.0, 1.0, 1.0, 2.0, 1.0, 0.5, 1.0, 1.0]
    )  # Re, Im (x + iy)^2 are x^2-y^2, 2xy; P(2) = (3z^2-1)/2
    return np.asarray(np.abs(normalisation(n_bands)[l, m]) * leading[: n_bands**2])


SCALES: dict[str, Callable[[int], Array]] = {
    "orthonormal": _orthonormal,
    "4pi": _four_pi,
    "sn3d": _sn3d,
    "polynomial": _polynomial,
}
"""Normalisation -> the factors from our coefficients to theirs, (n_bands**2,)."""


@dataclass(frozen=True)
class Convention:
    """The convention of one program. The defaults are ours."""

    name: str = "shviewer"
    program: str = "shviewer"
    """The program that reads it, in words."""
    phase: bool = True
    """Whether the basis keeps the Condon-Shortley phase (-1)^m."""
    axes: Axes = field(default_factory=Axes)
    scale: str = "orthonormal"
    quantity: str | None = None
    """One of QUANTITIES; None if the program takes any, or if the file has to say."""
    mirrored: bool = False
    """Whether c(l, m) is stored at l(l+1) - m."""
    complex: bool = False
    most_bands: int | None = None
    filled_up: bool = False
    """Whether the program always has `most_bands` bands, so that fewer are filled up with zeros."""
    layout: str = "rows of red, green, blue"
    """How the program itself arranges the numbers."""

    @property
    def index(self) -> str:
        return f"l(l+1) {'-' if self.mirrored else '+'} m"

    @property
    def basis(self) -> str:
        kind = {
            "orthonormal": f"orthonormal {'complex' if self.complex else 'real'} spherical harmonics",
            "4pi": "4-pi-normalised real spherical harmonics (mean square 1)",
            "sn3d": "SN3D real spherical harmonics; the numbers are integrals with them",
            "polynomial": "1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2, their constants in the numbers",
        }
        return kind[self.scale]

    @property
    def phase_words(self) -> str:
        if self.scale == "polynomial":
            return "no phase: plain polynomials"
        return "Condon-Shortley phase kept" if self.phase else "no Condon-Shortley phase"

    def check_bands(self, n_bands: int) -> None:
        """ValueError for more bands than the program has."""
        if self.most_bands is not None and n_bands > self.most_bands:
            raise ValueError(f"{n_bands} bands: {self.name} takes 1 to {self.most_bands}; use fewer")

    def from_ours(self, coefficients: Array, quantity: str = RADIANCE) -> NDArray[np.generic]:
        """Our coefficients (n**2, k) of `quantity`, "radiance" or "irradiance" -> the program's, float64 or complex128.

        ValueError for too many bands, or if the program wants radiance and the irradiance given tells nothing of some degree.
        """
        n_bands = count_bands(coefficients)
        self.check_bands(n_bands)
        found = to_quantity(np.asarray(coefficients, dtype=np.float64), quantity, self.quantity or quantity)
        if self.filled_up and self.most_bands:
            found = np.pad(found, ((0, self.most_bands**2 - n_bands**2), (0, 0)))
            n_bands = self.most_bands
        found = turn(found, self.axes)
        if not self.phase:
            found = found * alternating(orders(n_bands))
        found = found * SCALES[self.scale](n_bands)[:, None]
        if self.mirrored:
            found = found[mirrored_orders(n_bands)]
        return to_complex(found) if self.complex else found + 0.0  # no negative zeros

    def to_ours(self, numbers: NDArray[np.generic]) -> Array:
        """The program's numbers (n**2, k) -> our coefficients of the same quantity; "irradiance-over-pi" becomes irradiance.

        ValueError for too many bands, or complex numbers that belong to no real function.
        """
        n_bands = count_bands(numbers)
        self.check_bands(n_bands)
        found = from_complex(numbers) if self.complex else np.asarray(numbers, dtype=np.float64)
        if self.mirrored:
            found = found[mirrored_orders(n_bands)]
        found = found / SCALES[self.scale](n_bands)[:, None]
        if not self.phase:
            found = found * alternating(orders(n_bands))
        found = turn(found, self.axes.inverse)
        return found * np.pi if self.quantity == OVER_PI else found

    def basis_factors(self, n_bands: int) -> Array:
        """The program's basis functions over Y(l, m) in its own axes, (n**2,), by our index.

        ValueError for complex coefficients.
        """
        if self.complex:
            raise ValueError(f"{self.name} has complex coefficients; choose a convention with real ones")
        phase = np.ones(n_bands**2) if self.phase else alternating(orders(n_bands))[:, 0]
        return np.asarray(phase / SCALES[self.scale](n_bands))

    def holding(self, quantity: str) -> Convention:
        return replace(self, quantity=quantity)


def to_quantity(coefficients: Array, held: str, wanted: str) -> Array:
    """Our coefficients of one quantity -> those of another. ValueError where A(l) = 0 hides the radiance."""
    n_bands = count_bands(coefficients)
    if held != RADIANCE and wanted == RADIANCE:
        factors = irradiance_factors(n_bands)
        if lost := [int(l) for l in range(n_bands) if l > 1 and l % 2]:
            raise ValueError(f"irradiance holds nothing of band {lost[0]} of the radiance; use at most {lost[0]} bands")
        coefficients = coefficients / per_coefficient(factors)
    elif held == RADIANCE and wanted != RADIANCE:
        coefficients = coefficients * per_coefficient(irradiance_factors(n_bands))
    if OVER_PI in (held, wanted) and held != wanted:
        coefficients = coefficients * (np.pi if held == OVER_PI else 1 / np.pi)
    return np.asarray(coefficients)


def recovered_radiance(irradiance: Array) -> tuple[Array, list[int]]:
    """Our coefficients of irradiance (n**2, k) -> those of a radiance with that irradiance, and the degrees that are lost.

    Lost are the odd degrees from 3 on, where A(l) = 0; their coefficients are returned as zero.
    """
    n_bands = count_bands(irradiance)
    lost = list(range(3, n_bands, 2))
    factors = irradiance_factors(n_bands)
    factors[lost] = np.inf
    return irradiance / per_coefficient(factors), lost


def to_complex(coefficients: Array) -> NDArray[np.complex128]:
    """Coefficients of complex functions: Y(l, m) and Y(l, -m), m > 0, are sqrt(2) times their real and imaginary parts."""
    n_bands = count_bands(coefficients)
    m, partner = orders(n_bands)[:, None], coefficients[mirrored_orders(n_bands)]
    positive = np.where(m > 0, coefficients - 1j * partner, partner + 1j * coefficients) / np.sqrt(2)
    signs = np.where(m < 0, alternating(orders(n_bands)), 1.0)
    return np.asarray(np.where(m == 0, coefficients, signs * positive), dtype=np.complex128)


def from_complex(numbers: NDArray[np.generic]) -> Array:
    """The inverse of `to_complex`. ValueError unless c(l, -m) = (-1)^m conj(c(l, m)), as for every real function."""
    values = np.asarray(numbers, dtype=np.complex128)
    n_bands = count_bands(values)
    partner = np.conj(values[mirrored_orders(n_bands)]) * alternating(orders(n_bands))
    if np.abs(values - partner).max() > UNREAL * np.abs(values).max():
        worst = int(np.abs(values - partner).max(axis=1).argmax())
        raise ValueError(
            f"row {worst} and its partner of the other m are not conjugate up to (-1)^m: these are not of a real function"
        )
    values, m = np.sqrt(2) * (values + partner) / 2, orders(n_bands)[:, None]
    imaginary = -values[mirrored_orders(n_bands)].imag
    return np.asarray(np.where(m > 0, values.real, np.where(m < 0, imaginary, values.real / np.sqrt(2))))
