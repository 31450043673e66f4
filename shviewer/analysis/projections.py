"""Projections of lights by any method, timed, and what each way has cost in this session.

A light is projected once per method, to at least MAX_DIRECT_BANDS bands; a band key then only takes more or fewer of them.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from shviewer.analysis.cache import MEMORY, remember
from shviewer.analysis.recipe import Recipe
from shviewer.errors import UsageError, refused_as
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.harmonics.projection.rows import project_product
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import DirectionSet, gauss_legendre, jittered
from shviewer.harmonics.rotation import rotate
from shviewer.lights.analytic.lobe import lobes_form
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.light import Light
from shviewer.limits import MAX_DIRECT_BANDS
from shviewer.progress import tell

if TYPE_CHECKING:
    from shviewer.harmonics.quantities.encodings import Stored

MOST_MEASUREMENTS = 128
"""How many are kept per light, quantity and bands: more than the keys reach, at most 1 KiB each."""


class Way(NamedTuple):
    """A way to project. The best way draws no samples, and does not depend on how the light is turned."""

    method: str = "best"
    samples: int = 0
    seed: int = 0
    turn: tuple[float, ...] | None = None
    """As in `Recipe`, where samples stand in the world."""
    given: CoefficientLight | None = None
    """Coefficients in place of all that."""


BEST = Way()


@dataclass(frozen=True, eq=False)
class Projection:
    """Coefficients (n**2, 3) of all bands computed, with the method, the number of evaluations, and the time taken."""

    coefficients: Array
    method: str
    evaluations: int | None
    milliseconds: float | None
    """The time; None if nothing was projected: given coefficients, or some that the light had kept."""
    radiance: Array
    """The coefficients of the light's source, from which those of another quantity follow."""
    stored: Stored | None = None
    """What an encoding keeps of the irradiance, whose bands the coefficients are; None for the bands themselves."""

    @property
    def n_bands(self) -> int:
        return count_bands(self.coefficients)

    def stored_as(self, factors: Sequence[float]) -> Stored | None:
        """The numbers of the encoding that is shown with a factor for each band; None where there is none, or takes none."""
        return self.stored and self.stored.weighted(np.array(factors))

    @property
    def evaluation_noun(self) -> str:
        """The noun for one of its evaluations."""
        return "samples" if self.method == "jittered" else "points"


@dataclass(frozen=True)
class Measurement:
    """The time and the errors of one way to project a light: a few numbers, kept longer than the projection itself."""

    way: Way
    words: str
    """The method as `Projection` names it."""
    milliseconds: float
    """The least of all repetitions."""
    repetitions: int
    errors: Array = field(compare=False)
    """Relative L2 error with the first n = 1 ... N bands, (N,); it follows from the other fields and the light."""


def way_of(recipe: Recipe) -> Way:
    """The way of a recipe: samples, seed and turn that its method does not depend on are always the same."""
    if recipe.compare is not None:
        return Way("given", given=recipe.compare)
    return BEST if recipe.method == "best" else Way(recipe.method, recipe.samples, recipe.seed, recipe.turn)


def project(light: Light, way: Way, n_bands: int) -> Projection:
    """Project a light; another quantity of a sampled light comes from the samples of the light itself."""
    if way.given is not None:
        return _given_projection(light, way.given, n_bands)
    if way.turn is not None:
        return _turned_projection(light, way, n_bands)
    found = _measured_projection(light, way, n_bands)
    with MEMORY.lock:
        known = _known(light, n_bands)
        if way in known:  # not if another thread has read the light again
            known.move_to_end(way)
    return found


def measurements(light: Light, n_bands: int) -> tuple[Measurement, ...]:
    """The measurements of this session for projecting the light to `n_bands` bands, by their ways."""
    with MEMORY.lock:
        return tuple(found for _, found in sorted(_known(light, n_bands).items())) if light in MEMORY else ()


def _known(light: Light, n_bands: int) -> OrderedDict[Way, Measurement]:
    known: OrderedDict[Any, Measurement] = MEMORY.results(light, (Measurement, light, n_bands))
    return known


def time_best(light: Light, n_bands: int) -> None:
    """Measure the best way, where it was not: what a light had at hand took no time, such as what a search for bands made."""
    source = light.source
    again = source.anew()
    if again is None or BEST in (found.way for found in measurements(light, n_bands)):
        return
    tell("timing the best way")
    start = perf_counter()
    radiance = again.coefficients(n_bands)
    spent = 1000 * (perf_counter() - start)
    for one in dict.fromkeys((source, light)):
        _measure(one, BEST, Projection(one.from_source(radiance), source.best_method, None, spent, radiance))


def _measure(light: Light, way: Way, projection: Projection) -> None:
    """Measure a projection that took time and keep the numbers; a repetition keeps the lesser time."""
    assert projection.milliseconds is not None
    n_bands, shown = projection.n_bands, projection.coefficients
    exact = shown if way == BEST else project(light, BEST, n_bands).coefficients
    errors = errors_by_band_count(light.products(), exact, shown)
    with MEMORY.lock:
        known = _known(light, n_bands)
        spent = _known(light.source, n_bands).get(way) if light is not light.source else None
        if spent:  # the only time spent was that on the light itself
            known[way] = replace(spent, errors=errors)
        else:
            before = known.get(way)
            least = min(projection.milliseconds, before.milliseconds if before else np.inf)
            repetitions = 1 + (before.repetitions if before else 0)
            known[way] = Measurement(way, projection.method, least, repetitions, errors)
        if len(known) > MOST_MEASUREMENTS:
            known.popitem(last=False)


@remember(most=8, doing="projecting")
def _turned_projection(light: Light, way: Way, n_bands: int) -> Projection:
    """A light projected by samples that stand still while it turns; the coefficients are in its own frame."""
    if light is not light.source:
        source = project(light.source, way, n_bands)
        return replace(source, coefficients=light.from_source(source.coefficients))
    sampled = way.method == "jittered"
    points = jittered(way.samples, way.seed) if sampled else gauss_legendre(way.samples).direction_set()
    moved = DirectionSet(points.directions @ np.array(way.turn).reshape(3, 3).T, points.weights)
    start = perf_counter()
    radiance = project_samples(light.integrand, moved, n_bands)
    spent = 1000 * (perf_counter() - start)
    return Projection(radiance, "jittered" if sampled else "Gauss-Legendre", len(points.weights), spent, radiance)


@remember(most=8, doing="projecting")
def turned_exactly(light: Light, turn: tuple[float, ...], n_bands: int) -> Projection:
    """The best way, as it stands in the world and turned back. Exact coefficients of an image or a function turn with it."""
    found, source = project(light, BEST, n_bands), light.source
    if not source.lobes:
        return found
    light_from_world = np.reshape(turn, (3, 3))
    lobes = [replace(lobe, axis=lobe.axis @ light_from_world) for lobe in source.lobes]
    there = lobes_form([lobe.profile for lobe in lobes], lobes)
    radiance = rotate(there.coefficients(there.zonal(n_bands)), light_from_world)
    return replace(found, coefficients=light.from_source(radiance), radiance=radiance)


@remember(most=16, doing="encoding the irradiance")
def encoded(light: Light, projection: Projection, name: str, turn: tuple[float, ...] | None = None) -> Projection:
    """An irradiance as one of ENCODINGS keeps it, made of the first bands of a projection, in the frame of the light.

    turn: the rotation of the light, row by row, whose cube is wanted.
    """
    from shviewer.harmonics.quantities.encodings import ENCODINGS, Stored

    matrix = np.eye(3) if turn is None else np.reshape(turn, (3, 3))
    encoding = ENCODINGS[name].standing(matrix)
    with refused_as(UsageError, f"encode {name}: "):
        numbers = encoding.store(projection.radiance[: MAX_DIRECT_BANDS**2])
    coefficients = np.zeros_like(projection.coefficients)
    coefficients[: encoding.bands**2] = encoding.expand(numbers)
    stored = Stored(name, numbers) if encoding.turns else Stored(name, numbers, matrix)
    return replace(projection, coefficients=coefficients, stored=stored)


@remember(most=8)
def _given_projection(light: Light, given: CoefficientLight, n_bands: int) -> Projection:
    held = given.through(light.quantity).coefficients(n_bands)
    return Projection(held, given.read_as, None, None, given.coefficients(n_bands))


@remember(most=32, doing="projecting")
def _measured_projection(light: Light, way: Way, n_bands: int) -> Projection:
    """Project, take the time, and keep the measurement; what took none has the time that was measured before, if any."""
    projection = _timed_projection(light, way, n_bands)
    if projection.milliseconds is not None:
        _measure(light, way, projection)
        return projection
    with MEMORY.lock:
        before = _known(light, n_bands).get(way)
    return replace(projection, milliseconds=before.milliseconds) if before else projection


def _timed_projection(light: Light, way: Way, n_bands: int) -> Projection:
    """Project and take the time: of a convolved light that of its source, of coefficients that the light has kept none."""
    if light is not light.source:
        source = project(light.source, way, n_bands)
        return replace(source, coefficients=light.from_source(source.coefficients))
    start, evaluations, kept = perf_counter(), None, False
    if way.method == "jittered":
        directions = jittered(way.samples, way.seed)
        evaluations = len(directions.weights)
        coefficients = project_samples(light.integrand, directions, n_bands)
        words = "jittered"
    elif way.method == "gauss-legendre":
        rule = gauss_legendre(way.samples)
        evaluations = len(rule.theta) * rule.n_columns
        coefficients = project_product(light.integrand, rule, n_bands)[0]
        words = "Gauss-Legendre"
    else:
        kept = n_bands <= light.kept_bands
        coefficients = light.coefficients(n_bands)
        words = light.best_method
    spent = None if kept else 1000 * (perf_counter() - start)
    return Projection(coefficients, words, evaluations, spent, coefficients)
