"""Lobe profiles: functions of the angle to an axis, with closed-form coefficients at every band.

A profile f(x), x = direction . axis, has the coefficients c(l, m) = lambda(l) Y(l, m)(axis) with
lambda(l) = 2 pi integral of f(x) P(l)(x) dx over [-1, 1] (Funk-Hecke). Every profile here is written as a function of the
squared chord |direction - axis|^2 = 2 (1 - x), which keeps its digits where x is close to 1; shaders/lobes.glsl
holds the same four formulas.

With G(l, m) the Gegenbauer ratio of basis.py, integration by parts gives, for a support x > e = cos a,
    disc:            lambda(l) = pi sin(a)^2 G(l, 1)(e),             l >= 1
    clamped linear:  lambda(l) = (pi/4) s sin(a)^4 G(l, 2)(e),       l >= 2
which have none of the cancellation of the usual P(l-1) - P(l+1): the relative error is that of sin a for any cap.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from shviewer.harmonics.basis import Array, check_bands, evaluate_basis

LARGEST = 1e15
"""The largest slope, offset or sharpness: a lobe of sharpness 1e15 is only 3e-8 radians wide."""


class Profile(Protocol):
    """A rotationally symmetric function with peak value about 1, still to be multiplied by a radiance."""

    kind: ClassVar[int]
    """The profile's number in shaders/lobes.glsl."""

    @property
    def parameters(self) -> tuple[float, float]:
        """The numbers that the shader needs beside the kind."""

    @property
    def half_angle(self) -> float:
        """The profile vanishes beyond this angle from its axis, in radians; pi if nowhere."""

    def value(self, squared_chord: Array) -> Array:
        """The profile at |direction - axis|^2; same shape."""

    def zonal(self, n_bands: int) -> Array:
        """lambda(l) for l = 0 to n_bands-1, shape (n_bands,)."""

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        """Value, first and second derivative at angles to the axis in radians, and a bound of the fourth near each; all of the
        angles' shape.

        The value never rises with the angle.
        """

    def __hash__(self) -> int:
        """A hash, since tables of a profile are kept."""


@dataclass(frozen=True)
class Constant:
    """1 everywhere."""

    kind: ClassVar[int] = 0
    parameters: ClassVar[tuple[float, float]] = (0.0, 0.0)
    half_angle: ClassVar[float] = np.pi

    def value(self, squared_chord: Array) -> Array:
        return np.ones(np.shape(squared_chord))

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        nothing = np.zeros(np.shape(angle))
        return nothing + 1, nothing, nothing, nothing

    def zonal(self, n_bands: int) -> Array:
        return _leading(n_bands, 4 * np.pi)


@dataclass(frozen=True)
class ClampedLinear:
    """max(0, slope x - offset); a clamped cosine for slope 1 and offset 0. ValueError unless it is positive somewhere."""

    slope: float = 1.0
    offset: float = 0.0
    kind: ClassVar[int] = 1

    def __post_init__(self) -> None:
        if not (0 < self.slope <= LARGEST and self.offset < self.slope and abs(self.offset) <= LARGEST):
            raise ValueError(
                f"slope {self.slope:g}, offset {self.offset:g}: the slope must be positive, above the offset, and neither "
                f"beyond {LARGEST:g}"
            )

    @property
    def parameters(self) -> tuple[float, float]:
        return self.slope, self.offset

    @property
    def half_angle(self) -> float:
        return float(2 * np.arcsin(np.sqrt(min(1.0, (self.slope - self.offset) / (2 * self.slope)))))

    def value(self, squared_chord: Array) -> Array:
        return np.asarray(np.maximum(0, (self.slope - self.offset) - self.slope / 2 * squared_chord))

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        lit = np.asarray(self.slope * (angle <= self.half_angle))
        return self.value(_squared_chord(angle)), -lit * np.sin(angle), -lit * np.cos(angle), lit

    def zonal(self, n_bands: int) -> Array:
        if self.offset <= -self.slope:  # nowhere clamped
            return _leading(n_bands, -4 * np.pi * self.offset, 4 * np.pi / 3 * self.slope)
        edge = self.offset / self.slope
        height = (self.slope - self.offset) / self.slope  # 1 - edge, without its rounding
        sine_4 = (height * (1 + edge)) ** 2
        zonal = np.pi / 4 * self.slope * sine_4 * gegenbauer_ratios(edge, height, 2, n_bands)
        zonal[:2] = np.array([np.pi, np.pi / 3 * (2 + edge)])[:n_bands] * self.slope * height**2
        return zonal


@dataclass(frozen=True)
class Disc:
    """1 within `half_angle` radians of the axis, 0 beyond. ValueError unless 0 < half_angle <= pi."""

    half_angle: float
    kind: ClassVar[int] = 2

    def __post_init__(self) -> None:
        if not 0 < self.half_angle <= np.pi:
            raise ValueError(f"half angle {np.degrees(self.half_angle):g} degrees: it must be above 0 and at most 180")

    @property
    def parameters(self) -> tuple[float, float]:
        return float(4 * np.sin(self.half_angle / 2) ** 2), 0.0

    def value(self, squared_chord: Array) -> Array:
        return np.asarray(np.less_equal(squared_chord, self.parameters[0]), dtype=np.float64)

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        nothing = np.zeros(np.shape(angle))
        return self.value(_squared_chord(angle)), nothing, nothing, nothing

    def zonal(self, n_bands: int) -> Array:
        versine = 2 * np.sin(self.half_angle / 2) ** 2
        sine_2 = np.sin(self.half_angle) ** 2
        zonal: Array = np.pi * sine_2 * gegenbauer_ratios(np.cos(self.half_angle), versine, 1, n_bands)
        zonal[0] = 2 * np.pi * versine
        return zonal


@dataclass(frozen=True)
class Gaussian:
    """exp(sharpness (x - 1)), a spherical Gaussian. ValueError unless 0 < sharpness < infinity."""

    sharpness: float
    kind: ClassVar[int] = 3
    half_angle: ClassVar[float] = np.pi

    def __post_init__(self) -> None:
        if not 1 / LARGEST <= self.sharpness <= LARGEST:
            raise ValueError(f"sharpness {self.sharpness:g}: it must be {1 / LARGEST:g} to {LARGEST:g}")

    @property
    def parameters(self) -> tuple[float, float]:
        return self.sharpness, 0.0

    def value(self, squared_chord: Array) -> Array:
        return np.asarray(np.exp(-self.sharpness / 2 * squared_chord))

    def along(self, angle: Array) -> tuple[Array, Array, Array, Array]:
        k, value, sine = self.sharpness, self.value(_squared_chord(angle)), np.sin(angle)
        # with t = sqrt(k) angle the fourth derivative is below k^2 (t^4 + 6 t^2 + 3 + ...) exp(-t^2/2) < 4 k^2 exp(-t^2/4)
        return value, -k * sine * value, k * (k * sine * sine - np.cos(angle)) * value, 4 * k * (k + 1) * np.sqrt(value)

    def zonal(self, n_bands: int) -> Array:
        """lambda(l)/lambda(l-1) is a ratio of modified spherical Bessel functions; its recurrence [DLMF 10.51.4]

        r(l) = 1 / ((2l+1)/k + r(l+1)) is stable downwards, from any start far enough above n_bands.
        """
        check_bands(n_bands)
        k = self.sharpness
        start = n_bands + 40 + int(10 * np.sqrt(min(k, 1e8)))
        slope = (2 * start + 2) / k
        ratio = 2 / (slope + np.sqrt(slope**2 + 4))  # the recurrence's fixed point, exact to 1/k**2: enough for k > 1e8
        ratios = np.ones(n_bands)
        for l in range(start, 0, -1):
            ratio = 1 / ((2 * l + 1) / k + ratio)
            if l < n_bands:
                ratios[l] = ratio
        return np.asarray(-2 * np.pi * np.expm1(-2 * k) / k * np.cumprod(ratios))


def _squared_chord(angle: Array) -> Array:
    return np.asarray(4 * np.sin(angle / 2) ** 2)


def gegenbauer_ratios(z: float, one_minus_z: float, m: int, n_bands: int) -> Array:
    """G(l, m)(z) of basis.py for l = 0 to n_bands-1, zero for l < m.

    `one_minus_z` is 1 - z as accurately as the caller has it: for a tiny cap, z itself has lost those digits.
    """
    check_bands(n_bands)
    delta = one_minus_z if z >= 0 else 1 + z
    ratios = np.zeros(n_bands)
    ratio, difference = 1.0, 0.0
    for l in range(m, n_bands):
        if l > m:
            difference = (2 * l - 1) / (l + m) * (difference - delta * ratio) - difference
            ratio += difference
        ratios[l] = ratio if z >= 0 or (l + m) % 2 == 0 else -ratio
    return ratios


def orient(zonal: Array, axis: Array) -> Array:
    """Coefficients of profiles about their axes: zonal (..., n_bands), axis (..., 3) -> (..., n_bands**2)."""
    n_bands = zonal.shape[-1]
    return np.asarray(np.repeat(zonal, 2 * np.arange(n_bands) + 1, axis=-1) * evaluate_basis(axis, n_bands))


def _leading(n_bands: int, *values: float) -> Array:
    """`values` followed by zeros, cut to n_bands."""
    check_bands(n_bands)
    zonal = np.zeros(max(n_bands, len(values)))
    zonal[: len(values)] = values
    return zonal[:n_bands]
