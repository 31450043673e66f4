"""Draws surfaces of the lobe view into any framebuffer: triangles go into a finer tile, which is averaged in linear light."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property
from itertools import chain
from math import ceil, floor
from typing import NamedTuple

import moderngl

from shviewer.harmonics.basis import Array
from shviewer.viewer.composing.panes import Pixels, Sphere
from shviewer.viewer.gl.programs import SAMPLERS, Program, render
from shviewer.viewer.gl.triangles import Triangles
from shviewer.viewer.surface import Surface

OVERSAMPLING = 3
"""Samples along a side of a pixel."""

TILE = 512
"""Pixels along a side of the tile drawn at a time: large frames take time, not memory."""

FIRST_TRIANGLES = 2**14
"""How many are drawn at first, of which nobody knows how long they take."""

RING_WIDTH, WIDEST_RING = 1 / 200, 2.0
"""The line of the circle of radius 1: its width in radii (but at least a pixel), and its largest width in pixels."""


class Steps(NamedTuple):
    """Something to draw, a few steps at a time."""

    total: int
    few: int
    """How many make a short part, of a time that is not known."""
    draw: Callable[[int, int], None]
    """Draws from one step on, so many."""


class SurfaceRenderer:
    """One context's programs, tiles and the surfaces drawn last. release() at the end."""

    def __init__(self, context: moderngl.Context) -> None:
        self.context = context
        self.triangles = Triangles(context)
        self.spare: list[tuple[moderngl.Framebuffer, moderngl.Texture, moderngl.Renderbuffer]] = []
        """Tiles that nothing is drawn into: a frame and a picture that is saved take turns in the middle of one."""

    @cached_property
    def program(self) -> Program:
        return Program(self.context, "surface.frag", vertex="surface.vert")

    @cached_property
    def resolve_program(self) -> Program:
        return Program(self.context, "surface_resolve.frag", {"TONE": "NONE"})

    @contextmanager
    def tile(
        self,
        target: moderngl.Framebuffer,
        sphere: Sphere,
        height: int,
        surface: Surface,
        light_from_view: Array,
        box: Pixels,
    ) -> Iterator[Steps]:
        """Draw what of a surface is in one of its `tiles`, over BACKGROUND; pixels that it does not touch are left alone.

        target: RGBA8, sRGB, `height` pixels high; sphere: in whose place it is, with its centre, the length of radius 1 in
        pixels, and where it is cut. light_from_view: 3 x 3, as for the spheres. A step is a triangle; target is drawn into when
        all have been taken. What is bound, enabled and in view is left as found.
        """
        made = fine, tones, _ = self.spare.pop() if self.spare else self._make_tile()
        (x, y, wide, high), side = box, TILE * OVERSAMPLING
        key = self.triangles.chosen(surface, sphere.radius)

        def draw(first: int, count: int) -> None:
            self.program.set(
                radius=sphere.radius * OVERSAMPLING,
                tile=(side, side),
                view_from_light=tuple(light_from_view.ravel()),  # transposed: by columns
                centre=((sphere.x - x) * OVERSAMPLING, (height - sphere.y - y) * OVERSAMPLING),
            )
            with self._using(fine, moderngl.DEPTH_TEST | moderngl.CULL_FACE):
                fine.viewport = (0, 0, side, side)
                if first == 0:
                    fine.clear(viewport=(0, 0, wide * OVERSAMPLING, high * OVERSAMPLING))
                render(self.triangles.array(self.program, key), 3 * count, 3 * first)

        try:
            yield Steps(self.triangles.array(self.program, key).vertices // 3, FIRST_TRIANGLES, draw)
            self.resolve_program.set(
                oversampling=OVERSAMPLING,
                centre=(sphere.x, height - sphere.y),
                radius=sphere.radius,
                ring_width=min(max(1.0, sphere.radius * RING_WIDTH), WIDEST_RING),
                origin=(x, y),
            )
            with self._using(target, moderngl.NOTHING):
                viewport, target.viewport = target.viewport, (x, y, wide, high)
                tones.use(SAMPLERS["signed_tones"])
                self.resolve_program.draw()
                target.viewport = viewport
        finally:
            self.spare.append(made)

    def release(self) -> None:
        """Free everything this object made."""
        made = [self.__dict__.pop(name) for name in ("program", "resolve_program") if name in self.__dict__]
        for resource in (*chain(*self.spare), self.triangles, *made):
            resource.release()
        self.spare.clear()

    @contextmanager
    def _using(self, framebuffer: moderngl.Framebuffer, enabled: int) -> Iterator[None]:
        """Draw into `framebuffer` with the flags `enabled`; afterwards everything is bound and enabled as before."""
        scope = self.context.scope(framebuffer, enabled)
        try:
            with scope:
                yield
        finally:
            scope.release()

    def _make_tile(self) -> tuple[moderngl.Framebuffer, moderngl.Texture, moderngl.Renderbuffer]:
        size = (TILE * OVERSAMPLING, TILE * OVERSAMPLING)
        tones = self.context.texture(size, 1, dtype="f2")
        tones.filter = moderngl.NEAREST, moderngl.NEAREST
        depth = self.context.depth_renderbuffer(size)
        return self.context.framebuffer([tones], depth), tones, depth


def tiles(sphere: Sphere, height: int) -> list[Pixels]:
    """Boxes of at most TILE pixels that cover what is seen of a sphere, in a frame so many pixels high."""
    reach, clip = sphere.radius + 1, sphere.clip
    left, right = floor(max(sphere.x - reach, clip.left)), ceil(min(sphere.x + reach, clip.right))
    top, bottom = max(sphere.y - reach, clip.top), min(sphere.y + reach, clip.bottom)
    low, high = floor(height - bottom), ceil(height - top)
    return [
        (x, y, min(TILE, right - x), min(TILE, high - y))
        for y in range(low, high, TILE)
        for x in range(left, right, TILE)
    ]
