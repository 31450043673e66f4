"""Whether what a function's light says of its own accuracy is so: truths are closed forms, in function_suite.py."""

from __future__ import annotations

import json
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from harmonics.independent import random_directions
from lights.function_suite import Disc, discs, judge, suite

import shviewer
from shviewer.cli.main import main
from shviewer.errors import LightError
from shviewer.harmonics.sampling.look import SEEN_DEGREES
from shviewer.lights.function import FunctionLight
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import state_of

EVERY = 24
"""One case in so many is judged here, and all of them by python tests/benchmarks/functions.py."""


@pytest.mark.parametrize("number", range(5))
def test_a_sun_of_the_real_size_is_found_and_resolved_wherever_it_stands(number: int) -> None:
    rng = np.random.default_rng(number)
    axis = random_directions(5, seed=5)[number]
    sun = Disc(axis, 0.27, 0.1 * 10 ** rng.uniform(3, 6))
    verdict = judge(discs("sun", 0.1, sun))
    assert not verdict.silent
    assert not verdict.said
    assert verdict.error < 5e-4  # before, c00 was 1.3 times the truth, or the sun was not there at all


def test_a_function_is_as_accurate_as_it_says_or_a_note_says_that_it_is_not() -> None:
    verdicts = [(case, judge(case)) for case in islice(suite(), 3, None, EVERY)]
    assert len(verdicts) >= 9
    assert not [case.name for case, verdict in verdicts if verdict.silent and case.narrowest >= SEEN_DEGREES]
    assert not [case.name for case, verdict in verdicts if verdict.said and case.smooth]


def test_a_wave_that_regular_rows_mistake_for_a_constant_is_not_lost() -> None:
    """320 columns see cos(640 phi) as -1: the mean was 0 and the error 0, without a note."""
    light = FunctionLight(lambda d: 1 + np.cos(640 * np.arctan2(d[:, 1], d[:, 0])))
    mean = light.coefficients(1)[0, 0] / np.sqrt(4 * np.pi)
    assert abs(mean - 1) < 3 * light.accuracy()
    assert abs(mean - 1) < 0.1
    assert "features narrower than" in light.notes[0]


def test_what_is_narrower_than_the_look_is_said_to_be_missed_and_noted_once_it_is_met() -> None:
    axis = np.array([0.48, -0.6, 0.64])
    light = FunctionLight(lambda d: 1.0 + 1e4 * (np.linalg.norm(d - axis, axis=1) < 1e-6))
    assert light.best_method.endswith("features narrower than 0.5 degrees may be missed")
    assert light.notes == ()
    assert light.accuracy() < 1e-6
    light.radiance(axis[None])
    assert light.notes == (
        "radiance 1e+04 at theta 50.21, phi -51.34 degrees is not in the coefficients: "
        "features narrower than 0.5 degrees may be missed",
    )
    assert light.accuracy() == 1


def test_the_look_is_not_news_between_its_points() -> None:
    """The peak of the narrowest smooth lobe that one rule is enough for, seen from nearby."""
    axis = random_directions(1, seed=3)[0]
    light = FunctionLight(lambda d: np.exp(900 * (d @ axis - 1)))
    light.coefficients(1)
    light.radiance(axis[None])
    assert light.notes == ()


POLE = """import numpy as np
def light(d):
    return np.where(d[:, 2] == 1, np.nan, 1.0)
def below(d):
    return np.where(d[:, 2] == -1, np.inf, 1.0)
def axis(d):
    return np.where(d[:, 0] == 1, np.nan, d[:, 2] + 2)
"""


@pytest.mark.parametrize(("name", "value", "direction"), [
    ("light", "nan", "[0.0, 0.0, 1.0]"), ("below", "inf", "[0.0, 0.0, -1.0]"), ("axis", "nan", "[1.0, 0.0, 0.0]"),
])  # fmt: skip
def test_a_value_that_is_not_finite_is_refused_alike_by_all_modes(
    name: str, value: str, direction: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`project` wrote a file that `screenshot` refused."""
    file = tmp_path / "pole.py"
    file.write_text(POLE)
    text = f"{file}:{name}"
    said = f"{name}: the function returned [{value}, {value}, {value}] for direction "
    modes = (
        ["project", text, "-o", str(tmp_path / "out.json")],
        ["info", text],
        ["report", text, "-o", str(tmp_path / "report"), "--quick"],
    )
    for mode in modes:
        assert main(mode) == 3
        line = capsys.readouterr().err.strip().splitlines()[-1]
        assert said in line
        assert line.endswith("radiance must be finite")
    assert not (tmp_path / "out.json").exists()
    with pytest.raises(LightError, match="radiance must be finite"):
        shviewer.project(shviewer.find_light(text), 3)
    with pytest.raises(LightError, match="radiance must be finite"):
        prepare(state_of(text))


def test_file_info_and_picture_say_what_may_be_missed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "sky.py"
    file.write_text("import numpy as np\ndef sky(d):\n    return np.exp(d[:, 2])\n")
    missed = "features narrower than 0.5 degrees may be missed"
    assert main(["project", f"{file}:sky", "-o", str(tmp_path / "out.json")]) == 0
    assert missed in json.loads((tmp_path / "out.json").read_text())["method"]
    assert main(["info", f"{file}:sky"]) == 0
    assert missed in capsys.readouterr().out
    assert missed in prepare(state_of(f"{file}:sky")).projection.method
