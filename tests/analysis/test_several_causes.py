"""Several things that were done to a light at once are named, each of them, and of strangers none is claimed."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

import numpy as np
import pytest

from shviewer.analysis.comparing.suspecting import FITS, Suspicion, suspect
from shviewer.coefficients.diagnosis.bent import COLOURS, turned
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.programs import OURS
from shviewer.coefficients.texts import parse_convention
from shviewer.harmonics.basis import Array
from shviewer.harmonics.filters import per_coefficient, window
from shviewer.lights.find import find_light
from shviewer.lights.mistaken import mistaken

LIGHTS = ("venice_sunset", "film_studio", "st_fagans_interior")


@cache
def known(light: str, n_bands: int) -> tuple[Array, list[tuple[list[str], Array]]]:
    return find_light(light).coefficients(n_bands), list(mistaken(find_light(light), n_bands))


def suspected(numbers: Array, light: str, n_bands: int) -> Suspicion | None:
    exact, others = known(light, n_bands)
    return suspect(Listed(numbers), exact, OURS, partial(iter, others))


Done = tuple[Array, list[str]]
"""Coefficients, and what must be said of them."""


def in_one_colour(given: Array, random: np.random.Generator, n_bands: int) -> Done:
    name, weights = list(COLOURS.items())[random.integers(len(COLOURS))]
    return np.repeat(given @ weights[:, None], 3, axis=1), [name]


def moved(given: Array, random: np.random.Generator, n_bands: int) -> Done:
    angle = random.choice([-1, 1]) * random.uniform(10, 40)
    return turned(given, angle), [f"turned by {angle:.3g} degrees"]


def windowed(given: Array, random: np.random.Generator, n_bands: int) -> Done:
    name = ("hann", "lanczos", "gauss")[random.integers(3)]
    return given * per_coefficient(window(name, n_bands, n_bands)), [f"by the window {name}:{n_bands}"]


def scaled(given: Array, random: np.random.Generator, n_bands: int) -> Done:
    factor = random.uniform(2.2, 3.0)
    return factor * given, [f"times {factor:.3g}"[:9]]


def of_three(given: Array, random: np.random.Generator, n_bands: int) -> Done:
    return np.asarray(parse_convention("three").from_ours(given)), ["in the convention of three"]


Cause = Callable[[Array, np.random.Generator, int], Done]
SEVERAL: list[tuple[Cause, ...]] = [
    (moved, scaled),
    (windowed, scaled),
    (in_one_colour, windowed),
    (in_one_colour, moved),
    (moved, windowed),
    (in_one_colour, moved, windowed, scaled),
    (moved, windowed, of_three),
]


MISTAKEN = ("radiance is clamped at 1", "radiance is tone-mapped, x/(1 + x)", "radiance is encoded for a display")
CASES = [*((causes, "") for causes in SEVERAL), *zip(SEVERAL[2:5], MISTAKEN, strict=True)]


@pytest.mark.parametrize(("causes", "mistake"), CASES)
def test_all_of_what_was_done_is_named_and_nothing_is_left(causes: tuple[Cause, ...], mistake: str) -> None:
    random = np.random.default_rng(len(causes) + len(mistake))
    light, n_bands = LIGHTS[random.integers(len(LIGHTS))], 3 if of_three in causes else 4
    exact, others = known(light, n_bands)
    numbers, said = next((one for words, one in others if words == [mistake]), exact), [mistake]
    for cause in causes:
        numbers, words = cause(numbers, random, n_bands)
        said += words
    found = suspected(numbers, light, n_bands)
    assert found is not None
    line = found.conditions(OURS)
    assert found.error < 1e-5, line
    assert all(words in line for words in said), line


@pytest.mark.parametrize(("n_bands", "grey"), [(3, True), (4, False)])
def test_of_strangers_nothing_is_claimed(n_bands: int, grey: bool) -> None:
    """Lists of other lights, turned, and of nothing: at most one in a thousand may be explained by chance."""
    random = np.random.default_rng(n_bands)
    falling = 1 / np.repeat(np.arange(1.0, n_bands + 1), 2 * np.arange(n_bands) + 1)[:, None]
    strangers = [falling * random.normal(size=(n_bands**2, 3)) for _ in range(2)]
    strangers += [turned(known(light, n_bands)[0], 25.0) for light in LIGHTS[1:2]]
    for numbers in strangers:
        shown = np.repeat(numbers.mean(axis=1, keepdims=True), 3, axis=1) if grey else numbers
        found = suspected(shown, LIGHTS[0], n_bands)
        assert found is None or (found.error > FITS and len(found.of_light) < 2), found and found.conditions(OURS)


def test_a_simple_cause_with_noise_is_not_given_a_second() -> None:
    """Noise of 3 %, more than what counts as fitting: factors of bands would take some of it away."""
    random = np.random.default_rng(3)
    exact, _ = known("venice_sunset", 4)
    numbers = turned(exact, 35.0)
    numbers = numbers + 0.03 * np.linalg.norm(numbers) / np.sqrt(numbers.size) * random.normal(size=numbers.shape)
    found = suspected(numbers, "venice_sunset", 4)
    assert found is not None
    assert len(found.of_light) == 1
    assert "the light is turned by 3" in found.of_light[0]
