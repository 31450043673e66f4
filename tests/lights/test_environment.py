"""What shviewer.lights.environment promises: an image whose texels are areas of constant radiance."""

import numpy as np
import pytest
from hdr_files import FORMAT, hdr_file, random_texels
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.errors import LightError
from shviewer.harmonics.metrics import squared_error
from shviewer.harmonics.projection import project_image, project_samples
from shviewer.harmonics.quadrature import jittered
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.lat_long import LatLongMap


def random_light(height, width, seed=0):
    texels = np.random.default_rng(seed).random((height, width, 3)).astype(np.float32)
    return EnvironmentLight(LatLongMap(texels))


def solid_angles(height, width):
    """Solid angle of a texel of each row, (height,): the difference of the cosines of its edges."""
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    return (edges[:-1] - edges[1:]) * 2 * np.pi / width


@pytest.mark.parametrize(("height", "width"), [(1, 1), (2, 3), (5, 7), (64, 128), (33, 1)])
def test_the_norm_weighs_each_texel_by_its_solid_angle(height, width):
    light = random_light(height, width)
    squares = light.map.texels.astype(np.float64) ** 2
    expected = np.einsum("r,rcx->x", solid_angles(height, width), squares)
    assert_allclose(light.products().diagonal(), expected, rtol=1e-13, atol=0)


def test_a_constant_image_has_one_coefficient_that_holds_its_norm():
    light = EnvironmentLight(LatLongMap(np.broadcast_to(np.float32([0.5, 1, 4]), (6, 12, 3)).copy()))
    coefficients = light.coefficients(8)
    assert_allclose(coefficients[0], np.array([0.5, 1, 4]) * np.sqrt(4 * np.pi), rtol=1e-14, atol=0)
    assert np.abs(coefficients[1:]).max() < 1e-14 * coefficients[0].max()
    assert_allclose(light.products().diagonal(), np.array([0.25, 1, 16]) * 4 * np.pi, rtol=1e-14, atol=0)


def test_coefficients_and_norm_come_from_one_quadrature():
    light = random_light(7, 5)
    errors = [
        squared_error(light.products().diagonal(), c, c)[0] for c in (light.coefficients(n) for n in range(1, 60))
    ]
    assert (np.diff(errors) <= 1e-12).all()
    assert errors[-1] < 0.03 * light.products().diagonal().sum()


def test_many_bands_hold_the_energy_of_an_image():
    light = random_light(4, 6)
    share = (light.coefficients(200) ** 2).sum(axis=0) / light.products().diagonal()
    assert (share < 1).all()
    assert (share > 0.99).all()


def test_coefficients_are_those_of_the_areas_and_radiance_is_the_look_up():
    light = random_light(9, 18)
    assert_array_equal(light.coefficients(6), project_image(light.map.texels, 6))
    d = np.array([[1.0, 0, 0], [0, 0.6, 0.8]])
    assert_array_equal(light.radiance(d), light.map.sample(d))
    assert light.radiance_map() is light.map


@pytest.mark.parametrize(("row", "column"), [(0, 0), (3, 11), (7, 15), (5, 2)])
@pytest.mark.parametrize("peak", [50.0, -50.0])
def test_the_landmark_is_the_centre_of_the_brightest_texel(row, column, peak):
    light = random_light(8, 16)
    light.map.texels[row, column, 1] = peak
    landmark = light.landmarks()
    assert landmark.shape == (1, 3)
    assert_allclose(light.radiance(landmark)[0], light.map.texels[row, column], rtol=0, atol=1e-12)
    theta, phi = np.pi * (row + 0.5) / 8, np.pi * (1 - 2 * (column + 0.5) / 16)
    expected = [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)]
    assert_allclose(landmark[0], expected, rtol=0, atol=1e-15)


def test_a_file_is_read_with_its_name_and_size(tmp_path):
    path = tmp_path / "a street.hdr"
    path.write_bytes(hdr_file(random_texels(8, 16)))
    light = EnvironmentLight.read(path)
    assert (light.name, light.description, light.notes) == ("a street", "environment map, 16 x 8", ())
    assert light.best_method == "exact texel integrals"
    assert light.map.texels.shape == (8, 16, 3)


def test_notes_of_the_reader_pass_through(tmp_path):
    path = tmp_path / "square.hdr"
    path.write_bytes(hdr_file(random_texels(8, 8), settings=(FORMAT, b"EXPOSURE=2")))
    assert EnvironmentLight.read(path).notes == ("EXPOSURE 2 divided out",)


def test_a_missing_file_is_one_line(tmp_path):
    with pytest.raises(LightError) as caught:
        EnvironmentLight.read(tmp_path / "none.hdr")
    assert str(caught.value).count("\n") == 0
    assert "none.hdr" in str(caught.value)


def test_sampling_an_image_converges_to_its_texels_and_not_to_their_interpolation():
    light = EnvironmentLight(LatLongMap(np.random.default_rng(7).random((4, 8, 3)).astype(np.float32)))
    exact = light.coefficients(6)
    sampled = project_samples(light.integrand, jittered(250_000, 0), 6)
    assert np.abs(sampled - exact).max() < 2e-3 * exact.max()  # texel edges cut one cell in fifty
    smooth = project_samples(light.radiance, jittered(250_000, 0), 6)
    assert np.abs(smooth - exact).max() > 1e-2 * exact.max()
