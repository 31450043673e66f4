"""What opening a large map costs: [xvfb-run -a] python tests/benchmarks/opening.py [WIDTH ...]

Whole processes, files in a temporary folder: processor time, peak memory, and the time over that of the floor, a Python that
reads the same file with OpenEXR's own library and sums it once. The files are half floats, ZIP: one value, or noise that no
code compresses well.

With a display also the window: while a map is dropped and opened, the camera turns in every frame. Goal: no frame waits longer
than 50 ms for the light. The times of frames are those of drawing, too, so they stand beside the frames before the drop.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import OpenEXR
from measure import machine

FLOOR = """
import sys, numpy, OpenEXR
with OpenEXR.File(sys.argv[1]) as file:
    print(file.channels()["RGB"].pixels.astype(numpy.float32).sum())
"""
KINDS = ("flat", "noise")
BEFORE = 30
PATIENCE = 300.0
"""Seconds for a map to open in the window."""


def write_map(path: Path, width: int, kind: str) -> None:
    shape = width // 2, width, 3
    rng = np.random.default_rng(0)
    pixels = np.ones(shape, np.float16) if kind == "flat" else rng.random(shape, np.float32).astype(np.float16)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": pixels}) as file:
        file.write(str(path))


def process(*arguments: str) -> tuple[float, float]:
    """Processor seconds and peak MiB of a new Python."""
    child = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    assert status == 0, arguments
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def processes(path: Path) -> None:
    out = str(path.with_suffix(".png")), str(path.with_suffix(".json"))
    program = ("-m", "shviewer")
    works = {
        "floor": ("-c", FLOOR, str(path)),
        "project, 9 bands": (*program, "project", str(path), "--bands", "9", "-o", out[1]),
        "screenshot": (*program, "screenshot", out[0], str(path)),
        "info": (*program, "info", str(path)),
    }
    measured = {name: [process(*arguments) for _ in range(3)] for name, arguments in works.items()}
    floor = min(seconds for seconds, _ in measured["floor"])
    for name, runs in measured.items():
        seconds, peak = min(runs)[0], max(peak for _, peak in runs)
        print(f"{path.stem:<14}{name:<18}{seconds:7.2f} CPU-s{seconds / floor:7.2f} x floor{peak:8.0f} MiB")


def window(paths: list[Path]) -> None:
    import glfw
    import moderngl

    from shviewer.errors import GraphicsError
    from shviewer.viewer.desktop.canvas import Canvas
    from shviewer.viewer.desktop.window import Window, open_window
    from shviewer.viewer.picture import prepare
    from shviewer.viewer.state import changed, state_of

    def frame(shown: Window, turn: int) -> float:
        start = time.perf_counter()
        shown.change(changed(shown.session.state, camera=(float(turn % 360), 20.0)))
        shown.frame()
        glfw.poll_events()
        return 1000 * (time.perf_counter() - start)

    try:
        with open_window((1280, 640)) as handle:
            for path in paths:
                shown = Window(handle, Canvas(moderngl.create_context(require=330)), prepare(state_of("green")), False)
                before = [frame(shown, turn) for turn in range(BEFORE)]
                shown.session.drop(str(path))
                meanwhile, end = [], time.perf_counter() + PATIENCE
                while shown.shown is None or shown.shown.light.name != path.stem:
                    assert time.perf_counter() < end, shown.session.state.view.message
                    meanwhile.append(frame(shown, len(meanwhile)))
                    time.sleep(min(meanwhile[-1] / 1000, 0.03) if shown.session.working else 0)
                print(
                    f"{path.stem:<14}window: {len(meanwhile)} frames, median {statistics.median(meanwhile):.0f} ms, slowest "
                    f"{max(meanwhile):.0f} ms; before the drop {statistics.median(before):.0f} and {max(before):.0f} ms"
                )
                shown.canvas.release()
    except GraphicsError as error:
        print(f"window: not measured ({error})")


def main() -> None:
    widths = [int(text) for text in sys.argv[1:]] or [4096, 8192]
    print(machine())
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder) / f"{kind}-{width}.exr" for width in widths for kind in KINDS]
        for path in paths:
            kind, width = path.stem.split("-")
            write_map(path, int(width), kind)
            processes(path)
        window(paths)


if __name__ == "__main__":
    main()
