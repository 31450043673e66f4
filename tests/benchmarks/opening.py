"""What opening a large map costs: [xvfb-run -a] python tests/benchmarks/opening.py [WIDTH ...], or 0 for the layouts alone

Whole processes on files that this script makes: a sky of 1/f luminance with noise and a sun, as .exr (half floats, ZIP, and
float32, PIZ) and .hdr; and such a light as a cube, an angular map and a mirror ball. Of each: processor time, the same over
the floor, and the peak memory of all processes. The floor is a Python that reads the file with OpenImageIO and sums it
once. *First picture* is what the window shows first, its figures pending, without OpenGL; *screenshot* is the whole
picture, drawn, with all figures; *opened* is both in the way of a window, which lets a child decode.

With a display also the window: while a map is dropped and opened, the camera turns in every frame, twice for each map, since
OpenGL compiles a shader for the first. Goal: no frame waits longer than 50 ms for the light. The times of frames are those of
drawing, too, so they stand beside the frames before the drop; the processor time of the window's thread does not depend on how
busy the machine is. Then the frames in which the map is given back.
Last, what the memory of lights holds after ten maps in turn.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # as the command sets them for itself

import numpy as np
import OpenEXR
from measure import machine

FLOOR = """
import sys, OpenImageIO
print(OpenImageIO.ImageBuf(sys.argv[1]).get_pixels(OpenImageIO.FLOAT).sum())
"""
FIRST = """
import sys
from shviewer.lights.reading import Reading
from shviewer.viewer.picture import completed, first_picture
from shviewer.viewer.state import state_of
picture = first_picture(state_of(sys.argv[1], reading=Reading(layout=sys.argv[2], isolated=sys.argv[3] == "opened")))
if sys.argv[3] == "opened":
    from shviewer.viewer.screenshot import headless_renderer
    with headless_renderer() as renderer:
        renderer.show(picture)
        renderer.show(completed(picture))
"""
REPEATS = 3
BEFORE = 30
PATIENCE = 300.0
"""Seconds for a map to open in the window."""


def sky(width: int) -> np.ndarray:
    """(width / 2, width, 3) float32: waves of a height that falls with their frequency, noise, and a sun of 0.5 degrees."""
    rng = np.random.default_rng(0)
    phi, theta = np.linspace(0, 2 * np.pi, width, np.float32), np.linspace(0, np.pi, width // 2, np.float32)
    pixels = np.full((width // 2, width, 3), [0.4, 0.45, 0.5], np.float32)
    for k in 2 ** np.arange(1, 8):
        turns = rng.random(2) * 2 * np.pi
        wave = np.cos(k * theta + turns[0])[:, None] * np.cos(k * phi + turns[1]) / (8 * k)
        pixels += wave[..., None]
    for rows in pixels.reshape(-1, width, 3):
        rows *= rng.lognormal(0, 0.05, (width, 1)).astype(np.float32)
    size = max(1, width // 720)
    pixels[width // 8 : width // 8 + size, width // 3 : width // 3 + size] = 3e4
    return np.maximum(pixels, 1e-3)


def write_exr(path: Path, pixels: np.ndarray, compression: object) -> None:
    with OpenEXR.File({"compression": compression, "type": OpenEXR.scanlineimage}, {"RGB": pixels}) as file:
        file.write(str(path))


def write_maps(folder: Path, width: int) -> list[tuple[Path, str]]:
    """The files of one size, with their layouts."""
    import OpenImageIO

    pixels = sky(width)
    files = [(folder / f"{width}-{kind}", "auto") for kind in ("half.exr", "float.exr", "rgbe.hdr")]
    write_exr(files[0][0], pixels.astype(np.float16), OpenEXR.ZIP_COMPRESSION)
    write_exr(files[1][0], pixels, OpenEXR.PIZ_COMPRESSION)
    buffer = OpenImageIO.ImageBuf(OpenImageIO.ImageSpec(width, width // 2, 3, OpenImageIO.FLOAT))
    buffer.set_pixels(OpenImageIO.ROI(), pixels)
    buffer.write(str(files[2][0]))
    return files


def write_balls(folder: Path) -> list[tuple[Path, str]]:
    """A sky as an angular map and a mirror ball of 1024 texels a side, and as a cube and a lat-long map of as many texels.

    What shows nothing is black: the cells of a cross without a face, and what is around a disc.
    """
    from layouts import layouts

    files = []
    for name, (layout, shape) in layouts(1024).items():
        pixels = sky(max(2048, 2 * shape[0]))[: shape[0], : shape[1]] * (layout.solid_angles() > 0)[..., None]
        files.append((folder / f"1024-{name}.exr", name))
        write_exr(files[-1][0], pixels.astype(np.float16), OpenEXR.ZIP_COMPRESSION)
    return files


class Peak:
    """The most memory that this process's children and theirs held together, MiB, looked at every 5 ms. Linux only."""

    def __init__(self, root: int) -> None:
        self.mib, self._root, self._over = 0.0, root, threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()

    def _watch(self) -> None:
        while not self._over.wait(0.005):
            self.mib = max(self.mib, _resident(self._root) / 2**20)

    def end(self) -> float:
        self._over.set()
        self._thread.join()
        return self.mib


def _resident(root: int, shared: str = "") -> int:
    """Bytes of a process and its children. shared: what /proc says of the parent, as of a child that has just been forked."""
    try:
        said = Path(f"/proc/{root}/statm").read_text()
        children = Path(f"/proc/{root}/task/{root}/children").read_text().split()
    except OSError:
        return 0
    own = 0 if said == shared else int(said.split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return own + sum(_resident(int(child), said) for child in children)


def process(*arguments: str) -> tuple[float, float]:
    """Processor seconds and peak MiB, both with children, of a new Python; 0 MiB where the system does not tell."""
    child = subprocess.Popen([sys.executable, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    peak = Peak(child.pid)
    _, status, usage = os.wait4(child.pid, 0)
    assert status == 0, arguments
    return usage.ru_utime + usage.ru_stime, peak.end()


def processes(path: Path, layout: str) -> None:
    """Print a row of the table."""
    out = str(path.with_suffix(".png")), str(path.with_suffix(".json"))
    mode = "-m", "shviewer"
    more = "--layout", layout
    works = {
        "floor": ("-c", FLOOR, str(path)),
        "first picture": ("-c", FIRST, str(path), layout, "first"),
        "screenshot": (*mode, "screenshot", out[0], str(path), *more),
        "opened": ("-c", FIRST, str(path), layout, "opened"),
        "project": (*mode, "project", str(path), "--bands", "9", "-o", out[1], *more),
        "info": (*mode, "info", str(path), *more),
    }
    runs: dict[str, list[tuple[float, float]]] = {name: [] for name in works}
    for _ in range(REPEATS):
        for name, arguments in works.items():
            runs[name].append(process(*arguments))
    floor = min(seconds for seconds, _ in runs["floor"])
    cells = [f"{floor:.2f}"]
    for name in list(works)[1:]:
        seconds = min(seconds for seconds, _ in runs[name])
        cells.append(f"{seconds:.2f} / **{seconds / floor:.1f}** / {max(peak for _, peak in runs[name]):.0f}")
    print(f"| {path.name} | {' | '.join(cells)} |", flush=True)


def window(paths: list[Path]) -> None:
    import glfw

    from shviewer.errors import GraphicsError
    from shviewer.resources import resource_folder
    from shviewer.viewer.desktop.frames import LEAVE_SECONDS
    from shviewer.viewer.desktop.window import Window, canvas_of, open_window
    from shviewer.viewer.picture import prepare
    from shviewer.viewer.state import changed, state_of

    def frame(shown: Window, turn: int) -> tuple[float, float]:
        """Milliseconds on the clock, and of this thread's processor."""
        start, begun = time.perf_counter(), time.thread_time()
        shown.change(changed(shown.session.state, camera=(float(turn % 360), 20.0)))
        shown.session.tick(start)
        shown.frame()
        glfw.poll_events()
        return 1000 * (time.perf_counter() - start), 1000 * (time.thread_time() - begun)

    def said(frames: list[tuple[float, float]]) -> str:
        wall, own = zip(*frames, strict=True)
        return f"median {statistics.median(wall):.0f} ms, slowest {max(wall):.0f} ms, own {max(own):.0f} ms"

    def opened(shown: Window, light: str, name: str) -> tuple[float, float, list[tuple[float, float]]]:
        """Drop a light; seconds to its first picture and to all figures, and the frames meanwhile."""
        shown.session.drop(light)
        meanwhile, start, first = [], time.perf_counter(), 0.0
        while first == 0 or not (shown.session.picture.complete and shown.shown is shown.session.picture):
            assert time.perf_counter() < start + PATIENCE, shown.session.state.view.message
            meanwhile.append(frame(shown, len(meanwhile)))
            if first == 0 and shown.shown is not None and shown.shown.light.name == name:
                first = time.perf_counter() - start
            busy = shown.session.working or shown.canvas.pending
            time.sleep(min(meanwhile[-1][0] / 1000, LEAVE_SECONDS) if busy else 0)
        return first, time.perf_counter() - start, meanwhile

    try:
        with open_window((1280, 640)) as handle:
            for path in paths:
                green = path.with_name("plain.toml")
                green.write_text((resource_folder("assets") / "scenes" / "green.toml").read_text())
                shown = Window(handle, canvas_of(handle), prepare(state_of("green")))
                print(f"{path.name}: before the drop {said([frame(shown, turn) for turn in range(BEFORE)])}")
                for _ in range(2):
                    first, complete, meanwhile = opened(shown, str(path), path.stem)
                    _, _, away = opened(shown, str(green), green.stem)
                    away += [frame(shown, turn) for turn in range(BEFORE)]
                    print(
                        f"    first picture after {first:.2f} s, all figures after {complete:.2f} s; {len(meanwhile)} frames, "
                        f"{said(meanwhile)}; given back: {said(away)}"
                    )
                shown.canvas.release()
    except GraphicsError as error:
        print(f"window: not measured ({error})")


def ten_in_turn(path: Path) -> None:
    """Open one map under ten names, and print what is remembered of those not in use."""
    from shviewer.analysis.cache import MEMORY, MOST_BYTES, array_bytes
    from shviewer.viewer.picture import prepare
    from shviewer.viewer.state import state_of

    most = 0
    for number in range(10):
        link = path.with_name(f"turn-{number}{path.suffix}")
        link.hardlink_to(path)
        light = prepare(state_of(str(link))).light
        others = [array_bytes(other, results) for other, results in MEMORY._known.items() if other is not light]
        most = max(most, sum(others))
    print(f"ten maps in turn: {most / 2**20:.0f} MiB of lights not in use; the cap is {MOST_BYTES / 2**20:.0f} MiB")


def main() -> None:
    widths = [width for width in map(int, sys.argv[1:] or ["2048", "4096", "8192"]) if width]
    print(machine())
    print("\nProcessor seconds / over the floor / peak MiB of all processes:\n")
    print(
        "| map | floor | first picture | screenshot | opened | project, 9 bands | info |\n|---|---:|---:|---:|---:|---:|---:|"
    )
    with tempfile.TemporaryDirectory() as folder:
        files = [file for width in widths for file in write_maps(Path(folder), width)]
        for path, layout in (*files, *write_balls(Path(folder))):
            processes(path, layout)
        if not widths:
            return
        print()
        halves = [path for path, _ in files if path.suffix == ".exr"]
        window(halves)
        ten_in_turn(halves[-2])


if __name__ == "__main__":
    main()
