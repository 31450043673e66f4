"""The run of a report, from the first light to the last file. If it ends early, the part measured is kept and marked."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from shviewer.benchmark import experiments
from shviewer.benchmark.budget import STABILITY_SECONDS, Clock, Progress, allot
from shviewer.benchmark.front import sentences
from shviewer.benchmark.machine import machine_record, versions
from shviewer.benchmark.measured_lights import QUICK_TOLERANCES, TOLERANCES, MeasuredLight, find_measured_lights
from shviewer.benchmark.options import SECTIONS, Options
from shviewer.benchmark.page import plots, writing
from shviewer.benchmark.page.document import Report, read_report
from shviewer.benchmark.sections import AGAINST, Run, measure_sections
from shviewer.errors import OutputError
from shviewer.lights.light import Light


@dataclass(frozen=True)
class Summary:
    """The result of a run. rows: how many were measured. text: some lines for the terminal."""

    folder: Path
    files: tuple[str, ...]
    rows: int
    text: str
    stability_failed: bool = False


def write_report(
    lights: Sequence[str | Light], folder: Path, options: Options | None = None, progress: Progress | None = None
) -> Summary:
    """Measure `lights`, or experiments.LIGHTS if there are none, and write report.md, .json and .csv and plots into `folder`.

    OutputError, LightError or UsageError, before anything is measured, if that is impossible. An interrupt is raised again
    after the rows measured have been written as a partial report.
    """
    options = options or Options()
    before = None if options.against is None else read_report(options.against)
    writing.make_folder(folder)
    chosen = list(lights) or list(experiments.QUICK_LIGHTS if options.quick else experiments.LIGHTS)
    found = find_measured_lights(chosen, QUICK_TOLERANCES if options.quick else TOLERANCES, options.reading)
    wanted = {name: name in options.sections for name in SECTIONS} | {"peers": options.peers}
    seconds = allot(wanted, options.seconds) | ({"hard cases": STABILITY_SECONDS} if options.stability else {})
    report = Report(
        seed=options.seed,
        command=options.command or shlex.join(["shviewer", *sys.argv[1:]]),
        machine=machine_record(),
        versions=versions(),
        lights={measured.name: _light_record(measured) for measured in found},
    )
    texts = [text for text in chosen if isinstance(text, str)]
    run = Run(options, folder, report, writing.Page(found), texts, seconds, Clock(seconds, progress), before)
    run.write()
    try:
        measure_sections(run)
        report.complete = True
        paths, run.page.plot_message = plots.make_plots(report.rows, folder)
        run.page.plots += [path.name for path in paths]
    except BaseException:
        with suppress(OutputError):
            run.write()
        raise
    run.write()
    run.clock.finish()
    count = sum(row.measured for row in report.rows)
    return Summary(folder, (*writing.FILES, *run.page.plots), count, _summary(run), run.stability_failed)


def _light_record(measured: MeasuredLight) -> dict[str, object]:
    return {
        "description": measured.light.description,
        "best_method": measured.light.best_method,
        "accuracy": measured.light.accuracy(),
        "bands_within": {f"{tolerance:g}": count for tolerance, count in measured.needs.items()},
        "error_by_bands": measured.truncation.tolist(),
    }


def _summary(run: Run) -> str:
    lines = []
    for measured in run.page.lights:
        rows = [row for row in run.report.measured("projection") if row.light == measured.name]
        lines += [f"{measured.name}: {sentence}" for sentence in sentences(measured, rows)] if rows else []
    against = run.page.hosted.get(AGAINST, "").partition("\n")[0]
    return "\n".join([*lines, *([against] if against else [])])
