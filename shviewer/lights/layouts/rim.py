"""Texels next to the rim of a disc: integrated along their edges, on which nothing is singular.

The rim is one point of the sphere, straight back, so a texel that it cuts is bounded by the texel's own edges alone, and
boundary.py makes coefficients of integrals along them. The pole that must not be in the
area is straight ahead: axes are exchanged for that. On the line Y = y of the image, with rho^2 = 1 - y^2,
    X = rho cos t,      depth sqrt(1 - X^2 - y^2) = rho sin t,
and directions are analytic in t up to the rim, at t = 0. Neighbours share an edge, so that a line carries the differences of
the texels on either side; with Chebyshev points in t their integrals are closed forms, as in patches.py.

A quadrant has X and Y from 0 to 1, in world directions +y and +z; the others are its mirror images.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.boundary import project_boundary
from shviewer.harmonics.areas.chebyshev import (
    chebyshev_points,
    chebyshev_shares,
    chebyshev_values,
    integrate_series,
    point_count,
    points_from_series,
)
from shviewer.harmonics.areas.cycling import cycled
from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.quadrature import gauss_unit

GROUPS = 4
"""Groups of neighbouring lines, over equal angles, that share their points: directions are smooth across lines, too."""

MORE_POINTS = 35
"""How many more Chebyshev points than radians of a wave a line has for the sake of d(phi), which is infinite in the middle."""

FEWEST_LINES, MOST_LINES, LINE_TEXELS = 8, 64, 2048
"""Lines whose polynomials are held at once, and about how many texels on them, if they are few."""

AREA_POINTS = 24
"""Gauss's points on an edge that make its part of an area exact to rounding, even in an image of three texels."""


class Disc(ABC):
    """How a disc covers the sphere, and the texels of a quadrant."""

    @property
    @abstractmethod
    def edges(self) -> Array:
        """From 0 to 1, (half + 1,)."""

    @property
    @abstractmethod
    def reach(self) -> Indices:
        """The number of texels in each row, or column, of which some part lies inside, (half,)."""

    @abstractmethod
    def from_behind(self, depth: Array) -> Array:
        """pi - theta, the angle from straight back, at a depth: 0 on the rim, without cancellation."""


Line: TypeAlias = Callable[[Array, Array, Array], Array]
"""Directions (3, ...) on lines of the quadrant, from y, x and depth."""


def quadrants(pixels: NDArray[np.float32]) -> list[NDArray[np.float32]]:
    """Views (half, half, 3) of a square image's quadrants, from the centre outwards: upper and lower left, then right."""
    side = len(pixels)
    towards, away = slice((side - 1) // 2, None, -1), slice(side // 2, None)
    return [pixels[rows, columns] for columns in (towards, away) for rows in (towards, away)]


def project_rim(disc: Disc, on_line: Line, pixels: NDArray[np.float32], inside: Indices, n_bands: int) -> Array:
    """Coefficients (n**2, 3) of the texels from column inside[row] on to the rim, in all four quadrants.

    inside: (half,), descending, the same for rows and columns. The middle must not be among the texels, or next to them.
    """
    views, directions, values = quadrants(pixels), [], []
    starts = (len(inside) * np.sin(np.linspace(0, np.pi / 2, GROUPS + 1))).astype(np.int64).tolist()
    for lines in map(slice, starts, starts[1:]):
        direction, along, across = _on_lines(disc, on_line, views, inside, lines, n_bands)
        # On lines of constant X, coordinates change places.
        directions += [direction, direction[[0, 2, 1]]]
        values += [along, across]
    x, y, z = np.concatenate(directions, axis=1)
    # Values (left and right, down and up), their axes from y and z to x and y.
    return cycled(project_boundary(np.stack([y, z, x], axis=-1), np.concatenate(values, axis=2)[:, :, None], n_bands))


def _on_lines(
    disc: Disc, on_line: Line, views: list[NDArray[np.float32]], inside: Indices, lines: slice, n_bands: int
) -> tuple[Array, Array, Array]:
    """Directions (3, k) at points that stand for some lines of constant Y, and values there, (2, 2, k, 3), times d(phi).

    Values also of the image with X and Y exchanged, whose lines are those of constant X.
    """
    edges = disc.edges
    y = edges[lines, None]
    rho = np.sqrt((1 - y) * (1 + y))
    angle = np.arctan2(rho, y)[:, 0]
    length = float(_parameter(edges[inside[lines], None], rho).max())
    middle, half = (angle[0] + angle[-1]) / 2, max(angle[0] - angle[-1], 1e-9) / 2
    n_along, n_across = _point_counts(on_line, length, middle, half, n_bands)
    shares = chebyshev_shares((angle - middle) / half, n_across)
    sums = np.zeros((n_across, n_along + 1, 24))
    start = lines.start
    while start < lines.stop:
        columns = int(disc.reach[max(start - 1, 0)]) - int(inside[min(start + MOST_LINES, lines.stop) - 1])
        some = slice(start, min(start + max(FEWEST_LINES, min(MOST_LINES, LINE_TEXELS // columns)), lines.stop))
        here = slice(some.start - lines.start, some.stop - lines.start)
        first, last = int(inside[some.stop - 1]), int(np.searchsorted(edges[:-1], rho[here][0, 0]))
        ends = np.minimum(_parameter(edges[first : last + 1], rho[here]), length)
        polynomials = chebyshev_values(2 * ends / length - 1, n_along + 1)
        by_line = polynomials.swapaxes(0, 1) @ _corners(disc, views, inside, some, first, last)
        sums += (shares[:, here] @ by_line.reshape(len(by_line), -1)).reshape(sums.shape)
        start = some.stop
    values = points_from_series(n_along) @ integrate_series(sums.swapaxes(0, 1)).swapaxes(0, 1) * (length / 2)
    along, across = values.reshape(-1, 2, 2, 2, 3).transpose(1, 2, 3, 0, 4)
    y, rho = _circle(middle + half * chebyshev_points(n_across)[:, None])
    x, depth = _place(rho, length * (1 + chebyshev_points(n_along)) / 2)
    turning = (y * depth / (1 - depth**2)).ravel()  # d(phi)/dt about the direction ahead; on lines of constant X, too
    return on_line(y, x, depth).reshape(3, -1), along * turning[:, None], across * turning[:, None]


def _point_counts(on_line: Line, length: float, middle: float, half: float, n_bands: int) -> tuple[int, int]:
    """Chebyshev points along lines and across them, by the longest way that a direction goes, from a few of them."""
    y, rho = _circle(middle + half * np.linspace(-1, 1, 9)[:, None])
    directions = on_line(y, *_place(rho, length * np.linspace(0, 1, 9)))
    across, along = (8 * float(np.linalg.norm(np.diff(directions, axis=axis), axis=0).max()) for axis in (1, 2))
    return point_count(n_bands * along / 2, MORE_POINTS), point_count(n_bands * across / 2, MORE_POINTS)


def _circle(angle: Array) -> tuple[Array, Array]:
    """y and rho of the lines at an angle, in which directions are analytic up to the top of the disc."""
    return np.cos(angle), np.sin(angle)


def _parameter(x: Array, rho: Array) -> Array:
    """The parameter t of places on a line; 0 beyond its end."""
    x = np.minimum(x, rho)
    return np.arctan2(np.sqrt((rho - x) * (rho + x)), x)


def _place(rho: Array, t: Array) -> tuple[Array, Array]:
    return rho * np.cos(t), rho * np.sin(t)


def _corners(
    disc: Disc, views: list[NDArray[np.float32]], inside: Indices, lines: slice, first: int, last: int
) -> Array:
    """The weights of antiderivatives at the corners on some lines, (lines, last - first + 1, 24).

    That of an edge, of the texel above minus the one below, counts at its end and is taken off at its beginning. Texels that
    are not next to the rim count as 0. The last axis: the image and the one with X and Y exchanged, quadrant, channel.
    """
    rows, columns = np.arange(lines.start - 1, lines.stop), np.arange(first, last)
    texels = np.zeros((len(rows), len(columns) + 2, 2, 4, 3))
    above = slice(max(rows[0], 0), lines.stop)
    for i, view in enumerate(views):
        for turned, image in enumerate((view, view.swapaxes(0, 1))):
            texels[above.start - lines.start + 1 :, 1:-1, turned, i] = image[above, first:last]
    texels[:, 1:-1][(columns < inside[rows, None]) | (columns >= disc.reach[rows, None])] = 0.0
    if lines.start == 0:
        texels[0] = 0.0
    edges = np.diff(texels.reshape(*texels.shape[:2], -1), axis=0)
    return edges[:, :-1] - edges[:, 1:]


def cut_areas(disc: Disc, rows: Indices, columns: Indices) -> Array:
    """Steradians (k,) of the part inside the disc of texels at rows and columns (k,) of a quadrant, which the rim cuts.

    The area is the integral of -(1 + cos theta) d(phi) along the boundary, theta and phi about the direction ahead.
    """
    if len(disc.edges) == 2:
        return np.full(len(rows), np.pi)
    area = np.zeros(len(rows))
    for lines, places in ((rows, columns), (columns, rows)):
        for first, sign in ((lines, 1), (lines + 1, -1)):
            area += sign * _swept(disc, first, places, lambda behind, y, x: 2 * np.sin(behind / 2) ** 2)
    return area


def cut_rises(disc: Disc, rows: Indices, columns: Indices) -> Array:
    """The integral (k,) of the height over the same parts, which is sin(theta) sin(phi).

    That of F(theta) sin(phi) d(phi) along the boundary, with F' = sin(theta)^2 and F(pi) = 0.
    """
    if len(disc.edges) == 2:
        return np.full(len(rows), np.pi / 2)
    rise = np.zeros(len(rows))
    for lines, places, upright in ((rows, columns, False), (columns, rows, True)):

        def height(behind: Array, y: Array, x: Array, upright: bool = upright) -> Array:
            return (behind - np.sin(2 * behind) / 2) / 2 * (x if upright else y) / np.hypot(x, y)

        rise += _swept(disc, lines, places, height) - _swept(disc, lines + 1, places, height)
    return rise


def _swept(disc: Disc, lines: Indices, places: Indices, value: Callable[[Array, Array, Array], Array]) -> Array:
    """The integral of value * y dX / (X^2 + y^2) along one texel's edge, (k,), on the line y = edges[lines].

    value: of the angle from straight back, y and X.
    """
    y = disc.edges[lines, None]
    rho = np.sqrt((1 - y) * (1 + y))
    start, stop = (_parameter(disc.edges[at, None], rho) for at in (places + 1, places))
    nodes, weights = gauss_unit(AREA_POINTS)
    x, depth = _place(rho, start + (stop - start) * nodes)
    found = value(disc.from_behind(depth), y, x) * depth / (1 - depth**2)
    return np.asarray(found @ weights * ((stop - start) * y)[:, 0])
