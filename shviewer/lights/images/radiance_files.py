"""Radiance from an image file: its kind, whether it may be read, and what to do about bad values.

The decoders are beside this file, one per format. A *value* is one channel of one texel; messages and notes count values.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.files import naming, read_bytes
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.limits import BRIGHTEST, Limits, check_brightness
from shviewer.words import counted, one_line


@dataclass(frozen=True)
class _Kind:
    name: str
    magics: tuple[bytes, ...]
    suffixes: tuple[str, ...]


_RGBE = _Kind("Radiance RGBE", (b"#?", b"\xef\xbb\xbf#?"), (".hdr", ".pic", ".rgbe"))
_OPENEXR = _Kind("OpenEXR", (b"\x76\x2f\x31\x01",), (".exr",))
_PNG = _Kind("PNG", (b"\x89PNG",), (".png",))
_JPEG = _Kind("JPEG", (b"\xff\xd8\xff",), (".jpg", ".jpeg"))
_PFM = _Kind("PFM", (b"PF", b"Pf"), (".pfm",))
_DDS = _Kind("DDS", (b"DDS ",), (".dds",))
_ARRAY = _Kind("NumPy", (b"\x93NUMPY",), (".npy",))
_BY_OPENIMAGEIO = (
    _Kind("TIFF", (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"), (".tif", ".tiff")),
    _Kind("PSD", (b"8BPS",), (".psd", ".psb")),
    _Kind("WebP", (b"RIFF",), (".webp",)),
    _Kind("BMP", (b"BM",), (".bmp",)),
)
_KINDS = (_RGBE, _OPENEXR, _PNG, _JPEG, _PFM, _DDS, _ARRAY, *_BY_OPENIMAGEIO)

IMAGE_SUFFIXES = tuple(suffix for kind in _KINDS if kind is not _ARRAY for suffix in kind.suffixes)

_OTHER_MAGICS = (
    (b"GIF8", "a GIF"),
    (b"\xabKTX", "a KTX"),
    (b"PK\x03\x04", "a ZIP"),
    (b"\x1f\x8b", "a gzip"),
    (b"version https://git-lfs", "a Git LFS pointer"),
    (b"<", "an HTML or XML"),
)


def read_radiance_image(path: Path, reading: Reading = DEFAULT_READING, layer: str = "") -> Decoded:
    """Read an image file, of the kind that its first bytes say; the notes also say what was done about bad values.

    layer: the layer of an OpenEXR file, such as "diffuse"; "" for the plain colours or the only layer.
    Raises LightError, one line with file, finding, rule and next step, for whatever is wrong with the file.
    """
    return decode_radiance_image(_bytes_of(path, reading.limits), str(path), reading, layer)


def decode_radiance_image(data: bytes, name: str, reading: Reading = DEFAULT_READING, layer: str = "") -> Decoded:
    """`read_radiance_image` for a file that is in memory already; `name` is the path it has or might have."""
    with naming(name):
        kind, file = _kind(data, Path(name).suffix.lower()), [data]
        del data  # held by nobody but its decoder, which lets it go before it takes memory for the pixels
        decoded = _decoded(kind, file, reading.limits, layer, reading.isolated)
    return checked(decoded, name, reading.sanitize)


def checked(decoded: Decoded, name: str, sanitize: bool) -> Decoded:
    """A decoded image with values that are fit for a light, perhaps repaired, in place; notes say so. LightError otherwise."""
    with naming(name):
        notes = _repair(decoded.pixels) if sanitize else ()
        smallest, largest = 0.0, decoded.largest or math.inf
        if largest > BRIGHTEST:  # else nothing needs a look
            smallest, largest = float(decoded.pixels.min()), float(decoded.pixels.max())  # NaN if there is one
        if not math.isfinite(largest - smallest):
            _refuse_what_is_not_finite(decoded.pixels)
        if smallest < 0.0:
            notes += (f"{_negative(decoded.pixels)}, minimum {smallest:.4g}, kept",)
    check_brightness(max(largest, -smallest), one_line(name))
    return replace(decoded, notes=decoded.notes + notes)


def _bytes_of(path: Path, limits: Limits) -> bytes:
    with naming(str(path)):
        return read_bytes(path, limits)


def _decoded(kind: _Kind, file: list[bytes], limits: Limits, layer: str, isolated: bool | None) -> Decoded:
    """Decode the file, which is taken out of the list; the decoder is imported here, since most lights need none."""
    if kind is _RGBE:
        from shviewer.lights.images.rgbe import decode_rgbe

        return decode_rgbe(file.pop(), limits)
    if kind is _OPENEXR:
        from shviewer.lights.images.isolated import decode_isolated
        from shviewer.lights.images.openexr import decode_openexr

        return (decode_isolated if isolated else decode_openexr)(file.pop(), limits, layer)
    if kind is _PNG:
        from shviewer.lights.images.display.png import decode_png

        return decode_png(file.pop(), limits)
    if kind is _JPEG:
        from shviewer.lights.images.display.jpeg import decode_jpeg

        return decode_jpeg(file.pop(), limits)
    return _of_another_kind(kind, file, limits, isolated)


def _of_another_kind(kind: _Kind, file: list[bytes], limits: Limits, isolated: bool | None) -> Decoded:
    if kind is _PFM:
        from shviewer.lights.images.others.pfm import decode_pfm

        return decode_pfm(file.pop(), limits)
    if kind is _ARRAY:
        from shviewer.lights.images.others.arrays import decode_array

        return decode_array(file.pop(), limits)
    if kind is _DDS:
        from shviewer.lights.images.others.dds import decode_float_dds, spelled_out

        if (decoded := decode_float_dds(file[0], limits)) is not None:
            return decoded
        file[0] = spelled_out(file[0])
    from shviewer.lights.images.others.openimageio import check_installed, decode_openimageio

    check_installed(kind.name)  # before a process is started
    if isolated is False:
        return decode_openimageio(file.pop(), limits, kind.name)
    from shviewer.lights.images.isolated import decode_isolated

    return decode_isolated(file.pop(), limits, kind=kind.name)


def _kind(data: bytes, suffix: str) -> _Kind:
    """The kind by the first bytes. A suffix that says otherwise is refused, since one of the two is a mistake."""
    for kind in _KINDS:
        if not data.startswith(kind.magics):
            continue
        if suffix not in kind.suffixes and any(suffix in other.suffixes for other in _KINDS):
            raise LightError(f"named {suffix} but holds {kind.name}; rename it to end in {kind.suffixes[0]}")
        return kind
    wanted = "an image is read as .hdr (Radiance), .exr (OpenEXR), .png or .jpg: convert it"
    for magic, name in _OTHER_MAGICS:
        if data.startswith(magic):
            raise LightError(f"seems to be {name} file; {wanted}")
    raise LightError(f"begins with {data[:8]!r}, which is no known image; {wanted}")


def _refuse_what_is_not_finite(pixels: NDArray[np.float32]) -> None:
    """LightError for NaN and Inf, if there are any."""
    finite = np.isfinite(pixels)
    if not finite.all():
        row, column = (int(i) for i in np.argwhere(~finite.all(axis=2))[0])
        nan, up, down = int(np.isnan(pixels).sum()), int(np.isposinf(pixels).sum()), int(np.isneginf(pixels).sum())
        raise LightError(
            f"{nan} NaN, {up} +Inf and {down} -Inf values, the first at row {row}, column {column} (from 0, top left);"
            " a light must be finite: --sanitize repairs them"
        )


def _repair(pixels: NDArray[np.float32]) -> tuple[str, ...]:
    """Make the values finite and not negative, in place; return a note for each kind of repair."""
    finite = np.isfinite(pixels)
    if not finite.any():
        raise LightError("not one finite value, so there is nothing to repair it with: export it again")
    smallest = pixels.min(where=finite, initial=0.0)
    largest = pixels.max(where=finite, initial=0.0)
    repairs = []
    for wrong, name, value in (
        (np.isnan(pixels), "NaN", 0.0),
        (np.isposinf(pixels), "+Inf", largest),
        (np.isneginf(pixels), "-Inf", 0.0),
    ):
        if count := int(wrong.sum()):
            pixels[wrong] = value
            repairs.append(f"{count} {name} -> {value:.6g}")
    notes = ["sanitised: " + ", ".join(repairs)] if repairs else []
    if smallest < 0.0:
        notes.append(f"sanitised: {_negative(pixels)}, minimum {smallest:.4g} -> 0")
        np.maximum(pixels, 0.0, out=pixels)
    return tuple(notes)


def _negative(pixels: NDArray[np.float32]) -> str:
    return counted(int((pixels < 0.0).sum()), "negative value")
