"""Single rows with the other sign, in another's place, repeated or empty are found in any convention, and only there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import shviewer
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.diagnosis.chance import CHANCE
from shviewer.coefficients.diagnosis.search import Explanation, explain
from shviewer.coefficients.diagnosis.sentences import slips_in_words
from shviewer.coefficients.diagnosis.slips import Slip, mended
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.programs import OURS
from shviewer.coefficients.texts import convention_text, parse_convention
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array

TEXTS = (
    *("shviewer", "shviewer,y-up,no-phase", "shviewer,irradiance", "shviewer,-y+z+x,irradiance-over-pi", "ambix"),
    *("e3nn", "shtools", "shviewer,order-m-major,sn3d", "shviewer,m-swapped,times=2", "mitsuba,bgr", "directxmath"),
    *("filament", "three,z-up", "unity", "playcanvas", "fuma", "babylon", "godot"),
)
SEED = 41


def light(random: np.random.Generator, n_bands: int) -> Array:
    """A light as there are: grey for the most part, falling with the degree."""
    numbers = random.normal(size=(n_bands**2, 1)) * random.uniform(0.5, 1.5, size=3)
    numbers += 0.2 * random.normal(size=(n_bands**2, 3))
    return np.asarray(numbers / (1 + np.sqrt(np.arange(n_bands**2)))[:, None])


def cases(kind: str, n_bands: int, count: int) -> list[tuple[Convention, Array, Array, tuple[Slip, ...]]]:
    """Conventions, lights, lists with slips, and the slips."""
    random = np.random.default_rng([SEED, n_bands, *kind.encode()])
    found: list[tuple[Convention, Array, Array, tuple[Slip, ...]]] = []
    while len(found) < count:
        convention = parse_convention(str(random.choice(TEXTS)))
        exact = light(random, n_bands)
        if (convention.most_bands or n_bands) < n_bands or convention.fewest_bands > n_bands:
            continue
        numbers = np.asarray(convention.from_ours(exact)).copy()
        rows = [int(row) for row in random.permutation(n_bands**2)]
        told = [row for row in rows if np.abs(numbers[row]).max() > 0.02 * np.abs(numbers).max()]
        if kind == "sign":
            slips = (Slip(told[0], told[0], -1),)
        elif kind == "signs":
            slips = tuple(Slip(row, row, -1) for row in told[:2])
        elif kind == "swapped":
            slips = (Slip(told[0], told[1], 1), Slip(told[1], told[0], 1))
        elif kind == "repeated":
            slips = (Slip(told[0], told[1], 1),)
        else:
            slips = tuple(Slip(row, row, 0) for row in told[: 1 if kind == "empty" else 2])
        before = numbers.copy()
        for slip in slips:
            numbers[slip.row] = slip.sign * before[slip.holds]
        found.append((convention, exact, numbers, tuple(sorted(slips))))
    return found


def put_right(found: Explanation, numbers: Array, exact: Array) -> Array:
    """The light's coefficients that the list holds once what the explanation says is undone."""
    wanted = np.asarray(found.convention.from_ours(exact))
    return found.convention.to_ours(mended(numbers, found.slips, wanted))


@pytest.mark.parametrize("kind", ["sign", "signs", "swapped", "repeated", "empty", "two empty"])
@pytest.mark.parametrize("n_bands", [3, 4, 5])
def test_the_rows_that_are_wrong_are_named_in_the_convention_that_was_meant(kind: str, n_bands: int) -> None:
    for convention, exact, numbers, slips in cases(kind, n_bands, 4):
        found = explain(Listed(numbers), exact, convention)
        assert found is not None
        assert (found.slips, convention_text(found.convention)) == (slips, convention_text(convention))
        assert found.chance <= CHANCE
        assert found.error < 1e-6


@pytest.mark.parametrize("kind", ["sign", "swapped", "empty"])
@pytest.mark.parametrize("n_bands", [2, 3, 4, 5])
def test_what_is_said_of_a_list_that_names_nothing_is_true(kind: str, n_bands: int) -> None:
    """For few bands several explanations fit as well: whichever is given, with it undone the list is the light's."""
    for _, exact, numbers, _ in cases(kind, n_bands, 4):
        for named in (None, OURS):
            found = explain(Listed(numbers), exact, named)
            if found is None or found.chance > CHANCE or found.error > 1e-6:
                continue  # it is not named, or only as what is nearest
            held = put_right(found, numbers, exact)
            wanted = found.convention.to_ours(np.asarray(found.convention.from_ours(exact)))
            np.testing.assert_allclose(held, wanted[: len(held)], rtol=0, atol=1e-6 * np.abs(wanted).max())


@pytest.mark.parametrize("n_bands", [3, 5])
def test_a_slip_is_found_under_noise_and_noise_is_no_slip(n_bands: int) -> None:
    """Noise of 1 % of the norm over all rows, far below the row that is wrong."""
    random = np.random.default_rng(SEED)
    for convention, exact, right, _ in cases("none", n_bands, 6):
        numbers = np.asarray(convention.from_ours(exact)).copy()
        noise = random.normal(size=right.shape)
        noise *= 0.01 * np.linalg.norm(numbers) / np.linalg.norm(noise)
        plain = explain(Listed(numbers + noise), exact, convention)
        assert plain is not None
        assert not plain.slips
        row = int(np.abs(numbers[1:]).max(axis=1).argmax()) + 1
        numbers[row] *= -1
        found = explain(Listed(numbers + noise), exact, convention)
        assert found is not None
        assert found.slips == (Slip(row, row, -1),)


def test_slips_are_told_in_words() -> None:
    def said(*slips: tuple[int, int, int], text: str = "shviewer") -> list[str]:
        return slips_in_words(tuple(Slip(*slip) for slip in slips), parse_convention(text), 3)

    assert said((3, 3, -1)) == ["row 3 (l=1, m=1) has the other sign"]
    assert said((3, 3, -1), text="playcanvas") == ["row 3 (l=1, m=0) has the other sign"]
    assert said(*((row, row, -1) for row in (1, 2, 3))) == ["rows 1-3 (band 1) have the other sign"]
    assert said((1, 3, 1), (3, 1, 1)) == ["rows 1 (l=1, m=-1) and 3 (l=1, m=1) are swapped"]
    assert said((1, 3, 1), (3, 1, -1)) == ["rows 1 (l=1, m=-1) and 3 (l=1, m=1) hold what belongs into rows 3 and -1"]
    assert said((1, 3, 1), (2, 1, 1), (3, 2, 1)) == ["rows 1-3 (band 1) hold what belongs into rows 3, 1 and 2"]
    assert said((3, 1, 1)) == ["row 3 (l=1, m=1) holds what belongs into row 1, too"]
    assert said(*((row, row, 0) for row in range(4, 9))) == ["rows 4-8 (band 2), which are 0, are left out"]
    assert said((2, 2, -1), (6, 6, 0)) == [
        "row 2 (l=1, m=0) has the other sign",
        "row 6 (l=2, m=0), which is 0, is left out",
    ]


@pytest.mark.parametrize("n_bands", [3, 4, 5])
def test_a_band_of_another_light_is_no_slip(n_bands: int) -> None:
    """Each of its rows would come as near to what is said of it in at most one of twenty lists; of 180 none was named."""
    for seed, (convention, exact, _, _) in enumerate(cases("none", n_bands, 12)):
        numbers = np.asarray(convention.from_ours(exact)).copy()
        numbers[1:4] = light(np.random.default_rng([seed, n_bands]), 2)[1:4] * np.abs(numbers[1:4]).max()
        found = explain(Listed(numbers), exact, convention)
        assert found is None or not found.slips or found.chance > CHANCE


PAIRS = {
    "one row with m = 0": (lambda rows: rows.__setitem__(6, -rows[6]), (Slip(6, 6, -1),)),
    "both of a pair": (lambda rows: rows.__setitem__([5, 7], -rows[[5, 7]]), (Slip(5, 5, -1), Slip(7, 7, -1))),
    "an empty pair": (lambda rows: rows.__setitem__([4, 8], 0), (Slip(4, 4, 0), Slip(8, 8, 0))),
    "a pair the wrong way round": (lambda rows: rows.__setitem__([5, 7], rows[[7, 5]]), ()),
}
"""What happens to complex rows, and the slips that are found: those with which they are still of a real function."""


@pytest.mark.parametrize("what", PAIRS)
def test_rows_of_complex_lists_slip_in_pairs(what: str) -> None:
    exact = light(np.random.default_rng(SEED), 4)
    rows, (spoil, slips) = parse_convention("scipy").from_ours(exact).copy(), PAIRS[what]
    spoil(rows)
    found = explain(Listed(rows), exact)
    assert found is not None
    assert (found.slips, found.error < 1e-6) == (slips, bool(slips))
    if slips:
        wanted = np.asarray(parse_convention("scipy").from_ours(exact))
        np.testing.assert_allclose(mended(rows, slips, wanted), wanted)


def test_one_complex_row_without_its_partner_is_named(tmp_path: Path) -> None:
    rows = shviewer.project("venice_sunset", 4).numbers("scipy").copy()
    rows[7] *= -1
    np.save(tmp_path / "one.npy", rows)
    with pytest.raises(
        LightError, match=r"row 5 and its partner of the other m are not conjugate .* one of them is wrong"
    ):
        shviewer.project("venice_sunset", compare=tmp_path / "one.npy")
