"""Hard cases of layouts: where texels lie, how large they are, and what is between them, in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from math import atan, atan2, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from shviewer.benchmark.hard_cases.evaluation import towards
from shviewer.benchmark.hard_cases.outcome import Case, worst
from shviewer.harmonics.basis import Array
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.layouts import arrangements
from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout

FACE_FLUX = 4 / sqrt(2) * atan(1 / sqrt(2))
"""The integral of x over the directions of a cube's face +x: that of (1 + u^2 + v^2)^-2 over the square."""

MIDDLES = {
    arrangements.VERTICAL_STRIP: ((0, -1, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0)),
    arrangements.HORIZONTAL_STRIP: ((0, -1, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0)),
    arrangements.OPENEXR: ((0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0)),
    arrangements.VERTICAL_CROSS: ((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, -1, 0), (0, 0, -1), (-1, 0, 0)),
    arrangements.HORIZONTAL_CROSS: ((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, -1, 0), (-1, 0, 0), (0, 0, -1)),
}
"""Where the faces look, row by row."""


@worst
def constants() -> Iterator[ArrayLike]:
    """Radiance 1 in every layout: solid angles of 4 pi together, c(0, 0) = sqrt(4 pi), others 0; texels know themselves.

    Bound: 1e-13, polynomials of the kernels.
    """
    layouts: tuple[Layout, ...] = (
        LatLongLayout(5, 7),
        LatLongLayout(16, 32),
        *(CubeLayout(arrangement, side) for arrangement in MIDDLES for side in (1, 5)),
        AngularLayout(9),
        MirrorBallLayout(12),
    )
    for layout in layouts:
        shape = (layout.height, layout.width) if isinstance(layout, LatLongLayout) else layout.solid_angles().shape
        found = layout.project(np.ones((*shape, 3), np.float32), 4)[:, 0] / sqrt(4 * pi)
        found[0] -= 1
        angles = np.broadcast_to(layout.solid_angles(), shape)
        rows, columns = np.nonzero(angles > 0)
        yield found
        yield angles.sum() / (4 * pi) - 1
        if not isinstance(layout, AngularLayout | MirrorBallLayout):  # where centres may lie outside of the disc
            yield np.subtract(layout.nearest(layout.centres(rows, columns)), (rows, columns))


@worst
def faces() -> Iterator[ArrayLike]:
    """Each face of a cube lit alone: a sixth of the sphere, and a flux of FACE_FLUX towards its middle. Bound: 1e-13.

    Texel areas are differences of atan(uv / sqrt(1 + u^2 + v^2)).
    """
    corner = atan2(1, sqrt(3)) - 2 * atan2(0.5, sqrt(2.25)) + atan2(0.25, sqrt(1.5))
    for arrangement, middles in MIDDLES.items():
        layout = CubeLayout(arrangement, 4)
        cells = sorted((face.row, face.column) for face in arrangement.faces)
        for (row, column), middle in zip(cells, middles, strict=True):
            image = np.zeros((*layout.solid_angles().shape, 3), np.float32)
            image[4 * row : 4 * row + 4, 4 * column : 4 * column + 4] = 1
            c = layout.project(image, 2)[:, 0]
            flux = sqrt(4 * pi / 3) * np.array([-c[3], -c[1], c[2]])
            yield c[0] * sqrt(4 * pi) / (4 * pi / 6) - 1
            yield flux - FACE_FLUX * np.array(middle)
            yield layout.solid_angles()[4 * row, 4 * column] / corner - 1


@worst
def places() -> Iterator[ArrayLike]:
    """One texel of a lat-long image of 6 x 12, and one of a 20-degree angular map: band 1 points where it lies.

    Row 0 is +z, the middle column +x, the right half -y. Bound: 1e-14.
    """
    for row, column in ((0, 3), (2, 8), (5, 11)):
        image = np.zeros((6, 12, 3), np.float32)
        image[row, column] = 1
        c = LatLongLayout(6, 12).project(image, 2)[:, 0]
        low, high = pi * row / 6, pi * (row + 1) / 6
        area = (np.cos(low) - np.cos(high)) * pi / 6
        across = (high - low - (np.sin(2 * high) - np.sin(2 * low)) / 2) / 2
        left, right = pi * (1 - column / 6), pi * (1 - (column + 1) / 6)
        flux = [
            across * (np.sin(left) - np.sin(right)),
            across * (np.cos(right) - np.cos(left)),
            (np.sin(high) ** 2 - np.sin(low) ** 2) / 2 * pi / 6,
        ]
        yield sqrt(4 * pi / 3) * np.array([-c[3], -c[1], c[2]]) - flux
        yield c[0] * sqrt(4 * pi) - area
        yield float(LatLongLayout(6, 12).solid_angles()[row, 0]) / area - 1


@worst
def between() -> Iterator[Array]:
    """Between texel centres radiance is bilinear: a quarter and a third of the way between four texels, at the seam, too.

    Bound: 1e-6, float32 images in the cube; lat-long maps are read in float64.
    """
    random = np.random.default_rng(4)
    pixels = random.random((6, 12, 3)).astype(np.float32)

    def direction(row: float, column: float, rows: int = 6, offset: float = 0.5) -> Array:
        return towards(pi * (row + offset) / rows, pi * (1 - 2 * (column + 0.5) / 12))[None]

    for on_poles, place in ((False, 6), (True, 5)):
        read = LatLongMap(pixels, rows_on_poles=on_poles)
        for row, column in ((2, 4), (1, 11), (4, 0)):
            up, low = (pixels[r, column] * (2 / 3) + pixels[r, (column + 1) % 12] / 3 for r in (row, row + 1))
            found = read.sample(direction(row + 0.25, column + 1 / 3, place, 0.0 if on_poles else 0.5))[0]
            yield found - (0.75 * up + 0.25 * low)
    layout, face = CubeLayout(arrangements.VERTICAL_STRIP, 4), random.random((24, 4, 3)).astype(np.float32)
    u, v = (2 * (1 + 1 / 3 + 0.5) / 4 - 1, 2 * (2 + 0.25 + 0.5) / 4 - 1)
    # right is -y, down is -z; the front is the fifth face
    forward = np.array([[1.0, -u, -v]]) / sqrt(1 + u * u + v * v)
    up, low = (face[16 + r, 1] * (2 / 3) + face[16 + r, 2] / 3 for r in (2, 3))
    yield layout.sample(face, forward)[0] - (0.75 * up + 0.25 * low)


CLOSED = "closed form"

CASES = (
    Case("constant light in every layout", "sqrt(4 pi), else 0", 1e-13, constants),
    Case("faces of cubes", CLOSED, 1e-13, faces),
    Case("single texels of a lat-long image", CLOSED, 1e-14, places),
    Case("between four texels", "bilinear shares", 1e-6, between),
)
