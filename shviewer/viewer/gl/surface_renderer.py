"""Draws surfaces of the lobe view into any framebuffer: triangles go into a finer tile, which is averaged in linear light."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from math import ceil, floor, log2

import moderngl

from shviewer.harmonics.basis import Array
from shviewer.viewer.composing.panes import Sphere
from shviewer.viewer.gl.programs import SAMPLERS, Program
from shviewer.viewer.gl.surface_mesh import surface_mesh
from shviewer.viewer.surface import Surface

OVERSAMPLING = 3
"""Samples along a side of a pixel."""

TILE = 512
"""Pixels along a side of the tile drawn at a time: large frames take time, not memory."""

TOLERANCE_PIXELS = 0.25
"""How far a surface may be from its triangles; between half of this and all of it is used."""

RING_WIDTH, WIDEST_RING = 1 / 200, 2.0
"""The line of the circle of radius 1: its width in radii (but at least a pixel), and its largest width in pixels."""

MOST_SURFACES = 4
"""How many surfaces are kept on the GPU: one for each sphere of a frame, and one to come back to."""


@dataclass(frozen=True)
class _Drawable:
    """A surface's triangles on the GPU."""

    vertices: moderngl.Buffer
    triangles: moderngl.Buffer
    array: moderngl.VertexArray

    def release(self) -> None:
        self.array.release()
        self.triangles.release()
        self.vertices.release()


class SurfaceRenderer:
    """One context's programs, tile and the surfaces drawn last. release() at the end."""

    def __init__(self, context: moderngl.Context) -> None:
        self.context = context
        self.program = Program(context, "surface.frag", vertex="surface.vert")
        self.resolve_program = Program(context, "surface_resolve.frag", {"TONE": "NONE"})
        self.tile: tuple[moderngl.Framebuffer, moderngl.Texture, moderngl.Renderbuffer] | None = None
        self.held: OrderedDict[tuple[Surface, int], _Drawable] = OrderedDict()
        """Surface and fineness -> triangles, those used longest ago first."""

    def draw(
        self,
        target: moderngl.Framebuffer,
        sphere: Sphere,
        height: int,
        surface: Surface,
        light_from_view: Array,
    ) -> None:
        """Draw the surface in place of a sphere, over BACKGROUND; pixels that it does not touch are left alone.

        target: RGBA8, sRGB, `height` pixels high; sphere: its centre, the length of radius 1 in pixels, and where it is cut.
        light_from_view: 3 x 3, as for the spheres. What is bound, enabled and in view is left as found.
        """
        drawable = self._drawable(surface, sphere.radius)
        fine, tones, _ = self.tile = self.tile or self._make_tile()
        viewport = target.viewport
        self.program.set(
            radius=sphere.radius * OVERSAMPLING,
            tile=(TILE * OVERSAMPLING, TILE * OVERSAMPLING),
            view_from_light=tuple(light_from_view.ravel()),  # transposed: by columns
        )
        self.resolve_program.set(
            oversampling=OVERSAMPLING,
            centre=(sphere.x, height - sphere.y),
            radius=sphere.radius,
            ring_width=min(max(1.0, sphere.radius * RING_WIDTH), WIDEST_RING),
        )
        for x, y, wide, high in _tiles(sphere, height):
            centre = ((sphere.x - x) * OVERSAMPLING, (height - sphere.y - y) * OVERSAMPLING)
            self.program.set(centre=centre)
            self.resolve_program.set(origin=(x, y))
            with self._using(fine, moderngl.DEPTH_TEST | moderngl.CULL_FACE):
                fine.viewport = (0, 0, TILE * OVERSAMPLING, TILE * OVERSAMPLING)
                fine.clear(viewport=(0, 0, wide * OVERSAMPLING, high * OVERSAMPLING))
                drawable.array.render(moderngl.TRIANGLES)
            with self._using(target, moderngl.NOTHING):
                target.viewport = (x, y, wide, high)
                tones.use(SAMPLERS["signed_tones"])
                self.resolve_program.draw()
                target.viewport = viewport

    def release(self) -> None:
        """Free everything this object made."""
        for drawable in self.held.values():
            drawable.release()
        self.held.clear()
        for resource in (*(self.tile or ()), self.program, self.resolve_program):
            resource.release()
        self.tile = None

    @contextmanager
    def _using(self, framebuffer: moderngl.Framebuffer, enabled: int) -> Iterator[None]:
        """Draw into `framebuffer` with the flags `enabled`; afterwards everything is bound and enabled as before."""
        scope = self.context.scope(framebuffer, enabled)
        try:
            with scope:
                yield
        finally:
            scope.release()

    def _drawable(self, surface: Surface, radius: float) -> _Drawable:
        """The surface's triangles, held or made now; fineness goes in steps of 2, so that zooming rarely makes new ones."""
        fineness = ceil(log2(max(radius, 1.0) / TOLERANCE_PIXELS))
        key = surface, fineness
        if key not in self.held:
            while len(self.held) >= MOST_SURFACES:
                self.held.popitem(last=False)[1].release()
            mesh = surface_mesh(surface.values, 2.0**-fineness)
            vertices = self.context.buffer(mesh.vertices)
            triangles = self.context.buffer(mesh.triangles)
            content = [(vertices, "1f 3f 3f", "value", "direction", "normal")]
            array = self.context.vertex_array(self.program.program, content, index_buffer=triangles)
            self.held[key] = _Drawable(vertices, triangles, array)
        self.held.move_to_end(key)
        return self.held[key]

    def _make_tile(self) -> tuple[moderngl.Framebuffer, moderngl.Texture, moderngl.Renderbuffer]:
        size = (TILE * OVERSAMPLING, TILE * OVERSAMPLING)
        tones = self.context.texture(size, 1, dtype="f2")
        tones.filter = moderngl.NEAREST, moderngl.NEAREST
        depth = self.context.depth_renderbuffer(size)
        return self.context.framebuffer([tones], depth), tones, depth


def _tiles(sphere: Sphere, height: int) -> Iterator[tuple[int, int, int, int]]:
    """Boxes (x, y from the bottom, width, height) of at most TILE pixels that cover what is seen of a sphere."""
    reach, clip = sphere.radius + 1, sphere.clip
    left, right = floor(max(sphere.x - reach, clip.left)), ceil(min(sphere.x + reach, clip.right))
    top, bottom = max(sphere.y - reach, clip.top), min(sphere.y + reach, clip.bottom)
    low, high = floor(height - bottom), ceil(height - top)
    for y in range(low, high, TILE):
        for x in range(left, right, TILE):
            yield x, y, min(TILE, right - x), min(TILE, high - y)
