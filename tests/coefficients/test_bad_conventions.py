"""Conventions and lists that cannot go together: one line with the way out, and nothing written."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from coefficients.peer_cases import asymmetric
from helpers import refusal

from shviewer.cli.main import main
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.texts import parse_convention
from shviewer.errors import UsageError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading


def cilm_of(rows: np.ndarray) -> np.ndarray:
    """cilm of each channel of rows in our order, (k, 2, n, n)."""
    n_bands = round(len(rows) ** 0.5)
    cilm = np.zeros((rows.shape[1], 2, n_bands, n_bands))
    for l in range(n_bands):
        for m in range(-l, l + 1):
            cilm[:, int(m < 0), l, abs(m)] = rows[l * (l + 1) + m]
    return cilm


def in_our_order(n_bands: int) -> np.ndarray:
    """What SHTOOLS has, in our order of rows."""
    rows = np.asarray(CONVENTIONS["shtools"].from_ours(asymmetric(n_bands)))
    found = np.empty_like(rows)
    found[CONVENTIONS["shtools"].rows(n_bands)] = rows
    return found


@pytest.mark.parametrize("n_bands", [1, 2, 3, 6])
@pytest.mark.parametrize("kind", ["npy", "npz", "json"])
def test_cilm_of_three_channels_or_one_is_read_as_shtools_has_it(n_bands: int, kind: str, tmp_path: Path) -> None:
    cilm = cilm_of(in_our_order(n_bands))
    for array, wanted in ((cilm, asymmetric(n_bands)), (cilm[0], np.repeat(asymmetric(n_bands)[:, :1], 3, axis=1))):
        path = tmp_path / f"cilm.{kind}"
        if kind == "npy":
            np.save(path, array)
        elif kind == "npz":
            np.savez(path, coefficients=array)
        else:
            path.write_text(json.dumps(array.tolist()))
        light = find_light(str(path))
        assert isinstance(light, CoefficientLight)
        np.testing.assert_allclose(light.given, wanted, rtol=0, atol=1e-13)
        assert "taken as SHTOOLS makes it if not told otherwise" in light.notes[0]
        orthonormal = find_light(str(path), Reading(convention="shviewer,no-phase"))
        np.testing.assert_allclose(
            orthonormal.coefficients(n_bands)[0, 0], wanted[0, 0] / np.sqrt(4 * np.pi), rtol=1e-12
        )


def test_the_table_of_pyshtools_itself_is_read(tmp_path: Path) -> None:
    pyshtools = pytest.importorskip("pyshtools")
    table = pyshtools.SHCoeffs.from_array(cilm_of(in_our_order(5))[1])
    np.save(tmp_path / "own.npy", table.to_array())
    light = find_light(str(tmp_path / "own.npy"))
    np.testing.assert_allclose(light.coefficients(5)[:, 0], asymmetric(5)[:, 1], rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    ("array", "says"),
    [
        (np.ones((2, 3, 4)), "an image is (height, width, 3), cilm of SHTOOLS (2, n, n)"),
        (np.ones((2, 2, 3, 3)), "cilm of SHTOOLS is (2, n, n), or (3, 2, n, n) for red, green and blue: transpose it"),
        (np.ones((3, 3, 2, 2)), "an array of shape (3, 3, 2, 2)"),
        (np.ones((2, 3, 3)), "where m is above l, or at cilm[1, l, 0], where none can be"),
        (1j * cilm_of(asymmetric(2))[0], "convert them first: SHCoeffs.convert(kind='real')"),
        (np.zeros((2, 129, 129)), "129 bands: at most 128 are read"),
    ],
)
def test_a_cilm_of_the_wrong_shape_is_one_line(array: np.ndarray, says: str, tmp_path: Path) -> None:
    np.save(tmp_path / "bad.npy", array)
    assert says in refusal(find_light, str(tmp_path / "bad.npy"), Reading(convention="shtools"))


@pytest.mark.parametrize(
    ("numbers", "convention", "says"),
    [
        (np.ones((9, 1)), "three,by-channel", "9 numbers are not read by-channel"),
        (np.ones((16, 3)), "playcanvas", "16 rows|4 bands, so its numbers are not those of playcanvas"),
        (np.ones((16, 3)), "shviewer,order-xyz", "rows in order-xyz, 4 bands: it is defined for 1 to 3"),
        (np.ones((16, 3)), "shviewer,polynomial", "4 bands, so its numbers are not those of shviewer"),
        (np.ones((25, 3)), "fuma", "has at most 4"),
        (np.ones((9, 3)), "three,times=0", "a factor is a number above 0"),
        (np.ones((9, 3)), "three,times=nan", "a factor is a number above 0"),
        (np.ones((9, 3)), "three,bgr,rbg", "bgr and rbg contradict each other"),
        (np.ones((9, 3)), "arkit", "name a reading, arkit-phase or arkit-no-phase"),
        (np.ones((9, 3)) + 1j, "three", "complex numbers; of the conventions only scipy has them"),
    ],
)
def test_numbers_that_a_convention_cannot_hold_are_one_line(
    numbers: np.ndarray, convention: str, says: str, tmp_path: Path
) -> None:
    np.save(tmp_path / "bad.npy", numbers)
    said = refusal(find_light, str(tmp_path / "bad.npy"), Reading(convention=convention))
    assert any(one in said for one in says.split("|"))


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (
            ("--convention", "three,by-channel"),
            "by-channel says how a list is read; what is written has a row for each l and m",
        ),
        (("--convention", "webxr"), "name a reading, webxr-phase or webxr-no-phase"),
        (
            ("--convention", "godot", "--for", "irradiance"),
            "contradicts --convention godot, which takes radiance-over-pi",
        ),
        (("--convention", "playcanvas", "--bands", "4"), "4 bands: playcanvas takes 1 to 3"),
        (
            ("--convention", "shviewer,order-2001", "--bands", "4"),
            "rows in order-2001, 4 bands: it is defined for 1 to 3",
        ),
        (("--convention", "shviewer,fuma", "--bands", "5"), "FuMa's weights are defined for 1 to 4"),
        (("--convention", "babylon,order-xyz"), "are shviewer,-y+z+x,order-xyz,irradiance-over-pi"),
        (("--convention", "mitsuba", "--bands", "11"), "11 bands: mitsuba takes 1 to 10"),
    ],
)
def test_what_cannot_be_written_is_one_line_and_no_file(
    arguments: tuple[str, ...], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["project", "green", *arguments, "-o", str(tmp_path / "a.json")]) == 2
    error = capsys.readouterr().err
    assert says in error
    assert error.splitlines()[-1].startswith("shviewer: ")
    assert not (tmp_path / "a.json").exists()


def test_numbers_in_python_are_rows_too() -> None:
    import shviewer

    with pytest.raises(UsageError, match="says how a list is read"):
        shviewer.project("green", 3).numbers("three,by-channel")
    doubled = shviewer.project("green", 3).numbers("three,bgr,times=2")
    np.testing.assert_array_equal(doubled, 2 * np.asarray(shviewer.project("green", 3).numbers("three"))[:, ::-1])


def test_a_flat_list_of_arkit_is_channel_by_channel_and_rows_are_rows(tmp_path: Path) -> None:
    numbers = np.asarray(CONVENTIONS["arkit-phase"].from_ours(asymmetric(3)))
    (tmp_path / "flat.txt").write_text(" ".join(map(repr, numbers.T.ravel().tolist())))
    np.save(tmp_path / "rows.npy", numbers)
    for name in ("flat.txt", "rows.npy"):
        light = find_light(str(tmp_path / name), Reading(convention="arkit-phase"))
        np.testing.assert_allclose(light.coefficients(3), asymmetric(3), rtol=0, atol=1e-13)
    web = find_light(str(tmp_path / "flat.txt"), Reading(convention="webxr-phase,by-channel"))
    np.testing.assert_allclose(web.coefficients(3), asymmetric(3), rtol=0, atol=1e-13)


def test_rows_that_name_l_and_m_are_in_no_order_of_their_own(tmp_path: Path) -> None:
    """A table with l and m is the same whatever order its program has; a number of the row alone is that order."""
    ours = in_our_order(3)
    lines = [
        f"{l},{m}," + ",".join(map(repr, ours[l * (l + 1) + m].tolist())) for l in range(3) for m in range(-l, l + 1)
    ]
    (tmp_path / "named.csv").write_text("\n".join(["l,m,red,green,blue", *lines[::-1]]))
    light = find_light(str(tmp_path / "named.csv"), Reading(convention="shtools"))
    np.testing.assert_allclose(light.coefficients(3), asymmetric(3), rtol=0, atol=1e-13)
    rows = np.asarray(CONVENTIONS["shtools"].from_ours(asymmetric(3)))
    numbered = "\n".join(f"sh[{i}] = vec3({', '.join(map(repr, row))});" for i, row in enumerate(rows.tolist()))
    (tmp_path / "numbered.txt").write_text(numbered)
    light = find_light(str(tmp_path / "numbered.txt"), Reading(convention="shtools"))
    np.testing.assert_allclose(light.coefficients(3), asymmetric(3), rtol=0, atol=1e-13)


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        ("Unity", "convention 'Unity': did you mean unity?"),
        ("threejs,z-up", "convention 'threejs': did you mean three?"),
        ("three,yup", "convention modifier 'yup': did you mean y-up?"),
        ("y-up,no-phase", "whose name comes first: shviewer,y-up,no-phase"),
        ("times=2", "whose name comes first: shviewer,times=2"),
        ("xyz", "convention 'xyz': it must be one of shviewer, filament"),
    ],
)
def test_a_convention_that_is_nearly_right_is_told_what_is_right(text: str, advice: str) -> None:
    with pytest.raises(ValueError, match=re.escape(advice)):
        parse_convention(text)
