"""Texels that the rim of a disc cuts: quadrature points and weights on the part inside the unit circle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array


@dataclass(frozen=True, eq=False)
class RimPoints:
    """Points (k, n) in k pieces of rectangles. x and y are not negative; depth is sqrt(1 - x^2 - y^2), without cancellation.

    weights: their areas. texels: the index of each piece's rectangle, (k,).
    """

    x: Array
    y: Array
    depth: Array
    weights: Array
    texels: NDArray[np.int64]


def rim_points(x0: Array, x1: Array, y0: Array, y1: Array, n_points: int) -> RimPoints:
    """Gauss's rule on the part of rectangles [x0, x1] x [y0, y1] inside the unit circle; limits (k,) each, not negative.

    With y = sin(p) and x = cos(p) sin(t) the circle is t = pi/2 and sqrt(1 - x^2 - y^2) = cos(p) cos(t), so that nothing is
    singular there. Where the circle leaves the rectangle through a side x = x', which is p' = acos(x'), the limits in t go
    like sqrt(p' - p): substituting p = p' - s^2 makes them smooth as well. Below p' of the outer side the rectangle is whole,
    above it the circle bounds it: two parts of n_points^2 points. Both roots and polynomials in x and y are analytic.
    """
    node, weight = np.polynomial.legendre.leggauss(n_points)
    node, weight = (1 + node) / 2, weight / 2
    lowest, highest = np.arcsin(np.minimum(y0, 1)), np.arcsin(np.minimum(y1, 1))
    outer, inner = np.arccos(np.minimum(x1, 1)), np.arccos(np.minimum(x0, 1))
    parts = []
    for leaves, start, stop, bound in (
        (outer, lowest, np.minimum(highest, outer), x1),
        (inner, np.maximum(lowest, outer), np.minimum(highest, inner), np.full_like(x1, np.inf)),
    ):
        texels = np.flatnonzero(stop > start)
        leaves, start, stop, bound, left = (a[texels, None, None] for a in (leaves, start, stop, bound, x0))
        first, last = np.sqrt(leaves - stop), np.sqrt(leaves - start)
        s = first + (last - first) * node[:, None]
        angle = leaves - s * s
        c = np.cos(angle)
        t0, t1 = np.arcsin(np.minimum(left / c, 1)), np.arcsin(np.minimum(bound / c, 1))
        t = t0 + (t1 - t0) * node
        depth = c * np.cos(t)
        weights = (2 * s * (last - first) * weight[:, None] * c) * ((t1 - t0) * weight) * depth
        y = np.broadcast_to(np.sin(angle), t.shape)
        parts.append([a.reshape(len(texels), n_points**2) for a in (c * np.sin(t), y, depth, weights)] + [texels])
    x, y, depth, weights = (np.concatenate([part[i] for part in parts]) for i in range(4))
    return RimPoints(x, y, depth, weights, np.concatenate([part[4] for part in parts]))
