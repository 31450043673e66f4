"""Exact sums over the picture of a mirror ball: of values at points, and of texels next to the rim, from their edges.

The picture is the hemisphere of the mirror's normals h, seen from straight ahead: with X and Y in units of its radius,
    h = (X, Y, s),   s = sqrt(1 - X^2 - Y^2),   direction = 2 s h - (0, 0, 1),   d(omega) = 4 dX dY,
about the axis ahead. So a function of degree l is a polynomial of degree 2l in h. The line Y = cos(psi) is a circle on the
hemisphere, X + i s = sin(psi) e^it, where it is a trigonometric polynomial of t, and for one t of psi. With their parities it
is given by its values at n + 1 angles in a quarter turn each: nothing is approximated, up to the rim, where s = 0.

An area is an integral along its boundary by Green's theorem, as d(omega) = -d(cos theta) d(phi) and d(cos theta) = -2 d(r^2):
    the integral of Y(l, m) over an area = -4/m times that of Y(l, -m) (X dX + Y dY) along its boundary,   for m not 0,
                        of Y(l, 0)       = that of F(theta) (X dY - Y dX) / r^2,   F' = Y(l, 0) sin(theta),   F(0) = F(pi) = 0,
counterclockwise. The rim, which cuts texels, adds nothing, and nothing happens in the middle. Along an edge the integrals of
waves in t are closed forms at its ends, so that the second differences of the texels count at their corners. Edges of constant
X are those of constant Y with X and Y exchanged.

Waves at corners are rounded, by 3e-16 times the texel's value whatever its size: a lone one of 1024 x 1024 is 1e-11 off,
noise 1e-13. So edges are for texels that are too near the rim to be summed by points.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.eightfold import eightfold_waves, waves
from shviewer.harmonics.basis import Array, Indices, check_bands, orders
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS, from_waves

TEXELS, WAVE_VALUES = 2**15, 2**20
"""Texels on lines whose edges are summed at a time, if all were, and values of the waves there."""


class BallSums:
    """Sums against all functions of fewer than n_bands degrees, by quadrants from the centre on.

    X and Y are the first two axes of their world, straight ahead is the third. Along and across lines of constant Y: 0 for what
    is even, the sum of both sides of the middle, 1 for the first side minus the second.
    """

    def __init__(self, n_bands: int) -> None:
        check_bands(n_bands, MAX_SEPARABLE_BANDS)
        self.n_bands, self.n_nodes = n_bands, n_bands + 1
        n = self.n_nodes
        self.points = np.zeros((2, 2, n, 3, n))  # odd along, odd across, node of psi, channel, function of t
        self.edges = np.zeros((2, 2, n, 2, 3, n + 1))  # even along and across; lines of constant Y, or of constant X
        self.rings = np.zeros((n, 3, n + 1))  # even in both, for m = 0
        self.band_0 = np.zeros(3)

    def add_points(self, x: Array, y: Array, values: Array) -> None:
        """Add values in X = +-x, Y = +-y, times steradians: (2, 2, y, 3, x), by the sides of X and of Y; they are changed."""
        _fold(values)
        rho = np.sqrt((1 - y) * (1 + y))
        found = _sums_on_lines(values[::-1, ::-1], *_on_circle(x, rho[:, None]), self.n_nodes)
        self.points += _at_nodes(_shares(y, rho, self.n_nodes), found)

    def add_rim(self, views: list[NDArray[np.floating]], inside: Indices, edges: Array, areas: Array) -> None:
        """Add texels of the quadrants (half, half, 3) from column inside[row] on, descending, the same for rows and columns.

        views: of X and Y positive, X positive and Y negative, and so for X negative. edges: (half + 1,), from 0 to 1. areas:
        steradians (half, half).
        """
        all_rho = np.sqrt((1 - edges) * (1 + edges))
        reach = np.searchsorted(edges[:-1], all_rho)
        step = max(1, TEXELS // len(areas))
        for start in range(0, len(areas), step):
            lines = slice(start, min(start + step, len(areas)))
            columns = slice(int(inside[lines.stop - 1]), int(reach[max(start - 1, 0)]))
            rows = [_folded_rows(views, inside, lines, columns)]
            self.band_0 += np.einsum("crx,rx->c", rows[0][0, 0, :, 1:], areas[lines, columns])
            rows.append(_folded_rows([views[i].swapaxes(0, 1) for i in (0, 2, 1, 3)], inside, lines, columns))
            jumps = np.stack([np.diff(family, axis=3).swapaxes(2, 3) for family in rows], axis=3)
            jumps *= (np.arange(columns.start, columns.stop) < reach[lines, None])[:, None, None]
            corners = np.empty((*jumps.shape[:-1], jumps.shape[-1] + 1))
            corners[..., 0], corners[..., -1] = jumps[..., 0], -jumps[..., -1]
            np.subtract(jumps[..., 1:], jumps[..., :-1], out=corners[..., 1:-1])
            y, rho = edges[lines], all_rho[lines]
            cosine, sine = _on_circle(edges[columns.start : columns.stop + 1], rho[:, None])
            found = np.zeros((*corners.shape[:-1], self.n_nodes + 1))
            found[..., :-1] = _sums_on_lines(corners, cosine, sine, self.n_nodes)
            angle = np.arctan2(sine, cosine) / np.where(sine > 0, sine, 1.0)
            found[0, 1, ..., -1] = np.einsum("lfce,le->lfc", corners[0, 1], angle)
            shares = _shares(y, rho, self.n_nodes)
            self.edges += _at_nodes(shares * rho**2, found)
            self.rings += np.tensordot(shares[1] * (rho * y), found[0, 0].sum(axis=1), 1)

    def coefficients(self) -> Array:
        """Coefficients (n_bands**2, 3)."""
        n, nodes, (of_points, of_edges) = self.n_nodes, _node_angles(self.n_nodes), _to_nodes(self.n_nodes)
        x, y = np.sin(nodes)[:, None] * np.cos(nodes), np.cos(nodes)[:, None] * np.ones(n)
        s = np.sin(nodes)[:, None] * np.sin(nodes)
        directions = np.stack([2 * s * x, 2 * s * y, 2 * s * s - 1], axis=-1).reshape(-1, 3)
        values = (self.points.reshape(2, 2, -1, n) @ of_points).reshape(2, 2, n, 3, n).swapaxes(2, 3)
        weights = (self.edges.reshape(2, 2, -1, n + 1) @ of_edges).reshape(2, 2, n, 2, 3, n).transpose(3, 0, 1, 4, 2, 5)
        weights = weights * (4 * np.sin(nodes) * np.cos(nodes))
        own = np.concatenate([weights[0], values], axis=2)[::-1, ::-1].reshape(2, 2, 6, -1)
        exchanged = -weights[1, ::-1, ::-1].swapaxes(0, 1).reshape(2, 2, 3, -1)
        found, m = from_waves(eightfold_waves(directions, own, exchanged, self.n_bands)), orders(self.n_bands)
        result = found[:, 3:] - found[np.arange(len(m)) - 2 * m, :3] / np.where(m == 0, np.inf, m)[:, None]
        result[0] += self.band_0 / np.sqrt(4 * np.pi)
        rings = (self.rings.reshape(-1, n + 1) @ of_edges[0, 0]).reshape(n, 3, n).swapaxes(1, 2)
        rings = (rings * (-np.sin(nodes)[:, None] / (x * x + y * y)[..., None])).reshape(-1, 3)
        z = directions[:, 2]
        before, now = np.ones_like(z), z
        for l in range(
            1, self.n_bands
        ):  # F is the difference of the Legendre polynomials before and after, over 2l + 1
            after = ((2 * l + 1) * z * now - l * before) / (l + 1)
            result[l * (l + 1)] += (before - after) @ rings / np.sqrt(4 * np.pi * (2 * l + 1))
            before, now = now, after
        return np.asarray(result)


def _folded_rows(views: list[NDArray[np.floating]], inside: Indices, rows: slice, columns: slice) -> Array:
    """Rows from the one before, without texels inside, folded: (along, across, channel, rows + 1, columns)."""
    first = max(rows.start - 1, 0)
    result = np.zeros((2, 2, 3, rows.stop - rows.start + 1, columns.stop - columns.start))
    values = result[..., first + 1 - rows.start :, :]
    for sides, view in zip(np.ndindex(2, 2), views, strict=True):
        np.copyto(values[sides], np.array(view[first : rows.stop, columns], order="K").transpose(2, 0, 1))
    for row in range(first, rows.stop):
        values[..., row - first, : max(int(inside[row]) - columns.start, 0)] = 0
    _fold(values)
    return result


def _fold(values: Array) -> None:
    """Make sums and differences along the first two axes."""
    for part in (values, values.swapaxes(0, 1)):
        part[0] += part[1]
        part[1] *= -2
        part[1] += part[0]


def _on_circle(x: Array, rho: Array) -> tuple[Array, Array]:
    """cos(t) and sin(t) at x, or where the line ends."""
    x = np.minimum(x, rho)
    return x / rho, np.sqrt((rho - x) * (rho + x)) / rho


def _sums_on_lines(weights: Array, cosine: Array, sine: Array, n: int) -> Array:
    """Sums of weights times 2 cos(k t), k odd where `along` is 0 and even where it is 1: (along, across, line, any, n).

    Where `along` is not `across`, times sin(t). weights: (along, across, line, any, place), which are changed. cosine, sine:
    (line, place).
    """
    shape = weights.shape[:-1]
    for along in (0, 1):
        weights[along, 1 - along] *= sine.reshape(len(sine), *[1] * (len(shape) - 3), -1)
    weights = weights.reshape(2, 2, len(cosine), -1, weights.shape[-1])
    result = np.empty((*weights.shape[:-1], n))
    step = max(1, WAVE_VALUES // (2 * n * cosine.shape[1]))
    for top in range(0, len(cosine), step):
        some = slice(top, top + step)
        functions = _twice_the_cosines(cosine[some], 2 * n)
        for along in (0, 1):
            np.matmul(weights[along, :, some], functions[1 - along :: 2].transpose(1, 2, 0), out=result[along, :, some])
    return result.reshape(*shape, n)


def _twice_the_cosines(cosine: Array, n: int) -> Array:
    """2 cos(k t) for k < n, (n, ...), each from those of half k."""
    table = np.empty((n, *cosine.shape))
    table[0] = 2
    np.multiply(cosine, 2, out=table[1])
    k = 1
    while 2 * k < n:  # a power of 2: from those of k to 2k, those of 2k to 4k - 1
        even, odd = table[2 * k : 4 * k : 2], table[2 * k + 1 : 4 * k : 2]
        np.multiply(table[k : k + len(even)], table[k : k + len(even)], out=even)
        even -= 2
        np.multiply(table[k : k + len(odd)], table[k + 1 : k + 1 + len(odd)], out=odd)
        odd -= table[1]
        k *= 2
    return table


def _at_nodes(shares: Array, sums: Array) -> Array:
    """Sums over lines (along, across, line, ...) by the shares (across, node, line) of each node."""
    found = shares[:, None] @ sums.swapaxes(0, 1).reshape(2, 2, shares.shape[2], -1)
    return found.swapaxes(0, 1).reshape(2, 2, -1, *sums.shape[3:])


def _node_angles(n: int) -> Array:
    """Those of t, and those of psi."""
    return np.asarray((np.arange(n) + 0.5) * (np.pi / (2 * n)))


def _shares(cosine: Array, sine: Array, n: int) -> Array:
    """The share of each node in sums of sin(2k psi), or cos(2k psi), k < n, at angles psi: (2, node, angle)."""
    cosines, sines = waves((cosine - sine) * (cosine + sine), 2 * cosine * sine, n)
    return np.asarray(_node_waves(n) @ np.stack([sines, cosines]))


@lru_cache(maxsize=8)
def _node_waves(n: int) -> Array:
    """sin(2k psi) and cos(2k psi) at the nodes, times 2/n, for k = 0 once: (2, node, k)."""
    phase = 2 * np.arange(n) * _node_angles(n)[:, None]
    return np.asarray(np.stack([np.sin(phase), np.cos(phase)]) * np.where(np.arange(n) == 0, 1, 2) / n)


@lru_cache(maxsize=8)
def _to_nodes(n: int) -> tuple[Array, Array]:
    """From sums on lines to weights at the nodes of t, (along, across, function, node): of points, and of the ends of edges.

    An edge has the antiderivative of each function, and one function more, t, that of 1.
    """
    nodes, i = _node_angles(n), np.arange(n)[:, None]
    odd, even = 2 * i + 1, 2 * i
    points, edges = np.zeros((2, 2, n, n)), np.zeros((2, 2, n + 1, n))
    points[0, 0] = np.cos(odd * nodes)
    points[1, 1] = np.cos(even * nodes)
    points[1, 1, 0] /= 2
    points[1, 0], points[0, 1] = _of_odd_sines(np.sin(odd * nodes)), _of_even_sines(np.sin(even * nodes))
    edges[0, 0, :n] = -np.sin(odd * nodes) / odd
    edges[1, 1, 1:n] = -np.sin(even * nodes)[1:] / even[1:]
    edges[1, 0, :n] = _of_odd_sines(np.cos(odd * nodes) / odd * (i < n - 1))
    edges[0, 1, :n] = _of_even_sines(np.cos(even * nodes) / np.maximum(even, 1))
    edges[0, 1, n] = 1
    return points / n, edges / n


def _of_odd_sines(table: Array) -> Array:
    """Factors of 2 sin((2i+1) t) -> of s times 2 cos(2i t): sin((2i+1) t) = s (1 + 2 cos(2t) + ... + 2 cos(2i t))."""
    above = 2 * np.cumsum(table[::-1], axis=0)[::-1]
    above[0] /= 2
    return np.asarray(above)


def _of_even_sines(table: Array) -> Array:
    """Factors of 2 sin(2i t) -> of s times 2 cos((2i+1) t): sin(2i t) = 2 s (cos(t) + cos(3t) + ... + cos((2i-1) t))."""
    above = 2 * np.cumsum(table[:0:-1], axis=0)[::-1]
    return np.concatenate([above, np.zeros_like(table[:1])])
