"""An OpenEXR file whose strings are all UTF-8, which the library wants of them; the format prescribes no encoding.

Bytes that are no UTF-8 are taken for Latin-1, in which every byte is a letter and the order of names stays what it is:
channels lie in the file in the order of their names. Headers grow by that, so the offsets of the chunks are moved.

Source: openexr.com, "OpenEXR File Layout".
"""

from __future__ import annotations

import struct

import numpy as np

from shviewer.lights.images.openexr_attributes import (
    FIRST_HEADER,
    LONG_NAMES,
    SEVERAL_PARTS,
    Attribute,
    channels_in,
    read_attributes,
)


def with_readable_strings(data: bytes) -> bytes:
    """The file itself if its strings are UTF-8; else the same texels with strings that are. LightError for broken headers."""
    headers = read_attributes(data)
    stored = [list(header.attributes.items()) for header in headers]
    readable = [[_readable(*item) for item in items] for items in stored]
    if readable == stored:
        return data
    version = int.from_bytes(data[4:8], "little")
    end = b"\0" if version & SEVERAL_PARTS else b""
    written = b"".join(map(_written, readable)) + end
    old_table = headers[-1].end + len(end)
    new_table = FIRST_HEADER + len(written)
    offsets = np.frombuffer(data, "<u8", (len(data) - old_table) // 8, old_table)
    # The chunks follow the tables: these end where the first of the chunks that they list begins.
    ends = old_table + 8 * (1 + np.arange(len(offsets), dtype=np.uint64))
    count = int(np.argmax(ends >= np.minimum.accumulate(offsets))) + 1 if len(offsets) else 0
    moved = (offsets[:count].view("<i8") + (new_table - old_table)).tobytes()
    head = data[:4] + struct.pack("<I", version | LONG_NAMES) + written
    return b"".join([head, moved, data[old_table + 8 * count :]])


def _readable(name: bytes, attribute: Attribute) -> tuple[bytes, Attribute]:
    kind, value = attribute
    if kind == b"string":
        value = _utf8(value)
    elif kind == b"stringvector":
        texts = _texts(value)
        if not all(map(_is_utf8, texts)):
            value = b"".join(struct.pack("<i", len(text)) + text for text in map(_utf8, texts))
    elif kind == b"chlist":
        channels = channels_in(value)
        if not all(_is_utf8(channel) for channel, _ in channels):  # all of them, to keep their order
            value = b"".join(_from_latin1(channel) + b"\0" + rest for channel, rest in channels) + b"\0"
    return _utf8(name), Attribute(_utf8(kind), value)


def _written(attributes: list[tuple[bytes, Attribute]]) -> bytes:
    """A header of these attributes."""
    parts = [name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value for name, (kind, value) in attributes]
    return b"".join(parts) + b"\0"


def _texts(value: bytes) -> list[bytes]:
    texts, at = [], 0
    while at + 4 <= len(value):
        size = int.from_bytes(value[at : at + 4], "little")
        texts.append(value[at + 4 : at + 4 + size])
        at += 4 + size
    return texts


def _is_utf8(text: bytes) -> bool:
    try:
        text.decode()
    except UnicodeDecodeError:
        return False
    return True


def _utf8(text: bytes) -> bytes:
    return text if _is_utf8(text) else _from_latin1(text)


def _from_latin1(text: bytes) -> bytes:
    return text.decode("latin-1").encode()
