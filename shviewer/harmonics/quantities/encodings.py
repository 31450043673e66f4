"""Encodings of irradiance that engines store in few numbers, made of nine coefficients of radiance, or for cubes of all.

What is stored is evaluated by a formula of decoding.py, which says what c, v, u and z are; and it is a sum of bands, exactly so
but for Geomerics', which has every band, in closed form: its first GEOMERICS_BANDS leave less than 1e-5 of its peak.
    l1              c0 ... c3.
    geomerics       the same. q^p has the zonal coefficients 4 pi/(p+1) times the product of (p-k+1)/(p+k+1) for k = 1 ... l.
    zh3             c0 ... c3, and of band 2 the part that is symmetric about u, z = sqrt(4 pi/5) sum of Y(2, m)(u) c(2, m).
    hallucinated    c0 ... c3, from which z is guessed.
    ...-shared      one axis for all channels, that of their luminance, as programs do.
    zh3-solved      the same five with another band 1, nearer to the irradiance.
    l2, l2-deringed c0 ... c8 as they are, and with the factors of deringing.py or of a window.
    ambient-cube    six faces (ambient_cube.py), the irradiance there or, fitted, what is nearest to all of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.deringing import dering
from shviewer.harmonics.extremes.climbing import climb
from shviewer.harmonics.filters import irradiance_factors, per_coefficient, window
from shviewer.harmonics.quadrature import fibonacci
from shviewer.harmonics.quantities.ambient_cube import (
    CUBE_BANDS,
    FACES,
    bands_of_cube,
    fitted,
    products_of_cube,
    sampled,
)
from shviewer.harmonics.quantities.decoding import FORMULAS, axes, hallucination, lengths, one_sidedness, vectors
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.harmonics.rotation import rotate
from shviewer.harmonics.zonal import orient

BANDS = 3
"""Bands of radiance that encodings are made of, but for cubes, which take what there is."""

GEOMERICS_BANDS = ENCODED_BANDS["geomerics"]

SEARCHED, SEARCH_ROUNDS = 2000, 40
"""Directions, and rounds of climbing from the best of them, for the axis of `solved`."""


class Encoding(NamedTuple):
    """One way to store irradiance."""

    words: str
    floats: int
    """Numbers that are stored for a channel."""
    bands: int
    """Bands of the irradiance that it stands for."""
    store: Callable[..., Array]
    """Radiance (n**2, 3), n at least BANDS -> numbers (floats, 3)."""
    expand: Callable[..., Array]
    """Numbers (floats, 3) -> irradiance (bands**2, 3)."""
    formula: str = ""
    """The one of FORMULAS that has the irradiance in a direction; "" for what is only reported."""

    @property
    def turns(self) -> bool:
        """Whether it turns with the light; a cube stands in the axes of the world."""
        return self.formula != "cube"

    def standing(self, turn: Array) -> Encoding:
        """The same for a light that is turned by a rotation (3, 3), in its frame: of cubes, whose axes are not the light's."""
        if self.turns:
            return self
        faces = FACES @ turn
        return self._replace(store=partial(self.store, faces=faces), expand=partial(self.expand, faces=faces))

    @property
    def summed(self) -> bool:
        """Whether its numbers are coefficients and no more, so that factors of bands apply to them."""
        return self.formula in ("l1", "l2")

    @property
    def coefficients(self) -> int:
        """How many of its numbers are coefficients, which come first."""
        return (9 if self.floats == 9 else 4) * self.turns

    @property
    def places(self) -> tuple[str, ...]:
        """What each number is called."""
        if not self.turns:
            return "+x", "-x", "+y", "-y", "+z", "-z"
        return (*(f"c{number}" for number in range(self.coefficients)), "z")[: self.floats]

    def make(self, radiance: Array) -> Array:
        """Radiance (n**2, 3), n at least BANDS -> irradiance (bands**2, 3)."""
        return self.expand(self.store(radiance))


@dataclass(frozen=True, eq=False)
class Stored:
    """An irradiance as one of ENCODINGS keeps it."""

    name: str
    numbers: Array
    """(floats, 3)."""
    turn: Array = field(default_factory=lambda: np.eye(3))
    """The rotation (3, 3) of the light, in whose frame directions are, against the axes of a cube."""

    @property
    def encoding(self) -> Encoding:
        return ENCODINGS[self.name]

    @property
    def with_axes(self) -> Array:
        """The numbers, and of a cube its axes in the frame of the light: what shaders/encodings.glsl takes, (k, 3)."""
        return self.numbers if self.encoding.turns else np.concatenate([self.numbers, self.turn])

    @property
    def radiance(self) -> Array:
        """The radiance that it tells of, at most (9, 3): its own coefficients, and beyond them what the irradiance has."""
        count = min(self.encoding.bands, BANDS) ** 2
        found = self.encoding.expand(self.numbers)[:count] / per_coefficient(irradiance_factors(round(count**0.5)))
        found[: self.encoding.coefficients] = self.numbers[: self.encoding.coefficients]
        return np.asarray(found)

    def irradiance(self, normals: Array) -> Array:
        """Irradiance in unit directions (k, 3): (k, 3)."""
        return FORMULAS[self.encoding.formula](self.numbers, normals @ self.turn.T)

    def products(self) -> Array:
        """Integrals of E_i E_j over the sphere for channels i and j, (3, 3); of Geomerics' those of its bands."""
        if not self.encoding.turns:
            return products_of_cube(self.numbers)
        made = self.encoding.expand(self.numbers)
        return np.asarray(made.T @ made)

    def turned(self, matrix: Array) -> Stored:
        """The same of the light carried along by a rotation (3, 3); a cube stays where it is."""
        if not self.encoding.turns:
            return replace(self, turn=self.turn @ matrix.T)
        count = self.encoding.coefficients
        return replace(self, numbers=np.concatenate([rotate(self.numbers[:count], matrix), self.numbers[count:]]))

    def weighted(self, factors: Array) -> Stored | None:
        """With a factor for each band, as of a window; None where its formula takes none."""
        if (factors == 1).all():
            return self
        if not self.encoding.summed:
            return None
        return replace(self, numbers=self.numbers * per_coefficient(factors[: self.encoding.bands]))


def linear(radiance: Array, n_bands: int) -> Array:
    """The first bands of irradiance as they are: coefficients of radiance -> of irradiance, (n_bands**2, 3)."""
    return np.asarray(radiance[: n_bands**2] * per_coefficient(irradiance_factors(n_bands)))


def geomerics(numbers: Array, scale: float = 1.0, ratio: float = 1 / np.sqrt(3)) -> Array:
    """The bands of Geomerics' curve, (GEOMERICS_BANDS**2, 3), in closed form.

    scale, ratio: what is wrong with other variants: a factor of all, and |v|/c0 times `ratio` in place of r.
    """
    found = np.zeros((GEOMERICS_BANDS**2, 3))
    k = np.arange(1, GEOMERICS_BANDS)
    shares = np.minimum(one_sidedness(numbers, lengths(vectors(numbers)), ratio), 1.0)
    for channel, (c0, r, axis) in enumerate(zip(numbers[0], shares, axes(numbers, shared=False)[0], strict=True)):
        p, mean = 1 + 2 * r, scale * np.pi * c0 / (2 * np.sqrt(np.pi))
        zonal = np.append(1.0, 2 * r / (1 + r) * np.cumprod((p - k + 1) / (p + k + 1))) * 4 * np.pi * mean
        found[:, channel] = orient(zonal, axis)
    return found


def code_as_is(numbers: Array) -> Array:
    """Geomerics' as it stands in common code: radiance in place of irradiance, so that all surfaces are 12.84 % too bright."""
    return geomerics(numbers, scale=2 / np.sqrt(np.pi), ratio=0.5)


def five_numbers(radiance: Array, shared: bool = False) -> Array:
    """What zh3 stores, (5, 3)."""
    u, there = axes(radiance, shared)
    along = (evaluate_basis(u, BANDS)[:, 4:] * radiance[4:9].T).sum(axis=1)
    return np.concatenate([radiance[:4], [there * np.sqrt(4 * np.pi / 5) * along]])


def zh3(numbers: Array, shared: bool = False) -> Array:
    """The three bands of ZH3, (9, 3). shared: with one axis for all channels."""
    return _with_zonal(numbers, numbers[4], shared)


def hallucinated(numbers: Array, shared: bool = False) -> Array:
    """The three bands of ZH3 with its fifth number guessed from the other four, (9, 3)."""
    return _with_zonal(numbers, hallucination(numbers, shared), shared)


def solved(radiance: Array) -> Array:
    """Like five_numbers, with band 1 changed so that bands 1 and 2 of the irradiance together are as near as five can be.

    For an axis u the best band 1 is its part along u, if that is positive: what is left is least where v.u^2 + z(u)^2 is most.
    """
    factors = irradiance_factors(BANDS)
    changed = radiance[: BANDS**2].copy()
    for channel in range(3):
        own = radiance[: BANDS**2, [channel]]
        v = vectors(own)[0]

        def kept(u: Array, own: Array = own, v: Array = v) -> Array:
            along = np.sqrt(4 * np.pi / 5) * (evaluate_basis(u, BANDS)[:, 4:] @ own[4:, 0])
            return np.asarray((factors[1] * np.maximum(u @ v, 0)) ** 2 + (factors[2] * along) ** 2)

        starts = fibonacci(SEARCHED).directions
        best = starts[np.argsort(-kept(starts))[:8]]
        values, found = climb(kept, best, 2 / np.sqrt(SEARCHED), SEARCH_ROUNDS)
        u = found[int(np.argmax(values))]
        changed[[3, 1, 2], channel] = max(float(v @ u), 1e-12 * float(np.linalg.norm(v))) * u * [-1, -1, 1]
    return five_numbers(changed)


def _with_zonal(numbers: Array, z: Array, shared: bool) -> Array:
    """l1, and the zonal band 2 of z about the axes: (9, 3)."""
    u, there = axes(numbers, shared)
    band = evaluate_basis(u, BANDS)[:, 4:].T * (there * z * np.sqrt(4 * np.pi / 5))
    return linear(np.concatenate([numbers[:4], band]), BANDS)


def deringed(radiance: Array) -> Array:
    """Radiance (9, 3) whose irradiance is that of `radiance`, deringed."""
    return np.asarray(radiance[: BANDS**2] * per_coefficient(dering(linear(radiance, BANDS)).factors))


def _windowed(name: str) -> Callable[[Array], Array]:
    """Radiance (9, 3) with a window of four bands."""
    return lambda radiance: np.asarray(radiance[: BANDS**2] * per_coefficient(window(name, BANDS, 4)))


def _first(count: int) -> Callable[[Array], Array]:
    return lambda radiance: radiance[:count]


def _bands(n_bands: int) -> Callable[[Array], Array]:
    return lambda numbers: linear(numbers, n_bands)


ENCODINGS = {
    "l1": Encoding("L1, linear", 4, 2, _first(4), _bands(2), "l1"),
    "geomerics": Encoding("L1, Geomerics", 4, GEOMERICS_BANDS, _first(4), geomerics, "geomerics"),
    "hallucinated": Encoding("ZH3 hallucinated", 4, BANDS, _first(4), hallucinated, "hallucinated"),
    "hallucinated-shared": Encoding(
        "ZH3 hallucinated, shared axis", 4, BANDS, _first(4), partial(hallucinated, shared=True), "hallucinated_shared"
    ),
    "zh3": Encoding("ZH3", 5, BANDS, five_numbers, zh3, "zh3"),
    "zh3-shared": Encoding(
        "ZH3, shared axis", 5, BANDS, partial(five_numbers, shared=True), partial(zh3, shared=True), "zh3_shared"
    ),
    "zh3-solved": Encoding("ZH3, solved", 5, BANDS, solved, zh3, "zh3"),
    "ambient-cube": Encoding("ambient cube", 6, CUBE_BANDS, sampled, bands_of_cube, "cube"),
    "ambient-cube-fitted": Encoding("ambient cube, fitted", 6, CUBE_BANDS, fitted, bands_of_cube, "cube"),
    "l2": Encoding("L2, linear", 9, BANDS, _first(9), _bands(BANDS), "l2"),
    "l2-deringed": Encoding("L2, deringed", 9, BANDS, deringed, _bands(BANDS), "l2"),
}
"""Those that are shown, written and read, by their names on the command line."""

REPORTED = ENCODINGS | {
    "l2-hann": Encoding("L2, Hann window of 4", 9, BANDS, _windowed("hann"), _bands(BANDS), "l2"),
    "l2-lanczos": Encoding("L2, Lanczos window of 4", 9, BANDS, _windowed("lanczos"), _bands(BANDS), "l2"),
    "code-as-is": Encoding("a trap: Geomerics as in common code", 4, GEOMERICS_BANDS, _first(4), code_as_is),
}
"""Those of the report."""
