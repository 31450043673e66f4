"""What is left of an image without its suns is not computed twice, and what cannot be a sun is refused cheaply."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from shviewer.errors import LightError
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.arrangements import VERTICAL_CROSS
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout
from shviewer.lights.suns.clipping import PLATEAU
from shviewer.lights.suns.compact_sources import CompactSources
from shviewer.lights.suns.patched import Patched

HEIGHT, WIDTH = 256, 512


def sky(seed: int, *spots: tuple[int, int, float]) -> np.ndarray:
    """Smooth light with noise, and spots of 2 x 2 texels: row, column and radiance."""
    rng = np.random.default_rng(seed)
    pixels = 1 + 0.5 * np.sin(np.linspace(0, 3, HEIGHT))[:, None, None] * rng.random((HEIGHT, WIDTH, 3))
    for row, column, radiance in spots:
        pixels[row : row + 2, column : column + 2] = radiance * np.array([1, 0.9, 0.8])
    return pixels.astype(np.float32)


TWO = (40, 300, 3e4), (180, 20, 2e4)


def shaped(layout: Layout, shape: tuple[int, int], *spots: tuple[int, int]) -> EnvironmentLight:
    """Noise in any layout, and spots of 2 x 2 texels."""
    pixels = np.random.default_rng(5).uniform(1, 1.5, (*shape, 3)).astype(np.float32)
    pixels *= np.broadcast_to(layout.solid_angles(), shape)[..., None] > 0
    for row, column in spots:
        pixels[row : row + 2, column : column + 2] = 3e4
    return EnvironmentLight(pixels, layout)


LIGHTS = {
    "lat-long": lambda: EnvironmentLight(sky(1, *TWO)),
    "angular": lambda: shaped(AngularLayout(360), (360, 360), (100, 150), (200, 230)),
    "mirror-ball": lambda: shaped(MirrorBallLayout(361), (361, 361), (100, 150), (250, 180)),
    "cube": lambda: shaped(CubeLayout(VERTICAL_CROSS, 128), (512, 384), (128, 200), (255, 255)),
}
OTHERS = {name: light for name, light in LIGHTS.items() if name != "lat-long"}


@pytest.mark.parametrize("n_bands", [2, 23, 24, 128])
@pytest.mark.parametrize("light", LIGHTS.values(), ids=LIGHTS)
def test_the_rest_has_the_coefficients_of_its_own_texels(light: Callable[[], EnvironmentLight], n_bands: int) -> None:
    whole = light()
    rest = whole.split_suns().rest
    own = EnvironmentLight(rest.pixels, whole.layout)
    np.testing.assert_array_equal(rest.products(), own.products())
    scale = np.abs(whole.coefficients(n_bands)).max()  # all bands of a sun are rounded like its largest
    np.testing.assert_allclose(rest.coefficients(n_bands), own.coefficients(n_bands), atol=5e-14 * scale, rtol=0)
    assert np.abs(whole.coefficients(n_bands) - rest.coefficients(n_bands)).max() > 0.1 * scale


@pytest.mark.parametrize("light", LIGHTS.values(), ids=LIGHTS)
def test_the_rest_is_not_projected_once_more_and_not_copied(
    light: Callable[[], EnvironmentLight], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = light()
    whole.coefficients(40)
    monkeypatch.setattr(type(whole.layout), "project", None)
    rest = whole.split_suns().rest
    assert rest.coefficients(40).shape == (40**2, 3)
    assert rest.products().shape == (3, 3)
    assert "pixels" not in vars(rest)


@pytest.mark.parametrize("light", OTHERS.values(), ids=OTHERS)
def test_a_sun_has_the_bands_of_the_texels_that_were_taken(
    light: Callable[[], EnvironmentLight], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = light().split_suns().suns
    monkeypatch.setattr(type(light().layout), "project_texels", lambda *_: None)  # the whole image, black but for them
    for sun, own in zip(found, light().split_suns().suns, strict=True):
        np.testing.assert_allclose(sun.axis, own.axis, atol=1e-8, rtol=0)  # the image is of float32
        np.testing.assert_allclose(sun.half_angle, own.half_angle, rtol=1e-4)
        np.testing.assert_allclose(sun.flux, own.flux, rtol=1e-12)


def test_some_rows_of_a_patched_image_and_single_texels_are_those_of_the_copy() -> None:
    rng = np.random.default_rng(6)
    image = rng.random((40, 30, 3)).astype(np.float32)
    patched, copy = Patched(image), image.copy()
    for _ in range(3):
        rows, columns = np.divmod(rng.choice(1200, 50, replace=False), 30)
        values = rng.random((50, 3)).astype(np.float32)
        patched, copy[rows, columns] = patched.replaced(rows, columns, values), values
    for top in range(0, 40, 7):
        np.testing.assert_array_equal(patched[top : top + 9], copy[top : top + 9])
    rows, columns = rng.integers(0, 40, 500), rng.integers(0, 30, 500)
    np.testing.assert_array_equal(patched.at(rows, columns), copy[rows, columns])
    taken = np.zeros(image.shape)
    values, rows, columns = patched.taken
    taken[rows, columns] = values
    np.testing.assert_array_equal(taken, image.astype(np.float64) - copy)
    assert Patched(image)[:] is not image
    assert np.shares_memory(Patched(image)[:], image)


def test_a_rest_that_is_far_darker_than_its_sun_is_projected_itself() -> None:
    pixels = sky(3, (60, 100, 1e6)) * np.float32(1)
    pixels[pixels < 1e5] *= np.float32(1e-3)
    rest = EnvironmentLight(pixels).split_suns().rest
    assert isinstance(rest, EnvironmentLight)
    np.testing.assert_array_equal(rest.coefficients(32), EnvironmentLight(rest.pixels).coefficients(32))


SPOTS = [
    (),
    TWO,
    ((40, 300, 3e4), (50, 300, 2e3), (60, 310, 900.0)),
    tuple((20 * k + 5, 37 * k % 500, 3e3 * 1.1**k) for k in range(12)),
    ((100, 100, 4e4), *((90 + k, 400 + 2 * k, 500.0) for k in range(20))),
]


@pytest.mark.parametrize("spots", SPOTS)
@pytest.mark.parametrize("wanted", ["auto", "all"])
def test_what_is_refused_cheaply_would_be_refused_anyway(
    spots: tuple[tuple[int, int, float], ...], wanted: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    light = EnvironmentLight(sky(4, *spots))

    def outcome() -> tuple[str, np.ndarray, list[list[float]]]:
        try:
            split = light.split_suns(wanted)
        except LightError as error:
            return str(error), light.pixels, []
        return "", split.rest.pixels, [[*sun.axis, sun.half_angle, *sun.radiance] for sun in split.suns]

    cheap = outcome()
    monkeypatch.setattr(CompactSources, "_may_hold", lambda *_: True)
    said, rest, suns = outcome()
    assert (cheap[0], cheap[2]) == (said, suns)
    np.testing.assert_array_equal(cheap[1], rest)


@pytest.mark.parametrize("seed", range(4))
def test_the_plateau_is_every_texel_at_the_highest_value_of_a_channel(seed: int) -> None:
    rng = np.random.default_rng(seed)
    pixels = rng.random((300, 1000, 3)).astype(np.float32)
    for channel, value in enumerate(rng.choice([0.5, 1.0, 2.0], 3)):
        at = rng.integers(0, pixels[..., 0].size, rng.integers(1, 200))
        plane = pixels[..., channel].ravel()
        plane[at] = value
        pixels[..., channel] = plane.reshape(300, 1000)
    found = CompactSources(pixels, LatLongLayout(300, 1000))._plateau
    ceiling = pixels.reshape(-1, 3).max(axis=0)
    expected = np.flatnonzero((pixels.reshape(-1, 3) == ceiling).any(axis=1))
    assert len(expected) >= PLATEAU
    assert found is not None
    np.testing.assert_array_equal(found.rows * 1000 + found.columns, expected)


def test_a_channel_that_is_black_has_no_plateau() -> None:
    pixels = np.zeros((64, 128, 3), np.float32)
    assert CompactSources(pixels, LatLongLayout(64, 128))._plateau is None
    pixels[3, 3:5, 0] = 1
    found = CompactSources(pixels, LatLongLayout(64, 128))._plateau
    assert found is not None
    assert found.columns.tolist() == [3, 4]
