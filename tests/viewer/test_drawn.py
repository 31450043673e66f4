"""How the reconstruction is drawn is decided once, for every band count, everywhere."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.special import eval_legendre

import shviewer
from shviewer.cli.main import main
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.drawn import DirectSum, Drawn, SplineMap, Surfaces
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.gl.surface_mesh import MAX_TRIANGLES, surface_mesh
from shviewer.viewer.picture import prepare
from shviewer.viewer.screenshot import render_linear
from shviewer.viewer.state import state_of
from shviewer.viewer.surface import basis_surface, rows_for

RADIUS = 222.0
"""Pixels, of a sphere of the 1280 x 640 picture."""


@pytest.mark.parametrize(
    ("options", "by_map", "drawn"),
    [
        ({"n_bands": 32}, False, DirectSum),
        ({"n_bands": 33}, False, SplineMap),
        ({"n_bands": 128}, False, SplineMap),
        ({"n_bands": 5}, True, SplineMap),
        ({"n_bands": 5, "evaluate": "map"}, False, SplineMap),
        ({"n_bands": 5, "lobe_view": True}, False, Surfaces),
        ({"n_bands": 5, "lobe_view": True}, True, Surfaces),
        ({"n_bands": 5, "lobe_view": True, "evaluate": "map"}, False, Surfaces),
        ({"n_bands": 33, "lobe_view": True}, False, Surfaces),
        ({"n_bands": 128, "lobe_view": True}, False, Surfaces),
    ],
)
def test_each_state_is_drawn_in_one_way(options: dict[str, object], by_map: bool, drawn: type[Drawn]) -> None:
    assert type(prepare(state_of(**options), by_map=by_map).drawn) is drawn


@pytest.mark.parametrize("n_bands", [33, 40, 128])
def test_surfaces_are_drawn_at_any_band_count_by_command_and_from_python(
    renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, n_bands: int
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(renderer))
    assert main(["screenshot", "s.png", "green", "--bands", str(n_bands), "--lobes", "--size", "320", "160"]) == 0
    with Image.open("s.png") as image:
        drawn, said = np.asarray(image), json.loads(image.info["shviewer"])
    assert (said["bands"], said["evaluated"]) == (n_bands, "surfaces")
    assert drawn[60:100, 160:].max() > 200  # a lit surface in the right half
    np.testing.assert_array_equal(shviewer.screenshot("green", n_bands, lobe_view=True, size=(320, 160)), drawn)


def test_a_sweep_of_surfaces_goes_past_what_the_shader_sums(
    renderer: Renderer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("shviewer.viewer.animation.animation.headless_renderer", lambda: nullcontext(renderer))
    assert main(["sweep", "s.webp", "green", "--from", "31", "--to", "34", "--lobes", "--size", "128", "64"]) == 0
    with Image.open("s.webp") as image:
        assert image.n_frames == 4


def test_surfaces_hold_no_radiance_that_could_be_drawn(renderer: Renderer) -> None:
    with pytest.raises(ValueError, match="no radiance"):
        render_linear(renderer, prepare(state_of(lobe_view=True)), compose(64, 64))


@pytest.mark.parametrize("degree", [8, 31, 32, 64, 127])
def test_a_zonal_function_of_any_degree_keeps_its_shape(degree: int) -> None:
    """Its lobes end within 1 % of the radius where they should: as drawn, between two rows of its grid."""
    surface = basis_surface(degree, 0, rows_for(degree + 1, RADIUS))
    theta = np.linspace(0, np.pi, 400_001)
    exact = np.abs(eval_legendre(degree, np.cos(theta)))
    tips = np.flatnonzero((exact[1:-1] >= exact[:-2]) & (exact[1:-1] > exact[2:])) + 1
    assert len(tips) == degree - 1
    rows = np.abs(surface.values[:, 0])
    step = np.pi / (len(rows) - 1)
    above = np.minimum((theta[tips] / step).astype(int), len(rows) - 2)
    share = theta[tips] / step - above
    drawn = rows[above] * (1 - share) + rows[above + 1] * share
    assert np.abs(drawn - exact[tips]).max() < 0.01
    assert rows[[0, -1]] == pytest.approx(1, abs=1e-6)  # float32


@pytest.mark.parametrize(("l", "m"), [(127, 0), (127, 127), (64, 32), (100, 7)])
def test_a_surface_has_as_many_triangles_as_its_shape_needs(l: int, m: int) -> None:
    """Where the limit binds, the tolerance of a quarter of a pixel is not kept."""
    surface = basis_surface(l, m, rows_for(l + 1, RADIUS))
    assert len(surface_mesh(surface.values, 0.25 / RADIUS).triangles) < MAX_TRIANGLES
