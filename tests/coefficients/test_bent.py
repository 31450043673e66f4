"""Lists of a light that was turned, windowed or seen in one colour are named as that, in any convention; strangers are not."""

from __future__ import annotations

import re

import numpy as np
import pytest
from coefficients.peer_cases import asymmetric
from numpy.testing import assert_allclose

from shviewer.analysis.comparing.recognised import recognise
from shviewer.analysis.comparing.suspecting import suspect
from shviewer.coefficients.diagnosis.bent import turned
from shviewer.coefficients.numbers import Listed
from shviewer.coefficients.texts import parse_convention
from shviewer.harmonics.basis import Array
from shviewer.harmonics.filters import per_coefficient, window
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.rotation import rotate, turn


def nothing_else() -> object:
    return iter(())


def told(numbers: Array, exact: Array, convention: str = "shviewer") -> tuple[str, str]:
    """What is wrong with the light, and the convention, of numbers that were written in one."""
    chosen = parse_convention(convention)
    written = chosen.from_ours(numbers, "radiance")
    found = suspect(Listed(np.asarray(written)), exact, chosen, nothing_else)
    assert found is not None
    assert found.error < 1e-6
    return ", ".join(found.of_light), found.text


@pytest.mark.parametrize("angle", [-151.0, -34.4, 17.0, 44.9, 80.0])
@pytest.mark.parametrize("convention", ["shviewer", "three", "unity", "filament", "shviewer,y-up,no-phase,irradiance"])
def test_a_turn_about_the_vertical_is_found_in_the_convention_that_was_named(angle: float, convention: str) -> None:
    exact = asymmetric(3)
    said, text = told(rotate(exact, turn(angle, 0)), exact, convention)
    assert said == f"the light is turned by {angle:.3g} degrees about the vertical, as by --rotate-light {angle:.4g} 0"
    assert text == convention


def test_turning_is_the_rotation_about_z() -> None:
    exact = asymmetric(7)
    assert_allclose(turned(exact, 73.0), rotate(exact, turn(73.0, 0)), atol=1e-12)


@pytest.mark.parametrize("name", ["hann:4", "lanczos:5", "gauss:4"])
@pytest.mark.parametrize("convention", ["shviewer", "e3nn", "shviewer,no-phase,irradiance"])
def test_a_window_is_named_with_its_width(name: str, convention: str) -> None:
    exact, (kind, width) = asymmetric(4), name.split(":")
    factors = window(kind, 4, float(width))
    said, text = told(exact * per_coefficient(factors), exact, convention)
    assert said.startswith("its bands are multiplied by 1, ")
    assert said.endswith(f"by the window {name}")
    assert text == convention


def test_bands_with_factors_of_their_own_are_told_by_these() -> None:
    exact = asymmetric(4)
    said, text = told(exact * per_coefficient(np.array([1, 2 / 3, 1.5, 0.25])), exact)
    assert (said, text) == ("its bands are multiplied by 1, 0.667, 1.5 and 0.25", "shviewer")


@pytest.mark.parametrize(
    ("weights", "said"),
    [(LUMINANCE, "luminance"), (np.ones(3) / 3, "mean channel"), (np.eye(3)[1], "green"), (np.eye(3)[2], "blue")],
)
@pytest.mark.parametrize("convention", ["shviewer", "sphericart", "scipy"])
def test_a_grey_list_of_a_coloured_light_is_of_one_channel(weights: Array, said: str, convention: str) -> None:
    exact = asymmetric(4)
    numbers = np.asarray(
        parse_convention(convention).from_ours(np.repeat(exact @ weights[:, None], 3, axis=1), "radiance")
    )
    found = recognise(Listed(numbers[:, 0]), exact)
    assert found.fits
    assert found.said.startswith(f"{convention} fits")
    assert found.said.endswith(f", if it is of the light's {said} alone")


@pytest.mark.parametrize("n_bands", [2, 3, 4, 6])
def test_strangers_are_no_turned_or_windowed_lights(n_bands: int) -> None:
    """None of 10 lists of random numbers is told to be of this light, whatever its angle or factors."""
    exact, random = asymmetric(n_bands), np.random.default_rng(n_bands)
    for _ in range(10):
        assert suspect(Listed(random.normal(size=exact.shape)), exact, None, nothing_else) is None


def test_a_turn_is_told_under_noise() -> None:
    exact = asymmetric(3)
    noise = np.random.default_rng(8).normal(size=exact.shape)
    noisy = rotate(exact, turn(30, 0)) + 0.03 * noise * np.linalg.norm(exact) / np.linalg.norm(noise)
    found = suspect(Listed(noisy), exact, parse_convention("shviewer"), nothing_else)
    assert found is not None
    angle = re.search(r"by ([\d.]+) degrees", found.of_light[0])
    assert angle is not None
    assert float(angle[1]) == pytest.approx(30, abs=3)


@pytest.mark.parametrize("bands", [(2,), (1,), (1, 2), (2, 3)])
@pytest.mark.parametrize("convention", ["shviewer", "e3nn"])
def test_bands_with_the_other_sign_are_told_as_bands(bands: tuple[int, ...], convention: str) -> None:
    """But for what half a turn or the light from opposite directions explains as well: the odd bands."""
    exact = asymmetric(4)
    said, text = told(exact * per_coefficient(np.where(np.isin(np.arange(4), bands), -1.0, 1.0)), exact, convention)
    assert (
        said
        == f"band{'s' * (len(bands) > 1)} {' and '.join(map(str, bands))} {'have' if len(bands) > 1 else 'has'} the other sign"
    )
    assert text == convention
