"""What the programs draw, in float32 and in their own axes, and how far that is from what it should be.

Each draws a white sphere from six sides and flat tiles, lit as the guide says, by a file and some lines of code; the tiles lit
by the line that is in the file, too, and by the function of a module; and all once more by a constant light whose one number
is written by hand. Where it can, it shows the lat-long image around the camera, and makes coefficients of the image itself.

What a pixel shows over what it shows under the constant light is the irradiance over pi: with a Lambertian material the pixel
itself, and with one that takes something off, what it would be without that.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from clients.known import HERE, PROGRAMS, Missing, Program, chromium
from clients.light import Array, light_file

import shviewer
from shviewer.cli.main import main
from shviewer.coefficients.parts.axes import Axes, all_axes

SIZE = 128
"""Pixels of a view along each side, as in browser/page.mjs."""
VIEWS = np.array(
    [
        *([(1, 0, 0), (0, 1, 0)], [(-1, 0, 0), (0, 1, 0)], [(0, 1, 0), (0, 0, 1)]),
        *([(0, -1, 0), (0, 0, 1)], [(0, 0, 1), (0, 1, 0)], [(0, 0, -1), (0, 1, 0)]),
    ],
    dtype=float,
)
"""Forward and up of the six cameras, as in browser/page.mjs."""
TILES = 64
CONSTANT = 0.5
"""The irradiance over pi of the constant light."""
DISC = 0.97
"""How far from its middle the sphere is looked at: at its rim a pixel is several degrees wide."""
PATIENCE = 600
"""Seconds for all programs together; on a machine of their own they take about 30."""
NO_BROWSER = 3
"""How run.mjs ends if Chromium does not start."""

Seen = tuple[Array, Array]
"""Directions or normals in a program's axes, (n, 3), and the colours there, (n, 3)."""


def write_job(folder: Path) -> None:
    """What browser/page.mjs asks for: light.hdr, normals.f32, and for each program what the guide says: files and code."""
    (folder / "light.hdr").write_bytes(light_file())
    normals = np.random.default_rng(3).normal(size=(TILES, 3))
    (folder / "normals.f32").write_bytes(
        (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype("<f4").tobytes()
    )
    for name, program in PROGRAMS.items():
        command, lines = program.typed
        (folder / f"{name}-guide.js").write_text(lines, encoding="utf-8")
        meant = {"sky.hdr": str(folder / "light.hdr"), "sky.json": str(folder / f"{name}.json")}
        assert main([*(meant.get(word, word) for word in command), "--force"]) == 0
        asked = f"--bands 3 --convention {program.convention} --force -o".split()
        assert main(["project", str(folder / "light.hdr"), *asked, str(folder / f"{name}-module.js")]) == 0
        constant = [[CONSTANT * program.one] * 3, *[[0.0] * 3] * 8]
        (folder / f"{name}-constant.json").write_text(json.dumps({"coefficients": constant}), encoding="utf-8")


def draw(folder: Path) -> None:
    """Have all programs draw into `folder`; failed.json holds what went wrong in each. Missing if none can be run here."""
    browser = chromium()
    write_job(folder)
    command = ["node", str(HERE / "run.mjs"), str(folder), browser, *PROGRAMS]
    done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
    if done.returncode == NO_BROWSER:
        raise Missing(f"{browser} does not start: {done.stderr.strip().splitlines()[0]}")
    assert done.returncode == 0, done.stderr


@dataclass(frozen=True)
class Drawn:
    """What one program drew."""

    folder: Path
    name: str

    @property
    def program(self) -> Program:
        return PROGRAMS[self.name]

    @property
    def axes(self) -> Axes:
        return self.program.axes

    @property
    def failed(self) -> str:
        return str(json.loads((self.folder / "failed.json").read_text(encoding="utf-8")).get(self.name, ""))

    def has(self, what: str) -> bool:
        return (self.folder / f"{self.name}-{what}").exists()

    def floats(self, what: str) -> Array:
        """Colours as they were drawn, (views, SIZE, SIZE, 3) with rows from below."""
        values = np.fromfile(self.folder / f"{self.name}-{what}.f32", "<f4").astype(np.float64)
        return values.reshape(-1, SIZE, SIZE, 4)[..., :3]

    def sphere(self) -> Seen:
        """Normals, and the irradiance over pi that is shown."""
        toward = -np.sqrt(np.maximum(1 - RIGHT**2 - UP**2, 0))
        normals = self._in_views(RIGHT, UP, toward)[:, ON_SPHERE]
        white = self.floats("constant-sphere")[:, ON_SPHERE] / CONSTANT
        return normals.reshape(-1, 3), (self.floats("light-sphere")[:, ON_SPHERE] / white).reshape(-1, 3)

    def tiles(self, what: str = "light") -> Seen:
        """The same of the tiles, each in its middle. what: "use" or "module" if the lines of a file were typed."""
        normals = np.fromfile(self.folder / "normals.f32", "<f4").astype(np.float64).reshape(-1, 3)
        step = SIZE // round(TILES**0.5)
        at = np.arange(step // 2, SIZE, step)
        shown = self.floats(f"{what}-tiles")[0] / self.floats("constant-tiles")[0] * CONSTANT
        return normals, shown[np.ix_(at, at[:: self.program.hand])].reshape(-1, 3)

    def surroundings(self) -> Seen:
        """Directions, and the radiance that is seen there."""
        directions = self._in_views(RIGHT, UP, np.ones_like(UP)).reshape(-1, 3)
        return directions / np.linalg.norm(directions, axis=1, keepdims=True), self.floats("surroundings").reshape(
            -1, 3
        )

    def white(self, what: str) -> tuple[float, float]:
        """What a material makes of irradiance pi, in the middle of the sphere and on average. what: "constant" for the matt
        one of the pictures, "usual" for the program's physically based one."""
        white = self.floats(f"{what}-sphere") / CONSTANT
        return float(white[:, SIZE // 2, SIZE // 2].mean()), float(white[:, ON_SPHERE].mean())

    def irradiance_over_pi(self, directions: Array) -> Array:
        """In our directions, from the three bands of the Python face."""
        return np.asarray(shviewer.reconstruct(self._coefficients, directions) / np.pi)

    def radiance(self, directions: Array) -> Array:
        return np.asarray(shviewer.find_light(self.folder / "light.hdr").radiance(directions))

    def _in_views(self, right: Array, up: Array, forward: Array) -> Array:
        """Components in a view (SIZE, SIZE) -> vectors in the program's axes, (6, SIZE, SIZE, 3)."""
        ahead, above = VIEWS[:, 0], VIEWS[:, 1]
        aside = self.program.hand * np.cross(ahead, above)
        return np.einsum("kij,kvc->vijc", np.stack([right, up, forward]), np.stack([aside, above, ahead]))

    @cached_property
    def _coefficients(self) -> Array:
        return shviewer.project(self.folder / "light.hdr", 3, quantity="irradiance").coefficients


def by_axes(seen: Seen, wanted: Callable[[Array], Array]) -> dict[str, float]:
    """How far what was seen is from `wanted` of our directions, relative L2, if the program had these axes: all 48."""
    return {axes.text: off(seen[1], wanted(seen[0] @ axes.matrix)) for axes in all_axes()}


def off(shown: Array, wanted: Array) -> float:
    return float(np.linalg.norm(shown - wanted) / np.linalg.norm(wanted))


def _pixels() -> Seen:
    """Right and up of the middle of each pixel, -1 to 1, (SIZE, SIZE) each with rows from below."""
    places = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
    right, up = np.meshgrid(places, places)
    return right, up


RIGHT, UP = _pixels()
ON_SPHERE = RIGHT**2 + UP**2 < DISC**2
