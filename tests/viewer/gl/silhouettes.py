"""The outline of a surface |f| seen from afar, in float64 and without any mesh or grid of the product.

A ray at the distance r from the centre of the picture, in the direction a on the screen, passes the points that lie g out of
the plane of the screen at the radius r / cos g. It hits the surface if one of them has |f| >= r / cos g. So the outline is
R(a), the maximum over g of |f(a, g)| cos g, and everything inside it is covered.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.viewer.composing.panes import Sphere

ANGLES, DEPTHS = 2048, 240


def outline(values: Callable[[Array], Array], light_from_view: Array) -> Array:
    """R at ANGLES directions a = 0, ..., 2 pi, counterclockwise from the right, in units of radius 1.

    values: directions (k, 3) in the frame of the light -> (k,). Maxima are those of parabolas through three depths.
    """
    angle = 2 * np.pi * np.arange(ANGLES) / ANGLES
    depth = np.pi * (np.arange(DEPTHS + 1) / DEPTHS - 0.5)
    found = np.empty(ANGLES)
    for some in np.array_split(np.arange(ANGLES), 64):
        a = angle[some, None]
        parts = (
            np.cos(depth) * np.cos(a),
            np.cos(depth) * np.sin(a),
            np.broadcast_to(np.sin(depth), (len(some), len(depth))),
        )
        directions = np.stack(parts, axis=-1).reshape(-1, 3) @ light_from_view.T
        reach = np.abs(values(directions)).reshape(len(some), -1) * np.cos(depth)
        best = np.clip(reach.argmax(axis=1), 1, DEPTHS - 1)
        low, top, high = (np.take_along_axis(reach, (best + i)[:, None], axis=1)[:, 0] for i in (-1, 0, 1))
        bend = np.minimum(low + high - 2 * top, -1e-300)
        found[some] = np.maximum(top - (high - low) ** 2 / (8 * bend), np.maximum(low, high))
    return found


def coverage(outline_: Array, sphere: Sphere, width: int, height: int, rays: int = 8) -> Array:
    """The share of rays x rays rays that hit, of each pixel of a frame, (height, width), top row first."""
    x = (np.arange(width * rays) + 0.5) / rays - sphere.x
    y = sphere.y - (np.arange(height * rays) + 0.5) / rays
    hit = np.empty((height * rays, width * rays), dtype=bool)
    for row, up in enumerate(y):
        position = np.arctan2(up, x) % (2 * np.pi) * (ANGLES / (2 * np.pi))
        radius = np.interp(position, np.arange(ANGLES + 1), np.append(outline_, outline_[0])) * sphere.radius
        hit[row] = np.hypot(x, up) <= radius
    return np.asarray(hit.reshape(height, rays, width, rays).mean(axis=(1, 3)))
