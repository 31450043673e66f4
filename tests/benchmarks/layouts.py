"""What the other layouts cost beside a lat-long image of as many texels: python tests/benchmarks/layouts.py [SIDE ...]

First the projections alone, then whole processes that open a file (half floats, ZIP, noise): processor time, the least of
interleaved runs, one thread. SIDE (1024) is that of the mirror ball and the angular map; the others have as many texels.

Goal: a process within 1.5 times that of the lat-long file, at any number of bands up to 128.
"""

from __future__ import annotations

import os
import sys
import tempfile
from functools import partial
from pathlib import Path

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

import numpy as np
import OpenEXR
from measure import cpu_milliseconds, machine
from opening import process

from shviewer.lights.layouts.angular import AngularLayout
from shviewer.lights.layouts.arrangements import VERTICAL_CROSS
from shviewer.lights.layouts.cube import CubeLayout
from shviewer.lights.layouts.lat_long import LatLongLayout
from shviewer.lights.layouts.layout import Layout
from shviewer.lights.layouts.mirror_ball import MirrorBallLayout

BANDS = (3, 9, 32, 64, 128)
REPEATS = 3


def layouts(side: int) -> dict[str, tuple[Layout, tuple[int, int]]]:
    """Layouts, and height and width of their images, with about side^2 texels each."""
    height, face = round(side / 2**0.5), round(side / 6**0.5)
    return {
        "lat-long": (LatLongLayout(height, 2 * height), (height, 2 * height)),
        "cube": (CubeLayout(VERTICAL_CROSS, face), (4 * face, 3 * face)),
        "angular": (AngularLayout(side), (side, side)),
        "mirror-ball": (MirrorBallLayout(side), (side, side)),
    }


def image(layout: Layout, shape: tuple[int, int]) -> np.ndarray:
    shown = np.broadcast_to(layout.solid_angles() > 0, shape)
    return (
        np.random.default_rng(0).gamma(2.0, 0.5, (*shape, 3)).astype(np.float16).astype(np.float32) * shown[..., None]
    )


def projections(side: int) -> None:
    found = {name: (layout, image(layout, shape)) for name, (layout, shape) in layouts(side).items()}
    print(f"\nprojection, CPU ms (x lat-long), {side}^2 texels")
    for n_bands in BANDS:
        works = {name: partial(layout.project, pixels, n_bands) for name, (layout, pixels) in found.items()}
        for work in works.values():
            work()
        times = {name: min(cpu_milliseconds(work) for _ in range(REPEATS)) for name, work in works.items()}
        print(f"{n_bands:>4} bands", *(f"{name} {ms:.0f} ({ms / times['lat-long']:.1f})" for name, ms in times.items()))


def write(path: Path, pixels: np.ndarray) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": pixels.astype(np.float16)}) as file:
        file.write(str(path))


def processes(side: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        paths = {}
        for name, (layout, shape) in layouts(side).items():
            paths[name] = Path(folder) / f"{name}.exr"
            write(paths[name], image(layout, shape))
        works = {
            f"project, {n} bands": ("project", "--bands", str(n), "--force", "-o", f"{folder}/out.json")
            for n in (9, 128)
        }
        works |= {f"screenshot, {n} bands": ("screenshot", f"{folder}/out.png", "--bands", str(n)) for n in (5, 128)}
        works["info"] = ("info",)
        print(f"\nwhole processes, CPU s (x lat-long), {side}^2 texels")
        for title, work in works.items():
            runs: dict[str, list[float]] = {name: [] for name in paths}
            for _ in range(REPEATS):
                for name, path in paths.items():
                    runs[name].append(process("-m", "shviewer", *work, str(path), "--layout", name)[0])
            least = {name: min(seconds) for name, seconds in runs.items()}
            print(
                f"{title:<21}",
                *(f"{name} {s:.2f} ({s / least['lat-long']:.2f})" for name, s in least.items()),
                flush=True,
            )


def main() -> None:
    print(machine(), "- one thread")
    for side in map(int, sys.argv[1:] or ["1024"]):
        projections(side)
        processes(side)


if __name__ == "__main__":
    main()
