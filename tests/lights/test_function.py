"""What shviewer.lights.function promises: any Python function of directions is a light, or one line says why not."""

import re
import sys

import numpy as np
import pytest
from harmonics.independent import random_directions, scipy_basis
from helpers import refusal
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.errors import LightError
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import jittered
from shviewer.lights.function import FunctionLight, load_function
from shviewer.lights.lat_long import MAP_ROWS


def error_of(function, count=7):
    return refusal(FunctionLight(function, "sky").radiance, random_directions(count))


@pytest.fixture
def load(tmp_path):
    def load_text(text, function="light"):
        path = tmp_path / "my_light.py"
        path.write_text(text, encoding="utf-8")
        return load_function(path, function)

    return load_text


def test_a_grey_function_has_three_equal_channels():
    d = random_directions(20)
    assert_array_equal(FunctionLight(lambda d: d[:, 2] + 2).radiance(d), np.repeat(d[:, 2:] + 2, 3, axis=1))


def test_an_rgb_function_keeps_its_channels():
    d = random_directions(20)
    assert_array_equal(FunctionLight(lambda d: d * [1, 2, 3]).radiance(d), d * [1, 2, 3])
    assert FunctionLight(lambda d: (d > 0).astype(np.int8)).radiance(d).dtype == np.float64
    assert_array_equal(FunctionLight(lambda d: d.tolist()).radiance(d), d)


def test_three_directions_of_a_grey_function_are_not_mistaken_for_channels():
    assert_array_equal(FunctionLight(lambda d: d[:, 2]).radiance(np.eye(3)), [[0, 0, 0], [0, 0, 0], [1, 1, 1]])


def test_coefficients_of_a_band_limited_function_are_exact():
    coefficients = np.random.default_rng(0).standard_normal((9, 3))
    light = FunctionLight(lambda d: scipy_basis(d, 3) @ coefficients)
    # SciPy's error of some 1e-15 per function, 9 of them, and rounding over 131 072 points
    expected = np.concatenate([coefficients, np.zeros((16, 3))])
    for n_bands in (2, 5):
        assert_allclose(light.coefficients(n_bands), expected[: n_bands**2], rtol=0, atol=1e-13)
    assert_allclose(light.products().diagonal(), (coefficients**2).sum(axis=0), rtol=1e-13, atol=0)


def test_a_function_is_sampled_once_for_coefficients_and_products():
    calls = []
    light = FunctionLight(lambda d: calls.append(len(d)) or d)
    light.coefficients(3)
    once = sum(calls)
    light.products()
    light.coefficients(100)
    assert light.map.texels.shape == (MAP_ROWS, 2 * (MAP_ROWS - 1), 3)  # the look that the rule is compared with
    assert sum(calls) == once
    assert once < 510_000  # 417 000 in the look, and two rules of 128 and 160 rows


def test_coefficients_hold_no_more_energy_than_a_function_with_an_edge():
    light = FunctionLight(lambda d: (d @ [0.48, -0.6, 0.64] > 0.7) * 5.0)
    energy = (light.coefficients(128) ** 2).sum(axis=0)
    assert (energy <= light.products().diagonal() * (1 + 1e-12)).all()
    assert light.products().diagonal()[0] == pytest.approx(
        25 * 2 * np.pi * 0.3, rel=1e-2, abs=0
    )  # an edge between 256 rows


def test_coefficients_of_128_bands_are_finite_and_start_with_those_of_few():
    light = FunctionLight(lambda d: np.exp(3 * d[:, 0]) + d[:, 1])
    assert_allclose(light.coefficients(128)[:16], light.coefficients(4), rtol=0, atol=1e-13)


def test_coefficients_agree_with_scattered_samples():
    light = FunctionLight(lambda d: np.stack([np.exp(d[:, 0]), d[:, 1] ** 2, d[:, 2]], axis=-1))
    sampled = project_samples(light.radiance, jittered(40_000, seed=0), 4)
    assert_allclose(sampled, light.coefficients(4), rtol=0, atol=2e-3)  # 5 sigma of a cell of 1/200


def test_the_best_method_names_its_points():
    said = "features narrower than 0.5 degrees may be missed"
    assert FunctionLight(np.sin).best_method == f"Gauss-Legendre, 51 200 points; {said}"
    rough = FunctionLight(lambda d: np.sqrt(np.abs(d[:, 0]))).best_method
    assert re.fullmatch(rf"adaptive cells, [\d ]+ points; {said}", rough)


def test_the_map_has_the_function_at_its_texels_and_poles():
    light = FunctionLight(lambda d: np.stack([d[:, 0], d[:, 1], np.exp(d[:, 2])], axis=-1))
    image = light.map
    assert image.rows_on_poles
    assert image.texels.shape == (MAP_ROWS, 2 * (MAP_ROWS - 1), 3)
    assert image.texels.dtype == np.float32
    assert_allclose(image.texels[[0, -1], 0], [[0, 0, np.e], [0, 0, 1 / np.e]], rtol=0, atol=1e-6)
    d = random_directions(500)
    # linear between texels: h**2 / 8 of a curvature up to e, in both directions
    assert_allclose(image.sample(d), light.radiance(d), rtol=0, atol=2 * np.e * (np.pi / 512) ** 2 / 8 + 1e-6)


def test_there_are_no_landmarks():
    assert FunctionLight(np.sin).landmarks().shape == (0, 3)


def test_an_exception_is_one_line_with_its_place():
    def broken(directions):
        return 1 / int(directions[0, 0] * 0)

    line = error_of(broken)
    number = broken.__code__.co_firstlineno + 1
    assert line == f"sky: the function raised ZeroDivisionError at test_function.py:{number}: division by zero"


def test_an_exception_of_two_lines_is_one_line_too():
    def broken(_):
        raise ValueError("first\nsecond")

    error_of(broken)


@pytest.mark.parametrize(
    ("function", "shape"),
    [
        (lambda d: 1.0, "()"),
        (lambda d: d[:, :2], "(7, 2)"),
        (lambda d: d.T, "(3, 7)"),
        (lambda d: d[:, :1], "(7, 1)"),
        (lambda d: d[:-1], "(6, 3)"),
        (lambda d: d[None], "(1, 7, 3)"),
    ],
)
def test_another_shape_is_refused_with_both_shapes(function, shape):
    expected = f"for directions of shape (7, 3) the function returned shape {shape}; it must be (7, 3) or (7,)"
    assert error_of(function) == f"sky: {expected}"


@pytest.mark.parametrize(
    ("function", "said"),
    [
        (lambda d: None, "returned None; end it with return radiance"),
        (lambda d: 1j * d, "returned values of type complex128; radiance is plain real numbers"),
        (lambda d: np.ma.masked_less(d, 0), "returned a masked array; radiance is plain real numbers"),
        (lambda d: ["bright"] * len(d), "returned what is no array of numbers ("),
        (
            lambda: 1.0,
            "raised TypeError: <lambda>() takes 0 positional arguments but 1 was given; it is called with all",
        ),
    ],
    ids=["none", "complex", "masked", "text", "no parameter"],
)
def test_what_is_no_radiance_is_said_without_a_place_in_this_program(function, said):
    line = error_of(function)
    assert line.startswith(f"sky: the function {said}")
    assert "function.py" not in line


def test_a_function_of_a_single_direction_is_told_that_it_gets_all_at_once():
    line = error_of(lambda d: max(0.0, d[2]))
    assert line.endswith("; it is called with all directions at once, an array (7, 3)")


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_value_that_is_not_finite_is_refused_with_its_direction(bad):
    def spoilt(d):
        values = np.ones((len(d), 3))
        values[4, 1] = bad
        return values

    line = error_of(spoilt)
    expected = f"sky: the function returned [1.0, {bad}, 1.0] for direction {random_directions(7)[4].tolist()}"
    assert line == f"{expected}; radiance must be finite"


def test_values_that_are_no_numbers_are_one_line():
    assert "could not convert string to float" in error_of(lambda d: ["red"] * len(d))


def test_a_function_that_writes_into_its_argument_does_no_harm():
    def folded(d):
        d[:, 2] = np.abs(d[:, 2])
        return d[:, 2]

    expected = project_samples(FunctionLight(lambda d: np.abs(d[:, 2])).radiance, jittered(400, 0), 3)
    try:
        found = project_samples(FunctionLight(folded).radiance, jittered(400, 0), 3)
    except LightError:
        return
    assert_array_equal(found, expected)


def test_a_file_is_imported_and_its_function_named(load):
    light = load("import numpy as np\ndef light(d):\n    return np.maximum(0, d[:, 2])\n")
    assert (light.name, light.description, light.notes) == ("light", "Python function", ())
    assert_array_equal(light.radiance(np.eye(3))[:, 0], [0, 0, 1])


def test_neighbours_of_a_file_can_be_imported_and_the_path_is_put_back(load, tmp_path):
    before = list(sys.path)
    (tmp_path / "a_neighbour_of_light.py").write_text("LEVEL = 2.5\n")
    try:
        light = load("from a_neighbour_of_light import LEVEL\ndef light(d):\n    return 0 * d[:, 0] + LEVEL\n")
    finally:
        sys.modules.pop("a_neighbour_of_light", None)
    assert light.radiance(np.eye(3))[0, 0] == 2.5
    assert sys.path == before


def test_a_file_may_hold_dataclasses_with_postponed_annotations(load):
    light = load(
        "from __future__ import annotations\nfrom dataclasses import dataclass\n"
        "@dataclass\nclass Sky:\n    level: float = 2.0\n"
        "def light(d):\n    return 0 * d[:, 0] + Sky().level\n"
    )
    assert light.radiance(np.eye(3))[0, 0] == 2


def test_a_missing_file_is_one_line(tmp_path):
    path = tmp_path / "none.py"
    with pytest.raises(LightError, match=r"none\.py: no such file; check the path$"):
        load_function(path, "light")
    with pytest.raises(LightError, match="a directory"):
        load_function(tmp_path, "light")


def test_a_missing_function_lists_those_that_are_there(load):
    with pytest.raises(LightError, match=r"my_light\.py: no function 'ligth'; did you mean light\?$"):
        load("LEVEL = 3\ndef light(d): ...\ndef dusk(d): ...\ndef _helper(): ...\n", "ligth")
    with pytest.raises(LightError, match=r"my_light\.py: no function 'light'; there is: none$"):
        load("light = 3\n")
    with pytest.raises(LightError, match=r"no function 'sun'; there is: dusk, light$"):
        load("def light(d): ...\ndef dusk(d): ...\n", "sun")


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("def light(d:\n", "SyntaxError"),
        ("import no_module_of_this_name\n", "ModuleNotFoundError: No module named 'no_module_of_this_name'"),
        ("1 / 0\n", "ZeroDivisionError: division by zero"),
    ],
)
def test_a_file_that_cannot_be_imported_is_one_line(load, tmp_path, text, what):
    before = list(sys.path)
    assert refusal(load, text).startswith(f"{tmp_path / 'my_light.py'}: importing it raised {what}")
    assert sys.path == before


def test_a_function_that_gives_other_values_each_time_is_noted():
    rng = np.random.default_rng(5)
    noisy = FunctionLight(lambda d: 1 + 0.01 * rng.random(len(d)))
    assert "its values for the same directions differ from call to call" in noisy.notes[-1]
    assert FunctionLight(lambda d: 1 + 0.01 * d[:, 0]).notes == ()
