"""What --split-sun and U promise: the sun drawn as a disc of its own, and every figure that of the rest."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from viewer.overlay.written import texts_of

from shviewer.analysis.figures import needs
from shviewer.analysis.information import describe
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import subject
from shviewer.cli.info import as_text
from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.reading import DEFAULT_READING
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.control.keys import press
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.message import WARNING, kind_of
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import prepare
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.state import state_of


def noon():
    """A smooth sky, and a sun of a few texels that holds most of its energy."""
    height, width = 128, 256
    theta = np.pi * (np.arange(height)[:, None] + 0.5) / height
    pixels = np.repeat((1 + np.cos(theta) ** 2)[..., None] * [0.3, 0.5, 1.0], width, axis=1)
    pixels[30:32, 60:62] = [3e4, 2.8e4, 2.4e4]
    return EnvironmentLight(pixels.astype(np.float32), name="noon")


def state(light, **changes):
    return state_of(light, split_sun=True, **changes)


def test_u_splits_and_joins_again():
    first = press(state_of(), "U")
    assert first.recipe.split_sun
    assert not press(first, "U").recipe.split_sun


def test_a_noon_sky_becomes_a_few_bands_and_a_sun():
    light = noon()
    before, after = needs(Recipe(light)), needs(state(light).recipe)
    assert before.radiance is None
    assert after.radiance is not None
    assert after.radiance <= 9


def test_the_figures_are_those_of_the_rest():
    light = noon()
    picture = prepare(state(light, n_bands=4))
    rest = light.split_suns().rest
    coefficients = rest.coefficients(4)
    expected = errors_by_band_count(rest.products(), coefficients, coefficients)[-1]
    assert_allclose(picture.figures.relative_l2, expected, rtol=1e-9)  # a difference of norms
    assert picture.needs_unsplit == needs(Recipe(light))


def test_the_original_is_the_very_map_of_the_whole():
    light = noon()
    unsplit, split = prepare(state_of(light)), prepare(state(light))
    assert split.original.map is unsplit.original.map
    assert split.exposure_stops == unsplit.exposure_stops
    assert split.subject.whole is light


# the lobe of the irradiance is that of a point in the middle of the disc: cos(a/2)^2 of it, and a is half a degree
@pytest.mark.parametrize(("quantity", "tolerance"), [("radiance", 1e-6), ("irradiance", 3e-4), ("glossy:0.3", 3e-4)])
def test_rest_and_sun_add_up_to_the_whole(quantity, tolerance):
    picture = prepare(state(noon(), n_bands=6, quantity=quantity))
    assert len(picture.suns) == (19 if quantity.startswith("glossy") else 1)
    zonal = sum(sun.profile.zonal(1)[0] * np.sqrt(1 / (4 * np.pi)) * sun.radiance for sun in picture.suns)
    whole = picture.subject.whole.coefficients(1)[0]
    assert_allclose(picture.coefficients[0] + zonal, whole, rtol=tolerance)


def test_a_light_without_a_sun_is_shown_whole_with_the_reason():
    picture = prepare(state_of("green", split_sun=True))
    assert picture.suns == ()
    assert picture.light is prepare(state_of("green")).light
    assert "green has no sun" in picture.subject.refusal
    drawn = draw_overlay(picture, compose(1280, 640))
    assert any("no sun" in text.text for text in texts_of(drawn))
    assert "message" not in drawn.boxes


def test_the_window_says_the_reason_without_the_rule_once_for_each_light():
    """It stood in the foot until U was pressed again, and of a small window hid the figures."""
    session = Session(state_of("green", lights=("green", "constant")))
    said = []
    for key in ("U", "Up", "Right", "U"):
        session.press(key)
        session.prepare()
        said.append(session.state.view.message)
    assert said[0].startswith("green has no sun: ")
    assert ";" not in said[0]
    assert said[1] == ""
    assert said[2].startswith("constant has no sun: ")
    assert said[3] == ""
    assert kind_of(said[0]) == WARNING
    started = Session(state_of("green", split_sun=True))
    assert started.state.view.message == said[0]


def test_the_text_of_a_picture_describes_the_sun():
    picture = prepare(state("sun-sky", n_bands=3))
    about = json.loads(metadata(picture, compose(640, 320), "none"))
    (sun,) = about["suns"]
    assert about["split_sun"] is True
    assert_allclose(sun["half_angle_degrees"], 0.265, rtol=1e-12)
    assert_allclose(sun["radiance"], 1.599999e9, rtol=1e-12)
    assert about["figures"]["bands_needed"]["radiance"] == 1
    assert about["figures"]["bands_needed_unsplit"]["radiance"] is None


def test_info_names_the_sun_and_what_the_rest_needs():
    found = describe("sun-sky", DEFAULT_READING)
    assert [need.radiance for need in found.bands_needed_without_suns] == [1, 1, 1]
    assert_allclose(found.suns[0].theta_phi_degrees, [52, 107], atol=1e-9)
    assert "0.53 deg wide" in as_text(found)
    assert describe("green", DEFAULT_READING).suns == ()


def test_the_irradiance_of_a_split_light_is_that_of_the_rest():
    light = noon()
    found = subject(state(light, quantity="irradiance").recipe)
    rest = subject(state(light).recipe).light
    assert found.light.source is rest
    assert found.whole.source is light
