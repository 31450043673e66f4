"""Arrangements: where in an image the six faces of a cube lie.

Every face is drawn as seen from inside, not mirrored. In the world of basis.py, x forward, y left and z up:

    arrangement        image   faces, left to right or top to bottom
    vertical strip     1 x 6   right -y, left +y, up +z, down -z, front +x, back -x: the OpenGL and Direct3D order
    horizontal strip   6 x 1   the same. Both are left-handed there: their +X is our right, their +Y up, their +Z front;
                               the lower edge of their up face and the upper edge of their down face touch the front
    packs              3 x 2   the order of the strips, row by row, as ffmpeg writes it; or in three rows of two
    OpenEXR            1 x 6   the `envmap` attribute, +X -X +Y -Y +Z -Z of a right-handed space with X left, Y up and Z
                               forward: left, right, up, down, front, back; up and down are turned so that the image's
                               right is left in the world, and the lower edge of up touches the back
    vertical cross     3 x 4   up; left, front, right; down; back: the back hangs below down, turned by 180 degrees
                               (as HDRShop writes it and the published probes have it)
    horizontal cross   4 x 3   up over front, down under it; left, front, right, back in the middle row
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Face:
    """A face in the cell `row`, `column`. centre, right, down: the axes, as "+x", of its middle, its columns and its rows."""

    row: int
    column: int
    centre: str
    right: str
    down: str


@dataclass(frozen=True)
class Arrangement:
    """Where the faces of a cube stand in an image, in cells of one face each."""

    name: str
    rows: int
    columns: int
    faces: tuple[Face, ...]

    def face_size(self, height: int, width: int) -> int:
        """The side of a face, in texels; 0 if the image does not consist of whole faces in this arrangement."""
        size = height // self.rows
        return size if size * self.rows == height and size * self.columns == width else 0


_LEFT, _FRONT, _RIGHT, _BACK = ("+y", "+x", "-z"), ("+x", "-y", "-z"), ("-y", "-x", "-z"), ("-x", "+y", "-z")
_UP, _DOWN = ("+z", "-y", "+x"), ("-z", "-y", "-x")
_STRIP = _RIGHT, _LEFT, _UP, _DOWN, _FRONT, _BACK
_OPENEXR = _LEFT, _RIGHT, ("+z", "+y", "-x"), ("-z", "+y", "+x"), _FRONT, _BACK
_CROSS = Face(0, 1, *_UP), Face(1, 0, *_LEFT), Face(1, 1, *_FRONT), Face(1, 2, *_RIGHT), Face(2, 1, *_DOWN)

VERTICAL_STRIP = Arrangement("vertical strip", 6, 1, tuple(Face(i, 0, *axes) for i, axes in enumerate(_STRIP)))
HORIZONTAL_STRIP = Arrangement("horizontal strip", 1, 6, tuple(Face(0, i, *axes) for i, axes in enumerate(_STRIP)))
OPENEXR = Arrangement("OpenEXR order", 6, 1, tuple(Face(i, 0, *axes) for i, axes in enumerate(_OPENEXR)))
VERTICAL_CROSS = Arrangement("vertical cross", 4, 3, (*_CROSS, Face(3, 1, "-x", "-y", "+z")))
PACK = Arrangement("pack of 3 x 2", 2, 3, tuple(Face(i // 3, i % 3, *axes) for i, axes in enumerate(_STRIP)))
TALL_PACK = Arrangement("pack of 2 x 3", 3, 2, tuple(Face(i // 2, i % 2, *axes) for i, axes in enumerate(_STRIP)))
HORIZONTAL_CROSS = Arrangement("horizontal cross", 3, 4, (*_CROSS, Face(1, 3, *_BACK)))
