"""Cells of the sphere with Gauss points in each, and the projection of all of them at once.

The strips of the look (look.py) are divided into squares of 8 x 8 of its points, the roots: cells of depth 0. A cell divides
into four. One of depth d spans 1 / 2**d of its root along theta and along u, where phi = pi (1 - 2u), and is integrated by
POINTS x POINTS Gauss points: with a function that is a polynomial there, exactly, times the basis of 128 bands to 1e-10.

Values in the descendants of a root are carried to NODES x NODES Gauss nodes of the root. The weight W of a node is the integral
of the function times the polynomial K that is 1 there and 0 at the other nodes; so the sum of W K over the nodes is the
integral of f K for every K that is such a polynomial, as the basis is in a root to 5e-7 of its size.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial.legendre import legvander
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, Indices
from shviewer.harmonics.projection.row_transform import by_parity
from shviewer.harmonics.quadrature import Radiance, angles_from_directions, directions_from_angles, gauss_unit
from shviewer.harmonics.sampling.look import BLOCK, LOOK_COLUMNS, N_STRIPS, STRIP_ROWS, strides
from shviewer.harmonics.theta_series import from_waves

POINTS, NODES = 8, 12
"""Gauss points along a side of a cell, and nodes along a side of a root."""

HIGHEST = 2
"""How many of the POINTS terms of a polynomial tell whether there should be more."""


def sectors() -> Indices:
    """How many roots each strip has, (N_STRIPS,)."""
    return np.asarray(LOOK_COLUMNS // STRIP_ROWS // strides())


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells of one depth: strip and sector of their roots, and place in the root along u and theta, in cells; (n,) each."""

    strip: Indices
    sector: Indices
    across: Indices
    down: Indices
    depth: int = 0

    @classmethod
    def roots(cls) -> Cells:
        """All cells of depth 0, strip by strip."""
        counts = sectors()
        strip = np.repeat(np.arange(N_STRIPS), counts)
        sector = np.arange(len(strip)) - np.repeat(np.cumsum(counts) - counts, counts)
        return cls(strip, sector, 0 * strip, 0 * strip)

    def __len__(self) -> int:
        return len(self.strip)

    def __getitem__(self, which: NDArray[np.bool_] | Indices | slice) -> Cells:
        return replace(
            self, strip=self.strip[which], sector=self.sector[which], across=self.across[which], down=self.down[which]
        )

    def divided(self) -> Cells:
        """Their quarters, four in a row: upper left, upper right, lower left, lower right."""
        quarter = np.arange(4 * len(self)) % 4
        whole = self[np.repeat(np.arange(len(self)), 4)]
        return replace(
            whole, across=2 * whole.across + quarter % 2, down=2 * whole.down + quarter // 2, depth=self.depth + 1
        )

    @property
    def root(self) -> Indices:
        """The number of the root, counted strip by strip."""
        return np.asarray((np.cumsum(sectors()) - sectors())[self.strip] + self.sector)

    def beside(self, sides: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which cells, (n,), touch a marked side of another: sides (n, 4), those of left, right, top and bottom."""
        per_row, n_rows = sectors() << self.depth, N_STRIPS << self.depth
        row, column = (self.strip << self.depth) + self.down, (self.sector << self.depth) + self.across
        count = per_row[self.strip]
        sought = []
        for side, step in ((0, -1), (1, 1)):
            here = sides[:, side]
            sought.append(_key(row[here], (column[here] + step) % count[here]))
        for side, step in ((2, -1), (3, 1)):
            here = sides[:, side]
            other = row[here] + step
            beyond = (other < 0) | (other >= n_rows)  # over a pole, half way round
            other = np.where(beyond, row[here], other)
            there = per_row[other >> self.depth]
            for quarter in (1, 3):  # the other row may have twice as many or half as many
                place = (4 * column[here] + quarter) * there // (4 * count[here])
                sought.append(_key(other, (place + beyond * there // 2) % there))
        return np.isin(_key(row, column), np.concatenate(sought))

    def theta(self, at: Array) -> Array:
        """Angles to +z at places `at` (k,), 0 to 1 downwards: (n, k)."""
        return np.asarray(np.pi / N_STRIPS * (self.strip[:, None] + (self.down[:, None] + at) / 2**self.depth))

    def phi(self, at: Array) -> Array:
        """Azimuths at places `at` (k,), 0 to 1 from left to right: (n, k)."""
        u = (self.sector[:, None] + (self.across[:, None] + at) / 2**self.depth) / sectors()[self.strip][:, None]
        return np.asarray(np.pi * (1 - 2 * u))

    @property
    def width(self) -> Array:
        """Extent in phi, radians, (n,)."""
        return np.asarray(2 * np.pi / (sectors()[self.strip] * 2.0**self.depth))

    def weights(self) -> Array:
        """Steradians of the points: (n, POINTS of theta), for each of the points of phi."""
        at, share = gauss_unit(POINTS)
        height = np.pi / (N_STRIPS * 2.0**self.depth)
        return np.asarray(np.sin(self.theta(at)) * share * height * self.width[:, None])

    def evaluate(self, radiance: Radiance) -> Array:
        """Values at the points: (n, POINTS of theta, POINTS of phi, 3)."""
        at, _ = gauss_unit(POINTS)
        values = np.empty((len(self), POINTS, POINTS, 3))
        step = BLOCK // POINTS**2
        for start in range(0, len(self), step):
            part = self[start : start + step]
            directions = directions_from_angles(part.theta(at)[:, :, None], part.phi(at)[:, None, :])
            values[start : start + step] = radiance(directions.reshape(-1, 3)).reshape(-1, POINTS, POINTS, 3)
        return values


def _key(row: Indices, column: Indices) -> Indices:
    return (row << 32) + column


def shares(at: Array, count: int) -> Array:
    """The polynomials that are 1 at one of `count` Gauss points and 0 at the others, at places (...) in [0, 1]: (..., count).

    They are the sums over k < count of w (2k+1) P(k)(point) P(k)(place), since Gauss weights w make the P(k) orthogonal.
    """
    points, weights = gauss_unit(count)
    at_points = legvander(2 * points - 1, count - 1) * (2 * np.arange(count) + 1) * weights[:, None]
    return np.asarray(legvander(2 * at - 1, count - 1) @ at_points.T)


def locate(directions: Array) -> tuple[Indices, Array, Array]:
    """The roots that unit directions (k, 3) lie in, by number, and the places across and down in them, 0 to 1: (k,) each."""
    theta, phi = angles_from_directions(directions)
    down = theta * (N_STRIPS / np.pi)
    strip = np.minimum(down.astype(np.int64), N_STRIPS - 1)
    counts = sectors()
    across = (0.5 - phi / (2 * np.pi)) * counts[strip]
    sector = np.minimum(across.astype(np.int64), counts[strip] - 1)
    return (np.cumsum(counts) - counts)[strip] + sector, across - sector, down - strip


def highest_terms(values: Array) -> tuple[Array, Array]:
    """The largest magnitude of the HIGHEST terms of polynomials in values (n, POINTS, POINTS, 3): (n, 3), and (n, 4).

    The first is of all rows and columns of points, by channel; the second of those next to the left, the right, the upper and
    the lower side, over all channels. The terms are those of Legendre polynomials.
    """
    points, weights = gauss_unit(POINTS)
    degrees = np.arange(POINTS)[-HIGHEST:]
    analysis = (2 * degrees[:, None] + 1) * (legvander(2 * points - 1, POINTS - 1) * weights[:, None]).T[-HIGHEST:]
    columns = np.abs(analysis @ values.reshape(len(values), POINTS, -1)).max(axis=1).reshape(len(values), POINTS, 3)
    rows = np.abs(analysis @ values).max(axis=2)
    sides = np.stack([columns[:, 0], columns[:, -1], rows[:, 0], rows[:, -1]], axis=1)
    return np.maximum(columns, rows).max(axis=1), sides.max(axis=2)


def to_nodes(cells: Cells, weighted: Array, sums: Array) -> None:
    """Add weighted values (n, POINTS, POINTS, 3) of cells to the nodes of their roots, sums (roots, NODES, NODES, 3)."""
    at, _ = gauss_unit(POINTS)
    order = np.argsort(cells.root, kind="stable")
    for start in range(0, len(cells), 1024):
        part = order[start : start + 1024]
        some = cells[part]
        down, across = (
            shares((place[:, None] + at) / 2**cells.depth, NODES).transpose(0, 2, 1)
            for place in (some.down, some.across)
        )
        rows = (down @ weighted[part].reshape(len(part), POINTS, -1)).reshape(len(part), NODES, POINTS, 3)
        nodes = across[:, None] @ rows
        root = some.root
        firsts = np.flatnonzero(np.r_[True, np.diff(root) != 0])
        sums[root[firsts]] += np.add.reduceat(nodes, firsts, axis=0)


def project(layers: list[Array], n_bands: int) -> Array:
    """Coefficients (n_bands**2, 3) from weighted values at Gauss points of all roots: arrays (roots, k, k, 3)."""
    orders = np.arange(n_bands)
    counts = sectors()
    by_order = np.zeros((n_bands, 2, 3, n_bands))
    firsts = np.cumsum(counts) - counts
    for layer in layers:
        at, _ = gauss_unit(layer.shape[1])
        for count in np.unique(counts):
            strips = np.flatnonzero(counts == count)
            which = (firsts[strips][:, None] + np.arange(count)).ravel()
            values = layer[which].reshape(len(strips), count, len(at), len(at), 3)  # strip, sector, theta, phi, channel
            used = values.any(axis=(1, 2, 3, 4))
            if not used.any():
                continue
            strips, values = strips[used], values[used]
            u = (np.arange(count)[:, None] + at).ravel() / count
            angle = orders[:, None] * (np.pi * (1 - 2 * u))
            azimuth = np.concatenate([np.cos(angle), np.sin(angle)])
            columns = values.transpose(1, 3, 0, 2, 4).reshape(len(u), -1)
            sums = (azimuth @ columns).reshape(2, n_bands, -1, 3)  # {cos, sin}, m, theta, channel
            theta = np.pi / N_STRIPS * (strips[:, None] + at).ravel()
            along = theta[:, None] * by_parity(n_bands)
            for parity, wave in enumerate((np.cos(along), np.sin(along))):
                part = sums[:, parity::2].transpose(1, 0, 3, 2)
                by_order[parity::2] += (part.reshape(-1, len(theta)) @ wave).reshape(*part.shape[:3], n_bands)
    return from_waves(by_order)
