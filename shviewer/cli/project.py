"""`shviewer project`: what its options ask for, and one light into a file or onto stdout."""

from __future__ import annotations

import argparse
import os
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

from shviewer.analysis.figures import errors_of
from shviewer.analysis.projected import Projected, project_recipe
from shviewer.analysis.projections import way_of
from shviewer.analysis.recipe import Recipe, light_name
from shviewer.analysis.subjects import has_suns, load_light
from shviewer.cli.batch import Work, error_in_percent, project_batch
from shviewer.cli.below_zero import below_zero, encoded_below_zero
from shviewer.cli.notes import print_notes_on, warn_below_zero
from shviewer.cli.options.inputs import lights_of, lights_within, replacing_of
from shviewer.cli.options.recipes import check_effects, check_for_any_light, recipe_from
from shviewer.cli.options.states import turn_from
from shviewer.cli.status_line import speaking
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.axes import Axes
from shviewer.coefficients.parts.quantities import whole
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.coefficients.texts import convention_text, parse_convention
from shviewer.coefficients.writing import FORMATS
from shviewer.errors import OutputError, UsageError, refused_as
from shviewer.harmonics.quantities.names import ENCODED_BANDS, IRRADIANCE, in_words
from shviewer.harmonics.rotation import turn
from shviewer.outputs import file_stem, make_folder, write_atomically
from shviewer.words import counted, meant

STDOUT = "-"


def run(options: argparse.Namespace) -> int:
    """Project and write. ShviewerError for one light that fails, or arguments that fit no light."""
    convention = wanted_convention(options.convention, options.axes, options.no_phase, options.quantity)
    if options.n_bands is not None and options.tolerance is not None:
        raise UsageError(f"--bands {options.n_bands} and --tolerance {options.tolerance:g}: give one of them")
    if options.encode is not None:
        check_encode(options, convention)
    if convention.quantity:
        options.quantity = whole(convention.quantity)
    if options.n_bands is None and options.tolerance is None and convention.most_bands:
        options.n_bands = min(Recipe.n_bands, convention.most_bands)

    given, out, kind = lights_of(options), options.output, options.format
    lights = options.lights = lights_within(options)
    if kind is not None and kind not in FORMATS:
        raise UsageError(f"format {kind!r}: {meant(kind, FORMATS)}")
    work = Work(partial(_projected_of, options, convention), convention, replacing_of(options))
    check_for_any_light(options)
    if options.n_bands is not None:
        with refused_as(UsageError):
            convention.check_bands(options.n_bands)
    if lights == given and len(lights) == 1:
        _project_one(lights[0], out, kind, work)
        return 0
    if out == STDOUT or Path(out).suffix[1:] in FORMATS:
        raise UsageError(f"-o {out}: {len(lights)} lights are written into a folder, one file each; name a folder")
    return project_batch(lights, Path(out), kind or "json", work, options.jobs)


def _projected_of(options: argparse.Namespace, convention: Convention, light: str) -> Projected:
    """What the options make of a light. LightError or UsageError."""
    recipe, _ = recipe_from(options, light)
    check_effects(options, recipe)
    if options.tolerance is not None:
        check_tolerance(recipe, convention)
    projected, angles = project_recipe(recipe, options.encode or ""), turn_from(options)
    if projected.encoding and projected.stored is None:
        what = "--mute" if projected.recipe and projected.recipe.muted_shown else f"--window {options.window}"
        raise UsageError(f"{what}: the formula of {projected.encoding} takes no factors of bands; leave one out")
    projected = projected.turned(turn(*angles)) if angles else projected
    said = encoded_below_zero(projected, recipe) if projected.encoding else below_zero(recipe, convention)
    return replace(projected, below_zero=said)


def check_encode(options: argparse.Namespace, convention: Convention) -> None:
    """Let the options be those of --encode. UsageError if they contradict it."""
    name = options.encode
    if name not in ENCODED_BANDS:
        raise UsageError(f"--encode {name!r}: {meant(name, ENCODED_BANDS)}")
    if options.n_bands is not None or options.tolerance is not None:
        raise UsageError(f"--encode {name}: it takes the place of bands; leave out --bands and --tolerance")
    if convention != replace(OURS, axes=convention.axes):
        raise UsageError(
            f"--encode {name}: its formula takes shviewer's own numbers, not those of {convention_text(convention)}; for other "
            "axes give --axes, such as --axes y-up"
        )
    options.quantity, options.n_bands = options.quantity or IRRADIANCE, ENCODED_BANDS[name]


def wanted_convention(text: str, axes: str | None, no_phase: bool, quantity: str | None) -> Convention:
    """The convention that --convention, --axes, --no-phase and --for name together. UsageError if they contradict."""
    with refused_as(UsageError):
        convention = parse_convention(",".join([text, *([axes] if axes else []), *(["no-phase"] if no_phase else [])]))
    if convention.quantity and quantity not in (None, whole(convention.quantity)):
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
    reached = float(errors_of(load_light(recipe), way_of(recipe))[most - 1])
    remedy = "take its sun out, --split-sun, or " if has_suns(recipe) else ""
    raise UsageError(
        f"{light_name(recipe.light)}: {100 * recipe.tolerance:g} % needs more than the {bands} that {convention.name} takes, "
        f"which reach {100 * reached:.3g} %; {remedy}give --bands {most}"
    )


def _project_one(light: str, out: str, kind: str | None, work: Work) -> None:
    """Project and write one light; `out` is a file, a folder that exists or ends in /, or "-"."""
    convention = work.convention

    def noted() -> Projected:
        with speaking():
            projected = work.project(light)
        print_notes_on(projected, convention.axes, projected.name)
        return projected

    if out == STDOUT:
        if kind is None:
            raise UsageError(f"-o -: stdout has no suffix to go by; name a format: --format {', '.join(FORMATS)}")
        projected = noted()
        if sys.stdout is None:  # closed by whoever started this
            raise OutputError("-o -: stdout is closed; name a file")
        sys.stdout.buffer.write(projected.encode(convention, kind))
        sys.stdout.buffer.flush()
        warn_below_zero(projected, projected.name)
        return
    path = Path(out)
    if os.path.isdir(path) or out.endswith(("/", os.sep)):
        projected = noted()
        make_folder(path)
        path = path / f"{file_stem(projected.name)}.{kind or 'json'}"
        work.replacing.check(path)
    else:
        kind = _kind_of(path, kind)
        work.replacing.check(path)
        projected = noted()
    write_atomically(path, projected.encode(convention, kind or "json"))
    first, *others = ((in_words(of), error_in_percent(projected, of)) for of in projected.relative_l2_as)
    as_others = "".join(f", as {of} {error}" for of, error in others)
    print(f"wrote {path}: {projected.extent}, {first[0]} within {first[1].removeprefix('< ')}{as_others}")
    warn_below_zero(projected, projected.name)


def _kind_of(path: Path, kind: str | None) -> str:
    """The format by the suffix, which must not contradict `kind`."""
    suffix = path.suffix.lower()[1:]
    if kind is None and suffix not in FORMATS:
        raise UsageError(f"{path}: FILE must end in .{', .'.join(FORMATS)}, or name a format: --format json")
    if kind is not None and suffix in FORMATS and suffix != kind:
        raise UsageError(f"{path} and --format {kind} contradict each other; leave out --format")
    return kind or suffix
