"""An image is projected once, to the most bands that will be asked for."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from lights.images.hdr_files import exr_file

from shviewer.analysis.cache import MEMORY, array_bytes
from shviewer.analysis.figures import PENDING, Sums
from shviewer.analysis.information import describe
from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.cli.below_zero import below_zero
from shviewer.coefficients.texts import parse_convention
from shviewer.errors import LightError
from shviewer.harmonics.extremes.error_grid import ErrorGrid
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import state_of


@pytest.fixture
def sunny(tmp_path: Path) -> str:
    pixels = np.ones((128, 256), np.float16)
    pixels[40:42, 70:72] = 20000
    path = tmp_path / "sunny.exr"
    path.write_bytes(exr_file(dict.fromkeys("RGB", pixels)))
    MEMORY.clear()
    return str(path)


@pytest.mark.parametrize("work", ["project", "picture", "info"])
def test_an_image_is_projected_once(sunny: str, work: str, monkeypatch: pytest.MonkeyPatch) -> None:
    asked, real = [], LatLongLayout.project

    def counted(self: LatLongLayout, pixels: np.ndarray, n_bands: int) -> np.ndarray:
        asked.append(n_bands)
        return real(self, pixels, n_bands)

    monkeypatch.setattr(LatLongLayout, "project", counted)
    if work == "project":
        assert project_recipe(Recipe(sunny)).figures.irradiance_relative_l2 > 0
    elif work == "picture":
        assert prepare(state_of(sunny)).complete
    else:
        assert describe(sunny, DEFAULT_READING).bands_needed_without_suns
    assert asked == [128]


def test_what_is_told_of_an_image_in_another_layout_takes_one_projection_and_no_raster(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pixels = np.ones((200, 200), np.float16)
    pixels[60:62, 110:112] = 20000
    path = tmp_path / "probe.exr"
    path.write_bytes(exr_file(dict.fromkeys("RGB", pixels)))
    reading, asked, real = Reading(layout="mirror-ball"), [], MirrorBallLayout.project
    recipe, convention = Recipe(str(path), reading), parse_convention("shviewer")

    def told() -> tuple[object, str, Sums]:
        MEMORY.clear()
        return describe(str(path), reading), below_zero(recipe, convention), project_recipe(recipe).sums

    def counted(self: MirrorBallLayout, pixels: np.ndarray, n_bands: int) -> np.ndarray:
        asked.append(n_bands)
        return real(self, pixels, n_bands)

    with monkeypatch.context() as patch:
        patch.setattr(MirrorBallLayout, "project", counted)
        patch.setattr(MirrorBallLayout, "raster", None)
        patch.setattr("shviewer.lights.environment.FEW_DIRECTIONS", 0)  # the image is small
        found = told()
    assert asked == [128]
    monkeypatch.setattr("shviewer.lights.environment.FEW_DIRECTIONS", np.inf)  # a raster for every direction
    assert "--split-sun" in found[1]
    assert told() == found


def test_a_picture_without_text_searches_for_no_figure_and_looks_the_same(sunny: str) -> None:
    bare = prepare(state_of(sunny), written=False)
    light = bare.light
    assert (light.kept_bands, bare.extremes, bare.needs) == (32, PENDING, PENDING)
    seen = state_of(sunny, error="relative")
    bare, whole = prepare(seen, written=False), prepare(seen)
    assert not bare.complete
    assert bare.error_scale is whole.error_scale
    assert bare.coefficients is whole.coefficients


def test_a_projection_searches_for_the_error_only_when_asked_and_holds_no_image(
    sunny: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, real = [], ErrorGrid.compare
    monkeypatch.setattr(ErrorGrid, "compare", lambda self, shown: asked.append(1) or real(self, shown))
    found = project_recipe(Recipe(sunny))
    data = found.encode(parse_convention("shviewer"), "json")
    assert b"minimum" in data
    assert not asked
    assert array_bytes(vars(found)) < 10_000
    extremes = found.figures.extremes
    assert (found.lows.minimum, found.lows.negative_area) == (extremes.minimum, extremes.negative_area)
    assert found.figures.extremes is extremes
    assert len(asked) == 1
    sent = pickle.loads(pickle.dumps(project_recipe(Recipe(sunny))))
    assert sent.figures == found.figures


def test_figures_of_a_file_that_has_changed_are_refused(sunny: str) -> None:
    found = project_recipe(Recipe(sunny))
    Path(sunny).write_bytes(exr_file(dict.fromkeys("RGB", np.ones((8, 16), np.float16))))
    MEMORY.clear()
    with pytest.raises(LightError, match="sunny has changed since it was projected: project it again"):
        _ = found.figures
