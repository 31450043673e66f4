"""Conventions: what one has to know of a list of spherical-harmonic coefficients to use it, and conversions.

Ours (basis.py): orthonormal, Condon-Shortley phase kept, z polar and up, right-handed, index l(l+1) + m. With c(l, m) our
coefficients of a function, those of another program are, step by step,
    quantity   times A(l) for irradiance (filters.py), then over pi where the program does not divide by pi itself; times f(l)
               for a glossy quantity (glossy.py);
    axes       the same function in the program's axes (axes.py);
    phase      times (-1)^m where the program's basis has no Condon-Shortley phase;
    scale      times f(l, m) of SCALES (scales.py), since the program's basis functions are ours over f;
    shift      the first row less by what the program adds to the sum;
    index      c(l, m) at the index l(l+1) + m, or at l(l+1) - m, and these rows in another order (rows.py);
    list       times a factor, and the channels in another order (channels.py), where a list has such mistakes;
    complex    c(l, +-m) of both signs of m as one complex number and its partner (SciPy).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.parts.axes import Axes, alternating, mirrored_orders, turn
from shviewer.coefficients.parts.channels import RGB, channel_places
from shviewer.coefficients.parts.quantities import is_over_pi, to_quantity
from shviewer.coefficients.parts.rows import ACN, ORDERS, Order, row_order
from shviewer.coefficients.parts.scales import SCALES
from shviewer.harmonics.basis import Array, count_bands, orders
from shviewer.harmonics.quantities.names import RADIANCE

UNREAL = 1e-6
"""How far complex coefficients may be from those of a real function, relative to the largest of them."""


@dataclass(frozen=True)
class Convention:
    """The convention of one program. The defaults are ours."""

    name: str = "shviewer"
    program: str = "shviewer"
    """The program that reads it, in words."""
    phase: bool = True
    """Whether the basis keeps the Condon-Shortley phase (-1)^m."""
    axes: Axes = field(default_factory=Axes)
    pole: Axes = field(default_factory=Axes)
    """Which of the program's axes are x, y and z of its basis, if z is not its polar axis."""
    scale: str = "orthonormal"
    quantity: str | None = None
    """One of QUANTITIES, or a glossy one; None if the program takes any, or if the file has to say."""
    mirrored: bool = False
    """Whether c(l, m) is stored at l(l+1) - m."""
    complex: bool = False
    order: str = ACN
    """The order of the rows, one of ORDERS."""
    shift: float = 0.0
    """What the program adds to the sum of its basis functions: the mean of the function that its first row lacks."""
    channels: str = RGB
    """The order of the columns, one of CHANNEL_ORDERS."""
    sequence: str = ""
    """How a list is read: "" as it stands, one of SEQUENCES, or FLAT_BY_CHANNEL. What is written are rows."""
    factor: float = 1.0
    """The numbers are so many times those of the rest of the convention."""
    most_bands: int | None = None
    fewest_bands: int = 1
    """The fewest bands that the program has; fewer are filled up with zeros."""
    layout: str = "rows of red, green, blue"
    """How the program itself arranges the numbers."""

    @property
    def index(self) -> str:
        words = ORDERS[self.order][1]
        if not self.mirrored:
            return words
        return "l(l+1) - m" if self.order == ACN else f"{words}, with m and -m swapped"

    @property
    def basis(self) -> str:
        words = SCALES[self.scale][1].replace("real", "complex") if self.complex else SCALES[self.scale][1]
        if self.pole != Axes():
            words += f" about {self.pole.text[-1]}"
        return f"{self.shift:g} + {words}" if self.shift else words

    @property
    def basis_axes(self) -> Axes:
        """The axes of the basis, in ours."""
        return self.axes.then(self.pole)

    @property
    def phase_words(self) -> str:
        if self.scale == "polynomial":
            return "no phase: plain polynomials"
        return "Condon-Shortley phase kept" if self.phase else "no Condon-Shortley phase"

    def check_bands(self, n_bands: int) -> None:
        """ValueError for more bands than the program has."""
        if self.most_bands is not None and n_bands > self.most_bands:
            raise ValueError(f"{n_bands} bands: {self.name} takes 1 to {self.most_bands}; use fewer")

    def rows(self, n_bands: int) -> Order:
        """The index l(l+1) + m of our coefficient in each row, (n_bands**2,). ValueError for more than the order has."""
        order = row_order(self.order, n_bands)
        return np.asarray(mirrored_orders(n_bands)[order]) if self.mirrored else order

    def from_ours(self, coefficients: Array, quantity: str = RADIANCE) -> NDArray[np.generic]:
        """Our coefficients (n**2, k) of `quantity`, such as "radiance" -> the program's, float64 or complex128.

        ValueError for too many bands, or if the program wants radiance and the irradiance given tells nothing of some degree,
        or wants another quantity than a glossy one that is given.
        """
        n_bands = count_bands(coefficients)
        self.check_bands(n_bands)
        found = to_quantity(np.asarray(coefficients, dtype=np.float64), quantity, self.quantity or quantity)
        if n_bands < self.fewest_bands:
            found = np.pad(found, ((0, self.fewest_bands**2 - n_bands**2), (0, 0)))
            n_bands = self.fewest_bands
        found = turn(found, self.basis_axes)
        if not self.phase:
            found = found * alternating(orders(n_bands))
        found = found * self._scale(n_bands)[:, None]
        found[0] -= self._shift
        found = self.factor * found[self.rows(n_bands)]
        if self.channels != RGB:
            found = found[:, channel_places(self.channels)]
        return to_complex(found) if self.complex else found + 0.0  # no negative zeros

    def to_ours(self, numbers: NDArray[np.generic]) -> Array:
        """The program's numbers (n**2, k) -> our coefficients of the same quantity, no longer divided by pi.

        ValueError for too many bands, or complex numbers that belong to no real function.
        """
        n_bands = count_bands(numbers)
        self.check_bands(n_bands)
        listed = from_complex(numbers) if self.complex else np.asarray(numbers, dtype=np.float64)
        if self.channels != RGB:
            listed = listed[:, np.argsort(channel_places(self.channels))]
        found = np.empty_like(listed)
        found[self.rows(n_bands)] = listed / self.factor
        found[0] += self._shift
        found = found / self._scale(n_bands)[:, None]
        if not self.phase:
            found = found * alternating(orders(n_bands))
        found = turn(found, self.basis_axes.inverse)
        return found * np.pi if is_over_pi(self.quantity) else found

    @property
    def _shift(self) -> float:
        """The shift in units of the first row: that of the constant function 1, which is sqrt(4 pi) times Y(0, 0)."""
        return float(self.shift * np.sqrt(4 * np.pi) * self._scale(1)[0])

    def _scale(self, n_bands: int) -> Array:
        return SCALES[self.scale][0](n_bands)

    def basis_factors(self, n_bands: int) -> Array:
        """The program's basis functions over Y(l, m) in the axes of its basis, (n**2,), by our index.

        ValueError for complex coefficients.
        """
        if self.complex:
            raise ValueError(f"{self.name} has complex coefficients; choose a convention with real ones")
        phase = np.ones(n_bands**2) if self.phase else alternating(orders(n_bands))[:, 0]
        return np.asarray(phase / self._scale(n_bands))


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
            f"row {worst} and its partner of the other m are not conjugate up to (-1)^m: one of them is wrong, or these are "
            "not of a real function"
        )
    values, m = np.sqrt(2) * (values + partner) / 2, orders(n_bands)[:, None]
    imaginary = -values[mirrored_orders(n_bands)].imag
    return np.asarray(np.where(m > 0, values.real, np.where(m < 0, imaginary, values.real / np.sqrt(2))))
