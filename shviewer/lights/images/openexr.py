"""OpenEXR files: headers first, then the limits, then the pixels of the wanted part, as linear Rec. 709.

Alpha is ignored: colour in an OpenEXR file is premultiplied, and what is seen through a texel is not in the file.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import REC709, are_same, convert, rec709_from
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.luminance_chroma import rgb_from_luminance_chroma
from shviewer.lights.images.openexr_headers import Part, Window, read_headers
from shviewer.lights.images.openexr_layers import Source, find_source
from shviewer.lights.images.openexr_library import damaged, import_openexr, open_openexr
from shviewer.lights.images.openexr_parts import part_alone
from shviewer.lights.images.openexr_strings import with_readable_strings
from shviewer.limits import DEFAULT_LIMITS, Limits

_SAMPLES_PER_TEXEL = 4  # of all channels together, times the limit of texels: RGBA of the largest image
_TILE_OF_WINDOW = 4  # times its size: both sides may be up to the next power of two
_SMALL_TILE = 2**22  # values: 1024 x 1024 RGBA
_ROWS = 64  # of an image at a time, so that they stay in the cache
_KINDS = {"float16": "half", "float32": "float", "uint32": "uint"}

_Plane: TypeAlias = NDArray[np.floating]


def decode_openexr(data: bytes, limits: Limits = DEFAULT_LIMITS, layer: str = "") -> Decoded:
    """The radiance in an OpenEXR file on its display window, with notes for the user.

    data: the whole file. layer: as in openexr_layers.py; "" for the plain colours or the only layer.
    Half floats and unsigned integers are taken at their value; Inf and NaN pass through.
    Raises LightError, without the name of the file, if it is damaged, too large, deep, or does not say which of its
    channels are the radiance. Raises MemoryError.
    """
    planes = read_openexr(data, limits, layer)
    del data  # before memory is taken for the pixels
    return planes.decoded()


@dataclass(frozen=True, eq=False)
class Planes:
    """The planes of the wanted channels as the library gives them, and what makes them radiance."""

    planes: list[_Plane]
    part: Part
    source: Source
    matrix: NDArray[np.float64] | None
    """To linear Rec. 709; None for no change."""
    encoding: str
    notes: tuple[str, ...]

    @property
    def plain(self) -> bool:
        """Whether they are the radiance as it stands, all in half floats or all in float32."""
        changed = self.source.luminance_chroma or self.matrix is not None or self.part.window != self.part.display
        kinds = {plane.dtype.type for plane in self.planes}
        return not changed and kinds in ({np.float16}, {np.float32})

    @property
    def halves(self) -> bool:
        return self.plain and self.planes[0].dtype == np.float16

    def rows(self) -> Iterator[_Plane]:
        """The values as they stand, a few rows at a time, (rows, width, 3)."""
        for top in range(0, self.part.window.height, _ROWS):
            yield np.stack([plane[top : top + _ROWS] for plane in self._three], axis=2)

    def decoded(self) -> Decoded:
        """The radiance on the display window."""
        pixels = self._radiance()
        convert(pixels, self.matrix)
        pixels, cut = on_display_window(pixels, self.part.window, self.part.display)
        return Decoded(pixels, self.encoding, (*self.notes, *cut), self.part.layout)

    @property
    def _three(self) -> list[_Plane]:
        return self.planes * 3 if self.source.grey else self.planes

    def _radiance(self) -> NDArray[np.float32]:
        """(height, width, 3) on the data window, in the file's own primaries."""
        if self.source.luminance_chroma:
            luminance, chroma_red, chroma_blue = self.planes
            return rgb_from_luminance_chroma(luminance, (chroma_red, chroma_blue), self.part.chromaticities)
        pixels = np.empty((self.part.window.height, self.part.window.width, 3), np.float32)
        for top in range(0, len(pixels), _ROWS):
            rows = slice(top, top + _ROWS)
            for i, plane in enumerate(self._three):
                pixels[rows, :, i] = float32_of(plane[rows])
        return pixels


def read_openexr(data: bytes, limits: Limits = DEFAULT_LIMITS, layer: str = "") -> Planes:
    """`decode_openexr` up to the planes. Raises the same."""
    openexr = import_openexr()
    data = with_readable_strings(data)
    parts = read_headers(openexr, data)
    source, notes = find_source(parts, layer)
    part = parts[source.part]
    _check_size(part, limits, len(data), source)
    matrix, converted = _to_rec709(part, source)

    if len(parts) > 1:
        data = part_alone(data, source.part)
    planes = _planes(open_openexr(openexr, data, header_only=False), part, source)
    kinds = "/".join(dict.fromkeys(_KINDS.get(str(plane.dtype), str(plane.dtype)) for plane in planes))
    words = ["OpenEXR", kinds, *part.storage]
    if source.grey or source.luminance_chroma:
        words.append("luminance" if source.grey else "luminance-chroma")
    if len(parts) > 1:
        words.append(f"part {source.part + 1} of {len(parts)}")
    whole = ("its texels are whole numbers (uint), taken as radiance",) if "uint" in kinds else ()  # often codes
    return Planes(planes, part, source, matrix, ", ".join(words), (*notes, *whole, *converted))


def _check_size(part: Part, limits: Limits, file_bytes: int, source: Source) -> None:
    """LightError for a part that is too large, or would take too much memory."""
    window, display = (frame.width * frame.height for frame in (part.window, part.display))
    pixels = (28 if source.luminance_chroma else 12) * window + (12 * display if part.window != part.display else 0)
    decoding = part.plane_bytes + max(pixels, 4 * file_bytes)  # the file is let go before the pixels are made
    limits.check_size(part.window.width, part.window.height, "data window")
    limits.check_image(part.display.width, part.display.height, decoding, "display window")
    most = _SAMPLES_PER_TEXEL * limits.texels
    if part.samples > most:
        raise LightError(f"{part.samples} values in all channels; the limit is {most}: export only R, G and B")
    if part.tile is None:
        return
    across, down = part.tile
    most = max(_TILE_OF_WINDOW * part.samples, _SMALL_TILE)
    if not 0 < across * down * len(part.channels) <= most:
        raise LightError(
            f"tiles of {across} x {down} texels for a data window of {part.window.width} x {part.window.height}; a tile"
            f" may hold {most} values: export it with tiles of 64 x 64"
        )


def _to_rec709(part: Part, source: Source) -> tuple[NDArray[np.float64] | None, tuple[str, ...]]:
    """The matrix to linear Rec. 709, None if the colours are that already, and notes. Grey stays grey in any space."""
    if part.chromaticities is None:
        return None, ()
    xy = np.array(part.chromaticities, np.float64).reshape(4, 2)
    matrix = rec709_from(xy)  # also refuses chromaticities that make no colour space
    if source.grey or are_same(xy, REC709):
        return None, ()
    red, green, blue, white = (f"({x:.4g}, {y:.4g})" for x, y in xy)
    return matrix, (f"colours converted to Rec. 709 from the primaries {red}, {green}, {blue} and the white {white}",)


def _planes(file: Any, part: Part, source: Source) -> list[_Plane]:
    """The pixels of each channel, at its own resolution."""
    if len(file.parts) != 1:
        raise damaged(f"{len(file.parts)} parts where its header has one")
    subsampling = {channel.name: channel.subsampling for channel in part.channels}
    planes = []
    for name in source.channels:
        across, down = subsampling[name]
        plane = file.parts[0].channels[name].pixels
        if plane.dtype == object or plane.shape != (part.window.height // down, part.window.width // across):
            raise damaged(f"channel {name} has no pixels")
        planes.append(plane)
    return planes


def float32_of(plane: _Plane, out: NDArray[np.float32] | None = None) -> _Plane:
    """The plane as float32; halves go through a table, which takes three quarters of the time of a cast.

    out: where halves are put.
    """
    if plane.dtype != np.float16:
        return plane
    return _every_half().take(plane.view(np.uint16), out=out, mode="clip")  # nothing is out of range, or copied twice


@cache
def _every_half() -> NDArray[np.float32]:
    """(65536,): the value of each pattern of bits."""
    with np.errstate(invalid="ignore"):  # signalling NaN
        return np.arange(2**16, dtype=np.uint16).view(np.float16).astype(np.float32)


def on_display_window(
    radiance: NDArray[np.float32], window: Window, display: Window
) -> tuple[NDArray[np.float32], tuple[str, ...]]:
    """The radiance on the display window, (height, width, 3), which is the whole sphere, and notes on what was done.

    Black where there are no data, cropped outside. LightError if the windows have nothing in common.
    """
    if window == display:
        return radiance, ()
    left, right = max(window.left, display.left), min(window.right, display.right)
    top, bottom = max(window.top, display.top), min(window.bottom, display.bottom)
    if left > right or top > bottom:
        raise LightError(f"data window {tuple(window)} lies outside display window {tuple(display)}: re-export it")
    pixels = np.zeros((display.height, display.width, 3), np.float32)
    common = Window(left, top, right, bottom)
    pixels[_slices(common, display)] = radiance[_slices(common, window)]

    kept = common.width * common.height
    notes = []
    if empty := display.width * display.height - kept:
        notes.append(f"data window smaller than display window: {empty} texels without data are 0")
    if cropped := window.width * window.height - kept:
        notes.append(f"data window larger than display window: {cropped} texels outside are dropped")
    return pixels, tuple(notes)


def _slices(part: Window, whole: Window) -> tuple[slice, slice]:
    """The rows and columns of `part` in an array that covers `whole`."""
    rows = slice(part.top - whole.top, part.bottom - whole.top + 1)
    return rows, slice(part.left - whole.left, part.right - whole.left + 1)
