"""What shviewer.lights.analytic.scene promises: a scene file is read as written, or refused in one line that helps."""

import re

import numpy as np
import pytest
from harmonics.independent import random_directions
from helpers import refusal
from numpy.testing import assert_allclose

from shviewer.errors import LightError
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian
from shviewer.lights.analytic.scene import MAX_FILE_BYTES, read_scene
from shviewer.lights.find import built_in_lights

ABOVE = "the slope must be positive, above the offset, and neither beyond 1e+15"
GAUSSIAN = {"profile": '"gaussian"', "axis": "[0, 0, 1]", "radiance": "1", "sharpness": "3"}
LINEAR = {"profile": '"clamped-linear"', "axis": "[0, 0, 1]", "radiance": "1", "slope": "2", "offset": "1"}
DISC = {"profile": '"disc"', "axis": "[0, 0, 1]", "radiance": "1", "half_angle_degrees": "30"}
CONSTANT = {"profile": '"constant"', "radiance": "1"}
NO_AXIS = {"axis": None}


def lobe(base, **changes):
    """A [[lobe]] table; None takes a key away."""
    return "[[lobe]]\n" + "".join(f"{k} = {v}\n" for k, v in {**base, **changes}.items() if v is not None)


@pytest.fixture
def read(tmp_path):
    def read_text(text):
        path = tmp_path / "my scene.toml"
        path.write_text(text, encoding="utf-8")
        return read_scene(path)

    return read_text


MISTAKES = {
    # text -> what the line says after the file's name
    "": "an empty file (0 bytes); fetch or export it again",
    'description = "empty"': "no lobe; a scene has one or more [[lobe]] tables",
    "lobe = 3": "no lobe; a scene has one or more [[lobe]] tables",
    "lobe = []": "no lobe; a scene has one or more [[lobe]] tables",
    "lobe = [1, 2]": "no lobe; a scene has one or more [[lobe]] tables",
    "[lobe]\nprofile = 'constant'\nradiance = 1": "no lobe; a scene has one or more [[lobe]] tables",
    "description = 3\n" + lobe(CONSTANT): "description is 3; it must be a text",
    "title = 'x'\n" + lobe(CONSTANT): "the file: unknown key 'title'; known are description, lobe",
    '"a\\nb" = 1': "the file: unknown key 'a\\nb'; known are description, lobe",
    "[[lobes]]\n": "the file: unknown key 'lobes'; did you mean lobe?",
    lobe(CONSTANT) * 65: "65 lobes: there must be 1 to 64",
    lobe(CONSTANT, profile=None): "lobe 1: profile is missing; it must be one of clamped-linear, disc, gaussian, constant",
    lobe(CONSTANT, profile='"gausian"'): (
        "lobe 1: profile is 'gausian'; did you mean gaussian?"
    ),
    lobe(CONSTANT, profile="7"): "lobe 1: profile is 7; it must be one of clamped-linear, disc, gaussian, constant",
    lobe(CONSTANT, profile="['disc']"): (
        "lobe 1: profile is ['disc']; it must be one of clamped-linear, disc, gaussian, constant"
    ),
    lobe(CONSTANT) + lobe(GAUSSIAN, sharpness=None): "lobe 2: sharpness is missing; it must be a finite number",
    lobe(GAUSSIAN, sharpness='"3"'): "lobe 1: sharpness is '3'; it must be a finite number",
    lobe(GAUSSIAN, sharpness="true"): "lobe 1: sharpness is True; it must be a finite number",
    lobe(GAUSSIAN, sharpness="nan"): "lobe 1: sharpness is nan; it must be a finite number",
    lobe(GAUSSIAN, sharpness="inf"): "lobe 1: sharpness is inf; it must be a finite number",
    lobe(GAUSSIAN, sharpness="-2.5"): "lobe 1: sharpness -2.5: it must be 1e-15 to 1e+15",
    lobe(GAUSSIAN, sharpness="0"): "lobe 1: sharpness 0: it must be 1e-15 to 1e+15",
    lobe(GAUSSIAN, sharpness="1" + "0" * 400): re.compile("lobe 1: sharpness is 10+; it must be a finite number"),
    lobe(GAUSSIAN, sharpness="1979-05-27"): re.compile(r"lobe 1: sharpness is datetime.*; it must be a finite number"),
    lobe(GAUSSIAN, slope="1"): (
        "lobe 1: unknown key 'slope'; known are profile, radiance, sharpness, axis, azimuth_degrees, elevation_degrees"
    ),
    lobe(LINEAR, slope=None): "lobe 1: slope is missing; it must be a finite number",
    lobe(LINEAR, offset=None): "lobe 1: offset is missing; it must be a finite number",
    lobe(LINEAR, offset="2"): f"lobe 1: slope 2, offset 2: {ABOVE}",
    lobe(LINEAR, slope="-2"): f"lobe 1: slope -2, offset 1: {ABOVE}",
    lobe(DISC, half_angle_degrees=None): "lobe 1: half_angle_degrees is missing; it must be a finite number",
    lobe(DISC, half_angle_degrees="0"): "lobe 1: half angle 0 degrees: it must be above 0 and at most 180",
    lobe(DISC, half_angle_degrees="181"): "lobe 1: half angle 181 degrees: it must be above 0 and at most 180",
    lobe(CONSTANT, axis="[0, 0, 1]"): "lobe 1: unknown key 'axis'; known are profile, radiance",
    lobe(DISC, **NO_AXIS): (
        "lobe 1: no axis; give axis = [x, y, z] or azimuth_degrees and elevation_degrees"
    ),
    lobe(DISC, axis="[0, 0, 0]"): "lobe 1: axis is [0, 0, 0]; it must be a vector that is not zero",
    lobe(DISC, axis="[0, -0.0, 0.0]"): "lobe 1: axis is [0, -0.0, 0.0]; it must be a vector that is not zero",
    lobe(DISC, axis="[0, 1]"): "lobe 1: axis is [0, 1]; it must be three numbers",
    lobe(DISC, axis="[0, 1, 2, 3]"): "lobe 1: axis is [0, 1, 2, 3]; it must be three numbers",
    lobe(DISC, axis="1"): "lobe 1: axis is 1; it must be three numbers",
    lobe(DISC, axis='[0, 1, "z"]'): "lobe 1: axis is 'z'; it must be a finite number",
    lobe(DISC, axis="[0, 1, inf]"): "lobe 1: axis is inf; it must be a finite number",
    lobe(DISC, azimuth_degrees="3"): (
        "lobe 1: give axis or azimuth_degrees and elevation_degrees, not both"
    ),
    lobe(DISC, **NO_AXIS, azimuth_degrees="3"): "lobe 1: elevation_degrees is missing; it must be a finite number",
    lobe(DISC, **NO_AXIS, elevation_degrees="3"): "lobe 1: azimuth_degrees is missing; it must be a finite number",
    lobe(DISC, **NO_AXIS, azimuth_degrees="nan", elevation_degrees="3"): (
        "lobe 1: azimuth_degrees is nan; it must be a finite number"
    ),
    lobe(DISC, radiance=None): "lobe 1: radiance is missing; it must be a finite number",
    lobe(DISC, radiance="[1, 2]"): "lobe 1: radiance is [1, 2]; it must be three numbers",
    lobe(DISC, radiance='"red"'): "lobe 1: radiance is 'red'; it must be a finite number",
    lobe(DISC, radiance="[1, 2, nan]"): "lobe 1: radiance is nan; it must be a finite number",
    lobe(DISC, radiance="2e30"): "lobe 1: radiance is 2e+30; it must be at most 1e+30 in magnitude",
    lobe(DISC, radiance="[1, -2e30, 1]"): (
        "lobe 1: radiance is [1, -2e+30, 1]; it must be at most 1e+30 in magnitude"
    ),
    "[[lobe]\n": re.compile(r"not valid TOML: .*line 1.*"),
    "a = 1\na = 2": "not valid TOML: Cannot overwrite a value (at end of document)",
}  # fmt: skip


@pytest.mark.parametrize(("text", "expected"), MISTAKES.items(), ids=[text[-40:] or "empty" for text in MISTAKES])
def test_a_mistake_is_one_line_with_file_key_and_rule(read, tmp_path, text, expected):
    file, line = f"{tmp_path / 'my scene.toml'}: ", refusal(read, text)
    assert line.startswith(file)
    if isinstance(expected, str):
        assert line[len(file) :] == expected
    else:
        assert expected.fullmatch(line[len(file) :])


@pytest.mark.parametrize("text", ["x = " + "[" * 5000, lobe(GAUSSIAN, sharpness="1" * 5000)], ids=["nested", "digits"])
def test_what_toml_cannot_hold_is_one_line_too(read, text):
    with pytest.raises(LightError, match=r"my scene\.toml: .+"):
        read(text)


@pytest.mark.parametrize(
    "text",
    [
        lobe(LINEAR, slope="1e200"),
        lobe(LINEAR, offset="-1e200"),
        lobe(GAUSSIAN, sharpness="1e-160"),
        lobe(GAUSSIAN, sharpness="1e160"),
    ],
)
def test_a_scene_that_is_read_has_finite_coefficients_and_norm(read, text):
    try:
        light = read(text)
    except LightError:
        return
    assert np.isfinite(light.coefficients(4)).all()
    assert np.isfinite(light.products().diagonal()).all()


def test_a_file_that_is_no_text_is_one_line(tmp_path):
    path = tmp_path / "picture.toml"
    path.write_bytes(b"description = 1\n\xff\xd8")
    with pytest.raises(LightError, match=r"picture\.toml: byte 16 is not UTF-8 text; a scene is a TOML file$"):
        read_scene(path)


def test_a_missing_file_a_folder_and_a_huge_file_are_one_line(tmp_path):
    (tmp_path / "folder.toml").mkdir()
    (tmp_path / "huge.toml").write_bytes(b"#" * (MAX_FILE_BYTES + 1))
    for name, rule in (
        ("none.toml", "no such file; check the path"),
        ("folder.toml", "a directory; name one file in it"),
        ("huge.toml", "65537 bytes; a scene file has at most 65536"),
    ):
        with pytest.raises(LightError, match=f"{re.escape(str(tmp_path / name))}: {rule}$"):
            read_scene(tmp_path / name)


def test_a_file_of_the_largest_size_is_read(tmp_path):
    path = tmp_path / "large.toml"
    text = lobe(CONSTANT)
    path.write_text(text + "#" * (MAX_FILE_BYTES - len(text)))
    assert len(read_scene(path).lobes) == 1


def test_every_profile_is_read_with_its_parameters(read):
    text = 'description = "all four"\n' + lobe(LINEAR) + lobe(DISC) + lobe(GAUSSIAN) + lobe(CONSTANT)
    light = read(text)
    profiles = [each.profile for each in light.lobes]
    assert profiles == [ClampedLinear(2, 1), Disc(float(np.radians(30))), Gaussian(3), Constant()]
    assert (light.name, light.description, light.notes) == ("my scene", "all four", ())


def test_a_description_is_optional(read):
    assert read(lobe(CONSTANT)).description == ""


@pytest.mark.parametrize(
    ("value", "expected"),
    [("2", [2, 2, 2]), ("-0.5", [-0.5] * 3), ("[1, 2.5, -3]", [1, 2.5, -3]), ("1e30", [1e30] * 3), ("0", [0] * 3)],
)
def test_radiance_is_grey_or_rgb_and_may_be_negative(read, value, expected):
    assert read(lobe(DISC, radiance=value)).lobes[0].radiance.tolist() == expected


def test_an_axis_has_any_length(read):
    assert_allclose(read(lobe(DISC, axis="[0, -3, 4]")).lobes[0].axis, [0, -0.6, 0.8], rtol=0, atol=1e-16)
    assert_allclose(read(lobe(DISC, axis="[0, 0, 1e-310]")).lobes[0].axis, [0, 0, 1], rtol=0, atol=1e-16)


@pytest.mark.parametrize(
    ("azimuth", "elevation", "expected"),
    [
        (0, 0, [1, 0, 0]),
        (90, 0, [0, 1, 0]),
        (-90, 0, [0, -1, 0]),
        (123, 90, [0, 0, 1]),
        (0, -90, [0, 0, -1]),
        (60, 30, [np.sqrt(3) / 4, 0.75, 0.5]),
    ],
)
def test_azimuth_turns_from_x_to_y_and_elevation_rises_to_z(read, azimuth, elevation, expected):
    light = read(lobe(DISC, **NO_AXIS, azimuth_degrees=azimuth, elevation_degrees=elevation))
    assert_allclose(light.lobes[0].axis, expected, rtol=0, atol=2e-16)


def test_sixty_four_lobes_are_read_in_their_order(read):
    light = read("".join(lobe(GAUSSIAN, sharpness=k) for k in range(1, 65)))
    assert [each.profile.sharpness for each in light.lobes] == list(range(1, 65))


SCENES = {name: path for name, path in built_in_lights().items() if path.suffix == ".toml"}


def test_the_built_in_scenes_are_those_the_product_names():
    assert set(SCENES) == {"green", "sun-sky", "hemisphere", "cosine", "studio", "constant"}


@pytest.mark.parametrize("name", SCENES)
def test_every_built_in_scene_loads_and_describes_itself(name):
    light = read_scene(SCENES[name])
    assert light.name == name
    assert light.description
    assert np.isfinite(light.coefficients(16)).all()
    assert ((light.coefficients(16) ** 2).sum(axis=0) <= light.products().diagonal() * (1 + 1e-12)).all()


def test_built_in_scenes_have_the_norms_of_their_formulas():
    expected = {
        "green": 0.3 * np.pi,
        "hemisphere": 2 * np.pi,
        "cosine": 2 * np.pi / 3,
        "constant": 4 * np.pi,
        "sun-sky": 172042434161495.3794,  # hard_cases.json
    }
    for name, norm_squared in expected.items():
        assert_allclose(read_scene(SCENES[name]).products().diagonal(), np.full(3, norm_squared), rtol=1e-14, atol=0)


def test_the_built_in_green_light_is_the_formula_of_the_paper():
    d = np.concatenate([random_directions(1000), [[0, 0, 1], [np.cos(2.5), np.sin(2.5), 0]]])
    theta, phi = np.arccos(d[:, 2]), np.arctan2(d[:, 1], d[:, 0])
    paper = np.maximum(0, 5 * np.cos(theta) - 4) + np.maximum(0, -4 * np.sin(theta - np.pi) * np.cos(phi - 2.5) - 3)
    assert paper.max() == pytest.approx(1)
    assert_allclose(read_scene(SCENES["green"]).radiance(d), paper[:, None] * np.ones(3), rtol=0, atol=1e-13)
