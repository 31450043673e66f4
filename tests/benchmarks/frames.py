"""What a frame costs: [xvfb-run -a -s "-screen 0 3840x2160x24"] python tests/benchmarks/frames.py [OLD | window]

CPU time of all threads, which on software OpenGL is the cost of the shaders. 1280 x 640, Green's light. The base, measured in
the same run, shows a constant light with one band on the right. The reconstruction is summed per pixel, or drawn from its
map (goal: at most 25 cpu-ms whatever n is), with a third sphere for the error, and with everything written over it. Then how
far the map is from the sum (goal: under half a step of white up to 32 bands), and the CPU work of events outside the draw:
a band key (goal: under 2 ms up to 16 bands) with its overlay, a turn of the light, and the values under the mouse. Last a
step of a light that turns and is projected anew (Q), with all figures, over a fresh projection of 32 bands by the same way.

With a display, or with `window` alone, the longest that a window looks at no event, in every mode: it is entered, turned, and
saved. *Own* is the processor time of the window's thread; *drawn* is that of all threads: OpenGL in software draws in some of
its own, and compiles in another one. Goal: under 50 ms each, whatever a frame takes as a whole. For each size nothing has ever
been compiled, as on a machine that has not seen the program.

With a commit OLD, frames of it and of this checkout instead, in turns: their medians, and the ratio of the least ones (goal for
the lines over negative light: at most 1.15 at 5 bands, and 1.10 from 9 on).
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from statistics import median

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # as the command sets them for itself

import numpy as np
from commits import ROOT, lay_out
from measure import cpu_milliseconds, machine, medians, wall_milliseconds

from shviewer.analysis.figures import figures_of, irradiance_error, sums
from shviewer.harmonics.basis import Array
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import jittered
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.find import find_light
from shviewer.lights.light import Light
from shviewer.viewer.composing.composition import compose, frame_for
from shviewer.viewer.control.placing import rotate_light
from shviewer.viewer.control.playing import step_turn, turn_light
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.overlay.directions.marks import mark_layers
from shviewer.viewer.overlay.directions.probe import probe, probe_layers
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.screenshot import headless_renderer, offscreen, render_linear
from shviewer.viewer.state import State, state_of

BANDS = (3, 4, 5, 8, 16, 32)
COMPOSITION = compose(1280, 640)
REPEATS = 9


def frame_costs(renderer: Renderer) -> dict[str, float]:
    base = replace(prepare(state_of(n_bands=1)), coefficients=np.ones((1, 3)))
    pictures = {"base": base} | {f"{n} bands, sum": prepare(state_of(n_bands=n)) for n in BANDS}
    pictures |= {f"{n} bands, map": prepare(state_of(n_bands=n), by_map=True) for n in (3, 16, 32, 128)}
    pictures["16 bands, map, error"] = prepare(state_of(n_bands=16, error="signed"), by_map=True)
    pictures["9 bands, whole sphere"] = prepare(state_of(n_bands=9, whole_sphere=True))
    pictures["16 bands, map, written over"] = pictures["16 bands, map"]
    costs = {}
    with offscreen(renderer, COMPOSITION) as target:
        for name, picture in pictures.items():  # one after the other: uploading a map is no part of a frame
            composition = frame_for(picture.state.view, 1280, 640)
            layers: tuple[Layer, ...] = ()
            if "written" in name:
                layers = (*mark_layers(picture, composition), *draw_overlay(picture, composition).layers)
            renderer.show(picture)

            def draw(composition=composition, layers=layers) -> None:
                renderer.draw(target, composition, layers)
                renderer.context.finish()

            costs[name] = medians({name: draw}, REPEATS, cpu_milliseconds)[name]
    return costs


def map_differences(renderer: Renderer) -> None:
    for light in ("green", "studio", "venice_sunset", "film_studio"):
        steps = []
        for n_bands in (8, 16, 32):
            pictures = [prepare(state_of(light, n_bands=n_bands), by_map=by_map) for by_map in (False, True)]
            shown = [
                np.clip(2.0**picture.exposure_stops * render_linear(renderer, picture, COMPOSITION), -1, 1)
                for picture in pictures
            ]
            steps.append(f"{255 * np.abs(shown[0] - shown[1]).max():.4f}")
        print(f"{light:<16} map against sum at 8, 16, 32 bands: {', '.join(steps)} of 255 of white")


def event_costs() -> None:
    prepare(state_of())
    for n_bands in (4, 8, 16, 32):
        state = state_of(n_bands=n_bands)

        def press(state: State = state) -> Picture:
            for figures in (sums, irradiance_error, figures_of):
                figures.cache_clear()
            return prepare(state)

        picture = press()
        times = medians(
            {"picture": press, "overlay": lambda p=picture: draw_overlay(p, COMPOSITION)}, 25, wall_milliseconds
        )
        print(f"key to {n_bands:>3} bands: picture {times['picture']:6.2f} ms, overlay {times['overlay']:6.2f} ms")
    turned = state_of(n_bands=32, camera=(98.0, 22.0))

    def turn() -> None:
        nonlocal turned
        turned = rotate_light(turned, 0.01, 0.003)
        mark_layers(prepare(turned), COMPOSITION)

    picture = prepare(turned)

    def point() -> None:
        found = probe(picture, COMPOSITION, 330.0, 260.0)
        assert found is not None
        probe_layers(found, picture, COMPOSITION, 330.0, 260.0)

    for name, milliseconds in medians({"turn of the light": turn, "values under the mouse": point}, 25).items():
        print(f"{name}, 32 bands: {milliseconds:.2f} ms")


def fresh_projection(light: Light, method: str, samples: int) -> Array:
    """32 bands of a light of which nothing is kept."""
    if method == "jittered":
        return project_samples(light.integrand, jittered(samples, 1), 32)
    return (EnvironmentLight(light.pixels) if isinstance(light, EnvironmentLight) else light).coefficients(32)


def step_costs() -> None:
    """A step is a new state, projected where the light stands, and its picture with all figures."""
    for name, method in product(("green", "st_fagans_interior"), ("best", "jittered")):
        state, light = state_of(name, n_bands=9, method=method), find_light(name)
        turning = [turn_light(prepare(state).placed(state), "fresh")]

        def step(turning: list[State] = turning) -> None:
            turning[0] = step_turn(turning[0])
            prepare(turning[0])

        fresh = partial(fresh_projection, light, method, state.recipe.samples)
        times = medians({"step": step, "fresh": fresh}, 15, cpu_milliseconds)
        ratio, cost = times["step"] / times["fresh"], times["fresh"]
        print(f"step of {name}, {method}: {times['step']:.2f} cpu-ms, {ratio:.2f} times a projection ({cost:.2f})")


OF_A_COMMIT = """
import json, sys, time
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.picture import prepare
from shviewer.viewer.screenshot import headless_renderer, offscreen
from shviewer.viewer.state import state_of

frame = compose(1280, 640)
seen = {"camera": (78.0, 22.0)}
pictures = {f"{n} bands, sum": prepare(state_of(n_bands=n, **seen)) for n in (1, 5, 9, 16)}
pictures |= {f"{n} bands, map": prepare(state_of(n_bands=n, **seen), by_map=True) for n in (9, 16)}
pictures["venice_sunset, 9 bands"] = prepare(state_of("venice_sunset", n_bands=9, **seen))
with headless_renderer() as renderer, offscreen(renderer, frame) as target:
    for line in sys.stdin:
        costs = {}
        for name, picture in pictures.items():
            renderer.show(picture)
            times = []
            for _ in range(6):
                start = time.process_time()
                renderer.draw(target, frame)
                renderer.context.finish()
                times.append(1000 * (time.process_time() - start))
            costs[name] = min(times[1:])
        print(json.dumps(costs), flush=True)
"""
"""A process that draws frames of its checkout whenever it gets a line, and prints what each cost."""


def between_commits(old: str, rounds: int = 9) -> None:
    """Print what frames cost in another commit and here, drawn in turns."""
    with tempfile.TemporaryDirectory() as name:
        checkouts = lay_out(old, Path(name) / "old"), ROOT
        children = [
            subprocess.Popen(
                [sys.executable, "-c", OF_A_COMMIT],
                cwd=name,
                env={**os.environ, "PYTHONPATH": str(checkout)},
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            for checkout in checkouts
        ]
        costs: list[list[dict[str, float]]] = [[], []]
        for _ in range(rounds):
            for child, found in zip(children, costs, strict=True):
                assert child.stdin is not None
                assert child.stdout is not None
                child.stdin.write("\n")
                child.stdin.flush()
                found.append(json.loads(child.stdout.readline()))
        for child in children:
            child.communicate()
        for what in costs[0][0]:
            before, after = ([cost[what] for cost in found] for found in costs)
            print(f"{what:<28}{median(before):8.1f} cpu-ms{median(after):8.1f} cpu-ms{min(after) / min(before):8.3f}")


MODES: dict[str, dict[str, object]] = {
    "5 bands": {},
    "32 bands": {"n_bands": 32},
    "128 bands": {"n_bands": 128},
    "128 bands, signed error": {"n_bands": 128, "error": "signed"},
    "32 bands, the whole sphere, relative error": {"n_bands": 32, "error": "relative", "whole_sphere": True},
    "32 bands beside 32 without a window": {"n_bands": 32, "window": "hann", "beside": "no-window"},
    "irradiance": {"n_bands": 3, "quantity": "irradiance"},
    "as an engine stores it": {"n_bands": 3, "quantity": "irradiance", "encode": "hallucinated"},
    "surfaces, 5 bands": {"n_bands": 5, "lobe_view": True},
    "surfaces, 32 bands, error": {"n_bands": 32, "lobe_view": True, "error": "signed"},
    "surfaces, 128 bands, error": {"n_bands": 128, "lobe_view": True, "error": "signed"},
    "time against error": {"sheet": "plane"},
    "bands against roughness": {"by_roughness": True},
    "help": {"help_visible": True},
    "a photograph, 32 bands": {"light": "venice_sunset", "n_bands": 32},
    "a photograph without its sun, error": {
        "light": "venice_sunset",
        "n_bands": 9,
        "split_sun": True,
        "error": "signed",
    },
    "a sweep": {"n_bands": 32, "sweep_to": 40},
    "a light that turns": {"n_bands": 9, "turning": "fresh", "method": "jittered"},
}
"""What changes in a state of Green's light with 5 bands."""

SIZES_OF_WINDOWS = (1280, 640), (3840, 2160)
TURNS, PLAYED_SECONDS, MOST_SECONDS = 5, 3.0, 60.0


def windows() -> None:
    """Print the longest time without a look at events, in every mode of windows of both sizes, in milliseconds."""
    import glfw

    from shviewer.errors import GraphicsError
    from shviewer.viewer.desktop.window import Window, canvas_of, open_window
    from shviewer.viewer.state import changed

    def passes(shown: Window, seconds: float = 0.0) -> list[tuple[float, float]]:
        """What a window does until it is at rest, and at least so long: own and drawn milliseconds of each pass."""
        found, start = [], time.perf_counter()
        while time.perf_counter() < start + MOST_SECONDS:
            own, drawn = time.thread_time(), time.process_time()
            drawing = shown.pass_on()
            if shown.session.tick(time.perf_counter()) or shown.canvas.pending or shown.canvas.news:
                shown.due()
                drawing = True
            found.append((1000 * (time.thread_time() - own), 1000 * (time.process_time() - drawn)))
            if not drawing and not shown.session.working and time.perf_counter() >= start + seconds:
                break
            glfw.wait_events_timeout(0.0 if drawing else 0.005)
        return found

    def worst(found: list[tuple[float, float]]) -> str:
        own, drawn = (max(each) for each in zip(*found, strict=True))
        return f"{own:.0f} / {drawn:.0f}"

    for size in SIZES_OF_WINDOWS:
        os.environ["MESA_SHADER_CACHE_DIR"] = str(
            Path.cwd() / f"shaders-{size[0]}"
        )  # empty: no program was ever compiled
        try:
            with open_window(size) as handle:
                width, height = glfw.get_framebuffer_size(handle)
                print(f"\na window of {width} x {height}: longest pass, own / drawn, ms\n")
                print("| mode | entered | turned | saved with P |\n|---|---:|---:|---:|")
                shown = Window(handle, canvas_of(handle), prepare(state_of("green", "venice_sunset")))
                print(f"| the first picture | {worst(passes(shown))} | | |", flush=True)
                plain = shown.session.state
                for name, changes in MODES.items():
                    plays = "sweep_to" in changes or "turning" in changes
                    shown.change(changed(plain, **changes))
                    entered = passes(shown, PLAYED_SECONDS if plays else 0.0)
                    shown.change(changed(shown.session.state, sweep_to=None, turning=""))
                    passes(shown)
                    turned = []
                    for _ in range(TURNS):
                        shown.change(rotate_light(shown.session.placed, 0.1, 0.03))
                        turned += passes(shown)
                    shown.press("P")
                    print(f"| {name} | {worst(entered)} | {worst(turned)} | {worst(passes(shown))} |", flush=True)
                    shown.change(plain)
                    passes(shown)
                shown.canvas.release()
        except GraphicsError as error:
            print(f"a window of {size[0]} x {size[1]}: not measured ({error})")


def main() -> None:
    print(machine())
    if sys.argv[1:] == ["window"]:
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)  # for what P writes
            windows()
        return
    if len(sys.argv) > 1:
        between_commits(sys.argv[1])
        return
    with headless_renderer() as renderer:
        print(renderer.version)
        costs = frame_costs(renderer)
        for name, milliseconds in costs.items():
            print(f"{name:<28}{milliseconds:8.1f} cpu-ms{milliseconds - costs['base']:+9.1f} to the base")
        map_differences(renderer)
    event_costs()
    step_costs()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        windows()


if __name__ == "__main__":
    main()
