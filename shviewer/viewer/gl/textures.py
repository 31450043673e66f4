"""Textures that follow arrays: uploaded when the array is another one, released when it is gone."""

from __future__ import annotations

from time import perf_counter

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.errors import GraphicsError
from shviewer.viewer.gl.carrier import Carrier, Load

BAND_BYTES = 2**23
"""What is uploaded between two looks at the clock: a few milliseconds."""


class ArrayTexture:
    """The texture of one array (height, width, components), float32 or uint8, known by its identity; or no texture.

    It has the array's components, and half floats where the caller knows that those are exact: less memory loses nothing.
    """

    def __init__(self, context: moderngl.Context, carrier: Carrier | None = None) -> None:
        """carrier: makes large textures meanwhile; without one they go up here, in bands."""
        self._context = context
        self._carrier = carrier
        self._array: NDArray[np.generic] | None = None
        self._held: Upload | Load | None = None
        self._next: Upload | Load | None = None

    def follow(self, array: NDArray[np.generic] | None, halves: bool = False) -> None:
        """Upload `array` unless it is the one held. GraphicsError if this OpenGL has no textures that large.

        halves: whether all values are exact as half floats.
        """
        self.bring(array, halves=halves)
        if array is None:
            self.release()
        elif array is not self._array and self._next is not None:
            before, self._held, self._next = self._held, self._next, None
            if before is not None and not _same(before, self._held):
                before.release()
            self._array = array

    def bring(self, array: NDArray[np.generic] | None, seconds: float | None = None, halves: bool = False) -> bool:
        """Upload `array` for at most about `seconds`, beside the one held; return whether all of it is there."""
        if self._next is not None and self._next.array is not array:
            self._drop_upload()
        if array is None or array is self._array:
            return True
        if self._next is None:
            self._next = self._begin(array, halves)
        return self._next.go_on(None if seconds is None else perf_counter() + seconds)

    @property
    def share(self) -> float | None:
        """How much there is of what is on its way; None while nothing is."""
        return None if self._next is None else self._next.share

    def _begin(self, array: NDArray[np.generic], halves: bool) -> Upload | Load:
        height, width = array.shape[:2]
        limit = self._context.info["GL_MAX_TEXTURE_SIZE"]
        if max(height, width) > limit:
            raise GraphicsError(f"a map of {width} x {height} texels: this OpenGL takes at most {limit} a side")
        dtype = "f1" if array.dtype == np.uint8 else "f2" if halves else "f4"
        return self._load(array, dtype)

    def _load(self, array: NDArray[np.generic], dtype: str) -> Upload | Load:
        if self._carrier is not None and dtype != "f1" and large(array):
            return self._carrier.carry(array, dtype)
        height, width, components = array.shape
        held = self._held.texture if isinstance(self._held, Upload) else None
        alike = held is not None and (held.size, held.components, held.dtype) == ((width, height), components, dtype)
        if held is None or not alike or large(array):  # a small one is written over the one held
            held = self._context.texture((width, height), components, dtype=dtype, alignment=1)
        return Upload(array, held)

    def _drop_upload(self) -> None:
        if self._next is not None and not _same(self._next, self._held):
            self._next.release()
        self._next = None

    def use(self, unit: int) -> None:
        """Bind to a texture unit, if there is an array."""
        if self._held is not None:
            self._held.texture.use(unit)

    def release(self) -> None:
        self._drop_upload()
        if self._held is not None:
            self._held.release()
        self._held = self._array = None


def large(array: NDArray[np.generic]) -> bool:
    """Whether an array takes a while."""
    return array.nbytes > BAND_BYTES


def _same(one: Upload | Load, other: Upload | Load | None) -> bool:
    """Whether they have one texture, which the one is written into over the other."""
    return isinstance(one, Upload) and isinstance(other, Upload) and one.texture is other.texture


class Upload:
    """An array on its way into a texture, a band of rows at a time."""

    def __init__(self, array: NDArray[np.generic], texture: moderngl.Texture) -> None:
        self.array = array
        self.texture = texture
        self._row = 0

    @property
    def share(self) -> float:
        return float(self._row / max(len(self.array), 1))

    def go_on(self, end: float | None) -> bool:
        """Upload until `end` on the clock, at least one band; return whether all rows are there."""
        height, width = self.array.shape[:2]
        halves = self.texture.dtype == "f2"
        step = max(1, BAND_BYTES // max(self.array[0].nbytes, 1))
        while self._row < height:
            rows = self.array[self._row : self._row + step]
            data = rows.astype(np.float16) if halves else np.ascontiguousarray(rows)
            self.texture.write(data, viewport=(0, self._row, width, len(rows)), alignment=1)
            self._row += len(rows)
            if end is not None and perf_counter() > end:
                break
        return bool(self._row >= height)

    def release(self) -> None:
        self.texture.release()
