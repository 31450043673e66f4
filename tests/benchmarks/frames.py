"""What a frame costs: python tests/benchmarks/frames.py

CPU time of all threads, which on software OpenGL is the cost of the shaders. 1280 x 640, Green's light. The base, measured in
the same run, shows a constant light with one band on the right. Then the CPU work of a band key outside the draw: a new
picture of bands never shown before (goal: under 2 ms up to 16 bands), and its overlay.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from measure import cpu_milliseconds, machine, medians, wall_milliseconds

from shviewer.viewer.analysis import reconstruct
from shviewer.viewer.composition import compose
from shviewer.viewer.overlay import draw_overlay
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.screenshot import headless_renderer
from shviewer.viewer.state import ViewState

BANDS = (3, 4, 5, 8, 16, 32)
COMPOSITION = compose(1280, 640)


def frame_costs() -> dict[str, float]:
    with headless_renderer() as renderer:
        context = renderer.context
        texture = context.texture((1280, 640), 4)
        target = context.framebuffer([texture])

        def draw(picture: Picture) -> None:
            renderer.show(picture)
            renderer.draw(target, COMPOSITION)
            context.finish()

        base = replace(prepare(ViewState(n_bands=1)), coefficients=np.ones((1, 3)))
        pictures = {"base": base} | {f"{n} bands": prepare(ViewState(n_bands=n)) for n in (*BANDS, 64)}
        print(renderer.version)
        try:
            return medians({name: lambda p=picture: draw(p) for name, picture in pictures.items()}, 9, cpu_milliseconds)
        finally:
            target.release()
            texture.release()


def key_costs() -> None:
    prepare(ViewState())
    for n_bands in (4, 8, 16, 32):
        state = ViewState(n_bands=n_bands)

        def press(state: ViewState = state) -> Picture:
            reconstruct.cache_clear()
            return prepare(state)

        picture = press()
        times = medians(
            {"picture": press, "overlay": lambda p=picture: draw_overlay(p, COMPOSITION)}, 25, wall_milliseconds
        )
        print(f"key to {n_bands:>3} bands: picture {times['picture']:6.2f} ms, overlay {times['overlay']:6.2f} ms")


def main() -> None:
    print(machine())
    costs = frame_costs()
    for name, milliseconds in costs.items():
        print(f"{name:<10}{milliseconds:8.1f} cpu-ms{milliseconds - costs['base']:+9.1f} to the base")
    key_costs()


if __name__ == "__main__":
    main()
