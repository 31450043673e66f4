"""What clicks, drags and the wheel make of a state, without a window."""

from __future__ import annotations

import numpy as np
import pytest
from helpers import frame_of, picture_of

from shviewer.errors import UsageError
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.control.keys import press
from shviewer.viewer.control.placing import pan, zoom, zoom_about
from shviewer.viewer.desktop.mouse import LEFT, MIDDLE, RIGHT, Mouse
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import State, changed, state_of


@pytest.fixture(scope="module")
def shown() -> tuple[Picture, Composition]:
    picture = picture_of(camera=(30.0, 10.0))
    return picture, frame_of(picture)


def clicked(
    mouse: Mouse, at: tuple[float, float], picture: Picture, frame: Composition, seconds: float
) -> State | None:
    mouse.move(at, picture.state, frame)
    mouse.press(LEFT)
    assert mouse.release(LEFT)
    return mouse.click(picture, frame, {3: Box(700, 500, 720, 600)}, seconds)


def test_two_clicks_soon_on_a_point_face_it_and_nothing_else_does(shown: tuple[Picture, Composition]) -> None:
    picture, frame = shown
    sphere = frame.spheres[1]
    at = sphere.x + 0.3 * sphere.radius, sphere.y + 0.4 * sphere.radius
    mouse = Mouse()
    assert clicked(mouse, at, picture, frame, 1.0) is None
    assert clicked(mouse, at, picture, frame, 1.5) is None  # too late
    assert clicked(mouse, (at[0] + 9, at[1]), picture, frame, 1.6) is None  # another point
    faced = clicked(mouse, (at[0] + 9, at[1]), picture, frame, 1.7)
    assert faced is not None
    direction = sphere.direction(at[0] + 9, at[1], picture.world_from_view)
    np.testing.assert_allclose(picture.seen(faced).world_from_view[:, 2], direction, rtol=0, atol=1e-12)
    assert clicked(mouse, (at[0] + 9, at[1]), picture, frame, 1.8) is None  # a third is the first of two
    assert [clicked(mouse, (3.0, 3.0), picture, frame, when) for when in (2.0, 2.1)] == [None, None]


def test_a_click_on_a_bar_mutes_its_band_unless_the_help_covers_it(shown: tuple[Picture, Composition]) -> None:
    picture, frame = shown
    muted = clicked(Mouse(), (710.0, 550.0), picture, frame, 1.0)
    assert muted is not None
    assert muted.recipe.muted == {3}
    helped = picture.seen(changed(picture.state, help_visible=True))
    assert clicked(Mouse(), (710.0, 550.0), helped, frame, 1.0) is None


def test_a_press_that_moves_is_no_click_and_only_the_first_button_counts(shown: tuple[Picture, Composition]) -> None:
    picture, frame = shown
    mouse = Mouse()
    mouse.move((300.0, 300.0), picture.state, frame)
    mouse.press(LEFT)
    mouse.press(RIGHT)
    assert mouse.move((302.0, 300.0), picture.state, frame) is None  # not yet a drag
    turned = mouse.move((320.0, 300.0), picture.state, frame)
    assert turned is not None
    assert turned.view.light_rotation == picture.state.view.light_rotation
    assert not mouse.release(RIGHT)
    assert mouse.dragged
    assert not mouse.release(LEFT)
    assert mouse.move((400.0, 300.0), picture.state, frame) is None


@pytest.mark.parametrize(("button", "shift"), [(RIGHT, False), (LEFT, True)])
def test_the_right_button_or_shift_turns_the_light(
    shown: tuple[Picture, Composition], button: int, shift: bool
) -> None:
    picture, frame = shown
    mouse = Mouse()
    mouse.press(button)
    turned = mouse.move((30.0, 0.0), picture.state, frame, shift=shift)
    assert turned is not None
    assert turned.view.camera == picture.state.view.camera
    assert turned.view.light_rotation != picture.state.view.light_rotation


def test_the_middle_button_moves_the_spheres_with_the_mouse() -> None:
    picture = picture_of(zoom=2.0, camera=(30.0, 10.0))
    frame = frame_of(picture)
    home = frame.spheres[0].radius / 2
    mouse = Mouse()
    mouse.move((300.0, 300.0), picture.state, frame)
    mouse.press(MIDDLE)
    moved = mouse.move((340.0, 280.0), picture.state, frame)
    assert moved is not None
    assert moved.view.pan == pytest.approx((40 / home, 20 / home))
    after = frame_of(picture.seen(moved))
    for before, sphere in zip(frame.spheres, after.spheres, strict=True):
        assert (sphere.x - before.x, sphere.y - before.y) == pytest.approx((40, -20))
        assert (sphere.radius, sphere.clip) == (before.radius, before.clip)


@pytest.mark.parametrize("steps", [1, 5, -1])
@pytest.mark.parametrize("pane", [0, 1])
def test_what_is_under_the_mouse_stays_there_while_the_wheel_zooms(steps: float, pane: int) -> None:
    picture = picture_of(zoom=3.0, pan=(0.2, -0.1), camera=(30.0, 10.0))
    frame = frame_of(picture)
    at = frame.spheres[pane].x + 50.5, frame.spheres[pane].y - 20.5
    mouse = Mouse()
    mouse.move(at, picture.state, frame)
    zoomed = mouse.scroll(steps, picture.state, frame)
    assert zoomed.view.zoom == pytest.approx(3 * 1.1**steps)
    after = frame_of(picture.seen(zoomed)).spheres[pane]
    before, now = (sphere.direction(*at, picture.world_from_view) for sphere in (frame.spheres[pane], after))
    np.testing.assert_allclose(now, before, rtol=0, atol=1e-12)


def test_beside_the_panes_the_wheel_zooms_about_the_middle() -> None:
    picture = picture_of(camera=(30.0, 10.0))
    mouse = Mouse()
    mouse.move((2.0, 638.0), picture.state, frame_of(picture))
    zoomed = mouse.scroll(3, picture.state, frame_of(picture))
    assert (zoomed.view.pan, zoomed.view.zoom) == ((0.0, 0.0), pytest.approx(1.331))


def test_zooming_in_and_out_about_a_point_ends_where_it_began_and_zooming_out_elsewhere_in_the_middle() -> None:
    state = state_of()
    there = zoom_about(zoom_about(state, 4, 0.5, 0.2), -4, 0.5 * 1.1**4, 0.2 * 1.1**4)
    np.testing.assert_allclose((*there.view.pan, there.view.zoom), (0, 0, 1), rtol=0, atol=1e-12)
    away = zoom_about(zoom_about(state, 9, 0.9, 0.0), -9, -0.9, 0.0)
    np.testing.assert_allclose((*away.view.pan, away.view.zoom), (0, 0, 1), rtol=0, atol=1e-12)


def test_the_wheel_turns_the_pages_of_the_help_and_no_sphere_under_it_grows() -> None:
    picture = picture_of(help_visible=True)
    mouse, frame = Mouse(), frame_of(picture)
    down = mouse.scroll(-1, picture.state, frame)
    assert (down.view.help_page, down.view.zoom) == (1, 1.0)
    assert mouse.scroll(1, down, frame).view.help_page == mouse.scroll(1, picture.state, frame).view.help_page == 0


def test_a_sphere_stays_in_sight_however_it_is_moved() -> None:
    for state in (pan(state_of(), 50, -3), zoom(pan(state_of(zoom=4.0), 3, 2), -9), zoom_about(state_of(), 99, 90, 1)):
        state.check()
        assert np.hypot(*state.view.pan) <= state.view.zoom * (1 + 1e-12)
    with pytest.raises(UsageError, match="pan 2 0: at zoom 1 a sphere is moved by at most 1 radii"):
        state_of(pan=(2.0, 0.0)).check()
    assert press(pan(state_of(), 0.5, 0), "F") == state_of()
