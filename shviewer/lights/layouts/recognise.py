"""The layout of an image: the one asked for, else the one that its file states, else the one its shape suggests."""

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
from shviewer.lights.reading import LAYOUTS

TOLERANCE = 0.02
"""How far empty texels may be from one colour, as a share of how far the other texels are from it."""

MARGIN = 2
LOSSY_MARGIN = 16
"""Texels along a border that may mix both sides: by antialiasing, or by a JPEG's blocks, 16 wide for colours."""

SAMPLES = 2**18
"""About how many texels of an image are looked at."""

_Notes = tuple[str, ...]


def recognise(
    pixels: NDArray[np.float32], stated: str | None, wanted: str, lossy: bool = False
) -> tuple[Layout, _Notes]:
    """The layout of an image (height, width, 3) and a line about each guess.

    stated: the one of LAYOUTS that its file states, or None. A file that states a cube means OpenEXR's arrangement.
    wanted: "auto", or one of LAYOUTS, which then overrules file and shape. LightError if the image's shape does not fit.
    lossy: whether it comes from a JPEG, which blurs what lies next to an edge.
    """
    height, width = pixels.shape[:2]
    if wanted != "auto":
        return _fitting(wanted, height, width, stated), ()
    misfits: _Notes = ()
    if stated is not None:
        try:
            return _fitting(stated, height, width, stated), ()
        except LightError as misfit:
            misfits = (f"the file states another layout, but {misfit}",)
    layout, note = _by_shape(pixels, lossy)
    return layout, (*misfits, f"{width} x {height} {note}") if note else misfits


def _fitting(name: str, height: int, width: int, stated: str | None) -> Layout:
    """The named layout for an image of this shape. LightError for an unknown name or a shape that does not fit."""
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


def _by_shape(pixels: NDArray[np.float32], lossy: bool) -> tuple[Layout, str]:
    """The layout, and what to say of the image's size: how the layout was guessed; "" where nothing was."""
    height, width = pixels.shape[:2]
    arrangement = _arrangement(height, width)
    if arrangement is not None and _has_empty_cells(pixels, arrangement, lossy):
        layout = CubeLayout(arrangement, arrangement.face_size(height, width))
        return layout, f"is taken as a cube, {arrangement.name}: --layout lat-long if it is not"
    if width == height and _is_disc(pixels, lossy):
        return AngularLayout(height), "with a disc is taken as an angular map: --layout mirror-ball for a ball"
    if arrangement is not None:
        note = "is not 2:1 and no cube cross, whose corners are empty; taken as lat-long: --layout cube if it is one"
    elif width == height:
        note = "is not 2:1 and no disc on one colour; taken as lat-long: --layout angular or mirror-ball if it is one"
    else:
        note = "is not 2:1; taken as lat-long all the same: --layout to change it" if width != 2 * height else ""
    return LatLongLayout(height, width), note


def _arrangement(height: int, width: int) -> Arrangement | None:
    """The arrangement of six whole faces that fills the image, if any. A strip is taken to be OpenGL's and Direct3D's."""
    for arrangement in (VERTICAL_CROSS, HORIZONTAL_CROSS, HORIZONTAL_STRIP, VERTICAL_STRIP):
        if arrangement.face_size(height, width):
            return arrangement
    return None


def _has_empty_cells(pixels: NDArray[np.float32], arrangement: Arrangement, lossy: bool) -> bool:
    """Whether the cells without a face, if there are any, are all of one colour but for a margin."""
    size = arrangement.face_size(*pixels.shape[:2])
    margin = min(LOSSY_MARGIN if lossy else MARGIN, size // 4)
    places = {(face.row, face.column) for face in arrangement.faces}
    faces, empty = [], []
    for row, column in np.ndindex(arrangement.rows, arrangement.columns):
        cell = pixels[row * size : (row + 1) * size, column * size : (column + 1) * size]
        if (row, column) in places:
            step = _step(6 * cell.shape[0] * cell.shape[1])
            faces.append(cell[::step, ::step].reshape(-1, 3))
        else:
            empty.append(cell[margin : size - margin, margin : size - margin].reshape(-1, 3))
    return not empty or _stands_out(np.concatenate(faces), np.concatenate(empty))


def _is_disc(pixels: NDArray[np.float32], lossy: bool) -> bool:
    """Whether all texels outside the inscribed circle, but for a margin, are of one colour, and those inside are not."""
    side = len(pixels)
    margin = min(3 * LOSSY_MARGIN // 2 if lossy else MARGIN, side // 12)  # blocks may be cut across
    distance = np.maximum(np.abs(2 * np.arange(side) + 1 - side) - 1, 0) / side
    outside = distance**2 + distance[:, None] ** 2 >= (1 + 2 * margin / side) ** 2
    step = _step(side * side)
    inside = distance[::step] ** 2 + distance[::step, None] ** 2 < 1
    return bool(outside.any()) and _stands_out(pixels[::step, ::step][inside], pixels[outside])


def _step(texels: int) -> int:
    """Every so many rows and columns of an image are about SAMPLES."""
    return max(1, int(np.sqrt(texels / SAMPLES)))


def _stands_out(shown: NDArray[np.float32], empty: NDArray[np.float32]) -> bool:
    """Whether `empty` (k, 3) is of one colour, and more than half of `shown` (j, 3) is farther from it than all of `empty`.

    One colour means: within TOLERANCE times the ninth decile of `shown`, which a sun does not reach. The dark parts of a night
    are close to one colour as well; but then so is most of the rest.
    """
    colour = np.median(empty, axis=0)
    spread = float(np.abs(empty - colour).max())
    distances = np.abs(shown - colour).max(axis=1)
    half, large = np.quantile(distances, (0.5, 0.9))
    return bool(spread < half and spread <= TOLERANCE * large)
