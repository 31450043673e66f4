"""The picture without a window: an EGL context, and pixels read back from a framebuffer."""

from __future__ import annotations

import ctypes.util
import sys
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.errors import GraphicsError
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.gl.renderer import GL_VERSIONS, PART_SECONDS, Renderer
from shviewer.viewer.overlay.directions.marks import layers_over
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.overlay import Overlay, draw_overlay
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.picture_files import write_exr, write_png
from shviewer.viewer.saving.stamp import metadata

T = TypeVar("T", np.uint8, np.float32)


def save_picture(
    picture: Picture,
    composition: Composition,
    out: Path,
    *,
    overlay: bool = True,
    timing: bool = False,
    exclusive: bool = False,
) -> NDArray[np.uint8] | None:
    """Draw without a window and write `out`: linear radiance as .exr (returns None), else a PNG (returns its pixels).

    exclusive: FileExistsError if a PNG is there. GraphicsError, ShaderError or OutputError if that is impossible; then `out`
    is what it was.
    """
    with headless_renderer() as renderer:
        text = metadata(picture, composition, renderer.version, overlay=overlay)
        if out.suffix.lower() == ".exr":
            write_exr(out, render_linear(renderer, picture, composition), text)
            return None
        pixels = render_rgb(renderer, picture, composition, overlay=overlay, timing=timing)
    write_png(out, pixels, text, exclusive=exclusive)
    return pixels


@contextmanager
def headless_renderer() -> Iterator[Renderer]:
    """A renderer on a context without a display. GraphicsError says what was found and what to install."""
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
    written = _written(renderer, picture, composition, timing=timing) if overlay else None
    layers = layers_over(picture, composition, written) if written is not None else ()
    renderer.show(picture)
    return read_rgb(renderer, composition, layers)


def render_in_parts(
    renderer: Renderer, picture: Picture, composition: Composition
) -> Generator[float, None, Callable[[], NDArray[np.uint8]]]:
    """Draw the same in parts of about PART_SECONDS; yields the share that is drawn, and returns what makes the pixels of it."""
    written = _written(renderer, picture, composition)
    for _ in written.drawing():
        yield 0.0
    layers = layers_over(picture, composition, written)
    with offscreen(renderer, composition) as target:
        renderer.show(picture)
        for part in renderer.parts(target, composition, layers, seconds=PART_SECONDS):
            yield part.share
        data = target.read(components=4)
    return lambda: _upright(np.frombuffer(data, np.uint8), composition)


def _written(renderer: Renderer, picture: Picture, composition: Composition, *, timing: bool = False) -> Overlay:
    return draw_overlay(picture, composition, timing=timing, opengl=renderer.version)


def read_rgb(renderer: Renderer, composition: Composition, layers: Sequence[Layer] = ()) -> NDArray[np.uint8]:
    """Draw the renderer's picture into a framebuffer and read it back: (height, width, 3), top row first."""
    with offscreen(renderer, composition) as target:
        renderer.draw(target, composition, layers)
        return _upright(np.frombuffer(target.read(components=4), np.uint8), composition)


def render_linear(renderer: Renderer, picture: Picture, composition: Composition) -> NDArray[np.float32]:
    """Scene-linear radiance of the spheres, on the third one the error: (height, width, 3), top row first.

    Negative radiance stays negative; around the spheres it is 0.
    """
    renderer.show(picture)
    with offscreen(renderer, composition, "f4") as target:
        renderer.draw(target, composition, linear=True)
        return _upright(np.frombuffer(target.read(components=4, dtype="f4"), np.float32), composition)


def _upright(values: NDArray[T], composition: Composition) -> NDArray[T]:
    """The picture, top row first, of its RGBA, bottom row first."""
    return values.reshape(composition.height, composition.width, 4)[::-1, :, :3].copy()


@contextmanager
def offscreen(renderer: Renderer, composition: Composition, dtype: str = "f1") -> Iterator[moderngl.Framebuffer]:
    """A framebuffer of the composition's size, RGBA of that type."""
    texture = renderer.context.texture((composition.width, composition.height), 4, dtype=dtype)
    target = renderer.context.framebuffer([texture])
    try:
        yield target
    finally:
        renderer.rest.use()  # moderngl would bind a released framebuffer again when it makes the next one
        target.release()
        texture.release()
