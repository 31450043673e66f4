"""What the lobe view draws: values and their scale."""

from __future__ import annotations

import numpy as np
import pytest
from helpers import lat_long_grid

from shviewer.harmonics.basis import evaluate_basis, index
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.zonal import Disc
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.find import find_light
from shviewer.viewer.surface import (
    LIGHT_ROWS,
    MOST_ROWS,
    rows_for,
    sample_basis,
    sample_light,
    sample_reconstruction,
    surface,
    unit_radius,
)

# --- values


@pytest.mark.parametrize(("l", "m"), [(0, 0), (1, -1), (3, 2), (15, -7), (31, 31)])
def test_values_of_a_basis_function_are_those_of_the_basis(l: int, m: int) -> None:
    values = sample_basis(l, m, 65)
    assert values.dtype == np.float32
    wanted = evaluate_basis(lat_long_grid(65), l + 1)[..., index(l, m)]
    assert np.abs(values - wanted).max() < 1e-6 * np.abs(wanted).max()


def test_an_order_beyond_the_degree_is_refused() -> None:
    with pytest.raises(ValueError, match=r"Y\(2,-3\): the order goes from -l to l"):
        sample_basis(2, -3, 65)


def test_values_of_a_reconstruction_are_its_luminance() -> None:
    coefficients = np.random.default_rng(0).normal(size=(36, 3))
    wanted = evaluate_basis(lat_long_grid(65), 6) @ coefficients @ LUMINANCE
    assert np.abs(sample_reconstruction(coefficients, 65) - wanted).max() < 1e-6 * np.abs(wanted).max()


def test_values_of_a_light_are_its_luminance_and_remembered() -> None:
    light = find_light("green")
    values = sample_light(light, 65)
    wanted = light.radiance(lat_long_grid(65).reshape(-1, 3)) @ LUMINANCE
    assert np.abs(values.ravel() - wanted).max() < 1e-6  # rows stand 1e-7 aside; slopes are up to 5
    assert sample_light(light, 65) is values


@pytest.mark.parametrize(
    "axis", [(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (0.6, 0.0, 0.8), (-1.0, 1e-9, 0.0), (0.36, 0.48, -0.8)]
)
def test_a_sun_smaller_than_a_cell_has_the_width_of_one(axis: tuple[float, float, float]) -> None:
    sun = LobeLight((Lobe(Disc(np.radians(0.05)), np.array(axis), np.array([5.0, 5.0, 5.0])),))
    bright = sample_light(sun, 129) > 4
    assert bright.any()
    chord = np.linalg.norm(lat_long_grid(129)[bright] - axis, axis=-1)
    assert chord.max() < np.pi / 128
    assert bright.sum() >= 2


def test_the_edge_of_a_large_disc_is_left_as_it_is() -> None:
    """Also one that passes through a row of points, where rounding would decide."""
    values = sample_light(find_light("hemisphere"), 129)
    assert set(np.unique(values)) == {0.0, 1.0}
    assert (values == values[:, :1]).all()


def test_more_bands_and_larger_pictures_get_more_rows_up_to_a_bound() -> None:
    assert rows_for(1, 222) == rows_for(4, 222) == 129
    assert rows_for(16, 222) == LIGHT_ROWS == 513
    assert rows_for(32, 222) == rows_for(16, 222 * 16) == rows_for(128, 8192) == MOST_ROWS == 1025


# --- the scale


def test_the_largest_magnitude_of_a_reconstruction_is_the_radius_1_of_it_and_its_original() -> None:
    original, reconstruction = 3 * sample_basis(1, 0, 129), -2 * sample_basis(2, 1, 129)
    unit = unit_radius(original, reconstruction)
    assert unit == float(np.abs(reconstruction).max())
    shown = [surface(values, unit, root=True) for values in (original, reconstruction)]
    assert [item.clipped for item in shown] == [bool(np.abs(original).max() > unit), False]
    assert np.abs(shown[1].values).max() == pytest.approx(1)


def test_radii_of_a_light_are_square_roots_with_its_sign_and_cut_at_1() -> None:
    values = np.array([[-4.0, -1.0, -0.25, 0.0], [0.0, 0.25, 1.0, 9.0]], np.float32)
    shown = surface(values, 1.0, root=True)
    np.testing.assert_allclose(shown.values, [[-1, -1, -0.5, 0], [0, 0.5, 1, 1]])
    assert shown.clipped
    np.testing.assert_allclose(surface(values / 9, 1.0).values, values / 9)  # of a basis function they are not


def test_where_nothing_is_reconstructed_the_original_has_radius_1() -> None:
    original = sample_basis(1, 0, 129)
    assert unit_radius(original, np.zeros_like(original)) == float(original.max())


def test_an_error_longer_than_the_scale_is_cut_and_says_so() -> None:
    error = sample_basis(1, 0, 129)
    shown = surface(error, float(np.abs(error).max()) / 1.5)
    assert shown.clipped
    assert np.abs(shown.values).max() == 1


def test_zero_has_no_scale_and_no_radius() -> None:
    nothing = np.zeros((129, 256), np.float32)
    shown = surface(nothing, unit_radius(nothing, nothing), root=True)
    assert not shown.values.any()
    assert not shown.clipped
