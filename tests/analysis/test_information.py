"""`shviewer info` against numbers made without shviewer, and against the window's figures."""

from __future__ import annotations

import json
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from lights.images.hdr_files import exr_file, hdr_file, radiance_of, random_texels
from numpy.typing import NDArray

import shviewer
from shviewer.analysis.figures import needs
from shviewer.analysis.information import describe
from shviewer.cli.info import as_text
from shviewer.errors import LightError
from shviewer.lights.find import built_in_lights
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import state_of

BINS_PER_STOP = 22.0
"""The bins of the histogram are 32 to a stop, the first of each stop the widest: log2(33 / 32)."""

Pixels = NDArray[np.float32]
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def write_exr(path: Path, pixels: Pixels) -> str:
    path.write_bytes(exr_file({name: np.ascontiguousarray(pixels[..., i]) for i, name in enumerate("RGB")}))
    return str(path)


@pytest.fixture
def pixels() -> Pixels:
    """32 x 64, ten stops of them, black in places and with one hot texel."""
    rng = np.random.default_rng(5)
    made = np.exp2(rng.uniform(-5, 5, (32, 64, 3))).astype(np.float32)
    made[rng.random((32, 64)) < 0.1] = 0
    made[9, 50, 1] = 900
    return made


def areas(height: int, width: int) -> NDArray[np.float64]:
    """Solid angles of lat-long texels, (height, width)."""
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    return np.repeat((edges[:-1] - edges[1:])[:, None] * 2 * np.pi / width, width, axis=1)


def test_the_figures_of_an_image_are_those_of_its_texels(tmp_path: Path, pixels: Pixels) -> None:
    found = describe(write_exr(tmp_path / "sky.exr", pixels), DEFAULT_READING)
    weights, exact = areas(32, 64), pixels.astype(np.float64)
    assert (found.values.minimum, found.values.maximum, found.peak) == (0, 900, 900)
    assert found.values.negative_values == 0
    mean = np.einsum("rc,rck->k", weights, exact) / (4 * np.pi)
    np.testing.assert_allclose(found.mean, mean, rtol=1e-7)  # texels are float32
    assert found.mean_luminance == pytest.approx(mean @ LUMINANCE, rel=1e-7)
    black = (exact == 0).all(axis=2)
    assert found.values.negative_or_black_area == pytest.approx(weights[black].sum() / (4 * np.pi), rel=1e-12)
    luminance = exact[~black] @ LUMINANCE
    order = np.argsort(luminance)
    share = np.cumsum(weights[~black][order]) / weights[~black].sum()
    darkest = luminance[order][np.searchsorted(share, 0.01)]
    stops = np.log2(luminance.max() / darkest)
    assert found.values.dynamic_range_stops == pytest.approx(stops, abs=1 / BINS_PER_STOP)  # it counts in bins
    assert found.values.brightest_luminance == pytest.approx(luminance.max(), rel=1e-6)


def test_the_peak_is_the_centre_of_the_brightest_texel(tmp_path: Path, pixels: Pixels) -> None:
    found = describe(write_exr(tmp_path / "sky.exr", pixels), DEFAULT_READING)
    theta, phi = 180 * 9.5 / 32, 180 * (1 - 2 * 50.5 / 64)
    assert found.peak_theta_phi_degrees == pytest.approx((theta, phi), abs=1e-9)
    sine, cosine = np.sin(np.radians(theta)), np.cos(np.radians(theta))
    direction = sine * np.cos(np.radians(phi)), sine * np.sin(np.radians(phi)), cosine
    assert found.peak_direction == pytest.approx(direction, abs=1e-12)


def test_the_irradiance_up_is_the_integral_over_the_upper_half(tmp_path: Path, pixels: Pixels) -> None:
    """The integral of cos theta sin theta over a row is half the difference of sin^2, without a quadrature."""
    found = describe(write_exr(tmp_path / "sky.exr", pixels), DEFAULT_READING)
    squares = np.sin(np.pi * np.arange(17) / 32) ** 2
    rows = (squares[1:] - squares[:-1]) / 2 * 2 * np.pi / 64
    wanted = np.einsum("r,rck->k", rows, pixels[:16].astype(np.float64))
    np.testing.assert_allclose(found.irradiance_up, wanted, rtol=1e-12)


def test_file_size_encoding_and_layout_are_those_of_the_file(tmp_path: Path) -> None:
    path = tmp_path / "map.hdr"
    path.write_bytes(hdr_file(random_texels(8, 16)))
    found = describe(str(path), DEFAULT_READING)
    assert (found.light, found.file, found.file_bytes) == ("map", str(path), path.stat().st_size)
    assert (found.size, found.layout) == ((16, 8), "lat-long")
    assert found.encoding is not None
    assert "RGBE" in found.encoding
    assert found.values.maximum == radiance_of(random_texels(8, 16)).max()


@pytest.mark.parametrize("light", ["green", "venice_sunset", "film_studio"])
def test_the_figures_are_the_windows(light: str) -> None:
    found, state = describe(light, DEFAULT_READING), state_of(light)
    picture = prepare(state)
    assert found.energy_share == picture.figures.energy_share[:9]
    assert found.peak == pytest.approx(picture.figures.extremes.peak, rel=1e-9)
    assert [need.tolerance for need in found.bands_needed] == [0.1, 0.05, 0.01]
    in_window = asdict(needs(state.recipe))
    assert found.bands_needed[1].radiance == in_window["radiance"]
    assert found.bands_needed[1].irradiance == in_window["irradiance"]
    assert found.notes == picture.light.notes
    assert found.method == picture.projection.method


def test_a_hemisphere_has_the_figures_of_the_textbook(tmp_path: Path) -> None:
    """Radiance 3 above the horizon: mean 3/2, irradiance 3 pi, energy 1/2 of it in band 0 and 3/8 in band 1."""
    path = tmp_path / "half.toml"
    path.write_text('[[lobe]]\nprofile = "disc"\naxis = [0, 0, 1]\nradiance = 3\nhalf_angle_degrees = 90\n')
    found = describe(str(path), DEFAULT_READING)
    np.testing.assert_allclose(found.mean, 1.5, rtol=1e-12)
    np.testing.assert_allclose(found.irradiance_up, 3 * np.pi, rtol=1e-6)  # a table, linear between its nodes
    np.testing.assert_allclose(found.energy_share[:3], [0.5, 0.375, 0], rtol=0, atol=1e-12)
    assert (found.values.minimum, found.values.maximum) == (0, 3)
    assert found.values.negative_or_black_area == pytest.approx(0.5, abs=1e-12)
    assert found.encoding is found.layout is found.size is None


def test_the_peak_of_a_function_is_climbed_to(tmp_path: Path) -> None:
    path = tmp_path / "my.py"
    path.write_text(
        "import numpy as np\ndef sky(d):\n    return 7 * np.exp(200 * (d @ [0.48, -0.6, 0.64] - 1)) - 0.5\n"
    )
    found = describe(f"{path}:sky", DEFAULT_READING)
    assert found.peak == pytest.approx(6.5, rel=1e-9)
    assert found.peak_direction == pytest.approx((0.48, -0.6, 0.64), abs=1e-5)
    assert found.values.minimum == pytest.approx(-0.5, rel=1e-9)


def test_negative_values_are_counted_and_kept(tmp_path: Path, pixels: Pixels) -> None:
    pixels[3, 4], pixels[5, 6, 0] = (-1, -2, -3), -0.25
    found = describe(write_exr(tmp_path / "sky.exr", pixels), DEFAULT_READING)
    assert (found.values.negative_values, found.values.minimum) == (4, -3)
    assert re.search(r"bad values +no NaN, no infinity, 4 negative\n", as_text(found))


def test_an_image_with_nan_is_described_as_it_would_be_repaired_and_the_refusal_is_told(
    tmp_path: Path, pixels: Pixels
) -> None:
    clean = describe(write_exr(tmp_path / "clean.exr", pixels), DEFAULT_READING)
    pixels[2, 3, 0], pixels[0, 0, 1] = np.nan, np.inf
    text = write_exr(tmp_path / "sky.exr", pixels)
    found = describe(text, DEFAULT_READING)
    assert found.refused is not None
    assert "1 NaN, 1 +Inf" in found.refused
    assert found.values.maximum == clean.values.maximum
    assert any("1 NaN -> 0" in note for note in found.notes)
    assert found.refused in as_text(found)
    assert describe(text, Reading(sanitize=True)).refused is None


def test_an_array_with_nan_is_described_as_any_other_image(tmp_path: Path, pixels: Pixels) -> None:
    pixels[2, 3, 0] = np.nan
    np.save(tmp_path / "sky.npy", pixels.astype(np.float32))
    found = describe(str(tmp_path / "sky.npy"), DEFAULT_READING)
    assert "1 NaN" in (found.refused or "")
    assert any("1 NaN -> 0" in note for note in found.notes)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -1.0])
def test_what_was_repaired_is_not_said_never_to_have_been(tmp_path: Path, pixels: Pixels, bad: float) -> None:
    clean, mended = write_exr(tmp_path / "clean.exr", pixels), tmp_path / "mended.exr"
    pixels[2, 3, 0] = bad
    said = as_text(describe(write_exr(mended, pixels), Reading(sanitize=True)))
    assert re.search(r"bad values +repaired, see note\n", said)
    assert re.search(r"note +sanitised: ", said)
    assert re.search(r"bad values +no NaN, ", as_text(describe(clean, Reading(sanitize=True))))


def test_what_no_repair_can_help_is_refused_with_the_first_reason(tmp_path: Path) -> None:
    (tmp_path / "text.hdr").write_text("no image")
    with pytest.raises(LightError, match=r"text\.hdr"):
        describe(str(tmp_path / "text.hdr"), DEFAULT_READING)
    text = write_exr(tmp_path / "nothing.exr", np.full((4, 8, 3), np.nan, np.float32))
    with pytest.raises(LightError, match="96 NaN"):
        describe(text, DEFAULT_READING)


def test_a_black_light_has_neither_range_nor_bands(tmp_path: Path) -> None:
    found = describe(write_exr(tmp_path / "night.exr", np.zeros((4, 8, 3), np.float32)), DEFAULT_READING)
    assert found.values.dynamic_range_stops is found.values.darkest is None
    assert set(found.energy_share) == {0.0}
    said = as_text(found).replace(str(tmp_path), "")
    assert "black             100 %" in said
    assert re.search(r"peak +0 at", said)
    assert not re.search(r"-0(\.0*)?(?![.\d])", said)
    json.dumps(asdict(found), allow_nan=False)


@pytest.mark.parametrize("level", [0.7, 991.0, 1000.0, 1023.0])
def test_the_darkest_is_never_outside_of_what_there_is(tmp_path: Path, level: float) -> None:
    """An image of one luminance, whatever its place in the bin of a thirty-second of a stop."""
    values = describe(write_exr(tmp_path / "even.exr", np.full((4, 8, 3), level, np.float32)), DEFAULT_READING).values
    assert values.darkest == values.brightest_luminance == pytest.approx(level, rel=2e-7)  # a sum of three in float32
    assert values.dynamic_range_stops == 0


def test_the_range_of_a_sun_in_a_sky_begins_at_the_sky() -> None:
    values = describe("sun-sky", DEFAULT_READING).values
    assert values.darkest == pytest.approx(1000, rel=1e-9)


def test_a_negative_peak_keeps_its_sign(tmp_path: Path, pixels: Pixels) -> None:
    pixels[5, 6, 2] = -2000
    found = describe(write_exr(tmp_path / "sky.exr", pixels), DEFAULT_READING)
    assert found.peak == -2000
    assert re.search(r"peak +-2000 at", as_text(found))


def test_no_angle_is_minus_zero(tmp_path: Path) -> None:
    path = tmp_path / "ahead.toml"
    lobe = '[[lobe]]\nprofile = "disc"\nradiance = 5e4\nhalf_angle_degrees = 0.3\naxis = [1, -1e-9, 0]\n'
    path.write_text(lobe + '[[lobe]]\nprofile = "constant"\nradiance = 1\n')
    text = str(path)
    said = as_text(describe(text, DEFAULT_READING))
    assert len(re.findall(r"phi 0\.00", said)) == 2  # of the peak and of the sun
    assert "-0.00" not in said


@pytest.mark.parametrize("light", list(built_in_lights()))
def test_the_text_is_aligned_and_fits_a_screen(light: str) -> None:
    found = describe(light, DEFAULT_READING)
    lines = as_text(found).splitlines()
    assert len(lines) <= 20
    assert all(len(line) <= 120 for line in lines if found.file not in line)
    assert all(re.match(r"  \S.{0,15}\S {1,16}\S", line) and line[19] == " " != line[20] for line in lines[1:])


def test_the_json_says_what_the_text_says(tmp_path: Path, pixels: Pixels) -> None:
    found = describe(write_exr(tmp_path / "sky.exr", pixels), DEFAULT_READING)
    said = json.loads(json.dumps(asdict(found), allow_nan=False))
    assert said["values"]["maximum"] == 900
    assert said["size"] == [64, 32]
    assert [need["tolerance"] for need in said["bands_needed"]] == [0.1, 0.05, 0.01]
    assert set(said) == set(asdict(found))


# --- coefficient files


def test_a_coefficient_file_is_described_with_its_convention_and_where_it_comes_from(tmp_path: Path) -> None:
    shviewer.project("green", 4, window="hann", method="jittered", samples=64).save(tmp_path / "g.csv", "ambix,y-up")
    found = describe(str(tmp_path / "g.csv"), Reading())
    assert found.coefficients is not None
    said = found.coefficients
    assert (said.bands, said.quantity, said.convention, said.stamped) == (4, "radiance", "ambix,y-up", True)
    assert said.axes == "x y z are our +x +z -y; y up, right-handed"
    text = as_text(found)
    for line in (
        "  coefficients      4 bands, 16 rows, radiance",
        "  convention        ambix,y-up (ambiX (ACN, SN3D)), as the file says",
        "no Condon-Shortley phase; index l(l+1) + m",
        "  to be typed       channels = rows[:, 0]  # ACN; red: a bus of its own for each colour",
        "  origin            green (two soft lobes (Green 2003)), jittered, samples 64, seed 0, window hann of 4 bands, ",
        "  figures there     relative L2 error ",
    ):
        assert line in text
    assert [need.radiance for need in found.bands_needed] == [4, 4, 4]
    assert json.loads(json.dumps(asdict(found)))["coefficients"]["stamp"]["light"] == "green"


def test_a_bare_list_is_described_as_what_it_was_said_to_be(tmp_path: Path) -> None:
    (tmp_path / "sh.txt").write_text("1 2 3  0 0 0  0.5 0.5 0.5  0 0 0")
    found = describe(str(tmp_path / "sh.txt"), Reading(convention="filament"))
    text = as_text(found)
    assert "as named on the command line; the file does not say" in text
    assert "  coefficients      2 bands, 4 rows, irradiance over pi" in text
    assert "origin" not in text
    assert describe("cosine", Reading()).coefficients is None
    (tmp_path / "probe.json").write_text(json.dumps({"type": "LightProbe", "sh": [1] * 27}))
    text = as_text(describe(str(tmp_path / "probe.json"), Reading()))
    assert "  convention        three (three.js, SphericalHarmonics3.fromArray), as this kind of file implies" in text
