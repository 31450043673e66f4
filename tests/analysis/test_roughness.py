"""Bands against roughness: the staircase is that of the convolved lights, and of what is published."""

from __future__ import annotations

import numpy as np
import pytest
from places import kernels

from shviewer.analysis.figures import errors_of, needs
from shviewer.analysis.projections import BEST
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.roughness import ROUGHNESS, Staircase, errors_by_roughness, staircase
from shviewer.analysis.subjects import load_light
from shviewer.harmonics.zonal import Disc
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight

REFERENCE = kernels()["A"]


@pytest.mark.parametrize("name", ["green", "studio", "venice_sunset"])
def test_errors_are_those_of_the_convolved_light(name: str) -> None:
    found = errors_by_roughness(load_light(Recipe(name)), BEST)
    for roughness in (0.25, 0.4, 0.83, 1.0):
        wanted = errors_of(load_light(Recipe(name, quantity=f"glossy:{roughness}")), BEST)
        row = found[ROUGHNESS.index(roughness)]
        assert (row >= wanted - 1e-7).all()  # of squares of 1e-14 that differ
        np.testing.assert_allclose(row, wanted, rtol=0, atol=5e-5)  # the bands beyond 128, at most f(128) of them


def test_a_count_is_never_too_small_where_bands_are_missing() -> None:
    found = errors_by_roughness(load_light(Recipe("sun-sky")), BEST)
    for roughness in (0.1, 0.15, 0.2):
        wanted = errors_of(load_light(Recipe("sun-sky", quantity=f"glossy:{roughness}")), BEST)
        assert (found[ROUGHNESS.index(roughness)] >= wanted - 1e-9).all()


def test_the_steps_of_samples_are_those_of_their_own_error() -> None:
    recipe = Recipe("green", method="jittered", samples=900, tolerance=0.2)
    steps = staircase(recipe)
    assert steps.searched == 32
    for roughness in (0.3, 0.7):
        assert (
            steps.counts[ROUGHNESS.index(roughness)]
            == needs(
                Recipe("green", method="jittered", samples=900, tolerance=0.2, quantity=f"glossy:{roughness}")
            ).shown
        )


def test_a_point_light_is_served_by_the_published_ranges_also_where_they_end() -> None:
    """3 bands never reach 5 %, and 4 do so from 0.76 to 0.88 alone: more roughness needs more bands there."""
    point = LobeLight((Lobe(Disc(1e-4), np.array([0.0, 0.0, 1.0]), np.ones(3)),))
    steps = staircase(Recipe(point))
    assert steps.served(3) == []
    assert steps.served(4) == [(0.76, 0.88)]
    lowest = REFERENCE["delta_lowest_roughness_at_5pct"]
    for bands in (5, 9, 16, 32):
        ((low, high),) = steps.served(bands)
        assert (low, high) == (np.ceil(100 * lowest[str(bands)]) / 100, 1.0)
    assert steps.words(4) == "roughness 0.76 to 0.88"
    assert steps.sentence(9) == "for 5 %: 5 bands serve shading, 9 serve roughness 0.52 and rougher"


@pytest.mark.parametrize("name", ["mud_road_puresky", "st_fagans_interior"])
def test_maps_are_served_from_the_published_roughness_on(name: str) -> None:
    steps = staircase(Recipe(name))
    for bands, lowest in REFERENCE["maps"][name]["lowest_roughness_at_5pct"].items():
        if lowest >= 0.1:
            assert steps.served(int(bands))[0][0] == pytest.approx(float(lowest), abs=0.0101)


def test_words_for_all_that_bands_can_serve() -> None:
    def steps(*counts: int | None, mirror: int | None = None, shading: int | None = 3) -> Staircase:
        return Staircase(0.05, counts + (1,) * (len(ROUGHNESS) - len(counts)), mirror, shading, 128)

    assert steps(9, 9, mirror=12).words(12) == "a mirror"
    assert steps(9, 9).words(9) == "every roughness from 0.1"
    assert steps(9, 3, 9).words(4) == "roughness 0.11 and 0.13 and rougher"
    assert Staircase(0.05, (None,) * len(ROUGHNESS), None, None, 32).sentence(1) == (
        "for 5 %: no count up to 32 serves shading, 1 serves no roughness"
    )
    assert steps(2, shading=1).sentence(1) == "for 5 %: 1 band serves shading, 1 serves roughness 0.11 and rougher"
