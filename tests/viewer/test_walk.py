"""Random walks through the program: whatever is pressed, turned, resized or dropped, every state is drawn, and drawn right.

The key walks of test_state.py never draw, and so they did not see that surfaces of 33 bands could not be.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from random import Random

import numpy as np
import pytest

from shviewer.analysis.figures import needs
from shviewer.analysis.subjects import read_again
from shviewer.errors import ShviewerError
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS
from shviewer.viewer import actions, derived, drawn
from shviewer.viewer import picture as picture_module
from shviewer.viewer.actions import open_light, orbit, rotate_light, step_sweep, toggle_band, with_bands, zoom
from shviewer.viewer.camera import facing
from shviewer.viewer.composition import Composition, compose
from shviewer.viewer.drawn import DirectSum, Drawn, SplineMap, Surfaces
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.keys import ACTIONS, press
from shviewer.viewer.overlay.marks import marks_of
from shviewer.viewer.overlay.probe import probe, probe_layers
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.picture_files import metadata, write_exr
from shviewer.viewer.screenshot import render_linear, render_rgb
from shviewer.viewer.state import State, state_of

WALKS, STEPS = 12, 170
"""2040 states in all."""

SIZES = ((64, 64), (96, 64), (160, 80), (64, 200), (320, 160))
"""Small frames: what is drawn does not depend on their size, and the time does."""

KEYS = sorted(ACTIONS)


class Walk:
    """One seeded walk. It does for keys that ask for something what the window does, and no more."""

    def __init__(self, seed: int, lights: tuple[str | Light, ...], drops: tuple[str, ...], renderer: Renderer) -> None:
        self.random = Random(seed)
        self.renderer = renderer
        self.drops = drops
        compare = CoefficientLight(np.random.default_rng(seed).normal(size=(36, 3)), "given") if seed % 4 == 3 else None
        self.state = state_of(lights=lights, light_index=seed % len(lights), compare=compare)
        self.size = SIZES[0]
        self.trail: list[str] = []
        self.picture = prepare(self.state)
        self.drawn: set[type[Drawn]] = set()
        self.bands: set[int] = set()
        self.refusals: list[str] = []

    def step(self) -> None:
        """Do one thing, and draw what comes of it."""
        last = self.state
        words, self.state = self._something()
        self.trail.append(words)
        try:
            self._grant(last)
            self.picture = prepare(self.state, by_map=self.random.random() < 0.2)
        except ShviewerError as error:  # as the window does: the picture stays, and says why
            self.refusals.append(str(error))
            self.state = replace(self.picture.state, message=str(error), sweep_to=None)
            self.picture = replace(self.picture, state=self.state)
        self._draw()

    def composition(self) -> Composition:
        return compose(*self.size, self.state.zoom, n_spheres=self.state.n_spheres)

    def _something(self) -> tuple[str, State]:
        state, random = self.state, self.random
        turn = random.uniform(-1, 1), random.uniform(-1, 1)
        choice = random.random()
        if choice < 0.7:
            key = random.choice(KEYS)
            return key, press(state, key)
        if choice < 0.76:
            return f"drag {turn}", orbit(state, *turn)
        if choice < 0.8:
            return f"Shift+drag {turn}", rotate_light(state, *turn)
        if choice < 0.84:
            return f"scroll {turn[0]}", zoom(state, 12 * turn[0])
        if choice < 0.88:
            self.size = random.choice(SIZES)
            return f"resize {self.size}", state
        if choice < 0.92:
            path = random.choice(self.drops)
            return f"drop {Path(path).name}", replace(open_light(state, path), reloads=state.reloads + 1)
        if choice < 0.95:
            n_bands = random.choice((1, 2, 31, 32, 33, 34, 64, MAX_BANDS))
            return f"{n_bands} bands", with_bands(state, n_bands)
        if choice < 0.97:
            band = random.randrange(state.n_bands)
            return f"click on band {band}", toggle_band(state, band)
        return "beat", step_sweep(state)

    def _grant(self, last: State) -> None:
        """What a state asks for beyond being drawn."""
        state = self.state
        if state.reloads != last.reloads:
            read_again(state.recipe)
        if state.fits != last.fits:
            found = needs(state.recipe)
            wanted = found.irradiance if state.quantity == "irradiance" else found.radiance
            self.state = with_bands(state, wanted or found.best_bands)
        marks = marks_of(self.picture) if state.looks != last.looks else ()
        if marks:
            direction = self.picture.light_from_world.T @ marks[state.looks % len(marks)].direction
            self.state = replace(state, camera=facing(direction))
        if state.screenshots != last.screenshots:
            said = json.loads(metadata(self.picture, self.composition(), self.renderer.version))
            assert said["bands"] == self.picture.state.n_bands
        self.state = replace(self.state, closing=False, fullscreen=False)

    def _draw(self) -> None:
        picture, composition = self.picture, self.composition()
        assert picture.state == self.state
        self.drawn.add(type(picture.drawn))
        self.bands.add(self.state.n_bands)
        pixels = render_rgb(self.renderer, picture, composition, timing=True)
        assert pixels.shape == (composition.height, composition.width, 3)
        assert pixels.any()
        if not isinstance(picture.drawn, Surfaces) and self.random.random() < 0.5:
            assert np.isfinite(render_linear(self.renderer, picture, composition)).all()
        self._point(picture, composition)
        assert self.renderer.context.error == "GL_NO_ERROR"

    def _point(self, picture: Picture, composition: Composition) -> None:
        x, y = self.random.uniform(0, composition.width), self.random.uniform(0, composition.height)
        found = probe(picture, composition, x, y)
        if found is not None:
            assert np.isfinite([found.original, found.reconstruction, found.error]).all()
            assert probe_layers(found, composition, x, y)


@pytest.fixture(scope="session")
def all_kinds(tmp_path_factory: pytest.TempPathFactory) -> tuple[tuple[str | Light, ...], tuple[str, ...]]:
    """Lights of every kind, small, and files to be dropped, some of them bad."""
    folder = tmp_path_factory.mktemp("walk")
    random = np.random.default_rng(0)

    def image(name: str, height: int, width: int, scale: float = 1.0) -> str:
        pixels = (scale * random.random((height, width, 3)) ** 4).astype(np.float32)
        write_exr(folder / name, pixels, "")
        return str(folder / name)

    def text(name: str, content: str) -> str:
        (folder / name).write_text(content)
        return str(folder / name)

    numbers = "\n".join(",".join(map(str, row)) for row in random.normal(size=(25, 3)).round(3))
    stamp = "# shviewer-coefficients: 1\n# convention: shviewer\n# quantity: {}\nred,green,blue\n"
    sun = '[[lobe]]\nprofile = "disc"\nhalf_angle_degrees = 0.5\nradiance = 4000\naxis = [0, 0.6, 0.8]\n'
    lights: tuple[str | Light, ...] = (
        "green",
        "sun-sky",
        "hemisphere",
        text("black.toml", '[[lobe]]\nprofile = "constant"\nradiance = 0\n'),
        text("faint.toml", '[[lobe]]\nprofile = "constant"\nradiance = 1e-29\n' + sun.replace("4000", "3e-29")),
        text("sun.toml", sun + '[[lobe]]\nprofile = "constant"\nradiance = 0.1\n'),
        image("lat-long.exr", 16, 32),
        image("bright.exr", 16, 32, 1e28),
        image("square.exr", 24, 24),
        image("strip.exr", 8, 48),
        text("light.py", "def light(d):\n    return 1 + d[:, 2] * d[:, 0]\n") + ":light",
        text("radiance.csv", stamp.format("radiance") + numbers + "\n"),
        text("irradiance.csv", stamp.format("irradiance") + numbers + "\n"),
        FunctionLight(np.exp, "exp"),
        CoefficientLight(random.normal(size=(9, 3)), "nine"),
    )
    bad = np.full((8, 16, 3), np.nan, np.float32)
    write_exr(folder / "nan.exr", bad, "")
    drops = (
        text("broken.toml", "[[lobe]]\nprofile = 7\n"),
        text("bare.txt", "1 2 3"),
        text("fails.py", "def light(d):\n    raise ValueError('no')\n") + ":light",
        text("huge.toml", '[[lobe]]\nprofile = "constant"\nradiance = 1e31\n'),
        text("dim.toml", '[[lobe]]\nprofile = "constant"\nradiance = 1e-40\n'),
        str(folder / "nan.exr"),
        str(folder / "gone.hdr"),
        str(folder),
        *(light for light in lights if isinstance(light, str)),
    )
    return lights, drops


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Surfaces and maps for small frames: a walk makes hundreds of them."""
    monkeypatch.setattr(derived, "SURFACE_RADIUS", 2.0)
    monkeypatch.setattr(derived, "LIGHT_ROWS", 129)
    monkeypatch.setattr(drawn, "MAP_COLUMNS", (256, 512))
    monkeypatch.setattr(actions, "MAX_KEY_SAMPLES", 10_000)


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("seed", range(WALKS))
def test_every_state_that_a_walk_reaches_is_drawn(
    renderer: Renderer, all_kinds: tuple[tuple[str | Light, ...], tuple[str, ...]], seed: int
) -> None:
    walk = Walk(seed, *all_kinds, renderer)
    for number in range(STEPS):
        try:
            walk.step()
        except Exception as error:
            raise AssertionError(f"seed {seed}, step {number}, after {walk.trail[-40:]}: {walk.state}") from error
    assert walk.drawn == {DirectSum, SplineMap, Surfaces}
    assert walk.state.compare or any(n_bands > 32 for n_bands in walk.bands)
    assert all(walk.refusals)
    again = [render_rgb(renderer, prepare(walk.state), walk.composition()) for _ in range(2)]
    np.testing.assert_array_equal(*again)


@pytest.mark.usefixtures("coarse")
def test_a_walk_finds_what_is_broken(
    renderer: Renderer,
    all_kinds: tuple[tuple[str | Light, ...], tuple[str, ...]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The crash it was written for: a sum of more bands than the shader's block holds."""
    monkeypatch.setattr(picture_module, "MAX_DIRECT_BANDS", MAX_BANDS)
    walk = Walk(0, *all_kinds, renderer)

    def go_on() -> None:
        for _ in range(STEPS):
            walk.step()

    with pytest.raises(ValueError, match="could not broadcast"):
        go_on()
