"""The programs that are run here, and whether they can be."""

from __future__ import annotations

import json
import math
import os
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from documents import code_blocks, commands, page

from shviewer.coefficients.parts.axes import Axes
from shviewer.coefficients.programs import CONVENTIONS

HERE = Path(__file__).parent
MODULES = HERE / "node_modules"


@dataclass(frozen=True)
class Program:
    """A program that is run here; browser/programs/ says how."""

    called: str
    package: str
    """Its name on npm."""
    convention: str
    """The name that `shviewer project --convention` is given."""
    one: float
    """Row 0 of a light of irradiance pi, after the program's own sources: what its numbers are measured by."""
    section: str = ""
    """Where the guide says what to type, if it is not what the program is called."""
    hand: int = 1
    """1 if its axes are right-handed, -1 if left-handed: which way is right in a picture of it."""
    matt: bool = True
    """Whether it has a material that shows the irradiance over pi and nothing else."""
    turned: str = ""
    """The axes in which it shows the light, if they are not the convention's."""

    @property
    def axes(self) -> Axes:
        return Axes(self.turned) if self.turned else CONVENTIONS[self.convention].axes

    @property
    def typed(self) -> tuple[list[str], str]:
        """What the guide says to type: the arguments of shviewer, and the lines of JavaScript."""
        (section,) = re.findall(
            rf"^## {re.escape(self.section or self.called)}\n(.*?)(?=^## |\Z)", page("programs"), re.M | re.S
        )
        (command,), (lines,) = commands(section), code_blocks(section, "js")
        return command, lines

    @property
    def version(self) -> str:
        """The one that is installed."""
        package = json.loads((MODULES / self.package / "package.json").read_text(encoding="utf-8"))
        return str(package["version"])


ROOT = math.sqrt(4 * math.pi)
"""1 over Y(0,0)."""
PROGRAMS = {
    "three": Program("three.js", "three", "three", ROOT),
    "babylon": Program("Babylon.js", "babylonjs", "babylon", ROOT, hand=-1),
    "babylon-right": Program(
        "Babylon.js, right-handed", "babylonjs", "babylon", ROOT, section="Babylon.js", turned="-y+z-x"
    ),
    "gltf": Program("glTF in Babylon.js", "babylonjs-loaders", "gltf", math.pi * ROOT, hand=-1),
    "filament": Program("Filament", "filament", "filament", 1.0, matt=False),
    "playcanvas": Program("PlayCanvas", "playcanvas", "playcanvas", 1.0),
    "cesium": Program("Cesium", "cesium", "cesium", 1.0, matt=False),
}
"""By the names of their files in browser/programs/."""


class Missing(Exception):
    """The programs cannot be run on this machine; why, and what to do."""


def chromium() -> str:
    """The path of the browser. Missing if anything that the programs need is not there."""
    found = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
    if found is None or shutil.which("node") is None:
        raise Missing("the programs need Node.js and Chromium: apt-get install nodejs npm chromium")
    packages = ["playwright-core", "playcanvas-1", *(program.package for program in PROGRAMS.values())]
    absent = [name for name in packages if not (MODULES / name).is_dir()]
    if absent:
        raise Missing(f"{absent[0]} is not installed: npm ci --prefix tests/clients")
    return found
