"""What shviewer.lights.light promises: the text LIGHT names every kind of light, and every kind keeps one contract."""

import difflib
import subprocess
import sys

import numpy as np
import pytest
from harmonics.independent import random_directions
from helpers import refusal
from lights.images.hdr_files import exr_file, hdr_file, random_texels
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import column_azimuths, directions_from_angles, jittered
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import built_in_lights, find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import About
from shviewer.lights.reading import Reading

SCENE = '[[lobe]]\nprofile = "gaussian"\naxis = [1, 2, -1]\nradiance = [3, 2, 1]\nsharpness = 5\n'
FUNCTION = "import numpy as np\ndef dusk(d):\n    return np.exp(d * [1, -2, 0.5])\n"


def smooth_image(height=64, width=128):
    """Red grows towards +x, green towards +y, blue towards +z."""
    theta = np.pi * (np.arange(height)[:, None] + 0.5) / height
    phi = np.pi * (1 - 2 * (np.arange(width) + 0.5) / width)
    channels = [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) + 0 * phi]
    return EnvironmentLight(LatLongMap(np.exp(np.stack(channels, axis=-1)).astype(np.float32)))


def test_the_papers_light_comes_first_and_scenes_before_images():
    suffixes = [path.suffix for path in built_in_lights().values()]
    names = list(built_in_lights())
    n_scenes = suffixes.count(".toml")
    assert names[0] == "green"
    assert set(suffixes[:n_scenes]) == {".toml"}
    assert names[1:n_scenes] == sorted(names[1:n_scenes])
    assert names[n_scenes:] == sorted(names[n_scenes:])
    assert len(names) > n_scenes > 5


@pytest.mark.parametrize("name", built_in_lights())
def test_every_built_in_light_is_found_by_its_name(name):
    light = find_light(name)
    assert light.name == name
    assert light.description
    assert np.isfinite(light.coefficients(3)).all()


@pytest.mark.parametrize(
    ("text", "near"), [("gren", "green"), ("hemispere", "hemisphere"), ("sunsky", "sun-sky"), ("Green", "green")]
)
def test_a_misspelt_light_is_answered_with_the_nearest_names(text, near):
    line = refusal(find_light, text)
    assert line.startswith(f"unknown light {text!r}: did you mean {near}")
    assert line.endswith("?")
    assert difflib.get_close_matches(text, list(built_in_lights()), cutoff=0.5)[0] == near


def test_a_light_like_no_other_is_answered_with_all_names():
    assert refusal(find_light, "qqqqqq") == f"unknown light 'qqqqqq': there is: {', '.join(built_in_lights())}"


def test_a_scene_file_is_found_by_its_path(tmp_path):
    for name in ("a scene.toml", "UPPER.TOML"):
        (tmp_path / name).write_text(SCENE)
        light = find_light(str(tmp_path / name))
        assert isinstance(light, LobeLight)
        assert light.name == name.split(".")[0]


def test_an_image_is_found_by_its_path_and_sanitised_on_request(tmp_path):
    pixels = np.ones((4, 8, 3), np.float32)
    pixels[1, 2] = -1
    for name, data in (
        ("a.hdr", hdr_file(random_texels(4, 8))),
        ("b.PIC", hdr_file(random_texels(4, 8))),
        ("c.exr", exr_file({"R": pixels[..., 0], "G": pixels[..., 1], "B": pixels[..., 2]})),
    ):
        (tmp_path / name).write_bytes(data)
        light = find_light(str(tmp_path / name))
        assert isinstance(light, EnvironmentLight)
        assert light.map.texels.shape == (4, 8, 3)
    assert light.map.texels.min() == -1
    assert len(light.notes) == 1
    sanitised = find_light(str(tmp_path / "c.exr"), Reading(sanitize=True))
    assert sanitised.map.texels.min() == 0
    assert sanitised.notes[0].startswith("sanitised")


def test_a_function_is_found_by_its_file_and_name(tmp_path):
    path = tmp_path / "with: colon.py"
    path.write_text(FUNCTION)
    light = find_light(f"{path}:dusk")
    assert isinstance(light, FunctionLight)
    assert light.name == "dusk"


def test_missing_and_damaged_files_are_one_line(tmp_path):
    (tmp_path / "text.hdr").write_text("no picture")
    assert "none.toml" in refusal(find_light, str(tmp_path / "none.toml"))
    assert "none.exr" in refusal(find_light, str(tmp_path / "none.exr"))
    assert "text.hdr" in refusal(find_light, str(tmp_path / "text.hdr"))
    assert "no such file" in refusal(find_light, f"{tmp_path / 'none.py'}:dusk")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        (
            "picture.gif",
            "a file must end in .toml, .hdr, .pic, .rgbe, .exr, .png, .jpg, .jpeg, .pfm, .dds, .tif, .tiff, .psd, .psb, .webp,"
            " .bmp, .json, .gltf, .csv, .txt, .h, .glsl, .hlsl, .js, .cs, .npz or .npy: convert it",
        ),
        ("light.py", "a Python file; name a function in it, such as light.py:light"),
        ("folder", "a directory; name one file in it"),
    ],
)
def test_a_file_of_another_kind_is_told_the_kinds(tmp_path, name, said):
    path = tmp_path / name
    if name == "folder":
        path.mkdir()
    else:
        path.write_text("")
    assert refusal(find_light, str(path)) == f"unknown light {str(path)!r}: {said}"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("ldr.png:x", "only .exr files have layers; leave out :x"),
        ("sky.HDR:diffuse", "only .exr files have layers; leave out :diffuse"),
        ("scene.toml:", "only .exr files have layers; leave out :"),
        ("parts.exr:", "no layer is named after ':'; name one or leave out the ':'"),
        ("sky.py:", "no function is named after ':'; name one, such as sky.py:light"),
    ],
)
def test_a_colon_that_names_nothing_is_told_what_it_could_name(tmp_path, text, said):
    path = tmp_path / text
    assert refusal(find_light, text) == f"unknown light {text!r}: {said}"
    (tmp_path / text.rpartition(":")[0]).write_bytes(b"")
    assert refusal(find_light, str(path)) == f"unknown light {str(path)!r}: {said}"


@pytest.mark.parametrize("text", ["a" * 300, "a" * 300 + ".py:dusk"], ids=["name", "function"])
def test_a_name_longer_than_any_file_may_have_is_one_line(text):
    refusal(find_light, text)


@pytest.fixture(params=["scene", "image", "function", "coefficients", "green", "studio", "cosine", "venice_sunset"])
def light(request, tmp_path):
    """One light of every kind."""
    (tmp_path / "sh.csv").write_text("red,green,blue\n3,2,1\n0.5,0,-0.5\n1,1,1\n0,0.25,0\n")
    (tmp_path / "scene.toml").write_text(SCENE)
    (tmp_path / "light.py").write_text(FUNCTION)
    return {
        "scene": lambda: find_light(str(tmp_path / "scene.toml")),
        "image": smooth_image,
        "function": lambda: find_light(f"{tmp_path / 'light.py'}:dusk"),
        "coefficients": lambda: find_light(str(tmp_path / "sh.csv"), Reading(convention="three")),
    }.get(request.param, lambda: find_light(request.param))()


def test_coefficients_agree_with_a_jittered_projection_of_the_radiance(light):
    exact = light.coefficients(5)
    estimates = [project_samples(light.radiance, jittered(16_000, seed), 5) for seed in range(6)]
    sigma = np.std(estimates, axis=0, ddof=1) / np.sqrt(6)
    # an image is smoother between its texels than its areas are: 1 % of the largest for the built-in one (a sunset)
    slack = 0.01 if isinstance(light, EnvironmentLight) else 1e-4
    largest = np.abs(exact).max()
    assert_allclose(np.mean(estimates, axis=0), exact, rtol=0, atol=slack * largest + 5 * sigma.max())


@pytest.mark.parametrize("light", ["scene", "image", "function", "green", "studio", "cosine"], indirect=True)
def test_the_norm_agrees_with_a_jittered_integral_of_the_radiance(light):
    samples = jittered(160_000, seed=1)
    estimate = samples.weights @ light.radiance(samples.directions) ** 2
    # sigma of a cell of 1/400 in both directions, times the steepest light; texels of 3 degrees blur 1e-3
    assert_allclose(light.products().diagonal(), estimate, rtol=2e-3, atol=0)


def test_every_light_keeps_the_contract_of_shapes_and_types(light):
    d = random_directions(11)
    assert light.radiance(d).shape == (11, 3)
    assert light.radiance(d).dtype == np.float64
    for n_bands in (1, 2, 9):
        assert light.coefficients(n_bands).shape == (n_bands**2, 3)
    assert light.products().diagonal().shape == (3,)
    assert light.landmarks().shape[1:] == (3,)
    assert_allclose(np.linalg.norm(light.landmarks(), axis=1), 1, rtol=0, atol=1e-15)
    assert isinstance(light.notes, tuple)
    assert light.name
    assert light.best_method
    assert {light: 1}[light] == 1


def test_fewer_bands_are_the_first_of_more(light):
    many = light.coefficients(9)
    assert_allclose(light.coefficients(4), many[:16], rtol=0, atol=1e-13 * np.abs(many).max())


def test_the_coefficients_hold_no_more_energy_than_the_light(light):
    assert ((light.coefficients(32) ** 2).sum(axis=0) <= light.products().diagonal() * (1 + 1e-11)).all()


def test_a_light_is_drawn_by_its_lobes_or_by_its_map_and_either_shows_its_radiance(light):
    d = random_directions(300, seed=3)
    for one in (light, light.irradiance()):
        assert bool(one.lobes) == (one.map is None)
        shown = LobeLight(one.lobes).radiance(d) if one.map is None else one.map.sample(d)
        assert_allclose(shown, one.radiance(d), rtol=0, atol=1e-4 * np.abs(one.radiance(d)).max())


def test_rows_of_a_light_are_its_radiance_there(light):
    theta, phi = np.array([0.0, 0.3, 1.6, np.pi]), column_azimuths(6)
    d = directions_from_angles(theta[:, None], phi)
    for one in (light, light.irradiance()):
        wanted = one.radiance(d.reshape(-1, 3)).reshape(4, 6, 3).transpose(0, 2, 1)
        assert_allclose(one.rows(theta, 6), wanted, rtol=0, atol=1e-13 * np.abs(wanted).max())


def test_radiance_is_its_own_source_and_irradiance_its_own_irradiance(light):
    irradiance = light.irradiance()
    assert light.source is irradiance.source is light
    assert irradiance.irradiance() is irradiance
    coefficients = light.coefficients(6)
    assert light.from_source(coefficients) is coefficients
    assert_array_equal(irradiance.from_source(coefficients), irradiance.coefficients(6))
    assert (irradiance.name, irradiance.about, irradiance.notes) == (light.name, light.about, light.notes)


def test_the_texels_of_a_light_are_all_of_it_or_none(light):
    areas = [area for _, area in light.texels()]
    assert bool(areas) == (light.about.size is not None)
    if areas:
        assert_allclose(sum(area.sum() for area in areas), 4 * np.pi, rtol=1e-6)
        norm = sum(area @ radiance**2 for radiance, area in light.texels())
        assert_allclose(norm, light.products().diagonal(), rtol=1e-6)


def test_a_light_says_what_it_is_made_of(tmp_path):
    (tmp_path / "a.hdr").write_bytes(hdr_file(random_texels(4, 8)))
    (tmp_path / "sh.csv").write_text("red,green,blue\n3,2,1\n")
    image = find_light(str(tmp_path / "a.hdr"), Reading(layout="lat-long")).about
    assert (image.encoding, image.size, image.layout) == ("Radiance RGBE, new run-length packing", (8, 4), "lat-long")
    assert (image.n_bands, image.quantity, image.convention, image.file) == (None, None, None, None)
    given = find_light(str(tmp_path / "sh.csv"), Reading(convention="shviewer,irradiance")).about
    assert (given.encoding, given.size, given.layout) == (None, None, None)
    assert (given.n_bands, given.quantity, given.convention) == (1, "irradiance", "shviewer")
    assert given.file.numbers.tolist() == [[3, 2, 1]]
    assert find_light("green").about == FunctionLight(np.exp).about == About()


def test_finding_a_scene_loads_no_decoder_no_pillow_and_nothing_of_coefficients_or_suns():
    code = "import sys; from shviewer.lights.find import find_light; find_light('green'); print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "shviewer.lights.analytic.lobes" in loaded
    unwanted = ("PIL", "OpenEXR", "subprocess", "shviewer.coefficients.reading", "shviewer.lights.suns")
    unwanted += tuple(f"shviewer.lights.images.{name}" for name in ("display", "isolated", "openexr", "rgbe"))
    assert [name for name in loaded if name in unwanted] == []


def test_red_green_and_blue_of_an_image_grow_along_x_y_and_z():
    c = smooth_image().coefficients(2)
    strength = 4 * np.pi * np.sqrt(3 / (4 * np.pi)) / np.e  # 4 pi i_1(1) sqrt(3 / 4 pi), i_1(1) = 1/e
    expected = np.zeros((3, 3))
    expected[[2, 0, 1], [0, 1, 2]] = [-strength, -strength, strength]
    assert_allclose(c[1:], expected, rtol=0, atol=strength * (np.pi / 64) ** 2)
