"""The functions of `import shviewer` that draw: the picture of the window, and the window itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from shviewer.analysis.options import taken, whole
from shviewer.analysis.projected import Projected
from shviewer.analysis.recipe import Recipe
from shviewer.api import LightLike, find_light, recipe_of, with_options
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.names import ENCODED_BANDS, IRRADIANCE
from shviewer.viewer import screenshot as offscreen
from shviewer.viewer.composing.composition import frame_for
from shviewer.viewer.picture import first_picture, prepare
from shviewer.viewer.saving.picture_files import png_bytes
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.state import State
from shviewer.viewer.view import View


@with_options(Recipe, View)
def screenshot(
    light: LightLike,
    bands: int | None = None,
    *,
    size: tuple[int, int] = (1280, 640),
    overlay: bool = True,
    **options: Any,
) -> NDArray[np.uint8]:
    """The picture that the window would show: (height, width, 3) uint8, sRGB, top row first. size: (width, height) in pixels.

    overlay: with captions and figures. GraphicsError where there is no OpenGL 3.3.

    """
    state = _state(light, bands, options, size)
    picture = prepare(state, written=overlay)
    with offscreen.headless_renderer() as renderer:
        return offscreen.render_rgb(renderer, picture, frame_for(state.view, *size), overlay=overlay)


def picture_bytes(shown: object) -> bytes:
    """The picture of a light, or of a projection as it was made, as a PNG with its stamp. GraphicsError without OpenGL 3.3."""
    size = (1280, 640)
    recipe = shown.recipe if isinstance(shown, Projected) else None
    if isinstance(shown, Projected) and recipe is None:
        shown = find_light(shown.coefficients)
    state = State(recipe, View(), (recipe.light,)) if recipe else _state(cast(LightLike, shown), None, {}, size)
    picture = prepare(state)
    with offscreen.headless_renderer() as renderer:
        composition = frame_for(state.view, *size)
        pixels = offscreen.render_rgb(renderer, picture, composition)
        return png_bytes(pixels, metadata(picture, composition, renderer.version))


@with_options(Recipe, View)
def view(
    light: LightLike = "green", bands: int | None = None, *, size: tuple[int, int] = (1280, 640), **options: Any
) -> None:
    """Open the window and stay until it is closed. size: width and height in screen coordinates.

    NoDisplayError without a display, GraphicsError without OpenGL 3.3.

    """
    from shviewer.viewer.desktop import window
    from shviewer.viewer.desktop.behind.task import Task

    state = _state(light, bands, options, size)
    window.run(Task(lambda: [first_picture(state)]), size)


def _state(light: LightLike, bands: int | None, options: dict[str, Any], size: Any) -> State:
    """The state of the window with these options. UsageError for an option that is unknown or out of range."""
    if not (isinstance(size, Sequence) and len(size) == 2):
        raise UsageError(f"size {size!r}: it must be width and height, such as (1280, 640)")
    width, height = whole(size[0], "width"), whole(size[1], "height")
    view = View(**taken(options, View))
    view.check()
    if view.encode:
        options = {"quantity": IRRADIANCE} | options
    recipe = recipe_of(light, bands, options, View)
    if bands is None and view.encode:
        recipe = replace(recipe, n_bands=ENCODED_BANDS[view.encode])
    state = State(recipe, view, (recipe.light,))
    state.check((width, height))
    return state
