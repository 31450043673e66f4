"""A few texels are integrated as exactly alone as in an image that is black but for them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.arrangements import OPENEXR, VERTICAL_CROSS
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.disc import DiscLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout
from shviewer.lights.layouts.texels import FAR

LAYOUTS: dict[str, tuple[Layout, tuple[int, int]]] = {
    "lat-long": (LatLongLayout(150, 301), (150, 301)),
    "angular": (AngularLayout(200), (200, 200)),
    "angular, odd": (AngularLayout(201), (201, 201)),
    "mirror ball": (MirrorBallLayout(200), (200, 200)),
    "mirror ball, odd": (MirrorBallLayout(201), (201, 201)),
    "cross": (CubeLayout(VERTICAL_CROSS, 80), (320, 240)),
    "faces": (CubeLayout(OPENEXR, 81), (486, 81)),
}


def some(layout: Layout, shape: tuple[int, int], count: int) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of texels anywhere, in a disc as near to the rim as they may be."""
    rows, columns = np.divmod(np.random.default_rng(1).permutation(shape[0] * shape[1])[: 3 * count], shape[1])
    if isinstance(layout, DiscLayout):
        middle = np.hypot(2 * rows + 1 - shape[0], 2 * columns + 1 - shape[0]) / shape[0]
        allowed = middle <= 1 - FAR / shape[0]
        nearest = np.argsort(np.where(allowed, -middle, 1))[: count // 2]
        rows, columns = (np.concatenate([index[nearest], index[allowed]]) for index in (rows, columns))
        _, first = np.unique(rows * shape[1] + columns, return_index=True)
        rows, columns = rows[first], columns[first]
    return rows[:count], columns[:count]


@pytest.mark.parametrize("n_bands", [1, 9, 33, 100])
@pytest.mark.parametrize("name", LAYOUTS)
def test_texels_alone_have_the_coefficients_of_an_image_of_them(name: str, n_bands: int) -> None:
    layout, shape = LAYOUTS[name]
    rows, columns = some(layout, shape, 60)
    values = np.random.default_rng(2).uniform(0.5, 1.5, (len(rows), 3)).astype(np.float32)
    image = np.zeros((*shape, 3), np.float32)
    image[rows, columns] = values
    expected = layout.project(image, n_bands)
    found = layout.project_texels(values.astype(np.float64), rows, columns, n_bands)
    assert found is not None
    assert_allclose(
        found, expected, rtol=0, atol=2e-13 * np.abs(expected).max()
    )  # that of the image, of which 60 texels are little


@pytest.mark.parametrize("layout", [AngularLayout(200), MirrorBallLayout(200)])
def test_texels_at_the_rim_are_left_to_the_projection(layout: DiscLayout) -> None:
    for column in (199, 199 - FAR // 4):
        assert layout.project_texels(np.ones((1, 3)), np.array([100]), np.array([column]), 9) is None


def test_where_all_texels_would_take_no_longer_they_are_left_to_the_projection() -> None:
    layout = CubeLayout(OPENEXR, 16)
    rows, columns = (index.ravel() for index in np.indices((96, 16)))
    assert layout.project_texels(np.ones((len(rows), 3)), rows, columns, 9) is None


def test_no_texels_have_no_coefficients() -> None:
    nothing = np.zeros(0, np.int64)
    for layout, _ in LAYOUTS.values():
        found = layout.project_texels(np.zeros((0, 3)), nothing, nothing, 3)
        assert found is not None
        assert found.shape == (9, 3)
        assert not found.any()
