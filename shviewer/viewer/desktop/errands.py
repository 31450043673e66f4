"""What the window writes and copies of its picture: the picture itself, its command line, and its coefficients."""

from __future__ import annotations

from pathlib import Path

from shviewer.analysis.projected import Projected, project_recipe
from shviewer.coefficients.programs import OURS
from shviewer.outputs import file_stem, write_atomically
from shviewer.viewer import camera
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.picture_files import write_numbered, write_png
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.screenshot import render_rgb


def save_picture(picture: Picture, composition: Composition, renderer: Renderer) -> Path:
    """Write the picture under the next free name in the present folder; return its path. OutputError if that fails."""
    pixels, text = render_rgb(renderer, picture, composition), metadata(picture, composition, renderer.version)
    return write_numbered(_stem(picture), lambda path: write_png(path, pixels, text, exclusive=True))


def save_coefficients(picture: Picture) -> Path:
    """Write what `shviewer project` would, with the light turned as it is shown. OutputError if that fails."""
    data = _projected(picture).encode(OURS, "json")
    return write_numbered(_stem(picture), lambda path: write_atomically(path, data, exclusive=True), suffix=".json")


def coefficients_text(picture: Picture) -> str:
    """The same as CSV with its stamp."""
    return _projected(picture).encode(OURS, "csv").decode()


def _projected(picture: Picture) -> Projected:
    projected, rotation = project_recipe(picture.state.recipe), picture.state.view.light_rotation
    return projected if rotation == camera.IDENTITY else projected.turned(camera.matrix(rotation))


def _stem(picture: Picture) -> str:
    return f"shviewer-{file_stem(picture.light.name)}"
