"""The test for compact sources that are clipped in the file.

A source is *clipped* if it ends in a plateau: PLATEAU or more texels at the image's highest value in some channel, most of
all such texels, in a glow that has GLOW of the peak beyond the texels that its edge crosses, as no disc has, and that falls by
FALL towards FAR. Of a clipped source the file has kept too little, and its glow is its surroundings.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shviewer.lights.suns.caps import Caps, Texels
from shviewer.lights.suns.excess import CAP, Excess
from shviewer.lights.suns.rule import CONTRAST

PLATEAU = 2
GLOW, FALL = 0.01, 2.0
FAR, FARTHEST = np.radians(10.0), np.radians(15.0)

BLOCK_VALUES = 2**18
"""Texels that are looked at at a time."""


def highest(pixels: NDArray[np.float32], caps: Caps) -> Texels | None:
    """The texels of pixels (height, width, 3) at the highest value of a channel; None if they can be no clipped sun, being too
    few or too many.
    """
    height, width = pixels.shape[:2]
    flat = pixels.reshape(height, -1)
    ceiling = flat.max(axis=0).reshape(-1, 3).max(axis=0)
    wanted = np.tile(np.where(ceiling > 0, ceiling, np.nan), width).astype(np.float32)
    rows, columns = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)]
    found, block = 0, max(1, BLOCK_VALUES // width)
    for top in range(0, height, block):
        there = flat[top : top + block] == wanted
        if there.any():
            row, column = np.nonzero(there.reshape(len(there), width, 3).any(axis=2))
            rows.append(row + top)
            columns.append(column)
            found += len(row)
        if found > height * width // 8:
            return None
    return caps.texels(np.concatenate(rows), np.concatenate(columns)) if found >= PLATEAU else None


def is_clipped(excess: Excess, plateau: Texels | None, caps: Caps, mean: NDArray[np.float32]) -> bool:
    """As the module docstring has it. plateau: the `highest` texels. mean: of the three channels, (height, width), 0 for
    what shows nothing.
    """
    if plateau is None:
        return False
    here = plateau.within(excess.axis, -1, CAP)
    if len(here.rows) < PLATEAU or here.solid_angles.sum() < plateau.solid_angles.sum() / 2:
        return False
    peak, (core, texels) = float(excess.bright.max()), excess.core
    around = caps.cap(excess.axis, FARTHEST)
    far = around.within(excess.axis, FAR, FARTHEST)
    beyond = float(np.median(mean[far.rows, far.columns])) if len(far.rows) else 0.0
    size = 2 * core / np.sqrt(texels)  # of a texel, about
    edge = core + 0.8 * size  # an edge crosses texels whose centres are up to half a diagonal beyond it
    near, farther = (
        _average(mean, around.within(excess.axis, *ring)) - beyond
        for ring in ((edge, edge + max(core, 2 * size)), (FAR / 2, FAR))
    )
    return peak >= CONTRAST * beyond and near >= max(GLOW * (peak - beyond), FALL * farther)


def _average(mean: NDArray[np.float32], texels: Texels) -> float:
    """The mean radiance of texels and channels; 0 of none."""
    total = float(texels.solid_angles.sum())
    return float(texels.solid_angles @ mean[texels.rows, texels.columns]) / total if total else 0.0
