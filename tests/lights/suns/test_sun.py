"""What shviewer.lights.suns.sun promises: suns leave a light as discs, and what is left and the discs are the light."""

from typing import NamedTuple

import numpy as np
import pytest
from helpers import refusal
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.coefficients.parts.axes import Axes
from shviewer.coefficients.suns import sun_left_out
from shviewer.errors import LightError
from shviewer.harmonics.basis import evaluate_basis, normalise
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.harmonics.metrics import errors_by_band_count, smallest_band_count
from shviewer.harmonics.quadrature import jittered
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.images.radiance_files import read_radiance_image
from shviewer.lights.layouts.arrangements import (
    HORIZONTAL_CROSS,
    HORIZONTAL_STRIP,
    OPENEXR,
    VERTICAL_CROSS,
    VERTICAL_STRIP,
)
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.light import Light
from shviewer.lights.suns.caps import Caps, chord, chord_of
from shviewer.lights.suns.excess import CAP
from shviewer.lights.suns.rule import MOST
from shviewer.lights.suns.sun import Sun
from shviewer.resources import resource_folder

HEIGHT, WIDTH = 128, 256
ARRANGEMENTS = [VERTICAL_STRIP, HORIZONTAL_STRIP, OPENEXR, VERTICAL_CROSS, HORIZONTAL_CROSS]
WHITE = np.ones(3)
NOON = normalise(np.array([0.5, 0.3, 0.7]))
SIZE_OF_SUN = np.radians(0.265)


def light(pixels, name="test"):
    pixels = np.ascontiguousarray(pixels, dtype=np.float32)
    return EnvironmentLight(pixels=pixels, layout=LatLongLayout(*pixels.shape[:2]), name=name)


def centres(height, width):
    """(height, width, 3)"""
    return LatLongLayout(height, width).centres(*np.indices((height, width)))


def towards(azimuth, elevation=0.0):
    """A direction from degrees."""
    azimuth, elevation = np.radians([azimuth, elevation])
    return np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), np.sin(elevation)])


def grey(height=HEIGHT, width=WIDTH, radiance=1.0):
    return np.full((height, width, 3), radiance)


def add_disc(pixels, axis, half_angle, radiance, samples=16):
    """Adds a disc, each texel's share of it by samples x samples points of equal solid angle."""
    height, width = pixels.shape[:2]
    near = chord(centres(height, width), axis) < chord_of(half_angle + 2 * np.pi / height)
    offset = (np.arange(samples) + 0.5) / samples
    for row, column in np.argwhere(near):
        z = np.cos(np.pi * row / height) * (1 - offset) + np.cos(np.pi * (row + 1) / height) * offset
        phi = np.pi * (1 - 2 * (column + offset) / width)
        z, phi = np.meshgrid(z, phi)
        points = np.stack([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z], axis=-1)
        pixels[row, column] += (chord(points, axis) <= chord_of(half_angle)).mean() * np.asarray(radiance)
    return pixels


def noon_sky(height, width, axis=NOON):
    """A clear sky of radiance about 1, brighter round a sun of its true size and 100 000 times its radiance."""
    directions = centres(height, width)
    cosine = directions @ axis
    sky = (1 + 0.4 * directions[..., 2]) * (1 + 0.5 * cosine**2 + 3 * np.exp(8 * (cosine - 1)))
    pixels = sky[..., None] * np.array([0.6, 0.8, 1.2])
    return add_disc(pixels, axis, SIZE_OF_SUN, 1e5 * np.array([1.0, 0.95, 0.85]))


def texels_of(layout):
    """(height, width), also of a layout whose rows are uniform."""
    if isinstance(layout, LatLongLayout):
        return layout.height, layout.width
    return layout.solid_angles().shape


class Parts(NamedTuple):
    """A light, and what it is split into."""

    whole: Light
    rest: Light
    suns: tuple[Sun, ...]

    @property
    def sunlight(self):
        return LobeLight(tuple(sun.lobe for sun in self.suns))


def split_suns(a_light, wanted="all"):
    return Parts(a_light, *a_light.split_suns(wanted))


def flux_taken(split):
    """Per channel, (3,), from the pixels."""
    gone = split.whole.pixels.astype(np.float64) - split.rest.pixels
    return (gone * split.whole.layout.solid_angles()[..., None]).sum(axis=(0, 1))


def refused(a_light):
    line = refusal(split_suns, a_light)
    assert line.startswith(a_light.name)
    return line


def test_rest_and_discs_have_bands_0_and_1_of_the_whole():
    split = split_suns(light(noon_sky(256, 512)))
    whole = split.whole.coefficients(2)
    difference = split.rest.coefficients(2) + split.sunlight.coefficients(2) - whole
    assert np.abs(difference[0]).max() < 1e-12 * np.abs(whole[0]).max()
    assert np.abs(difference.mean(axis=1)).max() < 1e-8 * whole[0].mean()  # float32 texels, projected to 2e-8
    assert np.abs(difference).max() < 1e-6 * np.abs(whole[0]).max()


def test_further_bands_differ_by_the_shape_of_the_texels():
    """A texel of width w may be longer than wide by w, that is s^2 - t^2 = w^2 / 12, and its profile is not the disc's."""
    split = split_suns(light(noon_sky(256, 512)))
    difference = split.rest.coefficients(9) + split.sunlight.coefficients(9) - split.whole.coefficients(9)
    flux, angle, texel = split.suns[0].flux.max(), split.suns[0].half_angle, 2 * np.pi / 512
    for l in range(2, 9):
        found = np.linalg.norm(difference[l * l : (l + 1) ** 2].max(axis=1))
        allowed = flux * np.sqrt((2 * l + 1) / (4 * np.pi)) * (l * (l + 1) * texel**2 / 96 + (l * angle) ** 4 / 200)
        assert found < allowed


def test_the_irradiance_of_rest_and_sun_is_that_of_the_whole():
    split = split_suns(light(noon_sky(512, 1024)))
    basis = evaluate_basis(jittered(500, 0).directions, 9) * irradiance_factors(9).repeat(2 * np.arange(9) + 1)
    whole = basis @ split.whole.coefficients(9)
    both = basis @ (split.rest.coefficients(9) + split.sunlight.coefficients(9))
    assert (
        np.abs(both - whole).max() < 2e-6 * whole.max()
    )  # band 2, by the shape of the texels: a quarter at 2048 x 1024


def test_a_noon_sky_needs_few_bands_without_its_sun():
    split = split_suns(light(noon_sky(256, 512)))
    whole, rest = split.whole.coefficients(64), split.rest.coefficients(64)
    assert smallest_band_count(errors_by_band_count(split.whole.products(), whole, whole), 0.5) is None
    assert smallest_band_count(errors_by_band_count(split.rest.products(), rest, rest), 0.05) <= 9
    received = [per_coefficient(irradiance_factors(64)) * coefficients for coefficients in (whole, rest)]
    needed = [smallest_band_count(errors_by_band_count(r.T @ r, r, r), 0.01) for r in received]
    assert needed[0] >= 9
    assert needed[1] == 3


def test_the_whole_is_untouched_and_so_is_what_lies_beyond_the_cap():
    pixels = noon_sky(HEIGHT, WIDTH).astype(np.float32)
    before = pixels.copy()
    split = split_suns(light(pixels))
    assert_array_equal(split.whole.pixels, before)
    changed = (split.rest.pixels != before).any(axis=2)
    assert changed.any()
    assert (chord(centres(HEIGHT, WIDTH)[changed], split.suns[0].axis) < chord_of(1.01 * CAP)).all()


def test_a_disc_is_found_where_it_is_with_its_size_and_flux():
    axis = towards(40, 35)
    split = split_suns(light(add_disc(grey(512, 1024), axis, np.radians(1.5), [2000, 1000, 500])))
    (sun,) = split.suns
    texel = 2 * np.pi / 1024
    assert chord(sun.axis, axis) < 0.02 * texel  # the samples of a texel are 1/16 of it apart, and the edge has many
    assert np.radians(1.5) < sun.half_angle < np.hypot(np.radians(1.5), texel)  # texels at the edge spread it
    assert_allclose(sun.flux, 2 * np.pi * (1 - np.cos(np.radians(1.5))) * np.array([2000, 1000, 500]), rtol=2e-3)
    assert_allclose(sun.solid_angle, 2 * np.pi * (1 - np.cos(sun.half_angle)), rtol=1e-10)


@pytest.mark.parametrize(("row", "column"), [(40, 100), (64, 0), (90, 255)])
def test_a_sun_of_one_texel_is_a_disc_as_large_as_the_texel(row, column):
    pixels = grey()
    pixels[row, column] = 1e4
    split = split_suns(light(pixels))
    (sun,) = split.suns
    solid_angle = split.whole.layout.solid_angles()[row, 0]
    assert chord(sun.axis, centres(HEIGHT, WIDTH)[row, column]) < 1e-3 * np.pi / HEIGHT * 180 / np.pi
    assert_allclose(sun.solid_angle, solid_angle, rtol=0.15)  # a square spreads 5 % more than a disc, these up to 12 %
    assert sun.solid_angle > solid_angle
    assert_array_equal(split.rest.pixels, grey().astype(np.float32))


def test_touching_texels_are_one_sun_across_the_seam():
    pixels = grey()
    pixels[60, [0, WIDTH - 1]] = 1e4
    (sun,) = split_suns(light(pixels)).suns
    assert_allclose(sun.axis, [-1, 0, np.cos(np.pi * 60.5 / HEIGHT)], atol=4e-3)


@pytest.mark.parametrize("pole", [1, -1])
def test_a_sun_at_a_pole_is_one_sun(pole):
    split = split_suns(light(add_disc(grey(), np.array([0, 0, pole]), np.radians(1), 1e4)))
    (sun,) = split.suns
    assert_allclose(sun.axis, [0, 0, pole], atol=1e-6)
    assert_allclose(sun.flux, flux_taken(split), rtol=1e-12)


@pytest.mark.parametrize("columns", [1, 77, 200])
def test_turning_the_image_turns_the_sun(columns):
    pixels = noon_sky(HEIGHT, WIDTH)
    (sun,) = split_suns(light(pixels)).suns
    (turned,) = split_suns(light(np.roll(pixels, columns, axis=1))).suns
    angle = -2 * np.pi * columns / WIDTH
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    assert_allclose(turned.axis, turn @ sun.axis, atol=1e-7)
    assert_allclose(turned.half_angle, sun.half_angle, rtol=1e-3)  # 1 - |vector| / flux, to 2e-8
    assert_allclose(turned.flux, sun.flux, rtol=1e-6)


def test_suns_come_in_order_of_their_flux_not_of_their_radiance():
    pixels = add_disc(grey(256, 512), towards(10, 20), np.radians(0.6), 5e3 * WHITE)
    split = split_suns(light(add_disc(pixels, towards(100, 40), np.radians(2), 2e3 * WHITE)))
    wide, bright = split.suns
    assert wide.flux.sum() > bright.flux.sum()
    assert wide.radiance.sum() < bright.radiance.sum()
    assert_allclose(wide.flux + bright.flux, flux_taken(split), rtol=1e-12)


def test_a_sun_is_weighed_against_what_brighter_ones_leave():
    pixels = add_disc(grey(256, 512), towards(10, 20), np.radians(0.6), 1e6 * WHITE)
    bright, dim = split_suns(light(add_disc(pixels, towards(100, 40), np.radians(0.6), 2e4 * WHITE))).suns
    assert_allclose(dim.flux, bright.flux / 50, rtol=1e-2)  # of ||f||^2, 1/2500 at first


def test_no_more_than_sixteen_sources_leave():
    pixels = grey(radiance=0.01)
    pixels[64, ::14] = 100
    split = split_suns(light(pixels))
    assert len(split.suns) == MOST
    assert (split.rest.pixels == 100).all(axis=2).sum() == len(range(0, WIDTH, 14)) - MOST


def test_what_is_left_has_no_sun():
    pixels = add_disc(noon_sky(HEIGHT, WIDTH), towards(-120, -20), np.radians(1), 1e4 * WHITE)
    split = split_suns(light(pixels))
    assert len(split.suns) == 2
    refused(split.rest)


def test_each_channel_keeps_its_own_flux():
    pixels = grey()
    pixels[40, 100] = [1, 200, 50_000]
    split = split_suns(light(pixels))
    assert_allclose(split.suns[0].flux, flux_taken(split), rtol=1e-12)
    assert split.suns[0].radiance[0] == 0
    assert_array_equal(split.rest.pixels[..., 0], split.whole.pixels[..., 0])


def test_a_channel_that_would_gain_by_it_gives_nothing():
    pixels = grey()
    pixels[40, 100] = [-0.01, 200, 50_000]
    split = split_suns(light(pixels))
    assert split.suns[0].radiance[0] == 0
    assert split.rest.pixels[40, 100, 0] == np.float32(-0.01)


def test_taking_a_sun_leaves_the_level_of_its_surroundings():
    split = split_suns(light(noon_sky(HEIGHT, WIDTH)))
    near = chord(centres(HEIGHT, WIDTH), NOON) < chord_of(2 * CAP)
    assert split.rest.pixels[near].min() >= split.whole.pixels[near].min()
    assert split.rest.pixels[near].max() < 2 * np.median(split.whole.pixels[near])


def test_the_ringing_of_a_resized_sun_leaves_with_it():
    pixels = grey()
    pixels[40, 98:103] = np.array([10, -800, 9000, -700, 12])[:, None]
    split = split_suns(light(pixels))
    assert_array_equal(split.rest.pixels[40, 98:103], np.array([1, 0, 1, 0, 1])[:, None] * np.ones(3))
    assert_allclose(split.suns[0].flux, flux_taken(split), rtol=1e-12)


def test_negative_texels_elsewhere_stay():
    pixels = grey()
    pixels[40, 100], pixels[100, 30] = 9000, -5
    assert (split_suns(light(pixels)).rest.pixels[100, 30] == -5).all()


def glow():
    """10 degrees about the sun, in the dark."""
    return add_disc(grey(radiance=0.01), NOON, np.radians(10), WHITE)


def tube():
    """3 degrees by 20."""
    pixels = grey(256, 512, 0.01)
    pixels[100:104, 200:230] = 100
    return pixels


def lamps(count):
    pixels = grey(radiance=0.01)
    rows, columns = np.random.default_rng(1).integers([[30], [0]], [[98], [WIDTH]], (2, count))
    pixels[rows, columns] = 100
    return pixels


@pytest.mark.parametrize(
    ("pixels", "reason"),
    [
        (lambda: grey(), "no texel is bright enough"),
        (lambda: grey(radiance=0), "nothing in it is above 0"),
        (lambda: grey(radiance=-1), "nothing in it is above 0"),
        (lambda: np.random.default_rng(0).random((HEIGHT, WIDTH, 3)), "no texel is bright enough"),
        (lambda: np.exp(np.random.default_rng(0).normal(size=(HEIGHT, WIDTH, 3))), "squared norm"),
        (lambda: grey(1, 1), "no texel is bright enough"),
        (lambda: np.random.default_rng(0).random((2, 3, 3)), "no texel is bright enough"),
        (lambda: np.random.default_rng(0).random((4, 3840, 3)), "no texel is bright enough"),
        (lambda: add_disc(grey(), NOON, np.radians(2.7), 1e4 * WHITE), "degrees wide"),
        (lambda: add_disc(grey(), NOON, np.radians(12), 1e4 * WHITE), "no brighter than what surrounds it"),
        (lambda: add_disc(glow(), NOON, np.radians(2), 7 * WHITE), "as bright as what surrounds it"),
        (lambda: add_disc(grey(), NOON, np.radians(0.7), 40 * WHITE), "of the squared norm"),
        (lambda: add_disc(grey(512, 1024), NOON, np.radians(0.2), 500 * WHITE), "of the flux"),
        (lambda: lamps(100), "of the squared norm"),
        (lambda: tube(), "part of something larger"),
    ],
)
def test_a_light_without_a_sun_says_why_in_one_line(pixels, reason):
    finding = refused(light(pixels())).split(";")[0]
    assert "has no sun" in finding
    assert reason in finding


def test_huge_and_tiny_radiances_are_split_alike():
    for scale in (1e-30, 1.0, 1e24):
        pixels = grey() * scale
        pixels[40, 100] *= 1e4
        split = split_suns(light(pixels))
        assert_allclose(split.suns[0].flux, flux_taken(split), rtol=1e-12)
        assert_allclose(split.suns[0].half_angle, np.radians(0.76), rtol=0.02)


@pytest.mark.parametrize(
    ("name", "suns", "sources"),
    [
        ("venice_sunset.hdr", 1, 1),
        ("film_studio.exr", 0, 1),
        ("st_fagans_interior.hdr", 0, 3),
        ("mud_road_puresky.hdr", 0, 0),
    ],
)
@pytest.mark.parametrize("wanted", ["auto", "all"])
def test_the_maps_that_ship(name, suns, sources, wanted):
    """A sun on the horizon; of four lamps the one that is small; lamps of a room; an overcast sky."""
    suns = suns if wanted == "auto" else sources
    a_light = light(read_radiance_image(resource_folder("assets") / "environments" / name).pixels, name)
    if not suns:
        with pytest.raises(LightError, match="has no sun"):
            a_light.split_suns(wanted)
    else:
        split = split_suns(a_light, wanted)
        assert len(split.suns) == suns
        assert_allclose(sum(sun.flux for sun in split.suns), flux_taken(split), rtol=1e-12)


def rings(height, core, step, axis=NOON):
    """A clear sky of 1, and a core clipped at 100 that glows: 20 and 4 in two rings around it, `step` degrees wide."""
    pixels, far = grey(height, 2 * height), np.degrees(2 * np.arcsin(chord(centres(height, 2 * height), axis) / 2))
    for radius, value in ((core + 2 * step, 4), (core + step, 20), (core, 100)):
        pixels[far <= radius] = value
    return pixels


@pytest.mark.parametrize("axis", [NOON, towards(180, 4), towards(20, 88)])
@pytest.mark.parametrize("step", [0.5, 1, 2, 4])
@pytest.mark.parametrize("core", [0.3, 0.6, 1.0, 1.5])
def test_a_clipped_sun_that_glows_is_found_and_said_to_be_clipped(core, step, axis):
    split = split_suns(light(rings(512, core, step, axis)), "auto")
    (sun,) = split.suns
    assert sun.clipped
    assert chord(sun.axis, axis) < np.radians(0.2)
    assert_allclose(sun.flux, flux_taken(split), rtol=1e-12)
    assert "had more" in sun_left_out(sun.directional_light, Axes())


def test_a_glow_that_falls_like_that_of_a_lens_is_found_too():
    far = np.degrees(2 * np.arcsin(chord(centres(256, 512), NOON) / 2))
    sky = 0.5 + 0.5 * (1 + centres(256, 512)[..., 2])
    pixels = np.minimum(sky + 3000 / (1 + (far / 0.3) ** 2) ** 1.5, 60)[..., None] * np.array([1.0, 0.9, 0.8])
    (sun,) = split_suns(light(np.minimum(pixels, 40)), "auto").suns
    assert sun.clipped


def test_a_disc_with_a_sharp_edge_and_a_sky_around_a_real_sun_are_not_clipped():
    for pixels in (
        noon_sky(256, 512),
        noon_sky(1024, 2048),
        add_disc(grey(512, 1024), NOON, np.radians(1), 5000 * WHITE),
    ):
        (sun,) = split_suns(light(pixels), "auto").suns
        assert not sun.clipped


def spots(count, radiance=100.0):
    pixels = grey(256, 512, 0.01)
    for i in range(count):
        pixels = add_disc(pixels, towards(360 * i / count, 20 - 40 * (i % 2)), np.radians(0.5), radiance * WHITE)
    return pixels


@pytest.mark.parametrize(
    ("pixels", "reason", "count"),
    [
        (lambda: spots(12), "its 12 brightest compact sources are alike, as lamps are", 12),
        (lambda: spots(3), "its 3 brightest compact sources are alike, as lamps are", 3),
        (lambda: add_disc(grey(512, 1024, 0.1), NOON, np.radians(2.1), 200 * WHITE), "is 4.2 degrees wide", 1),
        (lambda: add_disc(grey(512, 1024), NOON, np.radians(1.2), 48 * WHITE), "of the squared norm", 1),
    ],
)
def test_lamps_stay_unless_they_are_asked_for(pixels, reason, count):
    lamps = light(pixels())
    with pytest.raises(LightError, match=reason) as caught:
        lamps.split_suns()
    assert "a sun is a compact source of at most 3 degrees with 25 % of the squared norm" in str(caught.value)
    every, strongest = split_suns(lamps, "all"), split_suns(lamps, 1)
    assert len(every.suns) == count
    assert len(strongest.suns) == 1
    assert_allclose(strongest.suns[0].flux, every.suns[0].flux, rtol=1e-6)
    assert_allclose(strongest.suns[0].flux, flux_taken(strongest), rtol=1e-12)


def test_a_sun_leaves_and_lamps_beside_it_stay():
    pixels = add_disc(spots(4), towards(45, 70), np.radians(0.4), 1e5 * WHITE)
    split = split_suns(light(pixels), "auto")
    (sun,) = split.suns
    assert chord(sun.axis, towards(45, 70)) < np.radians(0.1)
    beyond = chord(centres(256, 512), sun.axis) > chord_of(1.01 * CAP)
    assert_array_equal(split.rest.pixels[beyond], split.whole.pixels[beyond])


def test_scenes_have_the_same_rule():
    discs = [Lobe(Disc(0.01), towards(30 * i), 1e4 * WHITE) for i in range(12)]
    with pytest.raises(LightError, match="its 12 brightest compact sources are alike"):
        LobeLight(tuple(discs)).split_suns()
    assert len(LobeLight(tuple(discs)).split_suns(5).suns) == 5
    sky = Lobe(Constant(), [0, 0, 1], WHITE)
    with pytest.raises(LightError, match=r"is 4\.2 degrees wide"):
        LobeLight((sky, Lobe(Disc(np.radians(2.1)), [0, 0, 1], 1e4 * WHITE))).split_suns()


def test_the_disc_of_a_scene_leaves_exactly():
    whole = find_light("sun-sky")
    split = split_suns(whole)
    (sun,) = split.suns
    sky, disc = whole.lobes
    assert (sun.axis == disc.axis).all()
    assert (sun.radiance == disc.radiance).all()
    assert sun.half_angle == disc.profile.half_angle
    assert split.rest.lobes == (sky,)
    both = split.rest.coefficients(20) + split.sunlight.coefficients(20)
    assert_allclose(both, whole.coefficients(20), rtol=1e-14, atol=0)


def test_a_scene_that_is_all_sun_leaves_black():
    split = split_suns(LobeLight((Lobe(Disc(0.01), [0, 1, 0], 5 * WHITE),)))
    assert not split.rest.coefficients(4).any()
    assert len(split.suns) == 1


def test_of_several_discs_only_the_small_and_bright_leave():
    sky, large = Lobe(Constant(), [0, 0, 1], WHITE), Lobe(Disc(0.3), [0, 0, 1], 100 * WHITE)
    small, bright = Lobe(Disc(0.03), [1, 0, 0], 5000 * WHITE), Lobe(Disc(0.01), [0, 1, 0], 30000 * WHITE)
    dim, soft = Lobe(Disc(0.01), [-1, 0, 0], 20 * WHITE), Lobe(ClampedLinear(1e4, 9999), [0, -1, 0], 40000 * WHITE)
    split = split_suns(LobeLight((sky, dim, bright, large, small, soft)))
    assert [tuple(sun.axis) for sun in split.suns] == [(1, 0, 0), (0, 1, 0)]
    assert split.rest.lobes == (sky, dim, large, soft)


@pytest.mark.parametrize("name", ["green", "constant", "hemisphere", "studio"])
def test_scenes_without_a_small_disc_have_no_sun(name):
    assert "has no sun" in refused(find_light(name))


def test_a_disc_whose_squares_are_0_is_refused_in_words():
    assert "holds only 0 % of the squared norm" in refused(LobeLight((Lobe(Disc(0.01), [0, 1, 0], 1e-200 * WHITE),)))


def test_the_irradiance_of_a_light_cannot_be_split():
    assert "only images and sums of lobes" in refused(find_light("sun-sky").irradiance())


def test_the_irradiance_lobe_is_exact_but_for_the_horizon():
    sun = Sun(np.array([0.0, 0.0, 1.0]), np.radians(2), np.array([3.0, 2.0, 1.0]))
    rings, spokes = 400, 400
    z = 1 - (1 - np.cos(sun.half_angle)) * (np.arange(rings)[:, None] + 0.5) / rings
    phi = 2 * np.pi * (np.arange(spokes) + 0.5) / spokes
    points = np.stack(
        np.broadcast_arrays(np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z), axis=-1
    )
    worst = (sun.half_angle - np.sin(sun.half_angle) * np.cos(sun.half_angle)) / (np.pi * np.sin(sun.half_angle) ** 2)
    assert_allclose(worst, 2 * sun.half_angle / (3 * np.pi), rtol=1e-3)
    for elevation in np.radians([-3, -2, -1, -0.1, 0, 0.1, 1, 2, 3, 30, 90]):  # of the sun's centre
        normal = np.array([np.cos(elevation), 0, np.sin(elevation)])
        truth = np.maximum(points @ normal, 0).mean() * sun.flux
        [lobe] = sun.lobes("irradiance", 7)
        shown = lobe.profile.value(chord(normal, sun.axis) ** 2) * lobe.radiance
        bound = worst if abs(elevation) < sun.half_angle else 0
        assert (truth - shown >= -1e-5 * sun.irradiance).all()  # 1e-5: the quadrature of a disc that the horizon cuts
        assert (truth - shown <= (bound + 1e-5) * sun.irradiance).all()


LAYOUTS = [
    *(LatLongLayout(*size) for size in [(1, 1), (5, 7), (128, 256), (100, 333), (2000, 10), (6, 5000)]),
    *(CubeLayout(arrangement, face) for arrangement in ARRANGEMENTS for face in (1, 5, 60)),
]


@pytest.mark.parametrize("axis", [NOON, towards(180), towards(0, 90), towards(77, -89), towards(45, 35)])
@pytest.mark.parametrize("layout", LAYOUTS, ids=repr)
def test_a_cap_holds_every_texel_within_its_angle(axis, layout):
    height, width = texels_of(layout)
    everywhere = np.indices((height, width))
    shown = np.broadcast_to(layout.solid_angles(), (height, width)) > 0
    distance = chord(layout.centres(*everywhere.reshape(2, -1)), axis).reshape(height, width)
    for half_angle in (0.02, 0.3, 1.0):
        cap = Caps(layout, height, width).cap(axis, half_angle)
        inside = np.flatnonzero(shown & (distance <= chord_of(half_angle)))
        assert_array_equal(np.sort(cap.rows * width + cap.columns), inside)
        assert (cap.solid_angles > 0).all()


@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=lambda arrangement: arrangement.name)
@pytest.mark.parametrize("axis", [towards(10, 20), towards(45, 35.3), towards(-135, 0), towards(120, -80)])
def test_a_sun_in_a_cube_is_one_sun_even_on_an_edge_or_a_corner(arrangement, axis):
    layout = CubeLayout(arrangement, 90)
    height, width = texels_of(layout)
    rows, columns = np.indices((height, width)).reshape(2, -1)
    pixels = np.ones((height, width, 3), dtype=np.float32)
    near = chord(layout.centres(rows, columns), axis).reshape(height, width) < chord_of(np.radians(1.5))
    pixels[near & (layout.solid_angles() > 0)] = 2000
    split = split_suns(EnvironmentLight(pixels=pixels, layout=layout))
    (sun,) = split.suns
    assert chord(sun.axis, axis) < np.radians(0.2)  # a fifth of a texel
    assert_allclose(sun.half_angle, np.radians(1.5), rtol=0.15)
    assert_allclose(sun.flux, flux_taken(split), rtol=1e-12)
    assert (split.rest.pixels == 1).all()
