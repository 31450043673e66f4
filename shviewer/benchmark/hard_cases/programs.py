"""Hard cases of conventions: the numbers for every program, put into that program's own basis functions, are the light.

The functions are written out as the programs' sources have them, and the axes as they see our image (coefficients/programs.py):
nothing here comes from coefficients/ or harmonics/ but the conversion under test.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import pi, sqrt

import numpy as np

from shviewer.benchmark.hard_cases.outcome import Case, worst
from shviewer.benchmark.hard_cases.shader import SEED
from shviewer.coefficients.texts import parse_convention
from shviewer.harmonics.basis import Array

CONSTANTS = np.sqrt(np.array([1, 3, 3, 3, 15, 15, 5 / 4, 15, 15 / 4]) / (4 * pi))
PHASE = np.array([1, -1, 1, -1, 1, -1, 1, -1, 1])
"""(-1)^m of the nine functions."""

LAMBERT = np.array([pi, *[2 * pi / 3] * 3, *[pi / 4] * 5])
SN3D = np.array([1, 1, 1, 1, sqrt(3), sqrt(3), 0.5, sqrt(3), sqrt(3) / 2]) * np.repeat([1, 3, 5], [1, 3, 5]) / (4 * pi)
"""SN3D functions over the polynomials, times (2l+1)/4pi, the share of each channel in the function."""


def polynomials(x: Array, y: Array, z: Array) -> Array:
    return np.stack([x / x, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y], axis=-1)


def complex_functions(x: Array, y: Array, z: Array) -> Array:
    """The orthonormal complex functions with phase, by l(l+1) + m."""
    plus, minus = x + 1j * y, x - 1j * y
    one, two = sqrt(3 / (8 * pi)), sqrt(15 / (2 * pi))
    found = [
        x / x * sqrt(1 / pi) / 2, one * minus, z * sqrt(3 / pi) / 2, -one * plus,
        two / 4 * minus**2, two / 2 * minus * z, (3 * z * z - 1) * sqrt(5 / pi) / 4, -two / 2 * plus * z, two / 4 * plus**2,
    ]  # fmt: skip
    return np.stack(found, axis=-1)


PROGRAMS: dict[str, tuple[Callable[[Array, Array, Array], Array], Array]] = {
    "shviewer": (lambda x, y, z: polynomials(x, y, z) * CONSTANTS * PHASE, np.ones(9)),
    "filament": (lambda x, y, z: polynomials(y, z, x), LAMBERT / pi),
    "three": (lambda x, y, z: polynomials(x, z, -y) * CONSTANTS, np.ones(9)),
    "unity": (lambda x, y, z: polynomials(x, z, y), LAMBERT / pi),
    "unreal": (lambda x, y, z: polynomials(-y, -x, z) * CONSTANTS * PHASE, np.ones(9)),
    "ambix": (lambda x, y, z: polynomials(x, y, z) * SN3D, np.ones(9)),
    "sphericart": (lambda x, y, z: polynomials(x, y, z) * CONSTANTS, np.ones(9)),
    "scipy": (complex_functions, np.ones(9)),
    "shviewer,y-up,4pi,no-phase,irradiance": (
        lambda x, y, z: polynomials(x, z, -y) * CONSTANTS * sqrt(4 * pi),
        LAMBERT,
    ),
    "shviewer,m-swapped": (
        lambda x, y, z: (polynomials(x, y, z) * CONSTANTS * PHASE)[..., [0, 3, 2, 1, 8, 7, 6, 5, 4]],
        np.ones(9),
    ),
}
"""Convention -> the program's functions of a direction in our axes, and the factors from radiance to what it holds."""


@worst
def conventions() -> Iterator[Array]:
    """Random lights of three bands in 40 random directions, in every convention and back, relative to the largest value.

    Bound: 1e-14, a rotation of three bands and sums of nine products.
    """
    random = np.random.default_rng(SEED)
    coefficients, directions = random.normal(size=(9, 3)), random.normal(size=(40, 3))
    x, y, z = (directions / np.linalg.norm(directions, axis=1, keepdims=True)).T
    ours = polynomials(x, y, z) * CONSTANTS * PHASE
    for text, (functions, factors) in PROGRAMS.items():
        convention = parse_convention(text)
        wanted = ours @ (factors[:, None] * coefficients)
        numbers = np.asarray(convention.from_ours(coefficients), np.complex128)
        yield np.abs(functions(x, y, z) @ numbers - wanted) / float(np.abs(wanted).max())
        held = LAMBERT[:, None] if convention.quantity in ("irradiance", "irradiance-over-pi") else 1.0
        yield convention.to_ours(convention.from_ours(coefficients)) - held * coefficients


CASES = (Case("numbers for other programs and back", "their own basis functions", 1e-14, conventions),)
