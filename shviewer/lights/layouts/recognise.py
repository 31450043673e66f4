"""Which layout an image has: the one asked for, else the one that its file states, else what its shape suggests."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.cube import (
    HORIZONTAL_CROSS,
    HORIZONTAL_STRIP,
    OPENEXR,
    VERTICAL_CROSS,
    VERTICAL_STRIP,
    Arrangement,
    CubeLayout,
)
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout

LAYOUTS = ("lat-long", "cube", "angular", "mirror-ball")

_Notes = tuple[str, ...]


def recognise(pixels: NDArray[np.float32], stated: str | None, wanted: str) -> tuple[Layout, _Notes]:
    """The layout of an image (height, width, 3) and a line about each guess.

    stated: what its file says, one of LAYOUTS; None for nothing. A file that says cube means OpenEXR's.
    wanted: "auto" or one of LAYOUTS, which overrules both. LightError if the image's shape cannot be so.
    """
    height, width = pixels.shape[:2]
    if wanted != "auto":
        return _fitting(wanted, height, width, stated), ()
    if stated is not None:
        try:
            return _fitting(stated, height, width, stated), ()
        except LightError as misfit:
            layout, notes = _by_shape(pixels)
            return layout, (f"the file states another layout, but {misfit}", *notes)
    return _by_shape(pixels)


def _fitting(name: str, height: int, width: int, stated: str | None) -> Layout:
    """LightError for an unknown name and for a shape that the layout does not have."""
    shown = f"{width} x {height}"
    if name == "lat-long":
        return LatLongLayout(height, width)
    if name == "cube":
        arrangement = OPENEXR if stated == "cube" and OPENEXR.face_size(height, width) else _arrangement(height, width)
        if arrangement is None:
            raise LightError(
                f"{shown} is no cube: it must be a cross of 3 x 4 or 4 x 3 faces or a strip of 6 x 1 or 1 x 6;"
                " choose another --layout"
            )
        return CubeLayout(arrangement, arrangement.face_size(height, width))
    if name in ("angular", "mirror-ball"):
        if height != width:
            raise LightError(
                f"{shown} is not square, as {name} must be: crop it to the disc or choose another --layout"
            )
        return AngularLayout(height) if name == "angular" else MirrorBallLayout(height)
    raise LightError(f"unknown layout {name!r}; choose auto, {', '.join(LAYOUTS)}")


def _by_shape(pixels: NDArray[np.float32]) -> tuple[Layout, _Notes]:
    height, width = pixels.shape[:2]
    shown = f"{width} x {height}"
    arrangement = _arrangement(height, width)
    if arrangement is not None:
        if _has_empty_cells(pixels, arrangement):
            layout = CubeLayout(arrangement, arrangement.face_size(height, width))
            return layout, (f"{shown} is taken as a cube, {arrangement.name}: --layout lat-long if it is not",)
        return LatLongLayout(height, width), (
            f"{shown} is not 2:1 and no cube cross, whose corners are empty; taken as lat-long: --layout cube if it is one",
        )
    if width == height and _is_disc(pixels):
        return AngularLayout(height), (
            f"{shown} with a disc is taken as an angular map: --layout mirror-ball for a ball",
        )
    if width != 2 * height:
        return LatLongLayout(height, width), (
            f"{shown} is not 2:1; taken as lat-long all the same: --layout to change it",
        )
    return LatLongLayout(height, width), ()


def _arrangement(height: int, width: int) -> Arrangement | None:
    """Of whole faces. A strip of unknown origin is in the order of OpenGL and Direct3D."""
    for arrangement in (VERTICAL_CROSS, HORIZONTAL_CROSS, HORIZONTAL_STRIP, VERTICAL_STRIP):
        if arrangement.face_size(height, width):
            return arrangement
    return None


def _has_empty_cells(pixels: NDArray[np.float32], arrangement: Arrangement) -> bool:
    """Whether the cells without a face, if there are any, are all of one colour."""
    size = arrangement.face_size(*pixels.shape[:2])
    faces = {(face.row, face.column) for face in arrangement.faces}
    cells = [
        pixels[row * size : (row + 1) * size, column * size : (column + 1) * size]
        for row, column in np.ndindex(arrangement.rows, arrangement.columns)
        if (row, column) not in faces
    ]
    return all(bool((cell == cells[0][0, 0]).all()) for cell in cells)


def _is_disc(pixels: NDArray[np.float32]) -> bool:
    """Whether all that lies wholly outside the inscribed circle is of one colour, and what lies inside is not."""
    side = len(pixels)
    inner = np.maximum(np.abs(2 * np.arange(side) + 1 - side) - 1, 0) / side
    outside = inner**2 + inner[:, None] ** 2 >= 1
    if not outside.any():
        return False
    differs = (pixels != pixels[0, 0]).any(axis=2)
    return bool(differs[~outside].any()) and not bool(differs[outside].any())
