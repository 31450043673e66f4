"""Functions whose integrals are known in closed form, and how far what a FunctionLight says of them is from the truth.

Every integral follows from two facts, and none from the code under test: the integral of g(d . a) is 2 pi times that of
g(x) over -1 <= x <= 1 (Archimedes), and bands of a sum of zonal functions about axes a_i hold the sum over i, j of
(2l+1)/(4 pi) lambda_i(l) lambda_j(l) P_l(a_i . a_j) (addition theorem), lambda(l) = 2 pi times the integral of g(x) P_l(x).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.special import beta, eval_legendre, gammaln

from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.lights.function import FunctionLight

Function = Callable[[np.ndarray], np.ndarray]
BANDS = (1, 4, 16, 64, 128)
FLOOR = 2e-7
"""The square root of some 1e-14: errors come from a difference of squares of relative rounding 1e-16, 128 bands of them."""

RULES = {nodes: np.polynomial.legendre.leggauss(nodes) for nodes in (600, 2500)}
"""The second is for waves."""


@dataclass(frozen=True)
class Case:
    """A grey function: its integral, that of its magnitude and of its square, and relative L2 errors for some band counts."""

    name: str
    function: Function
    flux: float
    magnitude: float
    energy: float
    errors: dict[int, float]
    narrowest: float = 180.0
    """The width in degrees of its narrowest feature."""
    smooth: bool = False


class Verdict(NamedTuple):
    error: float
    stated: float
    said: bool
    """Whether a note says that the figures are uncertain."""
    silent: bool
    """Whether the error is more than three times what is stated and no note says so."""


class Disc(NamedTuple):
    """The zonal function that is `radiance` within `half_angle` degrees of `axis`."""

    axis: np.ndarray
    half_angle: float
    radiance: float

    @property
    def chord2(self) -> float:
        return 4 * float(np.sin(np.radians(self.half_angle) / 2)) ** 2

    def __call__(self, d: np.ndarray) -> np.ndarray:
        return self.radiance * (((d - self.axis) ** 2).sum(axis=1) < self.chord2)

    def zonal(self, n: int) -> np.ndarray:
        """lambda(l): the integral of P_l from x0 to 1 is (P_(l-1)(x0) - P_(l+1)(x0)) / (2l+1)."""
        l, x0 = np.arange(n), 1 - self.chord2 / 2
        below = np.where(l > 0, eval_legendre(np.maximum(l - 1, 0), x0), 1.0)
        parts = (below - eval_legendre(l + 1, x0)) / (2 * l + 1)
        parts[0] = self.chord2 / 2
        return 2 * np.pi * self.radiance * parts


def direction(rng: np.random.Generator) -> np.ndarray:
    vector = rng.standard_normal(3)
    return vector / np.linalg.norm(vector)


def discs(name: str, sky: float, *suns: Disc, narrowest: float | None = None) -> Case:
    """Discs that do not overlap, or of which one lies inside another about the same axis, over a constant sky."""
    areas = [2 * np.pi * sun.chord2 / 2 for sun in suns]
    flux = 4 * np.pi * sky + sum(sun.radiance * area for sun, area in zip(suns, areas, strict=True))
    energy = 4 * np.pi * sky**2 + sum(2 * sky * s.radiance * a for s, a in zip(suns, areas, strict=True))
    for one in suns:
        for two in suns:
            nested = np.allclose(one.axis, two.axis)
            common = 2 * np.pi * min(one.chord2, two.chord2) / 2 if nested else 0.0
            energy += one.radiance * two.radiance * common
    zonal = [sun.zonal(max(BANDS)) for sun in suns]
    l = np.arange(max(BANDS))
    power = np.zeros(len(l))
    for one, first in zip(suns, zonal, strict=True):
        for two, second in zip(suns, zonal, strict=True):
            power += (2 * l + 1) / (4 * np.pi) * first * second * eval_legendre(l, min(1.0, one.axis @ two.axis))
    power[0] = flux**2 / (4 * np.pi)
    kept = np.cumsum(power)
    errors = {n: float(np.sqrt(max(0.0, 1 - kept[n - 1] / energy))) for n in BANDS}

    def function(d: np.ndarray) -> np.ndarray:
        return sky + sum(sun(d) for sun in suns)

    width = min(2 * sun.half_angle for sun in suns) if narrowest is None else narrowest
    return Case(name, function, flux, flux, energy, errors, width)


def zonal(
    name: str, axis: np.ndarray, g: Function, *, knots: tuple[float, ...] = (), nodes: int = 600, **about: object
) -> Case:
    """g(d . axis), by Gauss-Legendre in x between the knots with so many points that nothing is left to chance."""
    x, w = RULES[nodes]
    ends = [-1.0, *knots, 1.0]
    places = np.concatenate([(a + b) / 2 + (b - a) / 2 * x for a, b in pairwise(ends)])
    weights = np.concatenate([(b - a) / 2 * w for a, b in pairwise(ends)])
    values = g(places)
    flux, magnitude, energy = (2 * np.pi * float(weights @ part) for part in (values, np.abs(values), values**2))
    l = np.arange(max(BANDS))
    power = (2 * l + 1) * np.pi * ((weights * values) @ np.polynomial.legendre.legvander(places, l[-1])) ** 2
    kept = np.cumsum(power)
    errors = {n: float(np.sqrt(max(0.0, 1 - kept[n - 1] / energy))) for n in BANDS}
    return Case(name, lambda d: g(np.clip(d @ axis, -1, 1)), flux, magnitude, energy, errors, **about)


def integrals(name: str, function: Function, flux: float, magnitude: float, energy: float, **about: object) -> Case:
    return Case(name, function, flux, magnitude, energy, {}, **about)


def azimuth(d: np.ndarray) -> np.ndarray:
    return np.arctan2(d[:, 1], d[:, 0])


def turned(rng: np.random.Generator) -> np.ndarray:
    return np.linalg.qr(rng.standard_normal((3, 3)))[0]


def step(at: float) -> Function:
    return lambda x: (x > at) * 1.0


def lobe(sharpness: float) -> Function:
    return lambda x: np.exp(sharpness * (x - 1))


def clamped(power: float) -> Function:
    return lambda x: np.maximum(x, 0) ** power


def sine(k: int) -> Function:
    return lambda x: np.sin(k * x) + 0.3


def disc_in_lobe(edge: float, sharpness: float) -> Function:
    return lambda x: np.exp(sharpness * (x - 1)) + 1e3 * (x > edge)


def wave(k: int) -> Function:
    return lambda d: 1 + np.cos(k * azimuth(d))


def sectoral(k: int, power: int) -> Function:
    return lambda d: np.hypot(d[:, 0], d[:, 1]) ** power * np.cos(k * azimuth(d))


def board(frame: np.ndarray, across: int, down: int) -> Function:
    def function(d: np.ndarray) -> np.ndarray:
        e = d @ frame
        column = np.floor(azimuth(e) * across / np.pi)
        row = np.floor(np.arccos(np.clip(e[:, 2], -1, 1)) * down / np.pi)
        return 1.0 * ((column + row) % 2 == 0)

    return function


WAVES = "1 2 3 5 8 16 31 64 100 128 160 200 320 333 512 640 777 1000 1024 1280 1500 1920 2000"
BOARDS = "2x2 4x3 9x4 16x16 30x15 45x20 64x64 100x50 180x90 500x250"


def suite(seed: int = 0) -> Iterator[Case]:
    """All cases; another seed gives other directions."""
    rng = np.random.default_rng(seed)
    for half_angle in (0.05, 0.1, 0.15, 0.2, 0.27, 0.27, 0.35, 0.5, 1.0, 2.0, 5.0):
        for ratio in (1.5, 10.0, 1e3, 1e6):
            for _ in range(2):
                sun = Disc(direction(rng), half_angle, 0.1 * (ratio - 1))
                yield discs(f"sun of {half_angle} degrees, {ratio:g} times the sky", 0.1, sun)
    for axis in (*np.eye(3), -np.eye(3)[2]):
        for half_angle in (0.27, 20.0):
            yield discs(f"disc of {half_angle} degrees about {axis}", 0.1, Disc(axis, half_angle, 100.0))
    for _ in range(6):
        suns = [Disc(direction(rng), 0.27, 0.1 * 10 ** rng.uniform(2, 6)) for _ in range(2)]
        yield discs("two suns", 0.1, *suns)
    for width in (0.3, 0.6, 1.0, 3.0, 5.0):
        for _ in range(3):
            axis, inner = direction(rng), rng.uniform(2, 80)
            ring = [Disc(axis, inner + width, 5.0), Disc(axis, inner, -5.0)]
            yield discs(f"ring {width} degrees wide", 0.5, *ring, narrowest=width)
    for _ in range(12):
        at = rng.uniform(-0.9, 0.9)
        yield zonal("slanted edge", direction(rng), step(at), knots=(at,))
    for at in (-0.3, 0.0, 0.1, 0.5):
        for axis in np.eye(3):
            yield zonal(f"edge at {at} along {axis}", axis, step(at), knots=(at,))
    for sharpness in (0.5, 1, 2, 5, 10, 30, 100, 300, 1000, 3000, 1e4, 1e5):
        name, knots = f"lobe of sharpness {sharpness:g}", (1 - min(1.9, 40 / sharpness),)
        yield zonal(name, direction(rng), lobe(sharpness), knots=knots, smooth=sharpness <= 1000)
    for power in (0.5, 1, 2, 3, 5):
        for _ in range(2):
            yield zonal(f"clamped cosine to the {power}", direction(rng), clamped(power), knots=(0.0, 1e-3))
    for k in (3, 10, 40, 100, 200, 500, 1000, 2000):
        yield zonal(f"sin({k} x)", direction(rng), sine(k), nodes=2500, narrowest=180 / k, smooth=k <= 40)
    for k in map(int, WAVES.split()):
        yield integrals(f"1 + cos({k} phi)", wave(k), 4 * np.pi, 4 * np.pi, 6 * np.pi)
    for k, p in ((2, 4), (8, 8), (30, 30), (64, 3), (128, 1), (500, 2), (640, 1), (2000, 4)):
        # the square of sin(theta)^p integrates to 2 pi B(p + 1, 1/2), and half of that with cos(k phi)^2
        energy = float(np.pi * beta(p + 1, 0.5))
        yield integrals(f"sin^{p} cos({k} phi)", sectoral(k, p), 0.0, 4 * float(beta(p / 2 + 1, 0.5)), energy)
    for text in BOARDS.split():
        across, down = map(int, text.split("x"))
        for frame in (np.eye(3), turned(rng)):
            function = board(frame, across, down)
            yield integrals(f"checkerboard {2 * across} x {down}", function, 2 * np.pi, 2 * np.pi, 2 * np.pi)
    for powers in ((2, 0, 0), (2, 2, 2), (4, 2, 0), (10, 6, 2), (20, 20, 20), (40, 2, 40)):
        yield integrals(f"x^{powers[0]} y^{powers[1]} z^{powers[2]}", *monomial(powers), smooth=True)
    for half_angle, sharpness in ((0.27, 2), (0.27, 30), (1, 5), (3, 2), (0.5, 200)):
        for _ in range(2):
            name, edge = f"disc of {half_angle} in a lobe of {sharpness}", float(np.cos(np.radians(half_angle)))
            function = disc_in_lobe(edge, sharpness)
            yield zonal(name, direction(rng), function, knots=(edge,), narrowest=2 * half_angle)


def monomial(powers: tuple[int, ...]) -> tuple[Function, float, float, float]:
    """Even powers: the integral is 2 G(a) G(b) G(c) / G(a + b + c), a = (power + 1) / 2 [Folland, Am. Math. Monthly 108]."""

    def integral(exponents: np.ndarray) -> float:
        half = (exponents + 1) / 2
        return float(2 * np.exp(gammaln(half).sum() - gammaln(half.sum())))

    exponents = np.array(powers)
    scale = 1 / integral(exponents)
    function = lambda d: scale * np.prod(d**exponents, axis=1)  # noqa: E731
    return function, 1.0, 1.0, scale**2 * integral(2 * exponents)


def judge(case: Case) -> Verdict:
    """Compare everything that is known of a case with what its light says."""
    light = FunctionLight(case.function, case.name)
    coefficients, products = light.coefficients(128), light.products()
    found = [
        abs(coefficients[0, 0] * np.sqrt(4 * np.pi) - case.flux) / case.magnitude,
        abs(np.sqrt(products[0, 0] / case.energy) - 1),
    ]
    errors = errors_by_band_count(products, coefficients, coefficients)
    found += [abs(errors[n - 1] - wanted) for n, wanted in case.errors.items()]
    error, stated = float(max(found)), light.accuracy()
    return Verdict(error, stated, bool(light.notes), error > 3 * max(stated, FLOOR) and not light.notes)
