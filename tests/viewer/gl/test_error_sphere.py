"""The third sphere: the shader's error against the CPU's, its colours against their tables, and maps against the sum."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from helpers import picture_of, to_srgb
from numpy.typing import NDArray
from viewer.colour.curves import toned
from viewer.gl.frames import lobes, picture_view, positions, reconstructing, rounding, sum_of_harmonics

from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.zonal import Constant, Disc, Gaussian
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.function import FunctionLight
from shviewer.viewer.colour.colour_maps import linear, map_of, table
from shviewer.viewer.colour.error_scale import error_values
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, Sphere
from shviewer.viewer.drawn import DirectSum, SplineMap
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.screenshot import render_linear, render_rgb
from shviewer.viewer.state import state_of
from shviewer.viewer.view import TONES

ORIGINAL, RECONSTRUCTION, ERROR = range(3)
SIDE = 128


def three_spheres(side: int = SIDE) -> Composition:
    """Side by side, their centres off every pixel's centre and edge."""
    spheres = tuple(
        Sphere(
            (number + 0.5) * side + off, side / 2 - off, 0.47 * side, Box(number * side, 0, (number + 1) * side, side)
        )
        for number, off in enumerate((0.27, -0.38, 0.11))
    )
    return Composition(3 * side, side, 1.0, spheres)


def original_at(picture: Picture, directions: Array) -> Array:
    return np.asarray(picture.light.radiance(directions))


@pytest.mark.parametrize("light", ["green", "studio", "venice_sunset", "cosine"])
@pytest.mark.parametrize("n_bands", [3, 9, 32, 40])
@pytest.mark.parametrize("error", ["signed", "relative"])
def test_the_linear_error_is_reconstruction_minus_original_at_every_pixel(
    renderer: Renderer, light: str, n_bands: int, error: str
) -> None:
    """Whatever the colours show. Bounds are those of the two spheres that it is the difference of (test_parity.py)."""
    frame = three_spheres()
    picture = picture_of(light, n_bands=n_bands, error=error, camera=(35.0, 15.0), muted=frozenset({2}))
    seen = picture_view(frame, ERROR, picture)
    original = original_at(picture, seen.directions)
    wanted = sum_of_harmonics(seen.directions, picture.coefficients) - original
    drawn = render_linear(renderer, picture, frame)[seen.mask]
    peak = max(np.abs(wanted).max(), np.abs(original).max())
    # a pixel's direction is rounded, and the original may jump from texel to texel or along a crease
    steep = np.abs(original_at(picture, seen.directions + 3 * rounding(seen)[:, None]) - original).max(axis=1)
    if picture.original.map is not None:
        steep = steep + 4e-5 * peak  # angles of float32, times the contrast of neighbouring texels
    smooth = (n_bands * np.maximum(1e-6, rounding(seen)) + 3e-5 * (n_bands > 32)) * peak
    error_made = np.abs(drawn - wanted).max(axis=1)
    allowed = smooth + 8 * steep + 1e-6 * peak
    assert (error_made <= allowed).mean() > 0.999, np.sort(error_made / allowed)[-10:]
    assert np.median(error_made) < 2e-6 * n_bands * peak


@pytest.mark.parametrize("error", ["signed", "absolute", "relative"])
@pytest.mark.parametrize("light", ["green", "studio"])
def test_the_colours_are_those_of_the_table_for_the_errors_of_the_cpu(
    renderer: Renderer, light: str, error: str
) -> None:
    frame = three_spheres()
    picture = picture_of(light, n_bands=5, error=error)
    seen = picture_view(frame, ERROR, picture)
    original = original_at(picture, seen.directions)
    values = error_values(
        error, original, sum_of_harmonics(seen.directions, picture.coefficients), picture.error_scale.floor
    )
    share = np.clip(values / picture.error_scale.end, -1, 1)
    position = 255 * (0.5 + 0.5 * share if error == "signed" else share)
    colours = table(map_of(error)).astype(float)
    wanted = np.stack([np.interp(position, np.arange(256), colours[:, channel]) for channel in range(3)], axis=1)
    drawn = render_rgb(renderer, picture, frame, overlay=False)[seen.mask].astype(float)
    inner = seen.facing > 0.2  # pixels of the soft rim are mixed with the background
    # interpolated in linear light, rounded to bytes; a step of the table is at most 4 of 255
    assert np.abs(drawn - wanted)[inner].max() < 2.5
    assert np.abs(drawn - wanted)[inner].mean() < 0.4


def test_a_fixed_range_is_kept_whatever_the_error(renderer: Renderer) -> None:
    frame = three_spheres()
    wide, narrow = (picture_of("green", error="absolute", error_range=end) for end in (10.0, 0.01))
    assert (wide.error_scale.end, narrow.error_scale.end) == (10.0, 0.01)
    dark, bright = (
        render_rgb(renderer, p, frame, overlay=False)[picture_view(frame, ERROR, p).mask] for p in (wide, narrow)
    )
    assert dark.mean() < 40 < 150 < bright.mean()


def test_an_exact_reconstruction_has_no_colour_but_that_of_zero(renderer: Renderer) -> None:
    frame = three_spheres()
    picture = picture_of("constant", n_bands=2, error="signed")
    seen = picture_view(frame, ERROR, picture)
    drawn = render_rgb(renderer, picture, frame, overlay=False)[seen.mask][seen.facing > 0.2]
    assert drawn.max() <= 2


@pytest.mark.parametrize("error", ["signed", "absolute"])
def test_no_error_is_black_and_more_of_it_is_brighter(error: str) -> None:
    luminance = linear(table(map_of(error))) @ LUMINANCE
    halves = (luminance[127::-1], luminance[128:]) if error == "signed" else (luminance,)
    for half in halves:
        assert half[0] < 1e-4
        assert (np.diff(half) >= 0).all()


@pytest.mark.parametrize("error", ["signed", "absolute", "relative"])
def test_what_float32_makes_of_no_error_is_not_blown_up_to_colours(renderer: Renderer, error: str) -> None:
    """128 bands hold all of the studio: what is left is rounding, in float64 of 1e-15 and in the shader of 1e-7."""
    frame = three_spheres()
    picture = picture_of("studio", n_bands=128, error=error)
    assert picture.error_scale is not None
    assert not picture.error_scale.worth_showing
    seen = picture_view(frame, ERROR, picture)
    drawn = render_rgb(renderer, picture, frame, overlay=False)[seen.mask][seen.facing > 0.2].astype(int)
    colours = table(map_of(error)).astype(int)
    zero = colours[127] if error == "signed" else colours[0]
    assert np.median(np.abs(drawn - zero).max(axis=1)) < 30


def test_where_a_sun_was_split_off_the_error_is_that_of_the_rest(renderer: Renderer) -> None:
    frame = three_spheres()
    sun = Lobe(Disc(0.02), [0.3, 0.9, 0.3], [4000.0, 3000.0, 2000.0])
    light = lobes(Lobe(Constant(), [0, 0, 1], 1.0), Lobe(Gaussian(9.0), [0, 0, 1], 2.0), sun)
    picture = picture_of(light, n_bands=6, error="signed", split_sun=True)
    assert picture.suns
    seen = picture_view(frame, ERROR, picture)
    wanted = sum_of_harmonics(seen.directions, picture.coefficients) - original_at(picture, seen.directions)
    drawn = render_linear(renderer, picture, frame)[seen.mask]
    assert np.abs(drawn - wanted).max() < 2e-5 * np.abs(wanted).max()
    assert 1e-3 < np.abs(drawn).max() < 1  # the sun is 400


# --- maps in place of the sum


WHITE = 1 / 255


@pytest.mark.parametrize("light", ["green", "studio", "sun-sky", "venice_sunset", "film_studio", "st_fagans_interior"])
@pytest.mark.parametrize("n_bands", [2, 8, 17, 32])
def test_a_map_differs_from_the_direct_sum_by_less_than_half_a_step_of_white(
    renderer: Renderer, light: str, n_bands: int
) -> None:
    """In what reaches the eye before sRGB: exposed, and white where it is brighter than white.

    Either is float32, which has 1e-7 of the largest value anywhere: under a sun of a million that is more than the step.
    """
    frame = three_spheres(256)
    direct = picture_of(light, n_bands=n_bands)
    by_map = prepare(direct.state, by_map=True)
    assert isinstance(direct.drawn, DirectSum)
    assert isinstance(by_map.drawn, SplineMap)
    seen = picture_view(frame, RECONSTRUCTION, direct)
    exposed = [2.0**direct.exposure_stops * render_linear(renderer, p, frame)[seen.mask] for p in (direct, by_map)]
    shown = [np.clip(part, -1, 1) for part in exposed]
    float32 = 4e-7 * max(0.0, float(np.abs(exposed[0]).max()) - 100)
    assert 0 < np.abs(shown[0] - shown[1]).max() < 0.5 * WHITE + float32


def test_a_map_of_noise_is_as_close(renderer: Renderer) -> None:
    frame = three_spheres(256)
    coefficients = np.random.default_rng(0).normal(size=(32**2, 3))
    direct = reconstructing(picture_of("green", n_bands=32), coefficients)
    splines = reconstructing(picture_of("green", n_bands=33), np.vstack([coefficients, np.zeros((65, 3))]))
    by_map = replace(direct, drawn=splines.drawn)
    seen = picture_view(frame, RECONSTRUCTION, direct)
    drawn = [render_linear(renderer, p, frame)[seen.mask] for p in (direct, by_map)]
    assert np.abs(drawn[0] - drawn[1]).max() < 0.5 * WHITE * np.abs(drawn[0]).max()


# --- tone


@pytest.mark.parametrize("tone", TONES)
def test_every_sphere_shows_the_curve_of_the_cpu_at_one_exposure(renderer: Renderer, tone: str) -> None:
    """Bytes of sRGB [IEC 61966-2-1] of the curve of the exposed linear picture, where nothing is negative."""
    frame = three_spheres()
    picture = picture_of("studio", n_bands=12, tone=tone, marks=False)
    linear = render_linear(renderer, picture, frame).astype(np.float64)
    drawn = render_rgb(renderer, picture, frame, overlay=False).astype(int)
    for side in (ORIGINAL, RECONSTRUCTION):
        seen = picture_view(frame, side, picture)
        mask = seen.mask.copy()
        mask[seen.mask] = seen.facing > 0.2
        exposed = 2.0**picture.exposure_stops * linear[mask]
        positive = (exposed >= 0).all(axis=1)
        shown = np.clip(toned(exposed[positive], tone), 0, 1)
        assert positive.sum() > 1000
        assert np.abs(drawn[mask][positive] - np.round(255 * to_srgb(shown))).max() <= 1


def test_negative_radiance_has_its_hue_under_every_curve(renderer: Renderer) -> None:
    frame = three_spheres()
    seen = None
    for tone in TONES:
        picture = picture_of("green", n_bands=5, tone=tone, exposure_stops=0.0)
        seen = picture_view(frame, RECONSTRUCTION, picture)
        value = sum_of_harmonics(seen.directions, picture.coefficients)[:, 0]
        drawn: NDArray[np.int64] = render_rgb(renderer, picture, frame, overlay=False)[seen.mask].astype(int)
        blue = drawn[(value < -0.05) & (seen.facing > 0.2)]
        assert (blue[:, 2] > blue[:, 1]).all()
        assert (blue[:, 1] > blue[:, 0]).all()


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("stops", [-64.0, 64.0])
def test_no_exposure_makes_anything_but_black_or_white_of_a_grey_light(
    renderer: Renderer, tone: str, stops: float
) -> None:
    frame = three_spheres()
    picture = picture_of("constant", tone=tone, exposure_stops=stops, marks=False)
    seen = picture_view(frame, ORIGINAL, picture)
    drawn = render_rgb(renderer, picture, frame, overlay=False)[seen.mask][seen.facing > 0.2]
    assert (drawn == (255 if stops > 0 else 0)).all()


@pytest.mark.parametrize("tone", TONES)
def test_the_border_of_what_is_negative_is_black_on_both_sides(renderer: Renderer, tone: str) -> None:
    """Channels of both signs whose luminance is just above or below zero: neither may look like light or like ringing."""
    frame = three_spheres()
    for luminance in (-1e-5, 1e-5):
        red = (luminance - 0.7152 * 0.1 - 0.0722 * 0.1) / 0.2126
        colour = np.array([red, 0.1, 0.1])
        light = FunctionLight(lambda directions, colour=colour: np.tile(colour, (len(directions), 1)), "border")
        picture = picture_of(light, tone=tone, exposure_stops=0.0, marks=False)
        seen = picture_view(frame, ORIGINAL, picture)
        drawn = render_rgb(renderer, picture, frame, overlay=False)[seen.mask][seen.facing > 0.2]
        assert drawn.max() < 40
    plain = picture_of(
        FunctionLight(lambda directions: np.tile([0.0, 0.0, 0.5], (len(directions), 1)), "blue"), exposure_stops=0.0
    )
    seen = picture_view(frame, ORIGINAL, plain)
    assert render_rgb(renderer, plain, frame, overlay=False)[seen.mask][:, 2].max() >= 187  # no light is faded


def test_pixels_and_positions_agree(renderer: Renderer) -> None:
    """The ruler: where a sphere says that a pixel lies is where the frame's own arithmetic puts it."""
    frame = three_spheres()
    sphere = frame.spheres[2]
    place = positions(frame, sphere)
    found = sphere.position(300.5, 70.5)
    assert found == pytest.approx(tuple(place[70, 300]))
    assert sphere.position(10.0, 10.0) is None
    assert state_of(error="signed").view.n_spheres == 3
