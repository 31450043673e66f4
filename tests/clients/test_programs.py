"""Real programs, lit by files that are written here, show what the Python face says. browser/programs/ are what they run.

Skipped with the reason where Node.js, Chromium or the packages are missing: nothing of the product needs them.
"""

from __future__ import annotations

import os
import re

import numpy as np
import pytest
from clients.drawing import Drawn, by_axes, draw, off
from clients.known import PROGRAMS, Missing
from clients.measured import MEASURED, own_projection, stated

from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.texts import parse_convention

LIT = 2e-3
"""On the sphere: its triangles, and the places of its pixels."""
FLAT = 1e-5
"""On tiles whose pixels have one normal: float32."""
OTHERWISE = 0.1
"""No other axes come as near as this; the light was chosen so."""
SHOWN = 0.012
"""The error of a lat-long image: looked up without interpolation, or kept in 8 bits."""

programs = pytest.mark.parametrize("name", PROGRAMS)


@pytest.fixture(scope="session")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Drawn]:
    """What the programs draw; they run once, for all processes of the test run."""
    fcntl = pytest.importorskip("fcntl", reason="the programs are run where files can be locked")
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if os.environ.get("PYTEST_XDIST_WORKER") else base) / "clients"
    folder.mkdir(exist_ok=True)
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "failed.json").exists():
            try:
                draw(folder)
            except Missing as missing:
                pytest.skip(str(missing))
    return {name: Drawn(folder, name) for name in PROGRAMS}


@pytest.fixture
def program(name: str, drawn: dict[str, Drawn]) -> Drawn:
    if drawn[name].failed:
        pytest.fail(drawn[name].failed)
    return drawn[name]


@programs
def test_a_white_sphere_shows_the_irradiance_over_pi_in_our_axes_and_no_others(program: Drawn) -> None:
    errors = by_axes(program.sphere(), program.irradiance_over_pi)
    assert errors.pop(program.axes.text) <= LIT
    assert min(errors.values()) > OTHERWISE


@programs
def test_flat_tiles_show_the_numbers_themselves(program: Drawn) -> None:
    errors = by_axes(program.tiles(), program.irradiance_over_pi)
    assert errors.pop(program.axes.text) <= FLAT
    assert min(errors.values()) > OTHERWISE


@programs
@pytest.mark.parametrize("what", ["use", "module"])
def test_the_line_in_the_file_and_the_function_of_a_module_do_what_the_guide_says(program: Drawn, what: str) -> None:
    normals, colours = program.tiles(what)
    assert off(colours, program.irradiance_over_pi(normals @ program.axes.matrix)) <= FLAT


@pytest.mark.parametrize("name", [name for name in PROGRAMS if MEASURED[name].surroundings])
def test_a_lat_long_image_is_seen_where_its_coefficients_light(program: Drawn) -> None:
    directions, colours = program.surroundings()
    factor = np.median(colours / program.radiance(directions @ program.axes.matrix))
    errors = by_axes((directions, colours / factor), program.radiance)
    assert errors.pop(program.axes.text) <= SHOWN
    assert min(errors.values()) > OTHERWISE


@programs
def test_a_light_of_one_number_is_shown_as_that_number(program: Drawn) -> None:
    """Absolutely: it is what the light is measured by. Filament and Cesium have no material that takes nothing off."""
    middle, mean = program.white("constant")
    if program.program.matt:
        assert [middle, mean] == pytest.approx([1, 1], abs=FLAT)
    else:
        assert 0.97 < mean < middle < 1


@programs
def test_what_is_stated_of_a_program_is_measured_again(program: Drawn) -> None:
    """The guide's table. How far a sphere is off is geometry; below 1e-5 it is the last digits of float32."""
    found, said = stated(program), MEASURED[program.name]
    assert found.version == said.version, "python tests/clients/measure.py writes it anew"
    assert found.sphere == pytest.approx(said.sphere, rel=0.1)
    assert found.white == pytest.approx(said.white, abs=1e-3)
    assert [found.surroundings, found.factor] == [
        value and pytest.approx(value, rel=rel) for value, rel in ((said.surroundings, 0.1), (said.factor, 1e-3))
    ]


@pytest.mark.parametrize("name", [name for name in PROGRAMS if MEASURED[name].own])
def test_what_a_program_projects_itself_is_known_with_its_convention_and_without(program: Drawn) -> None:
    wanted = CONVENTIONS[program.program.convention]
    said, verdict = own_projection(program, program.program.convention)
    assert verdict == MEASURED[program.name].own
    said, again = own_projection(program, "")
    found = re.fullmatch(r"\S+ does not name its convention: (\S+) fits", said)
    assert found is not None, said
    numbers = np.random.default_rng(5).normal(size=(9, 3))
    assert off(parse_convention(found[1]).from_ours(numbers), wanted.from_ours(numbers)) < 1e-12
    assert again == verdict


@pytest.mark.parametrize("name", ["three", "playcanvas"])
def test_radiance_files_are_shown_brighter_by_256_over_255(program: Drawn) -> None:
    """These divide by 255 where the format says 256; PlayCanvas then keeps 8 bits. It is no fault of the file written here."""
    assert stated(program).factor == pytest.approx(256 / 255, abs=3e-4)
