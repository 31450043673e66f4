"""Lists of coefficients as people have them: what other programs, shaders and spreadsheets write, and what is assumed of it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from coefficients.found_lists import (
    COLOURED,
    FOUND,
    GREY,
    GREYS,
    IMPLIED,
    PROBE,
    REFUSED,
    ROWS,
    cases,
    lines,
    vector,
)
from helpers import refusal

from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading


def read(path: Path, text: str, convention: str = "shviewer") -> CoefficientLight:
    path.write_text(text, encoding="utf-8")
    light = find_light(str(path), Reading(convention=convention))
    assert isinstance(light, CoefficientLight)
    return light


def numbers(path: Path, text: str, convention: str = "shviewer") -> np.ndarray:
    light = read(path, text, convention)
    assert light.file is not None
    return light.file.numbers


@pytest.mark.parametrize("name", COLOURED)
def test_a_list_as_it_is_found_is_read_and_what_was_assumed_is_said(name: str, tmp_path: Path) -> None:
    text, note = COLOURED[name]
    light = read(tmp_path / name, text)
    np.testing.assert_array_equal(light.given, ROWS)
    assert "; ".join(light.notes) == note


@pytest.mark.parametrize(("name", "text", "note"), GREYS)
def test_a_grey_list_is_told_from_a_coloured_one(name: str, text: str, note: str, tmp_path: Path) -> None:
    light = read(tmp_path / name, text)
    np.testing.assert_array_equal(light.given, GREY)
    assert "; ".join(light.notes) == note


def test_a_table_of_shtools_is_that_of_shtools(tmp_path: Path) -> None:
    """The file of its own writer, for lmax 1 to 8: some sizes pass for lists of grey."""
    pyshtools = pytest.importorskip("pyshtools")
    from shviewer.coefficients.texts import parse_convention

    for lmax in range(1, 9):
        ours = np.random.default_rng(lmax).normal(size=((lmax + 1) ** 2, 1))
        theirs = parse_convention("shviewer,no-phase,4pi").from_ours(ours)
        cilm = np.zeros((2, lmax + 1, lmax + 1))
        for l in range(lmax + 1):
            for m in range(l + 1):
                cilm[:, l, m] = theirs[l * (l + 1) + m, 0], theirs[l * (l + 1) - m, 0] if m else 0.0
        pyshtools.shio.shwrite(str(tmp_path / "sh.txt"), cilm)
        light = find_light(str(tmp_path / "sh.txt"), Reading(convention="shviewer,no-phase,4pi"))
        np.testing.assert_allclose(light.coefficients(lmax + 1), np.repeat(ours, 3, axis=1), rtol=1e-14)


@pytest.mark.parametrize(("name", "text", "says"), REFUSED)
def test_what_may_mean_two_things_is_refused_with_the_way_out(name: str, text: str, says: str, tmp_path: Path) -> None:
    assert says in refusal(read, tmp_path / name, text)


@pytest.mark.parametrize("name", IMPLIED)
def test_a_convention_that_the_file_implies_is_taken_and_said_unless_another_is_named(
    name: str, tmp_path: Path
) -> None:
    text, convention, note = IMPLIED[name]
    implied = read(tmp_path / name, text, "")
    np.testing.assert_allclose(implied.given, read(tmp_path / name, text, convention).given, rtol=1e-15)
    assert any(note in said for said in implied.notes)
    assert implied.file is not None
    assert implied.file.implied
    np.testing.assert_array_equal(read(tmp_path / name, text).given, ROWS)
    assert not any(note in said for said in read(tmp_path / name, text).notes)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [("0,125 0 2,500", [[0.125, 0, 2.5]]), ("1,2 3,4 5,6 7,8 9", np.arange(1, 10)[:, None] * [1, 1, 1])],
)
def test_commas_are_decimal_ones_only_where_they_can_be_nothing_else(
    text: str, wanted: np.ndarray, tmp_path: Path
) -> None:
    np.testing.assert_array_equal(numbers(tmp_path / "a.txt", text), wanted)


@pytest.mark.parametrize("shape", [(12, 4), (6, 8), (4, 12)])
def test_lines_that_cannot_be_rows_are_one_list(shape: tuple[int, int], tmp_path: Path) -> None:
    text = lines(np.arange(48).reshape(shape))
    np.testing.assert_array_equal(numbers(tmp_path / "a.txt", text), np.arange(48).reshape(16, 3))


def test_a_grey_list_that_could_be_rows_of_four_says_so(tmp_path: Path) -> None:
    assert read(tmp_path / "a.txt", "1 2 3 4").notes == ("4 numbers in one list: taken as 2 grey bands",)
    (note,) = read(tmp_path / "a.txt", "1 " * 16).notes
    assert note == "16 numbers in one list: taken as 4 grey bands, not as 4 rows of four"


def test_one_band_has_an_l_and_m_too(tmp_path: Path) -> None:
    for end in ("", "\n", "\n\n"):
        assert numbers(tmp_path / "a.csv", "l,m,r,g,b\n0,0,1,2,3" + end).tolist() == [[1, 2, 3]]


def test_a_first_number_among_others_is_no_count(tmp_path: Path) -> None:
    rows = np.vstack([[8, 1, 2], ROWS[1:]])
    light = read(tmp_path / "a.glsl", ", ".join(map(vector, rows)))
    np.testing.assert_array_equal(light.given, rows)
    assert not light.notes


def test_a_table_of_cmgen_that_is_no_irradiance_implies_nothing(tmp_path: Path) -> None:
    text = IMPLIED["sh.txt"][0].replace("irradiance, ", "")
    assert "a bare list of numbers" in refusal(read, tmp_path / "sh.txt", text, "")


def test_what_is_beside_the_coefficients_of_a_light_is_applied_or_said_not_to_be(tmp_path: Path) -> None:
    probe = read(tmp_path / "a.json", json.dumps({"object": {"children": [PROBE | {"intensity": 2}]}}), "shviewer")
    np.testing.assert_array_equal(probe.given, 2 * ROWS)
    assert probe.notes == ("multiplied by its intensity, 2",)
    light = {"irradianceCoefficients": ROWS.tolist(), "intensity": 2, "rotation": [0, 1, 0, 0]}
    assert "its intensity and rotation are not applied" in read(tmp_path / "b.json", json.dumps(light)).notes
    plain = light | {"intensity": 1, "rotation": [0, 0, 0, 1]}
    assert not any("applied" in note for note in read(tmp_path / "c.json", json.dumps(plain)).notes)


def test_complex_numbers_of_which_each_is_a_pair_are_no_rgb_and_something(tmp_path: Path) -> None:
    from shviewer.coefficients.programs import CONVENTIONS
    from shviewer.coefficients.writing import real_columns

    for rows, columns in ((ROWS, 6), (GREY, 2)):
        pairs = real_columns(CONVENTIONS["scipy"].from_ours(rows))[:, :columns]
        for text in (lines(pairs), lines([pairs.ravel()])):
            np.testing.assert_allclose(
                read(tmp_path / "a.txt", text, "scipy").given, rows, rtol=0, atol=1e-5
            )  # six digits


def test_every_row_of_the_guide_is_a_case_of_these_tests() -> None:
    refusals = [says for _, _, says in REFUSED]
    for row in FOUND:
        assert row.case in cases() or any(says.startswith(row.case) for says in refusals), row.case
