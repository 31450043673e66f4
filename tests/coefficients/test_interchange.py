"""A file written here is the same radiance in each program's own evaluator, and that program's file is it here."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from coefficients import peer_evaluators as peers
from coefficients.peer_cases import EXACT, OF_IRRADIANCE, PEERS, SHADED, asymmetric, directions_here, theirs

from shviewer.analysis.projected import Projected, project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.writing import FORMATS
from shviewer.harmonics.basis import Array
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading


def given(n_bands: int) -> CoefficientLight:
    return CoefficientLight(asymmetric(n_bands), "given")


def projected(name: str, n_bands: int) -> Projected:
    quantity = "irradiance" if name in OF_IRRADIANCE else "radiance"
    return project_recipe(Recipe(given(n_bands), n_bands=n_bands, quantity=quantity))


def held(name: str, light: CoefficientLight, directions: Array) -> Array:
    """What the program makes of its numbers."""
    if name not in SHADED:
        return light.radiance(directions)
    return load_light(Recipe(light, quantity="irradiance")).radiance(directions) / np.pi


def numbers_of_json(data: bytes) -> peers.Numbers:
    return np.array(json.loads(data)["coefficients"])


def numbers_of_csv(data: bytes) -> peers.Numbers:
    lines = [line for line in data.decode().splitlines() if not line.startswith("#")]
    return np.array([[float(cell) for cell in row[2:]] for row in csv.reader(lines[1:])])


@pytest.mark.parametrize("name", PEERS)
@pytest.mark.parametrize(("kind", "read"), [("json", numbers_of_json), ("csv", numbers_of_csv)])
def test_a_file_written_here_is_the_same_radiance_there(name: str, kind: str, read: object) -> None:
    evaluator, n_bands = PEERS[name]
    directions = directions_here()
    numbers = read(projected(name, n_bands).encode(CONVENTIONS[name], kind))
    if name == "scipy":
        numbers = numbers[:, 0::2] + 1j * numbers[:, 1::2]
    wanted = held(name, given(n_bands), directions)
    np.testing.assert_allclose(evaluator(numbers, theirs(name, directions)), wanted, rtol=0, atol=EXACT)


def as_the_program_keeps_them(name: str, numbers: peers.Numbers) -> tuple[str, str]:
    """Suffix and text of a bare list, in the form in which people have it."""
    if name == "filament":  # cmgen's sh.txt
        rows = (
            f"({r!r}, {g!r}, {b!r}); // L{i}, irradiance, pre-scaled base"
            for i, (r, g, b) in enumerate(numbers.tolist())
        )
        return ".txt", "\n".join(rows)
    if name == "three":  # SphericalHarmonics3.toArray
        return ".json", json.dumps(numbers.ravel().tolist())
    if name in ("unity", "unreal", "directxmath"):  # one list per channel
        return ".json", json.dumps(numbers.T.tolist())
    if name == "scipy":
        return ".csv", "\n".join(",".join(f"{v.real!r},{v.imag!r}" for v in row) for row in numbers.tolist())
    return ".csv", "\n".join(",".join(map(repr, row)) for row in numbers.tolist())


@pytest.mark.parametrize("name", PEERS)
def test_a_file_of_the_program_is_the_same_radiance_here(name: str, tmp_path: Path) -> None:
    evaluator, n_bands = PEERS[name]
    numbers: peers.Numbers = asymmetric(n_bands)
    if name == "scipy":
        numbers = np.asarray(CONVENTIONS[name].from_ours(asymmetric(n_bands)[::-1].copy()))
    suffix, text = as_the_program_keeps_them(name, numbers)
    path = tmp_path / f"theirs{suffix}"
    path.write_text(text)
    light = find_light(str(path), Reading(convention=name))
    assert isinstance(light, CoefficientLight)
    directions = directions_here()
    wanted = evaluator(numbers, theirs(name, directions))
    np.testing.assert_allclose(held(name, light, directions), wanted, rtol=0, atol=20 * EXACT)


def test_our_own_numbers_survive_every_program_and_every_format(tmp_path: Path) -> None:
    for name, convention in CONVENTIONS.items():
        for kind in FORMATS:
            if name == "scipy" and kind in ("glsl", "hlsl"):
                continue
            path = tmp_path / f"{name}.{kind}"
            path.write_bytes(projected(name, 3).encode(convention, kind))
            light = find_light(str(path))
            assert isinstance(light, CoefficientLight)
            assert light.file is not None
            quantity = "irradiance" if name in OF_IRRADIANCE else "radiance"
            written = convention.from_ours(projected(name, 3).coefficients, quantity)
            np.testing.assert_array_equal(light.file.numbers, written)  # not one digit is lost
            np.testing.assert_allclose(light.given, asymmetric(3), rtol=0, atol=1e-14)
            assert (light.convention, light.quantity) == (name, quantity)
