"""A light that turns is projected anew in every frame, and the line under the curve says how far that moves."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from viewer.overlay.written import pieces_of, texts_of

from shviewer.cli.main import main
from shviewer.errors import UsageError
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import jittered
from shviewer.harmonics.rotation import rotate
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.viewer import camera
from shviewer.viewer.animation.animation import Animation
from shviewer.viewer.animation.turning import light_turn
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.overlay.pieces import Curve
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import state_of

SAMPLED = state_of("green", n_bands=5, method="jittered", samples=900)
AT = compose(1280, 640)


def picture(animation: Animation, number: int) -> Picture:
    assert animation.picture is not None
    return animation.picture(number)


def test_the_light_goes_once_round_and_fresh_samples_have_seeds_of_their_own() -> None:
    fresh, same = (light_turn(SAMPLED, 8, 0.1, fresh=one) for one in (True, False))
    assert [state.recipe.seed for state in fresh.states] == list(range(8))
    assert {state.recipe.seed for state in same.states} == {0}
    ahead = [camera.matrix(state.view.light_rotation) @ [1, 0, 0] for state in same.states]
    angles = np.degrees(np.unwrap(np.arctan2(*np.array(ahead)[:, [1, 0]].T)))
    np.testing.assert_allclose(angles, 45 * np.arange(8), atol=1e-9)
    assert same.about == {"kind": "turning light", "seeds": "same"}


def test_a_frame_is_the_projection_of_the_light_as_it_stands_there_turned_back() -> None:
    """By the other way round: the light turned, the samples as they are, and the coefficients rotated back."""
    animation = light_turn(SAMPLED, 8, 0.1, fresh=False)
    turn = camera.matrix(animation.states[3].view.light_rotation)
    light, points = find_light("green"), jittered(900, 0)
    there = project_samples(lambda d: light.radiance(d @ turn), points, 5)  # row vectors: d @ R is R^T applied to each
    np.testing.assert_allclose(picture(animation, 3).coefficients, rotate(there, turn.T), rtol=0, atol=1e-12)


def test_exactly_projected_it_does_not_change_and_sampled_it_does() -> None:
    exact = picture(light_turn(state_of("green", n_bands=5), 6, 0.1, fresh=True), 5)
    assert 0 < max(exact.state.view.trace) < 2e-15
    fresh, same = (
        np.array(picture(light_turn(SAMPLED, 90, 0.1, fresh=one), 12).state.view.trace) for one in (True, False)
    )
    assert len(fresh) == len(same) == 12
    assert np.sqrt((fresh**2).mean()) > 3 * np.sqrt((same**2).mean()) > 0
    assert 0.01 < fresh.mean() < 0.1  # some 5 % in five bands (benchmark/moving.py)


def test_the_line_under_the_curve_tells_the_last_changes_in_any_order_of_frames() -> None:
    animation = light_turn(SAMPLED, 60, 0.1, fresh=True)
    late, early = picture(animation, 55), picture(animation, 3)
    assert [len(one.state.view.trace) for one in (late, early, picture(animation, 0))] == [48, 3, 0]
    assert picture(animation, 55).state.view.trace == late.state.view.trace
    overlay = draw_overlay(early, AT)
    assert "trace_words" in overlay.boxes
    assert not [name for name in overlay.boxes if name.startswith("legend_")]
    assert any(isinstance(piece, Curve) and piece.name == "trace" for piece in pieces_of(overlay))
    words = next(text.text for text in texts_of(overlay) if text.name == "trace_words")
    assert "of the light from frame to frame, RMS of 3 frames" in words
    still = draw_overlay(picture(light_turn(state_of("green"), 4, 0.1, fresh=True), 2), AT)
    assert "the same to rounding" in next(text.text for text in texts_of(still) if text.name == "trace_words")


def test_what_cannot_turn_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    given = CoefficientLight(np.ones((4, 3)))
    with pytest.raises(UsageError, match="leave out --compare"):
        light_turn(state_of("green", compare=given, n_bands=2), 8, 0.1, fresh=True)
    for arguments, said in (
        (("--turn-light", "--turntable"), "one of them turns; leave out the other"),
        (("--seeds", "same"), "it says how --turn-light draws its samples"),
        (("--turn-light", "--from", "2"), "--from 2 with --turn-light: a turn has one number of bands"),
        (("--turn-light", "--frames", "1"), "--frames 1: a turn has 2 to 720"),
    ):
        assert main(["sweep", str(tmp_path / "t.webp"), "green", *arguments]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert said in line
