"""The headers of an OpenEXR file, read from the bytes, since the library cannot be asked for everything.

It silently puts a window of 64 x 64 in the place of a window that is missing or of another type.

Source: openexr.com, "OpenEXR File Layout": headers of name, type, size and value, each ended by an empty name; the
headers of a file of several parts are followed by an empty one.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from shviewer.errors import LightError

FIRST_HEADER = 8  # bytes; before it a magic number and the version field
TILED, LONG_NAMES, SEVERAL_PARTS = 0x200, 0x400, 0x1000  # flags of the version field
_LONGEST_NAME = 255
_MOST_ATTRIBUTES = 2**15  # of all parts; files of hundreds of passes have thousands
_MOST_OF_A_PART = 2**12  # the library takes a time that grows with their square: 0.1 s
_LONGEST_CHANNELS = 2**17  # bytes of the list of channels, which is as slow: 4000 channels of 15 letters
_OF_A_CHANNEL = 16  # bytes behind its name: type, flags and subsampling
_LONGEST_HEADERS = 2**24  # bytes; previews of a thousand texels a side are within


class Attribute(NamedTuple):
    """An attribute of a header, as its bytes."""

    kind: bytes
    """The name of its type, such as b"box2i"."""
    value: bytes


class RawHeader(NamedTuple):
    """The header of one part; start and end are offsets into the file, bytes."""

    start: int
    end: int
    attributes: dict[bytes, Attribute]

    def count(self, name: bytes) -> int:
        """The value of an attribute of type int that is not negative. Raises LightError for any other."""
        return count_in(self.attributes.get(name, Attribute(b"", b"")).value)

    def window(self, name: bytes) -> tuple[int, int, int, int]:
        """Left, top, right and bottom, both ends included. Raises LightError if they are not given or not in order."""
        kind, value = self.attributes.get(name, Attribute(b"", b""))
        shown = name.decode("ascii")
        if kind != b"box2i" or len(value) != 16:
            raise LightError(f"no {shown} in its header, so its size is not known; fetch or export the file again")
        left, top, right, bottom = struct.unpack("<4i", value)
        if right < left or bottom < top:
            raise LightError(
                f"{shown} from ({left}, {top}) to ({right}, {bottom}) ends before it begins; export the file again"
            )
        return left, top, right, bottom


def read_attributes(data: bytes) -> list[RawHeader]:
    """The header of every part. Raises LightError if the bytes end before the headers do, or they have no end."""
    headers = [_header(data, FIRST_HEADER, _MOST_ATTRIBUTES)]
    left = _MOST_ATTRIBUTES - len(headers[0].attributes)
    if count_in(data[4:FIRST_HEADER]) & SEVERAL_PARTS:
        while data[headers[-1].end : headers[-1].end + 1] != b"\0":
            headers.append(_header(data, headers[-1].end, left))
            left -= len(headers[-1].attributes)
    return headers


def count_in(field: bytes) -> int:
    """Four bytes as an integer. LightError if it is negative, or the bytes are not four."""
    if len(field) != 4 or field[3] > 127:
        raise broken("a count in a header is none")
    return int.from_bytes(field, "little")


def channels_in(value: bytes) -> list[tuple[bytes, bytes]]:
    """The name of each channel and what is said of it. LightError if the list does not end."""
    channels, at = [], 0
    while value[at : at + 1] not in (b"\0", b""):
        end = value.find(b"\0", at)
        if end < 0 or end + 1 + _OF_A_CHANNEL > len(value):
            raise broken("its list of channels does not end")
        channels.append((value[at:end], value[end + 1 : end + 1 + _OF_A_CHANNEL]))
        at = end + 1 + _OF_A_CHANNEL
    return channels


def broken(reason: str) -> LightError:
    """The error for bytes that contradict themselves."""
    return LightError(f"damaged or cut short: {reason}; fetch or export the file again")


def _header(data: bytes, start: int, most: int) -> RawHeader:
    """The header at `start`, of at most `most` attributes."""
    attributes: dict[bytes, Attribute] = {}
    at = start
    for _ in range(min(most, _MOST_OF_A_PART) + 1):
        name, at = _text(data, at)
        if not name:
            return RawHeader(start, at, attributes)
        kind, at = _text(data, at)
        size = count_in(data[at : at + 4])
        at += 4
        if at + size > len(data):
            raise broken("an attribute ends behind the end of the file")
        if at + size > _LONGEST_HEADERS or (kind == b"chlist" and size > _LONGEST_CHANNELS):
            what = "channels" if kind == b"chlist" else "metadata"
            raise LightError(f"headers with {size} bytes of {what} at byte {at}; export it with less of them")
        attributes[name] = Attribute(kind, data[at : at + size])  # the last counts, for the library's windows too
        at += size
    raise LightError(
        f"more than {_MOST_OF_A_PART} attributes in a header, or {_MOST_ATTRIBUTES} in all; export it without metadata"
    )


def _text(data: bytes, at: int) -> tuple[bytes, int]:
    end = data.find(b"\0", at, at + _LONGEST_NAME + 1)
    if end < 0:
        raise broken("a header does not end")
    return data[at:end], end + 1
