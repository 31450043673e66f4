"""Each program's own evaluator makes of our converted coefficients what they are of, and its coefficients become ours."""

from __future__ import annotations

import numpy as np
import pytest
from coefficients import peer_evaluators as peers
from coefficients.peer_cases import EXACT, PEERS, asymmetric, directions_here, theirs
from numpy.typing import NDArray

from shviewer.coefficients.axes import NAMED_AXES, Axes, all_axes, turn
from shviewer.coefficients.convention import to_quantity
from shviewer.coefficients.programs import CONVENTIONS, convention_text, parse_convention
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.quadrature import gauss_legendre
from shviewer.harmonics.rotation import rotate

A = np.repeat([np.pi, 2 * np.pi / 3, np.pi / 4], [1, 3, 5])[:, None]
"""The clamped cosine's factors."""


def what_it_holds(name: str, coefficients: Array, directions: Array) -> Array:
    """The radiance, or for programs that keep irradiance over pi that."""
    held = coefficients * A / np.pi if name in ("filament", "unity") else coefficients
    return evaluate_basis(directions, int(np.sqrt(len(held)))) @ held


@pytest.mark.parametrize("name", PEERS)
def test_the_program_evaluates_our_export_to_the_same_function(name: str) -> None:
    evaluator, n_bands = PEERS[name]
    coefficients, directions = asymmetric(n_bands), directions_here()
    numbers = CONVENTIONS[name].from_ours(coefficients)
    wanted = what_it_holds(name, coefficients, directions)
    np.testing.assert_allclose(evaluator(numbers, theirs(name, directions)), wanted, rtol=0, atol=EXACT)


@pytest.mark.parametrize("name", PEERS)
def test_coefficients_of_the_program_become_ours(name: str) -> None:
    evaluator, n_bands = PEERS[name]
    numbers: NDArray[np.generic] = asymmetric(n_bands)
    if name == "scipy":
        numbers = CONVENTIONS[name].from_ours(asymmetric(n_bands)[::-1].copy())
    directions = directions_here()
    found = evaluate_basis(directions, n_bands) @ CONVENTIONS[name].to_ours(numbers)
    if name in ("filament", "unity"):
        found = found / np.pi
    np.testing.assert_allclose(found, evaluator(numbers, theirs(name, directions)), rtol=0, atol=10 * EXACT)


@pytest.mark.parametrize("name", ["filament", "three", "unity", "unreal", "sphericart"])
def test_a_projection_made_with_the_programs_own_functions_is_the_one_we_write(name: str) -> None:
    """Integrals over the program's directions of the function times the program's functions, one by one."""
    evaluator, n_bands = PEERS[name]
    rule = gauss_legendre(2 * (n_bands + 1) ** 2).direction_set()
    coefficients = asymmetric(n_bands)
    ours = evaluate_basis(rule.directions, n_bands) @ coefficients
    basis = evaluator(np.eye(n_bands**2), theirs(name, rule.directions))
    gram = basis.T @ (rule.weights[:, None] * basis)
    projected = np.linalg.solve(gram, basis.T @ (rule.weights[:, None] * ours))
    if name in ("filament", "unity"):
        projected = projected * A / np.pi
    np.testing.assert_allclose(CONVENTIONS[name].from_ours(coefficients), projected, rtol=0, atol=EXACT)


@pytest.mark.parametrize("normalization", ["ortho", "4pi"])
@pytest.mark.parametrize("phase", [True, False])
def test_pyshtools_evaluates_both_normalisations_and_both_phases(normalization: str, phase: bool) -> None:
    scale = {"ortho": "orthonormal", "4pi": "4pi"}[normalization]
    convention = parse_convention(f"shviewer,{scale},{'phase' if phase else 'no-phase'}")
    coefficients, directions = asymmetric(16), directions_here(100)
    numbers = np.asarray(convention.from_ours(coefficients))
    value = peers.pyshtools(numbers, directions, normalization, phase)
    np.testing.assert_allclose(value, evaluate_basis(directions, 16) @ coefficients, rtol=0, atol=EXACT)
    np.testing.assert_allclose(convention.to_ours(numbers), coefficients, rtol=0, atol=EXACT)


def test_e3nn_has_its_pole_along_y_and_no_phase() -> None:
    convention = parse_convention("shviewer,no-phase,+z+x+y")
    coefficients, directions = asymmetric(4), directions_here()
    numbers = np.asarray(convention.from_ours(coefficients))
    in_basis_axes = directions @ convention.axes.matrix.T
    x, y, z = in_basis_axes.T
    value = peers.e3nn(numbers, np.stack([y, z, x], axis=1))  # its x, y, z are what it calls m = -1, 0, 1
    np.testing.assert_allclose(value, evaluate_basis(directions, 4) @ coefficients, rtol=0, atol=EXACT)
    np.testing.assert_allclose(np.stack([y, z, x], axis=1), directions, rtol=0, atol=0)  # and they are our x, y, z


def test_the_printed_factors_of_filament_are_ours() -> None:
    """The table in IndirectLight.h, for coefficients with phase in filament's own axes."""
    printed = [0.282095, -0.325735, 0.325735, -0.325735, 0.273137, -0.273137, 0.078848, -0.273137, 0.136569]
    here = np.asarray(parse_convention("filament,z-up").from_ours(np.eye(9)))
    np.testing.assert_allclose(here, np.diag(printed), rtol=0, atol=5.1e-7)


@pytest.mark.parametrize(
    ("name", "look_up"),
    [
        ("three", lambda x, y, z: (np.arctan2(z, x) / (2 * np.pi) + 0.5, 0.5 - np.arcsin(y) / np.pi)),
        ("unity", lambda x, y, z: (0.5 - np.arctan2(z, x) / (2 * np.pi), np.arccos(y) / np.pi)),
        ("unreal", lambda x, y, z: ((1 + np.arctan2(x, -y) / np.pi) / 2, np.arccos(z) / np.pi)),
        ("filament", lambda x, y, z: ((np.arctan2(-x, z) / np.pi + 1) / 2, (1 - 2 * np.arcsin(y) / np.pi) / 2)),
    ],
)
def test_the_program_sees_our_image_where_its_own_loader_puts_it(name: str, look_up: object) -> None:
    """equirectUv of three.js, ToRadialCoords of Unity's panoramic sky, LookupLongLat of Unreal's importer, whose directions
    have y and z swapped, and filament's equirectangularToCubemap with cmgen's mirror.
    """
    u, v = np.meshgrid(np.linspace(0.05, 0.95, 13), np.linspace(0.1, 0.9, 7))
    phi, theta = np.pi * (1 - 2 * u.ravel()), np.pi * v.ravel()
    ours = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    found = look_up(*(ours @ CONVENTIONS[name].axes.matrix.T).T)  # type: ignore[operator]
    np.testing.assert_allclose(np.stack(found), np.stack([u.ravel(), v.ravel()]), rtol=0, atol=1e-12)


def test_all_48_axes_leave_the_function_what_it_is() -> None:
    directions = directions_here(100)
    for n_bands in (1, 2, 7):
        coefficients = asymmetric(n_bands)
        wanted = evaluate_basis(directions, n_bands) @ coefficients
        for axes in all_axes():
            value = evaluate_basis(directions @ axes.matrix.T, n_bands) @ turn(coefficients, axes)
            np.testing.assert_allclose(value, wanted, rtol=0, atol=EXACT, err_msg=axes.text)
    assert len({axes.text for axes in all_axes()}) == 48
    assert sum(axes.right_handed for axes in all_axes()) == 24


def test_rotations_are_those_of_the_rotation_module() -> None:
    coefficients = asymmetric(12)
    for text in ("+y+z+x", "+x+z-y", "-x-y+z", "+y-x+z", "+x-y-z"):
        axes = Axes(text)
        np.testing.assert_allclose(turn(coefficients, axes), rotate(coefficients, axes.matrix), rtol=0, atol=1e-13)


def test_turns_about_z_and_mirrors_are_exact_and_zeros_stay_zero() -> None:
    coefficients = asymmetric(9)
    for text in ("-x+y+z", "+x+y-z", "-y+x+z", "+y+x+z", "-x-y-z"):
        axes = Axes(text)
        np.testing.assert_array_equal(turn(turn(coefficients, axes), axes.inverse), coefficients)
    zonal = np.zeros((25, 1))
    zonal[[0, 2, 6, 12, 20]] = 1.0
    assert np.count_nonzero(turn(zonal, Axes("+x+z-y"))) == 1 + 1 + 2 + 2 + 3


def test_64_bands_turn_without_loss() -> None:
    coefficients = asymmetric(64)
    there_and_back = turn(turn(coefficients, Axes("+x+z-y")), Axes("+x+z-y").inverse)
    np.testing.assert_allclose(there_and_back, coefficients, rtol=0, atol=1e-12)


def test_axes_say_which_way_is_up_and_which_hand() -> None:
    assert Axes.named("y-up").words == "x y z are our +x +z -y; y up, right-handed"
    assert Axes.named("z-up-left").words == "x y z are our +x -y +z; z up, left-handed"
    assert [Axes(text).right_handed for text in NAMED_AXES.values()] == [True, True, False, False]
    for text in ("x+z-y", "+x+x-y", "+x+z", "up"):
        with pytest.raises(ValueError, match=r"such as \+x\+z-y"):
            Axes(text)


@pytest.mark.parametrize(
    "text",
    [
        *CONVENTIONS,
        "shviewer,y-up,4pi,no-phase,irradiance",
        "three,z-up-left",
        "shviewer,m-swapped,-z+y+x",
        "shviewer,polynomial",
    ],
)
def test_a_convention_is_its_text(text: str) -> None:
    convention = parse_convention(text)
    assert parse_convention(convention_text(convention)) == convention
    coefficients = asymmetric(3)
    back = convention.to_ours(convention.from_ours(coefficients, "irradiance" if convention.quantity else "radiance"))
    held = "irradiance" if convention.quantity == "irradiance-over-pi" else convention.quantity or "radiance"
    np.testing.assert_allclose(
        to_quantity(back, held, "irradiance" if convention.quantity else "radiance"), coefficients, atol=EXACT
    )


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("blender", "must be one of shviewer, filament"),
        ("three,irradiance", "contradicts three, which takes radiance"),
        ("filament,radiance", "contradicts filament, which takes irradiance-over-pi"),
        ("unreal,no-phase", "not be what that program expects"),
        ("sphericart,4pi", "not be what that program expects"),
        ("shviewer,y-up,z-up", "contradict each other"),
        ("shviewer,sideways", "modifier 'sideways'"),
    ],
)
def test_unknown_and_contradictory_conventions_are_refused(text: str, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        parse_convention(text)


def test_more_bands_than_a_program_has_are_refused() -> None:
    for name in ("filament", "three", "unity", "unreal"):
        with pytest.raises(ValueError, match=rf"4 bands: {name} takes 1 to 3"):
            CONVENTIONS[name].from_ours(asymmetric(4))


def test_programs_that_always_have_three_bands_get_three() -> None:
    for name, rows in {"filament": 4, "three": 9, "unity": 9, "unreal": 9, "ambix": 4}.items():
        numbers = CONVENTIONS[name].from_ours(asymmetric(2))
        assert len(numbers) == rows
        assert not np.any(numbers[4:])


def test_radiance_comes_back_from_irradiance_up_to_the_degree_that_is_lost() -> None:
    coefficients = asymmetric(3)
    np.testing.assert_allclose(
        to_quantity(to_quantity(coefficients, "radiance", "irradiance"), "irradiance", "radiance"), coefficients
    )
    with pytest.raises(ValueError, match="nothing of band 3"):
        to_quantity(asymmetric(4), "irradiance", "radiance")


def test_complex_coefficients_of_no_real_function_are_refused() -> None:
    numbers = CONVENTIONS["scipy"].from_ours(asymmetric(3)).copy()
    numbers[1] *= 2
    with pytest.raises(ValueError, match="not of a real function"):
        CONVENTIONS["scipy"].to_ours(numbers)
