"""Draws layers of pixels over a frame. What did not change since the last frame is not uploaded again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.gl.programs import SAMPLERS, Program
from shviewer.viewer.gl.textures import ArrayTexture
from shviewer.viewer.overlay.layers import Layer


class LayerRenderer:
    """One context's program and the textures of the last frame. release() at the end."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._program = Program(context, "layer.frag")
        self._held: dict[int, tuple[Layer, ArrayTexture]] = {}
        """The layers of the last frame and their textures, by the identity of the image."""

    def bring(self, layers: Sequence[Layer]) -> Iterator[None]:
        """Upload layers one after the other; the texture of an image lives as long as it is in every frame."""
        wanted = {id(layer.image) for layer in layers}
        spare = [self._held.pop(key)[1] for key in list(self._held) if key not in wanted]
        try:
            for layer in layers:
                if id(layer.image) not in self._held:
                    texture = spare.pop() if spare else ArrayTexture(self._context)
                    texture.follow(_pixels(layer.image))
                    self._held[id(layer.image)] = layer, texture
                    yield
        finally:
            for texture in spare:
                texture.release()

    def draw(self, target: moderngl.Framebuffer, composition: Composition, layers: Sequence[Layer]) -> None:
        """Draw layers one over the other."""
        for _ in self.bring(layers):
            pass
        self._context.enable(moderngl.BLEND)
        self._context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        for layer in layers:
            self._held[id(layer.image)][1].use(SAMPLERS["layer"])
            height, width = layer.image.shape[:2]
            corner = layer.left, composition.height - layer.top
            self._program.set(corner=corner)
            target.viewport = (corner[0], corner[1] - height, width, height)
            self._program.draw()
        self._context.disable(moderngl.BLEND)
        target.viewport = (0, 0, composition.width, composition.height)

    def release(self) -> None:
        """Free everything this object made."""
        self._program.release()
        for _, texture in self._held.values():
            texture.release()


def _pixels(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The pixels that the shader needs: one of an image that is one pixel broadcast."""
    return image[:1, :1] if image.strides[:2] == (0, 0) else image
