"""Hard cases of sampling and weighting: the paper's jittered samples, quadrature rules, windows and zonal factors."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from decimal import Decimal
from fractions import Fraction
from functools import partial
from math import pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from shviewer.benchmark.hard_cases import exact
from shviewer.benchmark.hard_cases.evaluation import generic, towards
from shviewer.benchmark.hard_cases.outcome import Case, largest, worst
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.filters import window
from shviewer.harmonics.projection.rows import project_product
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import DirectionSet, fejer, fibonacci, gauss_legendre, jittered, uniform_random
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import ClampedLinear, Gaussian

SIDE = 300
LIMIT = 4.0
"""Standard deviations that a statistic of fixed samples may be off; a wrong sampler is off by tens."""

Sampler = Callable[[int, int], DirectionSet]


def stratified(sampler: Sampler = jittered) -> float:
    """SIDE^2 jittered samples: one in each cell, uniform in it, both coordinates independent, other seeds other samples.

    u = (1 - z)/2 and v = phi/2 pi are uniform. Statistics in units of LIMIT standard deviations; a cell without its
    sample counts as one, too. Bound: 1.
    """
    cells = []
    for seed in (0, 1):
        found = sampler(SIDE**2, seed)
        x, y, z = found.directions.T
        cells.append(SIDE * np.stack([(1 - z) / 2, np.arctan2(y, x) / (2 * pi) % 1]))
    numbers, places = np.floor(cells[0]).astype(int), cells[0] % 1
    other = cells[1] % 1
    if not np.array_equal(np.sort(numbers[0] * SIDE + numbers[1]), np.arange(SIDE**2)):
        return np.inf
    spread = [places - 0.5, places**2 - 1 / 3, places[0] * places[1] - 0.25, places * other - 0.25]
    off = [np.abs(part.mean(axis=-1)).max() / (part.std() / SIDE) for part in spread]
    neighbours = np.corrcoef(places[0, :-1], places[0, 1:])[0, 1] * SIDE
    weights = largest(found.weights * SIDE**2 / (4 * pi) - 1) / 1e-12
    return float(max(*off, abs(neighbours), weights) / LIMIT)


def independent(sampler: Sampler = uniform_random) -> float:
    """The same of points that are independent: their moments, in units of LIMIT standard deviations. Bound: 1."""
    found = sampler(SIDE**2, 3)
    x, y, z = found.directions.T
    moments = {0.0: (x, y, z, x * y, y * z, z * x), 1 / 3: (x * x, y * y, z * z), 1 / 5: (z**4,)}
    off = [abs(part.mean() - mean) / part.std() * SIDE for mean, parts in moments.items() for part in parts]
    return float(max(*off, largest(found.weights * SIDE**2 / (4 * pi) - 1) / 1e-12) / LIMIT)


def spiral() -> float:
    """The golden spiral: sum of z^2 = (N^2 - 1)/3 N, and turns of 2 pi/g between neighbours. Bound: 1e-9, azimuths mod 2 pi."""
    n = 20_001
    found = fibonacci(n)
    x, y, z = found.directions.T
    turns = np.diff(np.arctan2(y, x)) / (2 * pi) - 2 / (1 + sqrt(5))
    sums = np.array([found.weights.sum() / (4 * pi) - 1, z.mean(), (z * z).mean() * 3 / (1 - 1 / n**2) - 1])
    return max(largest(sums), largest(turns - np.round(turns)), largest(np.linalg.norm(found.directions, axis=1) - 1))


@worst
def rules() -> Iterator[ArrayLike]:
    """Gauss-Legendre and Fejer rules against the integrals of z^k, 4 pi/(k+1) for even k, as far as each is exact.

    Columns are equidistant, so that e^(im phi) adds up to nothing; the first is next to +-pi. Bound: 1e-14, rounding.
    """
    for rows in (1, 2, 5, 16, 33):
        for make, degree in ((gauss_legendre, 2 * rows - 1), (fejer, rows - 1)):
            rule = make(2 * rows**2)
            for k in range(degree + 1):
                wanted = 0 if k % 2 else 2 / (k + 1)
                yield rule.row_weights @ np.cos(rule.theta) ** k - wanted
            yield np.abs(np.exp(1j * np.arange(1, 2 * rows) * rule.phi[:, None]).mean(axis=0))
            yield rule.phi[0] - pi * (1 - 1 / (2 * rows))


def rough(directions: Array) -> Array:
    return np.asarray(np.sin(40 * directions) + 0.3)


def scattered(n_bands: int) -> float:
    """12 347 samples everywhere, of random weights and a rough radiance, against the plain sum with `evaluate_basis`.

    Relative to the sum of magnitudes. Bound: 1e-13, that of `project_samples`. There are blocks, and the last is not full.
    """
    directions = generic(12_347)
    weights = np.random.default_rng(5).random(len(directions))
    found = project_samples(rough, DirectionSet(directions, weights), n_bands)
    plain = evaluate_basis(directions, n_bands).T @ (weights[:, None] * rough(directions))
    return largest(found - plain) / float(np.abs(weights[:, None] * rough(directions)).sum())


@worst
def projected_on_rules(n: int) -> Iterator[Array]:
    """A sum of n bands of noise, projected by rules of even and odd rows that are exact for them, and their products.

    Bound: 1e-12, rounding of sums over up to 12 000 points.
    """
    coefficients = np.random.default_rng(8).normal(size=(n * n, 3))
    exact_for = gauss_legendre(2 * n**2), gauss_legendre(2 * (n + 1) ** 2), fejer(2 * (2 * n - 1) ** 2), fejer(8 * n**2)
    for rule in exact_for:
        found, products = project_product(lambda d: evaluate_basis(d, n) @ coefficients, rule, n)
        yield found - coefficients
        yield (products - coefficients.T @ coefficients) / n**2


def sums_on_rows() -> float:
    """A sum of 40 bands of noise on rows, and from pole to pole, against the plain sum. Bound: 1e-12 of the largest."""
    coefficients = np.random.default_rng(6).normal(size=(1600, 3))
    synthesis = Synthesis(coefficients)
    theta, columns = np.array([0.0, 1e-9, 0.3, 1.5, 3.0, pi]), 97
    phi = pi * (1 - (2 * np.arange(columns) + 1) / columns)
    places = towards(theta[:, None], phi)
    wanted = evaluate_basis(places, 40) @ coefficients
    on_rows = synthesis.on_rows(theta, columns).transpose(0, 2, 1)
    apart = synthesis.in_directions(places.reshape(-1, 3)).reshape(wanted.shape)
    return max(largest(on_rows - wanted), largest(apart - wanted)) / float(np.abs(wanted).max())


@exact.in_many_digits
@worst
def windows() -> Iterator[float]:
    """Every window to l = 24 at several widths. Bound: 1e-15, a few roundings; sin and cos as series, exp in decimals."""
    for width in (Decimal(3), Decimal("7.5"), Decimal(16)):
        found = {name: window(name, 25, float(width)) for name in ("hann", "lanczos", "gauss")}
        for l in range(25):
            x = exact.PI * l / width
            inside = l < width
            wanted = {
                "hann": (1 + exact.cosine(x)) / 2 if inside else Decimal(0),
                "lanczos": (exact.cosine(x - exact.PI / 2) / x if l else Decimal(1)) if inside else Decimal(0),
                "gauss": (-x * x / 2).exp(),
            }
            yield from (float(found[name][l]) - float(value) for name, value in wanted.items())


@worst
def clamped_linear() -> Iterator[float]:
    """lambda(l) of max(0, x - e) to l = 20 against exact integrals of polynomials, relative to pi. Bound: 2e-14.

    e = -2 is nowhere clamped, -1/2 and 1/4 are, 7/8 is narrow; integrals of P(l)(x) (x - e) as fractions.
    """
    polynomials = [[Fraction(1)], [Fraction(0), Fraction(1)]]
    for l in range(2, 21):
        before, last = polynomials[-2], polynomials[-1]
        up, low = [Fraction(0), *last], [*before, Fraction(0), Fraction(0)]
        polynomials.append([((2 * l - 1) * a - (l - 1) * b) / l for a, b in zip(up, low, strict=True)])
    for e in (Fraction(-2), Fraction(-1, 2), Fraction(0), Fraction(1, 4), Fraction(7, 8)):
        found = ClampedLinear(1.0, float(e)).zonal(21)
        start = max(e, Fraction(-1))
        for l, polynomial in enumerate(polynomials):
            none = Fraction(0)
            terms = enumerate(zip([*polynomial, none], [none, *polynomial], strict=True))
            # of x^k: the coefficient of x P(l), and -e times that of P(l)
            wanted = sum((rise - e * flat) * (1 - start ** (k + 1)) / (k + 1) for k, (flat, rise) in terms)
            yield (float(found[l]) - 2 * pi * float(wanted)) / pi


@exact.in_many_digits
@worst
def gaussians() -> Iterator[Array]:
    """lambda(0), lambda(1) and lambda(2) of exp(k (x - 1)), k = 1/8 to 1e4, relative: 2 pi (1 - exp(-2k))/k, times
    coth k - 1/k, or 1 - 3 (coth k - 1/k)/k. Bound: 1e-14, the steps of the recurrence.
    """
    for k in map(Decimal, ("0.125", "1", "20", "10000")):
        tail = (-2 * k).exp()
        first = 2 * exact.PI * (1 - tail) / k
        slope = (1 + tail) / (1 - tail) - 1 / k
        wanted = [float(part) for part in (first, first * slope, first * (1 - 3 * slope / k))]
        yield Gaussian(float(k)).zonal(3) / np.array(wanted) - 1


STATISTICS = f"uniform and independent, in {LIMIT:g} deviations"

CASES = (
    Case("jittered samples, 300 x 300 cells", STATISTICS, 1.0, stratified),
    Case("independent samples", STATISTICS, 1.0, independent),
    Case("golden spiral", "closed form", 1e-9, spiral),
    Case("Gauss-Legendre and Fejer, every moment", "2/(k+1)", 1e-14, rules),
    *(Case(f"scattered samples, {n} bands", "plain sums", 1e-13, partial(scattered, n)) for n in (4, 7, 33)),
    Case(
        "9 and 40 bands projected by exact rules",
        "the same numbers",
        1e-12,
        lambda: max(map(projected_on_rules, (9, 40))),
    ),
    Case("sums of 40 bands on rows", "plain sums", 1e-12, sums_on_rows),
    Case("windows", "60-digit decimal", 1e-15, windows),
    Case("clamped lines to l = 20", "exact fractions", 2e-14, clamped_linear),
    Case("Gaussians, k = 1/8 to 1e4", "60-digit decimal, relative", 1e-14, gaussians),
)
