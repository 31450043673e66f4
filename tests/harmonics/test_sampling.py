"""What shviewer.harmonics.sampling promises: a look that steps over nothing wide, and cells that integrate what they hold."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import random_directions, scipy_basis
from numpy.testing import assert_allclose
from scipy.spatial import cKDTree
from scipy.special import eval_legendre

from shviewer.harmonics.quadrature import directions_from_angles, gauss_unit
from shviewer.harmonics.sampling.cells import NODES, POINTS, Cells, locate, project, sectors, shares, to_nodes
from shviewer.harmonics.sampling.look import LOOK_COLUMNS, LOOK_ROWS, SEEN_DEGREES, look, turned
from shviewer.harmonics.sampling.sampled import Sampled, sample
from shviewer.harmonics.sampling.spread import project_points


def grey(values: np.ndarray) -> np.ndarray:
    return np.repeat(values[:, None], 3, axis=1)


def test_every_direction_is_within_half_the_stated_width_of_a_point_of_the_look() -> None:
    seen: list[np.ndarray] = []

    def record(d: np.ndarray) -> np.ndarray:
        seen.append(d)
        return d

    look(record)
    d = np.concatenate([random_directions(20_000), np.eye(3), -np.eye(3)])
    chord = cKDTree(np.concatenate(seen)).query(d)[0].max()
    assert np.degrees(2 * np.arcsin(chord / 2)) < SEEN_DEGREES / 2


def test_the_look_and_the_turned_rule_are_exact_for_products_of_functions_of_100_bands() -> None:
    """Legendre's polynomials of degree 99 about a slanted axis and about z; the square integrates to 4 pi / 199."""
    axis = np.array([0.48, -0.6, 0.64])

    def radiance(d: np.ndarray) -> np.ndarray:
        return np.stack([eval_legendre(99, d @ axis), eval_legendre(99, d[:, 2]), 1 + d[:, 0]], axis=-1)

    cross = 4 * np.pi / 199 * eval_legendre(99, axis[2])
    expected = [[4 * np.pi / 199, cross, 0], [cross, 4 * np.pi / 199, 0], [0, 0, 16 * np.pi / 3]]
    for found in (look(radiance)[1], turned(radiance)[0]):
        assert_allclose(found.products, expected, rtol=0, atol=1e-12)  # SciPy's recurrence loses 1e-14 of 99 steps
        assert_allclose(found.moments[0], [0, 0, 4 * np.pi], rtol=0, atol=1e-12)
    assert_allclose(turned(radiance)[0].moments[1], [0, 0, 4 * np.pi / 3], rtol=0, atol=1e-12)


def test_the_raster_of_the_look_is_the_function_at_its_columns_and_linear_in_between() -> None:
    texels, _ = look(lambda d: grey(d[:, 0]))
    theta = np.linspace(0, np.pi, LOOK_ROWS)[:, None]
    phi = np.pi * (1 - (2 * np.arange(LOOK_COLUMNS) + 1) / LOOK_COLUMNS)
    # a chord of a circle of radius 1 / stride, h long, is h^2 / 8 * stride from it, stride up to 16; float32 has 1e-7
    assert_allclose(texels[..., 1], np.sin(theta) * np.cos(phi), rtol=0, atol=16 * (np.pi / 512) ** 2 / 8 + 1e-7)


def test_cells_of_any_depth_tile_the_sphere() -> None:
    cells = Cells.roots()
    assert len(cells) == sectors().sum()
    assert_allclose(cells.weights().sum(), 4 * np.pi, rtol=1e-14)
    some = cells[np.array([0, 5, 700, 3000, 6511])]
    quarters = some.divided().divided()
    assert_allclose(
        quarters.weights().sum(axis=1).reshape(5, 16).sum(axis=1), some.weights().sum(axis=1), rtol=1e-13, atol=0
    )


def test_directions_are_in_the_roots_that_they_are_located_in() -> None:
    d = random_directions(500)
    root, across, down = locate(d)
    theta, phi = np.arccos(d[:, 2]), np.arctan2(d[:, 1], d[:, 0])
    for number in range(500):
        cell = Cells.roots()[root[[number]]]
        assert cell.root[0] == root[number]
        assert_allclose(cell.theta(down[[number]])[0, 0], theta[number], rtol=0, atol=1e-12)
        assert_allclose(cell.phi(across[[number]])[0, 0], phi[number], rtol=0, atol=1e-12)


def test_cells_project_a_band_limited_function_whether_they_are_divided_or_not() -> None:
    cells, half = Cells.roots(), np.arange(sectors().sum()) % 3 == 0
    directions = random_directions(40)

    def radiance(d: np.ndarray) -> np.ndarray:
        x, y, z = d.T
        return np.stack([1 + x * y**3, x * z - 0.3 * y, z**4 + x**5], axis=-1)

    whole, divided = np.zeros((len(cells), POINTS, POINTS, 3)), np.zeros((len(cells), NODES, NODES, 3))

    def weighted(some: Cells) -> np.ndarray:
        values = some.evaluate(radiance)
        return values * (some.weights()[:, :, None] * gauss_unit(POINTS)[1])[..., None]

    whole[half] = weighted(cells[half])
    to_nodes(cells[~half].divided(), weighted(cells[~half].divided()), divided)
    found = project([whole, divided], 16)
    # 12 nodes of a root carry 16 bands, 0.4 radians from its middle to its side, to (0.4 / 2)^12 / 12!; SciPy has 1e-14
    assert_allclose(scipy_basis(directions, 16) @ found, radiance(directions), rtol=0, atol=1e-12)


def test_shares_are_one_at_their_own_point_and_carry_polynomials() -> None:
    assert_allclose(shares(gauss_unit(8)[0], 8), np.eye(8), rtol=0, atol=1e-13)
    places = np.array([0.0, 0.3, 1.0])
    assert_allclose(shares(places, 8) @ gauss_unit(8)[0] ** 7, places**7, rtol=0, atol=1e-12)


@pytest.mark.parametrize("depth", [0, 2])
def test_cells_beside_a_marked_side_are_those_just_across_it(depth: int) -> None:
    cells = Cells.roots()
    for _ in range(depth):
        cells = cells[np.random.default_rng(2).permutation(len(cells))[:6000]].divided()
    marked = np.random.default_rng(3).random((len(cells), 4)) < 0.01
    step = 1e-6
    places = {0: (-step, 0.5), 1: (1 + step, 0.5), 2: (0.25, -step), 3: (0.25, 1 + step)}
    found = cells.beside(marked)
    for side, (across, down) in places.items():
        which = np.flatnonzero(marked[:, side])
        theta = cells[which].theta(np.array([down]))[:, 0]
        phi = cells[which].phi(np.array([across]))[:, 0]
        beyond = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
        root, u, v = locate(beyond)
        there = np.stack([root, np.floor(u * 2**depth), np.floor(v * 2**depth)], axis=-1)
        known = {key: number for number, key in enumerate(zip(cells.root, cells.across, cells.down, strict=True))}
        expected = [known[key] for key in map(tuple, there) if key in known]
        assert found[expected].all()
    assert found.sum() <= 2 * marked.sum()


def test_a_small_disc_does_not_cost_a_dense_sphere() -> None:
    axis = np.array([0.48, -0.6, 0.64])
    chord = 2 * np.sin(np.radians(0.27) / 2)

    def sampled(radiance: float) -> Sampled:
        return sample(lambda d: grey(0.1 + radiance * (np.linalg.norm(d - axis, axis=1) < chord)), 128)

    found = sampled(1e6)
    base = 512**2 // 8 * 12.7 + 2 * 320**2  # the roots, and the rule that was tried in vain
    assert found.evaluations - sampled(0.0).evaluations < base + 200_000  # a dense sphere of the finest cells has 1e11
    assert found.places[0] @ axis > np.cos(np.radians(0.27))


@pytest.mark.parametrize("depth", [0, 1, 3])
def test_points_that_are_spread_onto_a_grid_have_the_waves_of_the_points(depth: int) -> None:
    """Some cells anywhere, those beside the poles among them, against the independent basis at their points."""
    rng, cells = np.random.default_rng(depth), Cells.roots()
    cells = cells[np.r_[0, 1, len(cells) - 1, rng.integers(0, len(cells), 5)]]
    for _ in range(depth):
        cells = cells.divided()
        cells = cells[rng.integers(0, len(cells), 8)]
    at, share = gauss_unit(POINTS)
    smooth = 1 + np.multiply.outer(at, at)  # what a root's points are read as is a polynomial
    weighted = rng.standard_normal((len(cells), 1, 1, 3)) * (np.multiply.outer(share, share) * smooth)[..., None]
    n_bands = 12
    directions = directions_from_angles(cells.theta(at)[:, :, None], cells.phi(at)[:, None, :]).reshape(-1, 3)
    wanted = scipy_basis(directions, n_bands).T @ weighted.reshape(-1, 3)
    found = project_points([(cells, weighted)], n_bands)
    assert_allclose(found, wanted, rtol=0, atol=3e-7 * np.abs(weighted).sum() / 3)
