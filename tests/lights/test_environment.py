"""What shviewer.lights.environment promises: an image whose texels are areas of constant radiance."""

from dataclasses import replace

import numpy as np
import OpenEXR
import pytest
from harmonics.independent import random_directions
from lights.images.hdr_files import FORMAT, hdr_file, random_texels
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from shviewer.errors import LightError
from shviewer.harmonics.metrics import squared_error
from shviewer.harmonics.projection.rows import project_image
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, jittered, row_angles
from shviewer.lights.environment import MAX_TEXTURE_SIDE, EnvironmentLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.arrangements import HORIZONTAL_CROSS, OPENEXR
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout
from shviewer.lights.reading import Reading
from shviewer.limits import Limits
from shviewer.progress import listening


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


@pytest.mark.parametrize("height", [1, 4, 5, 9])
def test_the_irradiance_up_of_a_constant_image_is_pi_also_where_a_row_lies_across_the_equator(height):
    light = replace(random_light(height, 8), pixels=np.ones((height, 8, 3), np.float32))
    assert_allclose(light.irradiance_up(), np.pi, rtol=1e-12)


@pytest.mark.parametrize("layout", [MirrorBallLayout(3), AngularLayout(15), CubeLayout(OPENEXR, 5)])
def test_the_irradiance_up_of_a_constant_image_of_an_odd_side_is_pi_in_any_layout(layout):
    light = EnvironmentLight(np.ones((*layout.solid_angles().shape, 3), np.float32), layout)
    assert_allclose(light.irradiance_up(), np.pi, rtol=1e-12)


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
    assert "RGBE" in light.encoding


def test_notes_of_the_reader_pass_through_before_those_about_the_layout(tmp_path):
    path = tmp_path / "square.hdr"
    path.write_bytes(hdr_file(random_texels(8, 8), settings=(FORMAT, b"EXPOSURE=2")))
    first, second = EnvironmentLight.read(path).notes
    assert first == "EXPOSURE 2 divided out"
    assert "8 x 8 is not 2:1" in second


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


# --- other layouts


OTHERS = [CubeLayout(OPENEXR, 6), CubeLayout(HORIZONTAL_CROSS, 5), AngularLayout(16), MirrorBallLayout(15)]
of_other_layouts = pytest.mark.parametrize("layout", OTHERS, ids=lambda layout: f"{layout.name} {layout.size}")


def random_light_of(layout, seed=0):
    pixels = np.random.default_rng(seed).random((*layout.solid_angles().shape, 3)).astype(np.float32)
    return EnvironmentLight(pixels, layout)


@of_other_layouts
def test_coefficients_and_norm_are_those_of_the_true_texels(layout):
    light = random_light_of(layout)
    assert_array_equal(light.coefficients(4), layout.project(light.pixels, 4))
    squares = np.einsum("rc,rci,rcj->ij", layout.solid_angles(), *[light.pixels.astype(np.float64)] * 2)
    assert_allclose(light.products(), squares, rtol=1e-13, atol=0)
    sampled = project_samples(light.integrand, jittered(250_000, 0), 4)
    exact = light.coefficients(4)
    assert np.abs(sampled - exact).max() < 2e-3 * exact.max()  # texel edges cut one cell in fifty


@of_other_layouts
def test_many_bands_hold_the_energy_of_any_layout(layout):
    light = random_light_of(layout)
    share = (light.coefficients(64) ** 2).sum(axis=0) / light.products().diagonal()
    assert (share < 1).all()
    assert (share > 0.97).all()


@of_other_layouts
def test_cpu_and_gpu_look_at_one_raster_that_is_about_as_fine_as_the_texels(layout):
    rows, columns = np.indices(layout.solid_angles().shape).reshape(2, -1)
    x, y, z = layout.centres(rows, columns).T
    pixels = np.stack([x + 0.5, y * z, 1 + z], axis=-1).reshape(*layout.solid_angles().shape, 3)
    light = EnvironmentLight(pixels.astype(np.float32), layout)
    directions = random_directions(2000)
    raster = light.map
    assert light.map is raster
    assert raster.texels.shape == (layout.raster_width // 2, layout.raster_width, 3)
    assert_array_equal(light.radiance(directions), raster.sample(directions))
    x, y, z = directions.T
    assert np.abs(light.radiance(directions) - np.stack([x + 0.5, y * z, 1 + z], axis=-1)).mean() < 0.03


def test_the_raster_of_a_large_image_is_bounded(monkeypatch):
    monkeypatch.setattr("shviewer.lights.environment.MAX_RASTER_WIDTH", 20)
    assert random_light_of(AngularLayout(16)).map.texels.shape == (10, 20, 3)


@of_other_layouts
@pytest.mark.parametrize("size", [(16, 32), (7, 13), (1, 1)])
def test_a_raster_is_the_look_up_at_the_centres_of_its_texels_in_whatever_blocks(layout, size, monkeypatch):
    pixels = random_light_of(layout).pixels
    expected = layout.sample(
        pixels, directions_from_angles(row_angles(size[0])[:, None], column_azimuths(size[1])).reshape(-1, 3)
    )
    for block in (2**15, 1):
        for module in ("layout", "disc"):
            monkeypatch.setattr(f"shviewer.lights.layouts.{module}.RASTER_BLOCK", block)
        assert_allclose(layout.raster(pixels, *size).reshape(-1, 3), expected, rtol=1e-5, atol=1e-5)


@of_other_layouts
def test_the_landmark_is_the_brightest_texel_that_shows_something(layout):
    light = random_light_of(layout)
    shown = layout.solid_angles() > 0
    light.pixels[~shown] = 1e6
    row, column = np.argwhere(shown)[len(shown)]
    light.pixels[row, column] = 100
    assert light.integrand(light.landmarks()).tolist() == [[100.0] * 3]


@pytest.mark.parametrize("layout", [CubeLayout(HORIZONTAL_CROSS, 5), AngularLayout(17)], ids=["cross", "disc"])
def test_only_when_what_is_hidden_is_brightest_is_it_masked(layout, monkeypatch):
    monkeypatch.setattr(type(layout), "solid_angles", lambda self: pytest.fail("the texels were masked"))
    pixels = np.zeros((15, 20, 3) if layout.name == "cube" else (17, 17, 3), np.float32)
    pixels[7, 8, 2] = -3
    light = EnvironmentLight(pixels, layout)
    assert light.integrand(light.landmarks()).tolist() == [[0, 0, -3]]


@pytest.mark.parametrize(("height", "width"), [(4, 38400), (38400, 4), (60, 20000)])
def test_a_lat_long_image_too_wide_or_high_for_a_texture_is_drawn_from_a_coarser_one(height, width):
    columns = np.linspace(0, 2 * np.pi, width, endpoint=False)
    rows = np.linspace(0, 1, height)[:, None, None]
    pixels = (rows + np.sin(columns)[None, :, None] + np.arange(3)).astype(np.float32)
    light = EnvironmentLight(LatLongMap(pixels))
    assert light.map.texels.shape == (min(height, 4096), min(width, 8192), 3)
    directions = random_directions(2000)
    assert_allclose(light.radiance(directions), LatLongMap(pixels).sample(directions), rtol=0, atol=2e-3)
    assert_array_equal(light.coefficients(3), project_image(pixels, 3))
    assert light.description == f"environment map, {width} x {height}"


def test_a_map_of_38400_by_4_in_a_file_is_read_shown_and_measured(tmp_path):
    path = tmp_path / "ring.hdr"
    texels = random_texels(4, 38400)
    path.write_bytes(hdr_file(texels, "flat"))  # the new packing ends at 32767 texels
    light = EnvironmentLight.read(path, Reading(limits=Limits(side=40000)))
    assert max(light.map.texels.shape) <= MAX_TEXTURE_SIDE
    assert_array_equal(light.coefficients(4), project_image(light.pixels, 4))
    row, column = np.argwhere(light.pixels == light.pixels.max())[0][:2]
    assert_array_equal(light.landmarks(), light.layout.centres(np.array([row]), np.array([column])))
    assert light.pixels.min() <= light.map.texels.min() <= light.map.texels.max() <= light.pixels.max()


def test_a_map_with_a_side_that_fits_is_its_own_raster():
    pixels = np.zeros((2, MAX_TEXTURE_SIDE, 3), np.float32)
    assert EnvironmentLight(pixels).map.texels is pixels


def test_a_layer_is_part_of_the_name(tmp_path):
    path = tmp_path / "passes.exr"
    values = np.full((4, 8), 2.0, np.float32)
    channels = {**{f"spec.{c}": values for c in "RGB"}, **dict.fromkeys("RGB", values / 2)}
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(str(path))
    assert EnvironmentLight.read(path).name == "passes"
    spec = EnvironmentLight.read(path, layer="spec")
    assert (spec.name, spec.pixels.max()) == ("passes:spec", 2)


def test_a_jpeg_of_a_probe_is_an_angular_map(tmp_path):
    path = tmp_path / "probe.jpg"
    x = (2 * np.arange(256) + 1) / 256 - 1
    shade = 0.5 + 0.4 * np.sin(9 * x)[:, None, None] * np.cos(7 * x)[None, :, None] * np.float32([1, 0.5, -1])
    shade[np.hypot(x, x[:, None]) > 1] = 0.3
    Image.fromarray((255 * shade).astype(np.uint8)).save(path, quality=85)
    assert EnvironmentLight.read(path).layout == AngularLayout(256)


def test_the_description_names_the_layout_unless_it_is_lat_long():
    descriptions = [light.description for light in (random_light(512, 1024), *map(random_light_of, OTHERS[::2]))]
    assert descriptions == [
        "environment map, 1024 x 512",
        "environment map, cube, 6 x 6 x 6",
        "environment map, angular, 16 x 16",
    ]


def test_a_light_with_other_pixels_keeps_the_rest():
    light = random_light_of(AngularLayout(16))
    other = replace(light, pixels=light.pixels * 2)
    assert other.layout == light.layout
    assert_allclose(other.coefficients(3), 2 * light.coefficients(3), rtol=1e-12, atol=0)


def test_without_a_layout_pixels_and_maps_are_lat_long():
    texels = random_light(3, 4).pixels
    for light in (EnvironmentLight(texels), EnvironmentLight(LatLongMap(texels))):
        assert light.layout == LatLongLayout(3, 4)
        assert light.map.texels is texels


def test_the_layout_asked_for_is_used_or_refused(tmp_path):
    path = tmp_path / "probe.hdr"
    path.write_bytes(hdr_file(random_texels(16, 16)))
    assert EnvironmentLight.read(path, Reading(layout="mirror-ball")).layout == MirrorBallLayout(16)
    with pytest.raises(LightError, match=r"probe\.hdr: 16 x 16 is no cube") as caught:
        EnvironmentLight.read(path, Reading(layout="cube"))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("width", "height"), [(1, 1), (3, 2), (1000, 500), (38400, 4)])
def test_any_size_is_read_and_projected_exactly(tmp_path, width, height):
    path = tmp_path / "odd.hdr"
    path.write_bytes(hdr_file(random_texels(height, width), "flat" if width > 32767 else "new"))
    light = EnvironmentLight.read(path, Reading(limits=Limits(side=40000)))
    assert light.pixels.shape == (height, width, 3)
    weights = solid_angles(height, width)
    expected = np.einsum("r,rcx->x", weights, light.pixels.astype(np.float64)) / np.sqrt(4 * np.pi)
    assert_allclose(light.coefficients(5)[0], expected, rtol=1e-12, atol=0)
    assert ((light.coefficients(5) ** 2).sum(axis=0) <= light.products().diagonal() * (1 + 1e-12)).all()


def test_whoever_has_an_image_projected_it_is_said_once_and_not_again_for_fewer_bands() -> None:
    told: list[str] = []
    light = EnvironmentLight(np.ones((8, 16, 3), np.float32))
    with listening(lambda what, share: told.append(what)):
        for n_bands in (3, 2, 3, 4):
            light.coefficients(n_bands)
    assert told.count("projecting") == 2
