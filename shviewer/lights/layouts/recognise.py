"""The layout of an image: the one asked for, else the one that its file states, else the one its shape suggests.

A cross shows itself by its empty cells, whatever their colour; where they hold something (a checkerboard, text), by its
seams, and so do packs, which have none. A border of exactly one colour around a cross is cut off. What is not certain is
lat-long, with a note.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.arrangements import (
    HORIZONTAL_CROSS,
    HORIZONTAL_STRIP,
    OPENEXR,
    PACK,
    TALL_PACK,
    VERTICAL_CROSS,
    VERTICAL_STRIP,
)
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout
from shviewer.lights.layouts.seams import fit_together
from shviewer.lights.reading import LAYOUT_CHOICES
from shviewer.words import meant

TOLERANCE = 0.02
"""How far empty texels may be from one colour, as a share of how far the other texels are from it."""

MARGIN = 2
LOSSY_MARGIN = 16
"""Texels along a border that may mix both sides: by antialiasing, or by a JPEG's blocks, 16 wide for colours."""

SAMPLES = 2**18
"""About how many texels of an image are looked at."""

_Notes = tuple[str, ...]
_Pixels = NDArray[np.float32]
_CROSSES = (VERTICAL_CROSS, HORIZONTAL_CROSS)
_PACKS = (PACK, TALL_PACK)
_CUBES = (*_CROSSES, HORIZONTAL_STRIP, VERTICAL_STRIP, *_PACKS)


class Recognised(NamedTuple):
    """What an image is taken for. pixels: the image, without the border that is no part of its layout."""

    layout: Layout
    notes: _Notes
    """A line about each guess."""
    pixels: _Pixels


def recognise(pixels: _Pixels, stated: str | None, wanted: str, lossy: bool = False) -> Recognised:
    """The layout of an image (height, width, 3).

    stated: the one of LAYOUTS that its file states, or None. A file that states a cube means OpenEXR's arrangement.
    wanted: "auto", or one of LAYOUTS, which then overrules file and shape. LightError if the image's shape does not fit.
    lossy: whether it comes from a JPEG, which blurs what lies next to an edge.
    """
    height, width = pixels.shape[:2]
    if wanted != "auto":
        if wanted == "cube" and _cube(height, width) is None and (found := _framed_cross(pixels)):
            return found
        return Recognised(_fitting(wanted, height, width, stated), (), pixels)
    misfits: _Notes = ()
    if stated is not None:
        try:
            return Recognised(_fitting(stated, height, width, stated), (), pixels)
        except LightError as misfit:
            misfits = (f"the file states another layout, but {misfit}",)
    layout, notes, pixels = _by_shape(pixels, lossy)
    return Recognised(layout, (*misfits, *notes), pixels)


def _fitting(name: str, height: int, width: int, stated: str | None) -> Layout:
    """The named layout for an image of this shape. LightError for an unknown name or a shape that does not fit."""
    shown = f"{width} x {height}"
    if name == "lat-long":
        return LatLongLayout(height, width)
    if name == "cube":
        cube = _cube(height, width, stated)
        if cube is None:
            raise LightError(
                f"{shown} is no cube: it must be a cross of 3 x 4 or 4 x 3 faces, a strip of 6 x 1 or 1 x 6, or a pack of"
                " 3 x 2 or 2 x 3; choose another --layout"
            )
        return cube
    if name in ("angular", "mirror-ball"):
        if height != width:
            raise LightError(
                f"{shown} is not square, as {name} must be: crop it to the disc or choose another --layout"
            )
        return AngularLayout(height) if name == "angular" else MirrorBallLayout(height)
    raise LightError(f"layout {name!r}: {meant(name, LAYOUT_CHOICES)}")


def _by_shape(pixels: _Pixels, lossy: bool) -> Recognised:
    """The layout, and how it was guessed, if it was."""
    height, width = pixels.shape[:2]
    shown = f"{width} x {height}"
    cube = _cube(height, width)
    packed = cube is not None and cube.arrangement in _PACKS
    if cube is not None:
        taken = f"{shown} is taken as a cube, {cube.arrangement.name}"
        if not packed and _has_empty_cells(pixels, cube, lossy):
            return Recognised(cube, (f"{taken}: --layout lat-long if it is not",), pixels)
        if fit_together(pixels, cube):
            note = f"{taken}, since its faces fit together: --layout lat-long if not"
            return Recognised(cube, (note,), pixels)
    if width == height and _is_disc(pixels, lossy):
        note = f"{shown} with a disc is taken as an angular map: --layout mirror-ball for a ball"
        return Recognised(AngularLayout(height), (note,), pixels)
    if found := _framed_cross(pixels):
        return found
    if cube is not None:
        what = "pack of a cube" if packed else "cube cross, whose corners are empty"
        guess = f"is not 2:1 and no {what}; taken as lat-long: --layout cube if it is one"
    elif width == height:
        guess = "is not 2:1 and no disc on one colour; taken as lat-long: --layout angular or mirror-ball if it is one"
    else:
        guess = "is not 2:1; taken as lat-long all the same: --layout to change it" if width != 2 * height else ""
    return Recognised(LatLongLayout(height, width), (f"{shown} {guess}",) if guess else (), pixels)


def _framed_cross(pixels: _Pixels) -> Recognised | None:
    """A cross within a border of one colour; None if there is none."""
    rows, columns = _inside_border(pixels)
    inner = pixels[rows, columns]
    height, width = inner.shape[:2]
    cube = _cube(height, width)
    if inner.shape == pixels.shape or cube is None or cube.arrangement not in _CROSSES:
        return None
    if not (_has_empty_cells(inner, cube, lossy=False) or fit_together(inner, cube)):
        return None
    note = (
        f"{pixels.shape[1]} x {pixels.shape[0]} is taken as a cube, {cube.arrangement.name} of {width} x {height} within a"
        " border: --layout lat-long if it is not"
    )
    return Recognised(cube, (note,), np.ascontiguousarray(inner))


def _inside_border(pixels: _Pixels) -> tuple[slice, slice]:
    """The rows and columns that are not all of the colour of the first texel; all of them if none are."""
    sides = (pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1])
    if not any(np.all(side == pixels[0, 0]) for side in sides):
        return slice(None), slice(None)
    other = np.any(pixels != pixels[0, 0], axis=2)
    spans = []
    for axis in (1, 0):
        places = np.flatnonzero(other.any(axis=axis))
        spans.append(slice(int(places[0]), int(places[-1]) + 1) if len(places) else slice(None))
    return spans[0], spans[1]


def _cube(height: int, width: int, stated: str | None = None) -> CubeLayout | None:
    """The cube whose six whole faces fill the image, if any.

    A strip is OpenEXR's if the file states a cube, else taken to be OpenGL's and Direct3D's.
    """
    for arrangement in (OPENEXR, *_CUBES) if stated == "cube" else _CUBES:
        if face := arrangement.face_size(height, width):
            return CubeLayout(arrangement, face)
    return None


def _has_empty_cells(pixels: NDArray[np.float32], cube: CubeLayout, lossy: bool) -> bool:
    """Whether the cells without a face, if there are any, are all of one colour but for a margin."""
    shown = cube.faces_by_cell >= 0
    if shown.all():
        return True
    size = cube.face
    margin, step = min(LOSSY_MARGIN if lossy else MARGIN, size // 4), _step(6 * size**2)
    cells = pixels.reshape(len(shown), size, -1, size, 3).swapaxes(1, 2)
    faces = cells[:, :, ::step, ::step][shown]
    empty = cells[:, :, margin : size - margin, margin : size - margin][~shown]
    return _stands_out(faces.reshape(-1, 3), empty.reshape(-1, 3))


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
