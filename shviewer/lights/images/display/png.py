"""PNG: which of its chunks says what the codes mean, and the light they stand for.

Whatever was brighter than white is lost; the notes say so.

Source
    [PNG] Portable Network Graphics, third edition, 4.3 (which colour chunk counts), 11.3.2 (colour)
"""

from __future__ import annotations

import struct

import numpy as np

from shviewer.errors import LightError
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.display.codes import decode, linearised
from shviewer.lights.images.display.colour import Colour, from_cicp, matrix_or_none, of_power
from shviewer.lights.images.display.icc import colour_of_profile
from shviewer.lights.images.display.photo_sphere import place
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
    decoded = linearised("PNG", codes, colour, animated)
    pixels, layout, placed = place(decoded.pixels, xmp_in(chunks), limits)
    return Decoded(pixels, decoded.encoding, (*decoded.notes, *placed), layout)


def _colour(chunks: dict[bytes, bytes], profile: bytes) -> Colour:
    """What the codes mean. The first colour chunk in the list of [PNG] 4.3 counts."""
    if cicp := chunks.get(b"cICP"):
        primaries, transfer = (*cicp, 0, 0)[:2]
        return from_cicp(primaries, transfer)
    if b"iCCP" in chunks:
        return colour_of_profile(profile)
    if b"sRGB" in chunks:
        return Colour()
    curve = Colour()
    if len(chunks.get(b"gAMA", b"")) == 4:
        gamma = struct.unpack(">I", chunks[b"gAMA"])[0] / 1e5
        if not 0.1 <= gamma <= 10.0:
            curve = Colour(notes=(f"its gAMA of {gamma:g} is ignored, sRGB assumed",))
        elif abs(gamma - _SRGB_GAMMA) >= 0.005:
            curves, _ = of_power(1.0 / gamma)
            curve = Colour(curves, f"gamma {gamma:g}", notes=(f"its gAMA of {gamma:g} is honoured",))
    if len(chunks.get(b"cHRM", b"")) != 32:
        return curve
    white, *primaries_xy = (np.array(struct.unpack(">8I", chunks[b"cHRM"])) / 1e5).reshape(4, 2)
    try:
        matrix = matrix_or_none(np.array([*primaries_xy, white]))
    except LightError as error:
        note = f"its cHRM is ignored: {str(error).rpartition(';')[0]}"
        return Colour(curve.curves, curve.curve_name, None, (*curve.notes, note))
    notes = curve.notes if matrix is None else (*curve.notes, "its primaries (cHRM) are converted to Rec. 709")
    return Colour(curve.curves, curve.curve_name, matrix, notes)
