"""The headers of an OpenEXR file as plain Python objects, with the fields that matter here."""

from __future__ import annotations

from types import ModuleType
from typing import Any, NamedTuple

from shviewer.lights.images.openexr_attributes import RawHeader, channels_in, read_attributes
from shviewer.lights.images.openexr_library import damaged, open_openexr

_HALF = 1  # a pixel type in the file


class Window(NamedTuple):
    """A rectangle of texels, y downwards, both ends included as in the file."""

    left: int
    top: int
    right: int
    bottom: int

    @property
    def width(self) -> int:
        return self.right - self.left + 1

    @property
    def height(self) -> int:
        return self.bottom - self.top + 1


class Channel(NamedTuple):
    """One channel of a part."""

    name: str
    subsampling: tuple[int, int]
    """The steps in x and y between samples, counted from 0 in the file's coordinates."""
    value_bytes: int
    """The bytes of a value: 2 of a half float."""


class Part(NamedTuple):
    """One image of the file; most files have one."""

    name: str
    deep: bool
    storage: tuple[str, ...]
    """How the texels are stored, such as ("PIZ", "tiled", "mip-mapped")."""
    layout: str | None
    """The layout in the envmap attribute: "lat-long" or "cube"; None without the attribute."""
    chromaticities: tuple[float, ...] | None
    """CIE x and y of red, green, blue and white, eight numbers; None: those of Rec. 709."""
    window: Window
    """The rectangle for which the file has data."""
    display: Window
    """The rectangle that the image is meant to show."""
    channels: tuple[Channel, ...]
    tile: tuple[int, int] | None
    """Texels across and down of each tile, on every level; None for scanlines."""

    @property
    def samples(self) -> int:
        """The number of values in all channels of the finest level."""
        return sum(map(self._samples, self.channels))

    @property
    def plane_bytes(self) -> int:
        """The bytes of these values as the library gives them."""
        return sum(channel.value_bytes * self._samples(channel) for channel in self.channels)

    def _samples(self, channel: Channel) -> int:
        across, down = channel.subsampling
        return -(-self.window.width // across) * -(-self.window.height // down)


def read_headers(openexr: ModuleType, data: bytes) -> tuple[Part, ...]:
    """Every part, without its pixels. LightError if a header is damaged."""
    raw = read_attributes(data)
    windows = [(Window(*own.window(b"dataWindow")), Window(*own.window(b"displayWindow"))) for own in raw]
    file = open_openexr(openexr, data, header_only=True)
    if len(raw) != len(file.parts):
        raise damaged(f"{len(file.parts)} parts where there are {len(raw)} headers")
    try:  # the library converts an attribute when it is asked for: UnicodeDecodeError, KeyError, ...
        headers = [part.header for part in file.parts]
        shared = _chromaticities(openexr, headers[0])  # one attribute for all parts, often in the first only
        kinds = [_pixel_types(own) for own in raw]
        return tuple(_plain(openexr, *three, shared) for three in zip(headers, windows, kinds, strict=True))
    except Exception as error:
        raise damaged(f"header unreadable ({error})") from None


def _plain(
    openexr: ModuleType,
    header: dict[str, Any],
    windows: tuple[Window, Window],
    kinds: dict[bytes, int],
    chromaticities: tuple[float, ...] | None,
) -> Part:
    """The part that a header of the library describes. windows: the data window and the display window.

    kinds: the pixel type of each channel.
    """
    tiles = header.get("tiles")
    return Part(
        name=str(header.get("name", "")),
        deep=header.get("type") in (openexr.deepscanline, openexr.deeptile),
        storage=_storage(openexr, header),
        layout={openexr.ENVMAP_LATLONG: "lat-long", openexr.ENVMAP_CUBE: "cube"}.get(header.get("envmap")),
        chromaticities=_chromaticities(openexr, header) or chromaticities,
        window=windows[0],
        display=windows[1],
        channels=tuple(
            Channel(
                channel.name,
                (max(1, channel.xSampling), max(1, channel.ySampling)),
                2 if kinds[channel.name.encode()] == _HALF else 4,
            )
            for channel in header["channels"]
        ),
        tile=None if tiles is None else (int(tiles.xSize), int(tiles.ySize)),
    )


def _pixel_types(header: RawHeader) -> dict[bytes, int]:
    """The pixel type of each channel, which the library does not tell before it decodes."""
    channels = channels_in(header.attributes[b"channels"].value)
    return {name: int.from_bytes(rest[:4], "little") for name, rest in channels}


def _storage(openexr: ModuleType, header: dict[str, Any]) -> tuple[str, ...]:
    codec = header["compression"]
    words = ["uncompressed" if codec == openexr.NO_COMPRESSION else codec.name.removesuffix("_COMPRESSION")]
    if "tiles" in header:
        words.append("tiled")
        levels = {openexr.MIPMAP_LEVELS: "mip-mapped", openexr.RIPMAP_LEVELS: "rip-mapped"}
        words += [levels[header["tiles"].mode]] if header["tiles"].mode in levels else []
    return tuple(words)


def _chromaticities(openexr: ModuleType, header: dict[str, Any]) -> tuple[float, ...] | None:
    """Chromaticities from the attribute of that name, else from a linear colour space named in colorInteropID."""
    values = header.get("chromaticities")
    if values is None and "colorInteropID" in header:
        values = openexr.colorInteropIDToChromaticities(header["colorInteropID"])
    return None if values is None else tuple(float(value) for value in values)
