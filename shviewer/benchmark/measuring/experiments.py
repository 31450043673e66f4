"""The ways to project a light, declared once: the name of each, where it applies, and how it is set up and run."""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shviewer.errors import UsageError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.projection.rows import project_image, project_product
from shviewer.harmonics.projection.scattered import project_samples, project_values
from shviewer.harmonics.quadrature import (
    DirectionSet,
    ProductRule,
    fejer,
    fibonacci,
    gauss_legendre,
    jittered,
    uniform_random,
)
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.function import FunctionLight
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.light import Light
from shviewer.words import meant

PAPER_SAMPLES = 10_000
"""The number of samples in the paper."""

BEST, PAPER = "best", "jittered"


class Prepared(NamedTuple):
    """A projection that has been set up; `project`() -> (n_bands**2, 3) is timed."""

    project: Callable[[], Array]
    evaluations: int | None
    """How often the light is evaluated; None if that is not known."""


Prepare = Callable[[Light, int, int, int], Prepared]
"""Light, number of samples, seed and bands -> the projection; a method ignores those it does not need."""


@dataclass(frozen=True, eq=False)
class Method:
    """One way to project."""

    name: str
    """The name in the files and on the command line."""
    words: str
    """The name in tables."""
    explanation: str
    prepare: Prepare
    applies: Callable[[Light], bool] = lambda light: True
    takes_samples: bool = True
    random: bool = False
    """Whether another seed gives another result."""
    points: Callable[[Light], int] = lambda light: 0
    """How many points a method without samples sums one by one; 0 if it is about as fast as the best way."""


def _best(light: Light, samples: int, seed: int, n_bands: int) -> Prepared:
    """The best way from scratch: every run gets a copy of the light that remembers no projection."""
    if isinstance(light, EnvironmentLight):
        return Prepared(lambda: light.layout.project(light.pixels, n_bands), texel_count(light))
    if isinstance(light, FunctionLight):
        return Prepared(lambda: replace(light).coefficients(n_bands), _function_evaluations(light, n_bands))
    if isinstance(light, LobeLight):
        return Prepared(lambda: replace(light).coefficients(n_bands), 0)
    return Prepared(lambda: copy(light).coefficients(n_bands), None)


def texel_count(light: Light) -> int:
    """The number of an image's texels that show something."""
    assert isinstance(light, EnvironmentLight)
    solid_angles = light.layout.solid_angles()
    return int(np.count_nonzero(solid_angles) * (light.pixels.shape[1] // solid_angles.shape[1]))


def _function_evaluations(light: FunctionLight, n_bands: int) -> int:
    """The number of evaluations in a projection, counted by a function that counts its calls."""
    count = 0

    def counting(directions: Array) -> ArrayLike:
        nonlocal count
        count += len(directions)
        return light.function(directions)

    FunctionLight(counting, light.name).coefficients(n_bands)
    return count


def _on_product(rule: Callable[[int], ProductRule]) -> Prepare:
    def prepare(light: Light, samples: int, seed: int, n_bands: int) -> Prepared:
        points, integrand = rule(samples), light.integrand
        return Prepared(lambda: project_product(integrand, points, n_bands)[0], len(points.theta) * points.n_columns)

    return prepare


def _on_samples(choose: Callable[[int, int], DirectionSet]) -> Prepare:
    def prepare(light: Light, samples: int, seed: int, n_bands: int) -> Prepared:
        chosen, integrand = choose(samples, seed), light.integrand
        return Prepared(lambda: project_samples(integrand, chosen, n_bands), len(chosen.weights))

    return prepare


def lat_long_texels(light: Light) -> NDArray[np.float32] | None:
    """The texels (height, width, 3) of a lat-long image; None for another light."""
    return light.pixels if isinstance(light, EnvironmentLight) and isinstance(light.layout, LatLongLayout) else None


def _per_texel(light: Light, samples: int, seed: int, n_bands: int) -> Prepared:
    """The way of most programs: every texel is a sample at its centre, weighted by the texel's solid angle."""
    assert isinstance(light, EnvironmentLight)
    solid_angles = np.broadcast_to(light.layout.solid_angles(), light.pixels.shape[:2])
    rows, columns = np.nonzero(solid_angles)
    directions = light.layout.centres(rows, columns)
    weights = solid_angles[rows, columns, None]
    everything = len(rows) == solid_angles.size

    def project() -> Array:
        texels = light.pixels.reshape(-1, 3) if everything else light.pixels[rows, columns]
        return project_values(directions, texels * weights, n_bands)

    return Prepared(project, len(rows))


def _reduced(factor: int) -> Prepare:
    """Take means of factor x factor texels, which is part of the time, then their exact integrals."""

    def prepare(light: Light, samples: int, seed: int, n_bands: int) -> Prepared:
        texels = lat_long_texels(light)
        assert texels is not None
        return Prepared(lambda: project_image(_means(texels, factor), n_bands), texels.shape[0] * texels.shape[1])

    return prepare


def _means(texels: NDArray[np.float32], factor: int) -> NDArray[np.float32]:
    """Means of blocks of factor x factor texels; over rows first, which is faster."""
    height, width = texels.shape[:2]
    rows = texels.reshape(height // factor, factor, width * 3).sum(axis=1)
    columns = rows.reshape(height // factor, width // factor, factor, 3)
    return np.asarray(sum(columns[:, :, i] for i in range(factor)) * np.float32(1 / factor**2))


def _divides(factor: int) -> Callable[[Light], bool]:
    def applies(light: Light) -> bool:
        texels = lat_long_texels(light)
        return texels is not None and not any(side % factor for side in texels.shape[:2])

    return applies


METHODS: tuple[Method, ...] = (
    Method(BEST, "best way", "the light's best way, the reference of all others", _best, takes_samples=False),
    Method(
        "gauss-legendre",
        "Gauss-Legendre",
        "Gauss-Legendre rows, equidistant azimuths, summed separably",
        _on_product(gauss_legendre),
    ),
    Method(
        "fejer",
        "Fejer lat-long",
        "a lat-long grid with the weights that make it exact, summed separably",
        _on_product(fejer),
    ),
    Method("fibonacci", "Fibonacci", "points on a spiral, of equal weight", _on_samples(lambda n, _: fibonacci(n))),
    Method(
        PAPER,
        "jittered (paper)",
        "the paper's: a random point in each of equal cells",
        _on_samples(jittered),
        random=True,
    ),
    Method("random", "plain random", "independent random points", _on_samples(uniform_random), random=True),
    Method(
        "per-texel",
        "per texel",
        "the basis at every texel's centre, weighted by its solid angle",
        _per_texel,
        lambda light: isinstance(light, EnvironmentLight),
        takes_samples=False,
        points=texel_count,
    ),
    Method("half", "half resolution", "means of 2 x 2 texels first", _reduced(2), _divides(2), takes_samples=False),
    Method(
        "quarter", "quarter resolution", "means of 4 x 4 texels first", _reduced(4), _divides(4), takes_samples=False
    ),
)


def method(name: str) -> Method:
    """The method of a name. UsageError for a name that is not in the table."""
    found = {each.name: each for each in METHODS}
    if name not in found:
        raise UsageError(f"method {name!r}: {meant(name, found)}")
    return found[name]
