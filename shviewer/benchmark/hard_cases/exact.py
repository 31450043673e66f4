"""References to 60 digits, in decimal arithmetic: a textbook recurrence may lose ten of them without harm.

Nothing here is shared with harmonics/: the recurrence is that of the normalised Legendre functions [DLMF 14.10.3], the one
that loses digits near the poles in float64. tests/hard_cases holds it to published values and to mpmath's. Inputs are
float64 numbers and mean exactly what they are; exponents cannot leave the range of decimal.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from decimal import Context, Decimal, localcontext
from functools import lru_cache, wraps
from itertools import islice
from typing import ParamSpec, TypeVar

DIGITS = 60
PI = Decimal("3.14159265358979323846264338327950288419716939937510582097494459230781640628620899")

P = ParamSpec("P")
T = TypeVar("T")
Vector = tuple[Decimal, Decimal, Decimal]
ExactQuaternion = tuple[Decimal, Decimal, Decimal, Decimal]


def in_many_digits(function: Callable[P, T]) -> Callable[P, T]:
    """Decorator: run the function in a decimal context of DIGITS digits and the widest exponents."""

    @wraps(function)
    def run(*arguments: P.args, **options: P.kwargs) -> T:
        with localcontext(Context(prec=DIGITS, Emax=10**9, Emin=-(10**9))):
            return function(*arguments, **options)

    return run


@in_many_digits
def unit(direction: Sequence[float | Decimal]) -> Vector:
    """The unit vector along (x, y, z)."""
    x, y, z = (Decimal(part) for part in direction)
    length = (x * x + y * y + z * z).sqrt()
    return x / length, y / length, z / length


@in_many_digits
def harmonics(direction: Sequence[float | Decimal], m: int, n_bands: int) -> list[Decimal]:
    """Y(l, m) in a direction of any length, for l = |m| to n_bands-1."""
    x, y, z = unit(direction)
    order = abs(m)
    real, imaginary = Decimal(1), Decimal(0)
    for _ in range(order):
        real, imaginary = x * real - y * imaginary, x * imaginary + y * real
    azimuth = (imaginary if m < 0 else real) * (Decimal(2).sqrt() if m else 1)
    last, value = Decimal(0), sectoral(order) * azimuth
    values = [value]
    for a, b in islice(_steps(order, n_bands), n_bands - order - 1):
        last, value = value, a * (z * value - b * last)
        values.append(value)
    return values


@in_many_digits
def sectoral(m: int) -> Decimal:
    """P(m, m) normalised, without sin^m and with the phase: (-1)^m sqrt((2m+1)!!/(2m)!! / 4 pi)."""
    square = 1 / (4 * PI)
    for k in range(1, m + 1):
        square = square * (2 * k + 1) / (2 * k)
    return -square.sqrt() if m % 2 else square.sqrt()


@lru_cache(maxsize=256)
@in_many_digits
def _steps(m: int, n_bands: int) -> tuple[tuple[Decimal, Decimal], ...]:
    """(a, b) of P(l) = a (z P(l-1) - b P(l-2)) for l = m+1 to n_bands-1."""
    squares = (
        ((4 * l * l - 1, l * l - m * m), ((l - 1) ** 2 - m * m, 4 * (l - 1) ** 2 - 1)) for l in range(m + 1, n_bands)
    )
    return tuple(((Decimal(p) / q).sqrt(), (Decimal(r) / s).sqrt()) for (p, q), (r, s) in squares)


@in_many_digits
def legendre(x: Decimal, n_bands: int) -> list[Decimal]:
    """P(l)(x) for l = 0 to n_bands-1."""
    values = [Decimal(1), x]
    for l in range(2, n_bands):
        values.append(((2 * l - 1) * x * values[-1] - (l - 1) * values[-2]) / l)
    return values[:n_bands]


@in_many_digits
def disc(half_angle: float, n_bands: int) -> list[Decimal]:
    """lambda(l) of a disc of `half_angle` radians: 2 pi (P(l-1) - P(l+1))/(2l+1) at its edge, and the solid angle."""
    edge = cosine(Decimal(half_angle))
    values = legendre(edge, n_bands + 1)
    return [2 * PI * (1 - edge)] + [2 * PI * (values[l - 1] - values[l + 1]) / (2 * l + 1) for l in range(1, n_bands)]


@in_many_digits
def cosine(angle: Decimal) -> Decimal:
    """The cosine by its series, for an angle up to a few radians."""
    total, term, k = Decimal(1), Decimal(1), 0
    while abs(term) > Decimal(10) ** (-DIGITS - 5):
        k += 2
        term = -term * angle * angle / (k * (k - 1))
        total += term
    return total


@in_many_digits
def product(second: ExactQuaternion, first: ExactQuaternion) -> ExactQuaternion:
    """Hamilton's product of two quaternions (x, y, z, w), which turns by `first` and then `second`; scaled to length 1."""
    (a, b, c, d), (e, f, g, h) = second, first
    x, y, z = d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h
    w = d * h - a * e - b * f - c * g
    length = (x * x + y * y + z * z + w * w).sqrt()
    return x / length, y / length, z / length, w / length


@in_many_digits
def rotation_matrix(quaternion: ExactQuaternion) -> list[list[Decimal]]:
    """Rows of the matrix M, v_out = M v_in, for a quaternion (x, y, z, w) of any length."""
    x, y, z, w = quaternion
    n = x * x + y * y + z * z + w * w
    return [
        [1 - 2 * (y * y + z * z) / n, 2 * (x * y - z * w) / n, 2 * (x * z + y * w) / n],
        [2 * (x * y + z * w) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - x * w) / n],
        [2 * (x * z - y * w) / n, 2 * (y * z + x * w) / n, 1 - 2 * (x * x + y * y) / n],
    ]
