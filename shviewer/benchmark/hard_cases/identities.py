"""Hard cases of the identities of the whole basis: the addition theorem and orthonormality."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from decimal import Decimal
from functools import partial

import numpy as np

from shviewer.benchmark.hard_cases import exact
from shviewer.benchmark.hard_cases.evaluation import NEAR, Evaluate, generic, rounding
from shviewer.benchmark.hard_cases.outcome import Case, largest, worst
from shviewer.benchmark.hard_cases.shader import noise_views
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.quadrature import DirectionSet, gauss_legendre


def not_unit(evaluate: Evaluate = evaluate_basis) -> float:
    """The addition theorem to degree 64 for directions of length 1.001 and 1 + 1e-7, relative.

    Unnormalised it is off by 2l|r-1| to l^2|r-1|/3.
    """

    def stretched(length: float) -> Evaluate:
        return lambda directions, n_bands: evaluate(directions * length, n_bands)

    return max(addition_theorem(65, stretched(length)) for length in (1.001, 1 + 1e-7, 0.3))


@worst
def addition_theorem(n_bands: int, evaluate: Evaluate = evaluate_basis) -> Iterator[Array]:
    """Sum over m of Y(l, m)^2 = (2l+1)/4pi, relative, everywhere.

    Bound: rounding(129) to l = 128; 2.1e-13 to l = 1024 (measured; the plain recurrence has 5e-11).
    """
    count = max(8, 2**22 // n_bands**2)
    near = np.array([[theta, -theta / 3, z] for theta in NEAR for z in (1, -1)])
    directions = np.concatenate([generic(count), near[: count // 2]])
    for start in range(0, len(directions), count // 4):
        values = np.asarray(evaluate(directions[start : start + count // 4], n_bands))
        sums = np.add.reduceat(values**2, np.arange(n_bands) ** 2, axis=1)
        yield sums * (4 * np.pi / (2 * np.arange(n_bands) + 1)) - 1


def two_directions() -> float:
    """Sum over m of Y(l, m)(a) Y(l, m)(b) = (2l+1)/4pi P(l)(a.b) to l = 128, relative to (2l+1)/4pi."""
    first, second = generic(12), generic(24)[12:]
    sums = np.add.reduceat(evaluate_basis(first, 129) * evaluate_basis(second, 129), np.arange(129) ** 2, axis=1)
    wanted = [_legendre_between(a, b, 129) for a, b in zip(first.tolist(), second.tolist(), strict=True)]
    return largest(sums * (4 * np.pi / (2 * np.arange(129) + 1)) - np.array(wanted))


@exact.in_many_digits
def _legendre_between(a: Sequence[float], b: Sequence[float], n_bands: int) -> list[float]:
    cosine = sum((p * q for p, q in zip(exact.unit(a), exact.unit(b), strict=True)), Decimal(0))
    return [float(value) for value in exact.legendre(cosine, n_bands)]


def gram(n_bands: int, rule: Callable[[int], DirectionSet] | None = None) -> float:
    """Integral of Y_i Y_j - (1 if i = j else 0), by the rule that has to be exact for it, 2 n^2 points.

    With Gauss-Legendre nodes and weights of full accuracy the errors of 16, 33 and 64 bands are 4.4e-15, 8.0e-15 and 1.4e-14.
    """
    points = gauss_legendre(2 * n_bands**2).direction_set() if rule is None else rule(2 * n_bands**2)
    basis = evaluate_basis(points.directions, n_bands) * np.sqrt(points.weights)[:, None]
    product = basis.T @ basis
    product[np.diag_indices(n_bands**2)] -= 1
    return largest(product)


SUM = "(2l+1)/4pi, relative"

CASES = (
    Case("directions of length 1.001, 1 + 1e-7", "(2l+1)/4pi to l = 64, relative", rounding(65), not_unit),
    Case("addition theorem to l = 128", SUM, rounding(129), lambda: addition_theorem(129), noise_views),
    Case("addition theorem to l = 1024", SUM, 2.1e-13, lambda: addition_theorem(1025)),
    Case("addition theorem of two directions", "P(l)(a.b) in 60 digits", rounding(129), two_directions),
    *(Case(f"Gram matrix, {n} bands", "identity", rounding(n), partial(gram, n)) for n in (16, 33, 64)),
)
