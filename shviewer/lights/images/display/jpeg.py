"""JPEG: the light of its first image, with the gain map that may follow it.

Damage within the scans cannot be told from a picture: the format has no checksum. What is cut short is refused.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import convert
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.display.codes import Codes, damaged, decode, linear
from shviewer.lights.images.display.colour import Colour
from shviewer.lights.images.display.gain_map import GainMap, apply, find_gain_map
from shviewer.lights.images.display.icc import colour_of_profile
from shviewer.lights.images.display.jpeg_segments import Jpeg, read_jpeg
from shviewer.lights.images.display.photo_sphere import placed
from shviewer.limits import DEFAULT_LIMITS, Limits

_MOST_TEXELS_OF_A_BYTE = 8 * 64  # a block of 8 x 8 takes at least one bit of Huffman code


def decode_jpeg(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance of a JPEG, upright by its EXIF orientation, on the part of the sphere that its XMP states.

    data: the whole file; what follows its first image does not matter, but for a gain map.
    Raises LightError, without the name of the file, if it is damaged, cut short, too large, or neither RGB nor grey.
    """
    first = read_jpeg(data)
    codes = _whole(first, limits)
    colour = colour_of_profile(codes.profile)
    words, notes = f"{codes.bits} bit {colour.curve_name}", []
    pixels = linear(codes, colour)
    matrix, white = colour.rec709_from, ""
    try:
        if gain_map := find_gain_map(data, first):
            map_codes = _whole(gain_map.jpeg, limits)
            into, matrix = _matrices(colour, map_codes, gain_map)
            convert(pixels, into)
            apply(pixels, map_codes.colours(codes.orientation), gain_map.metadata)
            white = f"{2.0**gain_map.metadata.headroom:.3g} times "
    except LightError as error:
        notes.append(f"its gain map is not read ({error})")
    mapped = " and its gain map at full headroom" if white else ""
    lost = f"{words}{mapped}, linearised: what was brighter than {white}white is lost, so a sun will be too weak"
    convert(pixels, matrix)
    encoding = f"JPEG, {words} with a gain map (HDR)" if white else f"JPEG, {words} (LDR)"
    return placed(Decoded(pixels, encoding, (lost, *notes, *colour.notes, *codes.notes())), codes.xmp, limits)


def _whole(jpeg: Jpeg, limits: Limits) -> Codes:
    """The codes of an image. LightError if it is cut short: if what might follow its last scan would change it."""
    from PIL.JpegImagePlugin import JpegImageFile  # here, so that lights without such a file start faster

    most = _MOST_TEXELS_OF_A_BYTE * len(jpeg.data)
    codes = decode(JpegImageFile, jpeg.data, limits, most)
    if not jpeg.arithmetic and not np.array_equal(codes.values, decode(JpegImageFile, jpeg.followed, limits).values):
        raise damaged("its last scan ends before the image does")
    return codes


def _matrices(
    colour: Colour, map_codes: Codes, gain_map: GainMap
) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | None]:
    """From the picture's primaries to those in which the map is applied, and from there to Rec. 709."""
    if gain_map.metadata.in_base_colours or not map_codes.profile:
        return None, colour.rec709_from
    alternate = colour_of_profile(map_codes.profile).rec709_from
    own: NDArray[np.float64] = np.eye(3) if colour.rec709_from is None else colour.rec709_from
    return own if alternate is None else np.linalg.inv(alternate) @ own, alternate
