"""What OpenGL holds of a picture: maps as textures, coefficients and lobes in buffers. What did not change stays."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.lat_long import LatLongMap
from shviewer.viewer.colour import colour_maps
from shviewer.viewer.drawn import DirectSum, SplineMap
from shviewer.viewer.gl.carrier import Carrier
from shviewer.viewer.gl.programs import BLOCKS, SAMPLERS
from shviewer.viewer.gl.shared import LOBE_SLOTS, SH_TERMS, pack_coefficients, pack_lobes
from shviewer.viewer.gl.textures import ArrayTexture, large
from shviewer.viewer.picture import Picture

VEC4 = 16
"""Bytes of a vec4."""


class Held:
    """One context's buffers and textures of lights and reconstructions. release() at the end."""

    def __init__(
        self, context: moderngl.Context, carrier: Carrier | None = None, texture: type[ArrayTexture] = ArrayTexture
    ) -> None:
        """carrier: makes the textures of large maps, so that drawing does not wait for them. texture: the kind of all."""
        self.sh_buffer, self.beside_buffer = (context.buffer(reserve=SH_TERMS * VEC4) for _ in range(2))
        self.lobe_buffer = context.buffer(reserve=LOBE_SLOTS * 3 * VEC4)
        self.original_map, self.compared_map = (texture(context, carrier) for _ in range(2))
        self.reconstruction_map, self.beside_map, self.colour_map = (texture(context) for _ in range(3))
        self.pinned: Picture | None = None
        """A picture that is drawn a part at a time, whose maps stay: no other ones come meanwhile."""
        self._colours: dict[str, NDArray[np.float32]] = {}
        self._coefficients: dict[moderngl.Buffer, Array] = {}
        self._lobes: tuple[Lobe, ...] | None = None

    @property
    def uploading(self) -> float | None:
        """How much there is of a map that is on its way; None while none is."""
        shares = (texture.share for texture in (self.original_map, self.compared_map))
        return next((share for share in shares if share is not None), None)

    def show(self, picture: Picture, seconds: float | None = None) -> bool:
        """Upload what is not there, for about so many seconds; return whether all is. Until then what was there stays."""
        wanted = _maps(picture)
        if self.pinned is not None and _maps(self.pinned) != wanted:
            return False
        maps = list(zip((self.original_map, self.compared_map), wanted, strict=True))
        if not all(texture.bring(_texels(map_), seconds, _halves(map_)) for texture, map_ in maps):
            return False
        for texture, map_ in maps:
            texture.follow(_texels(map_), _halves(map_))
        lobes = *picture.original.lobes, *picture.compared.lobes, *picture.suns
        if lobes != self._lobes:
            self.lobe_buffer.write(pack_lobes(lobes))
            self._lobes = lobes
        beside = picture.beside.drawn if picture.beside is not None else None
        for drawn, buffer, spline_map in (
            (picture.drawn, self.sh_buffer, self.reconstruction_map),
            (beside, self.beside_buffer, self.beside_map),
        ):
            if isinstance(drawn, DirectSum) and self._coefficients.get(buffer) is not drawn.coefficients:
                buffer.write(pack_coefficients(drawn.coefficients))
                self._coefficients[buffer] = drawn.coefficients
            if self.pinned is None or isinstance(
                drawn, SplineMap
            ):  # two pictures take turns: neither takes the other's
                spline_map.follow(drawn.splines if isinstance(drawn, SplineMap) else None)
        if picture.error_scale is not None:
            self.colour_map.follow(self._colour_row(colour_maps.map_of(picture.error_scale.kind)))
        return True

    def bind(self, picture: Picture, shown: str, *, beside: bool) -> None:
        """Bind what a pane needs. beside: whether the second reconstruction is in it."""
        (self.beside_buffer if beside else self.sh_buffer).bind_to_uniform_block(BLOCKS["ShBlock"])
        (self.beside_map if beside else self.reconstruction_map).use(SAMPLERS["reconstruction_map"])
        self.lobe_buffer.bind_to_uniform_block(BLOCKS["LobeBlock"])
        self.colour_map.use(SAMPLERS["colour_map"])
        apart = shown == "ERROR" and picture.compared.map is not picture.original.map
        (self.compared_map if apart else self.original_map).use(SAMPLERS["original_map"])

    def release(self) -> None:
        """Free everything this object made."""
        for buffer in (self.sh_buffer, self.beside_buffer, self.lobe_buffer):
            buffer.release()
        textures = self.original_map, self.compared_map, self.reconstruction_map, self.beside_map, self.colour_map
        for texture in textures:
            texture.release()

    def _colour_row(self, name: str) -> NDArray[np.float32]:
        """A colour map as a texture: one row of linear RGB."""
        if name not in self._colours:
            self._colours[name] = colour_maps.linear(colour_maps.table(name))[None].astype(np.float32)
        return self._colours[name]


def _maps(picture: Picture) -> tuple[LatLongMap | None, LatLongMap | None]:
    """The map of the original, and that which the error compares with where it is another one."""
    original = picture.original.map
    compared = picture.compared.map if picture.error_scale is not None else None
    return original, None if compared is original else compared


def kind_of(shown: LatLongMap | None) -> tuple[int, ...]:
    """All that a compiler of shaders may know of the texture of a map."""
    if shown is None:
        return ()
    height, width, components = shown.texels.shape
    powers = (side & (side - 1) == 0 for side in (height, width))
    return components, shown.halves, large(shown.texels), *powers


def _texels(shown: LatLongMap | None) -> NDArray[np.float32] | None:
    return None if shown is None else shown.texels


def _halves(shown: LatLongMap | None) -> bool:
    """Whether half floats hold the texels."""
    return shown is not None and shown.halves
