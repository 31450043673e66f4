"""Draws a Picture into any framebuffer. Knows OpenGL; knows no light, no key and no file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.zonal import Disc
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.lobe import Lobe
from shviewer.viewer.colour import colour_maps
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Pane, Sphere
from shviewer.viewer.drawn import DirectSum, Drawn, Encoded, SplineMap, Surfaces
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.layer_renderer import LayerRenderer
from shviewer.viewer.gl.programs import BLOCKS, SAMPLERS, Program
from shviewer.viewer.gl.shared import (
    BACKGROUND,
    CHOICES,
    FLOATS,
    LOBE_SLOTS,
    SH_TERMS,
    pack_coefficients,
    pack_lobes,
    profile_bits,
)
from shviewer.viewer.gl.surface_renderer import SurfaceRenderer
from shviewer.viewer.gl.textures import ArrayTexture
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.picture import Picture
from shviewer.viewer.view import ERRORS

GL_VERSIONS = (450, 410, 330)
"""Versions of OpenGL in the order in which they are asked for; every shader is written for the last."""

MOST_SAMPLES = 6
"""The most looks at a map along a side of a pixel."""

LEAST_HATCHED = 3
"""How many lines beyond white are the fewest that a sun has room for, if it has any."""

VEC4 = 16
"""Bytes of a vec4."""


class Renderer:
    """One context's programs, buffers and textures. `show` uploads what changed, `draw` draws it; release() at the end."""

    def __init__(self, context: moderngl.Context, carrier: Carrier | None = None) -> None:
        """carrier: makes the textures of large maps, so that drawing does not wait for them."""
        self.context = context
        self.carrier = carrier
        self.programs: dict[tuple[str | int, ...], Program] = {}
        """Programs of sphere.frag, by the choices they were made for."""
        self.layers = LayerRenderer(context)
        self.surfaces: SurfaceRenderer | None = None
        """Made when the first surface is drawn."""
        self.sh_buffer, self.beside_buffer = (context.buffer(reserve=SH_TERMS * VEC4) for _ in range(2))
        self.lobe_buffer = context.buffer(reserve=LOBE_SLOTS * 3 * VEC4)
        self.original_map, self.compared_map = (ArrayTexture(context, carrier) for _ in range(2))
        self.reconstruction_map, self.beside_map, self.colour_map = (ArrayTexture(context) for _ in range(3))
        self.colours: dict[str, NDArray[np.float32]] = {}
        self.picture: Picture | None = None
        self.coefficients: Array | None = None
        self.beside_coefficients: Array | None = None
        """Those of the second reconstruction, which are in its buffer."""
        self.lobes: tuple[Lobe, ...] | None = None
        """The lobes that are in their buffer."""
        self.rest = context.simple_framebuffer((1, 1))
        """Bound while no other framebuffer is in use."""

    @property
    def version(self) -> str:
        """OpenGL's version and the name of the graphics processor, as the driver gives them."""
        code = self.context.version_code
        return f"OpenGL {code // 100}.{code % 100 // 10}, {self.context.info['GL_RENDERER']}"

    @property
    def uploading(self) -> float | None:
        """How much there is of a map that is on its way; None while none is."""
        shares = (texture.share for texture in (self.original_map, self.compared_map))
        return next((share for share in shares if share is not None), None)

    def show(self, picture: Picture, seconds: float | None = None) -> bool:
        """Upload what differs from the last picture; return whether it is all there.

        seconds: about how long to upload maps. Until they are there, the last picture stays.
        """
        original = picture.original.map
        compared = picture.compared.map if picture.error_scale is not None else None
        maps = [(self.original_map, *_held(original))]
        maps.append((self.compared_map, *_held(None if compared is original else compared)))
        if not all(texture.bring(texels, seconds, halves) for texture, texels, halves in maps):
            return False
        lobes = *picture.original.lobes, *picture.compared.lobes, *picture.suns
        if lobes != self.lobes:
            self.lobe_buffer.write(pack_lobes(lobes))
            self.lobes = lobes
        for texture, texels, halves in maps:
            texture.follow(texels, halves)
        self._show_reconstruction(picture.drawn)
        beside = picture.beside.drawn if picture.beside is not None else None
        if isinstance(beside, DirectSum) and beside.coefficients is not self.beside_coefficients:
            self.beside_buffer.write(pack_coefficients(beside.coefficients))
            self.beside_coefficients = beside.coefficients
        self.beside_map.follow(beside.splines if isinstance(beside, SplineMap) else None)
        if picture.error_scale is not None:
            self.colour_map.follow(self._colours(colour_maps.map_of(picture.error_scale.kind)))
        self.picture = picture
        return True

    def _show_reconstruction(self, drawn: Drawn) -> None:
        """Upload coefficients or map. Coefficients stay in their buffer while something else is drawn; a map goes."""
        if isinstance(drawn, DirectSum) and drawn.coefficients is not self.coefficients:
            self.sh_buffer.write(pack_coefficients(drawn.coefficients))
            self.coefficients = drawn.coefficients
        self.reconstruction_map.follow(drawn.splines if isinstance(drawn, SplineMap) else None)

    def draw(
        self,
        target: moderngl.Framebuffer,
        composition: Composition,
        layers: Sequence[Layer] = (),
        *,
        linear: bool = False,
    ) -> None:
        """Draw the picture last shown, and layers over it. linear: the radiance alone; ValueError for surfaces."""
        picture = self.picture
        if picture is None:
            raise ValueError("nothing to draw: show a picture first")
        if linear and isinstance(picture.drawn, Surfaces):
            raise ValueError("surfaces hold no radiance")
        self._clear(target, composition, (0.0, 0.0, 0.0, 0.0) if linear else _GROUND)
        if isinstance(picture.drawn, Surfaces):
            self._draw_surfaces(target, composition, picture.drawn, picture.light_from_world @ picture.world_from_view)
        else:
            self._draw_panes(target, composition, picture, linear)
        target.viewport = (0, 0, composition.width, composition.height)
        if not linear:
            self.layers.draw(target, composition, layers)
        if self.carrier is not None:
            self.carrier.drawn()

    def draw_text(self, target: moderngl.Framebuffer, composition: Composition, layers: Sequence[Layer]) -> None:
        """Draw layers over the background alone, as long as there is no picture."""
        self._clear(target, composition, _GROUND)
        self.layers.draw(target, composition, layers)

    def release(self) -> None:
        """Free everything this object made."""
        resources: tuple[Program | SurfaceRenderer | LayerRenderer | moderngl.Buffer | ArrayTexture, ...] = (
            *self.programs.values(),
            *((self.surfaces,) if self.surfaces else ()),
            self.layers,
            self.sh_buffer,
            self.beside_buffer,
            self.lobe_buffer,
            self.original_map,
            self.compared_map,
            self.reconstruction_map,
            self.beside_map,
            self.colour_map,
        )
        for resource in resources:
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

    def _draw_surfaces(
        self, target: moderngl.Framebuffer, composition: Composition, drawn: Surfaces, light_from_view: Array
    ) -> None:
        if self.surfaces is None:
            self.surfaces = SurfaceRenderer(self.context)
        for sphere, surface in zip(composition.spheres, drawn.shown, strict=False):
            self.surfaces.draw(target, sphere, composition.height, surface, light_from_view)

    def _draw_panes(
        self, target: moderngl.Framebuffer, composition: Composition, picture: Picture, linear: bool
    ) -> None:
        self.sh_buffer.bind_to_uniform_block(BLOCKS["ShBlock"])
        self.lobe_buffer.bind_to_uniform_block(BLOCKS["LobeBlock"])
        self.reconstruction_map.use(SAMPLERS["reconstruction_map"])
        self.colour_map.use(SAMPLERS["colour_map"])
        for shown, pane in zip(CHOICES["SHOWN"], composition.panes, strict=False):
            if shown == "ERROR" and picture.beside is not None:
                self.beside_buffer.bind_to_uniform_block(BLOCKS["ShBlock"])
                self.beside_map.use(SAMPLERS["reconstruction_map"])
                second = replace(picture, coefficients=picture.beside.coefficients, drawn=picture.beside.drawn)
                self._draw_pane(target, composition, second, "RECONSTRUCTION", pane, linear)
            elif shown != "ERROR" or picture.error_scale is not None:
                self._draw_pane(target, composition, picture, shown, pane, linear)

    def _draw_pane(
        self,
        target: moderngl.Framebuffer,
        composition: Composition,
        picture: Picture,
        shown: str,
        pane: Pane,
        linear: bool,
    ) -> None:
        box = _pixel_box(pane, composition.height)
        if box[2] <= 0 or box[3] <= 0:
            return
        ends = np.cumsum([0, len(picture.original.lobes), len(picture.compared.lobes), len(picture.suns)]).tolist()
        source, lobes, suns = picture.original, tuple(ends[0:2]), tuple(ends[2:4])
        map_texture = self.original_map
        if shown == "ERROR":  # the error of what is left without the suns, if there are any
            source, lobes, suns = picture.compared, tuple(ends[1:3]), (0, 0)
            map_texture = self.original_map if source.map is picture.original.map else self.compared_map
        map_texture.use(SAMPLERS["original_map"])
        program = self._program(picture, shown, pane, 1 if linear else _samples(source.map, pane))
        light_from_pane = picture.light_from_world
        if isinstance(pane, Sphere):
            light_from_pane = light_from_pane @ picture.world_from_view
            program.set(radius=pane.radius)
        else:
            program.set(turn=pane.width)
        program.set(
            centre=(pane.x, composition.height - pane.y),
            light_from_pane=tuple(light_from_pane.T.ravel()),
            linear_output=linear,
            soft_edges=not linear,
            exposure=2.0**picture.exposure_stops,
            scale=max(composition.scale, 1.0),
            lines=float(picture.state.view.marks),
            n_bands=count_bands(picture.coefficients),
            original_lobes=lobes,
            sun_lobes=suns,
            wide_suns=shown != "RECONSTRUCTION" or _wide(picture.suns, pane, max(composition.scale, 1.0)),
            original_rows_on_poles=source.map is not None and source.map.rows_on_poles,
        )
        if isinstance(picture.drawn, Encoded):
            program.set(stored=[tuple(row) for row in picture.drawn.stored.numbers.tolist()])
        scale = picture.error_scale
        if scale is not None:
            program.set(error_kind=ERRORS.index(scale.kind) - 1, error_range=scale.end, error_floor=scale.floor)
        target.viewport = box
        program.draw()

    def _program(self, picture: Picture, shown: str, pane: Pane, samples: int = 1) -> Program:
        """The program that draws `shown`, compiled when first wanted. Choices that it does not read make no new one."""
        original = "LOBES" if picture.original.map is None or shown == "RECONSTRUCTION" else "MAP"
        reconstruction = _reconstruction(picture.drawn) if shown != "ORIGINAL" else "SUM"
        tone = "NONE" if shown == "ERROR" else picture.state.view.tone.upper()
        form = "SPHERE" if isinstance(pane, Sphere) else "MAP"
        lobes = {
            "ORIGINAL": picture.original.lobes,
            "RECONSTRUCTION": picture.suns,
            "ERROR": picture.compared.lobes,
        }[shown]
        samples = samples if original == "MAP" else 1
        key: tuple[str | int, ...] = (shown, original, reconstruction, tone, form, profile_bits(lobes), samples)
        if key not in self.programs:
            chosen: dict[str, str | int] = dict(zip((*CHOICES, "PROFILES", "SAMPLES"), key, strict=True))
            self.programs[key] = Program(self.context, "sphere.frag", chosen)
        return self.programs[key]

    def _colours(self, name: str) -> NDArray[np.float32]:
        """A colour map as a texture: one row of linear RGB."""
        if name not in self.colours:
            self.colours[name] = colour_maps.linear(colour_maps.table(name))[None].astype(np.float32)
        return self.colours[name]


def _wide(suns: Sequence[Lobe], pane: Pane, scale: float) -> bool:
    """Whether every sun is a few lines beyond white wide; a smaller one would have a stroke like a fault on it."""
    per_radian = pane.radius if isinstance(pane, Sphere) else pane.width / (2 * np.pi)
    widths = [2 * sun.profile.half_angle * per_radian for sun in suns if isinstance(sun.profile, Disc)]
    return all(width >= LEAST_HATCHED * FLOATS["BEYOND_PITCH"] * scale for width in widths)


def _held(shown: LatLongMap | None) -> tuple[NDArray[np.float32] | None, bool]:
    """The texels of a map, and whether half floats hold them."""
    return (None, False) if shown is None else (shown.texels, shown.halves)


def _reconstruction(drawn: Drawn) -> str:
    """The choice of a program that draws the reconstruction in that way."""
    match drawn:
        case Encoded(stored):
            return stored.encoding.formula.upper()
        case SplineMap():
            return "MAP"
        case _:
            return "SUM"


def _samples(original: LatLongMap | None, pane: Pane) -> int:
    """How many times along a side of a pixel a map is looked up: once for each of its texels, within MOST_SAMPLES."""
    if original is None:
        return 1
    turn = 2 * np.pi * pane.radius if isinstance(pane, Sphere) else pane.width
    return int(min(max(np.ceil(original.texels.shape[1] / turn), 1), MOST_SAMPLES))


def _pixel_box(pane: Pane, height: int) -> tuple[int, int, int, int]:
    """The viewport (x, y from the bottom, width, height) of what is seen of a pane."""
    left, top, right, bottom = pane.outline
    x, y = int(np.floor(left)), int(np.floor(height - bottom))
    return x, y, int(np.ceil(right)) - x, int(np.ceil(height - top)) - y


def _encode(colour: tuple[float, float, float]) -> tuple[float, float, float]:
    """sRGB of a linear colour, as in shaders/display.glsl."""
    red, green, blue = (12.92 * c if c < 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in colour)
    return red, green, blue


_GROUND = (*_encode(BACKGROUND), 1.0)
"""The background as it is written into a framebuffer."""
