"""From a state to arrays and figures: what they are, and what is not computed twice."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from helpers import picture_of

from shviewer.errors import LightError, UsageError
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import Constant, Disc, Gaussian
from shviewer.lights.analytic.lobes import Lobe, LobeLight
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.drawn import DirectSum, SplineMap
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import prepare
from shviewer.viewer.screenshot import render_rgb
from shviewer.viewer.splines import MAP_COLUMNS, map_size
from shviewer.viewer.state import state_of


def sphere_rule(rows: int = 400) -> tuple[Array, Array]:
    """Gauss-Legendre directions (k, 3) and weights, independent of shviewer."""
    z, weights = np.polynomial.legendre.leggauss(rows)
    phi = 2 * np.pi * (np.arange(2 * rows) + 0.5) / (2 * rows)
    z, phi = (part.ravel() for part in np.meshgrid(z, phi, indexing="ij"))
    ring = np.sqrt(1 - z * z)
    directions = np.stack([ring * np.cos(phi), ring * np.sin(phi), z], axis=1)
    return directions, np.repeat(weights * np.pi / rows, 2 * rows)


# --- what is not computed twice


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> tuple[LobeLight, list[int]]:
    """A light that has not been seen before, and the numbers of bands for which it is projected."""
    light = find_light("studio")
    assert isinstance(light, LobeLight)
    fresh = replace(light, name="fresh")
    calls: list[int] = []
    project = LobeLight.coefficients

    def coefficients(self: LobeLight, n_bands: int) -> Array:
        if self is fresh:
            calls.append(n_bands)
        return project(self, n_bands)

    monkeypatch.setattr(LobeLight, "coefficients", coefficients)
    return fresh, calls


def test_a_band_key_projects_nothing_again(counted: tuple[LobeLight, list[int]]) -> None:
    light, calls = counted
    for n_bands in (5, 6, 1, 32, 16):
        picture_of(light, n_bands=n_bands, muted=frozenset({1}))
    assert sorted(calls) == [
        2,
        32,
        128,
    ]  # the camera, the picture, and the band counts that radiance and irradiance need
    picture_of(light, n_bands=33)
    picture_of(light, n_bands=40)
    assert sorted(calls) == [2, 32, 128]


def test_neither_exposure_nor_camera_nor_light_rotation_projects_again(counted: tuple[LobeLight, list[int]]) -> None:
    light, calls = counted
    for change in ({}, {"exposure_stops": 2.0}, {"camera": (1.0, 2.0)}, {"light_rotation": (0.0, 0.0, 1.0, 0.0)}):
        picture_of(light, **change)
    assert sorted(calls) == [2, 32, 128]


def test_a_band_key_compiles_no_shader_and_reads_no_light_again(
    renderer: Renderer, monkeypatch: pytest.MonkeyPatch
) -> None:
    frame = compose(128, 64)
    for n_bands in (5, 33):
        render_rgb(renderer, picture_of("studio", n_bands=n_bands), frame)

    def forbidden(*arguments: object, **named: object) -> None:
        raise AssertionError("compiled or read again")

    monkeypatch.setattr("shviewer.viewer.gl.programs._compile", forbidden)
    monkeypatch.setattr("shviewer.analysis.subjects.find_light", forbidden)
    for n_bands in (6, 40, 1):
        render_rgb(renderer, picture_of("studio", n_bands=n_bands), frame)


# --- figures


def test_the_error_of_greens_light_in_four_bands_is_the_known_one() -> None:
    """0.511715 by quadrature in the project's notes, and by quadrature here; creases cost it 1e-4."""
    figures = picture_of(n_bands=4).figures
    assert figures.relative_l2 == pytest.approx(0.511715, abs=5e-7)
    directions, weights = sphere_rule()
    x, y, z = directions.T
    light = np.maximum(0, 5 * z - 4) + np.maximum(0, 4 * (x * np.cos(2.5) + y * np.sin(2.5)) - 3)
    basis = evaluate_basis(directions, 4)
    error = light - basis @ (basis.T @ (weights * light))
    assert figures.relative_l2 == pytest.approx(np.sqrt(weights @ error**2 / (weights @ light**2)), abs=1e-4)


@pytest.mark.parametrize("light", ["green", "studio"])
@pytest.mark.parametrize("muted", [frozenset(), frozenset({0, 2})])
def test_every_figure_is_what_quadrature_finds(light: str, muted: frozenset[int]) -> None:
    shown = picture_of(light, n_bands=6, muted=muted)
    directions, weights = sphere_rule(256)
    original = shown.light.radiance(directions)
    reconstruction = evaluate_basis(directions, 6) @ shown.coefficients
    figures, norm = shown.figures, weights @ (original**2).sum(axis=1)
    error = original - reconstruction
    assert figures.relative_l2 == pytest.approx(np.sqrt(weights @ (error**2).sum(axis=1) / norm), abs=2e-4)
    # The extremes of a grid of half a degree miss the function's by less than a thousandth of the peak.
    peak = np.abs(original).max()
    assert figures.extremes.peak == pytest.approx(peak, rel=0.02)
    assert figures.extremes.max_error == pytest.approx(np.abs(error).max(), abs=5e-3 * peak)
    assert figures.extremes.minimum == pytest.approx(reconstruction.min(), abs=1e-3 * peak)
    luminance = reconstruction @ [0.2126, 0.7152, 0.0722]
    assert figures.extremes.negative_area == pytest.approx(weights @ (luminance < 0) / (4 * np.pi), abs=0.01)
    bands = np.repeat(np.arange(6), 2 * np.arange(6) + 1)
    exact = shown.light.coefficients(6)
    shares = [float((exact[bands == l] ** 2).sum() / norm) for l in range(6)]
    np.testing.assert_allclose(figures.energy_share[:6], shares, rtol=0, atol=2e-4)


def test_muted_bands_are_left_out_and_their_energy_is_the_error_added() -> None:
    full, without = picture_of(n_bands=6), picture_of(n_bands=6, muted=frozenset({2, 9}))
    bands = np.repeat(np.arange(6), 2 * np.arange(6) + 1)
    assert not without.coefficients[bands == 2].any()
    np.testing.assert_array_equal(without.coefficients[bands != 2], full.coefficients[bands != 2])
    assert full.figures.channels["all"].added == 0
    assert without.figures.channels["all"].added ** 2 == pytest.approx(full.figures.energy_share[2], rel=1e-9)
    assert without.figures.channels["all"].left_out == full.figures.channels["all"].left_out
    squares = without.figures.channels["all"].left_out ** 2 + without.figures.channels["all"].added ** 2
    assert without.figures.relative_l2**2 == pytest.approx(squares, rel=1e-12)


def test_more_bands_never_make_the_exact_projection_worse() -> None:
    errors = [picture_of("venice_sunset", n_bands=n).figures.relative_l2 for n in range(1, 33)]
    assert all(after <= before for before, after in itertools.pairwise(errors))
    assert errors[-1] < errors[0]


# --- methods


def test_the_three_methods_agree_within_what_they_promise() -> None:
    best = picture_of(n_bands=8)
    product = picture_of(n_bands=8, method="gauss-legendre", samples=100_000)
    jittered = picture_of(n_bands=8, method="jittered", samples=100_000)
    assert best.projection.method == "closed form"
    assert best.projection.evaluations is None
    assert product.projection.evaluations == 2 * 223**2  # rows = floor(sqrt(100000 / 2))
    assert jittered.projection.evaluations == 316**2
    scale = np.abs(best.coefficients).max()
    np.testing.assert_allclose(product.coefficients, best.coefficients, rtol=0, atol=1e-3 * scale)
    np.testing.assert_allclose(jittered.coefficients, best.coefficients, rtol=0, atol=2e-2 * scale)
    assert 0 < product.figures.channels["all"].added < jittered.figures.channels["all"].added
    assert best.figures.channels["all"].added == 0


def test_samples_and_seed_change_the_sampled_methods_alone() -> None:
    def coefficients(**changes: object) -> bytes:
        return picture_of(n_bands=4, **changes).coefficients.tobytes()

    assert coefficients(seed=1) == coefficients(samples=77)
    assert coefficients(method="jittered", seed=1) != coefficients(method="jittered", seed=2)
    assert coefficients(method="jittered", seed=1) == coefficients(method="jittered", seed=1)
    assert coefficients(method="jittered", samples=100) != coefficients(method="jittered", samples=400)


# --- what is drawn how


def test_a_map_takes_over_above_32_bands() -> None:
    assert isinstance(picture_of(n_bands=32).drawn, DirectSum)
    above = picture_of(n_bands=33, muted=frozenset({1}))
    assert isinstance(above.drawn, SplineMap)
    splines = above.drawn.splines
    height, width, components = splines.shape
    assert components == 4
    rng = np.random.default_rng(0)
    rows, columns = rng.integers(1, height - 1, 50), rng.integers(0, width, 50)
    # at its node a quadratic B-spline is 3/4, at the nodes beside it 1/8
    value = sum(
        across * along * splines[rows + i, (columns + j) % width, :3].astype(np.float64)
        for i, across in ((-1, 0.125), (0, 0.75), (1, 0.125))
        for j, along in ((-1, 0.125), (0, 0.75), (1, 0.125))
    )
    theta, phi = np.pi * rows / (height - 1), np.pi * (1 - (2 * columns + 1) / width)
    directions = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    wanted = evaluate_basis(directions, 33) @ above.coefficients
    np.testing.assert_allclose(value, wanted, rtol=0, atol=3e-7 * np.abs(wanted).max())


def test_a_map_is_as_fine_as_the_bands_and_the_contrast_need() -> None:
    assert [map_size(n, 1.0)[1] for n in (1, 9, 32, 40, 64, 128)] == [512, 512, 512, 1024, 1024, 2048]
    assert [map_size(16, peak)[1] for peak in (1.0, 10.0, 100.0, 1e6)] == [512, 512, 1024, 2048]
    for n_bands in (2, 17, 32):
        for peak in (0.1, 3.0, 40.0):
            rows, columns = map_size(n_bands, peak)
            assert rows == columns // 2 + 1
            wave = 2 * np.pi * (n_bands - 1) / columns
            assert 0.012 * wave**3 * peak < 0.5 / 255 or columns == MAP_COLUMNS[-1]


@pytest.mark.parametrize("change", [{"exposure_offset": 12.0}, {"tone": "log"}, {"error": "signed"}])
def test_what_shows_finer_differences_takes_a_finer_map(change: dict[str, object]) -> None:
    plain = picture_of(n_bands=32, evaluate="map").drawn.splines
    finer = picture_of(n_bands=32, evaluate="map", **change).drawn.splines
    assert plain is not None
    assert finer is not None
    assert finer.shape[1] > plain.shape[1]


def test_a_map_is_drawn_where_it_is_asked_for_and_refused_nowhere_but_directly_above_32_bands() -> None:
    assert isinstance(picture_of(evaluate="map").drawn, SplineMap)
    assert isinstance(picture_of(evaluate="direct", n_bands=32).drawn, DirectSum)
    assert isinstance(prepare(state_of(), by_map=True).drawn, SplineMap)
    with pytest.raises(UsageError, match="33 bands: at most 32 are summed directly"):
        picture_of(evaluate="direct", n_bands=33)


def test_lobes_are_drawn_from_formulas_and_everything_else_from_a_map() -> None:
    lobes, image = picture_of("studio"), picture_of("venice_sunset")
    function = picture_of(FunctionLight(lambda d: d[:, 2]))
    assert len(lobes.original.lobes) == 4
    assert lobes.original.map is None
    for other in (image, function):
        assert other.original.lobes == ()
        assert other.original.map is not None


# --- exposure


@pytest.mark.parametrize("light", ["green", "studio", "venice_sunset", "sun-sky", "constant", "hemisphere"])
def test_automatic_exposure_leaves_one_hundredth_above_four_fifths_of_white(light: str) -> None:
    shown = picture_of(light)
    directions, weights = sphere_rule(300)
    brightest = shown.light.radiance(directions).max(axis=1) * 2**shown.exposure_stops
    assert weights[brightest > 0.8 * 1.03].sum() / (4 * np.pi) <= 0.0105  # 3 %: the grids are not the same
    assert weights[brightest >= 0.8 / 1.03].sum() / (4 * np.pi) >= 0.0095


@pytest.mark.parametrize("sharpness", [1e3, 1e4, 1e5, 1e8])
def test_the_reconstruction_of_a_light_that_is_one_point_is_neither_black_nor_beyond_white(sharpness: float) -> None:
    """The percentile of exp(-s (1 - cos)) is exp(-0.02 s) of the peak, 2^-289 for 1e4; n bands have n^2 times the mean."""
    lobe = Lobe(Gaussian(sharpness), np.array([1.0, 0.0, 0.0]), np.full(3, 3.0))
    shown = picture_of(LobeLight((lobe,), "point"))
    coefficients = shown.projection.coefficients[: shown.state.recipe.n_bands**2]
    brightest = float(Synthesis(coefficients).in_directions(np.array([[1.0, 0.0, 0.0]])).max())
    assert 0.1 < brightest * 2**shown.exposure_stops < 1
    assert shown.exposure_stops > np.log2(0.8 / 3) - 0.01  # and never darker than its peak needs


def test_a_sun_ten_million_times_as_bright_leaves_the_exposure_to_its_sky() -> None:
    sun = Lobe(Disc(np.radians(0.265)), np.array([0.0, 0.0, 1.0]), np.full(3, 1e7))
    sky = Lobe(Constant(), np.array([0.0, 0.0, 1.0]), np.ones(3))
    assert picture_of(LobeLight((sun, sky), "day")).exposure_stops == pytest.approx(np.log2(0.8), abs=0.01)


def test_a_fixed_exposure_is_kept_and_offsets_are_added() -> None:
    assert picture_of(exposure_stops=1.5).exposure_stops == 1.5
    assert picture_of(exposure_stops=1.5, exposure_offset=-0.5).exposure_stops == 1.0
    assert picture_of(exposure_offset=2.0).exposure_stops == picture_of().exposure_stops + 2


def test_a_black_or_negative_light_has_an_exposure_all_the_same() -> None:
    assert picture_of(FunctionLight(lambda d: 0 * d[:, 0])).exposure_stops == 0
    negative = picture_of(FunctionLight(lambda d: 0 * d[:, 0] - 4.0))
    assert negative.exposure_stops == pytest.approx(np.log2(0.8 / 4))


# --- what is refused


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"n_bands": 0}, "0 bands: the viewer shows 1 to 128"),
        ({"n_bands": 129}, "129 bands: the viewer shows 1 to 128"),
        ({"muted": frozenset({-1})}, "muted band -1: bands are counted from 0 to 127"),
        ({"muted": frozenset({128})}, "muted band 128"),
        ({"method": "magic"}, "method 'magic': it must be one of best, jittered, gauss-legendre"),
        ({"samples": 0}, "0 samples: there must be 1 to 16000000"),
        ({"samples": 16_000_001}, "16000001 samples"),
        ({"seed": -1}, "seed -1: it must not be negative"),
        ({"exposure_stops": 65.0}, "exposure 65: it must be -64 to 64 stops"),
        ({"zoom": 0.2}, "zoom 0.2: it must be 0.25 to 16"),
        ({"zoom": 17.0}, "zoom 17"),
    ],
)
def test_a_state_out_of_range_is_refused_with_value_and_rule(change: dict[str, object], words: str) -> None:
    with pytest.raises(UsageError) as caught:
        picture_of(**change)
    assert words in str(caught.value)


@pytest.mark.parametrize("size", [(63, 640), (640, 63), (8193, 640), (640, 8193), (-1, 5)])
def test_a_size_out_of_range_is_refused(size: tuple[int, int]) -> None:
    state_of().check((64, 8192))
    with pytest.raises(UsageError, match=rf"size {size[0]} x {size[1]}: each side must be 64 to 8192 pixels"):
        state_of().check(size)


def test_a_light_that_cannot_be_read_is_refused_every_time() -> None:
    for _ in range(2):
        with pytest.raises(LightError, match="unknown light 'gren': did you mean green"):
            picture_of("gren")
