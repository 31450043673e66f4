"""The sections of a report: what each measures, and its part of the page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from shviewer.benchmark import experiments, projection_rows
from shviewer.benchmark.budget import Clock
from shviewer.benchmark.hard_cases.shader import Shader, shader_or_reason
from shviewer.benchmark.measurement import Measurement
from shviewer.benchmark.options import Options
from shviewer.benchmark.page import writing
from shviewer.benchmark.page.comparing import compare
from shviewer.benchmark.page.document import Report
from shviewer.benchmark.page.machine import Yardstick
from shviewer.benchmark.page.row_tables import rows_table
from shviewer.benchmark.subjects import Subject
from shviewer.errors import UsageError

PEER_BANDS = (3, 9, 16, 32)
QUICK_RECONSTRUCTED = (3, 16)
IDLE_FROM = 60.0
"""The idle window takes six seconds: only for budgets of at least so many."""

QUICK_REPEATS = 3
"""Of what is slow, where five do not fit."""

QUICK_END, QUICK_PART = 13.0, 2.5
"""Seconds after which --quick begins nothing more, so that it ends within 15, and what its last parts take: reconstruction,
pictures and new processes."""


AGAINST = "Against an older report"


@dataclass
class Run:
    """A report while it is made. Every section adds to it and is written at once."""

    options: Options
    folder: Path
    report: Report
    page: writing.Page
    texts: list[str]
    """The LIGHTs that can be named to another process."""
    clock: Clock
    before: Report | None
    yardstick: Yardstick = field(default_factory=Yardstick)
    stability_failed: bool = False

    def add(self, rows: Sequence[Measurement]) -> None:
        self.report.rows += rows
        self.yardstick.measure()
        self.report.yardstick = self.yardstick.record()

    def late(self, what: str) -> bool:
        """Whether `what` would take --quick too long on a machine that has been as slow as this one; noted if so."""
        if not self.options.quick or self.clock.elapsed() + QUICK_PART * self.clock.pace() <= QUICK_END:
            return False
        self.report.left_out.append(f"{what}: --quick was out of time")
        return True

    def write(self) -> None:
        if self.before is not None and self.options.against is not None:
            lines = compare(self.before, self.report).as_markdown(self.options.against.name)
            self.page.hosted = {AGAINST: "\n".join(lines)} | {
                title: text for title, text in self.page.hosted.items() if title != AGAINST
            }
        writing.write(self.folder, self.report, self.page)


def measure_sections(run: Run, seconds: dict[str, float]) -> None:
    if "projection" in seconds:
        run.clock.begin("projection")
        _projection(run, seconds["projection"])
        run.write()
    if "peers" in seconds:
        run.clock.begin("peers")
        _peers(run, seconds["peers"])
        run.write()
    with shader_or_reason(run.options.shader and len(run.options.sections) > 0) as drawing:
        if isinstance(drawing, Shader):
            run.report.renderer = drawing.version
        if "reconstruction" in seconds and not run.late("reconstruction"):
            run.clock.begin("reconstruction")
            _reconstruction(run, drawing, seconds["reconstruction"])
            run.write()
        if "end to end" in seconds:
            run.clock.begin("end to end")
            _end_to_end(run, drawing, seconds["end to end"])
            run.write()
    if "hard cases" in seconds:
        run.clock.begin("hard cases")
        _stability(run)
        run.write()


def _projection(run: Run, budget: float) -> None:
    quick = run.options.quick
    groups = projection_rows.plan(
        run.page.subjects,
        experiments.QUICK_BANDS if quick else experiments.BANDS,
        experiments.QUICK_SAMPLES if quick else experiments.SAMPLES,
        run.options.methods,
    )
    left_out = projection_rows.fit(groups, budget)
    run.report.left_out = projection_rows.describe(left_out)
    run.clock.expect(sum(group.total() for group in groups))
    left_out += projection_rows.measure(groups, budget, run.options.seed, run.add, run.clock.tell)
    run.report.left_out = projection_rows.describe(left_out)


def _peers(run: Run, budget: float) -> None:
    from shviewer.benchmark.peers import INSTALL, peer_rows

    try:
        rows, missing = peer_rows(run.texts, PEER_BANDS, budget, run.options.seed)
    except UsageError as error:
        run.page.hosted["Peers"] = f"{error}."
        return
    run.add(rows)
    lines = ["The same projections by other libraries, one thread each, in one process of their own, taking turns.", ""]
    lines += rows_table(rows, ("note", "set up"))
    if missing:
        lines += ["", *(f"- without {line}" for line in missing), "", f"All of them: `{INSTALL}`"]
    run.page.hosted["Peers"] = "\n".join(lines)


def _reconstruction(run: Run, drawing: Shader | str, budget: float) -> None:
    from shviewer.benchmark.enough_bands import where_bands_stop_paying
    from shviewer.benchmark.reconstruction_rows import BANDS, reconstruction_rows

    quick = run.options.quick
    chosen = _representative(run.page.subjects)[: 1 if quick else 2]
    for number, subject in enumerate(chosen):
        run.clock.tell(number / len(chosen), subject.name)
        share = 0.5 * budget / len(chosen)
        bands, at_least = (QUICK_RECONSTRUCTED, QUICK_REPEATS) if quick else (BANDS, 5)
        run.add(reconstruction_rows(subject, drawing, budget=share, bands=bands, at_least=at_least))
    rows = [row for row in run.report.rows if row.section == "reconstruction"]
    lines = [
        "What a band costs where the sum is evaluated, against what it brings. Where the arithmetic error reaches what the",
        "bands left out hold, more bands are of no use.",
        "",
        *rows_table(rows, ("left out", "arithmetic", "note")),
        "",
    ]
    for subject in chosen:
        lines += [f"- {where_bands_stop_paying([row for row in rows if row.light == subject.name])}"]
    if isinstance(drawing, str):
        lines += ["", f"Nothing was drawn: {drawing}."]
    run.page.hosted["Reconstruction"] = "\n".join(lines)


def _representative(subjects: Sequence[Subject]) -> list[Subject]:
    """The first light of each kind."""
    kinds: dict[type, Subject] = {}
    for subject in subjects:
        kinds.setdefault(type(subject.light), subject)
    return list(kinds.values())


def _end_to_end(run: Run, drawing: Shader | str, budget: float) -> None:
    from shviewer.benchmark import end_to_end

    text = run.texts[0] if run.texts else experiments.LIGHTS[0]
    name = run.page.subjects[0].name if run.texts else text
    missing = [] if isinstance(drawing, Shader) else [f"pictures: nothing was drawn: {drawing}"]
    at_least = QUICK_REPEATS if run.options.quick else 5
    if not run.late("end to end, pictures"):
        run.add(end_to_end.session_rows(text, name, drawing, budget=0.4 * budget, at_least=at_least))
    run.clock.tell(0.4, "new processes")
    if not run.late("end to end, new processes"):
        run.add(end_to_end.process_rows(text, name, drawing, budget=0.5 * budget, at_least=at_least))
    if run.options.budget >= IDLE_FROM and not run.options.quick and run.options.shader:
        run.clock.tell(0.7, "an idle window")
        idle = end_to_end.idle_row()
        if isinstance(idle, str):
            missing.append(f"an idle window: {idle}")
        else:
            run.add([idle])
    rows = [row for row in run.report.rows if row.section == "end to end"]
    lines = ["What a user waits for.", "", *(rows_table(rows, ("note",)) if rows else ["Not measured."])]
    run.page.hosted["End to end"] = "\n".join([*lines, "", *(f"- Without {line}" for line in missing)])


def _stability(run: Run) -> None:
    from shviewer.benchmark import hard_cases as stability

    count, total = 0, len(stability.CASES)

    def tell(name: str) -> None:
        nonlocal count
        run.clock.tell(count / total, name)
        count += 1

    outcomes = stability.run(progress=tell, shader=run.options.shader)
    run.stability_failed = not all(outcome.passed for outcome in outcomes)
    run.report.extra["stability"] = json.loads(stability.as_json(outcomes))
    run.page.hosted["Hard cases"] = stability.as_markdown(outcomes).partition("\n")[2]
