"""Writes every kind of output again and again, each time in a process of its own, which fails or is ended at one step.

    python tests/crashes/victim.py FOLDER [--some N] [KIND ...]

in an empty FOLDER: a line for every run that broke what is promised, then how many there were (all of them: 2 min of CPU).
--some: only N runs of each kind, chosen at random, always the same.

A step is one call to the system by which a file comes to be: open, write, flush, fsync, close, chown, chmod, replace, link,
unlink. Pictures are not drawn: their pixels are given.
"""

from __future__ import annotations

import argparse
import builtins
import contextlib
import errno
import json
import os
import random
import resource
import signal
import sys
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

import shviewer
from shviewer import outputs
from shviewer.benchmark.page import plots, writing
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.rows.report import Report
from shviewer.cli.main import main
from shviewer.ending import end_by_signals
from shviewer.errors import ShviewerError
from shviewer.viewer import screenshot
from shviewer.viewer.animation import animation
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.desktop import session
from shviewer.viewer.desktop.behind import saving
from shviewer.viewer.saving.picture_files import write_png
from shviewer.viewer.state import state_of

BLOCK = 4096
SMALL = ("--size", "320", "240")
PIXELS = np.random.default_rng(0).integers(0, 256, (240, 320, 3)).astype(np.uint8)
ENDS = {"error": 0, "kill": signal.SIGKILL, "term": signal.SIGTERM, "hup": signal.SIGHUP, "int": signal.SIGINT}


@dataclass(frozen=True)
class Outcome:
    """The end of one run. `step` counts from 0; for `how` "full" it is the number of blocks that a file may have."""

    kind: str
    how: str
    step: int
    name: str
    """The step's function, or "" """
    code: int
    """The exit code; below zero, the signal that ended it."""
    lines: int
    """The lines on stderr that name a file that cannot be written."""
    traceback: bool
    torn: list[str]
    """Files that are neither what they were nor what they were to become."""
    left: list[str]
    """Files that should not be there."""


class Steps:
    """Counts the steps of writing, and lets one of them fail or be the last."""

    def __init__(self, fatal: int = -1, how: str = "") -> None:
        self.fatal, self.how = fatal, how
        self.names: list[str] = []

    def take(self, name: str) -> None:
        self.names.append(name)
        if len(self.names) - 1 != self.fatal:
            return
        if self.how == "error":
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        os.kill(os.getpid(), ENDS[self.how])

    def watched(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def step(*arguments: Any, **options: Any) -> Any:
            self.take(name)
            return function(*arguments, **options)

        return step

    def install(self) -> None:
        for name in ("fsync", "replace", "link", "chmod", "chown", "unlink"):
            setattr(os, name, self.watched(name, getattr(os, name)))
        right = os.open

        def opened(path: Any, flags: int, mode: int = 0o777, **options: Any) -> int:
            if flags & os.O_CREAT:
                self.take("open")
            return right(path, flags, mode, **options)

        os.open = opened
        outputs.open = self.open_file  # the writer's own open, in place of the built-in one

    def open_file(self, path: Any, mode: str, **options: Any) -> Any:
        return _Slow(builtins.open(path, mode, **options), self)


class _Slow:
    """A file whose every block is written by a step of its own, half of it if that is the last one."""

    def __init__(self, file: Any, steps: Steps) -> None:
        self.file, self.steps = file, steps

    def __enter__(self) -> _Slow:
        return self

    def __exit__(self, *error: object) -> None:
        self.file.close()
        self.steps.take("close")

    def write(self, data: bytes) -> None:
        self.file.write(data[: len(data) // 2])
        self.file.flush()
        self.steps.take("write")
        self.file.write(data[len(data) // 2 :])

    def flush(self) -> None:
        self.steps.take("flush")
        self.file.flush()

    def fileno(self) -> int:
        return int(self.file.fileno())


def command(*arguments: str) -> Callable[[], int]:
    return lambda: main([*arguments])


def called(function: Callable[[], object]) -> Callable[[], int]:
    """A function of the Python face as a command: its exit code is that of its error."""

    def run() -> int:
        try:
            function()
        except ShviewerError as error:
            print(f"shviewer: {error}", file=sys.stderr)
            return error.exit_code
        return 0

    return run


UNDRAWN = SimpleNamespace(
    version="none",
    show=lambda picture, seconds=None: True,
    ready=lambda picture, composition: True,
    held=SimpleNamespace(pinned=None),
)
"""A renderer that draws nothing."""


def press_p() -> int:
    """P, in a window: an error is a message there."""
    shown = session.Session(state_of())
    shown.save(UNDRAWN, compose(320, 240))
    shown.saving.finish()
    if "cannot be written" in shown.state.view.message:
        print(f"shviewer: {shown.state.view.message}", file=sys.stderr)
        return 4
    return 0


def write_report() -> None:
    Path("report").mkdir(exist_ok=True)
    report = Report(0, "shviewer report", {}, {})
    plots.make_plots(report, Path("report"))
    writing.write(Path("report"), Page(report))


KINDS: dict[str, tuple[Callable[[], int], tuple[str, ...]]] = {
    "png": (command("screenshot", "a.png", *SMALL), ("a.png",)),
    "exr": (command("screenshot", "a.exr", *SMALL), ("a.exr",)),
    "gif": (command("sweep", "a.gif", "--to", "2", *SMALL), ("a.gif",)),
    "webp": (command("sweep", "a.webp", "--to", "2", *SMALL), ("a.webp",)),
    "json": (command("project", "-o", "a.json"), ("a.json",)),
    "csv": (command("project", "-o", "a.csv"), ("a.csv",)),
    "npz": (command("project", "-o", "a.npz"), ("a.npz",)),
    "h": (command("project", "-o", "a.h"), ("a.h",)),
    "glsl": (command("project", "-o", "a.glsl"), ("a.glsl",)),
    "batch": (command("project", "green", "cosine", "-o", "."), ("green.json", "cosine.json")),
    "save": (called(lambda: shviewer.project("green", 9).save("b.json")), ("b.json",)),
    "difference": (
        command("screenshot", "c.png", *SMALL, "--reference", "reference.png"),
        ("c.png", "c-difference.png"),
    ),
    "P": (press_p, ("shviewer-green-001.png",)),
    "report": (
        called(write_report),
        tuple(f"report/{name}" for name in (*writing.FILES, "error-bands.svg", "error-bands.png")),
    ),
}
"""Kind -> what writes it, and the files that it writes."""

NEW = ("P",)
"""Kinds that never replace a file."""


@contextlib.contextmanager
def undrawn() -> Iterator[None]:
    yield UNDRAWN


def undrawn_part(*arguments: object) -> Generator[float, None, Callable[[], np.ndarray]]:
    yield 0.0
    return lambda: PIXELS


def give_pixels() -> None:
    """Let no picture be drawn."""
    for module in (screenshot, animation):
        module.headless_renderer = undrawn
        module.render_rgb = lambda *arguments, **options: PIXELS
    saving.render_in_parts = undrawn_part
    screenshot.render_linear = lambda *arguments: PIXELS.astype(np.float32)
    plots.plots_of = lambda report: {"error-bands": lambda figure: None}


def in_child(run: Callable[[], int]) -> tuple[int, str]:
    """The exit code of a function in a process of its own, below zero for a signal, and its stderr."""
    reading, writing_end = os.pipe()
    child = os.fork()
    if child == 0:
        code = 70
        try:
            os.dup2(writing_end, 2)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            sys.stdout, sys.stderr = (os.fdopen(number, "w", 1, closefd=False) for number in (1, 2))
            code = run()
        except BaseException:
            sys.excepthook(*sys.exc_info())
        finally:
            os._exit(code)
    os.close(writing_end)
    with open(reading) as file:
        said = file.read()
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), said


def contents() -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in Path().rglob("*") if path.is_file()}


def restore(before: dict[str, bytes]) -> None:
    for path in contents():
        if path not in before:
            os.unlink(path)
    for path, data in before.items():
        Path(path).parent.mkdir(exist_ok=True)
        Path(path).write_bytes(data)


Run = tuple[str, int, str, dict[str, bytes]]
"""How it ends, at which step, the step's name, and the files before."""


def runs(kind: str, whole: dict[str, bytes], bare: dict[str, bytes]) -> list[Run]:
    """Every end of one kind of output: over an older file of ours, and where there was none."""
    run = KINDS[kind][0]
    old = bare | ({} if kind in NEW else {path: data + b"\n#" for path, data in whole.items()})
    found: list[Run] = []
    for before in (old, bare) if old != bare else (bare,):
        restore(before)
        steps = Steps()

        def count(steps: Steps = steps) -> int:
            steps.install()
            code = run()
            print(json.dumps(steps.names), file=sys.stderr)
            return code

        names = json.loads(in_child(count)[1].splitlines()[-1])
        found += [(how, step, name, before) for how in ENDS for step, name in enumerate(names)]
    most = max(map(len, whole.values())) // BLOCK
    return [*found, *(("full", blocks, "", old) for blocks in range(most + 1))]


def outcomes(kind: str, some: int | None) -> Iterator[Outcome]:
    run, written = KINDS[kind]
    restore({})
    write_png(Path("reference.png"), 255 - PIXELS, "{}")
    bare = contents()
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere), contextlib.redirect_stderr(nowhere):
        assert run() == (kind == "difference")  # in this process, so that those that are forked know the light
    whole = {path: contents()[path] for path in written}
    all_runs = runs(kind, whole, bare)
    chosen = all_runs if some is None else random.Random(kind).sample(all_runs, min(some, len(all_runs)))
    for how, step, name, before in chosen:
        restore(before)
        end = in_child(limited(run, step)) if how == "full" else ended_at(run, Steps(step, how))
        yield judge(kind, how, step, name, end, before, whole)


def ended_at(run: Callable[[], int], steps: Steps) -> tuple[int, str]:
    def faulty() -> int:
        end_by_signals()
        steps.install()
        return run()

    return in_child(faulty)


def limited(run: Callable[[], int], blocks: int) -> Callable[[], int]:
    def run_limited() -> int:
        resource.setrlimit(resource.RLIMIT_FSIZE, (blocks * BLOCK, blocks * BLOCK))
        return run()

    return run_limited


def judge(
    kind: str, how: str, step: int, name: str, end: tuple[int, str], before: dict[str, bytes], whole: dict[str, bytes]
) -> Outcome:
    code, said = end
    after = contents()
    torn = [path for path, data in whole.items() if after.get(path) not in (data, before.get(path))]
    torn += [path for path, data in before.items() if path not in whole and after.get(path) != data]
    left = [path for path in after if path not in whole and path not in before]
    lines = sum("cannot be written" in line for line in said.splitlines())
    return Outcome(kind, how, step, name, code, lines, "Traceback" in said, torn, left)


def as_promised(outcome: Outcome) -> bool:
    """Old or new and nothing else, whatever happens; and one line and the exit code that is documented."""
    if outcome.torn or outcome.traceback:
        return False
    if outcome.how == "kill":
        return outcome.code == -signal.SIGKILL
    if outcome.left and outcome.name != "unlink":
        return False
    if outcome.how in ("term", "hup", "int"):
        return outcome.code == 128 + ENDS[outcome.how]
    failed = 1 if outcome.kind == "batch" else 4  # 1: that one light of several failed
    if outcome.code == failed and (outcome.lines == 1 or (outcome.kind == "batch" and outcome.lines)):
        return True
    # What is taken away on the way out may stay, and so may the owner. Without links P writes all the same.
    return outcome.name in ("unlink", "chown", "link") and outcome.code == (outcome.kind == "difference")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("kinds", nargs="*", default=list(KINDS))
    parser.add_argument("--some", type=int)
    options = parser.parse_args()
    os.chdir(options.folder)
    give_pixels()
    count = 0
    for each in options.kinds:
        for outcome in outcomes(each, options.some):
            count += 1
            if not as_promised(outcome):
                print(outcome, flush=True)
    print(f"{count} runs")
