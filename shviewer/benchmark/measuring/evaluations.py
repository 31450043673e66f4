"""The ways to evaluate the sum of one light's first n bands: their works, to be timed, and the error of their arithmetic.

`Evaluations` has those on the CPU, `ShaderFrame` those in the shader, summed directly or drawn from a map.
"""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np
from numpy.typing import NDArray

from shviewer.benchmark.hard_cases.evaluation import towards
from shviewer.benchmark.hard_cases.shader import in_blocks, normals_on
from shviewer.benchmark.measuring.measured_lights import MeasuredLight
from shviewer.benchmark.measuring.timing import Work
from shviewer.harmonics.basis import Array, evaluate_basis, normalise
from shviewer.harmonics.synthesis import Synthesis
from shviewer.limits import MAX_DIRECT_BANDS
from shviewer.viewer import camera
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.drawn import DirectSum, SplineMap
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.screenshot import render_linear
from shviewer.viewer.state import state_of

FRAME = compose(1280, 640)
MAP_SIZE = (1025, 2048)
"""Height and width of the maps that the CPU makes, and the largest that the shader draws from."""

SEEN_FROM = (78.0, 22.0)
"""Azimuth and elevation of the camera, degrees."""

DIRECT, CACHED = "shader, direct sum", "shader, cached map"
SCATTERED, BASIS = "CPU, scattered", "CPU, basis matrix"
MAP_64, MAP_32 = "CPU, map float64", "CPU, map float32"
CPU = (SCATTERED, BASIS, MAP_64, MAP_32)
MAKING = "making the map"
"""The set-up of CACHED, uploading included; it has no row of its own."""

PER_FRAME = "per frame of 1280 x 640, both spheres"
PER_MILLION = "per million directions"

STRIDE = 4
"""Every fourth pixel of every fourth row is compared: 9 000 directions a camera."""

MOST_DIRECTIONS, MOST_VALUES = 32_768, 2**20
"""The most directions, and the most values of their basis, in one timed run on the CPU."""

CHECKED = 512
"""The number of directions in which Synthesis is compared with the basis matrix."""

SEED = 20_240_602


def shader_methods(n_bands: int) -> tuple[str, ...]:
    return (CACHED, DIRECT) if n_bands <= MAX_DIRECT_BANDS else (CACHED,)


class Evaluations:
    """One light with one band count: its evaluations on the CPU and their errors."""

    def __init__(self, measured: MeasuredLight, n_bands: int) -> None:
        picture = prepare(state_of(measured.light, n_bands=n_bands))
        light = measured.light
        self.n_bands = n_bands
        self.light_name = measured.name
        self.coefficients = picture.coefficients
        self.direct = replace(picture, drawn=DirectSum(picture.coefficients), light_from_world=np.eye(3))
        self.synthesis = Synthesis(picture.coefficients)
        self.left_out = float(measured.left_out[n_bands - 1])
        self.rms = float(np.sqrt(np.trace(light.products()) / (4 * np.pi)))
        count = min(MOST_DIRECTIONS, MOST_VALUES // self.n_bands**2)
        self.directions = normalise(np.random.default_rng(SEED).normal(size=(count, 3)))

    def map(self) -> NDArray[np.float32]:
        return self.synthesis.pole_to_pole(*MAP_SIZE)

    def on_a_map(self) -> Picture:
        """The picture drawn from a map, however few bands it has."""
        return replace(self.direct, drawn=SplineMap(self.synthesis.spline_map(*MAP_SIZE)))

    def rows_of_map(self) -> Array:
        return self.synthesis.on_rows(np.linspace(0, np.pi, MAP_SIZE[0]), MAP_SIZE[1])

    def sum_at(self, directions: Array) -> Array:
        """The sum by Synthesis, in blocks: directions (k, 3) -> (k, 3)."""
        return in_blocks(self.synthesis.in_directions, directions)

    def sum_by_basis(self, directions: Array) -> Array:
        return in_blocks(lambda part: evaluate_basis(part, self.n_bands) @ self.coefficients, directions)

    def relative(self, mean_square: float) -> float:
        """The norm of an error, from its mean square, over the light's; infinite if a black light is not drawn black."""
        return float(np.sqrt(mean_square)) / self.rms if self.rms else 0.0 if mean_square == 0 else float("inf")

    def errors(self) -> dict[str, float | None]:
        """Method -> error against the basis matrix in float64, which has none itself."""
        some = self.directions[:CHECKED]
        scattered = ((self.sum_at(some) - self.sum_by_basis(some)) ** 2).sum(axis=1).mean()
        theta, exact = np.linspace(0, np.pi, MAP_SIZE[0]), self.rows_of_map().transpose(0, 2, 1)
        difference = ((self.map() - exact) ** 2).sum(axis=2).mean(axis=1)
        on_map = float(np.sin(theta) @ difference / np.sin(theta).sum())
        return {
            SCATTERED: self.relative(scattered),
            BASIS: None,
            MAP_64: self.relative(self._texel_error(exact)),
            MAP_32: self.relative(on_map),
        }

    def _texel_error(self, exact: Array) -> float:
        """The mean square error over CHECKED random texels, whose rows are drawn in proportion to solid angle."""
        random = np.random.default_rng(SEED)
        rows = np.rint(np.arccos(random.uniform(-1, 1, CHECKED)) * (MAP_SIZE[0] - 1) / np.pi).astype(np.int64)
        columns = random.integers(0, MAP_SIZE[1], CHECKED)
        directions = towards(rows * (np.pi / (MAP_SIZE[0] - 1)), np.pi * (1 - 2 * (columns + 0.5) / MAP_SIZE[1]))
        return float(((exact[rows, columns] - self.sum_by_basis(directions)) ** 2).sum(axis=1).mean())

    def works(self) -> dict[str, Work]:
        """Method -> the work to time."""
        return {
            SCATTERED: lambda: self.sum_at(self.directions),
            BASIS: lambda: self.sum_by_basis(self.directions),
            MAP_64: self.rows_of_map,
            MAP_32: self.map,
        }


class ShaderFrame:
    """A renderer and a framebuffer of the window's size and format."""

    def __init__(self, renderer: Renderer, target: moderngl.Framebuffer) -> None:
        self.renderer = renderer
        self.target = target
        self.cached: Evaluations | None = None
        """The stage whose map is shown."""
        x, y = np.arange(0, FRAME.width, STRIDE) + 0.5, np.arange(0, FRAME.height, STRIDE) + 0.5
        self.normals, self.inside = normals_on(FRAME.spheres[1], x, y)

    def works(self, stage: Evaluations) -> dict[str, Work]:
        works: dict[str, Work] = {MAKING: lambda: self.make_map(stage)}
        return works | dict.fromkeys(shader_methods(stage.n_bands), self.draw)

    def be_ready_for(self, method: str, stage: Evaluations) -> None:
        """Upload the picture to draw, which is not timed."""
        if method == DIRECT:
            self.cached = None
            self.renderer.show(stage.direct)
        elif method == CACHED and self.cached is not stage:
            self.make_map(stage)
        self.renderer.context.finish()

    def make_map(self, stage: Evaluations) -> None:
        self.cached = stage
        self.renderer.show(stage.on_a_map())
        self.renderer.context.finish()

    def draw(self) -> None:
        self.renderer.draw(self.target, FRAME)
        self.renderer.context.finish()

    def errors(self, stage: Evaluations) -> dict[str, float]:
        """Method -> arithmetic error."""
        pictures = {CACHED: stage.on_a_map(), DIRECT: stage.direct}
        return {method: self._error(stage, pictures[method]) for method in shader_methods(stage.n_bands)}

    def _error(self, stage: Evaluations, picture: Picture) -> float:
        """The error of the linear radiance read back from the right sphere, seen from the front and from behind."""
        azimuth, elevation = SEEN_FROM
        total = weights = 0.0
        for place in ((azimuth, elevation), (azimuth + 180, -elevation)):
            world_from_view = camera.world_from_view(*place)
            drawn = render_linear(self.renderer, replace(picture, world_from_view=world_from_view), FRAME)
            difference = drawn[::STRIDE, ::STRIDE][self.inside] - stage.sum_at(self.normals @ world_from_view.T)
            solid_angle = 1 / self.normals[:, 2]
            total += float(solid_angle @ (difference**2).sum(axis=1))
            weights += float(solid_angle.sum())
        return stage.relative(total / weights)
