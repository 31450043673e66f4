"""Each of the usual mistakes, alone and together with every other, is found and named."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from coefficients.peer_cases import A, asymmetric, spoiled

from shviewer.coefficients.parts.axes import Axes, turn
from shviewer.coefficients.parts.quantities import OVER_PI
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.suspects import usual_suspects

MISTAKES = {
    "phase": "without the Condon-Shortley phase",
    "order": "with m and -m swapped",
    "y-up": "in axes +x+z-y (y-up)",
    "y-up-left": "in axes +x+z+y (y-up-left)",
    "forward": "in axes +y+z+x (z forward)",
    "pi": "divided by pi",
    "times pi": "multiplied by pi",
    "4pi": "divided by sqrt(4 pi)",
    "A": "multiplied by A(l), as irradiance",
    "no A": "not multiplied by A(l), as radiance",
    "SN3D": "divided by sqrt(2l+1), as in SN3D",
}
AXES, SCALES, DEGREES = ("y-up", "y-up-left", "forward"), ("pi", "times pi", "4pi"), ("A", "no A", "SN3D")


@pytest.mark.parametrize("name", MISTAKES)
def test_one_mistake_is_named(name: str) -> None:
    best = usual_suspects(asymmetric(5), spoiled(asymmetric(3), name))[0]
    assert best.changes == (MISTAKES[name],)
    assert best.error < 1e-6


def pairs() -> list[tuple[str, str]]:
    same_kind = (AXES, SCALES, DEGREES)
    return [pair for pair in combinations(MISTAKES, 2) if not any(set(pair) <= set(kind) for kind in same_kind)]


@pytest.mark.parametrize("pair", pairs(), ids=" ".join)
def test_two_mistakes_are_named(pair: tuple[str, str]) -> None:
    best = usual_suspects(asymmetric(5), spoiled(asymmetric(3), *pair))[0]
    assert set(best.changes) == {MISTAKES[name] for name in pair}
    assert best.error < 1e-6


def test_nothing_is_suspected_of_numbers_that_are_right() -> None:
    found = usual_suspects(asymmetric(4), asymmetric(3))
    assert found[0].words == "as they are"
    assert found[0].error < 1e-7
    assert found[1].error > 0.1


def test_noise_does_not_buy_a_longer_explanation() -> None:
    noise = 0.02 * np.random.default_rng(5).normal(size=(9, 3))
    best = usual_suspects(asymmetric(3), spoiled(asymmetric(3), "phase", "pi") + noise / np.pi)[0]
    assert best.words == "without the Condon-Shortley phase and divided by pi"
    assert 0.005 < best.error < 0.1


def test_strangers_stay_strangers() -> None:
    other = np.random.default_rng(9).normal(size=(36, 3))
    best = usual_suspects(asymmetric(6), other)[0]
    assert best.error > 0.5


def test_a_whole_program_is_a_simpler_explanation_than_its_parts() -> None:
    exact = asymmetric(3)
    for name in ("filament", "three", "unity"):
        numbers = np.asarray(CONVENTIONS[name].from_ours(exact))
        readings = {
            (f"in the convention of {other}",): exact_again / (A if convention.quantity == OVER_PI else 1)
            for other, convention in CONVENTIONS.items()
            if not convention.complex
            for exact_again in [convention.to_ours(numbers)]
        }
        best = usual_suspects(exact, numbers, readings)[0]
        assert best.words == f"in the convention of {name}"
        assert best.error < 1e-7  # the root of a difference of sums


def test_black_lights_and_empty_numbers_have_an_answer() -> None:
    zero = np.zeros((9, 3))
    assert usual_suspects(zero, zero)[0].error == 0
    assert usual_suspects(zero, asymmetric(3))[0].error == np.inf
    assert usual_suspects(asymmetric(3), zero)[0].error == 1


def test_half_a_turn_is_called_the_phase() -> None:
    """(-1)^m is what turning by 180 degrees about z does: nobody could tell them apart."""
    best = usual_suspects(asymmetric(4), turn(asymmetric(4), Axes("-x-y+z")))[0]
    assert best.changes == (MISTAKES["phase"],)
