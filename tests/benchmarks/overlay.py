"""What a band key costs: python tests/benchmarks/overlay.py OLD [NEW] [--repeats R] [--lights GREEN ...]

OLD and NEW (HEAD unless given) are commits of this repository, laid out side by side; their processes take turns. Each goes up
through 4 to 16 bands, each seen for the first time, and down again, at 1280 x 640, and measures for every key the processor
time of the picture (coefficients, figures) and of the overlay (everything that is written, drawn to layers). The medians are
over keys and repeats. Goal: at most 25 ms in all for a key, and next to nothing where a band count was seen before.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from commits import lay_out
from measure import machine

KEYS = """
import json, sys, time
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import prepare
from shviewer.viewer.state import state_of

def spent(work):
    start = time.process_time()
    found = work()
    return 1000 * (time.process_time() - start), found

at = compose(1280, 640)
found = {"up": [], "down": []}
draw_overlay(prepare(state_of(sys.argv[1], n_bands=4)), at).layers
for way, counts in (("up", range(5, 17)), ("down", range(15, 3, -1))):
    for n_bands in counts:
        picture, shown = spent(lambda: prepare(state_of(sys.argv[1], n_bands=n_bands)))
        written, _ = spent(lambda: draw_overlay(shown, at, timing=True).layers)
        found[way].append((picture, written))
print(json.dumps(found))
"""


def walk(checkout: Path, light: str) -> dict[str, list[tuple[float, float]]]:
    """The milliseconds of picture and overlay of every key, up and down."""
    environment = {**os.environ, "PYTHONPATH": str(checkout)}
    done = subprocess.run(
        [sys.executable, "-c", KEYS, light], cwd=checkout, env=environment, capture_output=True, text=True, check=True
    )
    found: dict[str, list[tuple[float, float]]] = json.loads(done.stdout)
    return found


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("old")
    parser.add_argument("new", nargs="?", default="HEAD")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--lights", nargs="+", default=["green", "venice_sunset"])
    options = parser.parse_args()
    print(machine())
    print("light           key    picture old, new    overlay old, new, ratio    in all old, new   (CPU ms, medians)")
    with tempfile.TemporaryDirectory() as name:
        places = [lay_out(commit, Path(name) / label) for commit, label in ((options.old, "old"), (options.new, "new"))]
        for light in options.lights:
            walks = [[walk(place, light) for place in places] for _ in range(options.repeats)]
            for way in ("up", "down"):
                keys = [[key for turn in walks for key in turn[side][way]] for side in (0, 1)]
                pictures = [statistics.median(key[0] for key in side) for side in keys]
                written = [statistics.median(key[1] for key in side) for side in keys]
                both = [statistics.median(sum(key) for key in side) for side in keys]
                print(
                    f"{light:<16}{way:<7}{pictures[0]:7.1f} {pictures[1]:7.1f}    {written[0]:7.1f} {written[1]:7.1f}"
                    f" {written[0] / written[1]:7.2f}    {both[0]:11.1f} {both[1]:6.1f}"
                )


if __name__ == "__main__":
    main()
