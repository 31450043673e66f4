"""The key table and what the keys do to a state."""

from __future__ import annotations

from collections import Counter
from dataclasses import fields, replace
from itertools import chain

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shviewer.analysis.recipe import METHODS, Recipe
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light
from shviewer.lights.reading import Reading
from shviewer.limits import MAX_BANDS
from shviewer.viewer import camera
from shviewer.viewer.control.actions import open_light
from shviewer.viewer.control.commands import Command
from shviewer.viewer.control.keys import ACTIONS, BINDINGS, key_table, press
from shviewer.viewer.control.placing import orbit, rotate_light, zoom
from shviewer.viewer.control.playing import step_sweep
from shviewer.viewer.state import State, changed, describe_exposure, describe_muted, started, state_of

LIGHTS = ("green", "studio", "sun-sky")
START = state_of(*LIGHTS)
IMAGE = state_of("venice_sunset", *LIGHTS)
GIVEN = CoefficientLight(np.ones((4, 3)))


def pressed(state: State, *keys: str) -> State:
    for key in keys:
        done = press(state, key)
        assert not isinstance(done, Command), key
        state = done
    return state


def test_no_key_is_bound_twice() -> None:
    count = Counter(key for rows in BINDINGS.values() for binding in rows for key in binding.actions)
    assert [key for key, times in count.items() if times > 1] == []
    assert len(ACTIONS) == sum(count.values())


def test_every_binding_says_what_it_does_and_is_in_the_list() -> None:
    text = key_table()
    for binding in chain(*BINDINGS.values()):
        assert binding.label
        assert binding.help
        assert f"  {binding.label:<20}{binding.help}\n" in text + "\n"
        assert isinstance(binding.value(START), str)
    titles = [line for line in text.splitlines() if line and not line.startswith(" ")]
    assert titles == ["Bands", "Light", "Error", "Picture", "Program"]
    assert max(map(len, text.splitlines())) <= 80


def test_every_key_of_the_programs_promise_is_bound() -> None:
    promised = (
        "Up Down PageUp PageDown Home End , . Enter A Left Right M S Shift+S E Shift+E N G H ? R F P Ctrl+S F11 Esc T W I "
        "Q Shift+Q Ctrl+R F5 U B L Z D X O V Tab Shift+Tab Space Y K Shift+K J C + - F1 Ctrl+C Ctrl+Shift+C Ctrl+E Ctrl+Q "
        "Ctrl+W Ctrl+V Ctrl+O Ctrl+Z Ctrl+Y Ctrl+Shift+Z"
    )
    digits = [f"{shift}{digit}" for shift in ("", "Shift+") for digit in range(10)]
    assert set(ACTIONS) == {*promised.split(), *digits}


@settings(derandomize=True, deadline=None)
@given(
    st.lists(st.sampled_from([*sorted(ACTIONS), "drag", "turn", "scroll", "Ctrl+1"]), max_size=60), st.integers(0, 99)
)
def test_no_sequence_of_keys_leaves_the_limits(keys: list[str], seed: int) -> None:
    rng = np.random.default_rng(seed)
    state, placed = START, {"camera": (78.0, 22.0)}
    for key in keys:
        if key == "drag":
            state = orbit(changed(state, **placed), *rng.normal(scale=3, size=2))
        elif key == "turn":
            state = rotate_light(changed(state, **placed), *rng.normal(scale=3, size=2))
        elif key == "scroll":
            state = zoom(state, rng.normal(scale=20))
        else:
            done = press(state, key)
            state = state if isinstance(done, Command) else done
        state.check()
        assert 0 <= state.view.cursor < state.recipe.n_bands
        assert state.recipe.light in state.lights
        assert state.view.camera is None or abs(state.view.camera[1]) <= 90
        assert np.linalg.norm(state.view.light_rotation) == pytest.approx(1, abs=1e-12)
        assert all(band < state.recipe.n_bands for band in state.recipe.muted_shown)


def test_a_key_without_a_binding_changes_nothing() -> None:
    state = changed(START, message="kept")
    for key in ("Shift+J", "", "Shift+Up", "Ctrl+1", "up"):
        assert press(state, key) is state


MODES = ((), ("V",), ("I", "C"), ("J",), ("B",), ("G", "D"), ("M",), ("Home",), ("PageUp",) * 40, ("K",) * 30)


@pytest.mark.parametrize("mode", MODES, ids=lambda keys: " ".join(keys[:2]))
def test_a_key_that_changes_nothing_says_so(mode: tuple[str, ...]) -> None:
    state = changed(pressed(START, *mode), message="")
    for key in ACTIONS:
        assert press(state, key) != state, key


@pytest.mark.parametrize("key", ["E", "Shift+E", "N", "O", "X"])
def test_what_only_spheres_have_is_left_alone_while_surfaces_are_shown_which_is_said(key: str) -> None:
    surfaces = pressed(START, "E", "V")
    found = pressed(surfaces, key)
    assert "surfaces have no" in found.view.message
    assert changed(found, message="") == surfaces


@pytest.mark.parametrize("keys", ["I C", "J", "B"])
def test_a_cursor_that_nobody_sees_is_said(keys: str) -> None:
    assert pressed(START, *keys.split(), ".").view.message == "band 0: Enter mutes it or brings it back"


def test_j_under_b_takes_its_place() -> None:
    found = pressed(START, "B", "J")
    assert (found.view.sheet, found.view.by_roughness) == ("", True)
    assert pressed(START, "J", "B", "J") == found
    assert not pressed(found, "J").view.by_roughness


def test_I_goes_round_the_quantities_and_comes_back_to_the_roughness_shown_last() -> None:
    shown = [pressed(START, *keys.split()).recipe.quantity for keys in ("I", "I I", "I I I", "K", "K K", "K Shift+K")]
    assert shown == ["irradiance", "glossy:0.5", "radiance", "glossy:0.5", "glossy:0.55", "glossy:0.45"]
    assert pressed(START, "K", "K", "K", "I", "I", "I").recipe.quantity == "glossy:0.6"
    assert pressed(changed(START, quantity="glossy:0.33"), "I", "I", "I").recipe.quantity == "glossy:0.33"
    assert pressed(changed(START, quantity="glossy:0.33"), "K").recipe.quantity == "glossy:0.4"
    assert pressed(START, *["K"] * 30).recipe.quantity == "glossy:1"
    assert pressed(START, *["Shift+K"] * 30).recipe.quantity == "glossy:0.1"


def test_a_bound_key_takes_the_message_away() -> None:
    assert press(changed(START, message="read"), "Up").view.message == ""


def test_bands_go_up_and_down_by_one_and_by_four_and_stop_at_the_ends() -> None:
    keys = ("Up", "Down", "+", "-", "PageUp", "PageDown", "Home", "End")
    assert [pressed(START, key).recipe.n_bands for key in keys] == [6, 4, 6, 4, 9, 1, 1, 32]
    assert pressed(START, *["Down"] * 9).recipe.n_bands == 1
    assert pressed(START, *["PageUp"] * 40).recipe.n_bands == MAX_BANDS


@pytest.mark.parametrize("digit", range(5))
def test_a_digit_mutes_its_band_and_again_brings_it_back(digit: int) -> None:
    once = press(START, str(digit))
    assert once.recipe.muted == {digit}
    assert press(once, str(digit)) == START
    unused = press(START, str(digit + 5))
    assert changed(unused, message="") == START
    assert f"band {digit + 5}" in unused.view.message


def test_solo_leaves_one_band_and_twice_brings_back_all() -> None:
    solo = press(START, "Shift+2")
    assert solo.recipe.muted_shown == (0, 1, 3, 4)
    assert press(solo, "Up").recipe.muted_shown == (0, 1, 3, 4, 5)
    assert press(solo, "Shift+2").recipe.muted == frozenset()
    assert press(solo, "Shift+3").recipe.muted_shown == (0, 1, 2, 4)
    assert changed(press(START, "Shift+7"), message="") == START
    assert press(solo, "A").recipe.muted == frozenset()


def test_the_cursor_shows_itself_first_then_goes_round_and_enter_mutes() -> None:
    state = press(START, ".")
    assert (state.view.cursor, state.view.cursor_visible) == (0, True)
    assert press(state, ".").view.cursor == 1
    assert press(state, ",").view.cursor == 4
    assert pressed(state, ",", ".").view.cursor == 0
    at_3 = pressed(state, ".", ".", ".")
    assert press(at_3, "Enter").recipe.muted == {3}
    assert pressed(at_3, "Enter", "Enter").recipe.muted == frozenset()
    assert pressed(at_3, "Down", "Down").view.cursor == 2  # never on a band that is gone


def test_lights_and_methods_go_round() -> None:
    assert press(START, "Left").recipe.light == "sun-sky"
    assert pressed(START, "Right", "Right").recipe.light == "sun-sky"
    assert pressed(START, "Right", "Left") == START
    assert [pressed(START, *["M"] * count).recipe.method for count in range(4)] == [*METHODS, METHODS[0]]


def test_l_goes_round_the_layouts_and_another_layout_is_another_picture() -> None:
    states = [pressed(IMAGE, *["L"] * count) for count in range(6)]
    names = [state.recipe.reading.layout for state in states]
    assert names == ["auto", "lat-long", "cube", "angular", "mirror-ball", "auto"]
    assert states[1] != IMAGE
    assert states[5] == IMAGE


def test_l_goes_on_from_a_layout_that_the_image_could_not_have() -> None:
    """The window then takes the reading back."""
    cube = pressed(IMAGE, "L", "L")
    kept = changed(cube, reading=press(IMAGE, "L").recipe.reading)
    assert press(kept, "L").recipe.reading.layout == "angular"
    assert pressed(kept, "Left", "Right", "L").recipe.reading.layout == "cube"
    assert press(open_light(kept, "mine.hdr"), "L").recipe.reading.layout == "cube"


def test_z_repairs_and_again_leaves_as_it_is_for_every_light() -> None:
    repairing = press(IMAGE, "Z")
    assert repairing == changed(IMAGE, reading=Reading(sanitize=True))
    assert press(repairing, "Z") == IMAGE
    assert open_light(repairing, "mine.hdr").recipe.reading.sanitize
    isolated = changed(IMAGE, reading=Reading(isolated=True))
    assert pressed(isolated, "Z", "L").recipe.reading.isolated


def test_samples_go_by_four_and_stop_at_16_and_a_million() -> None:
    sampled = changed(START, method="jittered")
    assert press(sampled, "S").recipe.samples == 40_000
    assert press(sampled, "Shift+S").recipe.samples == 2_500
    assert pressed(sampled, *["S"] * 9).recipe.samples == 1_000_000
    assert pressed(sampled, *["Shift+S"] * 9).recipe.samples == 16
    assert press(START, "S").recipe.samples == START.recipe.samples
    assert "M changes the method" in press(START, "S").view.message
    many = changed(sampled, samples=5_000_000)  # asked for on the command line
    assert press(many, "S").recipe.samples == 5_000_000


def test_exposure_goes_by_half_stops_and_n_makes_it_automatic() -> None:
    assert pressed(START, "E", "E", "Shift+E").view.exposure_offset == 0.5
    fixed = changed(START, exposure_stops=2.0)
    assert describe_exposure(fixed.view) == "+2"
    assert describe_exposure(press(fixed, "E").view) == "+2 +0.5"
    assert describe_exposure(press(START, "Shift+E").view) == "auto -0.5"
    again = pressed(fixed, "E", "N")
    assert (again.view.exposure_stops, again.view.exposure_offset) == (None, 0.0)


@pytest.mark.parametrize(
    "light", ["green", "mine.toml", "probe.json", "lights.py:f", FunctionLight(np.exp, "exp"), GIVEN]
)
@pytest.mark.parametrize("key", ["L", "Z"])
def test_what_is_no_image_has_no_layout_and_no_repairs_which_is_said(light: str | Light, key: str) -> None:
    state = state_of(light)
    done = pressed(state, key)
    assert done == changed(state, message=done.view.message)
    assert " is no image, and has no " in done.view.message


@pytest.mark.parametrize(
    "light", ["sky.exr:layer", "SKY.HDR", "codes.npy", EnvironmentLight(np.ones((2, 4, 3), np.float32))]
)
def test_what_is_or_may_be_an_image_has(light: str | Light) -> None:
    assert press(state_of(light), "L") != state_of(light)


def test_reset_goes_back_to_what_was_asked_for_in_everything_but_the_light() -> None:
    asked = started(
        state_of(*LIGHTS, n_bands=7, tone="log", compare=GIVEN, reading=Reading(layout="cube"), message="m")
    )
    other = state_of(
        *LIGHTS,
        light="sun-sky",
        reading=Reading(sanitize=True),
        n_bands=9,
        muted=frozenset({1}),
        cursor=3,
        cursor_visible=True,
        quantity="irradiance",
        compare=GIVEN,
        split_sun=True,
        suns="all",
        window="hann",
        window_width=3.0,
        tolerance=0.1,
        method="jittered",
        samples=99,
        seed=4,
        turn=camera.turn_of(camera.towards(10, 10)),
        exposure_stops=1.0,
        exposure_offset=0.5,
        camera=(1.0, 2.0),
        light_rotation=camera.towards(10, 10),
        zoom=2.0,
        pan=(0.5, -0.5),
        whole_sphere=True,
        map_centre=(3.0, 4.0),
        error="signed",
        error_range=0.5,
        beside="own",
        tone="aces",
        marks=False,
        lobe_view=True,
        basis=(1, -1),
        evaluate="map",
        sweep_to=12,
        turning="fresh",
        trace=(0.5,),
        range_held=True,
        help_visible=True,
        help_page=1,
        sheet="plane",
        message="m",
        roughness=0.2,
        by_roughness=True,
        encode="zh3",
        layout_tried="cube",
    )
    for held in (other.recipe, other.view):
        assert [item.name for item in fields(held) if getattr(held, item.name) == item.default] == []
    assert press(replace(other, start=asked.start), "R") == changed(asked, light="sun-sky", message="")
    assert press(other, "R") == state_of(*LIGHTS, light="sun-sky")  # where nothing was asked for
    again = pressed(changed(asked, light="studio"), "L", "Z", "R")
    assert changed(again, message="") == changed(asked, light="studio", message="")


@pytest.mark.parametrize(
    ("key", "command"),
    [
        ("Ctrl+R", Command.RELOAD),
        ("F5", Command.RELOAD),
        ("T", Command.FIT),
        ("Y", Command.FACE_MARK),
        ("P", Command.SAVE),
        ("Ctrl+S", Command.SAVE),
        ("F11", Command.FULL_SCREEN),
        ("Esc", Command.LEAVE),
        ("Ctrl+Q", Command.CLOSE),
        ("Ctrl+W", Command.CLOSE),
        ("Ctrl+C", Command.COPY),
        ("Ctrl+Shift+C", Command.COPY_COEFFICIENTS),
        ("Ctrl+E", Command.EXPORT),
        ("Ctrl+V", Command.PASTE),
        ("Ctrl+Z", Command.UNDO),
        ("Ctrl+Y", Command.REDO),
        ("Ctrl+Shift+Z", Command.REDO),
    ],
)
def test_what_is_no_other_state_is_a_command(key: str, command: Command) -> None:
    assert press(START, key) is command


def test_f_faces_the_light_and_does_nothing_else() -> None:
    moved = changed(START, camera=(1.0, 2.0), zoom=3.0, n_bands=7)
    assert press(moved, "F") == changed(START, n_bands=7)


def test_escape_closes_the_help_first_and_then_the_window() -> None:
    for key in ("H", "?", "F1"):
        helped = press(START, key)
        assert helped.view.help_visible
        assert press(helped, key) == START
        assert press(helped, "Esc") == START
        assert press(START, "Esc") is Command.LEAVE


def test_b_shows_the_time_error_plane_and_escape_closes_it_after_the_help_and_before_the_window() -> None:
    shown = press(START, "B")
    assert shown == changed(START, sheet="plane")
    assert press(shown, "B") == START
    helped = press(shown, "H")
    without_help = press(helped, "Esc")
    assert without_help == shown
    assert press(without_help, "Esc") == START


def test_page_down_turns_the_help_and_adds_bands_only_without_it() -> None:
    assert press(START, "PageDown").recipe.n_bands < START.recipe.n_bands
    helped = press(START, "H")
    assert pressed(helped, "PageDown", "PageDown", "PageUp") == changed(helped, help_page=1)
    assert press(helped, "PageUp") == helped


@pytest.mark.parametrize(
    ("key", "name", "values"),
    [
        ("O", "tone", ["reinhard", "aces", "log", "none"]),
        ("X", "marks", [False, True]),
        ("V", "lobe_view", [True, False]),
    ],
)
def test_a_key_goes_through_its_choices_and_back(key: str, name: str, values: list[object]) -> None:
    state = START
    for value in values:
        state = press(state, key)
        assert state == changed(START, **{name: value})
    assert state == START


def test_tab_steps_through_the_basis_functions_in_use_and_none_of_them() -> None:
    state, seen = changed(START, n_bands=2), []
    for _ in range(5):
        state = press(state, "Tab")
        seen.append(state.view.basis)
    assert seen == [(0, 0), (1, -1), (1, 0), (1, 1), None]
    assert state.view.lobe_view  # Tab opened it
    assert press(state, "Shift+Tab").view.basis == (1, 1)
    assert pressed(state, "Shift+Tab", "Down").view.basis is None  # that band is no longer in use
    assert press(press(state, "Tab"), "V") == changed(START, n_bands=2)


def test_space_sweeps_from_one_band_to_those_in_use_and_any_band_key_ends_it() -> None:
    state, seen = press(changed(START, n_bands=4), "Space"), []
    while state.view.sweep_to is not None:
        seen.append(state.recipe.n_bands)
        state = step_sweep(state)
    assert seen == [1, 2, 3]
    assert state == changed(START, n_bands=4)
    begun = press(state, "Space")
    assert press(begun, "Space") == changed(begun, sweep_to=None)
    assert press(begun, "Up") == changed(START, n_bands=2)
    assert press(begun, "Esc") == changed(begun, sweep_to=None)
    assert press(changed(START, n_bands=1), "Space").view.sweep_to == 10


@pytest.mark.parametrize(("right", "up"), [(0.01, 0.0), (0.0, 0.01), (-0.01, -0.006)])
def test_the_front_of_the_sphere_follows_the_mouse(right: float, up: float) -> None:
    """On the horizon, where an azimuth is as long as an elevation; second order is left out."""
    start = changed(START, camera=(40.0, 0.0))
    front = camera.world_from_view(*start.view.camera)[:, 2]
    seen = camera.world_from_view(*orbit(start, right, up).view.camera).T @ front
    np.testing.assert_allclose(seen, [right, up, 1], rtol=0, atol=2e-4)


def test_orbiting_stops_at_the_poles_and_goes_round_the_equator() -> None:
    start = changed(START, camera=(78.0, 22.0))
    assert orbit(start, 0, -9).view.camera == (78.0, 90.0)
    assert orbit(start, 0, 9).view.camera == (78.0, -90.0)
    assert orbit(start, 2 * np.pi, 0).view.camera[0] == pytest.approx(78.0)
    assert 0 <= orbit(start, 3, 0).view.camera[0] < 360


def test_dragging_with_shift_turns_the_light_and_not_the_camera() -> None:
    start = changed(START, camera=(78.0, 22.0))
    turned = rotate_light(start, 0.1, 0.2)
    assert turned.view.camera == start.view.camera
    assert turned.view.light_rotation == camera.turned_by_drag(start.view.light_rotation, start.view.camera, 0.1, 0.2)
    assert turned.view.light_rotation != start.view.light_rotation


def test_scrolling_up_magnifies_by_a_tenth_within_limits() -> None:
    assert zoom(START, 1).view.zoom == pytest.approx(1.1)
    assert zoom(START, 999).view.zoom == 16
    assert zoom(START, -999).view.zoom == 0.25


def test_opening_a_light_adds_it_once_and_shows_it() -> None:
    mine = FunctionLight(lambda d: d[:, 0])
    opened = open_light(changed(START, message="old"), mine)
    assert opened.lights == (*LIGHTS, mine)
    assert opened.recipe.light is mine
    assert opened.view.message == ""
    assert open_light(press(opened, "Left"), mine) == opened
    assert open_light(opened, "studio") == changed(opened, light="studio")


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
    assert describe_muted(Recipe(muted=frozenset(muted), n_bands=n_bands)) == words


def test_the_window_key_leaves_deringing_out_where_it_cannot_be_had() -> None:
    few, many = changed(START, n_bands=32), changed(START, n_bands=33)
    assert [pressed(few, *["W"] * count).recipe.window for count in range(6)] == [
        "none", "hann", "lanczos", "gauss", "dering", "none",
    ]  # fmt: skip
    assert [pressed(many, *["W"] * count).recipe.window for count in range(5)] == [
        "none",
        "hann",
        "lanczos",
        "gauss",
        "none",
    ]
    assert press(changed(many, window="dering"), "W").recipe.window == "none"
