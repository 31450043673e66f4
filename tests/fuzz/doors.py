"""What every door promises about any bytes whatever: coefficients, scenes, comparisons, reports, references, arguments.

It is read, and what comes of it is finite and can be told, or one ShviewerError of one safe line is raised; within 2 s of
the processor and 200 MB; nothing is written, started, connected or run; and nothing is printed on the way.
"""

from __future__ import annotations

import contextlib
import io
import os
import sys
import tempfile
import time
import warnings
import weakref
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import promise
from door_seeds import seeds
from promise import DIRECTIONS, MOST_BYTES_BEYOND_IMAGE, BrokenPromise, forget_peak, peak_bytes
from watch import remove, unwatched, watched

import shviewer.lights.suns.compact_sources  # noqa: F401 - a reader loads it late, and making its classes runs code
from shviewer.analysis.cache import MEMORY
from shviewer.analysis.comparing.compared_files import compared_with
from shviewer.analysis.comparing.comparison import verdict
from shviewer.analysis.information import describe
from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light
from shviewer.benchmark.options import Options
from shviewer.benchmark.page import changes
from shviewer.benchmark.rows.comparing import compare
from shviewer.benchmark.rows.report import read_report
from shviewer.cli import help as help_pages
from shviewer.cli import info
from shviewer.cli.info import as_text
from shviewer.cli.main import _check_first
from shviewer.cli.options.inputs import reading_from
from shviewer.cli.options.modes import MODES, PARSERS
from shviewer.cli.options.recipes import recipe_from
from shviewer.cli.options.states import state_from
from shviewer.cli.project import wanted_convention
from shviewer.cli.sweep import _check_sweep
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.reading import read_coefficients
from shviewer.coefficients.writing import FORMATS
from shviewer.errors import ShviewerError
from shviewer.lights.find import find_light
from shviewer.lights.reading import Reading
from shviewer.limits import DEFAULT_LIMITS
from shviewer.outputs import OURS
from shviewer.viewer.saving.reference import compare_with_reference
from shviewer.viewer.saving.restoring import _read, _restored
from shviewer.viewer.saving.stamp_reading import state_of_stamp

MOST_CHARACTERS = 1000

TOLD = 5
"""One in so many of the lights that are read is also described as `info` does; one in 2 TOLD is written and read again."""

NAMES = (
    "new\nline",
    "\x1b[2J\x1b]0;x\x07",
    "\udcff\udcfe",
    "green",
    "a:b",
    " ",
    "-o",
    "x" * 240,
    "\u202eexr",
    "%s{}\\",
)
"""Stems of files, which one input in eight gets."""

_CONVENTIONS = (
    *("shviewer", "shviewer", "three", "scipy", "filament", "ambix,z-up", "shviewer,4pi,irradiance"),
    *("3dgs,bgr,times=2", "shtools", "arkit-phase", "shviewer,by-channel,order-fuma,schmidt"),
)


def _number_of(data: bytes) -> int:
    """A number that follows from the input: by it the names, conventions and further steps are chosen."""
    return _SOUND if data in _sound() else zlib.crc32(data)


_SOUND = len(_CONVENTIONS)
"""The number of a seed: it is read under its own name, in our own convention, and described."""


@cache
def _sound() -> frozenset[bytes]:
    return frozenset(seeds().values())


def _light(path: Path, data: bytes) -> Iterator[object]:
    number = _number_of(data)
    stamped = any(mark in data for mark in OURS) == (number % 16 != 0)  # a stamp and a named convention are too many
    reading = Reading(convention="" if stamped else _CONVENTIONS[number % len(_CONVENTIONS)])
    light = find_light(str(path), reading)
    yield from (light.radiance(DIRECTIONS), light.coefficients(3), light.description)
    MEMORY.clear()
    if number // 8 % TOLD == 0:
        yield as_text(describe(str(path), reading))
    if number // 8 % (2 * TOLD) == 1:
        kind = FORMATS[number // 64 % len(FORMATS)]
        written = project_recipe(Recipe(str(path), reading, n_bands=2))
        encoded = written.encode(CONVENTIONS["shviewer"], kind)
        with unwatched(), tempfile.TemporaryDirectory() as folder:
            again = Path(folder, f"again.{kind}")
            again.write_bytes(encoded)
            read = read_coefficients(again)
        if not np.array_equal(read.coefficients, written.coefficients):
            raise BrokenPromise(f"written as {kind}, other coefficients come back")


def _compare(path: Path, data: bytes) -> Iterator[object]:
    recipe, said = compared_with(Recipe("green"), str(path))
    assert recipe.compare is not None
    yield from (recipe.compare.given, said, verdict(load_light(recipe), recipe.compare))


def _against(path: Path, data: bytes) -> Iterator[object]:
    found, sound = read_report(path), _sound_report()
    found.as_json()  # only what is finite can be
    for pair in ((found, sound), (sound, found)):
        yield from changes.lines(compare(*pair), "old.json")


def _sound_report() -> Any:
    with unwatched(), tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "report.json")
        path.write_bytes(seeds()["against/report.json"])
        return read_report(path)


def _reference(path: Path, data: bytes) -> Iterator[object]:
    pixels = np.zeros((8, 12, 3), np.uint8)
    yield compare_with_reference(pixels, path, path.with_name("difference.png"), threshold=1.0)


def _stamp(path: Path, data: bytes) -> Iterator[object]:
    """The state that a stamp tells, and that of a picture which carries it and names its light."""
    text = data.decode("utf-8", "surrogateescape")
    with contextlib.suppress(ShviewerError):
        found = _restored(text, _read(text), path, DEFAULT_LIMITS, None)
        yield from (found.said, found.size or (1, 1), found.state.view.zoom)
    state = state_of_stamp(text)
    state.check()
    yield from (state.view.camera or 0.0, state.view.zoom, state.view.light_rotation)


def _arguments(path: Path, data: bytes) -> Iterator[object]:
    """The arguments parsed and made into what is done; the modes that only print are run."""
    argv = [os.fsdecode(part) for part in data.replace(b"\0", b"").split(b"\n")]  # an argument has no zero byte
    printed, complaint = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(complaint):
            _parsed(argv)
    except SystemExit as error:  # of argparse: --help, --version, or one line
        if error.code == 2:
            raise ShviewerError(_single(complaint.getvalue())) from None
        if error.code:
            raise BrokenPromise(f"exit code {error.code}") from None
    for line in complaint.getvalue().splitlines():
        yield _single(line + "\n")


def _single(text: str) -> str:
    if not text.endswith("\n") or not text[:-1].isprintable():
        raise BrokenPromise(f"prints {text[:200]!r}")
    return text[:-1]


def _parsed(argv: list[str]) -> None:
    if argv[:1] == ["help"]:
        help_pages.run(argv[1:])
        return
    _check_first(argv)
    mode, rest = (argv[0], argv[1:]) if argv[:1] and argv[0] in MODES else ("view", argv)
    options = PARSERS[mode]().parse_intermixed_args(rest)
    if (vars(options).get("samples") or 0) > 10_000 or len(vars(options).get("lights") or ()) > 20:
        return  # honest work of any length
    if mode == "info":
        options.jobs = 1  # more are processes, which are not the input's fault
        info.run(options)
    elif mode == "project":
        wanted_convention(options.convention, options.axes, options.no_phase, options.quantity)
        for light in options.lights:
            recipe_from(options, light)
    elif mode == "report":
        reading = reading_from(options)
        Options(
            options.budget or 120.0,
            seed=options.seed,
            methods=tuple((options.methods or "").split(",")),
            reading=reading,
        )
    else:
        if mode == "sweep":
            _check_sweep(options)
        if mode != "view" or not (options.list_keys or options.list_lights):
            state_from(options, all_lights=mode == "view")


DOORS: dict[str, Callable[[Path, bytes], Iterator[object]]] = {
    "light": _light,
    "compare": _compare,
    "against": _against,
    "reference": _reference,
    "stamp": _stamp,
    "arguments": _arguments,
}
"""Door -> what is done with a file: it gives arrays, which must be finite, and texts, which must be short of no line."""


class DoorWitness:
    """Checks inputs one after the other in one process, in a folder of its own, which is the current one meanwhile."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp())
        self._stderr, name = tempfile.mkstemp()
        os.unlink(name)
        weakref.finalize(self, os.close, self._stderr)
        weakref.finalize(self, remove, self.folder)
        (self.folder / "nine.json").write_bytes(seeds()["light/written.json"])
        (self.folder / "bare.txt").write_bytes(seeds()["light/rows.txt"])
        forget_peak()
        self.start = peak_bytes()

    def check(self, name: str, data: bytes) -> bool:
        """Whether the input was accepted. BrokenPromise if the door misbehaved."""
        door, _, file = name.partition("/")
        number = _number_of(data)
        plain = door not in ("light", "compare") or number % 8 != 0
        path = Path(file) if plain else Path(NAMES[number // 8 % len(NAMES)] + Path(file).suffix)
        forget_peak()
        here = os.getcwd()
        os.chdir(self.folder)
        try:
            path.write_bytes(data)
            began = time.process_time()
            with self._quiet(), watched(self.folder) as done:
                accepted = _outcome(door, path, data, plain)
            seconds = time.process_time() - began
        finally:
            path.unlink(missing_ok=True)
            os.chdir(here)
        if done:
            raise BrokenPromise(f"did what reading must not: {done[0]}")
        if seconds > promise.MOST_SECONDS:
            raise BrokenPromise(f"took {seconds:.1f} s")
        grown = peak_bytes() - self.start
        if grown > MOST_BYTES_BEYOND_IMAGE:
            raise BrokenPromise(f"took {grown / 1e6:.0f} MB")
        return accepted

    @contextlib.contextmanager
    def _quiet(self) -> Iterator[None]:
        """BrokenPromise if anything is printed, by Python or from C, or warned of."""
        sys.stdout.flush()
        kept = [os.dup(number) for number in (1, 2)]
        printed = io.StringIO()
        os.ftruncate(self._stderr, 0)
        os.lseek(self._stderr, 0, os.SEEK_SET)
        for number in (1, 2):
            os.dup2(self._stderr, number)
        try:
            with (
                warnings.catch_warnings(record=True) as warned,
                contextlib.redirect_stdout(printed),
                contextlib.redirect_stderr(printed),
            ):
                warnings.simplefilter("always")
                yield
        finally:
            for number, saved in zip((1, 2), kept, strict=True):
                os.dup2(saved, number)
                os.close(saved)
        said = [f"warned {warning.category.__name__}: {warning.message}" for warning in warned]
        said += [f"printed {printed.getvalue()[:200]!r}"] if printed.getvalue() else []
        if os.fstat(self._stderr).st_size:
            said.append(f"printed {os.pread(self._stderr, 200, 0)!r}")
        if said:
            raise BrokenPromise(said[0])


def _outcome(door: str, path: Path, data: bytes, plain: bool) -> bool:
    try:
        for part in DOORS[door](path, data):
            if isinstance(part, str):
                if not all(line.isprintable() and len(line) <= 2 * MOST_CHARACTERS for line in part.split("\n")):
                    raise BrokenPromise(f"says {part[:200]!r}")
            elif not np.isfinite(np.asarray(part, dtype=np.complex128)).all():
                raise BrokenPromise("gives values that are not finite")
    except ShviewerError as error:
        message = str(error)
        named = door in ("arguments", "stamp") or not plain or message.startswith(f"{path}: ")
        if not (message.isprintable() and named and 0 < len(message) <= MOST_CHARACTERS):
            raise BrokenPromise(f"refused with {message[:200]!r}") from None
        return False
    except (BrokenPromise, KeyboardInterrupt):
        raise
    except BaseException as error:
        where = _innermost(error)
        raise BrokenPromise(f"{type(error).__name__} at {where}: {str(error)[:200]}") from error
    return True


def _innermost(error: BaseException) -> str:
    """The last line of this program in the traceback."""
    where, at = "", error.__traceback__
    while at:
        file = Path(at.tb_frame.f_code.co_filename)
        if "shviewer" in file.parts and "fuzz" not in file.parts[-2:]:
            where = f"{file.name}:{at.tb_lineno}"
        at = at.tb_next
    return where
