"""An OpenEXR file whose strings are all UTF-8, which the library wants of them; the format prescribes no encoding.

Bytes that are no UTF-8 are taken for Latin-1, in which every byte is a letter and the order of names stays what it is:
channels lie in the file in the order of their names. Headers grow by that, so the offsets of the chunks are moved.

Source: openexr.com, "OpenEXR File Layout".
"""

from __future__ import annotations

import struct

import numpy as np

from shviewer.lights.images.openexr_attributes import Attribute, RawHeader, broken, read_attributes

_LONG_NAMES, _SEVERAL_PARTS = 0x400, 0x1000  # flags of the version field
_FIRST_HEADER = 8  # bytes; before it a magic number and the version field
_OF_A_CHANNEL = 16  # bytes behind its name: type, flags and subsampling


def with_readable_strings(data: bytes) -> bytes:
    """The file itself if its strings are UTF-8; else the same texels with strings that are. LightError for broken headers."""
    headers = read_attributes(data)
    if all(_is_readable(*item) for header in headers for item in header.attributes.items()):
        return data
    written = b"".join(_written(header) for header in headers)
    version = int.from_bytes(data[4:8], "little")
    several = version & _SEVERAL_PARTS
    old_table = headers[-1].end + (1 if several else 0)
    new_table = _FIRST_HEADER + len(written) + (1 if several else 0)
    offsets = np.frombuffer(data, "<u8", (len(data) - old_table) // 8, old_table)
    # The chunks follow the tables: these end where the first of the chunks that they list begins.
    ends = old_table + 8 * (1 + np.arange(len(offsets), dtype=np.uint64))
    count = int(np.argmax(ends >= np.minimum.accumulate(offsets))) + 1 if len(offsets) else 0
    moved = (offsets[:count].view("<i8") + (new_table - old_table)).tobytes()
    head = data[:4] + struct.pack("<I", version | _LONG_NAMES) + written + (b"\0" if several else b"")
    return b"".join([head, moved, data[old_table + 8 * count :]])


def _is_readable(name: bytes, attribute: Attribute) -> bool:
    return all(map(_is_utf8, (name, attribute.kind, *_strings(attribute))))


def _strings(attribute: Attribute) -> list[bytes]:
    match attribute.kind:
        case b"string":
            return [attribute.value]
        case b"stringvector":
            return _of_vector(attribute.value)
        case b"chlist":
            return [name for name, _ in _channels(attribute.value)]
    return []


def _written(header: RawHeader) -> bytes:
    """The header with readable strings."""
    parts = []
    for name, attribute in header.attributes.items():
        kind, value = attribute
        if kind == b"string":
            value = _utf8(value)
        elif kind == b"stringvector":
            value = b"".join(struct.pack("<i", len(text)) + text for text in map(_utf8, _of_vector(value)))
        elif kind == b"chlist":
            channels = _channels(value)
            as_they_are = all(_is_utf8(channel) for channel, _ in channels)
            entries = [(channel if as_they_are else _from_latin1(channel)) + b"\0" + rest for channel, rest in channels]
            value = b"".join(entries) + b"\0"
        parts += [_utf8(name), b"\0", _utf8(kind), b"\0", struct.pack("<i", len(value)), value]
    return b"".join(parts) + b"\0"


def _of_vector(value: bytes) -> list[bytes]:
    texts, at = [], 0
    while at + 4 <= len(value):
        size = int.from_bytes(value[at : at + 4], "little")
        texts.append(value[at + 4 : at + 4 + size])
        at += 4 + size
    return texts


def _channels(value: bytes) -> list[tuple[bytes, bytes]]:
    """The name of each channel and what is said of it."""
    channels, at = [], 0
    while value[at : at + 1] not in (b"\0", b""):
        end = value.find(b"\0", at)
        if end < 0 or end + 1 + _OF_A_CHANNEL > len(value):
            raise broken("its list of channels does not end")
        channels.append((value[at:end], value[end + 1 : end + 1 + _OF_A_CHANNEL]))
        at = end + 1 + _OF_A_CHANNEL
    return channels


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
