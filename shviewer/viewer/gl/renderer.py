"""Draws a Picture into any framebuffer, at once or a part at a time. Knows OpenGL; knows no light, no key and no file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from time import perf_counter
from typing import NamedTuple

import moderngl
import numpy as np

from shviewer.lights.images.display.colour import srgb_from_linear
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Pane, Pixels, Sphere
from shviewer.viewer.drawn import Surfaces
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.held import Held
from shviewer.viewer.gl.layer_renderer import LayerRenderer
from shviewer.viewer.gl.pane_renderer import PaneRenderer, pixel_box, shown_panes
from shviewer.viewer.gl.shared import BACKGROUND
from shviewer.viewer.gl.surface_renderer import Steps, SurfaceRenderer, tiles
from shviewer.viewer.gl.textures import ArrayTexture
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.picture import Picture
from shviewer.viewer.surface import Surface

GL_VERSIONS = (450, 410, 330)
"""Versions of OpenGL in the order in which they are asked for; every shader is written for the last."""

PART_SECONDS = 0.01
"""About how long a part of a frame takes, where a window lives meanwhile."""

FIRST_PIXELS = 2**14
"""Pixels of the first part of a pane, of which nobody knows how long they take."""

GROWTH = 4
"""A part has at most this many times the rows or triangles of the one before it, however short that was."""


class Part(NamedTuple):
    """A part of a frame that has been drawn."""

    share: float
    """How much of the frame there is by now."""
    seconds: float
    """How long it took."""
    first: bool
    """Whether it was the first of its pane, for which OpenGL may have compiled a shader."""


class Renderer:
    """One context's programs, buffers and textures. `show` uploads what changed, `draw` draws it; release() at the end."""

    def __init__(
        self, context: moderngl.Context, carrier: Carrier | None = None, texture: type[ArrayTexture] = ArrayTexture
    ) -> None:
        """carrier, texture: as for `Held`."""
        self.context = context
        self.carrier = carrier
        self.held = Held(context, carrier, texture)
        self.panes = PaneRenderer(context, self.held)
        self.layers = LayerRenderer(context)
        self.surfaces = SurfaceRenderer(context)
        self.compiled: Callable[[Picture, Composition], bool] = lambda *_: True
        """`Warming.ready`, where there is one."""
        self.picture: Picture | None = None
        self.rest = context.simple_framebuffer((1, 1))
        """Bound while no other framebuffer is in use."""

    @property
    def version(self) -> str:
        """OpenGL's version and the name of the graphics processor, as the driver gives them."""
        code = self.context.version_code
        return f"OpenGL {code // 100}.{code % 100 // 10}, {self.context.info['GL_RENDERER']}"

    def show(self, picture: Picture, seconds: float | None = None) -> bool:
        """Upload what differs from the last picture; return whether it is all there.

        seconds: about how long to upload maps. Until they are there, the last picture stays.
        """
        if not self.held.show(picture, seconds):
            return False
        self.picture = picture
        return True

    def ready(self, picture: Picture, composition: Composition) -> bool:
        """Whether all of a picture is there at once; what is not is on its way then, surfaces in this frame, too."""
        if not self.compiled(picture, composition) or (self.carrier is not None and self.carrier.busy):
            return False
        return self.surfaces.triangles.bring(surfaces_in(picture, composition)) and self.show(picture, 0.0)

    def draw(
        self,
        target: moderngl.Framebuffer,
        composition: Composition,
        layers: Sequence[Layer] = (),
        *,
        linear: bool = False,
    ) -> None:
        """Draw the picture last shown, and layers over it. linear: the radiance alone; ValueError for surfaces."""
        for _ in self.parts(target, composition, layers, linear=linear):
            pass

    def parts(
        self,
        target: moderngl.Framebuffer,
        composition: Composition,
        layers: Sequence[Layer] | None = (),
        *,
        linear: bool = False,
        seconds: float | None = None,
    ) -> Iterator[Part]:
        """Draw the same part by part; between two of them others may be drawn, of other pictures with the same maps.

        layers: None draws the panes alone. seconds: about how long a part may take. However the frame is divided, its pixels
        are the same.
        """
        picture = self.picture
        if picture is None:
            raise ValueError("nothing to draw: show a picture first")
        if linear and isinstance(picture.drawn, Surfaces):
            raise ValueError("surfaces hold no radiance")
        self._clear(target, composition, (0.0, 0.0, 0.0, 0.0) if linear else _GROUND)
        works = self._works(target, composition, picture, linear)
        total, done = sum(area for area, _ in works), 0
        for area, drawing in works:
            with drawing as (steps, count, draw):
                at, count = 0, count if seconds is not None else steps
                while at < steps:
                    if self.picture is not picture:
                        self.show(picture)
                    start = perf_counter()
                    target.use()
                    count = min(count, steps - at)
                    draw(at, count)
                    at += count
                    if seconds is not None:
                        self.context.finish()
                        took = perf_counter() - start
                        yield Part((done + area * at / steps) / total, took, at == count)
                        count = max(int(count * min(GROWTH, seconds / max(took, 1e-9))), 1)
            done += area
        written = layers if layers and not linear else ()
        for _ in self.layers.bring(written) if written else ():
            if seconds is not None:
                yield Part(1.0, 0.0, False)
        target.use()
        target.viewport = (0, 0, composition.width, composition.height)
        if written:
            self.layers.draw(target, composition, written)
        if self.carrier is not None:
            self.carrier.drawn()

    def draw_text(self, target: moderngl.Framebuffer, composition: Composition, layers: Sequence[Layer]) -> None:
        """Draw layers over the background alone, as long as there is no picture."""
        self._clear(target, composition, _GROUND)
        self.layers.draw(target, composition, layers)

    def release(self) -> None:
        """Free everything this object made."""
        for resource in (self.held, self.panes, self.layers, self.surfaces):
            resource.release()
        for attachment in (*self.rest.color_attachments, self.rest.depth_attachment):
            if attachment is not None:
                attachment.release()
        self.rest.release()

    def _clear(
        self, target: moderngl.Framebuffer, composition: Composition, colour: tuple[float, float, float, float]
    ) -> None:
        target.use()
        target.viewport = (0, 0, composition.width, composition.height)
        self.context.disable(moderngl.BLEND)
        target.clear(color=colour)
        self.rest.use()  # Mesa forgets at a clear that a program drew upside down, into a window, until it is bound anew
        target.use()

    def _works(
        self, target: moderngl.Framebuffer, composition: Composition, picture: Picture, linear: bool
    ) -> list[tuple[int, AbstractContextManager[Steps]]]:
        """What is to be drawn of a picture, one after the other: pixels, and the steps to them."""
        if isinstance(picture.drawn, Surfaces):
            turned = picture.light_from_world @ picture.world_from_view
            return [
                (box[2] * box[3], self.surfaces.tile(target, sphere, composition.height, surface, turned, box))
                for surface, sphere in surfaces_in(picture, composition)
                for box in tiles(sphere, composition.height)
            ]

        def draw(shown: str, pane: Pane, whole: Pixels, row: int, rows: int) -> None:
            left, bottom, wide, _ = target.viewport = whole
            target.scissor = left, bottom + row, wide, rows
            self.panes.draw(picture, shown, pane, composition, linear=linear)
            target.scissor = None  # type: ignore[assignment]  # None: all of it

        panes = [
            (shown, pane, pixel_box(pane, composition.height)) for shown, pane in shown_panes(picture, composition)
        ]
        return [
            (wide * high, nullcontext(Steps(high, max(FIRST_PIXELS // wide, 1), partial(draw, shown, pane, box))))
            for shown, pane, box in panes
            if (wide := box[2]) and (high := box[3])
        ]


def surfaces_in(picture: Picture, composition: Composition) -> list[tuple[Surface, Sphere]]:
    """The surfaces of a picture, and the spheres in whose place they are."""
    shown = picture.drawn.shown if isinstance(picture.drawn, Surfaces) else ()
    return list(zip(shown, composition.spheres, strict=False))


_GROUND = (*srgb_from_linear(np.array(BACKGROUND)).tolist(), 1.0)
"""The background as it is written into a framebuffer."""
