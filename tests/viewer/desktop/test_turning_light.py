"""In the window the light turns and is projected anew in every frame; a line under the curve says what that moves."""

from __future__ import annotations

import shlex
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from viewer.desktop.desktop import Viewer
from viewer.overlay.written import texts_of

from shviewer.analysis.projected import project_recipe
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import gauss_legendre
from shviewer.harmonics.rotation import rotate
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.viewer import camera
from shviewer.viewer.animation.turning import light_turn
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.commands import Command
from shviewer.viewer.control.placing import orbit, rotate_light
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.saving.command_line import command_line
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.state import changed, state_of

SAMPLED = {"n_bands": 5, "method": "jittered", "samples": 400}
AT = compose(1280, 640)


class Clock:
    """A session, and the time it is told."""

    def __init__(self, light: str = "green", key: str = "Q", **values: object) -> None:
        self.session = Session(state_of(light, **values))
        self.now = 0.0
        if key:
            self.press(key)

    @property
    def picture(self) -> Picture:
        return self.session.picture

    def press(self, key: str) -> object:
        done = self.session.press(key)
        self.session.prepare()
        return done

    def pass_by(self, frames: int, seconds: float = 0.1) -> Picture:
        for _ in range(frames):
            self.now += seconds
            self.session.tick(self.now)
            self.session.prepare()
        assert self.picture.state == self.session.state
        return self.picture


def azimuth(picture: Picture) -> float:
    x, y, _ = camera.matrix(picture.state.view.light_rotation)[:, 0]
    return float(np.degrees(np.arctan2(y, x)))


def words(picture: Picture, pace: float | None = None) -> dict[str, str]:
    return {text.name: text.text for text in texts_of(draw_overlay(picture, AT, pace=pace))}


@pytest.mark.parametrize("encode", ["", "hallucinated"])
def test_every_beat_is_a_frame_of_the_turn_that_a_file_has(encode: str) -> None:
    """A beat is due a period after the first look at the clock."""
    options = SAMPLED | ({"quantity": "irradiance", "encode": encode, "n_bands": 3} if encode else {})
    window = Clock(**options)
    shown = window.pass_by(5)
    animation = light_turn(state_of("green", **options), 72, 0.08, fresh=True)
    assert animation.picture is not None
    wanted = animation.picture(4)
    assert azimuth(shown) == pytest.approx(20.0, abs=1e-9)
    assert (shown.state.recipe.seed, wanted.state.recipe.seed) == (4, 4)
    np.testing.assert_allclose(shown.coefficients, wanted.coefficients, rtol=0, atol=1e-12)
    assert shown.state.view.trace == pytest.approx(wanted.state.view.trace, rel=1e-9)
    assert len(shown.state.view.trace) == 4


@pytest.mark.parametrize(("key", "seeds"), [("Q", {0, 1, 2, 3}), ("Shift+Q", {0})])
def test_samples_are_fresh_or_the_same_and_the_key_stops(key: str, seeds: set[int]) -> None:
    window = Clock(key=key, **SAMPLED)
    assert {window.pass_by(1).state.recipe.seed for _ in range(4)} == seeds
    before = window.picture
    window.press(key)
    after = window.pass_by(3)
    assert after.state.view.turning == ""
    assert after.coefficients is before.coefficients  # as it was seen last
    assert after.state.view.trace == before.state.view.trace


def test_exactly_projected_lobes_do_not_change_but_for_rounding_and_the_eye_sees_them_turn() -> None:
    window = Clock("green", n_bands=5)
    first = window.picture
    shown = window.pass_by(5)
    assert 0 < max(shown.state.view.trace) < 2e-15
    assert "the same to rounding in 4 frames" in words(shown)["trace_words"]
    np.testing.assert_array_equal(shown.world_from_view, first.world_from_view)  # the camera does not go round with it
    assert np.abs(shown.light_from_world - first.light_from_world).max() > 0.2
    image = Clock("venice_sunset", n_bands=5).pass_by(3)
    assert set(image.state.view.trace) == {0.0}
    assert words(image)["trace_words"] == "its coefficients turn with it: no change in 2 frames"


def test_points_of_a_quadrature_stand_still_too() -> None:
    shown = Clock("venice_sunset", n_bands=5, method="gauss-legendre", samples=200).pass_by(4)
    turn = camera.matrix(shown.state.view.light_rotation)
    light, points = find_light("venice_sunset"), gauss_legendre(200).direction_set()
    there = project_samples(lambda d: light.integrand(d @ turn), points, 5)
    np.testing.assert_allclose(shown.coefficients, rotate(there, turn.T), rtol=0, atol=1e-12)
    assert min(shown.state.view.trace) > 1e-4


def test_bands_and_orbit_go_on_meanwhile_and_the_line_begins_anew_with_other_numbers() -> None:
    window = Clock(lights=("green", "hemisphere"), **SAMPLED)
    window.pass_by(4)
    window.press("E")
    window.session.state = orbit(window.session.placed, 0.3, 0.1)
    assert len(window.pass_by(2).state.view.trace) == 5
    window.press("Up")
    assert window.picture.state.view.trace == ()
    shown = window.pass_by(2)
    assert (shown.state.recipe.n_bands, len(shown.state.view.trace)) == (6, 2)
    window.press("Right")
    assert window.pass_by(3).light.name == "hemisphere"
    assert len(window.picture.state.view.trace) == 3


def test_escape_stops_the_light_and_not_the_window_and_a_sweep_takes_its_place() -> None:
    window = Clock(**SAMPLED)
    window.pass_by(3)
    assert window.press("Esc") is None
    assert window.session.state.view.turning == ""
    assert window.press("Esc") is Command.LEAVE
    window.press("Q")
    window.press("Space")
    assert (window.session.state.view.turning, window.session.state.view.sweep_to) == ("", 5)
    window.press("Shift+Q")
    assert (window.session.state.view.turning, window.session.state.view.sweep_to) == ("same", None)


def test_a_frame_is_its_state_so_that_a_saved_picture_can_be_made_again(tmp_path: Path) -> None:
    shown = Clock(**SAMPLED).pass_by(6)
    again = prepare(state_of_stamp(metadata(shown, AT, "")))
    assert again.state == shown.state
    np.testing.assert_array_equal(again.coefficients, shown.coefficients)
    assert words(again) == words(shown)
    np.testing.assert_array_equal(project_recipe(shown.state.recipe).coefficients, shown.coefficients)
    line = shlex.split(command_line(shown, (320, 160)))
    command = [sys.executable, "-m", "shviewer", "screenshot", str(tmp_path / "a.png"), *line[3:]]
    subprocess.run(command, check=True)  # a process of its own: it makes an OpenGL context
    with Image.open(tmp_path / "a.png") as image:
        text = str(image.text["shviewer"])
    told = state_of_stamp(text)
    assert told.recipe == replace(shown.state.recipe, turn=told.recipe.turn)
    np.testing.assert_allclose(told.recipe.turn, shown.state.recipe.turn, rtol=0, atol=1e-14)


def test_turned_by_hand_afterwards_it_is_projected_where_it_stands_until_it_is_reset() -> None:
    window = Clock(**SAMPLED)
    window.pass_by(3)
    window.press("Q")
    window.session.state = rotate_light(window.session.placed, 0.5, 0.0)
    window.session.prepare()
    shown = window.picture
    assert shown.state.recipe.turn == camera.turn_of(shown.state.view.light_rotation)
    assert shown.state.view.trace == ()
    window.press("R")
    assert window.picture.state.recipe.turn is None


def test_until_it_is_projected_the_light_is_seen_where_it_was() -> None:
    picture = Clock(**SAMPLED).pass_by(2)
    ahead = changed(rotate_light(picture.placed(picture.state), 0.4, 0.0), exposure_offset=1.0)
    seen = picture.seen(ahead)
    np.testing.assert_array_equal(seen.light_from_world, picture.light_from_world)
    assert seen.state.view.exposure_offset == 1.0


def test_the_foot_says_what_turns_and_how_fast_where_it_does_not_keep_up() -> None:
    window = Clock(**SAMPLED)
    assert words(window.pass_by(8))["turning"] == "the light turns by 5° a frame, fresh samples"
    assert window.session.pace is None
    window.pass_by(8, seconds=0.5)
    assert window.session.pace == pytest.approx(2.0)
    said = words(window.picture, window.session.pace)
    assert said["turning"] == "the light turns by 5° a frame, fresh samples, 2 frames a second"
    assert said["turning_stops"] == "Esc stops"


def test_given_coefficients_do_not_turn() -> None:
    given = CoefficientLight(np.ones((4, 3)), "mine")
    window = Clock("green", compare=given, n_bands=2)
    assert window.session.state.view.turning == ""
    assert window.session.state.view.message == "the coefficients are those of mine: no light is projected"


def test_real_keys_turn_the_light_save_a_frame_and_leave_a_window_at_rest(start: Callable[..., Viewer]) -> None:
    viewer = start("green", "--method", "jittered", "--samples", "300", "--size", "640", "320")
    viewer.press("q", "frame")
    for _ in range(8):  # some frames are no step: the message of the key, what is being made
        viewer.wait_for("frame")
    pixels, text = viewer.saved_picture()
    state = state_of_stamp(text)
    assert state.view.turning == "fresh"
    assert len(state.view.trace) >= 2
    assert state.recipe.seed >= 2, "every step takes the next seed"
    viewer.press("Escape", "frame")
    viewer.rest()
    assert viewer.process.poll() is None
    assert pixels.shape == (320, 640, 3)
