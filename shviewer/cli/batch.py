"""Several lights projected into a folder, one file each, and the table of what became of them: a failure stops no other."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

from shviewer.analysis.projected import Projected
from shviewer.cli.jobs import in_order
from shviewer.cli.notes import print_notes_on, warn_below_zero
from shviewer.cli.status_line import bar, status_line
from shviewer.coefficients.convention import Convention
from shviewer.errors import ShviewerError, within_memory
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE, in_words
from shviewer.lights.find import is_code, split_light
from shviewer.outputs import Replacing, file_stem, make_folder, write_atomically
from shviewer.words import one_line

FAILED = 1
"""The exit code if some light failed."""


class Work(NamedTuple):
    """What is done with every light. project: LIGHT -> its coefficients, in any process."""

    project: Callable[[str], Projected]
    convention: Convention
    replacing: Replacing


@dataclass(frozen=True)
class SummaryRow:
    """A row of the summary: what became of one light."""

    light: str
    file: str = ""
    projected: Projected | None = None
    """None: it failed."""


def project_batch(lights: Sequence[str], folder: Path, kind: str, work: Work, jobs: int | None) -> int:
    """Project every light and write it into `folder`, made if need be; return the exit code. jobs: as in `jobs.in_order`."""
    make_folder(folder)
    rows: list[SummaryRow] = []
    outcomes = in_order(partial(_projected_alone, work.project), lights, jobs)
    with status_line() as line:
        for number, light in enumerate(lights):
            if is_code(light):
                print(one_line(f"shviewer: note: {light}: runs the code in {split_light(light)[0]}"), file=sys.stderr)
            if line:
                line.show(f"{bar(number / len(lights))} {number + 1} of {len(lights)}  {light[:60]}")
            try:
                projected = next(outcomes)
                if isinstance(projected, ShviewerError):
                    raise projected
                with failing_alone(light):
                    print_notes_on(projected, work.convention.axes, light)
                    path = _free(folder, file_stem(projected.name), kind, {row.file for row in rows})
                    work.replacing.check(path)
                    write_atomically(path, projected.encode(work.convention, kind))
                    warn_below_zero(projected, light)
            except ShviewerError as error:
                rows.append(SummaryRow(light))
                if line:
                    line.clear()
                print(f"shviewer: {error}", file=sys.stderr)
            else:
                rows.append(SummaryRow(light, str(path), projected))
    print(summary(rows))
    return FAILED if any(row.projected is None for row in rows) else 0


def _projected_alone(project: Callable[[str], Projected], light: str) -> Projected:
    with failing_alone(light):
        return project(light)


@contextmanager
def failing_alone(light: str) -> Iterator[None]:
    """Turn whatever goes wrong with one light of a batch into a ShviewerError, a fault of this program, too."""
    try:
        with within_memory(light):
            yield
    except ShviewerError:
        raise
    except Exception as error:
        traceback.print_exc()
        raise ShviewerError(f"{light}: internal error, {type(error).__name__}: {error}") from error


def _free(folder: Path, stem: str, kind: str, taken: set[str]) -> Path:
    """The first of stem.kind, stem-2.kind, ... that no light of this batch has."""
    names = (f"{stem}{f'-{number}' if number > 1 else ''}.{kind}" for number in range(1, len(taken) + 2))
    return next(folder / name for name in names if str(folder / name) not in taken)


def summary(rows: Sequence[SummaryRow]) -> str:
    """A table: light, bands, relative L2 errors of the quantities, the minimum of the one that is written, and the file."""
    width = max(len("light"), *(min(len(row.light), 40) for row in rows))
    done = [row.projected for row in rows if row.projected is not None]
    quantities = list(dict.fromkeys(of for projected in done for of in projected.relative_l2_as)) or [
        RADIANCE,
        IRRADIANCE,
    ]
    heads = "  ".join(f"{in_words(quantity):>10}" for quantity in quantities)
    count = "numbers" if done and done[0].stored is not None else "  bands"
    lines = [f"{'light':<{width}}  {count} {heads}     minimum  file"]
    for row in rows:
        label = row.light if len(row.light) <= 40 else f"...{row.light[-37:]}"
        if row.projected is None:
            lines.append(f"{label:<{width}}  failed")
            continue
        known = row.projected.relative_l2_as
        said = [(of, error_in_percent(row.projected, of) if of in known else "-") for of in quantities]
        errors = "  ".join(f"{error:>{max(10, len(in_words(of)))}}" for of, error in said)
        minimum = row.projected.lows.minimum
        held = row.projected.n_bands if row.projected.stored is None else len(row.projected.stored.numbers)
        numbers = f"{held:>7} {errors}  {minimum:>10.4g}"
        lines.append(f"{label:<{width}}  {numbers}  {row.file}")
    written = sum(row.projected is not None for row in rows)
    return "\n".join([*lines, f"{written} of {len(rows)} written"])


def error_in_percent(projected: Projected, quantity: str) -> str:
    """The relative L2 error, or the floor below which it cannot be told from rounding."""
    error, floor = projected.relative_l2_as[quantity], projected.sums.floor
    return f"{100 * error:.3g} %" if error >= floor else f"< {100 * floor:.0e} %"
