"""Draws a Picture into any framebuffer. Knows OpenGL; knows no light, no key and no file."""

from __future__ import annotations

import re
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.errors import GraphicsError, ShaderError
from shviewer.harmonics.basis import Array, count_bands
from shviewer.lights.lat_long import LatLongMap
from shviewer.resources import ShaderSource, load_shader
from shviewer.viewer.composition import Composition, Sphere
from shviewer.viewer.layout import (
    BACKGROUND,
    SOURCE_HARMONICS,
    SOURCE_LOBES,
    SOURCE_MAP,
    SOURCE_SMOOTH_MAP,
    glsl_constants,
    pack_coefficients,
    pack_lobes,
)
from shviewer.viewer.picture import Picture

GL_VERSIONS = (450, 410, 330)
"""Asked for in this order; every shader is written for the last."""

SH_BINDING, LOBE_BINDING = 0, 1


class Renderer:
    """One context's programs, buffers and textures. `show` uploads what changed, `draw` draws it; release() at the end."""

    def __init__(self, context: moderngl.Context) -> None:
        self.context = context
        self.sphere_program = _compile(context, "screen.vert", "sphere.frag")
        self.overlay_program = _compile(context, "screen.vert", "overlay.frag")
        self.sphere_quad = context.vertex_array(self.sphere_program, [])
        self.overlay_quad = context.vertex_array(self.overlay_program, [])
        self.sh_buffer = _block_buffer(self.sphere_program, "ShBlock", SH_BINDING)
        self.lobe_buffers = [_block_buffer(self.sphere_program, "LobeBlock", LOBE_BINDING) for _ in range(2)]
        """Of the original, and of what is added to the reconstruction."""
        self.textures: dict[int, tuple[LatLongMap, moderngl.Texture]] = {}
        self.no_map = context.texture((1, 1), 4, dtype="f4")
        self.overlay: moderngl.Texture | None = None
        self.overlay_image: NDArray[np.uint8] | None = None
        self.picture: Picture | None = None
        self.coefficients: Array | None = None
        """Those in the buffer."""
        self.rest = context.simple_framebuffer((1, 1))
        """Bound while no other framebuffer is in use."""

    @property
    def version(self) -> str:
        """Version and renderer as the driver names them."""
        code = self.context.version_code
        return f"OpenGL {code // 100}.{code % 100 // 10}, {self.context.info['GL_RENDERER']}"

    def show(self, picture: Picture, overlay: NDArray[np.uint8] | None = None) -> None:
        """Upload what differs from the last picture. overlay: (height, width, 4) RGBA, or None for none."""
        last = self.picture
        for side, lobes in enumerate((picture.lobes, picture.added_lobes)):
            if last is None or lobes is not (last.lobes, last.added_lobes)[side]:
                self.lobe_buffers[side].write(pack_lobes(lobes))
        if picture.reconstruction_map is None and picture.coefficients is not self.coefficients:
            self.sh_buffer.write(pack_coefficients(picture.coefficients))
            self.coefficients = picture.coefficients
        for side, wanted in enumerate((picture.original_map, picture.reconstruction_map)):
            self._upload_map(side, wanted)
        self._upload_overlay(overlay)
        self.picture = picture

    def draw(self, target: moderngl.Framebuffer, composition: Composition, *, linear: bool = False) -> None:
        """Both spheres and the overlay, or with `linear` their radiance alone, of the picture last shown."""
        picture = self.picture
        if picture is None:
            raise ValueError("nothing to draw: show a picture first")
        target.use()
        target.viewport = (0, 0, composition.width, composition.height)
        self.context.disable(moderngl.BLEND)
        target.clear(color=(0.0, 0.0, 0.0, 0.0) if linear else (*_encode(BACKGROUND), 1.0))
        program = self.sphere_program
        _uniform(program, "light_from_view").write(
            (picture.light_from_world @ picture.world_from_view).T.astype("f4").tobytes()
        )
        _set(program, "linear_output", linear)
        _set(program, "soft_edges", not linear)
        _set(program, "exposure", 2.0**picture.exposure_stops)
        _set(program, "n_bands", count_bands(picture.coefficients))
        self.sh_buffer.bind_to_uniform_block(SH_BINDING)
        original = SOURCE_LOBES if picture.original_map is None else SOURCE_MAP
        reconstruction = SOURCE_HARMONICS if picture.reconstruction_map is None else SOURCE_SMOOTH_MAP
        for side, source in enumerate((original, reconstruction)):
            self.lobe_buffers[side].bind_to_uniform_block(LOBE_BINDING)
            _set(program, "n_lobes", len((picture.lobes, picture.added_lobes)[side]))
            self._draw_sphere(target, composition, side, source)
        target.viewport = (0, 0, composition.width, composition.height)
        if not linear and self.overlay is not None:
            self.context.enable(moderngl.BLEND)
            self.context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
            self.overlay.use(0)
            self.overlay_quad.render(moderngl.TRIANGLES, vertices=3)
            self.context.disable(moderngl.BLEND)

    def release(self) -> None:
        """Free everything this object made."""
        for _, texture in self.textures.values():
            texture.release()
        for resource in (
            self.overlay,
            self.no_map,
            self.sh_buffer,
            *self.lobe_buffers,
            self.sphere_quad,
            self.overlay_quad,
        ):
            if resource is not None:
                resource.release()
        for attachment in (*self.rest.color_attachments, self.rest.depth_attachment):
            if attachment is not None:
                attachment.release()
        self.rest.release()
        self.sphere_program.release()
        self.overlay_program.release()

    def _draw_sphere(self, target: moderngl.Framebuffer, composition: Composition, side: int, source: int) -> None:
        sphere = composition.spheres[side]
        box = _pixel_box(sphere, composition.height)
        if box[2] <= 0 or box[3] <= 0:
            return
        held = self.textures.get(side)
        texture = self.no_map if held is None else held[1]
        texture.use(0)
        if held is not None:
            _set(self.sphere_program, "row_scale_offset", held[0].row_scale_offset)
            _set(self.sphere_program, "rows_on_poles", held[0].rows_on_poles)
        _set(self.sphere_program, "centre", (sphere.x, composition.height - sphere.y))
        _set(self.sphere_program, "radius", sphere.radius)
        _set(self.sphere_program, "source", source)
        target.viewport = box
        self.sphere_quad.render(moderngl.TRIANGLES, vertices=3)

    def _upload_map(self, side: int, wanted: LatLongMap | None) -> None:
        held = self.textures.get(side)
        if held is not None and held[0] is wanted:
            return
        limit = self.context.info["GL_MAX_TEXTURE_SIZE"]
        if wanted is not None and max(wanted.texels.shape) > limit:
            height, width = wanted.texels.shape[:2]
            raise GraphicsError(f"a map of {width} x {height} texels: this OpenGL takes at most {limit} a side")
        if held is not None:
            held[1].release()
            del self.textures[side]
        if wanted is not None:
            height, width = wanted.texels.shape[:2]
            texels = np.ones((height, width, 4), dtype=np.float32)
            texels[..., :3] = wanted.texels
            self.textures[side] = (wanted, self.context.texture((width, height), 4, texels, dtype="f4"))

    def _upload_overlay(self, image: NDArray[np.uint8] | None) -> None:
        if image is self.overlay_image:
            return
        if self.overlay is not None and (image is None or self.overlay.size != image.shape[1::-1]):
            self.overlay.release()
            self.overlay = None
        if image is not None:
            if self.overlay is None:
                self.overlay = self.context.texture((image.shape[1], image.shape[0]), 4)
            self.overlay.write(np.ascontiguousarray(image))
        self.overlay_image = image


def _pixel_box(sphere: Sphere, height: int) -> tuple[int, int, int, int]:
    """The viewport (x, y from the bottom, width, height) of a sphere with its soft edge, cut to its clip."""
    reach = sphere.radius + 1
    left, right = max(sphere.x - reach, sphere.clip.left), min(sphere.x + reach, sphere.clip.right)
    top, bottom = max(sphere.y - reach, sphere.clip.top), min(sphere.y + reach, sphere.clip.bottom)
    x, y = int(np.floor(left)), int(np.floor(height - bottom))
    return x, y, int(np.ceil(right)) - x, int(np.ceil(height - top)) - y


def _uniform(program: moderngl.Program, name: str) -> moderngl.Uniform:
    member = program[name]
    assert isinstance(member, moderngl.Uniform)
    return member


def _set(program: moderngl.Program, name: str, value: Any) -> None:
    _uniform(program, name).value = value


def _block_buffer(program: moderngl.Program, name: str, binding: int) -> moderngl.Buffer:
    """A buffer of the size of a uniform block, which is tied to `binding`."""
    block = program[name]
    assert isinstance(block, moderngl.UniformBlock)
    block.binding = binding
    return program.ctx.buffer(reserve=block.size)


def _encode(colour: tuple[float, float, float]) -> tuple[float, float, float]:
    """sRGB of a linear colour, as in shaders/display.glsl."""
    red, green, blue = (12.92 * c if c < 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in colour)
    return red, green, blue


def _compile(context: moderngl.Context, vertex: str, fragment: str) -> moderngl.Program:
    generated = {"constants.glsl": glsl_constants()}
    sources = {"vertex": load_shader(vertex, generated), "fragment": load_shader(fragment, generated)}
    try:
        return context.program(vertex_shader=sources["vertex"].text, fragment_shader=sources["fragment"].text)
    except moderngl.Error as error:
        raise ShaderError(_explain(str(error), sources, f"shaders/{vertex} + shaders/{fragment}")) from error


def _explain(report: str, sources: dict[str, ShaderSource], pair: str) -> str:
    """moderngl's report names the stage in a heading ("fragment_shader"); a link error has none."""
    stage = re.search(r"(vertex|fragment)_shader\s*=*\s*", report)
    if stage is None:
        return f"{pair} do not link: {' '.join(report.split())}"
    return f"shader does not compile: {sources[stage[1]].explain(report[stage.end() :])}"
