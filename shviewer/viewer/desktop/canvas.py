"""The content of a window: the renderer, and what is kept from one frame to the next. Knows no window and no event."""

from __future__ import annotations

from contextlib import suppress
from time import perf_counter

import moderngl

from shviewer.errors import ShviewerError
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.desktop.evaluation import Evaluation
from shviewer.viewer.drawn import DirectSum
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.overlay.captions import describe_evaluation
from shviewer.viewer.overlay.foot import Work
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.marks import mark_layers
from shviewer.viewer.overlay.overlay import Overlay, draw_overlay, status_layers
from shviewer.viewer.overlay.plots.plane import measured
from shviewer.viewer.overlay.probe import probe, probe_layers
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import State, changed
from shviewer.viewer.view import View

Point = tuple[float, float]

UPLOAD_SECONDS = 0.02
"""About how long a frame uploads maps, where no other thread does."""

UPLOADING = "handing the map to OpenGL"


class Canvas:
    """Frames on the screen of a context. release() at the end."""

    def __init__(self, context: moderngl.Context, carrier: Carrier | None = None) -> None:
        self.renderer = Renderer(context, carrier)
        self.overlay: Overlay | None = None
        self._overlay_key: object = None
        self._evaluation = Evaluation()
        self._work: Work | None = None
        """What is being done, as long as there is no picture."""

    @property
    def uploading(self) -> bool:
        """Whether a map is on its way."""
        return self.renderer.uploading is not None

    def by_map(self, state: State, composition: Composition) -> bool:
        """Whether to draw the reconstruction from a map; asked where the choice is left to the time that frames take."""
        pixels = summed_pixels(composition)
        return state.view.evaluate == "auto" and self._evaluation.choose(state.recipe.n_bands, pixels, perf_counter())

    def show(
        self,
        picture: Picture,
        composition: Composition,
        work: Work | None = None,
        pointer: Point | None = None,
        pace: float | None = None,
    ) -> bool:
        """Upload what has changed, and draw its text, with what is being done meanwhile in place of the message.

        pointer: where the mouse is, for the values of the band under it. pace: as in `draw_overlay`.

        Return False while a large map is on its way: the last picture stays, seen from where the camera is now.
        GraphicsError for a map that this OpenGL cannot hold.
        """
        uploaded = self.renderer.show(picture, UPLOAD_SECONDS)
        if not uploaded:
            self._work = work = work or Work(UPLOADING, round(self.renderer.uploading or 0.0, 2))
            if self.renderer.picture is None:
                return False
            self.renderer.picture = picture = self.renderer.picture.seen(picture.state)
        hovered = self.band_at(pointer)
        key = work, hovered, pace, _overlay_key(picture, composition)
        if key != self._overlay_key:
            opengl = self.renderer.version
            self.overlay = draw_overlay(
                picture, composition, timing=True, opengl=opengl, work=work, hovered=hovered, pace=pace
            )
            self._overlay_key = key
        return uploaded

    def band_at(self, pointer: Point | None) -> int | None:
        """The band whose slot in the curve is there; None for any other place."""
        slots = self.overlay.bars if self.overlay is not None else {}
        at = (band for band, box in slots.items() if pointer is not None and box.contains(*pointer))
        return next(at, None)

    def wait(self, work: Work, composition: Composition) -> None:
        """Draw what is being done, as long as there is no picture."""
        self.renderer.draw_text(self.renderer.context.screen, composition, status_layers(work, composition))

    def draw(self, composition: Composition, pointer: Point | None = None, *, alone: bool = True) -> bool:
        """Draw the picture last shown, with the values under the pointer; return whether another frame is due.

        alone: nothing else is at work. Then a picture that is summed per pixel is timed, and may turn out to be too slow.
        Until there is a picture, what is being done.
        """
        if self.renderer.picture is None and self._work is not None:
            self.wait(self._work, composition)
            return False
        picture = self._picture
        layers = self.layers(composition, pointer)
        timed = alone and picture.state.view.evaluate == "auto" and isinstance(picture.drawn, DirectSum)
        if timed:
            self.renderer.context.finish()
        start = perf_counter()
        self.renderer.draw(self.renderer.context.screen, composition, layers)
        if not timed:
            return False
        self.renderer.context.finish()
        now, pixels, n_bands = perf_counter(), summed_pixels(composition), picture.state.recipe.n_bands
        again = self._evaluation.drawn(n_bands, pixels, 1000 * (now - start), now)
        return again or self._evaluation.choose(n_bands, pixels, now)

    def layers(self, composition: Composition, pointer: Point | None = None) -> tuple[Layer, ...]:
        """Layers of the marks, of the text, and of the values under the pointer."""
        picture = self._picture
        written = self.overlay
        if written is None:
            return mark_layers(picture, composition)
        layers = (*mark_layers(picture, composition, written.obstacles), *written.layers)
        covered = written.sheet is not None and pointer is not None and written.sheet.contains(*pointer)
        if pointer is None or covered or picture.state.view.help_visible:
            return layers
        with suppress(ShviewerError):  # a light that cannot be evaluated there has no values to show
            found = probe(picture, composition, *pointer)
            if found is not None:
                layers += probe_layers(found, picture, composition, *pointer)
        return layers

    def release(self) -> None:
        self.renderer.release()
        if self.renderer.carrier is not None:
            self.renderer.carrier.end()

    @property
    def _picture(self) -> Picture:
        if self.renderer.picture is None:
            raise ValueError("nothing to draw: show a picture first")
        return self.renderer.picture


def summed_pixels(composition: Composition) -> float:
    """The number of visible pixels that show the reconstruction or its error."""
    return sum(pane.visible_area for pane in composition.panes[1:])


def _overlay_key(picture: Picture, composition: Composition) -> object:
    """A key that is equal as long as no text changes. Turning changes none, unless the help shows the camera.

    Zooming may change it, since text gives way to spheres; the time-error plane changes with every measurement, and figures
    come after the picture.
    """
    state = picture.state
    if not state.view.help_visible:
        state = changed(state, camera=View.camera, light_rotation=View.light_rotation, zoom=View.zoom, pan=View.pan)
    known = measured(picture) if state.view.sheet == "plane" else ()
    place = composition.width, composition.height, composition.scale, composition.panes
    figures = picture.figures, picture.needs, picture.verdict, picture.error_scale
    return state, figures, known, describe_evaluation(picture, timing=True), place
