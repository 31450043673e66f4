"""The content of a window: the renderer, and what is kept from one frame to the next. Knows no window and no event."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from time import perf_counter

import moderngl

from shviewer.errors import ShviewerError
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.desktop.behind.task import Wake
from shviewer.viewer.desktop.evaluation import Evaluation
from shviewer.viewer.desktop.unchanged import overlay_key, panes_key
from shviewer.viewer.drawn import DirectSum
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.kept import Kept
from shviewer.viewer.gl.renderer import PART_SECONDS, Part, Renderer, surfaces_in
from shviewer.viewer.gl.warming import Warming
from shviewer.viewer.overlay.directions.marks import layers_over, mark_layers
from shviewer.viewer.overlay.directions.probe import probe, probe_layers
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.overlay import Overlay, draw_overlay, status_layers
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import State, changed
from shviewer.viewer.view import View
from shviewer.viewer.work import Work

Point = tuple[float, float]

UPLOAD_SECONDS = 0.02
"""About how long a frame uploads maps, where no other thread does."""

UPLOADING, MESHING, COMPILING = "handing the map to OpenGL", "making the surfaces", "compiling the shaders"

PLAIN_FRAMES = 2
"""How many frames of the same panes are drawn as they are; further ones copy them, which takes a fifth of a frame."""

MOST_SUMMED = 0.05
"""Seconds after which the rest of a sum is not waited for, where a map could be drawn."""


class Canvas:
    """Frames on the screen of a context. release() at the end."""

    def __init__(self, context: moderngl.Context, carrier: Carrier | None = None, wake: Wake = None) -> None:
        self.renderer = Renderer(context, carrier)
        self._warming = Warming(carrier) if carrier is not None else None
        if self._warming is not None:
            self.renderer.compiled = self._warming.ready
        self.screen = context.screen
        self.overlay: Overlay | None = None
        self.again = False
        """Whether the last frame asks for another one."""
        self.composition: Composition | None = None
        """The layout of the picture that was last shown."""
        self._overlay_key: object = None
        self._evaluation = Evaluation()
        self._wake = wake
        self._shown: Picture | None = None
        """The picture that frames are drawn of."""
        self._pending: Work | None = None
        """What the next picture waits for."""
        self._frame: _Begun | None = None
        self._kept = Kept(self.renderer)
        self._exact = True
        """Whether surfaces have the triangles that they should have."""
        self._panes: tuple[object, int] = None, 0
        """The key of the panes that were drawn last, and in how many frames they were."""

    @property
    def pending(self) -> str:
        """What the next picture waits for, in words: that OpenGL has it; "" for nothing."""
        return self._pending.words if self._pending is not None else ""

    @property
    def news(self) -> bool:
        """Whether there is something for the next frame."""
        return self.renderer.surfaces.triangles.arrived

    @property
    def drawing(self) -> bool:
        """Whether a frame was begun and is not whole."""
        return self._frame is not None

    def by_map(self, state: State, composition: Composition) -> bool:
        """Whether to draw the reconstruction from a map; asked where the choice is left to the time that frames take."""
        pixels = summed_pixels(composition)
        return state.view.evaluate == "auto" and self._evaluation.choose(state.recipe.n_bands, pixels, perf_counter())

    def too_slow(self, picture: Picture, composition: Composition) -> bool:
        """Whether a picture is one of a sum that is known to take too long."""
        known = self._evaluation.too_slow(picture.state.recipe.n_bands, summed_pixels(composition), perf_counter())
        return known and _choosable(picture)

    def show(
        self,
        picture: Picture,
        composition: Composition,
        work: Work | None = None,
        pointer: Point | None = None,
        pace: float | None = None,
        framed: Callable[[View], Composition | None] | None = None,
    ) -> bool:
        """Upload what has changed, and draw its text, with what is being done meanwhile in place of the message.

        pointer: where the mouse is, for the values of the band under it. pace: as in `draw_overlay`. framed: the layout of
        another view, for the last picture, which may have more or other panes.

        Return False while a large map or a surface is on its way: the last picture stays, seen from where the camera is now.
        GraphicsError for a map that this OpenGL cannot hold.
        """
        self._pending = None
        if not self._meshed(picture, composition):
            self._pending = Work(MESHING)
        elif not self.renderer.compiled(picture, composition):
            self._pending = Work(COMPILING)
        elif not self.renderer.show(picture, UPLOAD_SECONDS):
            self._pending = Work(UPLOADING, round(self.renderer.held.uploading or 0.0, 2))
        if self._pending is None:
            self._shown = picture
        elif self._shown is None:
            return False
        else:
            last, view = self._shown, picture.state.view
            picture = last.seen(picture.state)
            composition = (framed and framed(picture.state.view)) or composition
            if self._warming is not None and not self._warming.has(picture, composition):
                picture = last.seen(changed(last.state, camera=view.camera, light_rotation=view.light_rotation))
                composition = (framed and framed(picture.state.view)) or composition
            self._shown = self.renderer.picture = picture
        self.composition = composition
        hovered = self.band_at(pointer)
        work = work or self._pending
        key = work, hovered, pace, overlay_key(picture, composition)
        if key != self._overlay_key:
            opengl = self.renderer.version
            self.overlay = draw_overlay(
                picture, composition, timing=True, opengl=opengl, work=work, hovered=hovered, pace=pace
            )
            self._overlay_key = key
        return self._pending is None

    def _meshed(self, picture: Picture, composition: Composition) -> bool:
        """Whether surfaces that are shown have triangles, if only until there are better ones."""
        triangles, wanted = self.renderer.surfaces.triangles, surfaces_in(picture, composition)
        self._exact = triangles.bring(wanted, self._wake)
        return self._exact or all(triangles.has(surface) for surface, _ in wanted)

    def band_at(self, pointer: Point | None) -> int | None:
        """The band whose slot in the curve is there; None for any other place."""
        slots = self.overlay.bars if self.overlay is not None else {}
        at = (band for band, box in slots.items() if pointer is not None and box.contains(*pointer))
        return next(at, None)

    def wait(self, work: Work, composition: Composition) -> None:
        """Draw what is being done, as long as there is no picture."""
        self.renderer.draw_text(self.screen, composition, status_layers(work, composition))

    def begin(self, composition: Composition, pointer: Point | None = None, *, alone: bool = True) -> None:
        """Begin with a frame of the picture last shown, with the values under the pointer.

        alone: nothing else is at work. Then a picture that is summed per pixel is timed, and may turn out to be too slow.
        Until there is a picture, the frame says what is being done.
        """
        again, self.again = self.again, False
        if self._shown is None:
            self.wait(self._pending or Work(UPLOADING), composition)
            self._frame = _Begun(iter(()), composition, False)
            return
        key = panes_key(self._shown, composition, self._exact)
        frames = self._panes[1] + 1 if key == self._panes[0] else 1
        self._panes = key, frames
        carrier = self.renderer.carrier  # what copies panes may be compiled there
        copied = frames > PLAIN_FRAMES and not again and not (carrier is not None and carrier.busy)
        parts = self._parts(composition, pointer, key if copied else None)
        self._frame = _Begun(parts, composition, alone and not copied and _choosable(self._shown))

    def _parts(self, composition: Composition, pointer: Point | None, kept: object) -> Iterator[Part]:
        """Draw a frame part by part, first what is written. kept: the key of panes that are copied."""
        for _ in self.overlay.drawing() if self.overlay is not None else ():
            yield Part(0.0, 0.0, False)
        layers = self.layers(composition, pointer)
        if kept is not None:
            yield from self._kept.parts(kept, self.screen, composition, layers, PART_SECONDS)
        else:
            yield from self.renderer.parts(self.screen, composition, layers, seconds=PART_SECONDS)

    def go_on(self, seconds: float | None = None) -> bool:
        """Draw on for about so long; return whether the frame is whole. A sum that takes too long is given up."""
        frame, picture = self._frame, self._shown
        assert frame is not None, "no frame was begun"
        end = None if seconds is None else perf_counter() + seconds
        whole = True
        for part in frame.parts:
            frame.seconds += 0.0 if part.first else part.seconds  # in the first one OpenGL may have compiled a shader
            if end is not None and perf_counter() >= end:
                whole = False
                break
        slow = not whole and frame.timed and frame.seconds > MOST_SUMMED
        if whole or slow:
            self._frame = None
        if frame.timed and picture is not None and (whole or slow):
            now, pixels, n_bands = perf_counter(), summed_pixels(frame.composition), picture.state.recipe.n_bands
            self.again = self._evaluation.drawn(n_bands, pixels, 1000 * frame.seconds, now, sure=slow)
            self.again = self._evaluation.choose(n_bands, pixels, now) or self.again
        return whole

    def give_up(self) -> None:
        """Draw no more of the frame that was begun: the window has another size."""
        self._frame = None

    def layers(self, composition: Composition, pointer: Point | None = None) -> tuple[Layer, ...]:
        """Layers of the marks, of the text, and of the values under the pointer."""
        picture, written = self._shown, self.overlay
        if picture is None:
            return ()
        if written is None:
            return mark_layers(picture, composition)
        layers = layers_over(picture, composition, written)
        if pointer is None or picture.state.view.help_visible:
            return layers
        with suppress(ShviewerError):  # a light that cannot be evaluated there has no values to show
            found = probe(picture, composition, *pointer)
            if found is not None:
                layers += probe_layers(found, picture, composition, *pointer)
        return layers

    def release(self) -> None:
        try:
            self._kept.release()
            self.renderer.release()
        finally:
            if self.renderer.carrier is not None:
                self.renderer.carrier.end()  # a context must not go while a thread compiles in it


@dataclass
class _Begun:
    """A frame that was begun."""

    parts: Iterator[Part]
    composition: Composition
    timed: bool
    seconds: float = 0.0
    """How long it has taken, without the first parts of its panes."""


def _choosable(picture: Picture) -> bool:
    """Whether it is summed because that was thought to be fast."""
    return picture.state.view.evaluate == "auto" and isinstance(picture.drawn, DirectSum)


def summed_pixels(composition: Composition) -> float:
    """The number of visible pixels that show the reconstruction or its error."""
    return sum(pane.visible_area for pane in composition.panes[1:])
