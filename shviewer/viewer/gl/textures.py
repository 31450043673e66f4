"""Textures that follow arrays: uploaded when the array is another one, released when it is gone."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.errors import GraphicsError


class ArrayTexture:
    """The texture of one array (height, width, components), float32 or uint8, known by its identity; or no texture.

    Three components are held as four, with 1 for the last: graphics processors read those faster.
    """

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        self._array: NDArray[np.generic] | None = None
        self._texture: moderngl.Texture | None = None

    def follow(self, array: NDArray[np.generic] | None) -> None:
        """Upload `array` unless it is the one held. GraphicsError if this OpenGL has no textures that large."""
        if array is self._array:
            return
        if array is None:
            self.release()
            return
        height, width, components = array.shape
        limit = self._context.info["GL_MAX_TEXTURE_SIZE"]
        if max(height, width) > limit:
            raise GraphicsError(f"a map of {width} x {height} texels: this OpenGL takes at most {limit} a side")
        dtype = "f4" if array.dtype == np.float32 else "f1"
        data = np.ascontiguousarray(array)
        if components == 3:
            components, data = 4, np.ones((height, width, 4), array.dtype)
            data[..., :3] = array
        held = self._texture
        if held is not None and (held.size, held.components, held.dtype) == ((width, height), components, dtype):
            held.write(data)
        else:
            self.release()
            self._texture = self._context.texture((width, height), components, data, dtype=dtype, alignment=1)
        self._array = array

    def use(self, unit: int) -> None:
        """Bind to a texture unit, if there is an array."""
        if self._texture is not None:
            self._texture.use(unit)

    def release(self) -> None:
        if self._texture is not None:
            self._texture.release()
        self._texture = self._array = None
