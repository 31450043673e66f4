"""Each program's own evaluator makes of our converted coefficients what they are of, and its coefficients become ours."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

import numpy as np
import pytest
from coefficients import peer_evaluators as peers
from coefficients.peer_cases import EXACT, OF_IRRADIANCE, PEERS, SHADED, A, asymmetric, directions_here, theirs
from numpy.typing import NDArray
from places import DATA

from shviewer.coefficients.parts.axes import NAMED_AXES, Axes, all_axes, turn
from shviewer.coefficients.parts.quantities import to_quantity
from shviewer.coefficients.parts.rows import ORDERS, row_order
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.texts import convention_text, in_our_terms, parse_convention
from shviewer.harmonics.basis import Array, evaluate_basis
from shviewer.harmonics.quadrature import gauss_legendre


def shaded(name: str, radiance: Array) -> Array:
    """Coefficients of what the program's evaluator gives for a light with these of the radiance."""
    return radiance * A / np.pi if name in SHADED else radiance


@pytest.mark.parametrize("name", PEERS)
def test_the_program_evaluates_our_export_to_the_same_function(name: str) -> None:
    evaluator, n_bands = PEERS[name]
    coefficients, directions = asymmetric(n_bands), directions_here()
    numbers = CONVENTIONS[name].from_ours(coefficients)
    wanted = evaluate_basis(directions, n_bands) @ shaded(name, coefficients)
    np.testing.assert_allclose(evaluator(numbers, theirs(name, directions)), wanted, rtol=0, atol=EXACT)


@pytest.mark.parametrize("name", PEERS)
def test_coefficients_of_the_program_become_ours(name: str) -> None:
    evaluator, n_bands = PEERS[name]
    numbers: NDArray[np.generic] = asymmetric(n_bands)
    if name == "scipy":
        numbers = CONVENTIONS[name].from_ours(asymmetric(n_bands)[::-1].copy())
    directions = directions_here()
    ours = CONVENTIONS[name].to_ours(numbers)
    ours = ours / np.pi if name in OF_IRRADIANCE else shaded(name, ours)
    found = evaluate_basis(directions, n_bands) @ ours
    np.testing.assert_allclose(found, evaluator(numbers, theirs(name, directions)), rtol=0, atol=10 * EXACT)


@pytest.mark.parametrize("name", ["filament", "three", "unity", "unreal", "sphericart", "playcanvas", "cesium"])
def test_a_projection_made_with_the_programs_own_functions_is_the_one_we_write(name: str) -> None:
    """Integrals over the program's directions of the function times the program's functions, one by one."""
    evaluator, n_bands = PEERS[name]
    rule = gauss_legendre(2 * (n_bands + 1) ** 2).direction_set()
    coefficients = asymmetric(n_bands)
    ours = evaluate_basis(rule.directions, n_bands) @ coefficients
    basis = evaluator(np.eye(n_bands**2), theirs(name, rule.directions))
    gram = basis.T @ (rule.weights[:, None] * basis)
    projected = np.linalg.solve(gram, basis.T @ (rule.weights[:, None] * ours))
    if name in OF_IRRADIANCE:  # rows of band l are within band l in every order
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


@cache
def values_of_programs() -> dict[str, Any]:
    return dict(json.loads((DATA / "peer_values.json").read_text()))


@pytest.mark.parametrize("name", ["directxmath", "e3nn", "mitsuba", "spharpy"])
def test_the_values_that_the_program_itself_gave_sum_up_to_the_function(name: str) -> None:
    """peer_values.py ran the programs: DirectXMath in float32, the others to the ten digits that are kept."""
    values = np.array(values_of_programs()["programs"][name]["values"])
    there = np.array(values_of_programs()["directions"])
    coefficients, n_bands = asymmetric(6), 6
    here = there @ CONVENTIONS[name].axes.matrix  # the inverse of ours to theirs
    np.testing.assert_allclose(theirs(name, here), there, rtol=0, atol=1e-15)
    wanted = evaluate_basis(here, n_bands) @ coefficients
    found = values @ np.asarray(CONVENTIONS[name].from_ours(coefficients))
    tolerance = 2e-6 if name == "directxmath" else 1e-9  # of sums of 36 products, the largest of which are near 1
    np.testing.assert_allclose(found, wanted, rtol=0, atol=tolerance)


def test_e3nn_has_its_pole_along_y_and_its_first_degree_is_x_y_z() -> None:
    convention = parse_convention("shviewer,no-phase,+z+x+y")
    np.testing.assert_array_equal(convention.from_ours(asymmetric(4)), CONVENTIONS["e3nn"].from_ours(asymmetric(4)))
    rows = np.asarray(CONVENTIONS["e3nn"].from_ours(CONVENTIONS["shviewer"].to_ours(np.eye(4))))
    by_axis = [np.linalg.solve(rows, np.eye(4))[:, i] for i in (1, 2, 3)]  # our coefficients of its l = 1
    directions = directions_here(20)
    found = evaluate_basis(directions, 2) @ np.stack(by_axis, axis=1)
    np.testing.assert_allclose(found, directions * np.sqrt(3 / (4 * np.pi)), rtol=0, atol=1e-15)
    for_a_client = parse_convention("shviewer,no-phase,-y+x+z")
    np.testing.assert_allclose(
        parse_convention("e3nn,y-up").from_ours(asymmetric(4)), for_a_client.from_ours(asymmetric(4)), atol=1e-15
    )


def test_live_packages_evaluate_what_we_write_for_them() -> None:
    """Mitsuba with all of its bands, and spharpy, where they are installed."""
    drjit = pytest.importorskip("drjit", reason="Dr.Jit is not installed: pip install mitsuba")
    mitsuba = pytest.importorskip("mitsuba", reason="Mitsuba is not installed: pip install mitsuba")
    mitsuba.set_variant("scalar_rgb")
    directions, coefficients = directions_here(5), asymmetric(10)
    there = theirs("mitsuba", directions)
    basis = np.array([[float(v) for v in drjit.sh_eval(mitsuba.Vector3d(*row), 9)] for row in there.tolist()])
    found = basis @ np.asarray(CONVENTIONS["mitsuba"].from_ours(coefficients))
    np.testing.assert_allclose(found, evaluate_basis(directions, 10) @ coefficients, rtol=0, atol=1e-12)


def test_spharpy_evaluates_what_we_write_for_it_and_its_fuma_is_the_inverse() -> None:
    spharpy = pytest.importorskip("spharpy", reason="spharpy is not installed: pip install spharpy")
    from pyfar import Coordinates

    directions, coefficients = directions_here(50), asymmetric(8)
    basis = np.real(spharpy.SphericalHarmonics(7, Coordinates(*directions.T)).basis)
    found = basis @ np.asarray(CONVENTIONS["spharpy"].from_ours(coefficients))
    np.testing.assert_allclose(found, evaluate_basis(directions, 8) @ coefficients, rtol=0, atol=EXACT)
    n, m = np.array([(l, m) for l in range(4) for m in range(-l, l + 1)]).T
    channel = np.asarray(spharpy.spherical.nm_to_fuma(n, m)).astype(int)
    np.testing.assert_array_equal(row_order("order-fuma-inverse", 4), np.argsort(channel))


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("order-playcanvas", "1 x y z xz yz xy zz xx"),
        ("order-xyz", "1 x y z xy xz yz xx zz"),
        ("order-alternating", "1 z x y zz xz yz xx xy"),
        ("order-2001", "1 y z x xz yz xy zz xx"),
        ("order-cilm", "1 z x y zz xz xx yz xy"),
        ("order-m-major", "1 z zz x xz y yz xx xy"),
        ("order-m-rising", "xy y yz 1 z zz x xz xx"),
        ("order-fuma", "1 x y z zz xz yz xx xy"),
    ],
)
def test_an_order_of_rows_is_that_of_the_sources_functions(name: str, wanted: str) -> None:
    """zz is 3z^2-1 and xx is x^2-y^2, as the sources that parts/rows.py names have them one after the other."""
    ours = ["1", "y", "z", "x", "xy", "yz", "zz", "xz", "xx"]
    assert " ".join(ours[index] for index in row_order(name, 3)) == wanted
    numbers = np.asarray(parse_convention(f"shviewer,{name}").from_ours(asymmetric(3)))
    np.testing.assert_array_equal(numbers, asymmetric(3)[row_order(name, 3)])
    np.testing.assert_array_equal(parse_convention(f"shviewer,{name}").to_ours(numbers), asymmetric(3))


def test_orders_of_any_length_are_permutations_and_others_say_where_they_end() -> None:
    most = {"order-playcanvas": 3, "order-xyz": 3, "order-2001": 3, "order-fuma": 4, "order-fuma-inverse": 4}
    for name in ORDERS:
        for n_bands in range(1, most.get(name, 7) + 1):
            assert sorted(row_order(name, n_bands)) == list(range(n_bands**2))
        if name in most:
            with pytest.raises(
                ValueError, match=rf"{name}, {most[name] + 1} bands: it is defined for 1 to {most[name]}"
            ):
                row_order(name, most[name] + 1)
    pyshtools = pytest.importorskip("pyshtools")
    cilm = np.arange(2 * 36.0).reshape(2, 6, 6)
    index = [int(cilm[int(m < 0), l, abs(m)]) for l in range(6) for m in range(-l, l + 1)]
    vector = pyshtools.shio.SHCilmToVector(cilm)
    np.testing.assert_array_equal(np.array(index)[row_order("order-cilm", 6)], vector)


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
    found = look_up(*(ours @ CONVENTIONS[name].axes.matrix.T).T)
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


def test_turns_about_z_and_mirrors_are_exact_and_zeros_stay_zero() -> None:
    coefficients = asymmetric(9)
    for text in ("-x+y+z", "+x+y-z", "-y+x+z", "+y+x+z", "-x-y-z"):
        axes = Axes(text)
        np.testing.assert_array_equal(turn(turn(coefficients, axes), axes.inverse), coefficients)
    zonal = np.zeros((25, 1))
    zonal[[0, 2, 6, 12, 20]] = 1.0
    assert np.count_nonzero(turn(zonal, Axes("+x+z-y"))) == 1 + 1 + 2 + 2 + 3


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
        "shviewer,polynomial,order-xyz,radiance-over-pi",
        "shviewer,shifted,schmidt,order-m-major",
        "shviewer,fuma,m-swapped,order-fuma-inverse",
        "e3nn,y-up",
    ],
)
def test_a_convention_is_its_text(text: str) -> None:
    convention = parse_convention(text)
    assert parse_convention(convention_text(convention)) == convention
    coefficients = asymmetric(3)
    back = convention.to_ours(convention.from_ours(coefficients, "irradiance" if convention.quantity else "radiance"))
    held = (convention.quantity or "radiance").removesuffix("-over-pi")
    np.testing.assert_allclose(
        to_quantity(back, held, "irradiance" if convention.quantity else "radiance"), coefficients, atol=EXACT
    )
    if not convention.complex:
        numbers = convention.from_ours(coefficients)
        ours = parse_convention(in_our_terms(convention)).to_ours(numbers)
        np.testing.assert_allclose(ours, convention.to_ours(numbers), rtol=0, atol=EXACT)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("blender", "must be one of shviewer, filament"),
        ("webxr", "nobody documents its phase; name a reading, webxr-phase or webxr-no-phase"),
        ("playcanvas,order-fuma", "so are shviewer,[+]y[+]z[+]x,polynomial,order-fuma,irradiance-over-pi"),
        ("three,order-cilm", "order-cilm contradicts three"),
        ("e3nn,phase", "so are shviewer,[+]z[+]x[+]y"),
        ("three,shifted", "shifted contradicts three"),
        ("shviewer,order-cilm,order-fuma", "contradict each other"),
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
    three_bands = (
        "filament",
        "three",
        "unity",
        "unreal",
        "babylon",
        "playcanvas",
        "cesium",
        "gltf",
        "godot",
        "webxr-phase",
    )
    for name, most in {
        **dict.fromkeys(three_bands, 3),
        "3dgs": 4,
        "fuma": 4,
        "directxmath": 6,
        "mitsuba": 10,
        "e3nn": 13,
    }.items():
        with pytest.raises(ValueError, match=rf"{most + 1} bands: {name} takes 1 to {most}"):
            CONVENTIONS[name].from_ours(asymmetric(most + 1))


def test_programs_that_always_have_three_bands_get_three() -> None:
    for name, rows in {"filament": 4, "three": 9, "unity": 9, "unreal": 9, "ambix": 4, "babylon": 9, "3dgs": 4}.items():
        numbers = CONVENTIONS[name].from_ours(asymmetric(2))
        assert len(numbers) == rows
        assert not np.any(numbers[4:])
    assert len(CONVENTIONS["directxmath"].from_ours(asymmetric(1))) == 4


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
