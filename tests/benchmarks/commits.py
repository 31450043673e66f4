"""Whether a change made anything slower: python tests/benchmarks/commits.py OLD [NEW] [--lights N] [--repeats R]

OLD and NEW (HEAD unless given) are commits of this repository; they are laid out side by side and take turns. Times are those
of the processor, of a process and its children, and the ratio is that of the least ones: what other programs on the machine
do hardly touches these. Goal: no ratio above 1.05.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from measure import machine

ROOT = Path(__file__).resolve().parents[2]

SCENE = """\
[[lobe]]
profile = "clamped-linear"
axis = [{x:.4f}, {y:.4f}, {z:.4f}]
radiance = [{r:.3f}, {g:.3f}, {b:.3f}]
slope = 5
offset = 4
"""

START_OF_WINDOW = """
import sys
try:
    from shviewer.viewer.desktop import window
except ImportError:  # where it was before
    from shviewer.viewer import window
right = window.Window.frame
def frame(self, *rest):
    right(self, *rest)
    if self.frame_count >= 2 and getattr(self, "shown", self) is not None:
        import glfw; glfw.set_window_should_close(self.handle, True)
window.Window.frame = frame
try:
    from shviewer.cli.main import main
except ImportError:
    from shviewer.cli import main
sys.exit(main(["green"]))
"""
"""The window, closed after the second frame that shows a picture."""


def lay_out(commit: str, folder: Path) -> Path:
    """The files of a commit in a folder."""
    folder.mkdir()
    archive = subprocess.run(["git", "archive", commit], cwd=ROOT, capture_output=True, check=True)
    subprocess.run(["tar", "-x", "-C", str(folder)], input=archive.stdout, check=True)
    return folder


def write_scenes(folder: Path, count: int) -> list[str]:
    chance = np.random.default_rng(0)
    paths = []
    for number in range(count):
        (x, y, z), (r, g, b) = chance.standard_normal(3), chance.random(3) + 0.1
        path = folder / f"scene-{number:04d}.toml"
        path.write_text(SCENE.format(x=x, y=y, z=z, r=r, g=g, b=b))
        paths.append(str(path))
    return paths


def processor_seconds(checkout: Path, arguments: Sequence[str], cwd: str) -> float:
    """User and system time of a new process that may cache bytecode. The exit code must be 0."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment["PYTHONPATH"] = str(checkout)
    child = subprocess.Popen(
        [sys.executable, *arguments], cwd=cwd, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    assert child.stderr is not None
    said = child.stderr.read().decode()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        sys.exit(f"{checkout.name}: {' '.join(arguments)[:80]} ended with {child.returncode}: {said[-500:]}")
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("old")
    parser.add_argument("new", nargs="?", default="HEAD")
    parser.add_argument("--lights", type=int, default=1000)
    parser.add_argument("--repeats", type=int, default=5)
    options = parser.parse_args()
    print(machine())
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        old, new = lay_out(options.old, folder / "old"), lay_out(options.new, folder / "new")
        (folder / "scenes").mkdir()
        scenes = write_scenes(folder / "scenes", options.lights)
        out = str(folder / "out.png")
        run = ("-m", "shviewer")
        works: dict[str, tuple[int, Sequence[str]]] = {
            "import shviewer": (20, ("-c", "import shviewer")),
            "--version": (20, (*run, "--version")),
            "--help": (20, (*run, "--help")),
            "screenshot green": (10, (*run, "screenshot", out, "green")),
            f"project {options.lights} scenes": (1, (*run, "project", *scenes, "-o", str(folder / "projected"))),
            f"info {options.lights} scenes": (1, (*run, "info", *scenes)),
        }
        if os.environ.get("DISPLAY"):
            works["window to its second frame"] = (5, ("-c", START_OF_WINDOW))
        print(f"{'processor time':<28}{'old':>10}{'new':>10}{'new/old':>9}")
        for what, (times, arguments) in works.items():
            seconds: dict[Path, list[float]] = {old: [], new: []}
            for checkout in seconds:
                if times > 1:  # a first run writes bytecode
                    processor_seconds(checkout, arguments, name)
            for _ in range(options.repeats * times):
                for checkout in seconds:
                    seconds[checkout].append(processor_seconds(checkout, arguments, name))
            before, after = (1000 * min(taken) for taken in seconds.values())
            print(f"{what:<28}{before:7.0f} ms{after:7.0f} ms{after / before:9.3f}", flush=True)


if __name__ == "__main__":
    main()
