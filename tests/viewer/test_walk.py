"""Random walks through the program: whatever is pressed, turned, resized or dropped, every state is drawn, and drawn right.

The key walks of test_state.py never draw, and so they did not see that surfaces of 33 bands could not be.
"""

from __future__ import annotations

from pathlib import Path
from random import Random

import numpy as np
import pytest
from harmonics.independent import random_directions

from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import is_code
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS
from shviewer.viewer import picture as picture_module
from shviewer.viewer import splines, surface
from shviewer.viewer.composing.composition import Composition, frame_for
from shviewer.viewer.control import actions
from shviewer.viewer.control.actions import toggle_band, with_bands
from shviewer.viewer.control.commands import Command
from shviewer.viewer.control.keys import ACTIONS
from shviewer.viewer.control.placing import orbit, rotate_light, zoom
from shviewer.viewer.control.playing import step_sweep, step_turn
from shviewer.viewer.desktop.behind.saving import projected_of
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.drawn import DirectSum, Drawn, Encoded, SplineMap, Surfaces
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.overlay.directions.probe import probe, probe_layers
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.saving.picture_files import write_exr
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.screenshot import render_linear, render_rgb
from shviewer.viewer.state import state_of

WALKS, STEPS = 12, 170
"""2040 states in all."""

SIZES = ((64, 64), (96, 64), (160, 80), (64, 200), (320, 160))
"""Small frames: what is drawn does not depend on their size, and the time does."""

KEYS = sorted(ACTIONS)

NORMALS = random_directions(20)


class Walk:
    """One seeded walk of a session, drawn without a window."""

    def __init__(self, seed: int, lights: tuple[str | Light, ...], drops: tuple[str, ...], renderer: Renderer) -> None:
        self.random, self.checks = Random(seed), Random(seed)
        self.renderer = renderer
        self.drops = drops
        compare = CoefficientLight(np.random.default_rng(seed).normal(size=(36, 3)), "given") if seed % 4 == 3 else None
        n_bands = 5 if compare else (33, 5, MAX_BANDS)[seed % 3]
        start: dict[str, object] = {"n_bands": n_bands, "compare": compare}
        if seed % 3 == 1 and compare is None:
            encode = list(ENCODED_BANDS)[seed % len(ENCODED_BANDS)]
            start = {"quantity": "irradiance", "encode": encode, "n_bands": ENCODED_BANDS[encode]}
        self.session = Session(state_of(*lights, light=lights[seed % len(lights)], **start))
        self.size = SIZES[0]
        self.trail: list[str] = []
        self.drawn: set[type[Drawn]] = set()

    def step(self) -> None:
        """Do one thing, and draw what comes of it."""
        self._do_something()
        self.session.prepare(by_map=self.random.random() < 0.2)
        self._draw()

    def composition(self) -> Composition:
        return frame_for(self.session.state.view, *self.size)

    def _do_something(self) -> None:
        session, state, random = self.session, self.session.state, self.random
        turn = random.uniform(-1, 1), random.uniform(-1, 1)
        choice = random.random()
        if choice < 0.7:
            key = random.choice(KEYS)
            self.trail.append(key)
            if session.press(key) is Command.SAVE:
                session.save(self.renderer, self.composition())
        elif choice < 0.76:
            self.trail.append(f"drag {turn}")
            session.state = orbit(session.placed, *turn)
        elif choice < 0.8:
            self.trail.append(f"Shift+drag {turn}")
            session.state = rotate_light(session.placed, *turn)
        elif choice < 0.84:
            self.trail.append(f"scroll {turn[0]}")
            session.state = zoom(state, 12 * turn[0])
        elif choice < 0.88:
            self.size = random.choice(SIZES)
            self.trail.append(f"resize {self.size}")
        elif choice < 0.92:
            path = random.choice(self.drops)
            self.trail.append(f"drop {Path(path).name}")
            session.drop(path)
        elif choice < 0.95:
            n_bands = random.choice((1, 2, 31, 32, 33, 34, 64, MAX_BANDS))
            self.trail.append(f"{n_bands} bands")
            session.state = with_bands(state, n_bands)
        elif choice < 0.97:
            band = random.randrange(state.recipe.n_bands)
            self.trail.append(f"click on band {band}")
            session.state = toggle_band(state, band)
        else:
            self.trail.append("beat")
            session.state = step_turn(step_sweep(state)) if state.view.turning else step_sweep(state)

    def _draw(self) -> None:
        picture, composition = self.session.picture, self.composition()
        assert picture.state == self.session.state
        self.drawn.add(type(picture.drawn))
        pixels = render_rgb(self.renderer, picture, composition, timing=True)
        assert pixels.shape == (composition.height, composition.width, 3)
        assert pixels.any()
        if not isinstance(picture.drawn, Surfaces) and self.random.random() < 0.5:
            assert np.isfinite(render_linear(self.renderer, picture, composition)).all()
        self._point(picture, composition)
        self._stamp(picture, composition)
        if picture.state.view.encode or self.checks.random() < 0.05:
            self._export(picture)
        assert self.renderer.context.error == "GL_NO_ERROR"

    def _stamp(self, picture: Picture, composition: Composition) -> None:
        """What the picture says of itself is the state again; a light that is an object cannot be told, nor is code run."""
        recipe = picture.state.recipe
        light = None if isinstance(recipe.light, str) and not is_code(recipe.light) else recipe.light
        read = state_of_stamp(metadata(picture, composition, self.renderer.version), light, recipe.compare)
        assert (read.recipe, read.view) == (recipe, picture.state.view)

    def _export(self, picture: Picture) -> None:
        """What Ctrl+E writes is what is shown, as it stands."""
        projected, rotation = projected_of(picture), picture.light_from_world
        shown = picture.rest_at(NORMALS @ rotation.T)
        written = evaluate_basis(NORMALS, projected.n_bands) @ projected.coefficients
        if projected.stored is not None:
            written = projected.stored.irradiance(NORMALS)
        np.testing.assert_allclose(written, shown, rtol=0, atol=1e-10 * np.abs(projected.coefficients).max())

    def _point(self, picture: Picture, composition: Composition) -> None:
        x, y = self.random.uniform(0, composition.width), self.random.uniform(0, composition.height)
        found = probe(picture, composition, x, y)
        if found is not None:
            assert np.isfinite([found.original, found.reconstruction, found.error]).all()
            assert probe_layers(found, picture, composition, x, y)


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
def coarse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Surfaces and maps for small frames: a walk makes hundreds of them."""
    monkeypatch.setattr(surface, "RADIUS", 2.0)
    monkeypatch.setattr(surface, "LIGHT_ROWS", 129)
    monkeypatch.setattr(splines, "MAP_COLUMNS", (256, 512))
    monkeypatch.setattr(actions, "MAX_KEY_SAMPLES", 10_000)
    monkeypatch.chdir(tmp_path)  # where pictures are saved


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
            raise AssertionError(
                f"seed {seed}, step {number}, after {walk.trail[-40:]}: {walk.session.state}"
            ) from error
    assert len(walk.drawn & {DirectSum, Encoded, SplineMap, Surfaces}) >= 2  # which, is chance
    again = [render_rgb(renderer, prepare(walk.session.state), walk.composition()) for _ in range(2)]
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
