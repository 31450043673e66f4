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

from shviewer.coefficients.diagnosis.costs import PROGRAM
from shviewer.coefficients.diagnosis.orientations import undoing
from shviewer.coefficients.diagnosis.ways import Way, ways
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
"""The angles, a degree of a circle in two, among which the best is sought before it is refined."""

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
    """A light, in words after "if", and its coefficients (n**2, 3)."""

    said: str
    coefficients: Array
    choices: int
    """How many lights of the kind there are to choose from, a bound."""
    cost: float = 0.0
    """What it costs beside the mistakes in a convention, in their units."""


def bent(listed: Listed, exact: Array) -> Iterator[Bent]:
    """The lights of each kind that the list is nearest to. exact: the light's radiance, (n**2, 3), with at least its bands.

    LightError if the list is no table.
    """
    taken = [way for way in ways(listed) if way.taken.order == ACN and not way.taken.shift]
    n_bands = min(count_bands(exact), count_bands(taken[0].table))
    exact = exact[: n_bands**2]
    if n_bands < 2 or not exact.any() or not taken[0].table.any():
        return
    grey = any(np.allclose(way.table, way.table[:, :1], rtol=1e-6) for way in taken)
    if grey and not np.allclose(exact, exact[:, :1], rtol=1e-6):
        for said, weights in COLOURS.items():
            yield Bent(f"it is of the light's {said}", np.repeat(exact @ weights[:, None], 3, axis=1), len(COLOURS))
    angle, turned_share, plain_share, negative = _nearest(taken, exact)
    if turned_share >= NEAR and abs(angle - 90 * round(angle / 90)) > PLAIN:
        quarters = ((angle + 90 * k + 180) % 360 - 180 for k in range(4))  # axes and the phase are quarters and halves
        for one in sorted(quarters, key=abs):
            said = f"the light is turned by {one:.3g} degrees about the vertical, as by --rotate-light {one:.4g} 0"
            yield Bent(said, turned(exact, one), ANGLES, 0.0 if abs(one) <= 90 else FAR)
    opposite = negative ^ set(range(1, n_bands, 2))  # the same from opposite directions
    for bands in filter(None, (negative, opposite) if negative else ()):
        some, have = ("s", "have") if len(bands) > 1 else ("", "has")
        said = f"band{some} {all_of([str(band) for band in sorted(bands)])} {have} the other sign"
        signs = np.where(np.isin(np.arange(n_bands), list(bands)), -1.0, 1.0)
        yield Bent(said, exact * per_coefficient(signs), 2**n_bands, float(len(bands)))
    if plain_share >= NEAR:
        yield from _multiplied(taken[0].table[: n_bands**2], exact)


def turned(coefficients: Array, degrees: float) -> Array:
    """Coefficients (n**2, ...) of the light turned about +z, from +x towards +y."""
    found = coefficients.copy()
    for row in range(len(coefficients)):
        degree, order = degree_order(row)
        angle, other = np.radians(degrees) * order, degree * (degree + 1) - order
        found[row] = np.cos(angle) * coefficients[row] - np.sin(angle) * coefficients[other]
    return found


def _nearest(taken: list[Way], exact: Array) -> tuple[float, float, float, set[int]]:
    """The angle, -180 to 180 degrees, by which the light is turned to be nearest to the list in any orientation, and how near
    it is then and without a turn: the product, 1 if they are the same but for a factor of each band that the list has;
    and the bands that are so near to it with the other sign, where others are with their own.
    """
    n_bands = min(count_bands(exact), TURNED_BANDS)
    exact = exact[: n_bands**2]
    orders = np.array([degree_order(row)[1] for row in range(n_bands**2)])
    other = np.array([l * (l + 1) - m for l, m in map(degree_order, range(n_bands**2))])
    m = np.arange(n_bands)[:, None]
    with_order, angles = np.abs(orders) == m, np.arange(ANGLES) * (2 * np.pi / ANGLES)
    best, most, plain, signed = 0.0, 0.0, 0.0, (0.0, np.ones(n_bands))
    starts = np.arange(n_bands) ** 2
    there = band_power(taken[0].table[: n_bands**2]).sum(axis=1) > 0
    whole = float(np.sqrt(band_power(exact).sum(axis=1))[there].sum())
    if not whole:
        return 0.0, 0.0, 0.0, set()
    for way in taken:
        table = way.table[: n_bands**2]
        power = per_coefficient(np.sqrt(band_power(table).sum(axis=1)))
        rows = undoing(n_bands) @ np.divide(table, power, out=np.zeros_like(table), where=power > 0)  # (192, n**2, 3)
        cosines = (exact * rows).sum(axis=2) @ with_order.T  # (192, n)
        sines = (np.sign(orders)[:, None] * exact[other] * rows).sum(axis=2) @ with_order.T
        products = cosines @ np.cos(m * angles) - sines @ np.sin(m * angles)
        orientation, place = np.unravel_index(int(products.argmax()), products.shape)
        plain = max(plain, float(products[:, 0].max()))
        bands = np.add.reduceat((exact * rows).sum(axis=2), starts, axis=1)  # (192, n)
        near = int((np.abs(bands).sum(axis=1) - FEWER * whole * (bands < 0).sum(axis=1)).argmax())
        signed = max(signed, (float(np.abs(bands[near]).sum()), np.sign(bands[near])), key=lambda one: one[0])
        if products[orientation, place] > most:
            most = float(products[orientation, place])
            best = _refined(cosines[orientation], sines[orientation], float(angles[place]))
    negative = set(np.flatnonzero(signed[1] < 0).tolist() if signed[0] >= NEAR * whole else [])
    return float((np.degrees(best) + 180) % 360 - 180), most / whole, plain / whole, negative


def _refined(cosines: Array, sines: Array, angle: float) -> float:
    """The largest value near by of the sum of cosines(m) cos m a - sines(m) sin m a, by Newton's rule."""
    m = np.arange(len(cosines))
    for _ in range(6):
        cos, sin = np.cos(m * angle), np.sin(m * angle)
        slope = float((m * (-cosines * sin - sines * cos)).sum())
        bend = float((m**2 * (-cosines * cos + sines * sin)).sum())
        if bend >= 0:
            break
        angle -= slope / bend
    return angle


def _multiplied(table: Array, exact: Array) -> Iterator[Bent]:
    """The light with its bands multiplied to have the power of the list's; the first band by 1, if a window did that."""
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
            yield Bent(said + by, exact * per_coefficient(windowed), 2, 0.0 if name else UNNAMED)
    said = all_of([f"{factor:.3g}" for factor in factors[told]])
    yield Bent(f"its bands are multiplied by {said}", exact * per_coefficient(factors), 2, UNNAMED + 1)


def _named(factors: Array, told: Array) -> str:
    """The window that has these factors, as --window takes it; "" if none of those that are known."""
    n_bands = len(factors)
    for width in (n_bands, *range(1, 4 * n_bands)):
        for name in WINDOWS:
            if np.abs(window(name, n_bands, width) - factors)[told].max() <= AS_A_WINDOW:
                return f"{name}:{width}"
    return ""
