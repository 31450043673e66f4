"""The run of a report, section after section. If it ends early, the part measured is kept and marked."""

from __future__ import annotations

import json
import shlex
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path

from shviewer.benchmark.hard_cases import table as stability
from shviewer.benchmark.hard_cases.shader import renderer_or_reason
from shviewer.benchmark.measuring import (
    bands,
    encodings,
    end_to_end,
    moving,
    moving_texels,
    projection_rows,
)
from shviewer.benchmark.measuring.machine import Worked, disturbance, machine_record, versions, yardstick
from shviewer.benchmark.measuring.measured_lights import MeasuredLight, find_measured_lights
from shviewer.benchmark.measuring.peers import peer_rows
from shviewer.benchmark.measuring.reconstruction_rows import reconstruction_rows
from shviewer.benchmark.measuring.timing import summarise
from shviewer.benchmark.options import Clock, Options, Progress
from shviewer.benchmark.page import changes, plots, writing
from shviewer.benchmark.page.advice import sentences
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import lines_not_measured
from shviewer.benchmark.rows.comparing import compare
from shviewer.benchmark.rows.report import DISTURBANCE, YARDSTICK, Report, read_report
from shviewer.benchmark.rows.row import Row, not_measured
from shviewer.coefficients.suffixes import COEFFICIENT_SUFFIXES
from shviewer.ending import at_the_end
from shviewer.errors import UsageError
from shviewer.lights.find import file_of, split_light
from shviewer.lights.light import Light
from shviewer.outputs import Replacing, make_folder
from shviewer.viewer.gl.renderer import Renderer

PEER_BANDS = (3, 9, 16, 32)


@dataclass(frozen=True)
class Summary:
    """The result of a run. rows: how many were measured. text: some lines for the terminal."""

    folder: Path
    files: tuple[str, ...]
    rows: int
    text: str
    stability_failed: bool = False
    warning: str = ""
    """Why its times are not to be trusted; "" if they are."""


@dataclass
class Run:
    """A report in the making. Every section adds to it and is written at once."""

    options: Options
    folder: Path
    lights: Sequence[MeasuredLight]
    texts: Sequence[str]
    """The LIGHTs that can be named to another process."""
    report: Report
    clock: Clock
    seconds: Mapping[str, float]
    """The sections wanted, and the time of each."""
    before: Report | None = None
    yardstick: list[Worked] = field(default_factory=list)
    stability_failed: bool = False

    def add(self, rows: Sequence[Row]) -> None:
        """Add rows, measured and not measured."""
        self.report.rows += rows
        if any(row.measured for row in rows):
            self.yardstick += yardstick()
            times = summarise([worked.wall for worked in self.yardstick])
            self.report.yardstick_milliseconds = dict(zip(YARDSTICK, times[:3], strict=True))
            self.report.extra[DISTURBANCE] = disturbance(self.yardstick)
        self.report.not_measured = lines_not_measured(self.report.rows)

    def write(self, plots: Sequence[str] = (), plot_message: str = "") -> None:
        """Write what there is so far."""
        if self.before is not None and self.options.against is not None:
            found = compare(self.before, self.report)
            self.report.extra[writing.AGAINST] = changes.lines(found, self.options.against.name)
        writing.write(self.folder, Page(self.report, plots, plot_message))

    def measure(self, section: str, measured_by: Callable[..., None], *drawing: Renderer | str) -> None:
        """Measure a section, if it is wanted, and write what it found."""
        if section in self.seconds:
            self.clock.begin(section)
            measured_by(self, *drawing)
            self.write()


def write_report(
    lights: Sequence[str | Light], folder: Path, options: Options | None = None, progress: Progress | None = None
) -> Summary:
    """Measure `lights`, or those of the size if there are none, and write writing.FILES and plots into `folder`.

    OutputError, LightError or UsageError, before anything is measured, if that is impossible or would destroy a file. An
    interrupt is raised again after the rows measured have been written as a partial report.
    """
    options = options or Options()
    before = None if options.against is None else read_report(options.against)
    chosen = list(lights) or list(options.size.lights)
    if options.moving:
        _check_moving(chosen)
    make_folder(folder)
    found = find_measured_lights(chosen, options.size.tolerances, options.reading)
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
        lights={measured.name: measured.record for measured in found},
    )
    texts = [text for text in chosen if isinstance(text, str)]
    run = Run(options, folder, found, texts, report, Clock(seconds, progress), seconds, before)
    run.write()
    drawn: list[str] = []
    message = ""
    with at_the_end(lambda: run.write(drawn, message)):
        _measure_sections(run)
        report.complete = True
        paths, message = plots.make_plots(report, folder)
        drawn += [path.name for path in paths]
    run.clock.finish()
    count = sum(row.measured for row in report.rows)
    return Summary(folder, (*writing.FILES, *drawn), count, _summary(report), run.stability_failed, report.warning)


def _check_moving(lights: Sequence[str | Light]) -> None:
    """UsageError for a light of given coefficients: nothing of it is projected, however it moves."""
    for light in lights:
        is_file = isinstance(light, str) and split_light(light)[0].suffix.lower() in COEFFICIENT_SUFFIXES
        if is_file or (not isinstance(light, str) and light.about.n_bands is not None):
            name = light if isinstance(light, str) else light.name
            raise UsageError(f"{name}: --moving projects a light in every frame; coefficients are projected already")


def _summary(report: Report) -> str:
    lines = []
    for name, record in report.lights.items():
        rows = [row for row in report.measured("projection") if row.light == name]
        lines += [f"{name}: {sentence}" for sentence in sentences(record, rows)] if rows else []
    return "\n".join([*lines, *report.extra.get(writing.AGAINST, [])[:1]])


def _measure_sections(run: Run) -> None:
    extra = run.report.extra
    extra[bands.BANDS_KEY] = bands.bands_extra(run.lights)
    extra[bands.ROUGHNESS_KEY] = bands.roughness_extra(run.lights)
    extra[encodings.KEY] = [asdict(kept) for measured in run.lights for kept in encodings.kept_of(measured)]
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
    size = run.options.size
    rounds = projection_rows.plan(run.lights, size.bands, size.samples, run.options.methods)
    projection_rows.measure(rounds, run.clock.left, run.options.seed, run.add, run.clock.tell)


def _peers(run: Run) -> None:
    try:
        rows, missing = peer_rows(run.texts, PEER_BANDS, run.seconds["peers"], run.options.seed)
    except UsageError as error:
        run.report.note("peers", [str(error)])
        return
    run.add(rows)
    run.report.note("peers", missing)


def _reconstruction(run: Run, drawing: Renderer | str) -> None:
    kinds: dict[type, MeasuredLight] = {}
    for measured in run.lights:
        kinds.setdefault(type(measured.light), measured)
    size = run.options.size
    chosen = list(kinds.values())[: size.kinds]  # the first light of each kind
    for number, measured in enumerate(chosen):
        run.clock.tell(measured.name)
        filling = 0.5 * run.seconds["reconstruction"] / len(chosen)
        at_most = run.clock.left() / (len(chosen) - number)
        run.add(reconstruction_rows(measured, drawing, budget=filling, at_most=at_most, bands=size.reconstructed))
    if isinstance(drawing, str):
        run.report.note("reconstruction", [f"pictures: nothing was drawn: {drawing}"])


def _end_to_end(run: Run, drawing: Renderer | str) -> None:
    text = run.texts[0] if run.texts else run.options.size.lights[0]
    name = run.lights[0].name if run.texts else text
    missing = [f"pictures: nothing was drawn: {drawing}"] if isinstance(drawing, str) else []
    parts = (("pictures", end_to_end.session_rows, 0.25), ("new processes", end_to_end.process_rows, 0.35))
    for what, rows_of, share in parts:
        run.clock.tell(what)
        budget, at_most = share * run.seconds["end to end"], run.clock.left()
        run.add(rows_of(text, name, drawing, budget=budget, at_most=at_most, at_least=run.options.size.repeats))
    if not run.options.quick and run.options.shader:
        run.clock.tell("an idle window")
        idle = end_to_end.idle_row(at_most=run.clock.left())
        if isinstance(idle, str):
            missing.append(f"an idle window: {idle}")
        else:
            run.add([idle])
    run.report.note("end to end", missing)


def _moving(run: Run) -> None:
    seed, found = run.options.seed, list[moving.SamplingError]()
    exact = {measured.name: moving.turned_exactly(measured) for measured in run.lights}
    stated = [*moving_texels.noise(seed), *moving_texels.sun(seed)]
    rounds = [(one, count, way) for one in run.lights for count in moving.SAMPLES for way in moving.WAYS]
    for number, (measured, count, way) in enumerate(rounds):
        if run.clock.left() < 0:
            left = [(one.name, way, count) for one, count, way in rounds[number:]]
            run.add([not_measured(moving.SECTION, way, name, None, count) for name, way, count in left])
            break
        run.clock.tell(f"{measured.name}, {way}, {count} samples")
        found += moving.sampled(measured, way, count, seed)
    run.add([one.row for one in found])
    run.report.extra[moving.SECTION] = {
        "turned_exactly": exact,
        "sampled": [asdict(one) for one in found],
        "stated": [asdict(one) for one in stated],
    }


def _stability(run: Run) -> None:
    outcomes = stability.run(progress=run.clock.tell, shader=run.options.shader)
    run.stability_failed = not all(outcome.passed for outcome in outcomes)
    run.report.extra[stability.KEY] = json.loads(stability.as_json(outcomes))
