"""What was measured of each program, kept in measured.json, and the guide's table of it: python tests/clients/measure.py"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

import numpy as np
from clients.drawing import Drawn, by_axes
from clients.known import HERE, PROGRAMS

from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.comparing.comparison import verdict
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light
from shviewer.lights.reading import Reading

FILE = HERE / "measured.json"


@dataclass(frozen=True)
class Measured:
    """The numbers of one program; None where it cannot show that."""

    version: str
    sphere: float
    """Relative L2 of a lit white sphere."""
    tiles: float
    """The same of flat tiles."""
    white: tuple[float, float]
    """What its physically based white makes of irradiance pi, in the middle of a sphere and on average."""
    surroundings: float | None = None
    """Relative L2 of a lat-long image around the camera, but for a factor."""
    factor: float | None = None
    """That factor: what is shown over what the file holds."""
    own: str = ""
    """What --compare says of the program's own projection of the image."""


def stated(drawn: Drawn) -> Measured:
    """What is to be said of a program that has drawn."""
    axes = drawn.axes.text
    surroundings = factor = None
    if drawn.has("surroundings.f32"):
        directions, colours = drawn.surroundings()
        wanted = drawn.radiance(directions @ drawn.axes.matrix)
        factor = float(np.median(colours / wanted))
        surroundings = by_axes((directions, colours / factor), drawn.radiance)[axes]
    return Measured(
        drawn.program.version,
        by_axes(drawn.sphere(), drawn.irradiance_over_pi)[axes],
        by_axes(drawn.tiles(), drawn.irradiance_over_pi)[axes],
        drawn.white("usual" if drawn.has("usual-sphere.f32") else "constant"),
        surroundings,
        factor,
        own_projection(drawn, drawn.program.convention)[1] if drawn.has("own.json") else "",
    )


def own_projection(drawn: Drawn, convention: str) -> tuple[str, str]:
    """What is said of coefficients that the program made of the image itself: on their convention, and how well they agree."""
    recipe = Recipe(str(drawn.folder / "light.hdr"), reading=Reading(convention=convention))
    recipe, said = compared_with(recipe, str(drawn.folder / f"{drawn.name}-own.json"))
    assert recipe.compare is not None
    return said, verdict(load_light(recipe), recipe.compare)


def read() -> dict[str, Measured]:
    rows = json.loads(FILE.read_text(encoding="utf-8"))
    return {name: Measured(**{**row, "white": tuple(row["white"])}) for name, row in rows.items()}


def write(found: dict[str, Measured]) -> None:
    """With four digits: the others are the machine's."""
    rows = {name: {key: _rounded(value) for key, value in asdict(row).items()} for name, row in found.items()}
    FILE.write_text(json.dumps(rows, indent=2) + "\n", encoding="utf-8")


def _rounded(value: object) -> object:
    if isinstance(value, tuple):
        return [_rounded(part) for part in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


MEASURED = read() if FILE.exists() else {}


def percent(share: float) -> str:
    return f"{100 * share:.2g} %"


def rendered(name: str) -> str:
    """The cell of a convention in the guide: how far a sphere that the program lights is off."""
    return percent(MEASURED[name].sphere) if name in MEASURED else "-"


def table() -> str:
    """What the guide says of each program that is run."""
    head = "| program | `--convention` | lit sphere, off by | its physically based white shows | a lat-long image, off by | "
    lines = ["", f"{head}what it projects itself |", "|---|---|---|---|---|---|"]
    for name, row in MEASURED.items():
        seen = "not shown" if row.surroundings is None else percent(row.surroundings)
        own = row.own.partition(" to ")[2].replace(" over its 3 bands", "")
        white = "{:.3f} in the middle, {:.3f} on average".format(*row.white)
        cells = (
            f"{PROGRAMS[name].called} {row.version}",
            f"`{PROGRAMS[name].convention}`",
            percent(row.sphere),
            white,
            seen,
            own or "-",
        )
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join([*lines, "", ""])
