"""Hard cases of evaluating the basis: factorials, poles, the seam, and directions of any length.

Each function returns the error of the code under test, or of another `evaluate` that a test passes. The bound is `rounding(n)`
unless another is named.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from decimal import Decimal

import numpy as np
from numpy.typing import ArrayLike

from shviewer.benchmark.hard_cases import exact
from shviewer.benchmark.hard_cases.outcome import Case, largest, worst
from shviewer.benchmark.hard_cases.shader import SEED, factorial_views, pole_views, seam_views
from shviewer.harmonics.basis import MAX_BANDS, Array, evaluate_basis, index, normalisation

DEGREE_1024 = 7.6e-14
"""The largest absolute error to l = 1024 of the recurrence of basis.py, measured against 256-bit references. The usual
normalised recurrence is off by 3.2e-10 next to the poles."""

DEGREE_1399 = DEGREE_1024 * 1400 / 1025

NEAR = tuple(10.0**-k for k in range(2, 13))
"""Angles to a pole, radians: 1e-2 to 1e-12."""


def rounding(n_bands: int) -> float:
    """n 2^-51: the error that rounding the direction alone may cause in n bands.

    A unit vector in float64 is off by up to 2^-52 (each component by 2^-53, the length by as much again), a degree l
    changes by at most l times its largest value per radian (Bernstein), and that is about 2 for the orders m of
    generic directions. The squares of the addition theorem have twice the error, relative to a value of 1.
    """
    return n_bands * 2.0**-51


Evaluate = Callable[[Array, int], Array]
"""Directions (k, 3) and a number of bands -> (k, n**2)."""


def generic(count: int) -> Array:
    """Random unit directions and one on the equator, (count, 3)."""
    vectors = np.random.default_rng(SEED).normal(size=(count, 3))
    vectors[0, 2] = 0
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


def towards(theta: ArrayLike, phi: ArrayLike) -> Array:
    """Unit directions (..., 3) of angles, broadcast; written out, so that references share nothing with harmonics/."""
    parts = np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


@worst
def against_exact(
    evaluate: Evaluate, directions: Array, n_bands: int, orders: Iterable[int], degrees: Sequence[int] | None = None
) -> Iterator[Array]:
    """The largest |Y - exact| over some orders and some degrees, or all below `n_bands`."""
    values = np.asarray(evaluate(directions, n_bands))
    for m in orders:
        l = np.arange(abs(m), n_bands)
        wanted = np.array([exact.harmonics(direction, m, n_bands) for direction in directions.tolist()], np.float64)
        error = values[:, l * (l + 1) + m] - wanted
        yield error if degrees is None else error[:, np.isin(l, degrees)]


def factorials(evaluate: Evaluate = evaluate_basis) -> float:
    """Degrees 86, 87 and 150, of every order: (l+m)! leaves float64 at l = 86, where the textbook has K = 0.

    Bound: rounding(151).
    """
    return against_exact(evaluate, generic(3), 151, range(-150, 151), (86, 87, 150))


@worst
def double_factorials(evaluate: Evaluate = evaluate_basis) -> Iterator[Array]:
    """Y(m, +-m) next to the equator: (2m-1)!! leaves float32 at m = 29 and float64 at m = 151."""
    directions = generic(4)
    directions[:, 2] *= 1e-3  # elsewhere sin^m makes them too small to see
    values = np.asarray(evaluate(directions, 513))
    for m in (11, 18, 29, 150, 151, 152, 300, 512):
        for signed in (m, -m):
            wanted = [float(exact.harmonics(direction, signed, m + 1)[0]) for direction in directions.tolist()]
            yield values[:, index(m, signed)] - wanted


def pole_growth(normalise: Callable[[int], Array] = normalisation) -> float:
    """N(l, m), the factor of Y beside its sin^m at the pole, which grows like 1.62^l, in the last band that is allowed.

    Relative to N. Bound: N is a product of up to 2 l square roots of quotients, 3 roundings of 2^-53 each, the
    roundings of a root counting half: 2 * 1400 * 3 * 2^-53 = 9.3e-13.
    """
    norms = normalise(MAX_BANDS)
    last = MAX_BANDS - 1
    chosen = np.array([0, 1, 2, 100, 500, 625, 700, 1000, last])
    wanted = [float(_norm_at_pole(last, m)) for m in chosen.tolist()]
    return largest(norms[last, chosen] / wanted - 1) if np.isfinite(norms).all() else np.inf


@exact.in_many_digits
def _norm_at_pole(l: int, m: int) -> Decimal:
    """N(l, m) = (-1)^m sqrt(2) sqrt((2l+1)/(4 pi) (l+m)!/(l-m)!) / (2^m m!), for m = 0 without sqrt(2)."""
    square = Decimal(2 * l + 1) / (4 * exact.PI) * (2 if m else 1)
    for k in range(1, m + 1):
        square = square * (l + k) * (l - k + 1) / (4 * k * k)
    return -square.sqrt() if m % 2 else square.sqrt()


def underflow() -> float:
    """Degrees 1000 to 1399 where sin(theta) = 1/e: sin^m falls to e^-1399, out of float64.

    Bound: DEGREE_1024 carried on in proportion to n, which is more than it grows.
    """
    sine = np.exp(-1)
    directions = np.array([[sine * np.cos(1), sine * np.sin(1), np.sqrt(1 - sine**2)]])
    orders = [0, 1, -2, *range(100, MAX_BANDS, 50), *range(-740, -600, 20), MAX_BANDS - 1]
    return against_exact(evaluate_basis, directions, MAX_BANDS, orders, range(1000, MAX_BANDS))


def near_poles(n_bands: int, evaluate: Evaluate = evaluate_basis) -> float:
    """1e-12 to 1e-2 radians from either pole, where acos(z) and the plain recurrence lose digits.

    Bound: rounding(33), a quarter of the plain recurrence's error, and DEGREE_1024.
    """
    theta = np.array(NEAR)
    near = towards(theta, np.arange(len(theta)) * 2.4)
    orders = [m for m in (0, 1, -1, 2, -2, 3, -5, 8, 12, -20, 31) if abs(m) < n_bands]
    return against_exact(evaluate, np.concatenate([near, near * [1, 1, -1]]), n_bands, orders)


def exact_poles(n_bands: int) -> float:
    """x = y = 0 of either sign: Y(l, 0) = (+-1)^l sqrt((2l+1)/4pi) and all others 0.

    Bound: DEGREE_1024, beyond that in proportion to n.
    """
    directions = np.array([[0.0, 0.0, 1.0], [-0.0, 0.0, -1.0], [0.0, -0.0, 1.0], [-0.0, -0.0, -1.0]])
    l = np.arange(n_bands)
    wanted = np.zeros((4, n_bands**2))
    wanted[:, l * (l + 1)] = np.sqrt((2 * l + 1) / (4 * np.pi))
    wanted[1::2, l * (l + 1)] *= (-1.0) ** l
    return largest(evaluate_basis(directions, n_bands) - wanted)


@worst
def seam(evaluate: Evaluate = evaluate_basis) -> Iterator[Array]:
    """phi = pi against -pi, and 0 against -0, at several heights: the same function value. Bound: 0, not one bit."""
    z = np.array([-0.8, -1e-9, 0.0, 0.3, 0.999])
    x = np.sqrt(1 - z**2)
    for sign in (1, -1):
        above, below = (np.stack([sign * x, np.full(5, zero), z], axis=-1) for zero in (0.0, -0.0))
        yield np.asarray(evaluate(above, 129)) - np.asarray(evaluate(below, 129))


def seam_values() -> float:
    """Values on the seam and 5e-324 to 1e-3 beside it."""
    beside = np.array([0.0, -0.0, 5e-324, -1e-300, 1e-16, -1e-9, 1e-3])
    directions = np.stack([np.full(7, -0.6), beside, np.full(7, 0.8)], axis=-1)
    return against_exact(evaluate_basis, directions, 129, (0, 1, -1, 2, -7, 64, -64, 127, -128))


def any_length(evaluate: Evaluate = evaluate_basis) -> float:
    """Directions of length 5e-324 to 1e308, mixed components included."""
    directions = [
        [1e200, 1e200, 0],
        [1e-200, 0, 1e-200],
        [5e-324, 0, 0],
        [5e-324, -5e-324, 1e-323],
        [1e-320, 3e-315, 1],
        [1.7e308, -1.7e308, 1.7e308],
        [1e308, 1e-308, 1e300],
        [3e-308, 2e-308, -1e-308],
        [1e-160, 1e-170, 1e-165],
    ]
    return against_exact(evaluate, np.array(directions), 33, range(-32, 33))


def no_direction(evaluate: Evaluate = evaluate_basis) -> float:
    """How many of the zero, NaN and infinite directions are not refused. Bound: 0."""
    nan, inf = float("nan"), float("inf")
    accepted = 0
    for bad in ([0, 0, 0], [-0.0, 0, 0], [nan, 0, 1], [0, inf, 0], [inf, -inf, 1], [0, 0, -inf]):
        try:
            evaluate(np.array([[0.0, 0, 1], bad]), 4)
        except ValueError:
            continue
        accepted += 1
    return accepted


DECIMAL = "60-digit decimal recurrence"

CASES = (
    Case("factorial overflow, degrees 86, 87, 150", DECIMAL, rounding(151), factorials, factorial_views),
    Case("double factorial, Y(m, +-m) to m = 512", DECIMAL, rounding(513), double_factorials),
    Case("growth at the pole, degree 1399", "N(l, m) in 60 digits, relative", 9.3e-13, pole_growth),
    Case("underflow of sin^m, degrees 1000-1399", DECIMAL, DEGREE_1399, underflow),
    Case("near poles, 33 bands", DECIMAL, rounding(33), lambda: near_poles(33), pole_views),
    Case("near poles, degree 1024", DECIMAL, DEGREE_1024, lambda: near_poles(1025)),
    Case("exact poles, degree 1024", "sqrt((2l+1)/4pi), else 0", DEGREE_1024, lambda: exact_poles(1025), pole_views),
    Case("exact poles, all 1400 bands", "sqrt((2l+1)/4pi), else 0", DEGREE_1399, lambda: exact_poles(MAX_BANDS)),
    Case("seam, both sides of it", "equal to the last bit", 0.0, seam, seam_views),
    Case("seam, values on and beside it", DECIMAL, rounding(129), seam_values),
    Case("directions from 5e-324 to 1e308", DECIMAL, rounding(33), any_length),
    Case("zero, NaN and infinite directions", "refused (number accepted)", 0.0, no_direction),
)
