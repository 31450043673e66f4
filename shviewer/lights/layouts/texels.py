"""Exact integrals over a few texels of an image, for what is taken out of it: it need not be projected once more.

Direction and density are analytic in the place within a texel, so that Gauss's rule with a few points a side is exact to
rounding: enough for the phase of the shortest wave from its middle to its edge, and for functions that are analytic as far
as FAR half sides of it.
"""

from __future__ import annotations

from collections.abc import Callable
from math import ceil
from typing import TypeAlias

import numpy as np

from shviewer.harmonics.areas.chebyshev import point_count
from shviewer.harmonics.areas.patches import project_mirrored
from shviewer.harmonics.basis import Array
from shviewer.harmonics.quadrature import gauss_unit

Places: TypeAlias = Callable[[Array, Array], tuple[Array, Array]]
"""Places within all texels, right and down from 0 to 1, (j, 1) each -> unit directions (j, k, 3) and density (j, k).

The density is in steradians per area of the texel.
"""

FAR = 8

FEWEST_POINTS = 6
"""Gauss's points a side: with FAR, the error falls by (FAR + sqrt(FAR^2 - 1))^2 = 250 with each of them, here to 4e-15."""


def integrate_texels(places: Places, values: Array, n_bands: int, texels: int) -> Array | None:
    """Coefficients (n**2, 3) of an image that is black but for k texels of `values`, (k, 3).

    None where that takes about as long as projecting all `texels` of the image, and their memory.
    """
    corners = places(np.array([[0.0], [1.0], [0.0]]), np.array([[0.0], [0.0], [1.0]]))[0]
    longest = float(np.linalg.norm(corners[1:] - corners[0], axis=-1).max(initial=0.0))
    side = max(FEWEST_POINTS, ceil(point_count(n_bands * longest / 2) / 2))
    if 4 * len(values) * side**2 > texels:
        return None
    nodes, weights = gauss_unit(side)
    right, down = (grid.reshape(-1, 1) for grid in np.meshgrid(nodes, nodes))
    directions, density = places(right, down)
    weighted = (density * np.outer(weights, weights).reshape(-1, 1))[..., None] * values
    return project_mirrored(directions.reshape(-1, 3), weighted.reshape(1, 1, 1, -1, 3), n_bands)
