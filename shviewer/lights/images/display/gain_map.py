"""Gain maps: the second picture in a JPEG that turns the first, made for a display, into HDR again (Ultra HDR).

With a the light of the picture, g the value of the map in 0 to 1 (bilinear between its texels), for each channel
    HDR = (a + base offset) 2 ** (minimum + (maximum - minimum) g ** (1 / gamma)) - alternate offset
at full headroom, where all of the gain is applied; 1 is the white of the picture. Below 0 is rounding: 0.

Sources
    [U] Ultra HDR Image Format v1.1, developer.android.com/media/platform/hdr-image-format: properties in XMP
    [I] ISO 21496-1:2025, annex C.2: the same in binary, as libultrahdr's gainmapmetadata.cpp writes it
"""

from __future__ import annotations

import math
import struct
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.display.jpeg_segments import Jpeg, following_images
from shviewer.lights.images.display.xmp import Properties, number, properties

_HDRGM = "{http://ns.adobe.com/hdr-gain-map/1.0/}"
_APPLE = "http://ns.apple.com/HDRGainMap/1.0/"
_ISO = b"urn:iso:std:iso:ts:21496:-1\0"
_SEVERAL_CHANNELS, _BASE_COLOURS, _BACKWARD, _COMMON = 0x80, 0x40, 0x04, 0x08
_MOST_STOPS, _MOST_OFFSET = 32.0, 1e3  # photographs have offsets up to 10
_BLOCK_TEXELS = 2**16


class Metadata(NamedTuple):
    """What the values of a map mean, for each channel; minimum, maximum and headroom are in stops."""

    minimum: NDArray[np.float64]
    maximum: NDArray[np.float64]
    gamma: NDArray[np.float64]
    base_offset: NDArray[np.float64]
    alternate_offset: NDArray[np.float64]
    headroom: float
    """How much brighter than white the HDR is meant to be, for the brightest display."""
    in_base_colours: bool
    """Whether the primaries in which it is applied are those of the picture; else those of the map's own profile."""


class GainMap(NamedTuple):
    """A gain map of an Ultra HDR image: its picture, and how it is applied."""

    jpeg: Jpeg
    metadata: Metadata


def find_gain_map(file: bytes, first: Jpeg) -> GainMap | None:
    """The gain map of the first image of a file; None if there is none.

    LightError, which says why, for one that is not understood.
    """
    announced = any(content.startswith(_ISO) for content in first.app2) or _has_gain_map(properties(first.xmp))
    for jpeg in following_images(file, first):
        payload = next((content[len(_ISO) :] for content in jpeg.app2 if content.startswith(_ISO)), b"")
        if len(payload) > 4:  # the first image has the version alone
            return GainMap(jpeg, _checked(_from_iso(payload)))
        found = properties(jpeg.xmp)
        if _has_gain_map(found):
            return GainMap(jpeg, _checked(_from_xmp(found)))
        if _APPLE.encode() in jpeg.xmp:
            raise LightError("Apple's own kind")
    if announced:
        raise LightError("it does not follow the picture")
    return None


def _has_gain_map(found: Properties) -> bool:
    return any(name.startswith(_HDRGM) for name in found)


def apply(pixels: NDArray[np.float32], codes: NDArray[Any], metadata: Metadata) -> None:
    """Turn the light of a picture (height, width, 3) into HDR, in place; codes: of its map, (rows, columns, 1 or 3)."""
    height, width = pixels.shape[:2]
    across, weight_across = _between(width, codes.shape[1])
    down, weight_down = _between(height, codes.shape[0])
    gains = codes.shape[2] if _alike(metadata) else 3
    low, exponent = (field[:gains].astype(np.float32) for field in (metadata.minimum, 1.0 / metadata.gamma))
    span = (metadata.maximum - metadata.minimum)[:gains].astype(np.float32)
    base, alternate = (field.astype(np.float32) for field in (metadata.base_offset, metadata.alternate_offset))
    block = max(1, _BLOCK_TEXELS // width)
    for top in range(0, height, block):
        rows = slice(top, top + block)
        upper, lower = (codes[np.minimum(down[rows] + i, len(codes) - 1)].astype(np.float32) for i in (0, 1))
        lines = upper + weight_down[rows, None, None] * (lower - upper)
        right = lines.take(np.minimum(across + 1, codes.shape[1] - 1), axis=1)
        left = lines.take(across, axis=1)
        share = (left + weight_across[:, None] * (right - left)) / np.float32(255)
        if np.any(exponent != 1.0):
            share = share**exponent
        gained = (pixels[rows] + base) * np.exp2(low + span * share) - alternate
        np.maximum(gained, 0.0, out=pixels[rows])


def _alike(metadata: Metadata) -> bool:
    """Whether the gain of all channels is made alike, so that a grey map needs one."""
    return all(np.ptp(field) == 0 for field in (metadata.minimum, metadata.maximum, metadata.gamma))


def _between(texels: int, samples: int) -> tuple[NDArray[np.int64], NDArray[np.float32]]:
    """For each texel the sample before its centre and the weight of the one after, at the border the sample there."""
    place = np.clip((np.arange(texels) + 0.5) * samples / texels - 0.5, 0.0, samples - 1.0)
    before = np.minimum(place.astype(np.int64), max(samples - 2, 0))
    return before, (place - before).astype(np.float32)


def _checked(metadata: Metadata) -> Metadata:
    stops = np.array([*metadata.minimum, *metadata.maximum, metadata.headroom])
    offsets = np.array([*metadata.base_offset, *metadata.alternate_offset])
    sound = np.all(np.abs(stops) <= _MOST_STOPS) and np.all(np.abs(offsets) <= _MOST_OFFSET)  # false for NaN
    if not (sound and np.all((metadata.gamma > 1e-3) & (metadata.gamma < 1e3))):
        raise LightError("its numbers make no sense")
    return metadata


def _from_xmp(found: Properties) -> Metadata:
    """[U], table 2."""

    def three(name: str, default: float | None) -> NDArray[np.float64]:
        texts = found.get(_HDRGM + name)
        values = [default if texts is None else number([text]) for text in texts or [""]]
        if len(values) not in (1, 3) or any(value is None for value in values):
            raise LightError(f"no number {name} in its XMP")
        return np.broadcast_to(np.array(values, np.float64), 3)

    if (found.get(_HDRGM + "BaseRenditionIsHDR") or ["False"])[0].lower() == "true":
        raise LightError("the picture itself is the HDR one")
    return Metadata(
        three("GainMapMin", 0.0),
        three("GainMapMax", None),
        three("Gamma", 1.0),
        three("OffsetSDR", 1 / 64),
        three("OffsetHDR", 1 / 64),
        float(three("HDRCapacityMax", None)[0]),
        in_base_colours=True,
    )


def _from_iso(payload: bytes) -> Metadata:
    """[I]; numbers are fractions, with a denominator each or one for all."""
    least_version, _, flags = struct.unpack_from(">HHB", payload)
    if least_version != 0:
        raise LightError(f"version {least_version} of ISO 21496-1")
    if flags & _BACKWARD:
        raise LightError("the picture itself is the HDR one")
    channels = 3 if flags & _SEVERAL_CHANNELS else 1
    signed = [False, False] + [True, True, False, True, True] * channels  # headrooms; minimum, maximum, gamma, offsets
    letters = "".join(("i" if sign else "I") + ("" if flags & _COMMON else "I") for sign in signed)
    layout = struct.Struct(">" + ("I" if flags & _COMMON else "") + letters)
    if len(payload) < 5 + layout.size:
        raise LightError("its numbers are cut short")
    numbers = layout.unpack_from(payload, 5)
    denominators = [numbers[0]] * len(signed) if flags & _COMMON else numbers[1::2]
    numerators = numbers[1:] if flags & _COMMON else numbers[::2]
    values = [n / d if d else math.nan for n, d in zip(numerators, denominators, strict=True)]
    fields = np.broadcast_to(np.reshape(values[2:], (channels, 5)), (3, 5)).T
    minimum, maximum, gamma, base_offset, alternate_offset = fields
    in_base_colours = bool(flags & _BASE_COLOURS)
    return Metadata(minimum, maximum, gamma, base_offset, alternate_offset, values[1], in_base_colours)
