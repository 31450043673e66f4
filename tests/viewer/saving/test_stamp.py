"""What a picture says of itself is complete: the state comes out of it again. test_walk.py asks it of thousands of states."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from helpers import frame_of, picture_of
from PIL import Image
from places import DATA

from shviewer.errors import UsageError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.reading import Reading
from shviewer.limits import Limits
from shviewer.viewer.saving.stamp import SCHEMA, metadata, state_of_stamp
from shviewer.viewer.state import State, state_of

GIVEN = CoefficientLight(np.ones((36, 3)), "given")


def stamped(**changes: Any) -> tuple[State, dict[str, Any]]:
    """The state of a picture, and its stamp."""
    picture = picture_of(**changes)
    said = json.loads(metadata(picture, frame_of(picture), "none"))
    assert isinstance(said, dict)
    return picture.state, said


def test_a_stamp_tells_what_the_picture_alone_would_not() -> None:
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
    assert state_of_stamp(json.dumps(said), light) == state


def test_a_stamp_of_before_the_schemas_is_read_as_far_as_it_goes() -> None:
    with Image.open(DATA / "golden-studio.png") as image:
        text = image.info["shviewer"]
    said = json.loads(text)
    assert "schema" not in said
    state = state_of_stamp(text)
    assert (state.recipe.light, state.recipe.n_bands) == (said["light_argument"], said["bands"])
    assert state.view.camera == tuple(said["camera_degrees"])
    assert state.view.exposure_stops == said["exposure_stops"]  # what was chosen then


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
    ],
)
def test_a_stamp_that_cannot_be_read_is_one_line(change: dict[str, Any], says: str) -> None:
    _, said = stamped()
    with pytest.raises(UsageError, match=says):
        state_of_stamp(json.dumps(said | change))


def test_a_value_out_of_range_is_refused_as_everywhere() -> None:
    _, said = stamped()
    said["state"]["recipe"]["n_bands"] = 500
    with pytest.raises(UsageError, match="500 bands"):
        state_of_stamp(json.dumps(said))
    for text in ("", "[]", "3", "no JSON"):
        with pytest.raises(UsageError, match="no stamp of a picture"):
            state_of_stamp(text)
