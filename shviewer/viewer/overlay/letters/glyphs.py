"""Which characters a font file can draw, and which face of the system has a character that ours lacks."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from struct import error, iter_unpack, unpack_from
from typing import NamedTuple

WINDOWS_FACES = (
    *("segoeui.ttf", "seguisym.ttf", "msyh.ttc", "msjh.ttc", "YuGothM.ttc", "malgun.ttf", "Nirmala.ttc"),
    *("Nirmala.ttf", "leelawui.ttf", "ebrima.ttf", "arialuni.ttf", "arial.ttf", "simsun.ttc"),
)
"""Faces that come with Windows, which between them have most scripts."""

SECONDS = 2.0
"""How long fontconfig may take."""


class Face(NamedTuple):
    """A font file, and which of the faces in it."""

    path: str
    number: int = 0


@lru_cache(maxsize=64)
def coverage(face: Face) -> tuple[tuple[int, int], ...]:
    """The ranges (first, last) of characters that a face has, after its cmap; none of a file that cannot be read."""
    try:
        return tuple(_ranges(Path(face.path).read_bytes(), face.number))
    except (OSError, error, ValueError):
        return ()


def has(face: Face, character: str) -> bool:
    return any(first <= ord(character) <= last for first, last in coverage(face))


def _ranges(data: bytes, index: int) -> Iterator[tuple[int, int]]:
    """[OpenType 1.9, "cmap": formats 4 and 12, which hold the Basic Multilingual Plane and all of Unicode]."""
    start = unpack_from(">L", data, 12 + 4 * index)[0] if data[:4] == b"ttcf" else 0
    tables = iter_unpack(">4sLLL", data[start + 12 : start + 12 + 16 * unpack_from(">H", data, start + 4)[0]])
    found = {tag: place for tag, _, place, _ in tables}
    if b"cmap" not in found or not {b"glyf", b"CFF ", b"CFF2"} & found.keys():  # bitmaps alone have no outline
        return
    cmap = found[b"cmap"]
    for number in range(unpack_from(">H", data, cmap + 2)[0]):
        platform, encoding, place = unpack_from(">HHL", data, cmap + 4 + 8 * number)
        place += cmap
        kind = unpack_from(">H", data, place)[0]
        if kind == 12:
            for group in range(unpack_from(">L", data, place + 12)[0]):
                yield unpack_from(">LL", data, place + 16 + 12 * group)
        elif kind == 4 and (platform, encoding) != (3, 0):  # (3, 0): symbols at places of their own
            half = unpack_from(">H", data, place + 6)[0]
            ends = unpack_from(f">{half // 2}H", data, place + 14)
            starts = unpack_from(f">{half // 2}H", data, place + 16 + half)
            yield from (pair for pair in zip(starts, ends, strict=True) if pair != (0xFFFF, 0xFFFF))


@lru_cache(maxsize=1024)
def system_face(character: str) -> Face | None:
    """A face of the system that has the character as an outline; None if there is none."""
    candidates = {"win32": _windows, "darwin": _core_text}.get(sys.platform, _fontconfig)
    try:
        return next((face for face in candidates(character) if has(face, character)), None)
    except (OSError, subprocess.SubprocessError, AttributeError, ValueError):
        return None


def _fontconfig(character: str) -> Iterator[Face]:
    program = shutil.which("fc-match")
    if program is None:
        return
    wanted = f"sans:charset={ord(character):x}:outline=true:scalable=true"
    done = subprocess.run(
        [program, "-f", "%{file}\t%{index}", wanted], capture_output=True, timeout=SECONDS, check=False
    )
    path, _, index = os.fsdecode(done.stdout).partition("\t")
    if path:
        yield Face(path, int(index or 0) & 0xFFFF)


def _windows(character: str) -> Iterator[Face]:
    folder = Path(os.environ.get("WINDIR", r"C:\Windows")) / "Fonts"
    yield from (Face(str(folder / name)) for name in WINDOWS_FACES)


def _core_text(character: str) -> Iterator[Face]:
    """The file of the face that Core Text takes in place of Helvetica for this character."""
    text = ctypes.CDLL("/System/Library/Frameworks/CoreText.framework/CoreText")
    base = ctypes.CDLL("/System/Library/Frameworks/CoreFoundation.framework/CoreFoundation")
    pointer, whole = ctypes.c_void_p, ctypes.c_long

    class Range(ctypes.Structure):
        _fields_ = (("start", whole), ("length", whole))

    for function, result, arguments in (
        (base.CFStringCreateWithCString, pointer, (pointer, ctypes.c_char_p, ctypes.c_uint32)),
        (base.CFURLGetFileSystemRepresentation, ctypes.c_bool, (pointer, ctypes.c_bool, ctypes.c_char_p, whole)),
        (base.CFRelease, None, (pointer,)),
        (text.CTFontCreateWithName, pointer, (pointer, ctypes.c_double, pointer)),
        (text.CTFontCreateForString, pointer, (pointer, pointer, Range)),
        (text.CTFontCopyAttribute, pointer, (pointer, pointer)),
    ):
        function.restype, function.argtypes = result, arguments
    utf8, made = 0x08000100, []
    try:
        for said in ("Helvetica", character):
            made.append(base.CFStringCreateWithCString(None, said.encode(), utf8))
        made.append(text.CTFontCreateWithName(made[0], 12.0, None))
        units = len(character.encode("utf-16-le")) // 2
        made.append(text.CTFontCreateForString(made[2], made[1], Range(0, units)))
        made.append(text.CTFontCopyAttribute(made[3], pointer.in_dll(text, "kCTFontURLAttribute")))
        path = ctypes.create_string_buffer(4096)
        if made[-1] and base.CFURLGetFileSystemRepresentation(made[-1], True, path, len(path)):
            yield from (Face(os.fsdecode(path.value), index) for index in range(8))
    finally:
        for thing in filter(None, made):
            base.CFRelease(thing)
