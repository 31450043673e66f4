"""The whole sphere as a map: every pixel shows what float64 computes in its direction, at poles and seam, zoomed or not."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import random_directions
from helpers import picture_of, to_srgb
from viewer.gl.frames import lobes, map_directions, map_frame, reconstructing, square_frame, sum_of_harmonics

from shviewer.harmonics.basis import Array
from shviewer.harmonics.zonal import ClampedLinear, Gaussian
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.viewer.camera import towards
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture
from shviewer.viewer.screenshot import render_linear, render_rgb

ORIGINAL, RECONSTRUCTION, ERROR = range(3)
FRAMES = {
    "whole": map_frame(128),
    "scrolled over the seam": map_frame(128, centre=(157.3, 0.0)),
    "zoomed at the north pole": map_frame(128, 7.0, (-40.0, 90.0)),
    "zoomed at the south pole": map_frame(128, 3.3, (10.0, -90.0)),
}
TURNED = {"light_rotation": towards(33.0, 65.0)}


def shown(renderer: Renderer, picture: Picture, frame: Composition, side: int) -> tuple[Array, Array]:
    """What one map shows, and its directions in the light: (pixels, 3) each."""
    columns, world = map_directions(frame, side)
    drawn = render_linear(renderer, picture, frame)[:, columns].astype(np.float64)
    return drawn.reshape(-1, 3), world.reshape(-1, 3) @ picture.light_from_world.T


@pytest.mark.parametrize("where", FRAMES)
@pytest.mark.parametrize("n_bands", [1, 9, 32])
def test_the_map_of_a_reconstruction_is_right_within_two_ten_millionths_a_band(
    renderer: Renderer, n_bands: int, where: str
) -> None:
    """Some of the peak, and half a millionth: float32's rounding of the direction, 1e-7 or 2e-7, times n peaks per radian."""
    coefficients = np.random.default_rng(n_bands).normal(size=(n_bands**2, 3))
    for view in ({}, TURNED):
        picture = reconstructing(picture_of("green", n_bands=n_bands, **view), coefficients)
        drawn, directions = shown(renderer, picture, FRAMES[where], RECONSTRUCTION)
        wanted = sum_of_harmonics(directions, coefficients)
        peak = np.abs(sum_of_harmonics(random_directions(20_000), coefficients)).max()
        assert np.abs(drawn - wanted).max() < (2e-7 * n_bands + 5e-7) * peak


@pytest.mark.parametrize("where", FRAMES)
def test_the_map_of_a_sum_of_lobes_is_that_sum(renderer: Renderer, where: str) -> None:
    light = lobes(
        Lobe(ClampedLinear(5.0, 4.0), [0.1, 0.2, 1.0], [1.0, 2.0, 3.0]), Lobe(Gaussian(20.0), [-1.0, 0.1, -1.0], 1.0)
    )
    for view in ({}, TURNED):
        drawn, directions = shown(renderer, picture_of(light, **view), FRAMES[where], ORIGINAL)
        np.testing.assert_allclose(drawn, light.radiance(directions), rtol=0, atol=1e-5)


@pytest.mark.parametrize("light", ["venice_sunset", "green"])
def test_the_error_on_a_map_is_the_difference_of_the_others(renderer: Renderer, light: str) -> None:
    frame = map_frame(128, count=3)
    picture = picture_of(light, n_bands=6, error="signed")
    drawn = [shown(renderer, picture, frame, side)[0] for side in (ORIGINAL, RECONSTRUCTION, ERROR)]
    np.testing.assert_allclose(
        drawn[ERROR], drawn[RECONSTRUCTION] - drawn[ORIGINAL], rtol=0, atol=4e-7 * drawn[0].max()
    )


def test_the_map_of_an_image_of_its_size_is_the_image(renderer: Renderer) -> None:
    """Column for column and row for row: +x in the middle, azimuth falling to the right."""
    texels = np.random.default_rng(0).random((64, 128, 3)).astype(np.float32)
    picture = picture_of(EnvironmentLight(LatLongMap(texels)), n_bands=2)
    drawn, _ = shown(renderer, picture, map_frame(128), ORIGINAL)
    np.testing.assert_allclose(
        drawn.reshape(64, 128, 3), texels, rtol=0, atol=2e-5
    )  # 4e-7 of a turn is 1e-5 of a texel


@pytest.mark.parametrize("finer", [2, 4, 6])
def test_a_map_finer_than_the_pixels_is_averaged_and_one_that_is_not_is_left_alone(
    renderer: Renderer, finer: int
) -> None:
    """To the eye, as sRGB to a step; what is written as numbers is that of the pixel's middle."""
    texels = np.random.default_rng(0).random((32 * finer, 64 * finer, 3)).astype(np.float32)
    picture = picture_of(EnvironmentLight(LatLongMap(texels)), n_bands=1, exposure_stops=0.0, marks=False)
    drawn = render_rgb(renderer, picture, map_frame(64), overlay=False)[:, :64]
    mean = texels.astype(np.float64).reshape(32, finer, 64, finer, 3).mean(axis=(1, 3))
    assert np.abs(drawn - 255 * to_srgb(mean)).max() < 1.5
    drawn_linear, directions = shown(renderer, picture, map_frame(64), ORIGINAL)
    np.testing.assert_allclose(drawn_linear, picture.light.radiance(directions), rtol=0, atol=1e-4)


def test_on_a_sphere_a_fine_map_is_averaged_too(renderer: Renderer) -> None:
    """Noise of a texel's size has lost most of its contrast where a pixel covers several of them."""
    texels = np.random.default_rng(0).random((1024, 2048, 3)).astype(np.float32)
    picture = picture_of(EnvironmentLight(LatLongMap(texels)), n_bands=1, exposure_stops=-1.0, camera=(0.0, 0.0))
    drawn = render_rgb(renderer, picture, square_frame(128), overlay=False)[54:74, 54:74].astype(float)
    fine = render_rgb(renderer, picture, square_frame(1024), overlay=False)[502:522, 502:522].astype(float)
    assert drawn.std() < 0.4 * fine.std()
