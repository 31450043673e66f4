"""A map written as EXR: every pixel is the reconstruction in its direction, and the file is a light again."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from helpers import picture_of
from numpy.typing import NDArray
from PIL import Image
from viewer.gl.frames import lobes, map_frame

from shviewer import reconstruct
from shviewer.cli.main import main
from shviewer.errors import LightError
from shviewer.harmonics.zonal import Constant, Disc
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading
from shviewer.limits import Limits
from shviewer.viewer.camera import towards
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.sphere_maps import write_sphere_map
from shviewer.viewer.screenshot import render_linear

WIDTH, HEIGHT = 64, 32
Written = Callable[[Picture], dict[str, NDArray[np.float32]]]


@pytest.fixture
def written(tmp_path: Path) -> Written:
    """The layers of a picture's map, read by OpenEXR itself: "", "original" and "error"."""

    def write(picture: Picture) -> dict[str, NDArray[np.float32]]:
        write_sphere_map(picture, WIDTH, tmp_path / "map.exr")
        channels = OpenEXR.File(str(tmp_path / "map.exr"), separate_channels=True).channels()
        assert len(channels) == 9
        return {
            layer: np.stack([channels[f"{layer}.{letter}" if layer else letter].pixels for letter in "RGB"], axis=-1)
            for layer in ("", "original", "error")
        }

    return write


def directions() -> NDArray[np.float64]:
    """The angles of pixel centres: azimuth from half a turn on the left to minus half a turn, elevation from the top down."""
    azimuth = np.pi * (1 - 2 * (np.arange(WIDTH) + 0.5) / WIDTH)
    elevation = (np.pi * (0.5 - (np.arange(HEIGHT) + 0.5) / HEIGHT))[:, None]
    flat = np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth)
    return np.stack([*flat, np.broadcast_to(np.sin(elevation), flat[0].shape)], axis=-1)


@pytest.mark.parametrize("light", ["green", "venice_sunset", "sun-sky"])
@pytest.mark.parametrize("n_bands", [1, 9, 40])
def test_every_pixel_is_the_reconstruction_and_the_layers_are_original_and_error(
    written: Written, light: str, n_bands: int
) -> None:
    """As `shviewer.reconstruct` and the light itself say, within float32's rounding."""
    picture = picture_of(light, n_bands=n_bands, muted=frozenset({2}))
    layers = written(picture)
    wanted = reconstruct(picture.coefficients, directions())
    original = picture.light.radiance(directions().reshape(-1, 3)).reshape(HEIGHT, WIDTH, 3)
    peak = np.abs(wanted).max()
    np.testing.assert_allclose(layers[""], wanted, rtol=0, atol=1e-7 * peak)
    np.testing.assert_allclose(layers["original"], original, rtol=1e-7, atol=1e-9 * peak)
    np.testing.assert_allclose(layers["error"], wanted - original, rtol=1e-7, atol=1e-7 * peak)


def test_the_map_of_a_turned_light_is_turned(written: Written) -> None:
    turned = picture_of("venice_sunset", n_bands=5, light_rotation=towards(70.0, 40.0))
    layers = written(turned)
    inside = directions().reshape(-1, 3) @ turned.light_from_world.T
    wanted = reconstruct(turned.coefficients, inside).reshape(HEIGHT, WIDTH, 3)
    np.testing.assert_allclose(layers[""], wanted, rtol=0, atol=2e-7 * np.abs(wanted).max())
    original = turned.light.radiance(inside).reshape(HEIGHT, WIDTH, 3)
    np.testing.assert_allclose(layers["original"], original, rtol=1e-6)
    assert not np.allclose(layers[""], written(picture_of("venice_sunset", n_bands=5))[""], atol=0.1)


def test_a_sun_apart_stands_on_the_reconstruction_and_in_no_error(written: Written) -> None:
    sun = Lobe(Disc(0.04), directions()[12, 20], [400.0, 300.0, 200.0])
    light = lobes(Lobe(Constant(), [0, 0, 1], 1.0), sun)
    layers = written(picture_of(light, n_bands=3, split_sun=True, suns="all"))
    np.testing.assert_allclose(layers[""][12, 20], [401.0, 301.0, 201.0], rtol=1e-6)
    np.testing.assert_allclose(layers["original"], layers[""], rtol=1e-6)
    np.testing.assert_allclose(layers["error"], 0, atol=1e-9)


def test_the_map_is_what_the_shader_draws_of_the_whole_sphere(renderer: Renderer, written: Written) -> None:
    picture = picture_of("green", n_bands=9)
    drawn = render_linear(renderer, picture, map_frame(WIDTH))[:, WIDTH:]
    np.testing.assert_allclose(written(picture)[""], drawn, rtol=0, atol=2e-6)


@pytest.mark.parametrize("width", [64, 128])
def test_the_map_is_a_light_with_the_coefficients_that_it_was_made_of(tmp_path: Path, width: int) -> None:
    """A texel is an area of constant radiance, which weakens waves of m turns by (pi m / width)^2 / 6 along the rows, and
    about as much along the columns."""
    picture = picture_of("venice_sunset", n_bands=6)
    write_sphere_map(picture, width, tmp_path / "map.exr")
    light = find_light(str(tmp_path / "map.exr"))
    found, wanted = light.coefficients(8), picture.coefficients
    bound = 2 * (np.pi * 5 / width) ** 2 / 6
    assert np.abs(found[:36] - wanted).max() < bound * np.abs(wanted).max()
    assert np.abs(found[36:]).max() < bound * np.abs(wanted).max()  # and no others
    assert find_light(f"{tmp_path / 'map.exr'}:original").coefficients(1)[0].min() > 0


def test_what_made_the_map_is_in_it_and_no_sphere_is(tmp_path: Path, written: Written) -> None:
    written(picture_of("green", n_bands=4, whole_sphere=True))
    said = json.loads(OpenEXR.File(str(tmp_path / "map.exr")).header()["shviewer"])
    assert (said["bands"], said["size"], said["spheres"]) == (4, [WIDTH, HEIGHT], {})
    assert said["state"]["view"]["whole_sphere"] is True


def test_a_map_that_needs_more_memory_than_there_may_be_is_refused_before(tmp_path: Path) -> None:
    picture = picture_of("green", reading=Reading(limits=Limits(memory_bytes=2**20)))
    with pytest.raises(LightError, match=r"a map of 1280 x 640 with its layers takes up to"):
        write_sphere_map(picture, 1280, tmp_path / "map.exr")
    assert not (tmp_path / "map.exr").exists()


def test_the_command_writes_a_map_that_is_a_light_and_refuses_another_shape(
    renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(renderer))
    assert main(["screenshot", "map.exr", "green", "--bands", "5", "--map", "--size", "256", "128"]) == 0
    assert find_light("map.exr").description == "environment map, 256 x 128"
    assert main(["screenshot", "other.exr", "green", "--map", "--size", "256", "100"]) == 2
    assert "a map is twice as wide as high; give --size 256 128" in capsys.readouterr().err
    assert main(["screenshot", "both.exr", "green", "--map", "--lobes"]) == 2
    assert main(["screenshot", "both.png", "green", "--map", "--map-centre", "200", "95"]) == 2
    assert "elevation 95: it must be -90 to 90 degrees" in capsys.readouterr().err
    assert (
        main(["screenshot", "scrolled.png", "constant", "--map", "--map-centre", "200", "0", "--size", "128", "64"])
        == 0
    )
    with Image.open("scrolled.png") as image:
        assert json.loads(image.info["shviewer"])["state"]["view"]["map_centre"] == [-160.0, 0.0]
    assert not Path("other.exr").exists()
