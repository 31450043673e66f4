"""The segments of a JPEG: where its first image ends, whether it is whole, what stands in its markers, what follows it.

Phones put videos, previews and gain maps behind the image, and some programs leave the end marker out. So the markers are
walked, and the scans of the first image alone are handed on, with an end of our own.

The format has no checksum and no length of its scans, and libjpeg fills what is missing with grey. Whether something is
missing shows when other bytes stand behind the last scan: they change the picture only if the decoder still needs some.

Source
    [JPEG] ITU-T T.81, annex B (markers and segments) and G.1 (progressive scans)
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from shviewer.errors import LightError
from shviewer.lights.images.display.codes import damaged

_SOI, _EOI, _SOS, _DRI, _APP1, _APP2 = 0xD8, 0xD9, 0xDA, 0xDD, 0xE1, 0xE2
_NEXT = re.compile(rb"\xff+([\x01-\xfe])")
_NEXT_AFTER_SCAN = re.compile(rb"\xff+([\x01-\xcf\xd8-\xfe])")  # within a scan stand 0 and restarts
_RST0 = 0xD0
_LAST_RESTART = re.compile(rb".*\xff([\xd0-\xd7])", re.DOTALL)
_ALONE = (0x01, *range(0xD0, 0xD8))  # markers without a segment
_FRAMES = (*range(0xC0, 0xC4), *range(0xC5, 0xC8), *range(0xC9, 0xCC), *range(0xCD, 0xD0))
_PROGRESSIVE = (0xC2, 0xC6, 0xCA, 0xCE)
_ARITHMETIC = range(0xC9, 0xD0)
_MOST_SCANS = 100  # encoders write about ten, each of which goes over the whole image
_FILLER = bytes((i * 89 + 173) % 255 for i in range(510))  # no marker; its first bit is not that of libjpeg's filling
_END = b"\xff\xd9"
_XMP = b"http://ns.adobe.com/xap/1.0/\0"
_FOLLOWING = 16  # images behind the first that are looked at


class Jpeg(NamedTuple):
    """One image within a file."""

    data: bytes
    """From its first marker to the end of its last scan, and an end marker."""
    end: int
    """The offset in the file of what follows it."""
    arithmetic: bool
    """Its coding, of which no part can be told to be missing: the encoder leaves out zeros at the end."""
    app2: tuple[bytes, ...]
    """The contents of its segments of that name: profiles, gain maps, lists of pictures."""
    xmp: bytes
    """Its XMP packet; empty for none."""
    restart: int
    """The number, 0 to 7, of the restart that would come next."""

    @property
    def followed(self) -> bytes:
        """The same image with bytes and restarts behind its last scan that a whole image does without."""
        restarts = [bytes((0xFF, _RST0 + (self.restart + i) % 8)) + _FILLER for i in range(8)]
        return b"".join([self.data.removesuffix(_END), _FILLER, *restarts, _END])


def read_jpeg(file: bytes, start: int = 0) -> Jpeg:
    """The image that begins at `start`. LightError if it is cut short between its markers."""
    position, app2, xmp, scans_end = start + 2, [], b"", 0
    last_scan, restarts = 0, False
    frame: _Frame | None = None
    while found := _NEXT.search(file, position):
        marker, position = found[1][0], found.end()
        if marker in (_EOI, _SOI):
            position = position if marker == _EOI else found.start()  # some leave out the end before the next image
            break
        if marker in _ALONE:
            continue
        size = int.from_bytes(file[position : position + 2], "big")
        content = file[position + 2 : position + size]
        if size < 2 or len(content) != size - 2:
            raise damaged(f"the segment at byte {position - 2} goes past the end of the file")
        position += size
        if marker in _FRAMES:
            if frame is not None:
                raise damaged("another image before its end")
            frame = _Frame(marker, content)
        elif marker == _APP2:
            app2.append(content)
        elif marker == _APP1 and content.startswith(_XMP):
            xmp = xmp or content[len(_XMP) :]
        elif marker == _DRI:
            restarts = any(content)
        elif marker == _SOS and frame is not None:
            frame.add_scan(content)
            last_scan = position
            after = _NEXT_AFTER_SCAN.search(file, position)
            scans_end = position = after.start() if after else len(file)
    if frame is None or not scans_end:
        raise damaged("no image before its end")
    if not frame.is_whole():
        raise damaged("it ends before its last scan")
    restarted = _LAST_RESTART.match(file, last_scan, scans_end) if restarts else None
    restart = restarted[1][0] - _RST0 + 1 if restarted else 0
    return Jpeg(file[start:scans_end] + _END, position, frame.marker in _ARITHMETIC, tuple(app2), xmp, restart)


def following_images(file: bytes, first: Jpeg) -> Iterator[Jpeg]:
    """The whole images behind the first, wherever they stand."""
    place = first.end
    for _ in range(_FOLLOWING):
        place = file.find(b"\xff\xd8\xff", place)
        if place < 0:
            return
        try:
            image = read_jpeg(file, place)
        except LightError:
            place += 1
        else:
            place = image.end
            yield image


class _Frame:
    """The components of an image, and which bits of which coefficients its scans have brought."""

    def __init__(self, marker: int, header: bytes) -> None:
        components = header[6 : 6 + 3 * header[5] : 3] if len(header) > 5 else b""
        self.marker = marker
        self.scans = 0
        self.left = {component: [14] * 64 for component in components}  # bits that have not come, of each coefficient

    def add_scan(self, content: bytes) -> None:
        self.scans += 1
        if self.scans > _MOST_SCANS:
            raise damaged(f"more than {_MOST_SCANS} scans; no picture needs as many")
        count = content[0] if content else 0
        if len(content) < 4 + 2 * count:
            raise damaged("the header of a scan is too short")
        first, last, bits = content[1 + 2 * count :][:3] if self.marker in _PROGRESSIVE else (0, 63, 0)
        for component in content[1 : 1 + 2 * count : 2]:
            for i in range(first, min(last, 63) + 1):
                if component in self.left:
                    self.left[component][i] = bits & 15

    def is_whole(self) -> bool:
        """Whether the scans have brought every bit. The format demands less, but nobody writes less."""
        return bool(self.left) and not any(map(any, self.left.values()))
