"""The run of a report, section after section. If it ends early, the part measured is kept and marked."""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from shviewer.benchmark import encodings, end_to_end, experiments, moving, projection_rows, roughness
from shviewer.benchmark.front import sentences, where_bands_stop_paying
from shviewer.benchmark.hard_cases import table as stability
from shviewer.benchmark.hard_cases.shader import renderer_or_reason
from shviewer.benchmark.machine import machine_record, versions, yardstick
from shviewer.benchmark.measured_lights import QUICK_TOLERANCES, TOLERANCES, MeasuredLight, find_measured_lights
from shviewer.benchmark.options import Clock, Options, Progress
from shviewer.benchmark.page import moving_page, plots, writing
from shviewer.benchmark.page.comparing import compare
from shviewer.benchmark.page.document import YARDSTICK, Report, read_report
from shviewer.benchmark.page.tables import lines_not_measured, rows_table
from shviewer.benchmark.peers import INSTALL, peer_rows
from shviewer.benchmark.reconstruction_rows import BANDS, reconstruction_rows
from shviewer.benchmark.row import Row, not_measured
from shviewer.benchmark.timing import summarise
from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
from shviewer.ending import at_the_end
from shviewer.errors import UsageError
from shviewer.lights.find import file_of, split_light
from shviewer.lights.light import Light
from shviewer.outputs import Replacing
from shviewer.viewer.gl.renderer import Renderer

PEER_BANDS = (3, 9, 16, 32)
QUICK_RECONSTRUCTED = (3, 16)
QUICK_REPEATS = 3
"""The repeats in a quick report, in which five of the slow ones do not fit."""

AGAINST = "Against an older report"


@dataclass(frozen=True)
class Summary:
    """The result of a run. rows: how many were measured. text: some lines for the terminal."""

    folder: Path
    files: tuple[str, ...]
    rows: int
    text: str
    stability_failed: bool = False


@dataclass
class Run:
    """A report in the making. Every section adds to it and is written at once."""

    options: Options
    folder: Path
    report: Report
    page: writing.Page
    texts: list[str]
    """The LIGHTs that can be named to another process."""
    seconds: Mapping[str, float]
    """The sections wanted, and the time of each."""
    clock: Clock
    before: Report | None
    yardstick: list[float] = field(default_factory=list)
    stability_failed: bool = False

    def add(self, rows: Sequence[Row]) -> None:
        """Add rows, measured and not measured."""
        self.report.rows += rows
        if any(row.measured for row in rows):
            self.yardstick += yardstick()
            times = summarise(self.yardstick)
            self.report.yardstick_milliseconds = dict(zip(YARDSTICK, times[:3], strict=True))
        self.report.left_out = lines_not_measured(self.report.rows)

    def write(self) -> None:
        if self.before is not None and self.options.against is not None:
            lines = compare(self.before, self.report).as_markdown(self.options.against.name)
            self.page.hosted = {AGAINST: ""} | self.page.hosted | {AGAINST: "\n".join(lines)}  # it comes first
        writing.write(self.folder, self.report, self.page)

    def measure(self, section: str, measured_by: Callable[..., None], *drawing: Renderer | str) -> None:
        """Measure a section, if it is wanted, and write what it found."""
        if section in self.seconds:
            self.clock.begin(section)
            measured_by(self, *drawing)
            self.write()


def write_report(
    lights: Sequence[str | Light], folder: Path, options: Options | None = None, progress: Progress | None = None
) -> Summary:
    """Measure `lights`, or experiments.LIGHTS if there are none, and write report.md, .json and .csv and plots into `folder`.

    OutputError, LightError or UsageError, before anything is measured, if that is impossible or would destroy a file. An
    interrupt is raised again after the rows measured have been written as a partial report.
    """
    options = options or Options()
    before = None if options.against is None else read_report(options.against)
    chosen = list(lights) or list(experiments.QUICK_LIGHTS if options.quick else experiments.LIGHTS)
    if options.moving:
        _check_moving(chosen)
    writing.make_folder(folder)
    found = find_measured_lights(chosen, QUICK_TOLERANCES if options.quick else TOLERANCES, options.reading)
    inputs = [*map(file_of, chosen), options.against]
    replacing = Replacing(tuple(path for path in inputs if path), options.force)
    for name in (*writing.FILES, *plots.names_of([measured.name for measured in found])):
        replacing.check(folder / name)
    seconds = options.seconds()
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
    with at_the_end(run.write):
        _measure_sections(run)
        report.complete = True
        paths, run.page.plot_message = plots.make_plots(report.rows, folder, report.extra)
        run.page.plots += [path.name for path in paths]
    run.clock.finish()
    count = sum(row.measured for row in report.rows)
    return Summary(folder, (*writing.FILES, *run.page.plots), count, _summary(run), run.stability_failed)


def _check_moving(lights: Sequence[str | Light]) -> None:
    """UsageError for a light of given coefficients: nothing of it is projected, however it moves."""
    for light in lights:
        is_file = isinstance(light, str) and split_light(light)[0].suffix.lower() in COEFFICIENT_SUFFIXES
        if is_file or (not isinstance(light, str) and light.about.n_bands is not None):
            name = light if isinstance(light, str) else light.name
            raise UsageError(f"{name}: --moving projects a light in every frame; coefficients are projected already")


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


def _measure_sections(run: Run) -> None:
    found = roughness.staircases(run.page.lights)
    run.report.extra[roughness.KEY] = roughness.as_extra(found)
    run.page.hosted[roughness.TITLE] = roughness.as_markdown(found)
    kept = [one for measured in run.page.lights for one in encodings.kept_of(measured)]
    run.report.extra[encodings.KEY] = encodings.as_extra(kept)
    run.page.hosted[encodings.TITLE] = encodings.as_markdown(kept)
    run.measure("projection", _projection)
    run.measure("peers", _peers)
    with renderer_or_reason(run.options.shader and len(run.options.sections) > 0) as drawing:
        if not isinstance(drawing, str):
            run.report.renderer = drawing.version
        run.measure("reconstruction", _reconstruction, drawing)
        run.measure("end to end", _end_to_end, drawing)
    run.measure("moving", _moving)
    run.measure("hard cases", _stability)


def _projection(run: Run) -> None:
    quick = run.options.quick
    rounds = projection_rows.plan(
        run.page.lights,
        experiments.QUICK_BANDS if quick else experiments.BANDS,
        experiments.QUICK_SAMPLES if quick else experiments.SAMPLES,
        run.options.methods,
    )
    projection_rows.measure(rounds, run.clock.left, run.options.seed, run.add, run.clock.tell)


def _peers(run: Run) -> None:
    try:
        rows, missing = peer_rows(run.texts, PEER_BANDS, run.seconds["peers"], run.options.seed)
    except UsageError as error:
        run.page.hosted["Peers"] = f"{error}."
        return
    run.add(rows)
    lines = ["The same projections by other libraries, one thread each, in one process of their own, taking turns.", ""]
    lines += rows_table(rows, ("note", "set up"))
    if missing:
        lines += ["", *(f"- without {line}" for line in missing), "", f"All of them: `{INSTALL}`"]
    run.page.hosted["Peers"] = "\n".join(lines)


def _reconstruction(run: Run, drawing: Renderer | str) -> None:
    kinds: dict[type, MeasuredLight] = {}
    for measured in run.page.lights:
        kinds.setdefault(type(measured.light), measured)
    quick = run.options.quick
    chosen = list(kinds.values())[: 1 if quick else 2]  # the first light of each kind
    bands = QUICK_RECONSTRUCTED if quick else BANDS
    for number, measured in enumerate(chosen):
        run.clock.tell(measured.name)
        filling = 0.5 * run.seconds["reconstruction"] / len(chosen)
        at_most = run.clock.left() / (len(chosen) - number)
        run.add(reconstruction_rows(measured, drawing, budget=filling, at_most=at_most, bands=bands))
    rows = [row for row in run.report.rows if row.section == "reconstruction"]
    lines = [
        "What a band costs where the sum is evaluated, against what it brings. Where the arithmetic error reaches what the",
        "bands left out hold, more bands are of no use.",
        "",
        *rows_table(rows, ("left out", "arithmetic", "note")),
        "",
    ]
    for measured in chosen:
        sentence = where_bands_stop_paying([row for row in rows if row.light == measured.name and row.measured])
        lines += [f"- {sentence}"] if sentence else []
    if isinstance(drawing, str):
        lines += ["", f"Nothing was drawn: {drawing}."]
    run.page.hosted["Reconstruction"] = "\n".join(lines)


def _end_to_end(run: Run, drawing: Renderer | str) -> None:
    text = run.texts[0] if run.texts else experiments.LIGHTS[0]
    name = run.page.lights[0].name if run.texts else text
    missing = [f"pictures: nothing was drawn: {drawing}"] if isinstance(drawing, str) else []
    at_least = QUICK_REPEATS if run.options.quick else 5
    parts = (("pictures", end_to_end.session_rows, 0.25), ("new processes", end_to_end.process_rows, 0.35))
    for what, rows_of, share in parts:
        run.clock.tell(what)
        budget, at_most = share * run.seconds["end to end"], run.clock.left()
        run.add(rows_of(text, name, drawing, budget=budget, at_most=at_most, at_least=at_least))
    if not run.options.quick and run.options.shader:
        run.clock.tell("an idle window")
        idle = end_to_end.idle_row(at_most=run.clock.left())
        if isinstance(idle, str):
            missing.append(f"an idle window: {idle}")
        else:
            run.add([idle])
    rows = [row for row in run.report.rows if row.section == "end to end"]
    lines = ["What a user waits for.", "", *rows_table(rows, ("note",))]
    run.page.hosted["End to end"] = "\n".join([*lines, "", *(f"- Without {line}" for line in missing)])


def _moving(run: Run) -> None:
    seed, found = run.options.seed, list[moving.Sampled]()
    exact = {measured.name: moving.turned_exactly(measured) for measured in run.page.lights}
    stated = [*moving.noise(seed), *moving.sun(seed)]
    rounds = [(one, count, way) for one in run.page.lights for count in moving.SAMPLES for way in moving.WAYS]
    for number, (measured, count, way) in enumerate(rounds):
        if run.clock.left() < 0:
            left = [(one.name, way, count) for one, count, way in rounds[number:]]
            run.add([not_measured(moving.SECTION, way, name, None, count) for name, way, count in left])
            break
        run.clock.tell(f"{measured.name}, {way}, {count} samples")
        found += moving.sampled(measured, way, count, seed)
    run.add([one.row for one in found])
    run.report.extra[moving.SECTION] = moving.as_extra(exact, found, stated)
    run.page.hosted[moving_page.TITLE] = moving_page.as_markdown(exact, found, stated)


def _stability(run: Run) -> None:
    outcomes = stability.run(progress=run.clock.tell, shader=run.options.shader)
    run.stability_failed = not all(outcome.passed for outcome in outcomes)
    run.report.extra["stability"] = json.loads(stability.as_json(outcomes))
    run.page.hosted["Hard cases"] = stability.as_markdown(outcomes).partition("\n")[2]
