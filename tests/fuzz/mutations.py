"""Ways to spoil a file: anywhere in its bytes, in the header lines of .hdr, the attributes of .exr, the chunks of .png."""

from __future__ import annotations

import re
import struct
import zlib
from collections.abc import Callable
from random import Random

_BYTES = (0, 1, 2, 127, 128, 129, 255)
_INTEGERS = (0, 1, -1, 2, 255, 256, 32767, 32768, 65535, 2**31 - 1, -(2**31), 2**24, 10**9)
_LONGEST_BLOCK = 64
_LONGEST_FILE = 16384

_SIZES = (
    b"0",
    b"-1",
    b"1",
    b"7",
    b"8",
    b"32767",
    b"32768",
    b"2147483648",
    b"1000000000000000000",
    b"1e3",
    b"",
    b"0x10",
    b"+5",
)
_HDR_LINES = (
    *(
        b"EXPOSURE=" + value
        for value in (b"nan", b"inf", b"0", b"-1", b"1e-300", b"1e300", b"1e-40", b"", b"1 2", b"x")
    ),
    *(b"COLORCORR=" + value for value in (b"1 1", b"0 0 0", b"nan 1 1", b"1 2 3 4", b"1e200 1e200 1e200")),
    *(
        b"PRIMARIES=" + value
        for value in (b"0 0 0 0 0 0 0 0", b".64 .33 .3 .6 .15 .06 0 0", b"nan", b"1 1 1 1 1 1 1 1", b"9 9")
    ),
    b"FORMAT=32-bit_rle_xyze",
    b"FORMAT=32-bit_rle_rgbe",
    b"FORMAT=",
    b"PIXASPECT=0",
    b"",
    b"#?RADIANCE",
    b"\0" * 300,
    b"=" * 70000,
)
_PNG_CHUNKS = (
    b"IHDR",
    b"PLTE",
    b"IDAT",
    b"IEND",
    b"tRNS",
    b"gAMA",
    b"cHRM",
    b"sRGB",
    b"iCCP",
    b"cICP",
    b"acTL",
    b"fcTL",
    b"fdAT",
)

Mutation = Callable[[bytearray, Random, bytes], None]
"""Changes the file in place; the last argument is another seed of the same kind."""


def mutated(seed: bytes, kind: str, random: Random, other: bytes) -> bytes:
    """A copy with one to six things changed; `kind` is the suffix of its name."""
    data = bytearray(seed)
    ways = _ANYWHERE + _OF_KIND.get(kind, ())
    for _ in range(random.choice((1, 1, 2, 3, 6))):
        if data:
            random.choice(ways)(data, random, other)
    if kind == ".png" and random.random() < 0.8:  # else nearly all are refused for their checksums alone
        _repair_checksums(data)
    return bytes(data[:_LONGEST_FILE]) if len(seed) < _LONGEST_FILE else bytes(data)


def spoilt_anywhere(data: bytearray, random: Random, other: bytes) -> None:
    """One to six changes of bytes, whatever they mean."""
    for _ in range(random.choice((1, 1, 2, 3, 6))):
        if data:
            random.choice(_ANYWHERE)(data, random, other)


def _flip_bit(data: bytearray, random: Random, other: bytes) -> None:
    data[random.randrange(len(data))] ^= 1 << random.randrange(8)


def _set_byte(data: bytearray, random: Random, other: bytes) -> None:
    data[random.randrange(len(data))] = random.choice((*_BYTES, random.randrange(256)))


def _set_integer(data: bytearray, random: Random, other: bytes) -> None:
    size = random.choice((2, 4, 4, 8))
    value = random.choice(_INTEGERS) + random.choice((0, 0, -1, 1))
    place = random.randrange(len(data))
    number = (value % 256**size).to_bytes(size, random.choice(("little", "big")))
    data[place : place + size] = number[: len(data) - place]


def _delete(data: bytearray, random: Random, other: bytes) -> None:
    del data[_block(data, random)]


def _duplicate(data: bytearray, random: Random, other: bytes) -> None:
    block = _block(data, random)
    data[block.start : block.start] = data[block] * random.choice((1, 1, 2, 30))


def _insert(data: bytearray, random: Random, other: bytes) -> None:
    place = random.randrange(len(data) + 1)
    length = random.randrange(1, _LONGEST_BLOCK)
    data[place:place] = random.choice((random.randbytes(length), bytes(length), b"\xff" * length))


def _swap(data: bytearray, random: Random, other: bytes) -> None:
    first, second = sorted((_block(data, random), _block(data, random)), key=lambda block: block.start)
    if first.stop <= second.start:
        data[first.start : second.stop] = data[second] + data[first.stop : second.start] + data[first]


def _truncate(data: bytearray, random: Random, other: bytes) -> None:
    del data[random.randrange(len(data)) :]


def _splice(data: bytearray, random: Random, other: bytes) -> None:
    """The beginning of this file and the end of another, cut at about the same share of each."""
    share = random.random()
    data[int(share * len(data)) :] = other[int(share * len(other)) + random.choice((0, 0, -4, 3)) :]


def _block(data: bytearray, random: Random) -> slice:
    start = random.randrange(len(data))
    return slice(start, min(len(data), start + random.randrange(1, _LONGEST_BLOCK)))


def _edit_size_line(data: bytearray, random: Random, other: bytes) -> None:
    if found := re.search(rb"\n([+-][XY]) *(\S*) ([+-][XY]) *(\S*)\r?\n", data):
        axes = random.choice((b"-Y", b"+Y", b"-X", b"+X")), found[1], found[3]
        sizes = random.choice(_SIZES), found[2], found[4]
        line = b" ".join((random.choice(axes), random.choice(sizes), random.choice(axes), random.choice(sizes)))
        data[found.start() + 1 : found.end()] = line + b"\n"


def _edit_header_line(data: bytearray, random: Random, other: bytes) -> None:
    ends = [found.end() for found in re.finditer(rb"\n", data[:400])][:6]
    if ends:
        place = random.choice(ends)
        if random.random() < 0.3:
            del data[place : data.find(b"\n", place) + 1 or len(data)]
        data[place:place] = random.choice(_HDR_LINES) + random.choice((b"\n", b"\n", b"\r\n", b""))


def _edit_attribute(data: bytearray, random: Random, other: bytes) -> None:
    """One attribute of the first header: its value, its size, its name, or all of it."""
    attributes = _attributes(data)
    if not attributes:
        return
    start, value, end = random.choice(attributes)
    match random.randrange(7):
        case 0 | 1 | 2 if end >= value + 4:
            place = value + 4 * random.randrange((end - value) // 4)
            data[place : place + 4] = (random.choice(_INTEGERS) % 2**32).to_bytes(4, "little")
        case 3 if end > value:
            data[random.randrange(value, end)] = random.choice(_BYTES)
        case 4:
            data[value - 4 : value] = (random.choice(_INTEGERS) % 2**32).to_bytes(4, "little")
        case 5:
            data[start:start] = data[start:end]
        case 6:
            del data[start:end]


def _attributes(data: bytearray) -> list[tuple[int, int, int]]:
    """Where each begins, where its value begins, and where it ends."""
    attributes, start = [], 8
    while start < len(data) and data[start]:
        kind = data.find(b"\0", start) + 1
        size = data.find(b"\0", kind) + 1
        if kind == 0 or size == 0 or size + 4 > len(data):
            break
        end = size + 4 + struct.unpack_from("<i", data, size)[0]
        if not size + 4 <= end <= len(data):
            break
        attributes.append((start, size + 4, end))
        start = end
    return attributes


def _edit_chunk(data: bytearray, random: Random, other: bytes) -> None:
    """One chunk: its type, its content, or all of it."""
    chunks = _chunks(data)
    if not chunks:
        return
    start, end = random.choice(chunks)
    match random.randrange(5):
        case 0:
            data[start + 4 : start + 8] = random.choice(_PNG_CHUNKS)
        case 1 | 2 if end - start > 12:
            data[random.randrange(start + 8, end - 4)] = random.choice((*_BYTES, 3, 4, 6, 8, 16))
        case 3:
            data[start:start] = data[start:end]
        case 4:
            del data[start:end]


def _repair_checksums(data: bytearray) -> None:
    for start, end in _chunks(data):
        data[end - 4 : end] = zlib.crc32(data[start + 4 : end - 4]).to_bytes(4, "big")


def _chunks(data: bytearray) -> list[tuple[int, int]]:
    """Where each begins and ends."""
    chunks, start = [], 8
    while start + 12 <= len(data):
        end = start + 12 + int.from_bytes(data[start : start + 4], "big")
        if end > len(data):
            break
        chunks.append((start, end))
        start = end
    return chunks


_ANYWHERE: tuple[Mutation, ...] = (
    *(_flip_bit, _set_byte, _set_integer) * 2,
    _delete,
    _duplicate,
    _insert,
    _swap,
    _truncate,
    _splice,
)
_OF_KIND: dict[str, tuple[Mutation, ...]] = {
    ".hdr": (_edit_size_line, _edit_header_line),
    ".exr": (_edit_attribute,) * 5,
    ".png": (_edit_chunk,) * 4,
}
