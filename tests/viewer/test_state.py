"""The key table and what the keys do to a state."""

from __future__ import annotations

from collections import Counter
from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.function import FunctionLight
from shviewer.lights.reading import Reading
from shviewer.limits import MAX_BANDS
from shviewer.viewer import camera
from shviewer.viewer.actions import open_light, orbit, rotate_light, step_sweep, zoom
from shviewer.viewer.keys import ACTIONS, BINDINGS, key_table, press
from shviewer.viewer.state import (
    CAMERA_HOME,
    METHODS,
    ViewState,
    describe_exposure,
    describe_muted,
)
from shviewer.viewer.view_limits import check

LIGHTS = ("green", "studio", "sun-sky")
START = ViewState(lights=LIGHTS)


def pressed(state: ViewState, *keys: str) -> ViewState:
    for key in keys:
        state = press(state, key)
    return state


def test_no_key_is_bound_twice() -> None:
    count = Counter(key for binding in BINDINGS for key in binding.actions)
    assert [key for key, times in count.items() if times > 1] == []
    assert len(ACTIONS) == sum(count.values())


def test_every_binding_says_what_it_does_and_is_in_the_list() -> None:
    text = key_table()
    for binding in BINDINGS:
        assert binding.label
        assert binding.help
        assert f"  {binding.label:<20}{binding.help}\n" in text + "\n"
        assert isinstance(binding.value(START), str)
    titles = [line for line in text.splitlines() if line and not line.startswith(" ")]
    assert titles == ["Bands", "Light", "Error", "Picture", "Program"]
    assert max(map(len, text.splitlines())) <= 80


def test_every_key_of_the_programs_promise_is_bound() -> None:
    promised = (
        "Up Down PageUp PageDown Home End , . Enter A Left Right M S Shift+S E Shift+E N H ? R F P Ctrl+S F11 Esc T W I "
        "Ctrl+R F5 U B L Z D X G O V Tab Shift+Tab Space Y"
    )
    digits = [f"{shift}{digit}" for shift in ("", "Shift+") for digit in range(10)]
    assert set(ACTIONS) == {*promised.split(), *digits}


@settings(derandomize=True, deadline=None)
@given(st.lists(st.sampled_from([*sorted(ACTIONS), "drag", "turn", "scroll", "Q"]), max_size=60), st.integers(0, 99))
def test_no_sequence_of_keys_leaves_the_limits(keys: list[str], seed: int) -> None:
    rng = np.random.default_rng(seed)
    state = START
    for key in keys:
        if key == "drag":
            state = orbit(state, *rng.normal(scale=3, size=2))
        elif key == "turn":
            state = rotate_light(state, *rng.normal(scale=3, size=2))
        elif key == "scroll":
            state = zoom(state, rng.normal(scale=20))
        else:
            state = press(state, key)
        check(state)
        assert 0 <= state.cursor < state.n_bands
        assert 0 <= state.light_index < len(state.lights)
        assert abs(state.camera[1]) <= 90
        assert np.linalg.norm(state.light_rotation) == pytest.approx(1, abs=1e-12)
        assert all(band < state.n_bands for band in state.muted_shown)


def test_a_key_without_a_binding_changes_nothing() -> None:
    state = replace(START, message="kept")
    for key in ("Q", "", "Shift+Up", "Ctrl+1", "up"):
        assert press(state, key) is state


def test_a_bound_key_takes_the_message_away() -> None:
    assert press(replace(START, message="read"), "Up").message == ""


def test_bands_go_up_and_down_by_one_and_by_four_and_stop_at_the_ends() -> None:
    keys = ("Up", "Down", "PageUp", "PageDown", "Home", "End")
    assert [press(START, key).n_bands for key in keys] == [6, 4, 9, 1, 1, 32]
    assert pressed(START, *["Down"] * 9).n_bands == 1
    assert pressed(START, *["PageUp"] * 40).n_bands == MAX_BANDS


@pytest.mark.parametrize("digit", range(5))
def test_a_digit_mutes_its_band_and_again_brings_it_back(digit: int) -> None:
    once = press(START, str(digit))
    assert once.muted == {digit}
    assert press(once, str(digit)) == START
    unused = press(START, str(digit + 5))
    assert replace(unused, message="") == START
    assert f"band {digit + 5}" in unused.message


def test_solo_leaves_one_band_and_twice_brings_back_all() -> None:
    solo = press(START, "Shift+2")
    assert solo.muted_shown == (0, 1, 3, 4)
    assert press(solo, "Up").muted_shown == (0, 1, 3, 4, 5)
    assert press(solo, "Shift+2").muted == frozenset()
    assert press(solo, "Shift+3").muted_shown == (0, 1, 2, 4)
    assert replace(press(START, "Shift+7"), message="") == START
    assert press(solo, "A").muted == frozenset()


def test_the_cursor_shows_itself_first_then_goes_round_and_enter_mutes() -> None:
    state = press(START, ".")
    assert (state.cursor, state.cursor_visible) == (0, True)
    assert press(state, ".").cursor == 1
    assert press(state, ",").cursor == 4
    assert pressed(state, ",", ".").cursor == 0
    at_3 = pressed(state, ".", ".", ".")
    assert press(at_3, "Enter").muted == {3}
    assert pressed(at_3, "Enter", "Enter").muted == frozenset()
    assert pressed(at_3, "Down", "Down").cursor == 2  # never on a band that is gone


def test_lights_and_methods_go_round() -> None:
    assert press(START, "Left").light == "sun-sky"
    assert pressed(START, "Right", "Right").light == "sun-sky"
    assert pressed(START, "Right", "Left") == START
    assert [pressed(START, *["M"] * count).method for count in range(4)] == [*METHODS, METHODS[0]]


def test_l_goes_round_the_layouts_and_another_layout_is_another_picture() -> None:
    states = [pressed(START, *["L"] * count) for count in range(6)]
    names = [state.reading.layout for state in states]
    assert names == ["auto", "lat-long", "cube", "angular", "mirror-ball", "auto"]
    assert states[1] != START
    assert states[5] == START


def test_l_goes_on_from_a_layout_that_the_image_could_not_have() -> None:
    """The window then takes the reading back."""
    cube = pressed(START, "L", "L")
    kept = replace(cube, reading=press(START, "L").reading)
    assert press(kept, "L").reading.layout == "angular"
    assert press(press(kept, "Left"), "L").reading.layout == "cube"
    assert press(open_light(kept, "studio"), "L").reading.layout == "cube"


def test_z_repairs_and_again_leaves_as_it_is_for_every_light() -> None:
    repairing = press(START, "Z")
    assert repairing == replace(START, reading=Reading(sanitize=True))
    assert press(repairing, "Z") == START
    assert open_light(repairing, "mine.hdr").reading.sanitize
    isolated = replace(START, reading=Reading(isolated=True))
    assert pressed(isolated, "Z", "L").reading.isolated


def test_samples_go_by_four_and_stop_at_16_and_a_million() -> None:
    sampled = replace(START, method="jittered")
    assert press(sampled, "S").samples == 40_000
    assert press(sampled, "Shift+S").samples == 2_500
    assert pressed(sampled, *["S"] * 9).samples == 1_000_000
    assert pressed(sampled, *["Shift+S"] * 9).samples == 16
    assert press(START, "S").samples == START.samples
    assert "M changes the method" in press(START, "S").message
    many = replace(sampled, samples=5_000_000)  # asked for on the command line
    assert press(many, "S").samples == 5_000_000


def test_exposure_goes_by_half_stops_and_n_makes_it_automatic() -> None:
    assert pressed(START, "E", "E", "Shift+E").exposure_offset == 0.5
    fixed = replace(START, exposure_stops=2.0)
    assert describe_exposure(fixed) == "+2"
    assert describe_exposure(press(fixed, "E")) == "+2 +0.5"
    assert describe_exposure(press(START, "Shift+E")) == "auto -0.5"
    again = pressed(fixed, "E", "N")
    assert (again.exposure_stops, again.exposure_offset) == (None, 0.0)


GIVEN = CoefficientLight(np.ones((4, 3)))


def test_reset_keeps_the_light_and_the_window_and_nothing_else() -> None:
    changed = ViewState(
        lights=LIGHTS,
        light_index=2,
        reading=Reading(sanitize=True),
        n_bands=9,
        muted=frozenset({1}),
        cursor=3,
        cursor_visible=True,
        quantity="irradiance",
        compare=GIVEN,
        split_sun=True,
        window="hann",
        window_width=3.0,
        tolerance=0.1,
        method="jittered",
        samples=99,
        seed=4,
        exposure_stops=1.0,
        exposure_offset=0.5,
        camera=(1.0, 2.0),
        light_rotation=camera.towards(10, 10),
        zoom=2.0,
        error="signed",
        error_range=0.5,
        tone="aces",
        marks=False,
        lobe_view=True,
        basis=(1, -1),
        evaluate="map",
        sweep_to=12,
        help_visible=True,
        sheet="plane",
        message="m",
        reloads=5,
        fullscreen=True,
        screenshots=3,
        fits=2,
        looks=4,
        layout_tried="cube",
    )
    assert all(getattr(changed, item.name) != item.default for item in fields(changed) if item.name != "closing")
    after = press(changed, "R")
    kept = {"light_index": 2, "reading": Reading(sanitize=True), "compare": GIVEN, "tolerance": 0.1, "evaluate": "map"}
    assert after == ViewState(lights=LIGHTS, reloads=5, **kept)  # type: ignore[arg-type]
    assert after.fullscreen
    assert after.screenshots == 3
    assert after.layout_tried == "cube"


@pytest.mark.parametrize("key", ["Ctrl+R", "F5"])
def test_reading_the_file_again_makes_another_state_and_keeps_every_setting(key: str) -> None:
    changed = replace(START, n_bands=9, muted=frozenset({1}), camera=(1.0, 2.0), light_index=1, fits=2)
    after = press(changed, key)
    assert after != changed
    assert replace(after, reloads=0) == changed
    assert press(after, key) != after


def test_f_brings_back_the_camera_alone() -> None:
    moved = replace(START, camera=(1.0, 2.0), zoom=3.0, n_bands=7)
    assert press(moved, "F") == replace(START, camera=CAMERA_HOME, n_bands=7)


def test_escape_closes_the_help_first_and_then_the_window() -> None:
    for key in ("H", "?"):
        helped = press(START, key)
        assert helped.help_visible
        assert press(helped, key) == START
        closed = press(helped, "Esc")
        assert (closed.help_visible, closed.closing) == (False, False)
        assert press(closed, "Esc").closing


def test_b_shows_the_time_error_plane_and_escape_closes_it_after_the_help_and_before_the_window() -> None:
    shown = press(START, "B")
    assert shown == replace(START, sheet="plane")
    assert press(shown, "B") == START
    helped = press(shown, "H")
    without_help = press(helped, "Esc")
    assert without_help == shown
    closed = press(without_help, "Esc")
    assert closed == START
    assert not closed.closing
    assert press(closed, "Esc").closing


def test_one_sheet_is_shown_at_a_time() -> None:
    assert press(START, "G").sheet == "convergence"
    assert pressed(START, "G", "B").sheet == "plane"
    assert pressed(START, "G", "G") == START
    assert pressed(START, "B", "G", "Esc") == START


@pytest.mark.parametrize(
    ("key", "name", "values"),
    [
        ("D", "error", ["signed", "absolute", "relative", "off"]),
        ("O", "tone", ["reinhard", "aces", "log", "none"]),
        ("X", "marks", [False, True]),
        ("V", "lobe_view", [True, False]),
    ],
)
def test_a_key_goes_through_its_choices_and_back(key: str, name: str, values: list[object]) -> None:
    state = START
    for value in values:
        state = press(state, key)
        assert state == replace(START, **{name: value})
    assert state == START


def test_tab_steps_through_the_basis_functions_in_use_and_none_of_them() -> None:
    state, seen = replace(START, n_bands=2), []
    for _ in range(5):
        state = press(state, "Tab")
        seen.append(state.basis)
    assert seen == [(0, 0), (1, -1), (1, 0), (1, 1), None]
    assert state.lobe_view  # Tab opened it
    assert press(state, "Shift+Tab").basis == (1, 1)
    assert pressed(state, "Shift+Tab", "Down").basis is None  # that band is no longer in use
    assert press(press(state, "Tab"), "V") == replace(START, n_bands=2)


def test_space_sweeps_from_one_band_to_those_in_use_and_any_band_key_ends_it() -> None:
    state, seen = press(replace(START, n_bands=4), "Space"), []
    while state.sweep_to is not None:
        seen.append(state.n_bands)
        state = step_sweep(state)
    assert seen == [1, 2, 3]
    assert state == replace(START, n_bands=4)
    begun = press(state, "Space")
    assert press(begun, "Space") == replace(begun, sweep_to=None)
    assert press(begun, "Up") == replace(START, n_bands=2)
    assert press(begun, "Esc") == replace(begun, sweep_to=None)
    assert press(replace(START, n_bands=1), "Space").sweep_to == 10


def test_wishes_to_the_window_are_no_part_of_the_picture() -> None:
    for key in ("P", "Ctrl+S", "F11"):
        assert press(START, key) == START
    assert press(START, "P").screenshots == press(START, "Ctrl+S").screenshots == 1
    assert press(START, "F11").fullscreen
    assert not pressed(START, "F11", "F11").fullscreen


@pytest.mark.parametrize(("right", "up"), [(0.01, 0.0), (0.0, 0.01), (-0.01, -0.006)])
def test_the_front_of_the_sphere_follows_the_mouse(right: float, up: float) -> None:
    """On the horizon, where an azimuth is as long as an elevation; second order is left out."""
    start = replace(START, camera=(40.0, 0.0))
    front = camera.world_from_view(*start.camera)[:, 2]
    seen = camera.world_from_view(*orbit(start, right, up).camera).T @ front
    np.testing.assert_allclose(seen, [right, up, 1], rtol=0, atol=2e-4)


def test_orbiting_stops_at_the_poles_and_goes_round_the_equator() -> None:
    assert orbit(START, 0, -9).camera == (78.0, 90.0)
    assert orbit(START, 0, 9).camera == (78.0, -90.0)
    assert orbit(START, 2 * np.pi, 0).camera[0] == pytest.approx(78.0)
    assert 0 <= orbit(START, 3, 0).camera[0] < 360


def test_dragging_with_shift_turns_the_light_and_not_the_camera() -> None:
    turned = rotate_light(START, 0.1, 0.2)
    assert turned.camera == START.camera
    assert turned.light_rotation == camera.turned_by_drag(START.light_rotation, START.camera, 0.1, 0.2)
    assert turned.light_rotation != START.light_rotation


def test_scrolling_up_magnifies_by_a_tenth_within_limits() -> None:
    assert zoom(START, 1).zoom == pytest.approx(1.1)
    assert zoom(START, 999).zoom == 16
    assert zoom(START, -999).zoom == 0.25


def test_opening_a_light_adds_it_once_and_shows_it() -> None:
    mine = FunctionLight(lambda d: d[:, 0])
    opened = open_light(replace(START, message="old"), mine)
    assert opened.lights == (*LIGHTS, mine)
    assert opened.light is mine
    assert opened.message == ""
    assert open_light(press(opened, "Left"), mine) == opened
    assert open_light(opened, "studio") == replace(opened, light_index=1)


@pytest.mark.parametrize(
    ("muted", "n_bands", "words"),
    [
        ((), 5, ""),
        ((7,), 5, ""),
        ((1,), 5, "muted 1"),
        ((1, 3, 4), 5, "muted 1, 3-4"),
        ((0, 1, 2, 5), 9, "muted 0-2, 5"),
        ((0, 1, 3, 4), 5, "only band 2"),
        ((0, 1, 2, 3), 4, "muted 0-3"),
        ((0,), 2, "muted 0"),
    ],
)
def test_muted_bands_are_described_in_runs(muted: tuple[int, ...], n_bands: int, words: str) -> None:
    assert describe_muted(replace(START, muted=frozenset(muted), n_bands=n_bands)) == words


def test_the_window_key_leaves_deringing_out_where_it_cannot_be_had() -> None:
    few, many = replace(START, n_bands=32), replace(START, n_bands=33)
    assert [pressed(few, *["W"] * count).window for count in range(6)] == [
        "none", "hann", "lanczos", "gauss", "dering", "none",
    ]  # fmt: skip
    assert [pressed(many, *["W"] * count).window for count in range(5)] == ["none", "hann", "lanczos", "gauss", "none"]
    assert press(replace(many, window="dering"), "W").window == "none"
