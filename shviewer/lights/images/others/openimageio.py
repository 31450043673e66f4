"""TIFF, DDS, PSD, WebP and BMP by OpenImageIO, an extra: pip install "shviewer[formats]".

What this program reads itself never comes here: OpenImageIO turns three of fourteen sound .hdr files, and PFM upside down.

Integers are codes for a display: the sRGB curve, unless the file states another. Floating-point numbers are linear radiance.
Traps of OpenImageIO (3.2), each with a test: colours are multiplied by alpha unless told not to; a plug-in that fails hands the
file to all others; orientation and full size are told, not applied; CMYK is converted by a formula; memory is not read.
"""

from __future__ import annotations

import re
from importlib.util import find_spec
from typing import Any

import numpy as np

from shviewer.ending import temporary_folder
from shviewer.errors import LightError
from shviewer.files import decoding
from shviewer.lights.images.chromaticities import convert
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.display.codes import Codes, linearised
from shviewer.lights.images.display.colour import Colour
from shviewer.lights.images.display.icc import colour_of_profile
from shviewer.lights.images.openexr import on_display_window
from shviewer.lights.images.openexr_headers import Window
from shviewer.limits import DEFAULT_LIMITS, Limits
from shviewer.words import one_line

EXTRA = 'pip install "shviewer[formats]"'

_RGB_OR_GREY = (0, 1, 2, 3, 6)  # TIFF's photometric interpretations: grey, RGB, palette, YCbCr
_BITS = {"uint8": 8, "uint16": 16}
_FLOATS = ("half", "float", "double")


def decode_openimageio(data: bytes, limits: Limits = DEFAULT_LIMITS, kind: str = "TIFF") -> Decoded:
    """The radiance in an image file. kind: the format as OpenImageIO names it, in whatever case.

    data: the whole file, which goes through a temporary one.
    LightError, without the name of the file, if it is damaged, too large, or neither RGB nor grey. Raises MemoryError.
    """
    import OpenImageIO as library

    library.attribute("threads", 1)
    with temporary_folder() as folder:
        file = folder / f"image.{kind.lower()}"
        file.write_bytes(data)
        with decoding(kind):  # of whatever its Python does not expect
            return _decoded(library, str(file), limits, kind)


def check_installed(kind: str) -> None:
    """LightError if OpenImageIO is missing; asked before anything is done for a file of this kind."""
    if find_spec("OpenImageIO") is None:
        raise LightError(f"{kind} is read with an extra: {EXTRA}, or convert it to .hdr or .exr")


def _decoded(library: Any, name: str, limits: Limits, kind: str) -> Decoded:
    wanted = library.ImageSpec()
    wanted["oiio:UnassociatedAlpha"] = 1
    file = library.ImageInput.open(name, wanted)
    if file is None:
        # what it says names a file that the user does not know
        raise _damaged(re.sub(rf'[: ]+"?{re.escape(name)}"?', "", library.geterror()))
    try:
        if file.format_name() != kind.lower():
            raise _damaged(f"it passes for {file.format_name()}")
        return _read(library, file, limits, kind)
    finally:
        file.close()


def _read(library: Any, file: Any, limits: Limits, kind: str) -> Decoded:
    spec = file.spec()
    _check(spec, limits)
    stored = str(spec.format)
    if spec.get_int_attribute("tiff:PhotometricInterpretation", 2) not in _RGB_OR_GREY:
        raise LightError("neither RGB nor grey, such as CMYK or Lab; export it as RGB")
    if stored not in (*_BITS, *_FLOATS):
        raise LightError(
            f"texels of type {stored}; 8 and 16 bit and floating-point numbers are read: export it as float"
        )
    values = file.read_image(0, 0, 0, spec.nchannels, library.TypeDesc(stored if stored in _BITS else "float"))
    if values is None or file.has_error:
        raise _damaged(file.geterror())
    values = np.asarray(values).reshape(spec.height, spec.width, spec.nchannels)
    alpha = spec.nchannels in (2, 4)
    notes = []
    if file.seek_subimage(1, 0):
        notes = [f"only {'the merged image of its layers' if kind == 'PSD' else 'the first of its images'} is read"]
    orientation, profile = spec.get_int_attribute("Orientation", 1), _bytes(spec.getattribute("ICCProfile"))
    codes = Codes(values, _BITS.get(stored, 32), alpha, orientation, profile)
    if stored in _BITS:
        decoded = linearised(kind, codes, colour_of_profile(profile), notes)
    else:
        decoded = _floats(kind, stored, codes, notes)
    return _placed(decoded, spec, orientation)


def _check(spec: Any, limits: Limits) -> None:
    limits.check_size(spec.width, spec.height)
    decoding = (12 + 12 * spec.nchannels) * spec.width * spec.height + 12 * spec.full_width * spec.full_height
    limits.check_image(spec.full_width, spec.full_height, decoding, "full image")
    names = tuple(spec.channelnames)
    known = spec.nchannels in (1, 2) or (spec.nchannels in (3, 4) and names[:3] == ("R", "G", "B"))
    if spec.depth != 1 or spec.deep or not known:
        raise LightError(
            f"channels {one_line(' '.join(names), 80)}; RGB or grey is read, perhaps with alpha: export that"
        )


def _floats(kind: str, stored: str, radiance: Codes, notes: list[str]) -> Decoded:
    """The light of texels that are linear, whatever their profile says; it may state their primaries."""
    colour = colour_of_profile(radiance.profile)
    if colour.curve_name != "linear":
        ignored = ("its colour profile (ICC) is ignored, Rec. 709 assumed",) if radiance.profile else ()
        colour = Colour(notes=ignored)
    colours = radiance.colours(radiance.orientation)
    pixels = np.ascontiguousarray(colours if colours.shape[2] == 3 else np.repeat(colours, 3, axis=2))
    convert(pixels, colour.rec709_from)
    return Decoded(pixels, f"{kind}, {stored}, taken as linear", (*colour.notes, *notes, *radiance.notes()))


def _placed(decoded: Decoded, spec: Any, orientation: int) -> Decoded:
    """The image where it lies in the full one; a cube, whose faces come in one column, as a row of them."""
    if spec.get_string_attribute("textureformat") == "CubeFace Environment":
        size = spec.width
        if spec.height != 6 * size:
            raise LightError("a cube of which faces are missing; export all six")
        faces = decoded.pixels.reshape(6, size, size, 3).swapaxes(0, 1).reshape(size, 6 * size, 3)
        return Decoded(np.ascontiguousarray(faces), f"{decoded.encoding}, cube", decoded.notes, "cube")
    window = _window(spec.x, spec.y, spec.width, spec.height)
    full = _window(spec.full_x, spec.full_y, spec.full_width, spec.full_height)
    if window == full:
        return decoded
    if orientation != 1:
        raise LightError("part of a larger image, and turned; export it upright and whole")
    pixels, notes = on_display_window(decoded.pixels, window, full)
    return Decoded(pixels, decoded.encoding, (*decoded.notes, *notes))


def _window(left: int, top: int, width: int, height: int) -> Window:
    return Window(left, top, left + width - 1, top + height - 1)


def _bytes(profile: Any) -> bytes:
    return np.asarray(profile, dtype=np.uint8).tobytes() if profile is not None else b""


def _damaged(said: str) -> LightError:
    if re.search("unsupported|not supported", said, re.IGNORECASE):
        return LightError(f"a variant that is not read ({one_line(said, 160)}); convert it to .hdr or .exr")
    return LightError(
        f"damaged or cut short ({one_line(said, 160) or 'no reason given'}); fetch or export the file again"
    )
