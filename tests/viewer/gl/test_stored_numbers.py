"""What engines store of irradiance is evaluated in the shader by the encoding's own formula, as decoding.py does in float64."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from harmonics.quantities.hard_numbers import CASES, HARD
from helpers import picture_of
from viewer.gl.frames import map_directions, map_frame, picture_view, rounding, square_frame

from shviewer.cli.main import main
from shviewer.harmonics.quantities.encodings import ENCODINGS, Stored
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.viewer.camera import towards
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.drawn import DirectSum, Encoded, SplineMap, Surfaces
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.screenshot import render_linear, render_rgb

TURNED = {"camera": (150.0, 35.0), "light_rotation": towards(-20.0, 28.0)}


def encoded(name: str, light: str = "green", **view: object) -> Picture:
    return picture_of(light, quantity="irradiance", encode=name, n_bands=ENCODED_BANDS[name], **view)


def showing(picture: Picture, stored: Stored) -> Picture:
    """The picture with other numbers."""
    return replace(picture, drawn=Encoded(stored), projection=replace(picture.projection, stored=stored))


@pytest.mark.parametrize(("name", "light"), CASES)
def test_the_shader_has_the_irradiance_of_any_numbers(renderer: Renderer, name: str, light: str) -> None:
    """Rounding of float32 in a few products of the largest number, a power (1e-6, measured on llvmpipe) and the direction."""
    stored = Stored(name, ENCODINGS[name].store(HARD[light]))
    picture = showing(encoded(name, **TURNED), stored)
    frame = square_frame(48)
    seen = picture_view(frame, 1, picture)
    wanted = picture.rest_at(seen.directions)
    np.testing.assert_array_equal(wanted, stored.irradiance(seen.directions))
    size = max(np.abs(wanted).max(), np.abs(stored.numbers).max())
    found = render_linear(renderer, picture, frame)[seen.mask]
    assert np.isfinite(found).all()
    tolerance = (3e-6 + 6 * rounding(seen)) * size
    assert (np.abs(found - wanted).max(axis=1) <= tolerance).all()


@pytest.mark.parametrize("name", ENCODINGS)
def test_numbers_of_a_light_go_up_as_few_as_they_are_and_none_is_a_sum_of_bands(name: str, renderer: Renderer) -> None:
    picture = encoded(name, "venice_sunset")
    drawn = picture.drawn
    assert isinstance(drawn, Encoded)
    assert drawn.stored.numbers.shape == (ENCODINGS[name].floats, 3)
    render_linear(renderer, picture, square_frame(16))
    programs = [
        program for key, program in renderer.panes.programs.items() if key[2] == ENCODINGS[name].formula.upper()
    ]
    assert programs
    for program in programs:
        assert program.program["stored"].array_length == len(drawn.stored.with_axes)
        assert not {"ShBlock", "n_bands", "reconstruction_map"} & set(program.program)


@pytest.mark.parametrize("name", ["geomerics", "zh3-shared", "l2-deringed"])
def test_error_sphere_and_map_are_of_the_formula(renderer: Renderer, name: str) -> None:
    picture = encoded(name, whole_sphere=True, error="signed", **TURNED)
    frame = map_frame(64, count=3)
    pixels = render_linear(renderer, picture, frame)
    columns, world = map_directions(frame, 1)
    directions = world.reshape(-1, 3) @ picture.light_from_world.T
    wanted = picture.rest_at(directions)
    original = picture.light.radiance(directions)
    third, _ = map_directions(frame, 2)
    atol = 1e-5 * np.abs(original).max()
    np.testing.assert_allclose(pixels[:, columns].reshape(-1, 3), wanted, rtol=0, atol=atol)
    np.testing.assert_allclose(pixels[:, third].reshape(-1, 3), wanted - original, rtol=0, atol=2 * atol)


@pytest.mark.parametrize("name", ["geomerics", "hallucinated"])
def test_an_exported_map_holds_the_irradiance_of_the_formula(tmp_path: Path, name: str) -> None:
    out = tmp_path / "m.exr"
    options = ("--for", "irradiance", "--encode", name, "--map", "--size", "128", "64", "--rotate-light", "30", "20")
    assert main(["screenshot", str(out), "green", *options]) == 0
    picture = encoded(name, whole_sphere=True, light_rotation=towards(30.0, 20.0))
    directions = map_directions(map_frame(128, count=1), 0)[1].reshape(-1, 3) @ picture.light_from_world.T
    channels = OpenEXR.File(str(out), separate_channels=True).channels()
    found = np.stack([channels[channel].pixels for channel in "RGB"], axis=-1).reshape(-1, 3)
    wanted = picture.rest_at(directions)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=2e-7 * np.abs(wanted).max())


@pytest.mark.parametrize("name", ["geomerics", "zh3"])
def test_a_surface_has_the_luminance_of_the_formula(name: str) -> None:
    drawn = encoded(name, lobe_view=True).drawn
    assert isinstance(drawn, Surfaces)
    summed = encoded(name, lobe_view=True, muted=frozenset({31})).drawn  # of Geomerics' 1024 terms all but some 1e-7
    assert isinstance(summed, Surfaces)
    np.testing.assert_allclose(drawn.shown[1].values, summed.shown[1].values, rtol=0, atol=4e-3)  # roots of 1e-5


def test_muted_bands_and_windows_are_of_its_bands_and_those_are_summed() -> None:
    assert isinstance(encoded("zh3", muted=frozenset({1})).drawn, DirectSum)
    assert isinstance(encoded("geomerics", window="hann").drawn, DirectSum)
    assert isinstance(encoded("l1", muted=frozenset({4})).drawn, Encoded)  # no band of it
    assert isinstance(encoded("l2", evaluate="direct").drawn, Encoded)
    assert isinstance(encoded("l2", evaluate="map").drawn, SplineMap)


def test_what_is_beside_goes_through_the_same_encoding() -> None:
    picture = encoded("zh3", beside="method", samples=300)
    assert picture.beside is not None
    assert isinstance(picture.beside.drawn, Encoded)
    numbers = picture.beside.drawn.stored.numbers
    own = encoded("zh3", method="jittered", samples=300).stored
    assert own is not None
    np.testing.assert_array_equal(numbers, own.numbers)
    here = np.array([[0.0, 0.6, 0.8]])
    np.testing.assert_array_equal(picture.beside.values_at(here), own.irradiance(here))


def test_the_stamp_says_how_it_was_evaluated_and_from_which_numbers(renderer: Renderer) -> None:
    picture = encoded("zh3")
    said = json.loads(metadata(picture, compose(1280, 640), renderer.version))
    assert said["evaluated"] == "formula"
    assert said["encoding"]["name"] == "zh3"
    assert picture.stored is not None
    np.testing.assert_allclose(said["encoding"]["numbers"], picture.stored.numbers, rtol=1e-8)
    plain = json.loads(metadata(picture_of("green"), compose(1280, 640), renderer.version))
    assert (plain["encoding"], plain["evaluated"]) == (None, "direct")


def test_a_formula_and_its_bands_are_the_same_picture(renderer: Renderer) -> None:
    for name in ENCODINGS:
        picture, frame = encoded(name, "film_studio"), square_frame(64)
        summed = replace(picture, drawn=DirectSum(picture.coefficients))
        own, other = (render_rgb(renderer, one, frame, overlay=False).astype(int) for one in (picture, summed))
        assert np.abs(own - other).max() <= 1
