"""`shviewer project` from the command line to the files."""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from harmonics.independent import random_directions
from places import ASSETS

from shviewer.cli.main import main
from shviewer.cli.status_line import StatusLine
from shviewer.coefficients.programs import CONVENTIONS, READINGS
from shviewer.coefficients.stamp import Stamp
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.harmonics.rotation import turn
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.words import percent

Capture = pytest.CaptureFixture[str]


def project(*arguments: object) -> int:
    return main(["project", *map(str, arguments)])


def held(path: Path) -> CoefficientLight:
    light = find_light(str(path))
    assert isinstance(light, CoefficientLight)
    return light


def test_the_file_holds_the_light_and_says_everything_about_it(tmp_path: Path) -> None:
    out = tmp_path / "green.json"
    assert project("-o", out) == 0
    said = json.loads(out.read_text())
    green = find_light("green")
    np.testing.assert_array_equal(said["coefficients"], green.coefficients(5))
    assert said["shviewer-coefficients"] == 1
    words = {key: said[key] for key in ("basis", "phase", "index", "axes", "normalisation", "one-over-pi")}
    assert words == {
        "basis": "orthonormal real spherical harmonics",
        "phase": "Condon-Shortley phase kept",
        "index": "l(l+1) + m",
        "axes": "x y z are our +x +y +z; z up, right-handed",
        "normalisation": "orthonormal",
        "one-over-pi": "not divided by pi",
    }
    exact = green.coefficients(5)
    assert said["relative-l2"] == pytest.approx(errors_by_band_count(green.products(), exact, exact)[-1], rel=1e-12)
    assert (said["light"], said["quantity"], said["window"], said["muted"], said["method"]) == (
        "green",
        "radiance",
        "none",
        "none",
        "closed form",
    )
    assert "samples" not in said
    assert "seed" not in said


def test_window_mutes_method_samples_and_seed_are_applied_and_said(tmp_path: Path) -> None:
    out = tmp_path / "green.csv"
    options = [
        "--bands",
        6,
        "--window",
        "hann",
        "--mute",
        "1,3",
        "--method",
        "jittered",
        "--samples",
        1024,
        "--seed",
        7,
    ]
    assert project("green", "-o", out, *options) == 0
    text = out.read_text()
    for line in ("window: hann of 6 bands", "muted: 1 3", "method: jittered", "samples: 1024", "seed: 7", "bands: 6"):
        assert f"# {line}\n" in text
    rows = held(out).coefficients(6)
    assert not rows[1:4].any()
    assert not rows[9:16].any()
    assert rows[0].any()
    first = text
    assert project("green", "-o", out, *options) == 0
    assert out.read_text() == first  # nothing depends on the clock


def test_a_program_gets_what_it_takes_without_being_asked_for_it(tmp_path: Path) -> None:
    assert project("venice_sunset", "--convention", "filament", "-o", tmp_path / "sh.glsl") == 0
    text = (tmp_path / "sh.glsl").read_text()
    assert "// quantity: irradiance-over-pi\n" in text
    assert "// bands: 3\n" in text
    assert "vec3 sh_venice_sunset_irradiance_over_pi(vec3 direction)" in text
    mean = find_light("venice_sunset").coefficients(1)[0] / (2 * np.sqrt(np.pi))
    assert held(tmp_path / "sh.glsl").file is not None
    np.testing.assert_allclose(held(tmp_path / "sh.glsl").file.numbers[0], mean, rtol=1e-12)


def test_axes_and_phase_are_options_and_axes_may_begin_with_a_minus(tmp_path: Path) -> None:
    assert project("-o", tmp_path / "a.json", "--axes", "y-up", "--no-phase") == 0
    assert json.loads((tmp_path / "a.json").read_text())["convention"] == "shviewer,y-up,no-phase"
    assert project("-o", tmp_path / "b.json", "--axes=-y+x+z") == 0
    assert json.loads((tmp_path / "b.json").read_text())["axes"] == "x y z are our -y +x +z; z up, right-handed"
    for name in "ab":
        np.testing.assert_allclose(
            held(tmp_path / f"{name}.json").given, find_light("green").coefficients(5), rtol=0, atol=1e-14
        )


def test_a_coefficient_file_is_converted_with_all_its_bands_and_its_own_quantity(tmp_path: Path) -> None:
    assert project("studio", "--bands", 7, "--for", "irradiance", "-o", tmp_path / "a.json") == 0
    assert project(tmp_path / "a.json", "--convention", "sphericart", "-o", tmp_path / "b.csv") == 0
    first, second = json.loads((tmp_path / "a.json").read_text()), (tmp_path / "b.csv").read_text()
    assert "# bands: 7\n" in second
    assert "# quantity: irradiance\n" in second
    assert held(tmp_path / "b.csv").file is not None
    np.testing.assert_allclose(held(tmp_path / "b.csv").file.coefficients, first["coefficients"], rtol=0, atol=1e-13)


def test_a_bare_list_is_converted_when_its_convention_is_named(tmp_path: Path) -> None:
    """What filament's list is in one direction, Unity's is in the same one, each in its own axes."""
    filament = np.random.default_rng(0).normal(size=(9, 3))
    (tmp_path / "sh.txt").write_text("\n".join(f"({r!r}, {g!r}, {b!r}); // L" for r, g, b in filament.tolist()))
    conventions = ["--input-convention", "filament", "--convention", "unity"]
    assert project(tmp_path / "sh.txt", *conventions, "-o", tmp_path / "u.json") == 0
    unity = np.array(json.loads((tmp_path / "u.json").read_text())["coefficients"])
    ours = np.array([0.6, 0.48, 0.64])

    def polynomials(x: float, y: float, z: float) -> list[float]:
        return [1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y]

    wanted = polynomials(*ours[[1, 2, 0]]) @ filament
    np.testing.assert_allclose(polynomials(*ours[[0, 2, 1]]) @ unity, wanted, rtol=0, atol=1e-13)


def test_stdout_holds_the_file_and_nothing_else(capsysbinary: pytest.CaptureFixture[bytes]) -> None:
    assert project("-o", "-", "--format", "json") == 0
    assert json.loads(capsysbinary.readouterr().out)["light"] == "green"


def test_of_several_lights_every_one_that_can_be_is_written(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "green.toml").write_text((ASSETS / "scenes/studio.toml").read_text())
    (tmp_path / "broken.csv").write_text("red,green\n1,2\n")
    out = tmp_path / "new" / "folder"
    lights = ["green", tmp_path / "green.toml", "nothing", tmp_path / "broken.csv", "cosine"]
    assert project(*lights, "-o", out, "--format", "csv", "--bands", 4) == 1
    captured = capsys.readouterr()
    assert sorted(path.name for path in out.iterdir()) == ["cosine.csv", "green-2.csv", "green.csv"]
    assert captured.out.splitlines()[-1] == "3 of 5 written"
    assert re.search(r"^green +4 +51\.2 % +[\d.]+ % +-0\.1844 +.*green\.csv$", captured.out, flags=re.MULTILINE)
    assert re.search(r"^nothing +failed$", captured.out, flags=re.MULTILINE)
    assert [line for line in captured.err.splitlines() if line.startswith("shviewer: unknown light 'nothing'")]
    assert "no column blue" in captured.err


def test_a_batch_without_failures_is_done(tmp_path: Path, capsys: Capture) -> None:
    assert project("green", "cosine", "-o", tmp_path) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["cosine.json", "green.json"]
    assert "2 of 2 written" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (("-o", "x.png"), 2, "FILE must end in .json, .csv, .npz, .h, .glsl, .hlsl, .js, .cs"),
        (("-o", "x.json", "--format", "csv"), 2, "contradict each other"),
        (("-o", "-"), 2, "name a format"),
        (("-o", "-", "--format", "exr"), 2, "format 'exr'"),
        (("green", "cosine", "-o", "-", "--format", "csv"), 2, "name a folder"),
        (("green", "cosine", "-o", "x.json"), 2, "name a folder"),
        (("-o", "x.json", "--convention", "blender"), 2, "must be one of shviewer"),
        (("-o", "x.json", "--convention", "three", "--for", "irradiance"), 2, "which takes radiance"),
        (("-o", "x.json", "--convention", "filament", "--for", "radiance"), 2, "which takes irradiance-over-pi"),
        (("-o", "x.json", "--convention", "filament", "--for", "glossy:0.4"), 2, "which takes irradiance-over-pi"),
        (("-o", "x.json", "--convention", "three", "--for", "glossy:0.4"), 2, "which takes radiance"),
        (("-o", "x.json", "--for", "glossy:0.05"), 2, "a roughness R of 0.1 to 1"),
        (("-o", "x.json", "--convention", "unreal", "--no-phase"), 2, "not be what that program expects"),
        (("-o", "x.json", "--axes", "up"), 2, "did you mean z-up or y-up?"),
        (("-o", "x.json", "--convention", "unity", "--bands", "4"), 2, "4 bands: unity takes 1 to 3"),
        (("-o", "x.json", "--convention", "unity", "--axes", "z-up"), 2, "unity expects x y z are our +x +z +y; y up"),
        (
            ("-o", "x.json", "--input-convention", "three"),
            2,
            "--input-convention three: it applies to a coefficient file",
        ),
        (("-o", "x.glsl", "--convention", "scipy"), 2, "complex coefficients"),
        (("-o", "x.json", "--input-convention", "maya"), 2, "must be one of shviewer"),
        (("nothing", "-o", "x.json"), 3, "unknown light 'nothing'"),
        (("-o", "missing/x.json"), 4, "no such folder"),
    ],
)
def test_what_cannot_be_is_one_line_and_leaves_no_file(
    arguments: tuple[str, ...], code: int, says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert project(*arguments) == code
    error = capsys.readouterr().err
    assert says in error
    assert error.count("\n") == 1
    assert os.listdir() == []


def test_the_file_that_is_read_is_not_written(tmp_path: Path, capsys: Capture) -> None:
    assert project("-o", tmp_path / "a.json") == 0
    before = (tmp_path / "a.json").read_bytes()
    assert project(tmp_path / "a.json", "-o", tmp_path / "a.json") == 4
    assert "is read from this file" in capsys.readouterr().err
    assert (tmp_path / "a.json").read_bytes() == before


def test_a_light_cannot_break_out_of_a_comment(tmp_path: Path) -> None:
    scene = tmp_path / "evil.toml"
    text = (ASSETS / "scenes/constant.toml").read_text()
    scene.write_text(re.sub(r"description = .*", r'description = "a */ b\\n#error c"', text))
    assert project(scene, "-o", tmp_path / "evil.h") == 0
    lines = (tmp_path / "evil.h").read_text().splitlines()
    (said,) = [line for line in lines if "light-is" in line]
    assert said == "// light-is: a * / b #error c"


def test_progress_goes_through_the_lights_and_is_cleared(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[str] = []
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setattr(StatusLine, "show", lambda self, text: shown.append(text))
    assert project("green", "no such light", "cosine", "-o", tmp_path, "--bands", 2) == 1
    assert [text[:26].count("#") for text in shown if text] == [0, 8, 16]
    assert [text.split("] ")[1] for text in shown if text] == [
        "1 of 3  green",
        "2 of 3  no such light",
        "3 of 3  cosine",
    ]
    assert shown[-1] == ""
    assert shown[2] == ""  # before the error is printed
    capsys.readouterr()


def test_as_many_bands_as_a_tolerance_needs(tmp_path: Path, capsys: Capture) -> None:
    assert project("cosine", "-o", tmp_path / "c.json", "--tolerance", "10%") == 0
    assert held(tmp_path / "c.json").n_bands == 3  # 127/128 of the energy: 8.8 %
    assert project("cosine", "-o", tmp_path / "c.json", "--tolerance", "1%", "--convention", "three") == 2
    assert "3 bands that three takes" in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["json", "csv", "npz", "h", "glsl"])
def test_a_sun_that_is_left_out_is_written_in_the_axes_of_the_file(kind: str, tmp_path: Path, capsys: Capture) -> None:
    """sun-sky.toml says where it stands and how bright it is; Unity's x, y, z are our x, z, y."""
    out = tmp_path / f"sky.{kind}"
    assert project("sun-sky", "--split-sun", "--convention", "unity", "-o", out) == 0
    sun = next(lobe for lobe in find_light("sun-sky").lobes if lobe.radiance.max() > 1000)
    light = held(out)
    assert light.file is not None
    said = {key: str(value) for key, value in light.file.stamp.items()}
    numbers = {key: np.array(value.split(), dtype=float) for key, value in said.items() if key.startswith("sun-1-")}
    assert said["suns"] == "1"
    np.testing.assert_allclose(numbers["sun-1-direction"], sun.axis[[0, 2, 1]], rtol=0, atol=1e-15)
    np.testing.assert_allclose(numbers["sun-1-radiance"], sun.radiance, rtol=1e-15)
    half_angle = np.radians(numbers["sun-1-width"] / 2)
    assert half_angle == pytest.approx(sun.profile.half_angle, rel=1e-12)
    irradiance = np.pi * np.sin(sun.profile.half_angle) ** 2 * sun.radiance
    np.testing.assert_allclose(numbers["sun-1-irradiance"], irradiance, rtol=1e-12)
    x, z, y = sun.axis
    direction, brightness = f"{x:.4g} {y:.4g} {z:.4g}", " ".join(f"{value:.4g}" for value in irradiance)
    assert f"sun left out: a directional light from ({direction}), irradiance {brightness}\n" in capsys.readouterr().err
    assert light.notes[0] == "1 sun left out; the file says where and how bright"


def test_without_a_sun_nothing_is_said_of_suns(tmp_path: Path, capsys: Capture) -> None:
    assert project("sun-sky", "-o", tmp_path / "a.json") == 0
    assert not [key for key in json.loads((tmp_path / "a.json").read_text()) if key.startswith("sun")]
    assert "sun left out" not in capsys.readouterr().err
    assert held(tmp_path / "a.json").notes == ()


@pytest.mark.parametrize("quantity", ["radiance", "irradiance"])
def test_both_errors_are_said_whatever_is_written(quantity: str, tmp_path: Path, capsys: Capture) -> None:
    green = find_light("green")
    exact = green.coefficients(3)
    radiance = errors_by_band_count(green.products(), exact, exact)[-1]
    shaded = green.irradiance()
    irradiance = errors_by_band_count(shaded.products(), shaded.coefficients(3), shaded.coefficients(3))[-1]
    assert project("green", "--bands", 3, "--for", quantity, "-o", tmp_path / "a.json") == 0
    errors = f"radiance within {100 * radiance:.3g} %, as irradiance {100 * irradiance:.3g} %"
    assert f"a.json: 3 bands, {errors}\n" in capsys.readouterr().out


def test_a_reconstruction_below_zero_is_warned_of_with_the_remedies_and_their_price(
    tmp_path: Path, capsys: Capture
) -> None:
    """Each figure of the note is that of the file which the remedy makes."""

    def written(*options: str) -> tuple[str, Stamp]:
        assert project("venice_sunset", "--bands", "4", *options, "-o", tmp_path / "a.json") == 0
        return capsys.readouterr().err, json.loads((tmp_path / "a.json").read_text())

    note, plain = written()
    _, apart = written("--split-sun")
    silent, calm = written("--window", "dering")
    assert f"the radiance of its 4 bands goes to {plain['minimum']:.3g}, {percent(plain['relative-l2'])} off" in note
    assert f"; with --split-sun to {apart['minimum']:.3g}, the rest {percent(apart['relative-l2'])} off" in note
    assert f"; with --window dering not below 0, {percent(calm['relative-l2'])} off" in note
    assert "goes to" not in silent


def test_a_large_image_is_not_searched_for_suns_for_the_sake_of_a_note(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("shviewer.cli.below_zero.SEARCHED_TEXELS", 256 * 128 - 1)
    monkeypatch.setattr(EnvironmentLight, "split_suns", lambda *_: pytest.fail("it is searched"))
    assert project("venice_sunset", "--bands", "5", "-o", tmp_path / "a.json") == 0
    assert capsys.readouterr().err.endswith("; if it has a sun, --split-sun takes that out\n")


@pytest.mark.parametrize(
    "convention", ["three", "unreal", "godot", "webxr-phase", "unity", "filament", "shviewer,z-up"]
)
@pytest.mark.parametrize("light", ["venice_sunset", "studio", "green"])
def test_what_a_program_shows_is_judged_and_not_what_its_numbers_hold(
    light: str, convention: str, tmp_path: Path, capsys: Capture
) -> None:
    """three.js, Unreal and Godot multiply radiance by A(l): radiance below zero that is no darkness then is no fault."""
    shows = "radiance" if convention.startswith("shviewer") else "irradiance"
    numbers = find_light(light).coefficients(3)
    if shows == "irradiance":
        numbers = numbers * np.repeat([np.pi, 2 * np.pi / 3, np.pi / 4], [1, 3, 5])[:, None]
    lowest = (evaluate_basis(random_directions(4000, seed=3), 3) @ numbers).min()
    assert project(light, "--bands", "3", "--convention", convention, "-o", tmp_path / "a.json") == 0
    note = capsys.readouterr().err
    assert (f"the {shows} of its 3 bands goes to -" in note) == (lowest < 0), lowest


def test_a_tolerance_that_a_program_cannot_reach_says_what_it_reaches(tmp_path: Path, capsys: Capture) -> None:
    command = ["--tolerance", "5%", "--convention", "three", "-o", tmp_path / "a.json"]
    assert project("green", *command) == 2
    green, exact = find_light("green"), find_light("green").coefficients(3)
    reached = errors_by_band_count(green.products(), exact, exact)[-1]
    error = capsys.readouterr().err.splitlines()[-1]
    assert f"needs more than the 3 bands that three takes, which reach {100 * reached:.3g} %; give --bands 3" in error
    assert project("sun-sky", *command) == 2
    assert "take its sun out, --split-sun" in capsys.readouterr().err
    assert project("sun-sky", "--split-sun", *command) == 0


def test_the_header_says_how_its_array_differs_from_the_programs(tmp_path: Path) -> None:
    assert project("-o", tmp_path / "a.h", "--convention", "unity") == 0
    assert "// layout: in Unity sh[channel, row]; this array is [row][channel]\n" in (tmp_path / "a.h").read_text()
    assert held(tmp_path / "a.h").n_bands == 3


def test_a_convention_that_nothing_is_read_in_is_refused(capsys: Capture) -> None:
    assert main(["screenshot", "a.png", "green", "--convention", "three"]) == 2
    says = (
        "--convention three: it applies to a coefficient file, and green is none; name one as LIGHT or with --compare"
    )
    assert says in capsys.readouterr().err


def test_suns_beside_split_sun_takes_lamps_and_never_a_light(tmp_path: Path, capsys: Capture) -> None:
    out = str(tmp_path / "a.json")
    assert main(["project", "--split-sun", "film_studio", "-o", out]) == 0
    assert "film_studio has no sun: its strongest compact source is 4.6 degrees wide" in capsys.readouterr().err
    assert main(["project", "--split-sun", "--suns", "all", "film_studio", "-o", out]) == 0
    assert "sun left out" in capsys.readouterr().err
    assert main(["project", "--suns", "2", "film_studio", "-o", out]) == 2
    assert "it says what --split-sun takes; give that, too" in capsys.readouterr().err


def test_the_help_names_every_program(capsys: Capture) -> None:
    with pytest.raises(SystemExit):
        main(["project", "--help"])
    text = " ".join(capsys.readouterr().out.split())
    said = set(re.findall(r"[\w-]+", re.search(r"convention to write: (.*?); after commas", text)[1]))
    assert {*CONVENTIONS} - said == {f"{name}-{phase}" for name in READINGS for phase in ("phase", "no-phase")}
    assert {*READINGS, "-phase", "-no-phase"} <= said


@pytest.mark.parametrize("kind", ["json", "h"])
def test_a_turned_light_is_written_turned_and_its_sun_with_it(kind: str, tmp_path: Path) -> None:
    """The turn takes +x to +z, so the radiance towards +z is what it was towards +x; errors are what they were."""
    plain, turned = tmp_path / f"plain.{kind}", tmp_path / f"turned.{kind}"
    assert main(["project", "sun-sky", "--split-sun", "-o", str(plain)]) == 0
    arguments = ["--rotate-light", "0", "90", "--roll-light", "30"]
    assert main(["project", "sun-sky", "--split-sun", "-o", str(turned), *arguments]) == 0
    before, after = (CoefficientLight.read(path) for path in (plain, turned))
    directions = np.random.default_rng(0).normal(size=(20, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    matrix = turn(0, 90, 30)
    np.testing.assert_allclose(matrix @ [1, 0, 0], [0, 0, 1], rtol=0, atol=1e-15)
    np.testing.assert_allclose(after.radiance(directions @ matrix.T), before.radiance(directions), rtol=0, atol=1e-5)
    assert before.file is not None
    assert after.file is not None
    was, now = (np.array([float(value) for value in str(light.file.stamp["sun-1-direction"]).split()])
                for light in (before, after) if light.file)  # fmt: skip
    np.testing.assert_allclose(now, matrix @ was, rtol=0, atol=1e-5)
    assert after.file.stamp["relative-l2"] == before.file.stamp["relative-l2"]
    written = [float(value) for value in str(after.file.stamp["turned"]).split()]
    np.testing.assert_allclose(written, matrix.ravel(), rtol=0, atol=1e-11)


def test_a_turn_beyond_the_pole_and_two_ways_to_choose_bands_are_refused(tmp_path: Path, capsys: Capture) -> None:
    out = str(tmp_path / "x.json")
    assert main(["project", "-o", out, "--rotate-light", "0", "91"]) == 2
    assert "elevation 91: it must be -90 to 90 degrees" in capsys.readouterr().err
    assert main(["project", "-o", out, "--bands", "3", "--tolerance", "5%"]) == 2
    assert "give one of them" in capsys.readouterr().err


LIGHTS = """
import numpy as np


def said(d):
    print("what code prints")
    return d[:, 2] ** 2


def lower(d):
    return d[:, 2]


def edge(d):
    return np.where(d[:, 2] > 0, 1.0, -0.1)
"""


def test_what_the_code_of_a_light_prints_is_kept_from_the_numbers(
    tmp_path: Path, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    (tmp_path / "lights.py").write_text(LIGHTS)
    light = f"{tmp_path / 'lights.py'}:said"
    assert project(light, "--bands", "2", "--format", "json", "-o", "-") == 0
    out, err = capfdbinary.readouterr()
    assert json.loads(out)["bands"] == 2
    assert b"what code prints" in err
    assert main(["info", light, "--json", "--jobs", "1"]) == 0
    assert len(json.loads(capfdbinary.readouterr().out)) == 1


def test_what_is_below_zero_in_the_light_itself_is_no_ringing(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "lights.py").write_text(LIGHTS)
    assert project(f"{tmp_path / 'lights.py'}:lower", "-o", tmp_path / "a.json") == 0
    assert "goes to" not in capsys.readouterr().err, "to -1, as the light does"
    assert project(f"{tmp_path / 'lights.py'}:edge", "-o", tmp_path / "a.json") == 0
    assert "the radiance of its 5 bands goes to -0.2" in capsys.readouterr().err


def test_what_a_glossy_surface_shows_below_zero_is_said_in_words(tmp_path: Path, capsys: Capture) -> None:
    assert project("green", "--for", "glossy:0.2", "-o", tmp_path / "a.json") == 0
    assert "what roughness 0.2 reflects of its 5 bands goes to -0." in capsys.readouterr().err


def test_a_folder_that_ends_in_a_slash_is_made_for_one_light_as_for_several(tmp_path: Path) -> None:
    assert project("green", "-o", f"{tmp_path / 'new' / 'folder'}/") == 0
    assert held(tmp_path / "new" / "folder" / "green.json").given.shape == (25, 3)


@pytest.mark.parametrize(
    "options",
    [
        ("--bands", "0"),
        ("--bands", "5", "--convention", "unity"),
        ("--samples", "10"),
        ("--window", "hann:-3"),
        ("--bands", "4", "--mute", "7"),
        ("--layout", "spiral"),
    ],
)
def test_an_option_that_is_wrong_for_any_light_is_said_once_before_one_is_read(
    options: tuple[str, ...], tmp_path: Path, capsys: Capture
) -> None:
    assert project("green", "nothing.hdr", "studio", *options, "-o", tmp_path / "new") == 2
    said = capsys.readouterr()
    assert (len(said.err.splitlines()), said.out) == (1, "")
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("first", ["green", "glossy.json"])
def test_a_batch_may_mix_lights_with_files_of_other_quantities(
    first: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert project("studio", "--for", "glossy:0.4", "-o", "glossy.json") == 0
    lights = sorted(["green", "glossy.json"], key=lambda light: light != first)
    assert project(*lights, "-o", "out") == 0
    head, *rows, written = capsys.readouterr().out.splitlines()[1:]
    assert written == "2 of 2 written"
    assert {"radiance", "irradiance", "glossy:0.4"} <= set(head.replace("roughness 0.4", "glossy:0.4").split())
    green = next(row for row in rows if row.startswith("green"))
    assert green.split("%")[-1].split()[0] == "-"


def test_notes_of_a_batch_tell_lights_of_the_same_name_apart(tmp_path: Path, capsys: Capture) -> None:
    for folder in "ab":
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "key.toml").write_text((ASSETS / "scenes/green.toml").read_text())
    lights = [str(tmp_path / folder / "key.toml") for folder in "ab"]
    assert project(*lights, "--tolerance", "20%", "--split-sun", "-o", tmp_path / "out") == 0
    told = capsys.readouterr().err.splitlines()
    for light in lights:
        starts = [line.partition(light)[0] for line in told if light in line]
        assert starts == ["shviewer: ", "shviewer: note: ", "shviewer: note: "]  # bands, no sun, below zero


def test_notes_of_a_batch_name_their_light_once(tmp_path: Path, capsys: Capture) -> None:
    options = ["--tolerance", "5%", "--for", "irradiance", "--split-sun"]
    assert project("green", "studio", *options, "-o", tmp_path) == 0
    told = capsys.readouterr().err.splitlines()
    assert "shviewer: green: bands within 5 %: radiance 15, irradiance 3" in told
    assert [line.count("studio") for line in told if "has no sun" in line] == [0, 1]
    assert project("green", *options, "-o", tmp_path / "a.json") == 0
    assert "shviewer: bands within 5 %: radiance 15, irradiance 3" in capsys.readouterr().err.splitlines()


@pytest.mark.parametrize(("convention", "ends"), [("unity", ", not divided by pi"), ("gltf", ")"), ("shviewer", ")")])
def test_info_says_in_which_unit_the_minimum_of_a_file_is(
    convention: str, ends: str, tmp_path: Path, capsys: Capture
) -> None:
    """Numbers over pi stand beside the minimum of the irradiance itself: the numbers evaluate to it over pi."""
    assert project("studio", "--bands", 3, "--convention", convention, "-o", tmp_path / "a.json") == 0
    assert main(["info", str(tmp_path / "a.json")]) == 0
    (line,) = (line for line in capsys.readouterr().out.splitlines() if "figures there" in line)
    assert line.endswith(ends)
