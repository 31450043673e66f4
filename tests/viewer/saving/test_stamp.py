"""What a picture says of itself is complete: the state comes out of it again. test_walk.py asks it of thousands of states."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from helpers import frame_of, picture_of

from shviewer.analysis.options import taken
from shviewer.analysis.recipe import Recipe
from shviewer.errors import UsageError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.reading import Reading
from shviewer.limits import Limits
from shviewer.viewer.picture import prepare
from shviewer.viewer.saving.stamp import SCHEMA, metadata
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.state import State, state_of
from shviewer.viewer.view import View

GIVEN = CoefficientLight(np.ones((36, 3)), "given")


def stamped(**changes: Any) -> tuple[State, dict[str, Any]]:
    """The state of a picture, and its stamp."""
    picture = picture_of(**changes)
    said = json.loads(metadata(picture, frame_of(picture), "none"))
    assert isinstance(said, dict)
    return picture.state, said


def test_a_stamp_tells_what_the_picturealone_would_not() -> None:
    reading = Reading(sanitize=True, layout="lat-long", limits=Limits(side=4096), convention="three")
    state, said = stamped(
        light="venice_sunset",
        reading=reading,
        tolerance=0.01,
        error="relative",
        error_range=0.2,
        evaluate="map",
        muted=frozenset({1, 9}),
        method="jittered",
        samples=500,
        seed=7,
        compare=GIVEN,
    )
    assert said["schema"] == SCHEMA
    recipe, view = said["state"]["recipe"], said["state"]["view"]
    assert recipe["tolerance"] == 0.01
    assert recipe["muted"] == [1, 9]  # also the one that is not in use
    assert (recipe["reading"]["convention"], recipe["reading"]["limits"]["side"]) == ("three", 4096)
    assert (view["error_range"], view["evaluate"]) == (0.2, "map")
    assert state_of_stamp(json.dumps(said), compare=GIVEN) == state


def test_a_light_without_a_name_is_given_again() -> None:
    light = CoefficientLight(np.ones((4, 3)), "mine")
    state, said = stamped(light=light, n_bands=2)
    assert said["state"]["recipe"]["light"] is None
    with pytest.raises(UsageError, match="give the light"):
        state_of_stamp(json.dumps(said))
    assert state_of_stamp(json.dumps(said), light) == state


def test_no_stamp_runs_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever reads the state of a picture and draws it would run what its stamp names, unless the caller names it, too."""
    monkeypatch.chdir(tmp_path)
    Path("evil.py").write_text("raise SystemExit('ran')\n")
    _, said = stamped()
    said["state"]["recipe"]["light"] = "evil.py:f"
    with pytest.raises(UsageError, match="which is code, and no picture runs code: give the light"):
        state_of_stamp(json.dumps(said))
    assert state_of_stamp(json.dumps(said), "evil.py:f").recipe.light == "evil.py:f"


def test_a_key_of_a_later_version_is_no_mistake() -> None:
    _, said = stamped()
    said["state"]["view"]["fog"] = 0.5
    assert state_of_stamp(json.dumps(said)) == state_of()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"schema": 2}, "a picture of schema 2: this version reads 1"),
        ({"state": {}}, "no stamp of a picture"),
        ({"state": 3}, "no stamp of a picture"),
        ({"schema": None}, "no stamp of a picture"),
    ],
)
def test_a_stamp_that_cannot_be_read_is_one_line(change: dict[str, Any], says: str) -> None:
    _, said = stamped()
    with pytest.raises(UsageError, match=says):
        state_of_stamp(json.dumps(said | change))


def test_coefficients_that_were_compared_are_given_again_with_all_their_bands() -> None:
    _, said = stamped(compare=GIVEN, n_bands=6)
    with pytest.raises(UsageError, match="compares with given"):
        state_of_stamp(json.dumps(said))
    with pytest.raises(UsageError, match="few has 1 band"):
        state_of_stamp(json.dumps(said), compare=CoefficientLight(np.ones((1, 3)), "few"))


HOSTILE: dict[str, list[Any]] = {
    "zoom": [10**400, "x", None, [], True],
    "camera": [[10**400, 1], [1], "ab"],
    "marks": ["no", 5, None],
    "light_rotation": ["abcd", [1, 2], [0, 0, 0, 0], None, ["nan", 0, 0, 0]],
    "exposure_offset": [[], None, 10**400, 1e9, "nan"],
    "cursor": ["x", 10**9, -1],
    "sweep_to": ["x", 10**9],
    "message": [5, None],
    "tone": [5, "filmic"],
    "basis": [[1], "x", [9, 9]],
}


@pytest.mark.parametrize("name", HOSTILE)
def test_nothing_but_a_usage_error_comes_out_of_a_view_that_there_is_not(name: str) -> None:
    for value in HOSTILE[name]:
        if (name, value) == ("zoom", True):  # a number, as everywhere in Python
            continue
        _, said = stamped()
        said["state"]["view"][name] = value
        with pytest.raises(UsageError):
            state_of_stamp(json.dumps(said))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("light", 5),
        ("light", ["a"]),
        ("reading", 3),
        ("reading", {"layout": [1]}),
        ("muted", 3),
        ("split_sun", "x"),
        ("n_bands", 1e400),
        ("seed", "x"),
    ],
)
def test_nothing_but_a_usage_error_comes_out_of_a_recipe_that_there_is_not(name: str, value: Any) -> None:
    _, said = stamped()
    said["state"]["recipe"][name] = value
    with pytest.raises(UsageError):
        state_of_stamp(json.dumps(said))


def test_a_stamp_nested_without_end_is_none() -> None:
    for text in ("[" * 100_000, '{"state":' * 50_000):
        with pytest.raises(UsageError, match="no stamp"):
            state_of_stamp(text)


def test_numbers_of_numpy_can_be_stamped() -> None:
    values = {"zoom": np.float32(2), "exposure_stops": np.int64(1), "marks": np.bool_(False)}
    view = View(**taken(values, View))
    state = State(Recipe(**taken({"window_width": np.float32(3), "window": "hann"}, Recipe)), view)
    picture = prepare(state)
    assert state_of_stamp(metadata(picture, frame_of(picture), "none")) == state


def test_a_value_out_of_range_is_refused_as_everywhere() -> None:
    _, said = stamped()
    said["state"]["recipe"]["n_bands"] = 500
    with pytest.raises(UsageError, match="500 bands"):
        state_of_stamp(json.dumps(said))
    for text in ("", "[]", "3", "no JSON"):
        with pytest.raises(UsageError, match="no stamp of a picture"):
            state_of_stamp(text)
