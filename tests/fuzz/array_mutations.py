"""Ways to spoil NumPy's files: headers that claim anything, archives whose members, sizes, checksums and names lie."""

# ruff: noqa: SIM905 (a list of spellings is read more easily in one text)

from __future__ import annotations

import io
import json
import re
import struct
import warnings
import zipfile
from functools import cache
from random import Random

from tree_mutations import spoilt_tree

_TYPES = (
    *(
        "'<f8' | '>f8' | '<f4' | '<f2' | '<f16' | '<i8' | '<c8' | '<c16' | '<c32' | 'O8' | '<U5' | '<U100000' | "
        "'<M8[s]' | '<M8[-1s]' | '<m8' | '<f3' | 'x' | '' | '<f8,<f8' | [('a','<f8')] | [('a','<f8',(3,))] | [] | "
        "('<f8',(3,)) | {} | None | 5 | '(3,)f8' | '(1000000,1000000)f8' | 1e400 | "
        "{'names':['a'],'formats':['f8'],'offsets':[-8]}"
    ).split(" | "),
    *("'|u1'", "'|b1'", "'|O'", "'|S3'", "'|V8'", "'|V0'", "'|S0'", "[('a',[('b','|O')])]"),
    *("'" + "f8," * 300 + "f8'", "'\\x1b[2Jf8'", "[('a\\n','<f8')]"),
)
_ORDERS = ("False", "False", "True", "0", "1", "None", "'x'", "[]")
_SHAPES = (
    *(
        "(9, 3) | (3, 9) | (27,) | (9,) | (1, 3) | (9, 3, 1) | () | (0,) | (0, 3) | (9, 0) | (-1, 3) | (9, -3) | "
        "(-3, -9) | (16384, 3) | (16385, 3) | (9223372036854775807,) | (9223372036854775808,) | "
        "(4294967296, 4294967296) | (2, 2**62) | (0, 9223372036854775807) | (9223372036854775807, 0, 3) | [9, 3] | "
        "9 | (9.0, 3) | ('9', 3) | (9L, 3L) | None | (True, 3) | (9, 3"
    ).split(" | "),
    *("(9, 3" + ", 1" * 40 + ")", "(" + "1," * 3000 + ")", "(9" * 2000, "(" * 200 + ")" * 200, "1" * 4400),
    *("(" + "1" * 4400 + ",)",),
)
_KEYS = ("descr", "fortran_order", "shape")
_HEADERS = (
    *(
        "",
        "{}",
        "{" * 5000,
        "[" * 100 + "]" * 100,
        "-" * 5000 + "1",
        "1+" * 3000 + "1",
        "__import__('os').system('true')",
        "\0",
        "\n",
    ),
    *(
        "{'descr': '<f8'}",
        "'" + "x" * 9000 + "'",
        "{'descr':'<f8','fortran_order':False,'shape':(9,3),'x':1}",
        "9" * 9000,
        "\xff\xfe",
    ),
)
_FLOATS = (0.0, 1.0, -1.0, 1e29, 1e31, 1e99, 1e101, 1e308, -1e308, 5e-324, float("nan"), float("inf"), -float("inf"))
_NAMES = (
    *(
        "coefficients.npy | coefficients.npy | coefficients | stamp.npy | stamp | Coefficients.npy | "
        "coefficients.npy.npy | ../coefficients.npy | /etc/passwd | a/"
    ).split(" | "),
    *("", "a\\b.npy", "\x1b[2J\x1b]0;x\x07.npy", "new\nline.npy", "x" * 5000, "\u202e.npy", "\0x"),
)
_STAMPS = (
    "",
    "{}",
    "[]",
    "null",
    "[" * 3000,
    "{" * 90,
    '{"shviewer-coefficients": 1}',
    "NaN",
    "1" * 4400,
    '{"shviewer-coefficients": []}',
)


def spoilt_npy(data: bytes, random: Random) -> bytes:
    """An .npy with something else in its header, its payload, or both."""
    header, payload = _parted(data)
    for _ in range(random.choice((1, 1, 2, 3))):
        match random.randrange(8):
            case 0 | 1:
                header = _with(header, "descr", random.choice(_TYPES))
            case 2 | 3:
                header = _with(header, "shape", random.choice(_SHAPES))
            case 4:
                header = _with(header, "fortran_order", random.choice(_ORDERS))
            case 5:
                header = random.choice(
                    (*_HEADERS, header.replace(random.choice(_KEYS), random.choice(_KEYS)), header[:-9])
                )
            case 6:
                payload = random.choice(
                    (b"", payload[:-1], payload[: len(payload) // 2], payload * 2, payload + b"x", bytes(216))
                )
            case 7:
                place = 8 * random.randrange(1 + len(payload) // 8)
                payload = payload[:place] + struct.pack("<d", random.choice(_FLOATS)) + payload[place + 8 :]
    return _npy(header, payload, random)


def _parted(data: bytes) -> tuple[str, bytes]:
    size = struct.unpack_from("<H", data, 8)[0]
    return data[10 : 10 + size].decode("latin-1").strip(), data[10 + size :]


def _with(header: str, key: str, value: str) -> str:
    return re.sub(rf"'{key}': ('[^']*'|\([^)]*\)|\w+)", lambda _: f"'{key}': {value}", header, count=1)


def _npy(header: str, payload: bytes, random: Random) -> bytes:
    text = (header + "\n").encode("utf-8", "replace")
    version = random.choice(((1, 0),) * 6 + ((2, 0), (2, 0), (3, 0), (3, 0), (0, 0), (4, 0), (1, 1), (255, 255)))
    wide = version in ((2, 0), (3, 0))
    size = len(text) if random.random() < 0.9 else random.choice((0, 1, 65535, len(text) - 1, len(text) + 1, 2**32 - 1))
    length = struct.pack("<I", size % 2**32) if wide else struct.pack("<H", size % 2**16)
    return b"\x93NUMPY" + bytes(version) + length + text + payload


def spoilt_npz(data: bytes, random: Random) -> bytes:
    """An archive whose members, or what it says of them, are not what they were."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = [(name, archive.read(name)) for name in archive.namelist()]
    for _ in range(random.choice((0, 1, 1, 1, 2))):
        _change_member(members, random)
    made = _zip(members, random)
    for _ in range(random.choice((0, 0, 1, 1, 3))):
        _lie(made, random)
    match random.randrange(12):
        case 0:
            del made[random.randrange(len(made)) :]
        case 1:
            made[:0] = random.choice((b"PK", b"PK\3\4", b"x", b"#!/bin/sh\n", bytes(100)))
        case 2:
            made += random.choice((b"x", bytes(70_000), bytes(made[-22:]), b"PK\5\6" + bytes(18)))
    return bytes(made)


def _change_member(members: list[tuple[str, bytes]], random: Random) -> None:
    place = random.randrange(len(members))
    name, content = members[place]
    match random.randrange(9):
        case 0 | 1 | 2 if content.startswith(b"\x93NUMPY") and len(content) > 10 and name.endswith(".npy"):
            members[place] = name, spoilt_npy(content, random)
        case 3:
            members[place] = random.choice(_NAMES), content
        case 4:
            members.insert(place, (random.choice((name, *_NAMES)), content))
        case 5 if len(members) > 1:
            del members[place]
        case 6:
            members[place] = "stamp.npy", _stamp(random)
        case 7:
            members[place] = (
                name,
                random.choice(
                    (b"", b"\x93NUMPY", content[:100], bytes(2_000_000), members[0][1], b"PK\5\6" + bytes(18))
                ),
            )
        case 8:
            members += [(f"m{number}.npy", b"") for number in range(random.choice((1, 30, 3000)))]


def _stamp(random: Random) -> bytes:
    sound = {"shviewer-coefficients": 1, "convention": "shviewer", "quantity": "radiance", "bands": 3, "light": "green"}
    text = random.choice(_STAMPS)
    if random.random() < 0.7:
        text = spoilt_tree(json.dumps(sound).encode(), random).decode("utf-8", "replace")
    payload = text.encode("utf-32-le", "replace")
    header = f"{{'descr': '<U{max(1, len(text))}', 'fortran_order': False, 'shape': (), }}"
    return _npy(header, payload or bytes(4), random)


def _zip(members: list[tuple[str, bytes]], random: Random) -> bytearray:
    if random.random() < 0.03:
        return bytearray(_bomb())
    packing = random.choice(
        (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)
    )
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", packing, compresslevel=1) as archive:
        for name, content in members:
            information = zipfile.ZipInfo()
            information.filename = name
            information.compress_type = packing
            with warnings.catch_warnings(action="ignore"):  # of two members of one name
                archive.writestr(information, content)
        archive.comment = random.choice((b"",) * 9 + (b"\x1b[2J\n", b"x" * 60_000))
    return bytearray(file.getvalue())


@cache
def _bomb() -> bytes:
    """400 MB of zeros in 400 kB."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("coefficients.npy", "w") as member:
        member.write(
            b"\x93NUMPY\1\0\x40\0" + b"{'descr': '<f8', 'fortran_order': False, 'shape': (9, 3), }".ljust(63) + b"\n"
        )
        for _ in range(400):
            member.write(bytes(10**6))
    return file.getvalue()


def _lie(made: bytearray, random: Random) -> None:
    """One field of a local header, of the directory, or of its end."""
    signature, fields = random.choice(
        (
            (b"PK\3\4", ((4, 2), (6, 2), (8, 2), (14, 4), (18, 4), (22, 4), (26, 2), (28, 2))),
            (b"PK\1\2", ((6, 2), (8, 2), (10, 2), (16, 4), (20, 4), (24, 4), (28, 2), (30, 2), (32, 2), (42, 4))),
            (b"PK\5\6", ((4, 2), (8, 2), (10, 2), (12, 4), (16, 4), (20, 2))),
        )
    )
    places = [found.start() for found in re.finditer(re.escape(signature), bytes(made[: 2**16]))][:20]
    if not places:
        return
    offset, size = random.choice(fields)
    place = random.choice(places) + offset
    old = int.from_bytes(made[place : place + size], "little")
    value = random.choice(
        (0, 1, 8, 9, 12, 14, 95, 99, old + 1, old - 1, old ^ 0x800, 2 * old, 2**15, 2**31, 2**32 - 1, 100)
    )
    made[place : place + size] = (value % 256**size).to_bytes(size, "little")
