"""The evidence of a cube's seams: whether faces that meet on the sphere, but not in the image, fit together.

A picture is cut at an edge of the cube no more than anywhere else: from the last texel of a face to the first of its neighbour
is a step like that between any two texels. In an image that is no cube, or has its faces in another order, the texels that
would meet have nothing to do with each other. An image whose borders are all alike proves nothing, and counts as no cube.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.lights.layouts.cube import CubeLayout

Places = NDArray[np.int64]
"""Rows and columns of the image, (2, lines, texels)."""

FEWEST_TEXELS = 8
"""The side of the smallest face whose seams prove something."""

_MOST_TEXELS = 256  # of an edge that are looked at
# Of the last two below, cubes of real maps have at most 1.3 and 0.46, and images that are none at least 2.4 and 0.76.
_FINEST_STEP = 0.01  # stops; below it everything is alike
_CONTRAST = 4.0  # how many times a step the texels at unrelated places must differ
_OF_A_STEP = 2.0  # how many times a step the texels may differ across all seams
_OF_UNRELATED = 0.5  # and across any one of them, as a share of the difference of unrelated texels


def fit_together(pixels: NDArray[np.float32], layout: CubeLayout) -> bool:
    """Whether the faces of an image (height, width, 3) certainly have this arrangement."""
    if layout.face < FEWEST_TEXELS:
        return False
    here, beyond, within, apart = _lines(layout)
    own, other, inner = (np.maximum(pixels[tuple(places)].astype(np.float64), 0.0) for places in (here, beyond, within))
    dim = float(np.median(own)) or float(own.mean())
    if not dim > 0.0:
        return False
    # In stops above a tenth of the median, so that a sun counts no more than a step.
    own, other, inner = (np.log2(1.0 + light / (0.1 * dim)) for light in (own, other, inner))
    across = np.abs(own - other).mean(axis=(1, 2))[apart]
    step = max(float(np.abs(own - inner).mean()), _FINEST_STEP)
    shifts = range(1, len(other))
    unrelated = float(np.mean([np.abs(own - np.roll(other, shift, axis=0)).mean() for shift in shifts]))
    return bool(
        unrelated >= _CONTRAST * step
        and across.mean() <= _OF_A_STEP * step
        and across.max() <= _OF_UNRELATED * unrelated
    )


def _lines(layout: CubeLayout) -> tuple[Places, Places, Places, NDArray[np.bool_]]:
    """Along the four edges of each face, 24 lines: texels, those across the seam, and those further within.

    Also which of the lines do not meet their neighbours in the image as well, (24,).
    """
    last = layout.face - 1
    along = np.unique(np.linspace(0, last, min(layout.face, _MOST_TEXELS)).astype(np.int64))
    start, end = np.zeros_like(along), np.full_like(along, last)
    # rows, columns, and the step outwards
    edges = ((start, along, -1, 0), (end, along, 1, 0), (along, start, 0, -1), (along, end, 0, 1))
    lines = []
    for face in range(6):
        for rows, columns, down, right in edges:
            faces = np.full(len(along), face)
            lines.append([layout.texels(faces, rows + i * down, columns + i * right) for i in (0, 1, -1)])
    here, beyond, within = np.array(lines).transpose(1, 2, 0, 3)
    apart = np.any(np.abs(here - beyond).sum(axis=0) != 1, axis=1)
    return here, beyond, within, apart
