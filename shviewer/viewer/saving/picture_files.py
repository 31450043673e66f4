"""PNG and EXR files that carry a text, written whole or not at all."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from shviewer.errors import OutputError
from shviewer.files import write_atomically, writing_folder
from shviewer.version import __version__


def write_png(path: Path, pixels: NDArray[np.uint8], text: str, *, exclusive: bool = False) -> None:
    """Write a PNG with `text` under the key shviewer, or OutputError. exclusive: FileExistsError if `path` exists."""
    information = PngInfo()
    information.add_itxt("shviewer", text)
    information.add_text("Software", f"shviewer {__version__}")
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG", compress_level=4, pnginfo=information)
    write_atomically(path, buffer.getvalue(), exclusive=exclusive)


def write_exr(path: Path, pixels: NDArray[np.float32], text: str) -> None:
    """Write an EXR of float32 RGB with `text` in the attribute shviewer. OutputError if that fails or OpenEXR is missing."""
    try:
        import OpenEXR
    except ImportError as error:
        raise OutputError(f"{path}: writing EXR needs the package OpenEXR (pip install OpenEXR)") from error
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "shviewer": text}
    with _folder_beside(path) as folder:
        file = Path(folder) / "picture.exr"
        OpenEXR.File(header, {"RGB": pixels}).write(str(file))
        write_atomically(path, file.read_bytes())


@contextmanager
def _folder_beside(path: Path) -> Iterator[str]:
    """A folder for a moment, beside the file that is to be written: nothing else need be writable."""
    try:
        with tempfile.TemporaryDirectory(prefix=".shv-", suffix=".tmp", dir=writing_folder(path)) as folder:
            yield folder
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}; choose another place") from error


def write_numbered(stem: str, pixels: NDArray[np.uint8], text: str) -> Path:
    """Write a PNG under the next free name stem-001.png, stem-002.png, ... in the current folder; return its path."""
    for number in range(1, 10_000):
        path = Path(f"{stem}-{number:03d}.png")
        if not path.exists():
            with suppress(FileExistsError):  # somebody else was faster
                write_png(path, pixels, text, exclusive=True)
                return path
    raise OutputError(f"{stem}-001.png to {stem}-9999.png all exist; move some away")
