"""Programs are compiled by another thread: the picture that is there goes on until they are, and no frame compiles any."""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from typing import Any

import moderngl
import numpy as np
import pytest
from helpers import frame_of, picture_of, unavailable
from viewer.gl.side import EglSide

from shviewer.lights.environment import EnvironmentLight
from shviewer.viewer.composing.composition import frame_for
from shviewer.viewer.desktop.canvas import COMPILING, Canvas
from shviewer.viewer.gl import programs
from shviewer.viewer.gl import warming as gl_warming
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.held import kind_of
from shviewer.viewer.gl.pane_renderer import kinds_of
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.gl.warming import Warming, _Corner
from shviewer.viewer.picture import Picture
from shviewer.viewer.screenshot import offscreen
from shviewer.viewer.state import changed

PICTURES: dict[str, dict[str, Any]] = {
    "an error": {"error": "signed"},
    "the whole sphere": {"whole_sphere": True, "tone": "log"},
    "two reconstructions": {"window": "hann", "beside": "no-window", "evaluate": "map"},
    "a photograph without its sun": {"light": "venice_sunset", "split_sun": True, "error": "relative"},
    "an encoding": {"quantity": "irradiance", "n_bands": 3, "encode": "zh3"},
    "surfaces": {"lobe_view": True},
}


@pytest.fixture
def carrier(renderer: Renderer) -> Iterator[Carrier]:
    side = EglSide()
    made = Carrier(renderer.context, side)
    yield made
    made.end()
    side.end()
    renderer.rest.use()


@pytest.fixture
def canvas(carrier: Carrier, renderer: Renderer) -> Iterator[Canvas]:
    made = Canvas(renderer.context, carrier)
    yield made
    renderer.rest.use()
    made.renderer.release()


def show(canvas: Canvas, picture: Picture) -> None:
    while not canvas.show(picture, frame_of(picture)):
        assert canvas.pending
    settle(canvas)


def settle(canvas: Canvas) -> None:
    """Wait for the other thread."""
    assert canvas.renderer.carrier is not None
    assert canvas.renderer.carrier.ask(lambda: None).wait(60)


def draw(canvas: Canvas, picture: Picture) -> None:
    with offscreen(canvas.renderer, frame_of(picture)) as target:
        canvas.screen = target
        canvas.begin(frame_of(picture))
        assert canvas.go_on()


def test_the_last_picture_can_be_turned_until_the_programs_of_the_next_are_there(
    canvas: Canvas, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gl_warming, "MOST", 99.0)
    first, second = picture_of(), picture_of(error="absolute", whole_sphere=True)
    show(canvas, first)
    draw(canvas, first)
    assert canvas.renderer.carrier is not None
    known, gate = set(canvas.renderer.panes.programs), threading.Event()
    canvas.renderer.carrier.ask(lambda: gate.wait(60))
    for camera in ((10.0, 5.0), (20.0, 5.0)):
        turned = second.seen(changed(second.state, camera=camera))
        assert not canvas.show(turned, frame_of(turned), framed=lambda view: frame_for(view, 1280, 640))
        assert canvas.pending == COMPILING
        assert canvas._shown is not None
        assert canvas._shown.drawn is first.drawn
        np.testing.assert_array_equal(canvas._shown.world_from_view, turned.world_from_view)
        assert canvas.composition == frame_of(first)
        draw(canvas, first)
        assert set(canvas.renderer.panes.programs) == known
    gate.set()
    show(canvas, second)
    assert canvas._shown is second


@pytest.mark.parametrize("name", PICTURES)
def test_whatever_a_frame_compiles_was_compiled_by_the_other_thread_before(
    canvas: Canvas, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    compiled: dict[str, set[tuple[Any, ...]]] = {}
    plain = programs._compile

    def noted(context: moderngl.Context, vertex: str, fragment: str, chosen: dict[str, Any]) -> moderngl.Program:
        thread = threading.current_thread().name
        compiled.setdefault(thread, set()).add((vertex, fragment, *sorted(chosen.items())))
        return plain(context, vertex, fragment, chosen)

    first, second = picture_of("constant", n_bands=1, tone="aces"), picture_of(**PICTURES[name])
    show(canvas, first)
    draw(canvas, first)
    monkeypatch.setattr(programs, "_compile", noted)
    show(canvas, second)
    draw(canvas, second)
    here = compiled[threading.current_thread().name]
    assert here
    assert here <= compiled["textures"]


def test_a_picture_is_saved_when_its_programs_are_there(canvas: Canvas, carrier: Carrier) -> None:
    shown, gate = picture_of(), threading.Event()
    show(canvas, shown)
    carrier.ask(lambda: gate.wait(60))
    other = picture_of(tone="log")
    assert not canvas.renderer.ready(other, frame_of(other))
    gate.set()
    settle(canvas)
    assert canvas.renderer.ready(other, frame_of(other))


@pytest.mark.parametrize("fails", [True, False])
def test_where_nothing_is_kept_or_all_goes_wrong_frames_compile(
    carrier: Carrier, monkeypatch: pytest.MonkeyPatch, fails: bool
) -> None:
    tries = 0

    def slow(self: Warming, *picture: object) -> bool:
        nonlocal tries
        tries += 1
        if fails:
            raise moderngl.Error("no memory")
        return False

    monkeypatch.setattr(Warming, "_draw", slow)
    monkeypatch.setattr(gl_warming, "PAUSES", (0.0, 0.0))
    warming, pictures = Warming(carrier), [picture_of(), picture_of(tone="log")]
    for shown in pictures * 2:
        warming.ready(shown, frame_of(shown))
        assert carrier.ask(lambda: None).wait(60)
        assert warming.ready(shown, frame_of(shown))
    assert tries == 2  # once for each picture, or twice and then never


def test_nothing_waits_long_for_a_compiler_that_is_slow(carrier: Carrier, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gl_warming, "MOST", 0.0)
    shown, gate = picture_of(), threading.Event()
    carrier.ask(lambda: gate.wait(60))
    assert Warming(carrier).ready(shown, frame_of(shown))
    gate.set()


def test_the_end_waits_for_no_compiler(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """It would hang here for a minute."""
    drawn = threading.Event()
    monkeypatch.setattr(Warming, "_draw", lambda *_: drawn.set())
    monkeypatch.setattr(gl_warming, "PAUSES", (0.0, 60.0))
    side, shown = EglSide(), picture_of()
    carrier = Carrier(renderer.context, side)
    Warming(carrier).ready(shown, frame_of(shown))
    assert drawn.wait(60)
    carrier.end()
    side.end()


@pytest.mark.parametrize("size", [(1, 1), (2, 6), (3, 4), (64, 128), (100, 7)])
@pytest.mark.parametrize("components", [3, 4])
@pytest.mark.parametrize("halves", [True, False])
def test_a_corner_of_a_map_is_of_its_kind(
    renderer: Renderer, size: tuple[int, int], components: int, halves: bool
) -> None:
    texels = np.ones((*size, components), np.float32)
    corner = _Corner(renderer.context)
    corner.follow(texels, halves)
    assert corner._held is not None
    held = corner._held.texture
    assert max(held.size) <= 3
    assert (held.components, held.dtype) == (components, "f2" if halves else "f4")
    for side, whole in zip(held.size[::-1], size, strict=True):
        assert (side & (side - 1) == 0) == (whole & (whole - 1) == 0)
    corner.release()


def test_maps_of_other_texels_are_of_other_kinds() -> None:
    random = np.random.default_rng(3).random((32, 64, 3), np.float32)
    maps = [random, random.astype(np.float16).astype(np.float32), random[:31], random[:, :50]]
    pictures = [picture_of(light=EnvironmentLight(texels.copy(), name="sky")) for texels in maps]
    assert len({kind_of(picture.original.map) for picture in pictures}) == 4
    kinds = [kinds_of(picture, frame_of(picture)) for picture in pictures]
    assert all(len(one) == 2 and len(one & other) == 1 for one, other in itertools.pairwise(kinds))


OF_A_PROCESS = """
import sys, threading, time
from pathlib import Path
sys.path[:0] = {path!r}
from viewer.gl.side import EglSide
from helpers import frame_of, picture_of
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.warming import Warming
from shviewer.viewer.screenshot import headless_renderer, read_rgb

def files():
    return sum(1 for path in Path({cache!r}).rglob("*") if path.is_file())

with headless_renderer() as renderer:
    picture = picture_of("venice_sunset", n_bands=3, error="signed", evaluate="map")
    frame = frame_of(picture)
    side = EglSide()
    carrier = Carrier(renderer.context, side)
    if {ahead!r}:
        warming = Warming(carrier)
        warming.ready(picture, frame)
        carrier.ask(lambda: None).wait()
    renderer.show(picture)
    before = files()
    read_rgb(renderer, frame)
    last, now = -1, files()
    while now != last:
        time.sleep(0.3)
        last, now = now, files()
    print(before, now - before)
    carrier.end()
    side.end()
"""


def test_opengl_in_software_compiles_nothing_in_a_frame_that_was_drawn_beside(tmp_path: Any) -> None:
    """What it compiles it writes into its folder: nothing new after the other thread, with maps and an error."""
    new = []
    for ahead in (False, True):
        cache = tmp_path / str(ahead)
        code = OF_A_PROCESS.format(path=sys.path, cache=str(cache), ahead=ahead)
        done = subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "MESA_SHADER_CACHE_DIR": str(cache)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        new.append([int(word) for word in done.stdout.split()])
    if new[0][1] == 0:
        unavailable("an OpenGL that keeps what it compiles in MESA_SHADER_CACHE_DIR")
    assert new[1][0] > 0
    assert new[1][1] == 0
