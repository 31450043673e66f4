"""`shviewer project`: one light into a file or onto stdout, or several into a folder, where a failure stops no other."""

from __future__ import annotations

import argparse
import os
import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from shviewer.analysis.figures import errors_of
from shviewer.analysis.projected import Projected, project_recipe
from shviewer.analysis.projections import sampling_of
from shviewer.analysis.recipe import Recipe, light_name
from shviewer.analysis.subjects import load_light, subject
from shviewer.cli.from_options import recipe_from, replacing_of
from shviewer.cli.jobs import in_order
from shviewer.cli.status_line import bar, speaking, status_line
from shviewer.coefficients.axes import Axes
from shviewer.coefficients.convention import OVER_PI, Convention
from shviewer.coefficients.programs import CONVENTIONS, parse_convention
from shviewer.coefficients.suns import sun_left_out
from shviewer.coefficients.writing import FORMATS
from shviewer.errors import OutputError, ShviewerError, UsageError, within_memory
from shviewer.lights.find import is_code, split_light
from shviewer.outputs import ANYTHING, Replacing, file_stem, write_atomically
from shviewer.words import counted, one_line

STDOUT = "-"
BATCH_FAILED = 1

ROUNDING = 1e-6
"""A minimum below zero by no more than this share of the largest coefficient counts as zero."""

RecipeOf = Callable[[str], Recipe]
"""LIGHT -> the recipe that the options ask for. It raises the errors of reading the light."""


@dataclass(frozen=True)
class Row:
    """A row of the summary: what became of one light."""

    light: str
    file: str
    projected: Projected | None = None
    error: str = ""


@dataclass(frozen=True)
class Noted:
    """What was made of a light, and the notes on it."""

    projected: Projected
    notes: tuple[str, ...]


def run(options: argparse.Namespace) -> int:

    convention = wanted_convention(options.convention, options.axes, options.no_phase, options.quantity)
    if convention.quantity:
        options.quantity = convention.quantity.removesuffix("-over-pi")
    if options.n_bands is None and options.tolerance is None and convention.most_bands:
        options.n_bands = min(Recipe.n_bands, convention.most_bands)

    lights = options.lights or ["green"]
    recipe_of = partial(_recipe_of, options, convention)
    with status_line() as line:
        show = line.show if line else None
        kind, replacing = options.format, replacing_of(options)
        return project_lights(lights, options.output, kind, convention, recipe_of, show, replacing, options.jobs)


def _recipe_of(options: argparse.Namespace, convention: Convention, light: str) -> Recipe:
    recipe, _ = recipe_from(options, light)
    if options.tolerance is not None:
        check_tolerance(recipe, convention)
    return recipe


def wanted_convention(text: str, axes: str | None, no_phase: bool, quantity: str | None) -> Convention:
    """The convention that --convention, --axes, --no-phase and --for name together. UsageError if they contradict."""
    try:
        convention = parse_convention(",".join([text, *([axes] if axes else []), *(["no-phase"] if no_phase else [])]))
    except ValueError as error:
        raise UsageError(str(error)) from error
    held = "irradiance" if convention.quantity == OVER_PI else convention.quantity
    if held is not None and quantity not in (None, held):
        raise UsageError(f"--for {quantity} contradicts --convention {text}, which takes {convention.quantity}")
    own = CONVENTIONS[convention.name]
    if axes and own.axes != Axes() and convention.axes != own.axes:
        raise UsageError(
            f"--axes {axes} contradicts --convention {text}: {own.name} expects {own.axes.words}; for its numbers in other "
            f"axes write --convention {own.name},{axes}"
        )
    return convention


def check_tolerance(recipe: Recipe, convention: Convention) -> None:
    """UsageError if the tolerance needs more bands than the program has; it says what those reach, and what may help."""
    most = convention.most_bands
    if most is None or recipe.n_bands <= most:
        return
    bands = counted(most, "band")
    reached = float(errors_of(load_light(recipe), *sampling_of(recipe))[most - 1])
    suns = () if recipe.split_sun else subject(replace(recipe, split_sun=True)).suns
    remedy = "take its sun out, --split-sun, or " if suns else ""
    raise UsageError(
        f"{light_name(recipe.light)}: {100 * recipe.tolerance:g} % needs more than the {bands} that {convention.name} takes, "
        f"which reach {100 * reached:.3g} %; {remedy}give --bands {most}"
    )


def project_lights(
    lights: Sequence[str],
    out: str,
    kind: str | None,
    convention: Convention,
    recipe_of: RecipeOf,
    status: Callable[[str], None] | None = None,
    replacing: Replacing = ANYTHING,
    jobs: int | None = 1,
) -> int:
    """Project and write; return the exit code. status: shows a line of progress, or clears it for "".

    replacing: what may be replaced by what is written. jobs: as in `jobs.in_order`.

    One light: `out` is a file, a folder that exists, or "-". Several: `out` is a folder, made if need be; the code is
    BATCH_FAILED if any of them failed. ShviewerError for one light that fails, or arguments that fit no light.
    """
    if kind is not None and kind not in FORMATS:
        raise UsageError(f"format {kind!r}: it must be one of {', '.join(FORMATS)}")
    if len(lights) > 1:
        return _batch(lights, out, kind or "json", convention, recipe_of, status, replacing, jobs)
    (light,) = lights
    if out == STDOUT:
        if kind is None:
            raise UsageError(f"-o -: stdout has no suffix to go by; name a format: --format {', '.join(FORMATS)}")
        projected = _noted(light, recipe_of, convention)
        if sys.stdout is None:  # closed by whoever started this
            raise OutputError("-o -: stdout is closed; name a file")
        sys.stdout.buffer.write(projected.encode(convention, kind))
        sys.stdout.buffer.flush()
        _warn_below_zero(projected)
        return 0
    path = Path(out)
    if os.path.isdir(path):
        projected = _noted(light, recipe_of, convention)
        path = path / f"{file_stem(projected.name)}.{kind or 'json'}"
        replacing.check(path)
    else:
        kind = _kind_of(path, kind)
        replacing.check(path)
        projected = _noted(light, recipe_of, convention)
    write_atomically(path, projected.encode(convention, kind or "json"))
    radiance, irradiance = (_percent(projected, quantity) for quantity in ("radiance", "irradiance"))
    print(
        f"wrote {path}: {_bands(projected)}, radiance within {radiance.removeprefix('< ')}, as irradiance {irradiance}"
    )
    _warn_below_zero(projected)
    return 0


def _batch(
    lights: Sequence[str],
    out: str,
    kind: str,
    convention: Convention,
    recipe_of: RecipeOf,
    status: Callable[[str], None] | None,
    replacing: Replacing,
    jobs: int | None,
) -> int:
    folder = Path(out)
    if out == STDOUT or folder.suffix[1:] in FORMATS:
        raise UsageError(f"-o {out}: {len(lights)} lights are written into a folder, one file each; name a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(f"{folder}: no folder can be made: {error.strerror}; choose another place") from error
    rows: list[Row] = []
    outcomes = in_order(partial(_attempt, recipe_of, convention), lights, jobs)
    for number, light in enumerate(lights):
        if is_code(light):
            print(one_line(f"shviewer: note: {light}: runs the code in {split_light(light)[0]}"), file=sys.stderr)
        if status:
            status(f"{bar(number / len(lights))} {number + 1} of {len(lights)}  {light[:60]}")
        outcome = next(outcomes)
        rows.append(_one_of_many(light, outcome, folder, kind, convention, {row.file for row in rows}, replacing))
        if rows[-1].error:
            if status:
                status("")
            print(f"shviewer: {rows[-1].error}", file=sys.stderr)
    if status:
        status("")
    print(summary(rows))
    return BATCH_FAILED if any(row.error for row in rows) else 0


def _one_of_many(
    light: str,
    outcome: Noted | ShviewerError,
    folder: Path,
    kind: str,
    convention: Convention,
    taken: set[str],
    replacing: Replacing,
) -> Row:
    """Write what was made of one light of a batch under a name of its own; return its row of the summary."""
    if isinstance(outcome, ShviewerError):
        return Row(light, "", error=str(outcome))
    try:
        projected = _said(outcome)
        stem = file_stem(projected.name)
        names = (f"{stem}{f'-{number}' if number > 1 else ''}.{kind}" for number in range(1, len(taken) + 2))
        path = next(folder / name for name in names if str(folder / name) not in taken)
        replacing.check(path)
        write_atomically(path, projected.encode(convention, kind))
        _warn_below_zero(projected)
    except ShviewerError as error:
        return Row(light, "", error=str(error))
    return Row(light, str(path), projected)


def _attempt(recipe_of: RecipeOf, convention: Convention, light: str) -> Noted | ShviewerError:
    """What is made of one light of a batch, whatever happens."""
    try:
        with within_memory(light):
            return _note(recipe_of, convention, light)
    except ShviewerError as error:
        return error
    except Exception as error:  # a fault of this program fails this light alone
        traceback.print_exc()
        return ShviewerError(f"{light}: internal error, {type(error).__name__}: {error}")


def _note(recipe_of: RecipeOf, convention: Convention, light: str) -> Noted:
    """Project a light, and note what was done to it and what became of its suns."""
    recipe = recipe_of(light)
    projected = project_recipe(recipe)
    suns = [sun_left_out(sun.directional_light, convention.axes) for sun in projected.suns]
    notes = *projected.notes, *suns
    return Noted(projected, tuple(one_line(f"shviewer: note: {projected.name}: {note}") for note in notes))


def _said(noted: Noted) -> Projected:
    """Say on stderr what was noted."""
    for note in noted.notes:
        print(note, file=sys.stderr)
    return noted.projected


def _noted(light: str, recipe_of: RecipeOf, convention: Convention) -> Projected:
    """Project a light; stderr says what was done to it."""
    with speaking():
        noted = _note(recipe_of, convention, light)
    return _said(noted)


def _warn_below_zero(projected: Projected) -> None:
    """Say on stderr if the reconstruction that was written is below zero by more than rounding."""
    minimum = projected.figures.extremes.minimum
    if minimum >= -ROUNDING * float(np.abs(projected.coefficients).max()):
        return
    says = f"the {projected.quantity} of its {_bands(projected)} goes to {minimum:.3g}"
    remedy = "" if projected.about["window"] == "dering" else "; --window dering takes that away"
    print(f"shviewer: note: {projected.name}: {says}{remedy}", file=sys.stderr)


def _kind_of(path: Path, kind: str | None) -> str:
    """The format by the suffix, which must not contradict `kind`."""
    suffix = path.suffix.lower()[1:]
    if kind is None and suffix not in FORMATS:
        raise UsageError(f"{path}: FILE must end in .{', .'.join(FORMATS)}, or name a format: --format json")
    if kind is not None and suffix in FORMATS and suffix != kind:
        raise UsageError(f"{path} and --format {kind} contradict each other; leave out --format")
    return kind or suffix


def summary(rows: Sequence[Row]) -> str:
    """A table: light, bands, relative L2 errors of both quantities, the minimum of the one that is written, and the file."""
    width = max(len("light"), *(min(len(row.light), 40) for row in rows))
    lines = [f"{'light':<{width}}  bands   radiance  irradiance     minimum  file"]
    for row in rows:
        label = row.light if len(row.light) <= 40 else f"...{row.light[-37:]}"
        if row.projected is None:
            lines.append(f"{label:<{width}}  failed")
            continue
        figures = row.projected.figures
        errors = f"{_percent(row.projected, 'radiance'):>9}  {_percent(row.projected, 'irradiance'):>10}"
        numbers = f"{row.projected.n_bands:>5}  {errors}  {figures.extremes.minimum:>10.4g}"
        lines.append(f"{label:<{width}}  {numbers}  {row.file}")
    failed = sum(1 for row in rows if row.error)
    return "\n".join([*lines, f"{len(rows) - failed} of {len(rows)} written"])


def _bands(projected: Projected) -> str:
    return counted(projected.n_bands, "band")


def _percent(projected: Projected, quantity: str) -> str:
    """The relative L2 error, or the floor below which it cannot be told from rounding."""
    error, floor = projected.relative_l2_as[quantity], projected.figures.floor
    return f"{100 * error:.3g} %" if error >= floor else f"< {100 * floor:.0e} %"
