"""The picture without a window: an EGL context, pixels, and files that carry everything that made them."""

from __future__ import annotations

import ctypes.util
import io
import json
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from shviewer import __version__
from shviewer.errors import GraphicsError, OutputError, UsageError
from shviewer.viewer.composition import Composition
from shviewer.viewer.overlay import draw_overlay
from shviewer.viewer.picture import Picture
from shviewer.viewer.renderer import GL_VERSIONS, Renderer

PIXEL_STEP = 2
"""Two pixels differ if any channel does by more than this many of 255: rounding differs by 1 between drivers."""


@contextmanager
def headless_renderer() -> Iterator[Renderer]:
    """A renderer on a context without display. GraphicsError says what was found and what to install."""
    context = _headless_context()
    try:
        renderer = Renderer(context)
        try:
            yield renderer
        finally:
            renderer.release()
    finally:
        context.release()


def _headless_context() -> moderngl.Context:
    backend: dict[str, Any] = {"backend": "egl"} if sys.platform == "linux" else {}
    found: list[str] = []
    for version in GL_VERSIONS:
        try:
            return moderngl.create_context(require=version, standalone=True, **backend)
        except Exception as error:  # glcontext raises bare Exception
            found.append(f"{version / 100:.1f}: {error}")
    missing = [name for name in ("GL", "EGL") if backend and not ctypes.util.find_library(name)]
    if missing:
        raise GraphicsError(
            f"no lib{' and no lib'.join(missing)}: install them (Debian, Ubuntu: apt-get install -y libgl1 libegl1)"
        )
    raise GraphicsError(
        f"no OpenGL 3.3 without a display ({found[-1]}): install a driver or Mesa (apt-get install -y libgl1 libegl1)"
    )


def render_rgb(
    renderer: Renderer, picture: Picture, composition: Composition, *, overlay: bool = True, timing: bool = False
) -> NDArray[np.uint8]:
    """The picture as seen: (height, width, 3) uint8, top row first."""
    sheet = draw_overlay(picture, composition, timing=timing, opengl=renderer.version).image if overlay else None
    renderer.show(picture, sheet)
    return read_rgb(renderer, composition)


def read_rgb(renderer: Renderer, composition: Composition) -> NDArray[np.uint8]:
    """What the renderer shows, drawn into a framebuffer of its own and read back: (height, width, 3), top row first."""
    size = composition.width, composition.height
    texture = renderer.context.texture(size, 4)
    target = renderer.context.framebuffer([texture])
    try:
        renderer.draw(target, composition)
        data = np.frombuffer(target.read(components=4), dtype=np.uint8)
    finally:
        target.release()
        texture.release()
    return np.ascontiguousarray(data.reshape(size[1], size[0], 4)[::-1, :, :3])


def render_linear(renderer: Renderer, picture: Picture, composition: Composition) -> NDArray[np.float32]:
    """Scene-linear radiance of both spheres, negative where it is, 0 around them: (height, width, 3), top row first."""
    size = composition.width, composition.height
    texture = renderer.context.texture(size, 4, dtype="f4")
    target = renderer.context.framebuffer([texture])
    try:
        renderer.show(picture)
        renderer.draw(target, composition, linear=True)
        data = np.frombuffer(target.read(components=4, dtype="f4"), dtype=np.float32)
    finally:
        target.release()
        texture.release()
    return np.ascontiguousarray(data.reshape(size[1], size[0], 4)[::-1, :, :3])


def metadata(picture: Picture, composition: Composition, opengl: str) -> str:
    """Everything that made the picture, as one JSON text; equal arguments give equal text."""
    state, figures, projection = picture.state, picture.figures, picture.projection
    extremes = figures.extremes
    description: dict[str, Any] = {
        "version": __version__,
        "light": picture.light.name,
        "light_notes": list(picture.light.notes),
        "bands": state.n_bands,
        "muted": list(state.muted_shown),
        "method": state.method,
        "method_words": projection.method,
        "samples": projection.evaluations,
        "seed": state.seed if state.method == "jittered" else None,
        "sanitize": state.sanitize,
        "exposure_stops": picture.exposure_stops,
        "size": [composition.width, composition.height],
        "camera_degrees": list(state.camera),
        "zoom": state.zoom,
        "world_from_view": picture.world_from_view.tolist(),
        "light_from_world": picture.light_from_world.tolist(),
        "spheres": {
            name: {"centre": [sphere.x, sphere.y], "radius": sphere.radius, "clip": list(sphere.clip)}
            for name, sphere in zip(("original", "reconstruction"), composition.spheres, strict=True)
        },
        "opengl": opengl,
        "figures": {
            "relative_l2": figures.relative_l2,
            "relative_l2_left_out": figures.left_out,
            "relative_l2_muted_and_sampling": figures.added,
            "max_error": extremes.max_error,
            "max_error_direction_in_light": list(extremes.max_error_direction),
            "minimum": extremes.minimum,
            "minimum_direction_in_light": list(extremes.minimum_direction),
            "negative_area": extremes.negative_area,
            "peak": extremes.peak,
            "energy_share": list(figures.energy_share),
        },
    }
    return json.dumps(description, ensure_ascii=False)


def write_png(path: Path, pixels: NDArray[np.uint8], text: str, *, exclusive: bool = False) -> None:
    """A PNG with `text` under the key shviewer. OutputError if it cannot be written; FileExistsError if exclusive and taken."""
    information = PngInfo()
    information.add_itxt("shviewer", text)
    information.add_text("Software", f"shviewer {__version__}")
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG", compress_level=4, pnginfo=information)
    write_atomically(path, buffer.getvalue(), exclusive=exclusive)


def write_exr(path: Path, pixels: NDArray[np.float32], text: str) -> None:
    """Float32 RGB with `text` in the attribute shviewer. OutputError if it cannot be written or OpenEXR is missing."""
    try:
        import OpenEXR
    except ImportError as error:
        raise OutputError(f"{path}: writing EXR needs the package OpenEXR (pip install OpenEXR)") from error
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "shviewer": text}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "picture.exr"
        OpenEXR.File(header, {"RGB": pixels}).write(str(file))
        write_atomically(path, file.read_bytes())


def write_atomically(path: Path, data: bytes, *, exclusive: bool = False) -> None:
    """Write beside and move into place: `path` is what it was or whole. exclusive: FileExistsError if it exists."""
    try:
        handle, name = tempfile.mkstemp(prefix=".shv-", suffix=".tmp", dir=path.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(name, 0o666 & ~_umask())
            if exclusive:
                os.link(name, path)
            else:
                os.replace(name, path)
        finally:
            with suppress(FileNotFoundError):
                os.unlink(name)
    except FileExistsError:
        raise
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}; choose another place") from error


def write_numbered(stem: str, pixels: NDArray[np.uint8], text: str) -> Path:
    """A PNG under the next free name stem-001.png, stem-002.png, ... in the current folder."""
    for number in range(1, 10_000):
        path = Path(f"{stem}-{number:03d}.png")
        if not path.exists():
            with suppress(FileExistsError):  # somebody else was faster
                write_png(path, pixels, text, exclusive=True)
                return path
    raise OutputError(f"{stem}-001.png to {stem}-9999.png all exist; move some away")


def compare_with_reference(pixels: NDArray[np.uint8], reference: Path, difference: Path, threshold: float) -> str:
    """ "" if at most the share `threshold` of the pixels differs by more than PIXEL_STEP of 255, else what differs.

    Then `difference` is written: the absolute difference, sixteen times as bright. UsageError if the reference is bad.
    """
    try:
        with Image.open(reference) as image:
            wanted = np.asarray(image.convert("RGB"))
    except (OSError, ValueError) as error:
        raise UsageError(f"{reference}: not a readable reference image: {error}") from error
    if wanted.shape != pixels.shape:
        return (
            f"{reference} is {wanted.shape[1]} x {wanted.shape[0]}, the picture {pixels.shape[1]} x {pixels.shape[0]}"
        )
    distance = np.abs(wanted.astype(np.int16) - pixels)
    share = float((distance.max(axis=2) > PIXEL_STEP).mean())
    if share <= threshold:
        return ""
    write_png(difference, np.minimum(distance * 16, 255).astype(np.uint8), json.dumps({"reference": str(reference)}))
    return (
        f"{share:.4%} of the pixels differ from {reference} by more than {PIXEL_STEP}/255 (allowed {threshold:.4%}, "
        f"largest {distance.max()}/255); see {difference}"
    )


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
