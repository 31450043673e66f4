"""Tone curves: the published values, and an exposure that puts the same share of the light below white under each."""

from __future__ import annotations

import numpy as np
import pytest
from harmonics.independent import random_directions
from viewer.colour.curves import toned

from shviewer.viewer.colour.tone import exposed_for, steepest
from shviewer.viewer.derived import WHITE_LEVEL
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import state_of
from shviewer.viewer.view import TONES


def test_the_curves_are_the_published_ones() -> None:
    np.testing.assert_allclose(toned(np.array([0.0, 1.0, 3.0]), "reinhard"), [0, 0.5, 0.75])
    # K. Narkowicz's fit: 1 becomes 0.8038, and 0.18, the grey card, 0.2669
    np.testing.assert_allclose(toned(np.array([0.0, 0.18, 1.0]), "aces"), [0, 0.2669, 0.8038], atol=1e-4)
    np.testing.assert_allclose(toned(np.array([0.0, 1.0]), "log"), [0, 1])
    np.testing.assert_allclose(toned(np.array([0.0, 0.7, 9.0]), "none"), [0, 0.7, 9.0])


@pytest.mark.parametrize("tone", TONES)
def test_a_curve_rises_and_its_way_back_is_its_inverse(tone: str) -> None:
    exposed = np.geomspace(1e-6, 1e4, 400)
    assert (np.diff(toned(exposed, tone)) > 0).all()
    for level in (0.01, 0.5, 0.8, 0.99):
        assert toned(np.array(exposed_for(level, tone)), tone) == pytest.approx(level, rel=1e-12)


@pytest.mark.parametrize("tone", TONES)
def test_the_steepest_slope_of_a_curve_is_reached_and_never_passed(tone: str) -> None:
    exposed = np.append(0, np.geomspace(1e-9, 1e3, 200_001))
    slopes = np.diff(toned(exposed, tone)) / np.diff(exposed)
    assert slopes.max() == pytest.approx(steepest(tone), rel=1e-6)


def test_a_map_is_within_its_bound_under_the_steepest_curve() -> None:
    """The bound of a map's error holds in the picture only if no curve enlarges it further than `steepest` says."""
    exposed = np.random.default_rng(1).uniform(0, 1, 100_000)
    shift = 1e-3
    for tone in TONES:
        moved = np.abs(toned(exposed + shift, tone) - toned(exposed, tone)).max()
        assert moved <= shift * steepest(tone) * (1 + 1e-9)
        if tone not in ("log", "reinhard"):  # those two are steepest at 0 alone
            assert moved >= 0.99 * shift * steepest(tone)


@pytest.mark.parametrize("tone", TONES)
@pytest.mark.parametrize("light", ["green", "venice_sunset", "sun-sky"])
def test_automatic_exposure_shows_one_hundredth_of_the_sphere_above_the_level_under_every_curve(
    light: str, tone: str
) -> None:
    picture = prepare(state_of(light, tone=tone))
    directions = random_directions(40_000)
    brightest = picture.light.radiance(directions).max(axis=1).clip(min=0)
    shown = toned(2.0**picture.exposure_stops * brightest, tone)
    above, up_to = (
        (shown > WHITE_LEVEL * (1 + step)).mean() for step in (1e-6, -1e-6)
    )  # an even sky is all at the level
    assert above < 0.014
    assert up_to > 0.006
