"""The triangles of surfaces in OpenGL; where frames must not wait for them, another thread makes them."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import ceil, log2
from threading import Thread

import moderngl

from shviewer.viewer.composing.panes import Sphere
from shviewer.viewer.gl.programs import Program
from shviewer.viewer.gl.surface_mesh import Mesh, surface_mesh
from shviewer.viewer.surface import Surface

TOLERANCE_PIXELS = 0.25
"""How far a surface may be from its triangles; between half of this and all of it is used."""

MOST_SURFACES = 4
"""How many surfaces are kept: one for each sphere of a frame, and one to come back to."""

Key = tuple[Surface, int]
"""A surface and its fineness, which goes in steps of 2, so that zooming rarely makes new triangles."""


@dataclass(frozen=True)
class _Held:
    """A surface's triangles in OpenGL."""

    vertices: moderngl.Buffer
    triangles: moderngl.Buffer
    array: moderngl.VertexArray

    def release(self) -> None:
        self.array.release()
        self.triangles.release()
        self.vertices.release()


class Triangles:
    """Those drawn last in one context. release() at the end."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self.held: OrderedDict[Key, _Held] = OrderedDict()
        """Those used longest ago first."""
        self._made: dict[Key, Mesh] = {}
        self._working = False

    def bring(self, wanted: Sequence[tuple[Surface, Sphere]], arrived: Callable[[], None] | None = None) -> bool:
        """Whether the triangles of surfaces in place of spheres are there; a thread makes what is missing.

        arrived: called from that thread when it has made them.
        """
        keys = [_key(surface, sphere.radius) for surface, sphere in wanted]
        missing = [key for key in keys if key not in self.held and key not in self._made]
        if not self._working:
            self._made = {key: mesh for key, mesh in self._made.items() if key in keys}
            if missing:
                self._working = True
                Thread(target=self._make, args=(missing, arrived), name="triangles", daemon=True).start()
        return not missing

    @property
    def arrived(self) -> bool:
        """Whether there are new ones, which were not drawn yet."""
        return bool(self._made) and not self._working

    def has(self, surface: Surface) -> bool:
        """Whether there are triangles of a surface, perhaps too coarse or too fine ones."""
        return any(surface is one for one, _ in (*self.held, *self._made))

    def chosen(self, surface: Surface, radius: float) -> Key:
        """What to draw of a surface; while its triangles are made, others that there are of it."""
        key = _key(surface, radius)
        if key not in self.held and key not in self._made and self._working:
            key = next((one for one in (*self.held, *self._made) if one[0] is surface), key)
        return key

    def array(self, program: Program, key: Key) -> moderngl.VertexArray:
        """The triangles for a program; made now, if there are none."""
        if key not in self.held:
            while len(self.held) >= MOST_SURFACES:
                self.held.popitem(last=False)[1].release()
            mesh = self._made.pop(key, None) or _mesh(key)
            vertices, triangles = self._context.buffer(mesh.vertices), self._context.buffer(mesh.triangles)
            content = [(vertices, "1f 3f 3f", "value", "direction", "normal")]
            array = self._context.vertex_array(program.program, content, index_buffer=triangles)
            self.held[key] = _Held(vertices, triangles, array)
        self.held.move_to_end(key)
        return self.held[key].array

    def release(self) -> None:
        """Free everything this object made."""
        for held in self.held.values():
            held.release()
        self.held.clear()

    def _make(self, missing: Sequence[Key], arrived: Callable[[], None] | None) -> None:
        try:
            for key in missing:
                self._made[key] = _mesh(key)
        finally:
            self._working = False
        if arrived is not None:
            arrived()


def _key(surface: Surface, radius: float) -> Key:
    return surface, ceil(log2(max(radius, 1.0) / TOLERANCE_PIXELS))


def _mesh(key: Key) -> Mesh:
    surface, fineness = key
    return surface_mesh(surface.values, 2.0**-fineness)
