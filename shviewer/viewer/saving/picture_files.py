"""PNG and EXR files that carry a text, written whole or not at all."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from shviewer.errors import OutputError
from shviewer.outputs import write_atomically
from shviewer.version import __version__


def write_png(path: Path, pixels: NDArray[np.uint8], text: str, *, exclusive: bool = False) -> None:
    """Write a PNG with `text` under the key shviewer, or OutputError. exclusive: FileExistsError if `path` exists."""
    write_atomically(path, png_bytes(pixels, text), exclusive=exclusive)


def png_bytes(pixels: NDArray[np.uint8], text: str) -> bytes:
    """A PNG with `text` under the key shviewer."""
    information = PngInfo()
    information.add_itxt("shviewer", text)
    information.add_text("Software", f"shviewer {__version__}")
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG", compress_level=4, pnginfo=information)
    return buffer.getvalue()


def write_exr(
    path: Path, pixels: NDArray[np.float32], text: str, layers: Mapping[str, NDArray[np.float32]] = MappingProxyType({})
) -> None:
    """Write an EXR of float32 RGB, and of layers by their names, with `text` in the attribute shviewer.

    OutputError if that fails or OpenEXR is missing.
    """
    try:
        import OpenEXR
    except ImportError as error:
        raise OutputError(f"{path}: writing EXR needs the package OpenEXR (pip install OpenEXR)") from error
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "shviewer": text}
    buffer = io.BytesIO()
    channels = {"RGB": pixels} | {
        f"{name}.{letter}": np.ascontiguousarray(layer[..., channel])
        for name, layer in layers.items()
        for channel, letter in enumerate("RGB")
    }
    OpenEXR.File(header, channels).write(buffer)
    write_atomically(path, buffer.getvalue())


def write_numbered(
    stem: str, write: Callable[[Path], object], first: int = 1, suffix: str = ".png", folder: Path = Path()
) -> Path:
    """Write under the next free name stem-001.png, stem-002.png, ... in the current folder or another; return its path.

    write: writes a path exclusively. first: the number to begin with; 0 is stem.png.
    """
    for number in range(first, 10_000):
        path = folder / (f"{stem}-{number:03d}{suffix}" if number else f"{stem}{suffix}")
        if not os.path.lexists(path):
            with suppress(FileExistsError):  # somebody else was faster
                write(path)
                return path
    raise OutputError(f"{stem}-001{suffix} to {stem}-9999{suffix} all exist; move some away")
