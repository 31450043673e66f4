"""Sends signals at many moments to every mode: python tests/crashes/moments.py [COUNT [SEED]]

Each run is a new process in an empty folder, which gets INT, TERM, HUP or KILL after a random time. Then it must have ended
with the documented code (or have been faster), have said no traceback, and have left no temporary file and no child.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]

MODES: dict[str, tuple[float, Sequence[str]]] = {
    "screenshot": (0.8, ("screenshot", "a.png", "--size", "320", "240")),
    "exr": (0.8, ("screenshot", "a.exr", "--size", "320", "240")),
    "view": (0.8, ("view-by-default", "--size", "320", "240")),
    "sweep": (2.0, ("sweep", "a.webp", "--to", "6", "--size", "640", "320")),
    "info": (1.2, ("info", "green", "film_studio", "venice_sunset", "sun-sky")),
    "jobs": (2.5, ("project", "green", "film_studio", "cosine", "hemisphere", "sun-sky", "--jobs", "2", "-o", ".")),
    "project": (0.8, ("project", "green", "film_studio", "cosine", "hemisphere", "sun-sky", "-o", ".")),
    "report": (6.0, ("report", "--quick", "--budget", "3")),
    "stability": (3.0, ("report", "--stability")),
    "help": (0.15, ("--help",)),
}
"""Mode -> about how many seconds it takes, and its arguments. They are spread over all of that."""

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
MARK = "SHVIEWER_MOMENT"
PATIENCE = 30.0


class Sent(NamedTuple):
    mode: str
    number: signal.Signals
    seconds: float
    code: int
    found: list[str]
    """What broke the promise."""


def send(mode: str, number: signal.Signals, seconds: float, folder: Path) -> Sent:
    """Run a mode in an empty folder, and send it a signal after some seconds."""
    (folder / "tmp").mkdir()
    mark = f"{os.getpid()}-{folder.name}"
    without = ("DISPLAY", "WAYLAND_DISPLAY", "PYTHONDONTWRITEBYTECODE")
    environment = {name: value for name, value in os.environ.items() if name not in without}
    environment |= {"PYTHONPATH": str(ROOT), "TMPDIR": str(folder / "tmp"), MARK: mark}
    arguments = [argument for argument in MODES[mode][1] if argument != "view-by-default"]
    command = [sys.executable, "-m", "shviewer", *arguments]
    with subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as child:
        time.sleep(seconds)
        child.send_signal(number)
        _, errors = child.communicate(timeout=PATIENCE)
    return Sent(
        mode, number, seconds, child.returncode, broken(number, child.returncode, errors.decode(), folder, mark)
    )


def broken(number: signal.Signals, code: int, errors: str, folder: Path, mark: str) -> list[str]:
    """What is not as promised, in words."""
    early = -number, (128 + number if number == signal.SIGINT else -number)  # in the start of Python itself
    before_us = any(words in errors for words in ("Fatal Python error", "Could not import runpy"))
    found = []
    if number != signal.SIGKILL:
        ours = "shviewer" in errors.partition("Traceback")[2]
        found += ["traceback"] if ours else []
        if code not in (0, 128 + number, *early) and not before_us:
            found.append(f"exit code {code}")
        found += [str(path) for path in folder.rglob("*.tmp")]
        found += [str(path) for path in (folder / "tmp").iterdir()]
    time.sleep(0.1)
    deadline = time.monotonic() + 3.0
    while (alive := marked(mark)) and time.monotonic() < deadline:
        time.sleep(0.1)
    found += [f"child {line}" for line in alive]
    found += [f"torn {path}" for path in folder.iterdir() if path.is_file() and path.suffix != ".tmp" and torn(path)]
    return found


def torn(path: Path) -> bool:
    """Whether a file is no whole one of its kind, by its last bytes."""
    data = path.read_bytes()
    match path.suffix:
        case ".png":
            return not data.endswith(b"IEND\xaeB`\x82")
        case ".webp":
            return len(data) != 8 + int.from_bytes(data[4:8], "little")
        case ".json":
            return not data.endswith(b"}\n")
    return not data


def marked(mark: str) -> list[str]:
    """The processes with the mark in their environment, where the system tells; without those that wait to be buried."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            if f"{MARK}={mark}".encode() in (entry / "environ").read_bytes().split(b"\0"):
                found.append((entry / "cmdline").read_bytes().replace(b"\0", b" ").decode()[-80:])
        except OSError:
            continue
    return found


def main(count: int, seed: int) -> int:
    chance, codes, wrong = random.Random(seed), Counter[tuple[str, int]](), 0
    for number in range(count):
        mode = list(MODES)[number % len(MODES)]
        with tempfile.TemporaryDirectory() as folder:
            sent = send(mode, chance.choice(SIGNALS), chance.uniform(0, MODES[mode][0]), Path(folder))
        codes[sent.number.name, sent.code] += 1
        if sent.found:
            wrong += 1
            print(sent, flush=True)
    print(f"{count} signals, {wrong} findings; {', '.join(f'{name} {code}: {n}' for (name, code), n in codes.items())}")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main(*(int(text) for text in (sys.argv[1:] + ["90", "0"][len(sys.argv) - 1 :]))))
