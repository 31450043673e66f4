"""Thirty lists as strangers might send them, each with one to three mistakes, are named exactly or honestly not at all."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.comparing.comparison import agrees, verdict
from shviewer.analysis.comparing.suspecting import FITS
from shviewer.analysis.recipe import Recipe
from shviewer.coefficients.parts.axes import all_axes
from shviewer.coefficients.parts.channels import CHANNEL_ORDERS
from shviewer.coefficients.parts.rows import ORDERS
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.texts import parse_convention
from shviewer.harmonics.basis import Array
from shviewer.lights.find import find_light
from shviewer.lights.light import Light

PROGRAMS = [name for name, one in CONVENTIONS.items() if not one.complex]
SEED = 19


@cache
def light() -> Light:
    return find_light("venice_sunset")


def mistakes(random: np.random.Generator, own: bool) -> dict[str, str]:
    """Kinds of mistakes -> one of each, at random; those of phase, order and normalisation only in our own terms."""
    axes = all_axes()
    found = {
        "axes": axes[random.integers(1, len(axes))].text,
        "factor": f"times={random.choice([2.0, 0.5, np.pi, 1 / np.pi, 255 / 256 * 2, 10.0, 0.8])!r}".replace(
            "np.float64", ""
        ),
        "channels": CHANNEL_ORDERS[random.integers(1, 6)],
        "sequence": "by-channel",
    }
    if own:
        found |= {
            "phase": "no-phase",
            "m": "m-swapped",
            "order": [*ORDERS][random.integers(1, len(ORDERS))],
            "scale": str(random.choice(["4pi", "schmidt", "sn3d"])),
            "quantity": str(random.choice(["irradiance", "irradiance-over-pi", "radiance-over-pi"])),
        }
    return {kind: text.replace("(", "").replace(")", "") for kind, text in found.items()}


def foreign(number: int) -> tuple[str, Array]:
    """The convention of a list, and its numbers as rows."""
    random = np.random.default_rng([SEED, number])
    while True:
        name = "shviewer" if random.random() < 0.5 else PROGRAMS[random.integers(len(PROGRAMS))]
        possible = mistakes(random, name == "shviewer")
        kinds = random.choice(list(possible), size=random.integers(1, 4), replace=False)
        text = ",".join([name, *(possible[kind] for kind in kinds)])
        convention = parse_convention(text)
        n_bands = int(random.integers(3, 6))
        try:
            return text, np.asarray(convention.from_ours(light().coefficients(n_bands)))
        except ValueError:  # more bands than the program or the order has
            continue


def written(numbers: Array, number: int, by_channel: bool) -> tuple[str, str]:
    """The list as a file: its suffix and text, with eight digits or all."""
    digits = [[float(f"{value:.8g}") if number % 2 else value for value in row] for row in numbers.tolist()]
    if by_channel:
        flat = np.array(digits).T.ravel().tolist()
        return ".txt", " ".join(map(repr, flat))
    if number % 3 == 0:
        return ".json", json.dumps(digits)
    if number % 3 == 1:
        return ".txt", ", ".join(repr(value) for row in digits for value in row)
    return ".h", "{" + "},\n{".join(", ".join(map(repr, row)) for row in digits) + "}"


@pytest.mark.parametrize("number", range(30))
def test_a_foreign_list_is_named_exactly(number: int, tmp_path: Path) -> None:
    text, numbers = foreign(number)
    suffix, content = written(numbers, number, "by-channel" in text)
    path = tmp_path / f"foreign{suffix}"
    path.write_text(content)
    recipe, said = compared_with(Recipe(light()), str(path))
    assert recipe.compare is not None
    agreement = verdict(light(), recipe.compare)
    assert agrees(agreement), (text, said)
    assert "agrees with the light's own to 0.0001 %" in agreement or "all of it a factor" in agreement, (text, said)
    own = light().coefficients(recipe.compare.n_bands)
    kept = [l for l in range(recipe.compare.n_bands) if recipe.compare.quantity == "radiance" or l < 2 or l % 2 == 0]
    for l in kept:
        rows = slice(l * l, (l + 1) ** 2)
        np.testing.assert_allclose(recipe.compare.given[rows], own[rows], rtol=0, atol=FITS * np.abs(own).max())


@pytest.mark.parametrize("number", range(12))
def test_a_list_with_a_mistake_that_has_no_name_is_honestly_not_named(number: int, tmp_path: Path) -> None:
    """Bands are of another light, or rows are exchanged or negated, too many of them for their own sake to be told."""
    random = np.random.default_rng([SEED, 100 + number])
    _, numbers = foreign(number)
    bad = numbers[: 9 if len(numbers) > 9 else len(numbers)].copy()
    spoiled = random.permutation(len(bad)) if number % 3 == 0 else np.arange(len(bad))
    bad = bad[spoiled]
    if number % 3 == 1:
        bad *= random.choice([-1.0, 1.0], size=(len(bad), 1))
        bad[[1, 5]] *= -1
    if number % 3 == 2:
        bad[1:] = random.normal(size=bad[1:].shape) * np.linalg.norm(bad[1:]) / np.sqrt(bad[1:].size)
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(bad.tolist()))
    recipe, said = compared_with(Recipe(light()), str(path))
    assert recipe.compare is not None
    if re.search(r": --convention \S+$", said):  # then it is true
        agreement = verdict(light(), recipe.compare)
        slips = re.search(r"fits, if (rows? .*): --convention", said)
        assert agrees(agreement) or " is nearest, " in said or (slips and f"not at all if {slips[1]}" in agreement)
    else:
        assert "no usual one fits; read as" in said
        assert "which no usual mistake explains" in verdict(light(), recipe.compare)
