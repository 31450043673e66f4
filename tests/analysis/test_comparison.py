"""--compare: the light's original beside coefficients that somebody else made of it, and what is wrong with them."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from contextlib import nullcontext, suppress
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from coefficients.peer_cases import spoiled
from numpy.typing import NDArray

from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.comparing.comparison import agrees, as_the_file_holds, caption, verdict, verdict_of
from shviewer.analysis.figures import needs
from shviewer.analysis.recipe import Recipe
from shviewer.cli.main import main
from shviewer.cli.options.modes import PARSERS
from shviewer.cli.options.states import state_from
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.texts import parse_convention
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.light import Light
from shviewer.lights.reading import Reading
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.actions import next_method, reset, with_bands
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.state import State, started, state_of
from shviewer.viewer.view import View


@cache
def venice() -> Light:
    return find_light("venice_sunset")


def given(coefficients: Array, name: str = "theirs.txt") -> CoefficientLight:
    return CoefficientLight(coefficients, name)


def of_venice(convention: str, n_bands: int = 3) -> NDArray[np.generic]:
    """The numbers of the light in a convention."""
    return np.asarray(parse_convention(convention).from_ours(venice().coefficients(n_bands)))


def told(file: Path, convention: str = "") -> tuple[str, str]:
    """What is said of a file, read as it is or in a convention that is named, and the verdict on it."""
    recipe, said = compared_with(Recipe(venice(), reading=Reading(convention=convention)), str(file))
    return said, verdict(venice(), recipe.compare)


def compared(file: CoefficientLight, **changes: object) -> Picture:
    recipe = Recipe(venice(), compare=file, **changes)
    recipe, said = as_the_file_holds(recipe, quantity="quantity" not in changes, bands="n_bands" not in changes)
    return prepare(State(recipe, View(message=said), (recipe.light,)))


def test_the_lights_own_coefficients_fit_and_have_its_own_figures() -> None:
    picture = compared(given(venice().coefficients(4)))
    plain = prepare(state_of(venice(), n_bands=4))
    np.testing.assert_allclose(picture.coefficients, plain.coefficients, rtol=0, atol=1e-14)
    assert picture.figures.relative_l2 == pytest.approx(plain.figures.relative_l2, rel=1e-9)
    assert picture.verdict == "theirs.txt agrees with the light's own to 0.0001 % over its 4 bands"


def test_the_figures_are_those_of_the_given_coefficients() -> None:
    exact = venice().coefficients(3)
    picture = compared(given(1.5 * exact))
    norm = np.sqrt(np.trace(venice().products()))
    assert picture.figures.channels["all"].added == pytest.approx(0.5 * np.linalg.norm(exact) / norm, rel=1e-9)
    np.testing.assert_array_equal(picture.coefficients, 1.5 * exact)


def test_mutes_and_windows_work_on_the_given_coefficients() -> None:
    file = given(venice().coefficients(4))
    assert not compared(file, muted=frozenset({1})).coefficients[1:4].any()
    hann = compared(file, window="hann").coefficients
    np.testing.assert_allclose(hann[1:4], file.given[1:4] * (1 + np.cos(np.pi / 4)) / 2, rtol=1e-14)


@pytest.mark.parametrize("quantity", ["radiance", "irradiance"])
def test_the_bands_needed_are_those_of_the_file_for_both_quantities(quantity: str) -> None:
    """The phase mistake changes no norm but leaves no count within 5 %; the light's own coefficients need 3 as irradiance."""
    file = given(spoiled(venice().coefficients(3), "phase"))
    found = compared(file, quantity=quantity, tolerance=0.05).needs
    own = prepare(State(Recipe(venice(), tolerance=0.05))).needs
    assert own.irradiance is not None
    assert (found.radiance, found.irradiance, found.searched) == (None, None, 3)


def test_samples_answer_for_both_quantities() -> None:
    found = {
        of: needs(Recipe("green", method="jittered", samples=400, quantity=of)) for of in ("radiance", "irradiance")
    }
    assert (found["radiance"].radiance, found["radiance"].irradiance) == (
        found["irradiance"].radiance,
        found["irradiance"].irradiance,
    )


def test_irradiance_is_compared_with_irradiance(tmp_path: Path) -> None:
    path = tmp_path / "probe.json"
    path.write_text(json.dumps(of_venice("unity").tolist()))
    file = CoefficientLight.read(path, Reading(convention="unity"))
    picture = compared(file)
    assert (picture.state.recipe.quantity, picture.state.recipe.n_bands) == ("irradiance", 3)
    assert picture.verdict == "probe agrees with the light's own to 0.0001 % over its 3 bands"
    own = prepare(state_of(venice(), n_bands=3, quantity="irradiance"))
    np.testing.assert_allclose(picture.coefficients, own.coefficients, rtol=0, atol=1e-13)
    assert picture.figures.relative_l2 == pytest.approx(own.figures.relative_l2, rel=1e-9)


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (
            ("phase",),
            "without the Condon-Shortley phase, or of the map turned by half a turn, which is the same",
        ),
        (("y-up", "pi"), "in axes +x+z-y (y-up) and divided by pi"),
        (("order", "4pi"), "with m and -m swapped and divided by sqrt(4 pi)"),
        (("A",), "multiplied by A(l), as irradiance"),
    ],
)
def test_the_usual_mistakes_are_named_in_one_line(names: tuple[str, ...], words: str) -> None:
    picture = compared(given(spoiled(venice().coefficients(3), *names)))
    assert picture.verdict.startswith("theirs.txt is ")
    assert picture.verdict.endswith(f" % off, but not at all if its numbers are {words}")
    assert "\n" not in picture.verdict


def test_another_programs_file_is_recognised_by_its_numbers(tmp_path: Path) -> None:
    for name in ("filament", "three", "unity"):
        path = tmp_path / f"{name}.json"
        path.write_text(json.dumps(of_venice(name).tolist()))
        file = CoefficientLight.read(path, Reading(convention="shviewer"))
        for quantity in ("radiance", "irradiance"):
            assert verdict_of(Recipe(venice(), quantity=quantity, compare=file)).endswith(
                f"not at all if its numbers are in the convention of {name}: --convention {name}"
            )


def test_what_nothing_explains_is_said_to_be_so() -> None:
    stranger = given(np.random.default_rng(0).normal(size=(9, 3)))
    assert " % off, which no usual mistake explains: band " in compared(stranger).verdict
    black = given(np.zeros((4, 3)))
    assert compared(black).verdict == "theirs.txt is 100 % off: its numbers are all zero"


def test_no_more_bands_are_shown_than_the_file_has() -> None:
    file = given(venice().coefficients(3))
    picture = compared(file, n_bands=9)
    assert picture.state.recipe.n_bands == 3
    assert picture.state.view.message == "theirs.txt has 3 bands"
    more = with_bands(picture.state, 4)
    assert (more.recipe.n_bands, more.view.message) == (3, "theirs.txt has 3 bands")
    assert with_bands(picture.state, 2).recipe.n_bands == 2


def test_keys_keep_the_comparison() -> None:
    state = started(state_of(venice(), compare=given(venice().coefficients(3)), n_bands=3))
    assert reset(state).recipe.compare is state.recipe.compare
    assert "those of theirs.txt" in next_method(state).view.message
    assert next_method(state).recipe.method == state.recipe.method


def test_the_picture_says_whose_coefficients_they_are() -> None:
    picture = compared(given(spoiled(venice().coefficients(3), "phase")))
    overlay = draw_overlay(picture, compose(1280, 640, 1.0))
    own = draw_overlay(prepare(state_of(venice(), n_bands=3)), compose(1280, 640, 1.0))
    longer, shorter = (sheet.boxes["reconstruction"] for sheet in (overlay, own))
    assert longer.right - longer.left > 1.2 * (shorter.right - shorter.left)
    assert "message" in overlay.boxes
    said = json.loads(metadata(picture, compose(1280, 640, 1.0), "none"))
    assert said["compare"] == {"name": "theirs.txt", "convention": "shviewer"}
    assert said["verdict"] == picture.verdict


def test_a_long_name_is_shortened_in_the_caption() -> None:
    file = given(venice().coefficients(1), "environment-of-the-second-courtyard-at-noon.json")
    assert caption(Recipe(venice(), compare=file)) == "environment...d-at-noon.json: "
    assert caption(Recipe(venice(), compare=given(venice().coefficients(1)))) == "theirs.txt: "
    assert "reconstruction" in draw_overlay(compared(file), compose(640, 320, 1.0)).boxes


def test_the_command_compares_and_says_what_is_wrong(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, renderer: Renderer
) -> None:
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(renderer))
    numbers = of_venice("three")
    (tmp_path / "theirs.json").write_text(json.dumps(numbers.tolist()))
    command = ["screenshot", str(tmp_path / "out.png"), "venice_sunset", "--compare", str(tmp_path / "theirs.json")]
    assert main([*command, "--convention", "three", "--size", "320", "160"]) == 0
    assert capsys.readouterr().err == "shviewer: theirs.json agrees with the light's own to 0.0001 % over its 3 bands\n"
    assert main([*command, "--convention", "unreal", "--size", "320", "160"]) == 0
    assert "theirs.json is " in (error := capsys.readouterr().err)
    assert "not at all if its numbers are in the convention of three" in error


@pytest.mark.parametrize(
    ("text", "kind"), [("own.hdr", "an image"), ("venice_sunset", "a built-in light"), ("own.toml", "a scene")]
)
def test_only_coefficients_are_compared(text: str, kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["screenshot", "out.png", "green", "--compare", text]) == 3
    assert f"{text} is {kind}; --compare takes coefficients (.json, .gltf, .csv, .txt" in capsys.readouterr().err


def test_small_disagreement_is_a_figure() -> None:
    exact = venice().coefficients(3)
    agreement = "theirs.txt agrees with the light's own to 0.5 % over its 3 bands"
    assert compared(given(1.005 * exact)).verdict == f"{agreement}, all of it a factor of 1.005"
    noise = np.random.default_rng(2).normal(size=exact.shape)
    noise *= 0.005 * np.linalg.norm(exact) / np.linalg.norm(noise)
    assert compared(given(exact + noise)).verdict == agreement
    assert compared(given(1.01 * (exact + noise))).verdict.endswith(" bands, most of it a factor of 1.0097")
    assert compared(given(exact[:1])).verdict.endswith("over its one band")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: 2 * c, "times 2"),
        (lambda c: 0.5 * c, "times 0.5"),
        (lambda c: np.pi * c, "multiplied by pi"),
        (lambda c: c[:, ::-1], "with channels in the order B G R"),
        (
            lambda c: 2 * spoiled(c, "phase")[:, ::-1],
            "without the Condon-Shortley phase, or of the map turned by half a turn, which is the same, with channels"
            " in the order B G R and times 2",
        ),
        (lambda c: c.T.reshape(9, 3), "listed channel by channel"),
    ],
)
def test_factors_channels_and_the_order_of_the_list_are_usual_mistakes(
    change: Callable[[Array], Array], words: str
) -> None:
    said = compared(given(np.ascontiguousarray(change(venice().coefficients(3))))).verdict
    assert said.endswith(f" off, but not at all if its numbers are {words}")


@pytest.mark.parametrize("named", ["shviewer", "filament", "unity", "unreal", "three,z-up"])
def test_mistakes_are_found_together_whichever_convention_was_named(named: str, tmp_path: Path) -> None:
    numbers = np.sqrt(4 * np.pi) * of_venice("three")
    (tmp_path / "theirs.json").write_text(json.dumps(numbers[:, ::-1].tolist()))
    said = verdict(venice(), CoefficientLight.read(tmp_path / "theirs.json", Reading(convention=named)))
    explained = said.partition("its numbers are ")[2]
    assert "multiplied by sqrt(4 pi)" in explained
    assert "with channels in the order B G R" in explained
    assert "in the convention of three" in explained or "y-up" in explained
    assert explained.endswith(("--convention three,bgr,times=3.544907702", "no-phase,bgr,times=3.544907702"))


def test_where_nothing_explains_it_the_band_is_named() -> None:
    exact = venice().coefficients(4)
    wrong = exact.copy()
    wrong[1:4] += np.random.default_rng(0).normal(size=(3, 3)) * np.linalg.norm(exact[1:4])
    assert re.search(r"explains: band 1 is \d+ % off, the others fit$", verdict(venice(), given(wrong)))
    wrong[4:9] *= 1.5
    assert re.search(r"explains: band 1 is \d+ % off, band 2 by less, the others fit$", verdict(venice(), given(wrong)))


@pytest.mark.parametrize(
    "text", [name for name, one in CONVENTIONS.items() if name not in ("spharpy", "arcore-phase", "arkit-phase")]
)
def test_a_convention_that_nobody_names_is_found(text: str, tmp_path: Path) -> None:
    np.save(tmp_path / "bare.npy", of_venice(text))
    said, agreement = told(tmp_path / "bare.npy")
    same = {"webxr-no-phase": "three", "arcore-no-phase": "three", "arkit-no-phase": "three"}
    named = "shviewer, in axes +x+z-y (y-up), fits, as webxr-phase would: --convention shviewer,y-up"
    found = named if text == "webxr-phase" else f"{same.get(text, text)} fits"
    found += (
        ", which is shviewer,no-phase, or shviewer of the map turned by half a turn" if text == "sphericart" else ""
    )
    assert said == f"bare.npy does not name its convention: {found}"
    assert agreement.endswith("agrees with the light's own to 0.0001 % over its 3 bands")


@pytest.mark.parametrize(
    "text", ["shviewer,m-swapped,4pi", "shviewer,y-up,4pi", "shviewer,y-up-left,sn3d", "filament,z-up", "three,+z-x-y"]
)
def test_a_bent_convention_is_found_too(text: str, tmp_path: Path) -> None:
    (tmp_path / "bare.json").write_text(json.dumps(of_venice(text).tolist()))
    said, agreement = told(tmp_path / "bare.json")
    assert ", fits: --convention " in said
    if text.startswith("shviewer"):  # the simplest of several that fit as well
        assert parse_convention(said.split()[-1]) == parse_convention(text)
    assert agrees(agreement)


def test_finder_and_comparison_are_one(tmp_path: Path) -> None:
    """What the finder takes agrees; a list that is off by a constant is said to be so, in a plain sentence."""
    numbers = 2 * of_venice("three")
    (tmp_path / "bare.txt").write_text(" ".join(map(str, numbers.reshape(-1))))
    said, agreement = told(tmp_path / "bare.txt")
    assert said == "bare.txt does not name its convention: three, times 2, fits: --convention three,times=2"
    assert agreement.endswith("agrees with the light's own to 0.0001 % over its 3 bands")


def test_where_no_convention_fits_the_nearest_is_named_and_where_it_fails(tmp_path: Path) -> None:
    np.save(tmp_path / "bare.npy", np.random.default_rng(3).normal(size=(9, 3)))
    said, agreement = told(tmp_path / "bare.npy")
    assert re.search(r"convention: no usual one fits; read as \S+, which is \d+ % off$", said)
    assert "which no usual mistake explains" in agreement


def hints(said: str) -> list[str]:
    return re.findall(r"--convention (\S+)", said)


PASTED = (
    *("filament,+x+z-y", "three,y-up-left", "shviewer,irradiance", "shviewer,irradiance-over-pi,y-up", "three,-x+z+y"),
    *("shviewer,order-fuma,4pi", "babylon,bgr,times=1.3", "shviewer,polynomial,order-xyz", "e3nn,+y-x+z", "3dgs,gbr"),
    *(
        "shviewer,m-swapped,-z-y+x,times=0.017",
        "shtools,y-up",
        "scipy,+x+z-y,times=2",
        "godot,times=2",
        "ambix,times=0.5",
    ),
)


@pytest.mark.parametrize("text", PASTED)
@pytest.mark.parametrize("n_bands", [3, 4, 5])
def test_every_hint_that_is_printed_can_be_pasted_and_gives_what_it_says(
    text: str, n_bands: int, tmp_path: Path
) -> None:
    try:
        numbers = of_venice(text, n_bands)
    except ValueError:
        pytest.skip("a program with fewer bands")
    file = tmp_path / "bare.npy"
    np.save(file, numbers)
    found, agreement = told(file)
    assert agrees(agreement)
    named = [*hints(found), "shviewer", "three", "filament", "unity,z-up", "ambix"]
    for start in named:
        with suppress(LightError):  # a convention that cannot hold it
            said = told(file, start)[1]
            for hint in hints(said):
                assert agrees(told(file, hint)[1]), (start, hint)
            assert agrees(said) or hints(said), start


def test_a_hint_on_a_stamped_file_can_be_pasted_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "stamped.json"
    assert main(["project", "venice_sunset", "--bands", "3", "--convention", "three", "-o", str(file)]) == 0
    file.write_text(file.read_text().replace('"light": "venice', '"light": "other'))
    rows = json.loads(file.read_text())
    rows["coefficients"] = (np.array(rows["coefficients"]) * 3).tolist()
    file.write_text(json.dumps(rows))
    (hint,) = hints(told(file)[1])
    assert hint == "three,times=3"
    said, agreement = told(file, hint)
    assert said == "stamped.json: says that its convention is three; read as three,times=3"
    assert agrees(agreement)


@pytest.mark.parametrize("n_bands", [3, 4, 5])
def test_what_is_irradiance_is_measured_as_irradiance(n_bands: int, tmp_path: Path) -> None:
    """From 4 bands on the radiance of band 3 cannot be had from it; read as radiance it is named."""
    np.save(tmp_path / "e.npy", of_venice("shviewer,irradiance", n_bands))
    assert told(tmp_path / "e.npy", "shviewer")[1].endswith(
        "not at all if its numbers are multiplied by A(l), as irradiance: --convention shviewer,irradiance"
    )
    assert agrees(told(tmp_path / "e.npy", "shviewer,irradiance")[1])


def test_three_lines_that_are_row_by_row_after_all(tmp_path: Path) -> None:
    rows = venice().coefficients(3).reshape(3, 9)
    (tmp_path / "lines.txt").write_text("\n".join(" ".join(map(repr, row)) for row in rows.tolist()))
    said = told(tmp_path / "lines.txt")[0]
    assert said.endswith("shviewer, listed row by row, fits: --convention shviewer,interleaved")


def test_what_fits_alike_is_said(tmp_path: Path) -> None:
    """A constant light tells neither phases nor axes apart."""
    (tmp_path / "bare.txt").write_text("3.5449077018110318 " * 3 + "0 " * 24)
    said = compared_with(Recipe("constant"), str(tmp_path / "bare.txt"))[1]
    others = "three, unreal, sphericart, babylon, directxmath, e3nn, mitsuba and webxr-phase"
    assert said == f"bare.txt does not name its convention: shviewer fits, as {others} would"


def test_a_list_alone_is_refused_and_told_how_to_find_out(tmp_path: Path) -> None:
    (tmp_path / "bare.txt").write_text("1 1 1")
    with pytest.raises(LightError, match=r"--compare finds it out: shviewer LIGHT --compare FILE"):
        find_light(str(tmp_path / "bare.txt"))


def test_what_a_glossy_surface_reflects_is_compared_as_that(tmp_path: Path) -> None:
    file = tmp_path / "glossy.json"
    assert main(["project", "venice_sunset", "--bands", "4", "--for", "glossy:0.4", "-o", str(file)]) == 0
    assert told(file)[1] == "glossy.json agrees with the light's own to 0.0001 % over its 4 bands"


@pytest.mark.parametrize("light", [(), ("green",)])
def test_it_is_said_with_which_light_where_none_is_named(
    light: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    np.save(tmp_path / "own.npy", find_light("green").coefficients(3))
    words = ["out.png", *light, "--compare", str(tmp_path / "own.npy"), "--convention", "shviewer"]
    state_from(PARSERS["screenshot"]().parse_intermixed_args(words), all_lights=False)
    said = f"no LIGHT is named, so that {tmp_path / 'own.npy'} is compared with green: name its own"
    assert (said in capsys.readouterr().err) == (not light)


@pytest.mark.parametrize("named", ["three", "unity", "shviewer,y-up,no-phase", "ambix"])
def test_what_was_named_is_kept_where_one_thing_differs(named: str, tmp_path: Path) -> None:
    """A(l) in place of radiance, or none in place of irradiance, is said of the convention that was named."""
    meant = parse_convention(named)
    exact = venice().coefficients(3)
    other = "radiance" if meant.quantity == "irradiance-over-pi" else "irradiance"
    np.save(tmp_path / "own.npy", np.asarray(replace(meant, quantity=other).from_ours(exact)))
    file = CoefficientLight.read(tmp_path / "own.npy", Reading(convention=named))
    said = verdict(venice(), file)
    assert "not at all if its numbers are" in said
    assert "multiplied by A(l), as " in said
    assert "convention of" not in said
    (hint,) = hints(said)
    assert agrees(verdict(venice(), CoefficientLight.read(tmp_path / "own.npy", Reading(convention=hint))))
