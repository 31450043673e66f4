"""PNG: which of its chunks says what the codes mean, and the light they stand for.

Whatever was brighter than white is lost; the notes say so.

Source
    [PNG] Portable Network Graphics, third edition, 4.3 (which colour chunk counts), 11.3.2 (colour)
"""

from __future__ import annotations

import struct
from dataclasses import replace

import numpy as np

from shviewer.errors import LightError
from shviewer.lights.images.chromaticities import REC709, are_same, rec709_from
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.display.codes import decode, linearised
from shviewer.lights.images.display.colour import Colour, from_cicp, power
from shviewer.lights.images.display.icc import colour_of_profile
from shviewer.lights.images.display.photo_sphere import placed
from shviewer.lights.images.display.png_chunks import check_texels, plain_png, read_chunks, xmp_in
from shviewer.limits import DEFAULT_LIMITS, Limits

_SRGB_GAMMA = 0.45455  # what encoders write for sRGB


def decode_png(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance that a PNG's codes stand for; an animated PNG gives its first frame.

    data: the whole file.
    Raises LightError, without the name of the file, if it is damaged, too large, or in PQ or HLG.
    """
    from PIL.PngImagePlugin import PngImageFile  # here, so that lights without such a file start faster

    chunks, compressed = read_chunks(data)
    check_texels(chunks[b"IHDR"], compressed, limits)
    codes = decode(PngImageFile, plain_png(chunks, compressed), limits)
    colour = _colour(chunks, codes.profile)
    animated = ["animated: only the first frame is read"] if b"acTL" in chunks else []
    return placed(linearised("PNG", codes, colour, animated), xmp_in(chunks), limits)


def _colour(chunks: dict[bytes, bytes], profile: bytes) -> Colour:
    """What the codes mean. The first colour chunk in the list of [PNG] 4.3 counts."""
    if cicp := chunks.get(b"cICP"):
        primaries, transfer = (*cicp, 0, 0)[:2]
        return from_cicp(primaries, transfer)
    if b"iCCP" in chunks:
        return colour_of_profile(profile)
    if b"sRGB" in chunks:
        return Colour()
    colour = Colour()
    if len(chunks.get(b"gAMA", b"")) == 4:
        gamma = struct.unpack(">I", chunks[b"gAMA"])[0] / 1e5
        if not 0.1 <= gamma <= 10.0:
            colour = Colour(notes=(f"its gAMA of {gamma:g} is ignored, sRGB assumed",))
        elif abs(gamma - _SRGB_GAMMA) >= 0.005:
            colour = Colour((power(1.0 / gamma),), f"gamma {gamma:g}", notes=(f"its gAMA of {gamma:g} is honoured",))
    if len(chunks.get(b"cHRM", b"")) != 32:
        return colour
    white_first = (np.array(struct.unpack(">8I", chunks[b"cHRM"])) / 1e5).reshape(4, 2)
    chromaticities = np.roll(white_first, -1, axis=0)
    if are_same(chromaticities, REC709):
        return colour
    try:
        matrix = rec709_from(chromaticities)
    except LightError as error:
        return replace(colour, notes=(*colour.notes, f"its cHRM is ignored: {str(error).rpartition(';')[0]}"))
    notes = (*colour.notes, "its primaries (cHRM) are converted to Rec. 709")
    return replace(colour, rec709_from=matrix, notes=notes)
