"""Radiance above what float32 can show is refused where a light is made, whatever makes it, and by value."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import shviewer
from shviewer.errors import LightError
from shviewer.harmonics.zonal import Constant, Disc
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.reading import Reading

UP = np.array([0.0, 0.0, 1.0])


def scene(folder: Path, radiance: float) -> object:
    (folder / "scene.toml").write_text(f'[[lobe]]\nprofile = "constant"\nradiance = {radiance!r}\n')
    return find_light(str(folder / "scene.toml"))


def coefficient_file(folder: Path, radiance: float) -> object:
    (folder / "sh.csv").write_text(f"{float(radiance * np.sqrt(4 * np.pi))!r},0,0\n")
    return find_light(str(folder / "sh.csv"), Reading(convention="shviewer"))


def evaluated(function: Callable[[np.ndarray], np.ndarray]) -> object:
    return FunctionLight(function).radiance(UP[None])


MAKERS: dict[str, Callable[[Path, float], object]] = {
    "lobes": lambda folder, radiance: LobeLight((Lobe(Disc(0.1), UP, radiance * np.array([1.0, 0.0, 0.0])),)),
    "lobes that add up": lambda folder, radiance: LobeLight(
        tuple(Lobe(Constant(), UP, np.full(3, radiance / 2)) for _ in range(2))
    ),
    "an image": lambda folder, radiance: EnvironmentLight(np.full((4, 8, 3), radiance, np.float32)),
    "a negative image": lambda folder, radiance: EnvironmentLight(np.full((4, 8, 3), -radiance, np.float32)),
    "coefficients": lambda folder, radiance: CoefficientLight(np.full((1, 3), radiance * np.sqrt(4 * np.pi))),
    "a function": lambda folder, radiance: evaluated(lambda d: np.full(len(d), radiance)),
    "a negative function": lambda folder, radiance: evaluated(lambda d: np.full(len(d), -radiance)),
    "a scene": scene,
    "a coefficient file": coefficient_file,
    "an array of texels": lambda folder, radiance: shviewer.find_light(np.full((4, 8, 3), radiance)),
    "an array of coefficients": lambda folder, radiance: shviewer.find_light(np.full((4, 3), radiance * 4)),
}


@pytest.mark.parametrize("maker", MAKERS)
def test_radiance_above_1e30_is_refused_by_value_where_the_light_is_made(tmp_path: Path, maker: str) -> None:
    MAKERS[maker](tmp_path, 0.4e30)
    with pytest.raises(LightError, match=r"\be\+?3[1-9]\b|\de\+3[1-9]"):
        MAKERS[maker](tmp_path, 4e31)


def test_what_is_too_bright_says_what_can_be_shown() -> None:
    with pytest.raises(LightError) as caught:
        MAKERS["lobes"](Path(), 4e31)
    assert str(caught.value) == "lobes: its largest radiance is 4e+31; float32 shows 1e-30 to 1e+30: scale the light"


def test_an_image_of_exactly_the_limit_is_no_brighter_for_its_rounding() -> None:
    EnvironmentLight(np.full((4, 8, 3), 1e30, np.float32))


def test_coefficients_whose_squares_leave_float64_are_refused_by_value() -> None:
    with pytest.raises(LightError, match=r"its largest radiance is 5\.64e\+199"):
        CoefficientLight(np.full((4, 3), 1e200))
