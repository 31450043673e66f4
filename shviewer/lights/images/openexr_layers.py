"""The choice of the channels of an OpenEXR file that hold radiance, by their names or the layer that the user names.

A channel "diffuse.R" is R of the layer "diffuse"; layers nest ("key.diffuse.R"). In a file of several parts each part has
a name too, and a layer is named "part:layer", or "part" for the channels of that part that are in no layer.

Programs call channels other names as well: r, Red, [red], a layer without a name (".R"), one channel alone. Those are read,
with a note, where nothing has the names of the format.
"""

from __future__ import annotations

from typing import NamedTuple

from shviewer.errors import LightError
from shviewer.lights.images.openexr_headers import Part

_RGB, _LUMINANCE_CHROMA, _LUMINANCE = ("R", "G", "B"), ("Y", "RY", "BY"), ("Y",)
_COLOURS = {"r": "R", "red": "R", "g": "G", "green": "G", "b": "B", "blue": "B"}
_GREYS = {"y", "l", "gray", "grey", "luminance", "luma", "intensity", *_COLOURS}  # if there is no other channel
_ALPHA = {"a", "alpha"}
_SHOWN = 12  # names in an error


class Source(NamedTuple):
    """The part, the layer and the channels that hold the radiance."""

    part: int
    layer: str
    """"" for channels without a layer."""
    kind: tuple[str, ...]
    """What the channels are: R, G, B; Y, RY, BY; or Y alone."""
    channels: tuple[str, ...]
    """Their names in the file."""
    usual: bool = True
    """Whether they have the names of the format."""

    @property
    def grey(self) -> bool:
        return self.kind == _LUMINANCE

    @property
    def luminance_chroma(self) -> bool:
        return self.kind == _LUMINANCE_CHROMA


def find_source(parts: tuple[Part, ...], layer: str = "") -> tuple[Source, tuple[str, ...]]:
    """The channels to read, and notes on the choice.

    layer: "diffuse", "part:diffuse" or "part"; "" for the colours without a layer, else the only layer that has
    colours, else the only luminance.
    Raises LightError if there is no such layer or more than one, or if it is deep.
    """
    sources = [source for i, part in enumerate(parts) for source in _sources(i, part)]
    notes: tuple[str, ...] = ()
    if layer:
        found = _named(sources, parts, layer)
    else:
        flat = [source for source in sources if not parts[source.part].deep]
        found = _unnamed(flat or sources)
    if not found:
        raise _nothing(sources, parts, layer)
    if len(found) > 1:
        names = _listed([_label(source, parts) for source in found])
        raise LightError(f"{len(found)} layers to choose from: {names}; name one with FILE.exr:LAYER")
    (source,) = found
    part = parts[source.part]
    if part.deep:
        raise _deep(part)
    needed = source.channels[:1] if source.luminance_chroma else source.channels
    coarse = [_plain(c.name) for c in part.channels if c.name in needed and c.subsampling != (1, 1)]
    if coarse:
        raise LightError(f"subsampled channels {', '.join(coarse)}; one value per texel is needed: export it as RGB")
    if source.layer and not layer:
        what = "luminance" if source.grey else "colours"
        notes = (f"layer {_plain(_label(source, parts))} read, the only one with {what}",)
    if not source.usual:
        taken = "channel {} taken for grey" if source.grey else "channels {} taken for red, green and blue"
        notes += (taken.format(_listed(list(source.channels))),)
    return source, notes


def _sources(i: int, part: Part) -> list[Source]:
    """A source for each layer of a part that has colours or a luminance."""
    layers: dict[str, dict[str, str]] = {}
    for channel in part.channels:
        layer, name = _layer_and_name(channel.name)
        names = layers.setdefault(layer, {})
        if name not in names or name == channel.name:  # "R" comes before ".R"
            names[name] = channel.name
    found = (_source(i, layer, names) for layer, names in layers.items())
    return [source for source in found if source]


def _layer_and_name(channel: str) -> tuple[str, str]:
    """ "key.diffuse.R" -> "key.diffuse", "R"; "diffuse[red]" -> "diffuse", "red"; ".R" -> "", "R"."""
    if channel.endswith("]") and "[" in channel:
        layer, _, name = channel[:-1].rpartition("[")
        return layer.removesuffix("."), name
    layer, _, name = channel.rpartition(".")
    return layer, name


def _source(i: int, layer: str, names: dict[str, str]) -> Source | None:
    """The source in a layer; names: of each channel within the layer, and in the file."""
    for kind in (_RGB, _LUMINANCE_CHROMA, _LUMINANCE):
        if names.keys() >= set(kind) and not (kind == _LUMINANCE and "X" in names):  # X, Y, Z: a vector
            return Source(i, layer, kind, tuple(names[name] for name in kind))
    colours = {_COLOURS[name.lower()]: channel for name, channel in names.items() if name.lower() in _COLOURS}
    if colours.keys() == set(_RGB):
        return Source(i, layer, _RGB, tuple(colours[name] for name in _RGB), usual=False)
    others = [name for name in names if name.lower() not in _ALPHA]
    if len(others) == 1 and others[0].lower() in _GREYS:
        return Source(i, layer, _LUMINANCE, (names[others[0]],), usual=False)
    return None


def _unnamed(sources: list[Source]) -> list[Source]:
    """The best sources if no layer is named: usual names, then colours before grey, then no layer before layers."""
    ranked = [(not source.usual, source.grey, source.layer != "") for source in sources]
    return [source for source, rank in zip(sources, ranked, strict=True) if rank == min(ranked)]


def _named(sources: list[Source], parts: tuple[Part, ...], layer: str) -> list[Source]:
    """The sources with this full name; else with this name of the layer; else with this name of the part."""
    by_label = [source for source in sources if layer in _spellings(_label(source, parts))]
    by_layer = [source for source in sources if layer in _spellings(source.layer)]
    by_part = [source for source in sources if len(parts) > 1 and layer in _spellings(parts[source.part].name)]
    return by_label or by_layer or by_part


def _spellings(name: str) -> tuple[str, str]:
    """A name as it is, and as it is shown, if the one cannot be typed."""
    return name, _plain(name)


def _label(source: Source, parts: tuple[Part, ...]) -> str:
    """The name by which a user can ask for a source."""
    part = parts[source.part].name if len(parts) > 1 else ""
    return ":".join(filter(None, (part, source.layer)))


def _nothing(sources: list[Source], parts: tuple[Part, ...], layer: str) -> LightError:
    names = [_label(source, parts) for source in sources]
    if layer and any(names):
        return LightError(
            f"no layer {_plain(layer)} with colours or luminance; there are {_listed(list(filter(None, names)))}:"
            " name one of them"
        )
    if layer and names:
        return LightError(f"no layer {_plain(layer)}; it has no layers at all: leave the name out")
    for part in parts:
        if part.deep:
            return _deep(part)
    return LightError(f"no R, G and B among its channels {_channels(parts)}; RGB or Y is needed: export it as RGB")


def _deep(part: Part) -> LightError:
    where = f" in part {_plain(part.name)}" if part.name else ""
    return LightError(f"deep data (several samples per texel){where}; only flat images are read: flatten it first")


def _channels(parts: tuple[Part, ...]) -> str:
    """The channels of all parts in the file's order, with the part's name where there are several."""
    prefixes = [f"{part.name}:" if len(parts) > 1 else "" for part in parts]
    return _listed(
        [prefix + channel.name for prefix, part in zip(prefixes, parts, strict=True) for channel in part.channels]
    )


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return ", ".join(_plain(name) for name in names[:_SHOWN]) + more


def _plain(name: str) -> str:
    """A name as one line of bounded length, whatever the file holds."""
    return name[:60] if name[:60].isprintable() else ascii(name[:60])[1:-1]
