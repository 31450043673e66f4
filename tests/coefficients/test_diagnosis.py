"""Each of the usual mistakes, alone and together with every other, is found and named; and strangers stay strangers."""

from __future__ import annotations

from functools import cache
from itertools import combinations

import numpy as np
import pytest
from coefficients.peer_cases import asymmetric

from shviewer.coefficients.diagnosis.chance import CHANCE
from shviewer.coefficients.diagnosis.orientations import orientations, undoing
from shviewer.coefficients.diagnosis.search import Explanation, explain
from shviewer.coefficients.diagnosis.sentences import words
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.parts.axes import Axes, alternating, mirrored_orders, turn
from shviewer.coefficients.parts.rows import ORDERS
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.coefficients.texts import convention_text, parse_convention
from shviewer.harmonics.basis import Array, orders
from shviewer.lights.find import find_light

MISTAKES = {
    "no-phase": "without the Condon-Shortley phase",
    "m-swapped": "with m and -m swapped",
    "y-up": "in axes +x+z-y (y-up)",
    "y-up-left": "in axes +x+z+y (y-up-left)",
    "+y+z+x": "in axes +y+z+x (z forward)",
    "+y-x+z": "of the map turned by a quarter, its left in the middle",
    "z-up-left": "in axes +x-y+z (z-up-left)",
    "radiance-over-pi": "divided by pi",
    "4pi": "divided by sqrt(4 pi)",
    "times=3.14159265": "multiplied by pi",
    "times=2": "times 2",
    "times=1.7": "times 1.7",
    "irradiance": "multiplied by A(l), as irradiance",
    "sn3d,times=0.28209479": "divided by sqrt(2l+1), as in SN3D",
    "schmidt,times=3.5449077": "multiplied by sqrt(2l+1)",
    "polynomial": "factors of the polynomials 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2",
    "fuma": "integrals with FuMa's weights",
    "shifted": "with a mean that is less by 0.5",
    "bgr": "with channels in the order B G R",
    "by-channel": "listed channel by channel",
    **{
        name: f"with rows in the order {ORDERS[name][1]}"
        for name in (
            *("order-playcanvas", "order-xyz", "order-alternating", "order-2001", "order-cilm", "order-m-major"),
            *("order-m-rising", "order-fuma", "order-fuma-inverse"),
        )
    },
}
"""Modifiers of our convention -> words."""


def listed(text: str, exact: Array) -> Listed:
    """What somebody who follows this convention writes, or reads in this sequence."""
    convention = parse_convention(text)
    numbers = np.asarray(convention.from_ours(exact))
    return Listed(numbers.T.reshape(numbers.shape) if convention.sequence == "by-channel" else numbers)


def explained(text: str, exact: Array) -> Explanation:
    found = explain(listed(text, exact), exact, OURS)
    assert found is not None
    return found


def same(found: Explanation, text: str, exact: Array) -> bool:
    """Whether the explanation reads the list as it was meant."""
    reads = parse_convention(convention_text(found.convention))
    meant = parse_convention(text)
    numbers = np.asarray(meant.from_ours(exact))
    return reads.sequence == meant.sequence and bool(np.allclose(reads.from_ours(exact), numbers, rtol=1e-6, atol=1e-6))


@pytest.mark.parametrize("modifier", MISTAKES)
def test_one_mistake_is_named_and_its_text_makes_the_numbers_right(modifier: str) -> None:
    found = explained(f"shviewer,{modifier}", asymmetric(3))
    assert same(found, f"shviewer,{modifier}", asymmetric(3))
    assert MISTAKES[modifier] in words(found.convention)
    assert " and " not in words(found.convention).replace("m and -m", "").replace("left and right", "")
    assert found.error < 1e-6
    assert found.chance < 1e-9


def kind(modifier: str) -> str:
    kinds = ("times", "order", "sn3d", "schmidt", "polynomial", "fuma", "4pi")
    name = next((one for one in kinds if modifier.startswith(one)), modifier)
    axes = {"y-up", "y-up-left", "+y+z+x", "+y-x+z", "z-up-left"}
    if modifier in ("irradiance", "radiance-over-pi"):
        return "quantity"
    return "axes" if modifier in axes else "scale" if name in kinds[2:] else name


PAIRS = [
    pair
    for pair in combinations(MISTAKES, 2)
    if kind(pair[0]) != kind(pair[1])
    and not {"polynomial", "no-phase"} <= set(pair)  # which polynomials have anyhow
    and not ("polynomial" in pair and "m-swapped" in pair)
    and not ("shifted" in pair and {kind(one) for one in pair} & {"scale", "order", "times", "by-channel", "quantity"})
    and not ("fuma" in pair and kind(pair[1]) == "order" and "fuma" not in pair[1])
    and not {"times", "scale"} <= {kind(one) for one in pair}
]


def test_two_mistakes_are_named_in_every_combination_that_people_make() -> None:
    wrong = []
    for pair in PAIRS[::8]:
        text = ",".join(["shviewer", *pair])
        found = explained(text, asymmetric(3))
        if not (same(found, text, asymmetric(3)) and found.error < 1e-6 and found.chance < CHANCE):
            wrong.append((pair, convention_text(found.convention)))
    assert len(PAIRS) > 200  # all are right; every eighth is tried in each run
    assert wrong == []


@pytest.mark.parametrize("name", [name for name in CONVENTIONS if "-" not in name])
def test_a_whole_program_is_a_simpler_explanation_than_its_parts(name: str) -> None:
    """sphericart and spharpy have the same numbers."""
    found = explain(Listed(np.asarray(CONVENTIONS[name].from_ours(asymmetric(3)))), asymmetric(3))
    assert found is not None
    assert convention_text(found.convention) == ("sphericart" if name == "spharpy" else name)


@pytest.mark.parametrize("n_bands", [4, 5, 6])
def test_irradiance_is_recognised_where_odd_degrees_vanish(n_bands: int) -> None:
    """A(3) = A(5) = 0: what is empty in the list is compared with what it holds, and not with the radiance."""
    for text in ("shviewer,irradiance", "shviewer,irradiance-over-pi,y-up", "shviewer,irradiance,no-phase,times=2"):
        found = explained(text, asymmetric(n_bands))
        assert same(found, text, asymmetric(n_bands))
        assert found.error < 1e-6
    tampered = np.asarray(parse_convention("shviewer,irradiance").from_ours(asymmetric(n_bands))).copy()
    tampered[9:16] = asymmetric(4)[9:16]
    other = explain(Listed(tampered), asymmetric(n_bands), OURS)
    assert other is not None
    assert other.error > 0.05


def test_nothing_is_suspected_of_numbers_that_are_right() -> None:
    found = explained("shviewer", asymmetric(4))
    assert words(found.convention) == "in the convention of shviewer"
    assert found.error < 1e-7


def test_noise_does_not_buy_a_longer_explanation() -> None:
    noise = 0.02 * np.random.default_rng(5).normal(size=(9, 3))
    numbers = np.asarray(parse_convention("shviewer,no-phase,radiance-over-pi").from_ours(asymmetric(3)))
    found = explain(Listed(numbers + noise / np.pi), asymmetric(3), OURS)
    assert found is not None
    assert words(found.convention).startswith("without the Condon-Shortley phase")
    assert words(found.convention).endswith(" and divided by pi")
    assert 0.005 < found.error < 0.1


@cache
def real_light(n_bands: int) -> Array:
    return np.asarray(find_light("venice_sunset").coefficients(n_bands))


@pytest.mark.parametrize("grey", [True, False])
@pytest.mark.parametrize("n_bands", [1, 2, 3, 4, 5])
def test_strangers_stay_strangers(n_bands: int, grey: bool) -> None:
    """Lists with the power of the light's own in each degree, and any direction: as like it as another light can be.

    8 of each kind, of which less than 8 CHANCE = 0.008 are expected to be explained; of 400 of each none was.
    """
    random = np.random.default_rng(n_bands)
    exact = real_light(n_bands)
    exact = np.repeat(exact.mean(axis=1, keepdims=True), 3, axis=1) if grey else exact
    for _ in range(8):
        numbers = random.normal(size=exact.shape)
        numbers = np.repeat(numbers[:, :1], 3, axis=1) if grey else numbers
        for l in range(n_bands):
            band = slice(l * l, (l + 1) ** 2)
            numbers[band] *= np.linalg.norm(exact[band]) / np.linalg.norm(numbers[band])
        found = explain(Listed(numbers), exact, OURS)
        assert found is not None
        assert found.chance > CHANCE, (convention_text(found.convention), found.error)


def test_few_numbers_fit_something_and_that_is_not_named() -> None:
    """One grey band is a factor away from any other; four grey numbers have a permutation that is near."""
    assert explained("shviewer,times=1.7", real_light(1)).chance > CHANCE
    assert explained("shviewer,y-up,times=1.7", real_light(3)).chance < 1e-9


def test_black_lights_and_empty_numbers_have_no_explanation() -> None:
    zero = np.zeros((9, 3))
    for numbers, exact in ((zero, zero), (asymmetric(3), zero), (zero, asymmetric(3))):
        assert explain(Listed(numbers), exact, OURS) is None


def test_half_a_turn_is_the_phase_and_the_sentence_says_both() -> None:
    """(-1)^m is what turning by 180 degrees about z does: nobody could tell them apart."""
    found = explain(Listed(turn(asymmetric(4), Axes("-x-y+z"))), asymmetric(4), OURS)
    assert found is not None
    assert convention_text(found.convention) == "shviewer,no-phase"
    assert "or of the map turned by half a turn, which is the same" in words(found.convention)


def test_turns_of_the_map_are_named_for_programs_too() -> None:
    for text, said in (
        ("three,-y-z-x", "in axes"),
        ("three,+y+z+x", "its left in the middle"),
        ("filament,+x+z-y", "its right in the middle"),
        ("unity,-x+z-y", "half a turn"),
        ("three,+x+z+y", "mirrored"),
    ):
        convention = parse_convention(text)
        found = explain(Listed(np.asarray(convention.from_ours(asymmetric(3)))), asymmetric(3), convention)
        assert found is not None
        assert said in words(found.convention, convention), (text, words(found.convention, convention))


def test_a_turn_is_said_as_it_is_seen() -> None:
    """Light from our left, +y, is written as if it came from the middle, +x."""
    left = np.zeros((4, 3))
    left[1] = -1.0  # Y(1, -1) is -y
    middle = np.zeros((4, 3))
    middle[3] = -1.0
    written = np.asarray(parse_convention("shviewer,+y-x+z").from_ours(left))
    np.testing.assert_allclose(written, middle, atol=1e-15)


def test_the_matrices_undo_what_their_orientations_did() -> None:
    coefficients = asymmetric(4)
    for orientation, matrix in list(zip(orientations(), undoing(4), strict=True))[::7]:
        done = turn(coefficients, orientation.axes)
        done = done if orientation.phase else done * alternating(orders(4))
        done = done[mirrored_orders(4)] if orientation.mirrored else done
        np.testing.assert_allclose(matrix @ done, coefficients, atol=1e-13)
    assert len(orientations()) == 192


def test_a_program_with_fewer_bands_than_the_list_is_no_explanation() -> None:
    """Six bands are compared of twelve, but the text has to read all of them."""
    numbers = np.asarray(parse_convention("shviewer,-y+z+x").from_ours(asymmetric(12)))
    found = explain(Listed(numbers), asymmetric(12))
    assert found is not None
    assert convention_text(found.convention) == "shviewer,-y+z+x"
    six = explain(Listed(numbers[:36]), asymmetric(12))
    assert six is not None
    assert convention_text(six.convention) == "directxmath"


def test_a_factor_within_the_noise_is_none() -> None:
    exact = asymmetric(3)
    noise = np.random.default_rng(2).normal(size=exact.shape)
    noisy = 1.03 * exact + 0.09 * noise * np.linalg.norm(exact) / np.linalg.norm(noise)
    found = explain(Listed(noisy), exact)
    assert found is not None
    assert found.convention.factor == 1
    quiet = explain(Listed(1.03 * exact + 0.01 * (noisy - 1.03 * exact)), exact)
    assert quiet is not None
    assert quiet.convention.factor == pytest.approx(1.03, abs=2e-3)
