"""Large maps reach OpenGL by another thread: the one that draws goes on, and draws the same."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import numpy as np
import pytest
from helpers import frame_of, picture_of
from viewer.gl.side import EglSide

from shviewer.errors import GraphicsError
from shviewer.lights.environment import EnvironmentLight
from shviewer.viewer.composing.composition import Composition, frame_for
from shviewer.viewer.desktop.canvas import UPLOADING, Canvas
from shviewer.viewer.gl import carrier, textures
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.gl.textures import ArrayTexture
from shviewer.viewer.picture import Picture
from shviewer.viewer.screenshot import read_rgb
from shviewer.viewer.state import changed
from shviewer.viewer.view import View

OUT_OF_MEMORY = 0x505
LARGE = np.random.default_rng(7).random((50, 9, 3), dtype=np.float32)


class Thread(Carrier):
    """A carrier whose thread can be held where a texture takes its memory."""

    open: threading.Event
    asked: threading.Event

    @classmethod
    def gated(cls, renderer: Renderer, side: EglSide) -> Thread:
        made = cls(renderer.context, side)
        made.open, made.asked = threading.Event(), threading.Event()
        made.open.set()
        storage = made.calls["glTexStorage2D"]

        def held(*arguments: int) -> int:
            made.asked.set()
            assert made.open.wait(60)
            return storage(*arguments)

        made.calls["glTexStorage2D"] = held
        return made


@pytest.fixture
def thread(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> Iterator[Thread]:
    monkeypatch.setattr(textures, "BAND_BYTES", 100)  # so that every map is a large one
    monkeypatch.setattr(carrier, "CARRIED_BYTES", LARGE[:8].nbytes)
    side = EglSide()
    made = Thread.gated(renderer, side)
    yield made
    made.open.set()
    made.end()
    side.end()


def arrived(texture: ArrayTexture, array: np.ndarray, halves: bool = False) -> np.ndarray:
    """What OpenGL holds once all of the array is there."""
    texture.follow(array, halves)
    assert texture._held is not None
    shown = texture._held.texture
    dtype = np.float16 if halves else np.float32
    return np.frombuffer(shown.read(alignment=1), dtype).reshape(array.shape)


def sky(seed: int, **view: object) -> Picture:
    pixels = np.random.default_rng(seed).random((24, 48, 3), dtype=np.float32)
    return picture_of(light=EnvironmentLight(pixels, name=f"sky {seed}"), **view)


def test_every_texel_arrives_as_it_is(renderer: Renderer, thread: Thread) -> None:
    halves = LARGE.astype(np.float16).astype(np.float32)
    for components in (3, 4):
        array = np.ascontiguousarray(np.concatenate([LARGE, LARGE[..., :1]], axis=2)[..., :components])
        texture = ArrayTexture(renderer.context, thread)
        np.testing.assert_array_equal(arrived(texture, array), array)
        texture.release()
    texture = ArrayTexture(renderer.context, thread)
    np.testing.assert_array_equal(arrived(texture, halves, halves=True), halves)
    texture.release()


def test_frames_go_on_while_opengl_takes_the_memory_of_a_map(renderer: Renderer, thread: Thread) -> None:
    canvas, before, after = Canvas(renderer.context, thread), sky(1), sky(2)
    assert not canvas.show(before, frame_of(before))
    assert canvas.renderer.picture is None  # nothing yet but what is being done
    while not canvas.show(before, frame_of(before)):
        assert canvas.pending
    last = read_rgb(canvas.renderer, frame_of(before))
    thread.open.clear()
    thread.asked.clear()
    assert not canvas.show(after, frame_of(after))
    assert thread.asked.wait(60)
    turned = after.seen(changed(after.state, camera=(70.0, 20.0)))
    assert not canvas.show(turned, frame_of(after))
    assert canvas.pending
    assert canvas._shown.light is before.light
    assert np.allclose(canvas._shown.world_from_view, turned.world_from_view)  # the last picture can be turned
    assert canvas._overlay_key[0].words == UPLOADING
    assert (read_rgb(canvas.renderer, frame_of(after)) != last).any()
    thread.open.set()
    while not canvas.show(turned, frame_of(after)):
        assert canvas.pending
    assert canvas._shown is turned
    assert not canvas.pending
    renderer.rest.use()
    canvas.renderer.release()


@pytest.mark.parametrize("before", [{"error": "signed"}, {"whole_sphere": True}, {}], ids=str)
@pytest.mark.parametrize("after", [{}, {"error": "signed"}], ids=str)
def test_a_picture_that_stays_keeps_its_panes(
    renderer: Renderer, thread: Thread, before: dict[str, object], after: dict[str, object]
) -> None:
    """The window closed where the error was taken away with a map on its way: its marks had no pane."""

    def framed(view: View) -> Composition:
        return frame_for(view, 320, 160)

    def show(picture: Picture) -> bool:
        return canvas.show(picture, framed(picture.state.view), framed=framed)

    canvas, first, second = Canvas(renderer.context, thread), sky(1, **before), sky(2, **after)
    while not show(first):
        assert canvas.pending
    thread.open.clear()
    thread.asked.clear()
    assert not show(second)
    assert thread.asked.wait(60)
    assert canvas.composition is not None
    assert len(canvas.composition.panes) == len(framed(first.state.view).panes)
    assert canvas.layers(canvas.composition)
    read_rgb(canvas.renderer, canvas.composition)
    thread.open.set()
    while not show(second):
        assert canvas.pending
    assert canvas.composition == framed(second.state.view)
    renderer.rest.use()
    canvas.renderer.release()


def test_a_map_that_was_carried_is_drawn_as_one_that_went_up_here(renderer: Renderer, thread: Thread) -> None:
    drawn, shown = Renderer(renderer.context, thread), sky(3)
    drawn.show(shown)
    renderer.show(shown)
    np.testing.assert_array_equal(read_rgb(drawn, frame_of(shown)), read_rgb(renderer, frame_of(shown)))
    renderer.rest.use()
    drawn.release()


def test_a_map_that_is_given_up_half_way_leaves_nothing_behind(renderer: Renderer, thread: Thread) -> None:
    texture, before = ArrayTexture(renderer.context, thread), LARGE + 1
    texture.follow(before)
    thread.open.clear()
    assert not texture.bring(LARGE, 0.0)
    load = texture._next
    assert texture.bring(before, 0.0)
    thread.open.set()
    thread.drawn()
    np.testing.assert_array_equal(arrived(texture, before), before)
    texture.release()
    np.testing.assert_array_equal(arrived(texture, LARGE), LARGE)  # so that the thread has come to the end of the other
    assert isinstance(load, carrier.Load)
    assert (load.share < 1, *load.names) == (True, 0, 0)
    texture.release()


def test_the_memory_of_a_map_is_held_until_a_frame_was_drawn_without_it(renderer: Renderer, thread: Thread) -> None:
    texture = ArrayTexture(renderer.context, thread)
    texture.follow(LARGE)
    load = texture._held
    assert isinstance(load, carrier.Load)
    assert all(load.names)
    texture.follow(LARGE + 1)
    texture.follow(LARGE + 2)  # the thread has done all there was to do
    assert (load.names[0], bool(load.names[1])) == (0, True)
    thread.drawn()
    texture.follow(LARGE + 3)
    assert tuple(load.names) == (0, 0)
    texture.release()


def test_a_map_for_which_opengl_has_no_memory_is_refused_in_one_line(renderer: Renderer, thread: Thread) -> None:
    texture = ArrayTexture(renderer.context, thread)
    texture.follow(LARGE)
    answers = iter([0, OUT_OF_MEMORY])
    asked, thread.calls["glGetError"] = thread.calls["glGetError"], lambda: next(answers)
    with pytest.raises(GraphicsError, match="no memory in OpenGL for a map of 9 x 50 texels"):
        texture.follow(LARGE + 1)
    thread.calls["glGetError"] = asked
    np.testing.assert_array_equal(arrived(texture, LARGE), LARGE)
    texture.release()


def test_the_end_waits_for_no_map_that_is_on_its_way(renderer: Renderer, thread: Thread) -> None:
    texture = ArrayTexture(renderer.context, thread)
    thread.open.clear()
    assert not texture.bring(LARGE, 0.0)
    load = texture._next
    assert thread.asked.wait(60)
    threading.Timer(0.05, thread.open.set).start()
    texture.release()
    assert isinstance(load, carrier.Load)
    thread.drawn()
    assert load.over.wait(60)
    assert load.share < 1


def test_without_a_second_context_maps_go_up_in_the_thread_that_draws(renderer: Renderer) -> None:
    class NoSide(EglSide):
        def enter(self) -> None:
            raise GraphicsError("no second context")

    side = NoSide()
    assert Carrier.beside(renderer.context, None) is None
    assert Carrier.beside(renderer.context, side) is None
    side.end()
