"""Six square faces of a cube, each 90 degrees wide seen from the centre. An Arrangement says where they lie in the image.

OpenEXR puts the centres of a face's border texels on the cube's edges; here, as everywhere, texels are areas that tile a face.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.areas.cube import project_faces
from shviewer.harmonics.areas.patches import (
    above_the_middle,
    four_quadrants,
    quadrant_edges,
    quadrant_weights,
)
from shviewer.harmonics.basis import Array, Indices
from shviewer.lights.layouts.arrangements import Arrangement, Face
from shviewer.lights.layouts.bilinear import between_texels
from shviewer.lights.layouts.layout import raster_of
from shviewer.lights.layouts.texels import integrate_texels

AROUND = 1, 0, 1
"""The first of the two axes in a face, of those about x, y and z, as `project_faces` has them."""

_AXES = {sign + name: factor * np.eye(3)[i] for sign, factor in (("+", 1), ("-", -1)) for i, name in enumerate("xyz")}


@dataclass(frozen=True)
class CubeLayout:
    """A cube map in some arrangement. face: the side of a face in texels."""

    arrangement: Arrangement
    face: int
    name: str = field(default="cube", init=False)

    @property
    def size(self) -> str:
        return f"6 x {self.face} x {self.face}"

    @property
    def raster_width(self) -> int:
        """Columns of a lat-long image that is nowhere coarser than the middle of a face."""
        return 4 * self.face

    def solid_angles(self) -> Array:
        shape = (self.arrangement.rows * self.face, self.arrangement.columns * self.face)
        angles = np.zeros(shape)
        for face in self.arrangement.faces:
            angles[self._cell(face)] = self._face_solid_angles
        return angles

    def solid_angles_at(self, rows: Indices, columns: Indices) -> Array:
        shown = self.faces_by_cell[rows // self.face, columns // self.face] >= 0
        return np.where(shown, self._face_solid_angles[rows % self.face, columns % self.face], 0.0)

    def rises(self) -> Array:
        """As in Layout: in closed form on the upper face, and on the upper half of a side.

        With u and v from the middle of a face, v upwards on a side, z times the density is (1 + u^2 + v^2)^-2 and v times that.
        """
        edges = quadrant_edges(self.face)
        u, v = edges, edges[:, None]
        along, across = (a / np.sqrt(1 + a**2) * np.arctan(b / np.sqrt(1 + a**2)) / 2 for a, b in ((u, v), (v, u)))
        up, side = (
            four_quadrants(np.diff(np.diff(corner, axis=0), axis=1), self.face)
            for corner in (along + across, np.arctan(u / np.sqrt(1 + v**2)) / (-2 * np.sqrt(1 + v**2)))
        )
        side *= above_the_middle(self.face)
        upright = {"-z": side, "+z": side[::-1]}
        rises = np.zeros((self.arrangement.rows * self.face, self.arrangement.columns * self.face))
        for face in self.arrangement.faces:
            if face.centre == "+z":
                rises[self._cell(face)] = up
            elif face.centre != "-z":
                rises[self._cell(face)] = upright[face.down] if face.down in upright else upright[face.right].T
        return rises

    def nearest(self, directions: Array) -> tuple[Indices, Indices]:
        face, u, v = self._on_faces(directions)
        column = np.minimum((self.face * (u + 1) / 2).astype(np.int64), self.face - 1)
        row = np.minimum((self.face * (v + 1) / 2).astype(np.int64), self.face - 1)
        return row + self._corners[face, 0], column + self._corners[face, 1]

    def centres(self, rows: Indices, columns: Indices) -> Array:
        """As in Layout; for a texel in an empty cell, the middle of the front face."""
        face = self.faces_by_cell[rows // self.face, columns // self.face]
        u, v = ((2 * (index % self.face) + 1) / self.face - 1 for index in (columns, rows))
        directions = self._directions(np.maximum(face, 0), u, v)
        directions[face < 0] = [1.0, 0.0, 0.0]
        return np.asarray(directions / np.linalg.norm(directions, axis=-1, keepdims=True))

    def sample(self, pixels: NDArray[np.float32], directions: Array) -> NDArray[np.float32]:
        """As in Layout; continuous across the edges, where the next face follows. At a corner of the cube three texels meet."""
        face, u, v = self._on_faces(directions)
        column, row = self.face * (u + 1) / 2 - 0.5, self.face * (v + 1) / 2 - 0.5
        left, top = np.floor(column).astype(np.int64), np.floor(row).astype(np.int64)
        right, down = column - left, row - top
        first_row, first_column = self._corners.T
        result = between_texels(pixels, top + first_row[face], left + first_column[face], down, right)
        last = self.face - 1
        edge = np.flatnonzero((np.minimum(left, top) < 0) | (np.maximum(left, top) >= last))
        result[edge] = self._across_edges(pixels, face[edge], top[edge], left[edge], down[edge], right[edge])
        return result

    def _across_edges(
        self, pixels: NDArray[np.float32], face: Indices, top: Indices, left: Indices, down: Array, right: Array
    ) -> Array:
        """Radiance (k, 3) where some of the four texels are on the next face or nowhere."""
        weights = np.stack([(1 - right) * (1 - down), right * (1 - down), (1 - right) * down, right * down])
        at_column, at_row = (np.stack(four) for four in ((left, left + 1) * 2, (top, top, top + 1, top + 1)))
        absent = ((at_column < 0) | (at_column >= self.face)) & ((at_row < 0) | (at_row >= self.face))
        taps = pixels[self.texels(np.tile(face, 4), at_row.ravel(), at_column.ravel())].reshape(4, -1, 3)
        weights = weights + (weights * absent).sum(axis=0) / 3
        weights[absent] = 0.0
        return np.asarray(np.einsum("ik,ikc->kc", weights, taps, dtype=np.float64))

    def texels(self, face: Indices, rows: Indices, columns: Indices) -> tuple[Indices, Indices]:
        """Row and column in the image of places on a face, (k,) each; beyond its border follows the next face."""
        beyond = (np.minimum(rows, columns) < 0) | (np.maximum(rows, columns) >= self.face)
        at_row, at_column = rows + self._corners[face, 0], columns + self._corners[face, 1]
        centre = self._directions(
            face[beyond], (2 * columns[beyond] + 1) / self.face - 1, (2 * rows[beyond] + 1) / self.face - 1
        )
        at_row[beyond], at_column[beyond] = self.nearest(centre)
        return at_row, at_column

    def raster(self, pixels: NDArray[np.float32], height: int, width: int) -> NDArray[np.float32]:
        return raster_of(self, pixels, height, width)

    def project(self, pixels: NDArray[np.float32], n_bands: int) -> Array:
        """As in Layout; from one quadrant of the front, left and upper face each, whose mirror images all others are."""
        n_points = quadrant_point_count(n_bands)
        values = np.zeros((2, 2, 2, 3, n_points, n_points, 3))
        for face in self.arrangement.faces:
            points, weights = quadrant_weights(pixels[self._cell(face)], n_points)
            weights *= ((1 + points**2 + points[:, None] ** 2) ** -1.5)[..., None]
            axes = face.centre, face.right, face.down
            normal, right, down = ("xyz".index(axis[1]) for axis in axes)
            for below, beside in np.ndindex(2, 2):
                side = [0, 0, 0]
                side[normal], side[right], side[down] = (
                    (axis[0] == "-") ^ turned for axis, turned in zip(axes, (0, 1 - beside, 1 - below), strict=True)
                )
                found = weights[below, beside]
                values[(*side, normal)] = found if down == AROUND[normal] else found.swapaxes(0, 1)
        return project_faces(points, values, n_bands)

    def project_texels(self, values: Array, rows: Indices, columns: Indices, n_bands: int) -> Array | None:
        """As in Layout; texels of empty cells count as nothing."""
        face = self.faces_by_cell[rows // self.face, columns // self.face]
        shown = face >= 0
        rows, columns, face = rows[shown], columns[shown], face[shown]

        def places(right: Array, down: Array) -> tuple[Array, Array]:
            u, v = (2 * (index % self.face + by) / self.face - 1 for index, by in ((columns, right), (rows, down)))
            towards = self._directions(np.broadcast_to(face, u.shape).ravel(), u.ravel(), v.ravel())
            length = np.linalg.norm(towards, axis=-1, keepdims=True)
            return (towards / length).reshape(*u.shape, 3), (length**-3.0).reshape(u.shape) * (2 / self.face) ** 2

        return integrate_texels(places, values[shown], n_bands, 6 * self.face**2)

    def _cell(self, face: Face) -> tuple[slice, slice]:
        row, column = face.row * self.face, face.column * self.face
        return slice(row, row + self.face), slice(column, column + self.face)

    @cached_property
    def faces_by_cell(self) -> Indices:
        """The index of the face in each cell, (rows, columns); -1 for an empty cell."""
        cells = np.full((self.arrangement.rows, self.arrangement.columns), -1)
        for i, face in enumerate(self.arrangement.faces):
            cells[face.row, face.column] = i
        return cells

    @cached_property
    def _corners(self) -> Indices:
        """Row and column of each face's first texel, (6, 2)."""
        return np.array([(face.row * self.face, face.column * self.face) for face in self.arrangement.faces])

    @cached_property
    def _frames(self) -> Array:
        """Centre, right and down of each face, (6, 3, 3)."""
        return np.array([[_AXES[axis] for axis in (f.centre, f.right, f.down)] for f in self.arrangement.faces])

    def _directions(self, face: Indices, u: Array, v: Array) -> Array:
        """Directions (k, 3), not of unit length, at u to the right and v down, in [-1, 1] within the face."""
        frame = self._frames[face]
        return np.asarray(frame[:, 0] + u[:, None] * frame[:, 1] + v[:, None] * frame[:, 2])

    def _on_faces(self, directions: Array) -> tuple[Indices, Array, Array]:
        """The face that each direction (of any length) meets, and the place on it: u and v in [-1, 1]."""
        components = np.ascontiguousarray(directions.T)
        size, place = np.abs(components), np.arange(len(directions))
        depth = size.max(axis=0)
        axis = np.where(size[0] == depth, 0, np.where(size[1] == depth, 1, 2)) * len(place)
        backward = components.take(axis + place) < 0
        by_axis = (self._frames[:, 0] @ np.concatenate([np.eye(3), -np.eye(3)]).T).argmax(axis=0)
        face = by_axis[axis // max(1, len(place)) + 3 * backward]
        u, v = (
            components.take(np.abs(edge).argmax(axis=1)[face] * len(place) + place) * (edge.sum(axis=1)[face] / depth)
            for edge in (self._frames[:, 1], self._frames[:, 2])
        )
        return face, u, v

    @cached_property
    def _face_solid_angles(self) -> Array:
        """Solid angles (face, face): the integral over v in closed form, without cancellation, over u by Gauss's rule.

        The integral of (1 + u^2 + v^2)^(-3/2) over v is v / (a sqrt(a + v^2)) with a = 1 + u^2.
        """
        edges = quadrant_edges(self.face)
        lower, upper = edges[:-1, None], edges[1:, None]
        quadrant = np.zeros((len(lower), len(lower)))
        for node, weight in zip(*np.polynomial.legendre.leggauss(12 if self.face < 16 else 6), strict=True):
            a = 1 + (lower.T + (upper - lower).T * (1 + node) / 2) ** 2
            low, high = np.sqrt(a + lower**2), np.sqrt(a + upper**2)
            between = (upper - lower) * (upper + lower) / (low * high * (upper * low + lower * high))
            quadrant += weight / 2 * (upper - lower).T * between
        return four_quadrants(quadrant, self.face)


def quadrant_point_count(n_bands: int) -> int:
    """Chebyshev points a side that make a quadrant of a face exact to rounding; measured, see the tests."""
    return 26 + int(np.ceil(0.55 * n_bands))
