"""The stamp that a PNG or an EXR carries, found without reading the picture.

Source
    [PNG] Portable Network Graphics, third edition, 5.3 (chunks), 11.3.3.4 (iTXt)
"""

from __future__ import annotations

import os
import stat
import struct
import zlib
from pathlib import Path
from typing import IO

from shviewer.errors import LightError
from shviewer.files import opened
from shviewer.lights.images.openexr_attributes import read_attributes

_PNG, _EXR = b"\x89PNG\r\n\x1a\n", b"\x76\x2f\x31\x01"
_KEYWORD = b"shviewer\0"
_MOST_CHUNKS = 2**18
_LONGEST = 2**22  # bytes of a stamp: those of 32 bands have 50 kB
_EXR_HEADER = 2**23  # bytes in which the header of an EXR of this program ends


def stamp_in(path: Path) -> str | None:
    """The text that this program wrote into a picture; None for any other file, also for one that cannot be read.

    LightError for a stamp that is damaged.
    """
    try:
        if not stat.S_ISREG(os.stat(path).st_mode):
            return None  # a pipe is read once, by whoever reads the light
        with opened(path) as file:
            magic = file.read(len(_PNG))
            if magic == _PNG:
                found = _in_png(file)
            else:
                found = _in_exr(magic + file.read(_EXR_HEADER)) if magic.startswith(_EXR) else None
    except (OSError, ValueError):
        return None
    if not found:
        return None
    try:
        return found.decode()
    except UnicodeDecodeError:
        raise LightError("its stamp is damaged: it is no text") from None


def _in_png(file: IO[bytes]) -> bytes | None:
    for _ in range(_MOST_CHUNKS):
        head = file.read(8)
        if len(head) < 8:
            return None
        length, kind = struct.unpack(">I4s", head)
        if kind == b"iTXt" and file.read(min(length, len(_KEYWORD))) == _KEYWORD:
            content = file.read(min(length - len(_KEYWORD), _LONGEST + 1))
            checksum = file.read(4)
            if len(content) > _LONGEST or len(checksum) < 4:
                raise LightError("its stamp is damaged: it is cut short, or far too long")
            if zlib.crc32(kind + _KEYWORD + content) != struct.unpack(">I", checksum)[0]:
                raise LightError("its stamp is damaged: it does not match its checksum")
            return _text_of(content)
        if kind == b"iTXt":
            file.seek(-min(length, len(_KEYWORD)), os.SEEK_CUR)
        file.seek(length + 4, os.SEEK_CUR)
    return None


def _text_of(content: bytes) -> bytes:
    """The text of an iTXt chunk behind its keyword: whether compressed, how, language, translated keyword, text."""
    text = content[2:].split(b"\0", 2)[-1]
    if content[:1] != b"\1":
        return text
    try:
        return zlib.decompressobj().decompress(text, _LONGEST)
    except zlib.error as error:
        raise LightError(f"its stamp is damaged: {error}") from None


def _in_exr(data: bytes) -> bytes | None:
    if _KEYWORD + b"string\0" not in data:
        return None
    return read_attributes(data)[0].attributes.get(_KEYWORD[:-1], (b"", b""))[1]
