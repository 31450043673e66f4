"""How long until something is seen: python tests/benchmarks/start_up.py

The base of every ratio is measured in the same run: a Python that imports numpy, moderngl and pyrr and opens an EGL context.
Goal: a screenshot of `green`, 4 bands, 1280 x 640, in at most 2.5 times that.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from measure import machine, medians

BASE = "import numpy, moderngl, pyrr; moderngl.create_context(standalone=True, backend='egl', require=330)"


def process(*arguments: str) -> Callable[[], object]:
    command = [sys.executable, *arguments]
    return lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        out = str(Path(folder) / "out.png")
        green = ("-m", "shviewer", "screenshot", out, "green", "--bands", "4")
        times = medians(
            {
                "python alone": process("-c", ""),
                "base: imports and one EGL context": process("-c", BASE),
                "shviewer --version": process("-m", "shviewer", "--version"),
                "shviewer --help": process("-m", "shviewer", "--help"),
                "screenshot green, 4 bands, 1280 x 640": process(*green),
                "screenshot film_studio, 9 bands": process(
                    "-m", "shviewer", "screenshot", out, "film_studio", "--bands", "9"
                ),
            },
            repeats=7,
        )
    base = times["base: imports and one EGL context"]
    print(machine())
    for name, milliseconds in times.items():
        print(f"{name:<42}{milliseconds:8.0f} ms{milliseconds / base:8.2f} x base")


if __name__ == "__main__":
    main()
