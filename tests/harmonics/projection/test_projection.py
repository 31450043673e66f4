"""What shviewer.harmonics.projection.rows promises: the coefficients of rules and of images, and the way back."""

import tracemalloc

import numpy as np
import pytest
from harmonics.independent import HARD_CASES, random_directions, scipy_basis
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal
from scipy.special import sph_harm_y

from shviewer.harmonics import theta_series as theta_series_module
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.projection import rows as projection
from shviewer.harmonics.projection.rows import project_image, project_product
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, gauss_legendre
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.theta_series import from_waves, theta_series

GREEN_EXACT = np.array([float(value) for value in HARD_CASES["lights"]["green"]["coefficients_n4"]])


def random_coefficients(n_bands, seed=0):
    return np.random.default_rng(seed).standard_normal((n_bands**2, 3))


def green(directions):
    """The light of Green 2003, written out as he did, in all three channels."""
    x, y, z = directions.T
    lobes = np.maximum(0, 5 * z - 4) + np.maximum(0, 4 * (x * np.cos(2.5) + y * np.sin(2.5)) - 3)
    return np.repeat(lobes[:, None], 3, axis=1)


def texel_edges(height, width):
    """theta of the row edges, phi of the column edges."""
    return np.pi * np.arange(height + 1) / height, np.pi * (1 - 2 * np.arange(width + 1) / width)


def brute_force_texels(height, width, n_bands, order):
    """Integral of every basis function over every texel, (height, width, n_bands**2), by order x order Gauss points."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    theta_edges, phi_edges = texel_edges(height, width)
    total = np.zeros((height, width, n_bands**2))
    for i in range(height):
        for j in range(width):
            theta = (theta_edges[i] + theta_edges[i + 1]) / 2 + nodes * np.pi / height / 2
            phi = (phi_edges[j] + phi_edges[j + 1]) / 2 + nodes * np.pi / width
            area = (weights * np.sin(theta))[:, None] * weights * (np.pi / height / 2) * (np.pi / width)
            total[i, j] = area.ravel() @ scipy_basis(
                directions_from_angles(theta[:, None], phi).reshape(-1, 3), n_bands
            )
    return total


@pytest.mark.parametrize(("height", "width", "order"), [(5, 7, 12), (1, 1, 40), (3, 2, 24), (1, 9, 24), (8, 1, 36)])
def test_an_image_is_integrated_texel_by_texel(height, width, order):
    image = np.random.default_rng(11).random((height, width, 3)) - 0.3
    expected = np.einsum("ijk,ijc->kc", brute_force_texels(height, width, 6, order), image)
    assert_allclose(project_image(image, 6), expected, rtol=0, atol=2e-14)  # SciPy's rounding, over 4 pi


@pytest.mark.parametrize(("height", "width"), [(1, 1), (2, 3), (3, 2), (5, 7), (1, 64), (64, 1), (33, 65), (512, 1024)])
def test_a_constant_image_of_any_size_has_one_coefficient(height, width):
    image = np.broadcast_to([1.0, 2.0, 0.25], (height, width, 3))
    coefficients = project_image(image, 64)
    first = np.array([1.0, 2.0, 0.25]) * np.sqrt(4 * np.pi)
    assert_allclose(coefficients[0], first, rtol=1e-14, atol=0)
    assert np.abs(coefficients[1:] / first).max() < 1e-14  # numerics.md 2: 3e-15 at 8 bands


def test_the_top_of_an_image_is_north_and_its_left_half_is_y():
    image = np.zeros((4, 8, 3))
    image[:2, :, 0] = 1
    image[:, :4, 1] = 1
    image[:, 2:6, 2] = 1
    y, z, x = (project_image(image, 2)[1:] * np.array([-1, 1, -1])[:, None]).round(12)
    half = np.round(np.sqrt(3 / (4 * np.pi)) * np.pi, 12)
    assert [x.tolist(), y.tolist(), z.tolist()] == [[0, 0, half], [0, half, 0], [half, 0, 0]]


@settings(max_examples=150, deadline=None, derandomize=True, database=None)
@given(
    arrays(np.float64, st.tuples(st.integers(1, 8), st.integers(1, 8), st.just(3)), elements=st.floats(-1e3, 1e3)),
    st.integers(1, 12),
)
def test_no_image_has_coefficients_with_more_energy_than_itself(image, n_bands):
    height, width = image.shape[:2]
    theta, _ = texel_edges(height, width)
    solid_angle = (np.cos(theta[:-1]) - np.cos(theta[1:])) * 2 * np.pi / width
    norm_squared = np.einsum("r,rcx->x", solid_angle, image**2)
    energy = (project_image(image, n_bands) ** 2).sum(axis=0)
    assert (energy <= norm_squared * (1 + 1e-12) + 1e-290).all()  # Bessel, to rounding


def test_a_float32_image_is_projected_in_float64():
    image = np.random.default_rng(12).random((40, 70, 3)).astype(np.float32)
    assert_array_equal(project_image(image, 12), project_image(image.astype(np.float64), 12))


def test_blocks_of_rows_do_not_show_in_an_image_projection(monkeypatch):
    image = np.random.default_rng(13).random((23, 10, 3))
    whole = project_image(image, 9)
    monkeypatch.setattr(projection, "BLOCK_VALUES", 150)  # 5 rows of 23
    assert_allclose(project_image(image, 9), whole, rtol=0, atol=1e-14)


def test_blocks_of_rows_do_not_show_in_a_product_projection(monkeypatch):
    rule = gauss_legendre(2 * 11**2)
    coefficients, norm_squared = project_product(green, rule, 9)
    monkeypatch.setattr(projection, "BLOCK_VALUES", 8 * rule.n_columns * 3)
    again, norm_again = project_product(green, rule, 9)
    assert_allclose(again, coefficients, rtol=0, atol=1e-14)
    assert_allclose(norm_again, norm_squared, rtol=0, atol=1e-14)


@pytest.mark.parametrize("n_bands", [1, 2, 3, 8, 33, 100])
def test_a_band_limited_function_comes_back_from_synthesis_and_projection(n_bands):
    coefficients = random_coefficients(n_bands)
    synthesis = Synthesis(coefficients)
    rule = gauss_legendre(2 * n_bands**2)

    def radiance(directions):
        x, y, z = directions.T
        return synthesis.at(np.arctan2(np.hypot(x, y), z), np.arctan2(y, x))

    found, norm_squared = project_product(radiance, rule, n_bands)
    # random coefficients: values grow like n_bands, rounding of the angles m phi and k theta like n_bands again
    assert_allclose(found, coefficients, rtol=0, atol=2e-14 + 2.0**-52 * n_bands**2)
    assert_allclose(np.diag(norm_squared), (coefficients**2).sum(axis=0), rtol=1e-12, atol=0)


def test_the_product_rule_agrees_with_the_plain_sum_over_its_points():
    rule = gauss_legendre(2 * 20**2)
    points = rule.direction_set()
    values = green(points.directions) * [1, 2, 3]
    expected = scipy_basis(points.directions, 12).T @ (values * points.weights[:, None])
    found, norm_squared = project_product(lambda d: green(d) * [1, 2, 3], rule, 12)
    assert_allclose(found, expected, rtol=0, atol=1e-13)
    assert_allclose(np.diag(norm_squared), points.weights @ values**2, rtol=1e-13, atol=0)


@pytest.mark.parametrize("n_bands", [1, 2, 5, 16, 33])
def test_synthesis_at_scattered_angles_is_the_sum_over_the_basis(n_bands):
    rng = np.random.default_rng(14)
    coefficients = random_coefficients(n_bands, seed=1)
    # beyond both poles and beyond the seam, too, where `ErrorGrid` climbs
    theta, phi = rng.uniform(-1, np.pi + 1, 200), rng.uniform(-4, 4, 200)
    expected = evaluate_basis(directions_from_angles(theta, phi), n_bands) @ coefficients
    assert_allclose(Synthesis(coefficients).at(theta, phi), expected, rtol=0, atol=1e-14 * n_bands**2)


@pytest.mark.parametrize("n_bands", [1, 2, 5, 16, 33])
@pytest.mark.parametrize("n_columns", [1, 8, 13])
def test_synthesis_on_rows_has_the_columns_of_an_image(n_bands, n_columns):
    coefficients = random_coefficients(n_bands, seed=2)
    theta = np.array([0.0, 0.2, 1.4, np.pi / 2, 3.0, np.pi])
    directions = directions_from_angles(theta[:, None], np.pi * (1 - 2 * (np.arange(n_columns) + 0.5) / n_columns))
    expected = np.einsum("rck,kx->rxc", evaluate_basis(directions, n_bands), coefficients)
    found = Synthesis(coefficients).on_rows(theta, n_columns)
    assert_allclose(found, expected, rtol=0, atol=1e-14 * n_bands**2)


@pytest.mark.parametrize("count", [0, 5])
def test_synthesis_needs_the_coefficients_of_whole_bands(count):
    with pytest.raises(ValueError, match=f"{count} coefficients: n bands have"):
        Synthesis(np.zeros((count, 3)))


def test_more_bands_than_are_separated_are_refused():
    with pytest.raises(ValueError, match="513 bands: there must be 1 to 512"):
        project_image(np.zeros((2, 4, 3)), 513)
    with pytest.raises(ValueError, match="129 bands: there must be 1 to 128"):
        theta_series(129)


@pytest.mark.parametrize("n_bands", [1, 2, 9, 40])
def test_waves_become_bands_and_back_without_a_table_as_with_it(n_bands, monkeypatch):
    rng = np.random.default_rng(n_bands)
    sums, coefficients = rng.standard_normal((n_bands, 2, 3, n_bands)), random_coefficients(n_bands)
    with_table = from_waves(sums), Synthesis(coefficients).at(np.array([0.3, 2.0]), np.array([-1.0, 3.0]))
    monkeypatch.setattr(theta_series_module, "TABLE_BANDS", 0)
    assert_allclose(from_waves(sums), with_table[0], rtol=0, atol=3e-15 * n_bands)
    again = Synthesis(coefficients).at(np.array([0.3, 2.0]), np.array([-1.0, 3.0]))
    assert_allclose(again, with_table[1], rtol=0, atol=3e-15 * n_bands)


def test_512_bands_of_an_image_are_the_integrals_over_its_texels():
    """One texel about the middle of a row, over which Gauss points integrate the independent functions."""
    image = np.zeros((8, 16, 3))
    image[2, 5] = 1, 2, 3
    found = project_image(image, 512)
    nodes, weights = np.polynomial.legendre.leggauss(80)  # 512 * pi/8 = 201 radians across
    theta, phi = np.pi * (2.5 + nodes / 2) / 8, np.pi * (1 - (11 + nodes) / 16)
    for l, m in ((511, 0), (500, 13), (511, -300), (407, 407), (20, -3)):
        shape = sph_harm_y(l, abs(m), theta, 0).real
        along = {True: np.cos, False: np.sin}[m >= 0](abs(m) * phi)
        factor = np.sqrt(2) if m else 1.0
        wanted = factor * (weights * np.sin(theta) @ shape) * (weights @ along) * (np.pi / 16) ** 2
        assert_allclose(found[l * l + l + m], wanted * np.array([1, 2, 3]), rtol=0, atol=2e-15)


def test_512_bands_are_summed_as_the_basis_says():
    coefficients = random_coefficients(512)
    d = random_directions(3, 1)
    found = Synthesis(coefficients).in_directions(d)
    assert_allclose(found, evaluate_basis(d, 512) @ coefficients, rtol=0, atol=1e-14 * 512**2)


def test_the_narrowest_kernel_takes_no_table_of_all_its_bands():
    """n^3 numbers of 512 bands are 1 GiB; what there is of n^2 is 2 MiB each."""
    tracemalloc.start()
    synthesis = Synthesis(project_image(np.ones((8, 16, 3)), 512))
    synthesis.pole_to_pole(33, 64)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 200 * 2**20


@pytest.mark.parametrize(("n_bands", "columns"), [(25, 50), (40, 97), (25, 49)])
def test_rows_of_many_bands_are_the_sum_in_their_directions(n_bands, columns):
    synthesis = Synthesis(random_coefficients(n_bands))
    theta = np.array([0.0, 0.4, 1.6, np.pi])
    found = synthesis.on_rows(theta, columns)
    directions = directions_from_angles(theta[:, None], column_azimuths(columns)).reshape(-1, 3)
    wanted = synthesis.in_directions(directions).reshape(4, columns, 3).swapaxes(1, 2)
    assert_allclose(found, wanted, rtol=0, atol=1e-12 * n_bands)


def test_the_exact_projection_of_greens_light_has_his_signs_and_order():
    # caps cut by a Gauss grid: numerics.md 0.3 measures 2e-6 of max |c| at 512 rows
    coefficients, norm_squared = project_product(green, gauss_legendre(2 * 256**2), 4)
    for channel in range(3):
        assert_allclose(coefficients[:, channel], GREEN_EXACT, rtol=0, atol=2e-5)
    assert_allclose(np.diag(norm_squared), np.full(3, 0.3 * np.pi), rtol=0, atol=1e-4)
