"""The stability table: every row within its bound, and the textbook's way outside of it.

All rows are measured once, in a process of their own: two OpenGL contexts in one thread would mix.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
import textbook
from helpers import unavailable
from places import hard_cases

from shviewer.benchmark.hard_cases import evaluation as ev
from shviewer.benchmark.hard_cases import exact, figures, identities, projecting, radiances, ringing, rotating, sampling
from shviewer.benchmark.hard_cases.outcome import Case, Outcome
from shviewer.benchmark.hard_cases.shader import renderer_or_reason
from shviewer.benchmark.hard_cases.table import CASES, as_json, as_markdown, as_text, from_json, measure
from shviewer.harmonics import basis

HARD_CASES = hard_cases()
RUN = """
import sys
from shviewer.benchmark.hard_cases.table import as_json, run
names = []
outcomes = run(progress=names.append)
assert names == [outcome.name for outcome in outcomes]
sys.stdout.write(as_json(outcomes))
"""


@pytest.fixture(scope="module")
def rows() -> dict[str, dict[str, object]]:
    done = subprocess.run([sys.executable, "-c", RUN], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return {row["name"]: row for row in json.loads(done.stdout)["cases"]}


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_hard_case_stays_within_its_bound(case: Case, rows: dict[str, dict[str, object]]) -> None:
    row = rows[case.name]
    assert row["passed"], row
    assert row["note"] == ""


@pytest.mark.parametrize("case", [case for case in CASES if case.views], ids=lambda case: case.name)
def test_the_shader_stays_within_a_millionth_of_the_peak_per_band(
    case: Case, rows: dict[str, dict[str, object]]
) -> None:
    row = rows[case.name]
    if row["shader_error"] is None:
        unavailable("no OpenGL without display")
    assert row["shader_bound"] == pytest.approx(32e-6)
    assert 0 < row["shader_error"] <= row["shader_bound"], "0 would mean that nothing was drawn"


def test_a_figure_that_is_nan_is_an_infinite_error(monkeypatch: pytest.MonkeyPatch) -> None:
    lost = SimpleNamespace(extremes=SimpleNamespace(negative_area=np.nan, negative_energy=np.nan))
    monkeypatch.setattr(figures, "shown_as", lambda *_: lost)
    assert figures.below_zero() == np.inf


def test_no_two_cases_share_a_name() -> None:
    assert len({case.name for case in CASES}) == len(CASES)


# --- what the textbook does in the same cases

FAILURES: dict[str, Callable[[], float]] = {
    "factorial overflow, degrees 86, 87, 150": lambda: ev.factorials(basis_of_degrees(86, 87, 150)),
    "double factorial, Y(m, +-m) to m = 512": lambda: ev.double_factorials(sectoral_basis),
    "growth at the pole, degree 1399": lambda: ev.pole_growth(textbook.normalisation),
    "near poles, 33 bands": lambda: ev.near_poles(33, textbook.evaluate_basis),
    "near poles, degree 1024": lambda: ev.near_poles(1025, textbook.plain_recurrence),
    "seam, both sides of it": lambda: ev.seam(lambda d, _: textbook.evaluate_basis(d, 33)),
    "directions from 5e-324 to 1e308": lambda: ev.any_length(textbook.evaluate_basis),
    "zero, NaN and infinite directions": lambda: ev.no_direction(textbook.evaluate_basis),
    "directions of length 1.001, 1 + 1e-7": lambda: identities.not_unit(textbook.plain_recurrence),
    "addition theorem to l = 128": lambda: identities.addition_theorem(90, textbook.evaluate_basis),
    "Gram matrix, 16 bands": lambda: identities.gram(16, textbook.midpoint_rule),
    "Gram matrix, 33 bands": lambda: identities.gram(33, textbook.midpoint_rule),
    "constant light, images from 1 x 1": lambda: projecting.constant_image(textbook.project_image),
    "odd aspect ratios": lambda: projecting.odd_sizes(textbook.project_image),
    "sun and sky, 512 x 1024": lambda: projecting.sun_and_sky(float32_sums),
    "dynamic range 1e-6 to 1e6": lambda: projecting.dynamic_range(float32_sums),
    "+-1e6 cancellation, image": lambda: projecting.cancellation(float32_sums),
    "tiny suns, 1e-6 to 0.265 degrees": lambda: projecting.suns((1e-6, 1e-4, 0.01, 0.265), textbook.disc_zonal),
    "huge suns, 179 to 179.9 degrees": lambda: projecting.suns((179.0, 179.735, 179.9), textbook.disc_zonal),
    "1e7 samples of a constant 0.1": lambda: projecting.many_samples(textbook.project_samples_float32),
    "+-1e6 cancellation, 1e7 samples": lambda: projecting.many_cancelling_samples(textbook.project_samples_float32),
    "jittered samples, 300 x 300 cells": lambda: sampling.stratified(sampling.uniform_random),
    "independent samples": lambda: sampling.independent(textbook.samples_at_equal_angles),
    "black light": lambda: radiances.black(textbook.relative_figures),
    "figures of radiance 1e-30 to 1e30": lambda: radiances.figures_at_any_radiance(
        lambda light: textbook.relative_figures(light, np.float32)
    ),
    "NaN and Inf texels": lambda: radiances.bad_texels(lambda path: None),
    "rotation at the gimbal, 33 bands": lambda: rotating.gimbal(
        lambda c, m: rotating.rotate(c, textbook.rebuilt_from_euler_angles(m))
    ),
    "1e4 composed 3 x 3 matrices": lambda: rotating.composed_matrices(textbook.multiply_float32),
    "deringing leaves nothing negative": lambda: ringing.deringed(lambda c: np.ones(basis.count_bands(c))),
    "irradiance factors to l = 1000": lambda: ringing.irradiance(textbook.irradiance_factors),
}


def basis_of_degrees(*wanted: int) -> ev.Evaluate:
    """Some of the textbook's functions among ours: all of 151 bands take it minutes."""

    def evaluate(directions: np.ndarray, n_bands: int) -> np.ndarray:
        values = np.array(basis.evaluate_basis(directions, n_bands))
        for l in wanted:
            for m in (0, 1, -2, 40, l - 1, l):
                values[:, basis.index(l, m)] = one_function(directions, l, m)
        return values

    return evaluate


def sectoral_basis(directions: np.ndarray, n_bands: int) -> np.ndarray:
    values = np.zeros((len(directions), n_bands**2))
    for m in (11, 18, 29, 150, 151, 152, 300, 512):
        values[:, basis.index(m, m)] = one_function(directions, m, m)
        values[:, basis.index(m, -m)] = one_function(directions, m, -m)
    return values


def one_function(directions: np.ndarray, l: int, m: int) -> np.ndarray:
    """The textbook's Y(l, m)."""
    x, y, z = directions.T
    with np.errstate(all="ignore"):
        k = np.sqrt((2 * l + 1) / (4 * np.pi) * textbook.factorial(l - abs(m)) / textbook.factorial(l + abs(m)))
        phi = np.arctan2(y, x)
        azimuth = np.sqrt(2) * (np.cos(m * phi) if m > 0 else np.sin(-m * phi)) if m else 1.0
        return k * textbook.legendre(l, abs(m), z / np.sqrt(x * x + y * y + z * z)) * azimuth


def float32_sums(image: np.ndarray, n_bands: int) -> np.ndarray:
    """Texels projected exactly, and what 32 rows at a time give added up in float32."""
    from shviewer.harmonics.projection.rows import project_image

    total = np.zeros((n_bands**2, 3), dtype=np.float32)
    for start in range(0, len(image), 32):
        rows = np.zeros_like(image, dtype=np.float64)
        rows[start : start + 32] = image[start : start + 32]
        total += project_image(rows, n_bands).astype(np.float32)
    return total.astype(np.float64)


@pytest.mark.parametrize("name", FAILURES)
def test_the_textbook_fails_the_same_bound(name: str) -> None:
    """Otherwise the case would not be hard."""
    (case,) = (case for case in CASES if case.name == name)
    with np.errstate(all="ignore"):
        assert not FAILURES[name]() <= case.bound


def test_the_textbook_is_right_where_nothing_is_hard() -> None:
    """It must fail for its method, not for a slip: nine bands, ordinary directions, and lights of moderate size."""
    directions = ev.generic(20)
    ours = basis.evaluate_basis(directions, 9)
    np.testing.assert_allclose(textbook.evaluate_basis(directions, 9), ours, rtol=0, atol=1e-13)
    np.testing.assert_allclose(textbook.plain_recurrence(directions, 9), ours, rtol=0, atol=1e-13)
    np.testing.assert_allclose(textbook.normalisation(9)[8], basis.normalisation(9)[8], rtol=1e-13)
    assert projecting.suns((20.0, 60.0), textbook.disc_zonal) < 1e-11
    np.testing.assert_allclose(textbook.irradiance_factors(12), ringing.irradiance_factors(12), rtol=0, atol=1e-14)
    image = np.ones((64, 128, 3))
    np.testing.assert_allclose(textbook.project_image(image, 3)[0], np.sqrt(4 * np.pi), rtol=1e-3)
    turn = rotating._about_z(1.0) @ rotating._about_y(0.7) @ rotating._about_z(-2.0)
    np.testing.assert_allclose(textbook.rebuilt_from_euler_angles(turn), turn, rtol=0, atol=1e-15)
    green = radiances.relative_figures(ringing.find_light("green"))
    np.testing.assert_allclose(textbook.relative_figures(ringing.find_light("green")), green[:6], rtol=1e-3)


# --- the references


def test_sixty_digit_harmonics_are_the_published_ones() -> None:
    """Every value of hard_cases.json (mpmath, 70 digits), to the 34 digits it has."""
    for entry in HARD_CASES["sh_values"]["values"]:
        direction = [float.fromhex(text) for text in entry["xyz_hex"]]
        l, m = entry["l"], entry["m"]
        ours = exact.harmonics(direction, m, l + 1)[-1]
        wanted = Decimal(entry["value"])
        assert abs(ours - wanted) <= Decimal("1e-32") * max(abs(wanted), Decimal("1e-30")), entry


def test_sixty_digit_suns_and_hemispheres_are_the_published_ones() -> None:
    light = HARD_CASES["lights"]["sun_disc_unit_radiance"]
    degrees = float(light["half_angle_deg"])
    radians = Decimal(light["half_angle_deg"]) * exact.PI / 180  # not the float64 nearest to it
    assert float(radians) == pytest.approx(np.radians(degrees), rel=1e-15)
    for l, (ours, text) in enumerate(zip(exact.disc(radians, 17), light["zonal"], strict=True)):
        # there: coefficients of a sun on +z, lambda(l) sqrt((2l+1)/4pi)
        scale = (Decimal(2 * l + 1) / (4 * exact.PI)).sqrt()
        assert float(ours * scale) == pytest.approx(float(text), rel=1e-15)
    for l, text in enumerate(HARD_CASES["lights"]["hemisphere"]["zonal"]):
        coefficient = ringing.hemisphere(17)[l * (l + 1), 0]
        assert coefficient == pytest.approx(float(text), abs=1e-15)


def test_exact_quaternions_turn_as_the_published_matrix_does() -> None:
    """quaternion (1, 2, 2, 4)/5 as w, x, y, z; a product with its inverse is no turn."""
    q = (Decimal(2), Decimal(2), Decimal(4), Decimal(1))
    matrix = np.array(exact.rotation_matrix(q), dtype=float) * 25
    np.testing.assert_allclose(matrix, HARD_CASES["rotation"]["R_times_25"], rtol=0, atol=1e-13)
    inverse = (-q[0], -q[1], -q[2], q[3])
    assert [float(part) for part in exact.product(inverse, q)] == pytest.approx([0, 0, 0, 1], abs=1e-50)
    other = (Decimal(1), Decimal(0), Decimal(-3), Decimal(2))
    both = np.array(exact.rotation_matrix(exact.product(other, q)), dtype=float)
    one_by_one = np.array(exact.rotation_matrix(other), dtype=float) @ np.array(exact.rotation_matrix(q), dtype=float)
    np.testing.assert_allclose(both, one_by_one, rtol=0, atol=1e-15)


def test_green_s_energy_is_the_published_one() -> None:
    published = HARD_CASES["lights"]["green"]["residual_energy_fraction_after_n_bands(index n-1)"]
    for n_bands, text in ringing.GREEN_LEFT_OUT.items():
        assert Fraction(text) == Fraction(published[n_bands - 1])


# --- running and writing


def test_an_exception_is_a_failed_row_that_names_it() -> None:
    def broken() -> float:
        raise RuntimeError("two\nlines")

    row = measure(Case("broken", "none", 1.0, broken), "not asked for")
    assert not row.passed
    assert row.note == "RuntimeError: two lines"
    assert "broken: RuntimeError: two lines" in as_text([row])
    assert json.loads(as_json([row]))["cases"][0]["error"] is None


def test_overflow_division_by_zero_and_nan_are_failures_too() -> None:
    for bad in (
        lambda: float(np.float64(1e300) * np.float64(1e300)),
        lambda: float(np.float64(0) / np.float64(0)),
        lambda: float("nan"),
    ):
        assert not measure(Case("bad", "", 1e300, bad), "").passed


GOOD = Outcome("case | one", "closed form", 1e-15, 2e-15, 1e-7, 1e-6, drawn_by="OpenGL 4.5, a driver")


def test_an_error_beyond_either_bound_fails_the_row() -> None:
    assert GOOD.passed
    assert not replace(GOOD, error=3e-15).passed
    assert not replace(GOOD, shader_error=2e-6).passed
    assert replace(GOOD, error=0.0, bound=0.0, shader_error=None, shader_bound=None).passed


def test_without_opengl_the_rows_stand_and_the_table_says_why() -> None:
    undrawn = replace(GOOD, shader_error=None, shader_bound=None, drawn_by="GraphicsError: no libEGL")
    assert undrawn.passed
    for text in (as_text([undrawn]), as_markdown([undrawn])):
        assert "No float32 column: GraphicsError: no libEGL" in text
    assert json.loads(as_json([undrawn]))["shader"] == "GraphicsError: no libEGL"
    with renderer_or_reason(False) as drawing:
        assert drawing == "not asked for"


def test_the_three_formats_say_the_same() -> None:
    failed = replace(GOOD, name="case two", error=float("inf"), note="ValueError: why")
    text, page, data = as_text([GOOD, failed]), as_markdown([GOOD, failed]), json.loads(as_json([GOOD, failed]))
    for words in (text, page):
        assert "1 of 2 cases are within their bounds." in words
        assert "case two: ValueError: why" in words
        assert "1.0e-15" in words
    assert "case \\| one" in page
    assert "Made with shviewer" in text
    assert from_json(data) == [GOOD, failed]
    assert {"shviewer", "Python", "numpy", "machine", "seed"} <= set(data["made_with"])
    assert [case["passed"] for case in data["cases"]] == [True, False]
    assert data["passed"] is False


def test_importing_the_table_loads_no_opengl() -> None:
    code = "import sys, shviewer.benchmark.hard_cases.table; assert 'moderngl' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
