"""OpenEXR files through the official library, which is asked for the header first and believed only then.

Traps of the library (3.5.3), each with a test:
    a damaged chunk raises nothing: it prints one line on stderr (from C) and one on sys.stdout, and `parts` is empty;
    a header may claim any window, and pixels of that size are allocated at once;
    RGB of mixed pixel types cannot be grouped, so channels are read one by one.
"""

import contextlib
import io
import os
from collections.abc import Iterator
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.decoders.decoded import Decoded
from shviewer.lights.decoders.limits import DEFAULT_LIMITS, Limits

_SAMPLES_PER_TEXEL = 4  # of all channels and parts together, times the limit of texels: RGBA of the largest image
_DAMAGED = "damaged or cut short, the OpenEXR library says: {}; fetch or export the file again"


class _Window(NamedTuple):
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


class _Channel(NamedTuple):
    name: str
    subsampling: tuple[int, int]


class _Part(NamedTuple):
    """What matters of a part's header, in plain Python."""

    name: str
    deep: bool
    cube: bool
    window: _Window  # where the file has data
    display: _Window  # what the image is meant to show
    channels: tuple[_Channel, ...]


class _Source(NamedTuple):
    """Where the three channels of the radiance are."""

    part: int
    layer: str  # "" for channels without a layer
    channels: tuple[str, str, str]


def decode_openexr(data: bytes, limits: Limits = DEFAULT_LIMITS) -> Decoded:
    """The radiance in an OpenEXR file on its display window, and what its reader should be told.

    data: the whole file.
    Returns ((height, width, 3) float32, top row and left column first, C-contiguous), notes. Half floats and
    unsigned integers are taken at their value; Inf and NaN pass through.
    Raises LightError, without the name of the file, if it is damaged, too large, deep, a cube map, in
    luminance/chroma, or does not say which of its channels are the radiance.
    """
    openexr = _import_openexr()
    parts = _read_headers(openexr, data)
    _check_headers(parts, limits)
    source = _find_radiance(parts)
    window, display = parts[source.part].window, parts[source.part].display

    decoded = _open(openexr, data, header_only=False).parts
    if len(decoded) != len(parts):
        raise LightError(_DAMAGED.format(f"only {len(decoded)} of {len(parts)} parts can be decoded"))
    radiance = np.empty((window.height, window.width, 3), np.float32)
    for i, name in enumerate(source.channels):
        channel = decoded[source.part].channels[name].pixels
        if channel.dtype == object or channel.shape != radiance.shape[:2]:
            raise LightError(_DAMAGED.format(f"channel {name!r} has no pixels"))
        radiance[..., i] = channel

    pixels, notes = _on_display_window(radiance, window, display)
    if source.layer:
        notes = (f"layer {source.layer!r} read, the only one with R, G and B", *notes)
    return Decoded(pixels, "OpenEXR", notes)


def _import_openexr() -> ModuleType:
    """Imported here, so that lights without an .exr start faster and need no library."""
    try:
        import OpenEXR
    except ImportError as error:
        raise LightError(f"an OpenEXR file needs the OpenEXR library ({error}): pip install OpenEXR") from None
    return OpenEXR  # type: ignore[no-any-return]


def _open(openexr: ModuleType, data: bytes, *, header_only: bool) -> Any:
    """An OpenEXR.File with at least one part; what the library prints becomes the reason in the error."""
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), _c_stderr_silenced():
            file = openexr.File(io.BytesIO(data), separate_channels=True, header_only=header_only)
    except Exception as error:  # RuntimeError, ValueError, TypeError, MemoryError, ... by file and version
        raise LightError(_DAMAGED.format(_one_line(str(error)))) from None
    if not file.parts:
        raise LightError(_DAMAGED.format(_one_line(printed.getvalue()) or "no parts"))
    return file


@contextlib.contextmanager
def _c_stderr_silenced() -> Iterator[None]:
    """File descriptor 2 points nowhere meanwhile: the C part of the library writes past sys.stderr."""
    try:
        saved = os.dup(2)
    except OSError:  # closed, as under a service manager: nothing to keep clean
        yield
        return
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(saved, 2)
        os.close(saved)


def _one_line(text: str) -> str:
    line = " ".join(text.removeprefix("Warning: ").split())
    return ascii(line[:160])[1:-1]


def _read_headers(openexr: ModuleType, data: bytes) -> tuple[_Part, ...]:
    """Every part, since the library decodes them all."""
    file = _open(openexr, data, header_only=True)
    try:
        return tuple(_plain(openexr, part.header) for part in file.parts)
    except (
        Exception
    ) as error:  # the library converts an attribute when it is asked for: UnicodeDecodeError, KeyError, ...
        raise LightError(_DAMAGED.format(f"header unreadable ({_one_line(str(error))})")) from None


def _plain(openexr: ModuleType, header: dict[str, Any]) -> _Part:
    return _Part(
        name=str(header.get("name", "")),
        deep=header.get("type") in (openexr.deepscanline, openexr.deeptile),
        cube=header.get("envmap") == openexr.ENVMAP_CUBE,
        window=_window(header["dataWindow"]),
        display=_window(header["displayWindow"]),
        channels=tuple(
            _Channel(channel.name, (channel.xSampling, channel.ySampling)) for channel in header["channels"]
        ),
    )


def _window(corners: Any) -> _Window:
    (left, top), (right, bottom) = corners
    return _Window(int(left), int(top), int(right), int(bottom))


def _check_headers(parts: tuple[_Part, ...], limits: Limits) -> None:
    samples = 0
    for part in parts:
        if part.deep:
            raise LightError("deep data (several samples per texel); only flat images are read: flatten it first")
        if part.cube:
            raise LightError(
                "a cube map (its envmap attribute says so); lat-long only for now: convert it with exrenvmap"
            )
        limits.check_size(part.window.width, part.window.height, "data window")
        limits.check_size(part.display.width, part.display.height, "display window")
        samples += part.window.width * part.window.height * len(part.channels)
    most = _SAMPLES_PER_TEXEL * limits.texels
    if samples > most:
        raise LightError(f"{samples} values in all channels; the limit is {most}: export only R, G and B")


def _find_radiance(parts: tuple[_Part, ...]) -> _Source:
    """R, G, B without a layer; else the only layer that has them; else a single luminance Y."""
    names = [{channel.name for channel in part.channels} for part in parts]
    sources = []
    for i in range(len(parts)):
        for red in sorted(name for name in names[i] if name.rpartition(".")[2] == "R"):
            layer, dot, _ = red.rpartition(".")
            rgb = (red, f"{layer}{dot}G", f"{layer}{dot}B")
            if names[i].issuperset(rgb):
                sources.append(_Source(i, layer, rgb))
    if not sources and any(present & {"RY", "BY"} for present in names):
        raise LightError("luminance and chroma channels (Y, RY, BY); only RGB or a single Y is read: export it as RGB")
    if not sources:
        sources = [_Source(i, "", ("Y", "Y", "Y")) for i in range(len(parts)) if "Y" in names[i]]

    chosen = [source for source in sources if not source.layer] or sources
    if len(chosen) != 1:
        found = f"{len(chosen)} candidates" if chosen else "no R, G and B"
        raise LightError(
            f"{found} among its channels {_listed(parts)}; exactly one RGB or Y is needed: export it alone"
        )
    (source,) = chosen
    coarse = [c.name for c in parts[source.part].channels if c.name in source.channels and c.subsampling != (1, 1)]
    if coarse:
        raise LightError(f"subsampled channels {', '.join(coarse)}; one value per texel is needed: export it as RGB")
    return source


def _listed(parts: tuple[_Part, ...]) -> str:
    """The channels of all parts, in the file's order, at most a dozen; with the part's name where there are several."""
    names = []
    for part in parts:
        prefix = f"{part.name}:" if len(parts) > 1 else ""
        names += [ascii(prefix + channel.name)[1:-1][:60] for channel in part.channels]
    return ", ".join(names[:12]) + (f" and {len(names) - 12} more" if len(names) > 12 else "")


def _on_display_window(
    radiance: NDArray[np.float32], window: _Window, display: _Window
) -> tuple[NDArray[np.float32], tuple[str, ...]]:
    """Black where there are no data, nothing outside: the display window is the whole sphere."""
    if window == display:
        return radiance, ()
    left, right = max(window.left, display.left), min(window.right, display.right)
    top, bottom = max(window.top, display.top), min(window.bottom, display.bottom)
    if left > right or top > bottom:
        raise LightError(f"data window {tuple(window)} lies outside display window {tuple(display)}: re-export it")
    pixels = np.zeros((display.height, display.width, 3), np.float32)
    common = _Window(left, top, right, bottom)
    pixels[_slices(common, display)] = radiance[_slices(common, window)]

    kept = common.width * common.height
    notes = []
    if empty := display.width * display.height - kept:
        notes.append(f"data window smaller than display window: {empty} texels without data are 0")
    if cropped := window.width * window.height - kept:
        notes.append(f"data window larger than display window: {cropped} texels outside are dropped")
    return pixels, tuple(notes)


def _slices(part: _Window, whole: _Window) -> tuple[slice, slice]:
    """The rows and columns of `part` in an array that covers `whole`."""
    rows = slice(part.top - whole.top, part.bottom - whole.top + 1)
    return rows, slice(part.left - whole.left, part.right - whole.left + 1)
