"""Lights that a list may be of in place of the one that is known: seen in one colour, turned, or with its bands multiplied.

Unlike mistakes in a convention these have numbers of their own, which the list tells: an angle, a factor or sign of each band.

A turn about the vertical by a mixes c(l, m) and c(l, -m) as it mixes cos m phi and sin m phi, so that the product of a turned
light and a list, each band of which has the power 1, is a trigonometric polynomial of a, whose largest value is looked for. No
turn changes the power of a band: what multiplies it is the root of its power in the list over that in the light, in whatever
axes the list is.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.diagnosis.costs import ONE, PROGRAM
from shviewer.coefficients.diagnosis.orientations import undoing
from shviewer.coefficients.diagnosis.ways import ways
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.parts.rows import ACN
from shviewer.harmonics.basis import Array, count_bands, degree_order
from shviewer.harmonics.filters import WINDOWS, irradiance_factors, per_coefficient, window
from shviewer.harmonics.metrics import LUMINANCE, band_power
from shviewer.words import all_of

COLOURS = {
    "luminance alone": LUMINANCE,
    "mean channel alone": np.ones(3) / 3,
    "red alone": np.eye(3)[0],
    "green alone": np.eye(3)[1],
    "blue alone": np.eye(3)[2],
}
"""What a grey list is often of, and the weights of red, green and blue."""

TURNED_BANDS = 5
"""The most bands of which a turn is sought: it shows in the first ones, where all 192 orientations are tried."""

ANGLES = 720
"""So many turns count as different: they are told by half a degree."""

STARTS, BEST_STARTS = 72, 8
"""Angles from which the best turn is sought in every orientation, each a quarter of the shortest wave's rise from the next, and
how many of all of them are refined."""

FAR = PROGRAM
"""What more than a quarter of a turn costs: half a turn is the phase, too, which a program without it has for that."""

NEAR = 0.9
"""How near the light must be to the list, but for a factor of each band, for either to be looked into."""

FEWER = 1e-6
"""The share that a band with the other sign must gain: half a turn and the like give signs, too."""

PLAIN = 1.0
"""Degrees: a turn that is so near to quarters is one of axes."""

AS_A_WINDOW = 0.005
"""How near factors are to those of a window that is named."""

UNNAMED = 1.0
"""What factors cost that are those of no window."""

TOLD = 1e-6
"""A band with less than this share of the strongest one's power has no factor."""


class Bent(NamedTuple):
    """A light: what was done to it, each in words after "if", and its coefficients (n**2, 3)."""

    said: list[str]
    coefficients: Array
    choices: int = 1
    """How many lights of the kind there are to choose from, a bound."""
    cost: float = 0.0
    """What it costs beside the mistakes in a convention, in their units."""

    def then(self, said: str, coefficients: Array, choices: int, cost: float = 0.0) -> Bent:
        """The light to which something else was done, too; each thing after the first costs as much as a mistake."""
        another = ONE if self.said else 0.0
        return Bent([*self.said, said], coefficients, self.choices * choices, self.cost + cost + another)


class Bending:
    """What may have been done to lights so that a list is of them: turns, factors of bands, and one colour of a grey one.

    These commute, and what is turned and multiplied at once is found at once: no factor of a band changes its best turn.
    """

    def __init__(self, listed: Listed, n_bands: int) -> None:
        """n_bands: at most so many are compared. LightError if the list is no table."""
        taken = [way for way in ways(listed) if way.taken.order == ACN and not way.taken.shift]
        self.n_bands = min(n_bands, count_bands(taken[0].table))
        self.tables = [way.table[: self.n_bands**2] for way in taken]
        self.grey = any(np.allclose(table, table[:, :1], rtol=1e-6) for table in self.tables)
        self._rows = [_directions(table[: TURNED_BANDS**2]) for table in self.tables] if self.n_bands > 1 else []

    def plain(self, light: Bent) -> list[Bent]:
        """The light, or where it has colours and the list has none, what the list may be of."""
        exact = light.coefficients[: self.n_bands**2]
        if not self.grey or np.allclose(exact, exact[:, :1], rtol=1e-6):
            return [light._replace(coefficients=exact)]
        return [
            light.then(f"it is of the light's {said}", np.repeat(exact @ weights[:, None], 3, axis=1), len(COLOURS))
            for said, weights in COLOURS.items()
        ]

    def nearness(self, light: Bent) -> float:
        """How near the light can come to the list by turns and factors, 0 to 1: no explanation of it comes nearer."""
        return self._nearest(light.coefficients).turned if self._told(light) else 0.0

    def bent(self, light: Bent) -> Iterator[Bent]:
        """The light as it is nearest to the list, turned, with factors, or both, and with other signs."""
        if not self._told(light):
            return
        exact, near = light.coefficients, self._nearest(light.coefficients)
        if near.turned >= NEAR and abs(near.angle - 90 * round(near.angle / 90)) > PLAIN:
            quarters = ((near.angle + 90 * k + 180) % 360 - 180 for k in range(4))  # axes and the phase are those
            for one in sorted(quarters, key=abs):
                said = f"the light is turned by {one:.3g} degrees about the vertical, as by --rotate-light {one:.4g} 0"
                moved = light.then(said, turned(exact, one), ANGLES, 0.0 if abs(one) <= 90 else FAR)
                yield moved
                if abs(one) <= 45:  # the others are this and axes
                    yield from self._multiplied(moved)
        opposite = near.negative ^ set(range(1, self.n_bands, 2))  # the same from opposite directions
        for bands in filter(None, (near.negative, opposite) if near.negative and not light.said else ()):
            some, have = ("s", "have") if len(bands) > 1 else ("", "has")
            said = f"band{some} {all_of([str(band) for band in sorted(bands)])} {have} the other sign"
            signs = np.where(np.isin(np.arange(self.n_bands), list(bands)), -1.0, 1.0)
            yield light.then(said, exact * per_coefficient(signs), 2**self.n_bands, float(len(bands)))
        if near.plain >= NEAR:
            yield from self._multiplied(light)

    def _told(self, light: Bent) -> bool:
        return self.n_bands > 1 and bool(light.coefficients.any()) and bool(self.tables[0].any())

    def _nearest(self, exact: Array) -> _Nearest:
        return _nearest(self._rows, exact[: TURNED_BANDS**2])

    def _multiplied(self, light: Bent) -> Iterator[Bent]:
        yield from _multiplied(self.tables[0], light)


class _Nearest(NamedTuple):
    """The turn in which a light is nearest to a list, whichever factors its bands have."""

    angle: float
    """-180 to 180 degrees."""
    turned: float
    """How near it is then, the product: 1 if they are the same but for a factor of each band that the list has."""
    plain: float
    """How near it is without a turn."""
    negative: set[int]
    """The bands that are so near to it with the other sign, where others are with their own."""


def turned(coefficients: Array, degrees: float) -> Array:
    """Coefficients (n**2, ...) of the light turned about +z, from +x towards +y."""
    found = coefficients.copy()
    for row in range(len(coefficients)):
        degree, order = degree_order(row)
        angle, other = np.radians(degrees) * order, degree * (degree + 1) - order
        found[row] = np.cos(angle) * coefficients[row] - np.sin(angle) * coefficients[other]
    return found


def _directions(table: Array) -> tuple[Array, NDArray[np.bool_]]:
    """A list in all orientations, each band with the power 1, (192, n**2, 3), and the bands that it has, (n,)."""
    power = np.sqrt(band_power(table).sum(axis=1))
    each = per_coefficient(power)
    return undoing(len(power)) @ np.divide(table, each, out=np.zeros_like(table), where=each > 0), power > 0


def _nearest(lists: list[tuple[Array, NDArray[np.bool_]]], exact: Array) -> _Nearest:
    """How near a light comes to one of the lists, in any orientation."""
    n_bands = count_bands(exact)
    orders = np.array([degree_order(row)[1] for row in range(n_bands**2)])
    other = np.array([l * (l + 1) - m for l, m in map(degree_order, range(n_bands**2))])
    m = np.arange(n_bands)[:, None]
    with_order, angles = np.abs(orders) == m, np.arange(STARTS) * (2 * np.pi / STARTS)
    best, most, plain, signed = 0.0, 0.0, 0.0, (0.0, np.ones(n_bands))
    starts = np.arange(n_bands) ** 2
    whole = float(np.sqrt(band_power(exact).sum(axis=1))[lists[0][1]].sum())
    if not whole:
        return _Nearest(0.0, 0.0, 0.0, set())
    for rows, _ in lists:
        along = (exact * rows).sum(axis=2)
        cosines = along @ with_order.T  # (192, n)
        sines = (np.sign(orders)[:, None] * exact[other] * rows).sum(axis=2) @ with_order.T
        products = cosines @ np.cos(m * angles) - sines @ np.sin(m * angles)  # (192, STARTS)
        plain = max(plain, float(products[:, 0].max()))
        bands = np.add.reduceat(along, starts, axis=1)  # (192, n)
        near = int((np.abs(bands).sum(axis=1) - FEWER * whole * (bands < 0).sum(axis=1)).argmax())
        signed = max(signed, (float(np.abs(bands[near]).sum()), np.sign(bands[near])), key=lambda one: one[0])
        starting = np.argpartition(products, -BEST_STARTS, axis=None)[-BEST_STARTS:]
        for orientation, place in zip(*np.unravel_index(starting, products.shape), strict=True):
            value, angle = _refined(cosines[orientation], sines[orientation], float(angles[place]))
            if value > most:
                most, best = value, angle
    negative = set(np.flatnonzero(signed[1] < 0).tolist() if signed[0] >= NEAR * whole else [])
    return _Nearest(float((np.degrees(best) + 180) % 360 - 180), most / whole, plain / whole, negative)


def _refined(cosines: Array, sines: Array, angle: float) -> tuple[float, float]:
    """The largest value near by of the sum of cosines(m) cos m a - sines(m) sin m a, by Newton's rule, and its angle."""
    m = np.arange(len(cosines))
    for _ in range(6):
        cos, sin = np.cos(m * angle), np.sin(m * angle)
        slope = float((m * (-cosines * sin - sines * cos)).sum())
        bend = float((m**2 * (-cosines * cos + sines * sin)).sum())
        if bend >= 0:
            break
        angle -= slope / bend
    return float((cosines * np.cos(m * angle) - sines * np.sin(m * angle)).sum()), angle


def _multiplied(table: Array, light: Bent) -> Iterator[Bent]:
    """The light with its bands multiplied to have the power of the list's; the first band by 1, if a window did that."""
    exact = light.coefficients
    n_bands = count_bands(exact)
    own, given = band_power(exact).sum(axis=1), band_power(table).sum(axis=1)
    told = own > TOLD * own.max()
    factors = np.sqrt(np.divide(given, own, out=np.zeros(n_bands), where=told))
    if not (told[0] and factors[0] > 0):
        return
    for held in (np.ones(n_bands), np.abs(irradiance_factors(n_bands))):
        there = told & (held > 0)
        windowed = np.divide(factors, held, out=np.zeros(n_bands), where=there) * (held[0] / factors[0])
        if (np.diff(windowed[there]) <= AS_A_WINDOW).all() and windowed[there].min() < 1 - AS_A_WINDOW:
            name = _named(windowed, there)
            said = f"its bands are multiplied by {all_of([f'{factor:.3g}' for factor in windowed[there]])}"
            by = f", by the window {name}" if name else ""
            yield light.then(said + by, exact * per_coefficient(windowed), 2, 0.0 if name else UNNAMED)
    said = all_of([f"{factor:.3g}" for factor in factors[told]])
    yield light.then(f"its bands are multiplied by {said}", exact * per_coefficient(factors), 2, UNNAMED + 1)


def _named(factors: Array, told: Array) -> str:
    """The window that has these factors, as --window takes it; "" if none of those that are known."""
    n_bands = len(factors)
    for width in (n_bands, *range(1, 4 * n_bands)):
        for name in WINDOWS:
            if np.abs(window(name, n_bands, width) - factors)[told].max() <= AS_A_WINDOW:
                return f"{name}:{width}"
    return ""
