"""import shviewer: light to import, one function per command, and lights of every kind."""

from __future__ import annotations

import importlib
import io
import json
import os
import subprocess
import sys
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coefficients.peer_cases import asymmetric
from PIL import Image
from places import ROOT

import shviewer
from shviewer.analysis.options import options_of
from shviewer.analysis.recipe import Recipe
from shviewer.api import NAMED_ELSEWHERE
from shviewer.cli.main import main
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.errors import ShviewerError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.function import FunctionLight
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.view import View


def test_importing_loads_neither_numpy_nor_opengl() -> None:
    program = "import sys, shviewer; shviewer.__version__; dir(shviewer); print([n for n in sys.modules if n in sys.argv[1:]])"
    heavy = ["numpy", "moderngl", "glfw", "PIL", "argparse"]
    done = subprocess.run([sys.executable, "-c", program, *heavy], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_everything_promised_is_there_and_nothing_else() -> None:
    assert all(getattr(shviewer, name) is not None for name in shviewer.__all__)
    assert set(shviewer.__all__) <= set(dir(shviewer))
    assert (Path(shviewer.__file__).parent / "py.typed").exists()
    with pytest.raises(AttributeError, match="no attribute 'render'"):
        shviewer.render  # noqa: B018


def test_project_gives_the_coefficients_and_figures_of_the_window() -> None:
    found = shviewer.project("green", 5)
    np.testing.assert_array_equal(found.coefficients, shviewer.find_light("green").coefficients(5))
    assert found.figures.relative_l2 == pytest.approx(0.2832852245674103, rel=1e-12)
    assert (found.n_bands, found.quantity) == (5, "radiance")
    muted = shviewer.project("green", 5, muted=[1, 2], window="hann", quantity="irradiance")
    assert not muted.coefficients[1:9].any()


def test_reconstruct_is_the_sum_of_the_basis() -> None:
    directions = np.random.default_rng(0).normal(size=(4, 5, 3)) * 7
    value = shviewer.reconstruct(asymmetric(6), directions)
    assert value.shape == (4, 5, 3)
    np.testing.assert_allclose(value, shviewer.evaluate_basis(directions, 6) @ asymmetric(6), rtol=0, atol=1e-13)
    with pytest.raises(ShviewerError, match="8 coefficients"):
        shviewer.reconstruct(np.zeros((8, 3)), directions)


def test_a_light_may_be_a_text_a_path_a_function_an_array_or_a_light(tmp_path: Path) -> None:
    def up(directions: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
        return np.maximum(directions[:, 2], 0.0)

    assert isinstance(shviewer.find_light(up), FunctionLight)
    assert shviewer.find_light(up).name == "up"
    assert isinstance(shviewer.find_light(asymmetric(3)), CoefficientLight)
    assert isinstance(shviewer.find_light(np.ones((4, 8, 3))), EnvironmentLight)
    assert shviewer.find_light(ROOT / "assets/scenes/studio.toml").name == "studio"
    light = shviewer.find_light("green")
    assert shviewer.find_light(light) is light
    (tmp_path / "bare.json").write_text(json.dumps(asymmetric(3).tolist()))
    assert shviewer.find_light(tmp_path / "bare.json", convention="unreal").description == "3 bands, unreal"
    assert shviewer.project(asymmetric(7)).n_bands == 7  # all that a coefficient light has
    np.testing.assert_allclose(shviewer.project(np.ones((8, 16, 3)), 1).coefficients, 2 * np.sqrt(np.pi), rtol=1e-14)


def test_options_are_told_and_taken_in_words_of_python_and_of_the_command_line() -> None:
    for function in (shviewer.project, shviewer.screenshot, shviewer.view):
        assert "--" not in (function.__doc__ or "")
    one = shviewer.project("green", 8, window="hann:4", muted="1,3-4")
    two = shviewer.project("green", 8, window="hann", window_width=4, muted=[1, 3, 4])
    np.testing.assert_array_equal(one.coefficients, two.coefficients)
    for wrong in (
        {"window": "hann:wide"},
        {"window": "dering:4"},
        {"window": "hann:4", "window_width": 3},
        {"muted": "4-3"},
    ):
        with pytest.raises(ShviewerError, match=f"^{next(iter(wrong))} "):
            shviewer.project("green", 8, **wrong)


@pytest.mark.parametrize("convention", [*CONVENTIONS, "shviewer,4pi,no-phase,y-up", "unity,by-channel"])
def test_an_array_is_read_in_the_convention_that_is_named(convention: str) -> None:
    found = shviewer.project("studio", 3)
    numbers = found.numbers(convention.removesuffix(",by-channel"))
    given = numbers.T.ravel() if "by-channel" in convention else numbers
    light = shviewer.find_light(given, convention=convention)
    own = shviewer.find_light("studio").coefficients(3)
    np.testing.assert_allclose(light.coefficients(3), own, rtol=0, atol=1e-13)


def test_cilm_of_shtools_is_read_as_an_array() -> None:
    cilm = np.zeros((2, 4, 4))
    cilm[0, 0, 0], cilm[1, 2, 1] = 1, 0.5
    light = shviewer.find_light(cilm)
    expected = np.zeros(16)
    expected[0], expected[5] = (
        np.sqrt(4 * np.pi),
        -0.5 * np.sqrt(4 * np.pi),
    )  # 4-pi-normalised, m = -1 without the phase
    np.testing.assert_allclose(light.coefficients(4), np.repeat(expected[:, None], 3, 1), rtol=1e-14)


def test_an_image_is_repaired_and_laid_out_as_its_file_would_be(tmp_path: Path) -> None:
    image = np.random.default_rng(3).random((32, 24, 3))
    image[5, 9], image[6, 10] = np.nan, -1
    np.save(tmp_path / "cross.npy", image)
    options: dict[str, Any] = {"layout": "cube", "sanitize": True}
    light, file = (shviewer.find_light(what, **options) for what in (image, tmp_path / "cross.npy"))
    assert (light.description, light.notes) == (file.description, file.notes)
    np.testing.assert_array_equal(light.coefficients(5), file.coefficients(5))
    about = shviewer.info(image, **options)
    assert (about.layout, len(about.notes)) == ("cube", 2)
    assert np.isnan(image[5, 9]).all()


@pytest.mark.parametrize(
    ("what", "options", "says"),
    [
        (asymmetric(3), {"layout": "cube"}, "layout 'cube': it is for images"),
        (asymmetric(3), {"sanitize": True}, "sanitize True: it is for images"),
        (np.ones((4, 8, 3)), {"convention": "three"}, "convention 'three': it is for coefficients"),
        (np.ones((4, 8, 3)), {"layout": "cube"}, "4 x|8 x 4"),
        (np.ones((3, 2, 5)), {"convention": "three"}, "shape .3, 2, 5. as coefficients"),
        (np.ones((25, 3)), {"convention": "three"}, "5 bands, so its numbers are not those of three"),
        (lambda directions: directions, {"layout": "cube"}, "layout 'cube': it is for files and arrays"),
        (np.ones((9, 3), complex), {}, "convention='scipy'"),
    ],
)
def test_how_a_light_is_read_is_never_ignored(what: Any, options: dict[str, Any], says: str) -> None:
    with pytest.raises(ShviewerError, match=says):
        shviewer.find_light(what, **options)


@pytest.mark.parametrize(
    ("light", "options", "says"),
    [
        ("nothing", {}, "unknown light"),
        (3, {}, "a light of type int"),
        (np.ones((8, 3)), {}, "8 coefficients"),
        (np.ones(5), {}, r"an array of shape \(5,\)"),
        (np.full((9, 3), np.nan), {}, "NaN"),
        ("green", {"bands": 129}, "129 bands"),
        ("green", {"colour": 1}, "option 'colour': it must be one of"),
        ("green", {"n_bands": 3}, "option 'n_bands': it is called bands here"),
        ("green", {"mute": [3]}, "option 'mute': it is called muted here"),
        ("green", {"window": "welch"}, "window 'welch'"),
        ("green", {"bands": 3.5}, "bands 3.5: it must be a whole number"),
        ("green", {"bands": "3"}, "bands '3': it must be a whole number"),
        ("green", {"samples": 1e3}, "samples 1000.0: it must be a whole number"),
        ("green", {"window_width": "wide"}, "window_width 'wide': it must be a finite number"),
        ("green", {"window": 3}, "window 3: it must be a text"),
        ("green", {"muted": 1}, "muted 1: it must be several bands"),
        ("green", {"camera": (1, 2)}, "option 'camera': it must be one of tolerance, quantity, "),
        ("green", {"compare": "studio"}, "studio is a built-in light; compare= takes coefficients"),
        ("green", {"compare": lambda directions: directions}, "it must be coefficients"),
    ],
)
def test_what_is_wrong_is_one_line(light: Any, options: dict[str, Any], says: str) -> None:
    with pytest.raises(ShviewerError, match=says):
        shviewer.project(light, **options)


def test_saving_converts_and_keeps_figures_only_where_they_hold(tmp_path: Path) -> None:
    found = shviewer.project("venice_sunset", 3)
    found.save(tmp_path / "a.json", "three")
    found.save(tmp_path / "b.json", "filament")
    three, filament = (json.loads((tmp_path / f"{name}.json").read_text()) for name in "ab")
    np.testing.assert_array_equal(three["coefficients"], found.numbers("three"))
    np.testing.assert_array_equal(filament["coefficients"], found.numbers("filament"))
    assert three["relative-l2"] == found.figures.relative_l2
    assert filament["relative-l2"] == found.figures.irradiance_relative_l2
    assert "minimum" in three
    assert "minimum" not in filament
    for path, convention, says in (
        ("a.png", "three", "format 'png'"),
        ("a.json", "maya", "must be one of"),
        ("a.json", "three,4pi", "not be what"),
    ):
        with pytest.raises(ShviewerError, match=says):
            found.save(tmp_path / path, convention)
    with pytest.raises(ShviewerError, match="a file of type BytesIO: give a path"):
        found.save(io.BytesIO())
    with pytest.raises(ShviewerError, match="takes 1 to 3"):
        shviewer.project("green", 4).numbers("unity")


def test_screenshot_is_the_picture_of_the_command(session_renderer: Renderer, tmp_path: Path) -> None:
    """In a process of its own: two OpenGL contexts in one thread silently mix."""
    program = (
        "import sys, shviewer, PIL.Image; a = shviewer.screenshot('studio', 8, size=(320, 160), window='lanczos');"
        " assert a.dtype == 'uint8' and a.shape == (160, 320, 3); PIL.Image.fromarray(a).save(sys.argv[1])"
    )
    command = [sys.executable, "-m", "shviewer", "screenshot", "b.png", "studio", "--bands", "8", "--window", "lanczos"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    subprocess.run([sys.executable, "-c", program, "a.png"], cwd=tmp_path, env=environment, check=True)
    subprocess.run([*command, "--size", "320", "160"], cwd=tmp_path, env=environment, check=True)
    with Image.open(tmp_path / "a.png") as first, Image.open(tmp_path / "b.png") as second:
        np.testing.assert_array_equal(np.asarray(first), np.asarray(second))


def test_report_is_given_names_as_they_are_and_everything_else_as_lights(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only what has a name can be measured in another process: `shviewer.report("cosine")` waited for pictures of green."""
    run = importlib.import_module("shviewer.benchmark.run")
    seen: list[Any] = []
    monkeypatch.setattr(run, "write_report", lambda *arguments: seen.append(arguments))
    shviewer.report("green", "somewhere", quick=True)
    shviewer.report(["green", Path("sky.exr"), np.ones((4, 3))], budget=3)
    assert seen[0][0] == ["green"]
    assert seen[1][0][:2] == ["green", "sky.exr"]
    assert seen[1][0][2].coefficients(2).shape == (4, 3)
    assert seen[0][1] == Path("somewhere")
    assert seen[0][2].quick
    assert seen[1][2].budget == 3


@pytest.mark.skipif(find_spec("mypy") is None, reason="no mypy: pip install 'shviewer[dev]'")
def test_users_are_type_checked(tmp_path: Path) -> None:
    (tmp_path / "user.py").write_text(
        "import shviewer\n\nfound = shviewer.project('green', 5, quantity='radiance')\nfound.save('x.json', 'three')\n"
        "value = shviewer.reconstruct(found.coefficients, [[0, 0, 1]])\nreveal_type(value)\n"
        "reveal_type(shviewer.report('green').rows)\nshviewer.project('green', 'five')\n"
    )
    command = [sys.executable, "-m", "mypy", "--strict", "user.py"]

    done = subprocess.run(
        command, cwd=tmp_path, env={**os.environ, "MYPYPATH": str(ROOT)}, capture_output=True, text=True, check=False
    )
    errors = [line for line in done.stdout.splitlines() if line.startswith("user.py") and "error" in line]
    assert len(errors) == 1, done.stdout
    assert 'user.py:8: error: Argument 2 to "project"' in errors[0]
    assert 'user.py:7: note: Revealed type is "int"' in done.stdout


def test_reconstruct_and_evaluate_basis_say_what_is_wrong() -> None:
    for coefficients, directions, says in (
        (np.ones((8, 3)), [0, 0, 1], "8 coefficients"),
        (np.ones((9, 2)), [0, 0, 1], "rows of red, green and blue"),
        (np.ones((9, 3)), [0, 0, 0], "finite and not zero"),
    ):
        with pytest.raises(ShviewerError, match=says):
            shviewer.reconstruct(coefficients, directions)
    for n_bands in (0, 2.5, "2"):
        with pytest.raises(ShviewerError):
            shviewer.evaluate_basis([0, 0, 1], n_bands)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"camera": (1,)}, "azimuth and elevation"),
        ({"basis": (1.5, 0)}, "basis 1.5: it must be a whole number"),
        ({"zoom": 99}, "zoom 99: it must be 0.25 to 16"),
        ({"zoom": 10**400}, "it must be a finite number"),
        ({"marks": "no"}, "marks 'no': it must be True or False"),
        ({"colour": 1}, "option 'colour': it must be one of .*samples.*zoom"),
        ({"tone": "filmic", "bands": 0}, "tone 'filmic'"),
    ],
)
def test_a_view_that_cannot_be_had_is_one_line(options: dict[str, Any], says: str) -> None:
    with pytest.raises(ShviewerError, match=says):
        shviewer.screenshot("green", **options)


@pytest.mark.parametrize("size", [(320,), (320.5, 160), 3])
def test_a_size_is_two_whole_numbers(size: Any) -> None:
    with pytest.raises(ShviewerError, match=r"width"):
        shviewer.screenshot("green", size=size)


def test_help_lists_the_options_where_they_are_taken() -> None:
    recipe, view = (options_of(holder).keys() - set(NAMED_ELSEWHERE) for holder in (Recipe, View))
    assert len(recipe) > 7
    assert len(view) > 8
    for function, names in (
        (shviewer.project, recipe),
        (shviewer.screenshot, recipe | view),
        (shviewer.view, recipe | view),
    ):
        listed = str(function.__doc__).partition("options:")[2]
        assert {line.split()[0] for line in listed.splitlines() if line.strip()} == names | {"compare"}


def test_coefficients_from_elsewhere_take_the_place_of_the_lights_own(tmp_path: Path) -> None:
    own = shviewer.project("venice_sunset", 3)
    (tmp_path / "three.json").write_text(json.dumps(own.numbers("three").tolist()))
    compared = shviewer.project("venice_sunset", compare=1.5 * own.coefficients)
    np.testing.assert_array_equal(compared.coefficients, 1.5 * own.coefficients)
    assert compared.figures.channels["all"].added > 0.1
    found = shviewer.project("venice_sunset", compare=tmp_path / "three.json")
    np.testing.assert_allclose(found.coefficients, own.coefficients, rtol=0, atol=1e-13)


def test_a_light_without_a_sun_says_so() -> None:
    with pytest.warns(UserWarning, match="green has no sun: "):
        found = shviewer.project("green", 3, split_sun=True)
    assert found.suns == ()
    assert "green has no sun: " in found.notes[-1]
    with pytest.warns(UserWarning, match="film_studio has no sun: its strongest compact source is 4"):
        shviewer.project("film_studio", 3, split_sun=True)


def test_lamps_are_taken_where_they_are_asked_for() -> None:
    assert len(shviewer.project("film_studio", 3, split_sun=True, suns="all").suns) == 1
    assert len(shviewer.project("st_fagans_interior", 3, split_sun=True, suns=2).suns) == 2
    for wrong, words in (
        (0, "suns 0: it must be auto, all or 1 to 16"),
        ("some", "suns some: it must be"),
        (1.5, "whole number"),
    ):
        with pytest.raises(shviewer.ShviewerError, match=words):
            shviewer.project("film_studio", 3, split_sun=True, suns=wrong)
    with pytest.raises(shviewer.ShviewerError, match="it says what split_sun takes; give that, too"):
        shviewer.project("film_studio", 3, suns=1)


@pytest.mark.parametrize("what", ["green", "sh.txt", "venice_sunset"])
@pytest.mark.parametrize(
    ("option", "says"),
    [({"layout": "mirrorball"}, "mean mirror-ball"), ({"convention": "tree"}, "three"), ({"convention": "x"}, "'x'")],
)
def test_a_layout_or_a_convention_that_is_none_is_refused_whatever_the_light_is(
    what: str, option: dict[str, Any], says: str, tmp_path: Path
) -> None:
    """A list of numbers raised a ValueError, and a light that needed neither took any."""
    (tmp_path / "sh.txt").write_text("1 1 1")
    with pytest.raises(shviewer.ShviewerError, match=says):
        shviewer.find_light(tmp_path / what if what == "sh.txt" else what, **option)


def test_complex_coefficients_are_refused_and_not_halved() -> None:
    found = shviewer.project("studio", 3)
    with pytest.raises(ShviewerError, match="complex coefficients: those of real functions are real"):
        shviewer.reconstruct(found.numbers("scipy"), [0, 0, 1])


def test_a_tolerance_chooses_the_bands_as_on_the_command_line() -> None:
    assert shviewer.project("green", tolerance="5%").n_bands == 15
    assert shviewer.project("green", tolerance=0.05, quantity="irradiance").n_bands == 3
    with pytest.warns(UserWarning, match="no count up to 128 is within 5 %: the best is 95.7 % with 128 bands"):
        assert shviewer.project("sun-sky", tolerance=0.05).n_bands == 128
    for options, says in (
        ({"tolerance": 5}, "did you mean|between 0 and 1"),
        ({"tolerance": "wide"}, "tolerance 'wide': it must be a finite number"),
        ({"bands": 3, "tolerance": 0.1}, "bands 3 and tolerance 0.1: give one of them"),
    ):
        with pytest.raises(ShviewerError, match=says):
            shviewer.project("green", **options)


def test_info_is_that_of_the_command_line_and_of_any_light(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "venice_sunset", "--json"]) == 0
    (said,) = json.loads(capsys.readouterr().out)
    found = shviewer.info("venice_sunset")
    assert {"schema": 1} | json.loads(json.dumps(asdict(found))) == said
    assert shviewer.info(np.ones((4, 3))).bands_needed[0].radiance == 2
    assert shviewer.info(lambda directions: directions[:, 2] ** 2).irradiance_up[0] == pytest.approx(np.pi / 2)
    with pytest.raises(ShviewerError, match="layout 'cubic'"):
        shviewer.info("venice_sunset", layout="cubic")


@pytest.mark.parametrize(
    ("light", "shown"),
    [
        ("green", "<green: two soft lobes (Green 2003)>"),
        ("venice_sunset", "<venice_sunset: environment map, 256 x 128>"),
        (np.ones((9, 3)), "<coefficients: 3 bands, shviewer>"),
        (abs, "<abs: Python function>"),
    ],
)
def test_a_light_at_the_prompt_is_one_line(light: Any, shown: str) -> None:
    assert repr(shviewer.find_light(light)) == shown
    assert repr(shviewer.find_light(light).irradiance()) == shown


def test_completion_at_the_prompt_offers_what_is_promised() -> None:
    assert dir(shviewer) == sorted(shviewer.__all__)
