"""A whole report: its files, its interruptions and what it refuses."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import count
from pathlib import Path

import pytest

from shviewer.benchmark import options
from shviewer.benchmark import run as run_module
from shviewer.benchmark.measuring import end_to_end, projection_rows, timing
from shviewer.benchmark.options import Clock, Options
from shviewer.benchmark.page import plots
from shviewer.benchmark.page.rows_pages import _matrix
from shviewer.benchmark.rows.report import read_report
from shviewer.benchmark.rows.row import COLUMNS, Row
from shviewer.benchmark.run import write_report
from shviewer.cli.main import main
from shviewer.errors import LightError, OutputError, UsageError

LITTLE = Options(budget=0.5, quick=True, sections=("projection",), methods=("gauss-legendre", "jittered"), shader=False)


MESSAGE = "no plots here"


@pytest.fixture(scope="module", autouse=True)
def _on_any_machine() -> Iterator[None]:
    """Every look at a clock takes a millisecond, so that what a budget admits depends on no machine. And no plots."""
    ticks = count()
    with pytest.MonkeyPatch.context() as patch:
        for module in (options, projection_rows, timing):
            patch.setattr(module, "perf_counter", lambda: next(ticks) / 1000)
        patch.setattr(timing, "thread_time", lambda: next(ticks) / 1000)
        patch.setattr(
            plots,
            "make_plots",
            lambda report, folder: ((folder / "error-bands.svg", folder / "error-bands.png"), MESSAGE),
        )
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("report")
    write_report(["green"], folder, replace(LITTLE, command="shviewer report green"))
    return folder


def test_a_report_is_a_page_every_row_as_json_and_every_row_as_csv(folder: Path) -> None:
    page = (folder / "report.md").read_text()
    document = json.loads((folder / "report.json").read_text())
    with (folder / "report.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert document["complete"] is True
    assert "partial" not in page
    assert list(rows[0]) == list(COLUMNS)
    assert len(rows) == len(document["rows"]) > 5
    best = next(row for row in rows if row["method"] == "best")
    assert (best["error"], best["samples"], best["error_low"]) == ("", "", "")  # not measured is not 0
    assert "shviewer report green" in page
    assert f"numpy {document['versions']['numpy']}" in page
    assert document["renderer"] is None
    assert document["lights"]["green"]["bands_within"] == {"0.05": 15}
    assert document["yardstick_milliseconds"]["median"] > 0


def test_the_bands_and_what_to_use_come_first_and_everything_is_legible_at_128_columns(folder: Path) -> None:
    page = (folder / "report.md").read_text()
    headings = [line for line in page.splitlines() if line.startswith("## ")]
    assert headings[:2] == ["## How many bands", "## What to use"]
    tables = [line for line in page.splitlines() if line.startswith("|")]
    assert tables
    assert max(map(len, page.splitlines())) <= 128
    assert "\u00b1" in page


def test_a_busy_machine_is_said_in_one_line_of_the_page_and_on_stderr(
    tmp_path: Path, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Every look at the thread's own clock takes a third of one at the other: two thirds of the time others had."""
    assert "machine was busy" not in (folder / "report.md").read_text()
    worked = count()
    monkeypatch.setattr(timing, "thread_time", lambda: next(worked) / 3000)
    monkeypatch.setattr(
        run_module,
        "_measure_sections",
        lambda run: run.add([Row(section="projection", method="best", milliseconds=1.0)]),
    )
    assert main(["report", "green", "--quick", "--no-shader", "-o", str(tmp_path / "r")]) == 0
    said = "a fixed piece of work took 3 times as long as it worked, so that the times are not to be trusted"
    assert f"shviewer: the machine was busy: {said}" in capsys.readouterr().err
    page = (tmp_path / "r" / "report.md").read_text()
    assert f"**The machine was busy: {said}" in " ".join(page.split())
    assert max(map(len, page.splitlines())) <= 128
    assert json.loads((tmp_path / "r" / "report.json").read_text())["extra"]["disturbance"] == pytest.approx(3)


def test_plots_are_linked_and_the_line_that_installs_them_is_there(folder: Path) -> None:
    page = (folder / "report.md").read_text()
    assert "![Relative L2 error of the first 1, 2, 3, ... bands of each light](error-bands.svg)" in page
    assert "error-bands.png" not in page
    assert MESSAGE in page


def test_many_bands_continue_in_a_second_table() -> None:
    rows = [Row(section="projection", method="random", samples=10, n_bands=n, error=0.5) for n in range(1, 20)]
    lines = _matrix(rows, lambda row: f"{row.error:12}")
    assert max(map(len, lines)) <= 128
    assert lines.count("") == 2
    assert sum(line.count(" 0.5 |") for line in lines) == 19


def test_an_interrupted_run_leaves_a_readable_partial_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    measure, calls = projection_rows._measure_round, 0

    def interrupted(*arguments: object) -> list[Row]:
        nonlocal calls
        calls += 1
        if calls == 2:
            raise KeyboardInterrupt
        return measure(*arguments)

    monkeypatch.setattr(projection_rows, "_measure_round", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_report(["green"], tmp_path, LITTLE)
    report = read_report(tmp_path / "report.json")
    assert not report.complete
    assert {row.n_bands for row in report.rows} == {3}
    page = (tmp_path / "report.md").read_text()
    assert "**This report is partial" in page
    assert "### green: milliseconds" in page
    assert (tmp_path / "report.csv").read_text().count("\n") == len(report.rows) + 1


def test_a_light_that_fails_on_the_way_leaves_what_was_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*arguments: object) -> None:
        raise LightError("sky.py: gone")

    monkeypatch.setattr(projection_rows, "_measure_round", broken)
    with pytest.raises(LightError, match="gone"):
        write_report(["green"], tmp_path, LITTLE)
    assert not read_report(tmp_path / "report.json").complete


def test_a_report_is_compared_with_an_older_one(folder: Path, tmp_path: Path) -> None:
    older = replace(LITTLE, against=folder / "report.json")
    summary = write_report(["green"], tmp_path, older)
    page = (tmp_path / "report.md").read_text()
    assert "## Against an older report" in page
    assert "rows are in this report and in report.json" in summary.text
    assert " 0 better, 0 worse." in summary.text  # one seed, one program: the same errors


def test_an_unwritable_folder_is_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match=r"cannot be made a folder: .*; choose another place") as refused:
        write_report(["green"], tmp_path / "file" / "folder", LITTLE)
    assert "\n" not in str(refused.value)
    with pytest.raises(OutputError, match="cannot be made a folder"):
        write_report(["green"], tmp_path / "file", LITTLE)


@pytest.mark.parametrize("budget", [0.0, -1.0, float("nan"), float("inf")])
def test_a_budget_has_to_be_some_seconds(budget: float) -> None:
    with pytest.raises(UsageError, match=r"budget .*: it must be a number of seconds above 0"):
        Options(budget=budget)


def test_an_unknown_method_or_section_and_a_bad_seed_are_refused() -> None:
    with pytest.raises(UsageError, match="method 'magic': it must be one of"):
        Options(methods=("best", "magic"))
    with pytest.raises(UsageError, match="section 'magic': it must be one of"):
        Options(sections=("magic",))
    with pytest.raises(UsageError, match="seed -1"):
        Options(seed=-1)


def test_a_bad_older_report_is_refused_before_anything_is_measured(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read"):
        write_report(["green"], tmp_path / "new", replace(LITTLE, against=tmp_path / "none.json"))
    assert not (tmp_path / "new").exists()


def test_an_unknown_light_is_refused_before_anything_is_measured(tmp_path: Path) -> None:
    with pytest.raises(LightError, match="unknown light 'gren'"):
        write_report(["gren"], tmp_path / "new", LITTLE)


def test_progress_goes_from_nothing_to_done(tmp_path: Path) -> None:
    told: list[tuple[float, float, str]] = []
    write_report(["green"], tmp_path, LITTLE, lambda *what: told.append(what))
    shares = [share for share, _, _ in told]
    assert told[-1] == (1.0, 0.0, "done")
    assert all(0 <= share <= 1 for share in shares)
    assert all(left >= 0 for _, left, _ in told)
    assert any("green, 3 bands" in what for _, _, what in told)


def test_sections_that_are_not_wanted_give_their_time_to_projection() -> None:
    everything = Options(budget=100, peers=True).seconds()
    assert set(everything) == {"projection", "reconstruction", "end to end", "peers"}
    assert sum(everything.values()) == pytest.approx(100)
    assert Options(budget=100, sections=("projection",)).seconds() == {"projection": pytest.approx(100)}
    assert "peers" not in Options(budget=100).seconds()


def test_the_clock_tells_the_share_of_the_time_and_what_a_section_leaves_over_goes_to_the_next(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = 0.0
    monkeypatch.setattr("shviewer.benchmark.options.perf_counter", lambda: now)
    told: list[tuple[float, float, str]] = []
    clock = Clock({"first": 10.0, "second": 5.0, "third": 5.0}, lambda *what: told.append(what))
    clock.begin("first")
    now = 4.0
    clock.tell("one")
    assert told == [(0.0, 20.0, "first"), (0.2, 16.0, "first: one")]
    clock.begin("second")
    assert clock.left() == 11.0
    assert told[-1] == (pytest.approx(4 / 14), 10.0, "second")  # likely, though it has longer
    now = 17.0
    clock.tell("late")
    assert clock.left() == -2.0
    assert told[-1] == (pytest.approx(17 / 22), 5.0, "second: late")
    clock.begin("third")
    assert clock.left() == 3.0  # what the second took too much


def test_nothing_is_begun_after_the_time_is_up(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(end_to_end.subprocess, "run", lambda *rest, **options: pytest.fail("begun"))
    brief = Options(budget=1e-4, quick=True, sections=("projection", "end to end"), shader=False)
    summary = write_report(["green"], tmp_path, brief)
    report = read_report(tmp_path / "report.json")
    assert report.complete
    assert summary.rows == 0
    assert [row.method for row in report.rows if row.section == "end to end"] == [end_to_end.VERSION]
    assert not any(row.measured for row in report.rows)
    with (tmp_path / "report.csv").open() as file:
        assert {row["note"] for row in csv.DictReader(file)} == {"not measured"}
    assert "best way: green, 3 9 15 bands" in report.not_measured
    page = (tmp_path / "report.md").read_text()
    assert (
        "Not measured for want of time; a larger --budget measures more:\n\n- best way: green, 3 9 15 bands\n" in page
    )
    assert re.search(r"\| start, --version +\|.*\| not measured +\|", page)


def test_a_run_of_the_same_seed_has_the_same_errors_however_far_it_comes(folder: Path, tmp_path: Path) -> None:
    write_report(["green"], tmp_path, replace(LITTLE, budget=0.25))
    some = {row.key: row for row in read_report(tmp_path / "report.json").rows if row.measured}
    whole = {row.key: row for row in read_report(folder / "report.json").rows if row.measured}
    assert 0 < len(some) < len(whole)
    for key, row in some.items():
        assert (row.error, row.error_low, row.error_high) == (
            whole[key].error,
            whole[key].error_low,
            whole[key].error_high,
        )
