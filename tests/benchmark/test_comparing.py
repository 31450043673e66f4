"""What two reports are said to differ in, and what is noise."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from shviewer.benchmark.page.changes import lines
from shviewer.benchmark.rows.comparing import compare
from shviewer.benchmark.rows.report import Report, read_report
from shviewer.benchmark.rows.row import Row, not_measured
from shviewer.errors import UsageError

MACHINE = {"processor": "one", "processors": 2, "system": "Linux 6"}


def report(*rows: Row, **others: object) -> Report:
    return replace(Report(0, "shviewer report", MACHINE, {}, rows=list(rows), complete=True), **others)


def row(ms: float = 1.0, quartiles: tuple[float, float] = (0.99, 1.01), **others: object) -> Row:
    columns = {"section": "projection", "light": "green", "method": "jittered", "n_bands": 9, "samples": 100} | others
    low, high = ms * quartiles[0], ms * quartiles[1]
    return Row(milliseconds=ms, low_quartile=low, high_quartile=high, repeats=5, **columns)


def verdicts(before: Report, after: Report) -> tuple[str, str]:
    (change,) = compare(before, after).changes
    return change.time, change.error


@pytest.mark.parametrize(("ms", "verdict"), [(2.0, "slower"), (0.5, "faster"), (1.2, ""), (0.85, "")])
def test_a_time_differs_beyond_a_ratio(ms: float, verdict: str) -> None:
    assert verdicts(report(row(1.0)), report(row(ms))) == (verdict, "")


def test_a_time_within_the_quartiles_of_the_other_does_not_differ() -> None:
    assert verdicts(report(row(1.0, (0.5, 1.7))), report(row(1.6, (0.9, 1.1)))) == ("", "")


def test_the_yardsticks_drift_has_to_be_passed() -> None:
    steady = {"median": 1.0, "low_quartile": 0.95, "high_quartile": 1.05}
    drifting = {"median": 1.5, "low_quartile": 1.4, "high_quartile": 1.9}
    before = report(row(1.0), yardstick_milliseconds=steady)
    assert verdicts(before, report(row(1.6), yardstick_milliseconds=steady))[0] == "slower"
    assert verdicts(before, report(row(1.6), yardstick_milliseconds=drifting))[0] == ""


def test_errors_of_deterministic_methods_differ_beyond_rounding() -> None:
    assert verdicts(report(row(error=1e-3)), report(row(error=1.01e-3))) == ("", "worse")
    assert verdicts(report(row(error=1e-3)), report(row(error=0.99e-3))) == ("", "better")
    assert verdicts(report(row(error=1e-3)), report(row(error=1e-3 * (1 + 1e-9)))) == ("", "")
    assert verdicts(report(row(error=1e-15)), report(row(error=3e-15))) == ("", "")


def test_errors_of_random_methods_differ_beyond_their_spread() -> None:
    def spread(error: float) -> Report:
        return report(row(error=error, error_low=0.8 * error, error_high=1.2 * error))

    assert verdicts(spread(1e-3), spread(1.3e-3)) == ("", "")
    assert verdicts(spread(1e-3), spread(2e-3)) == ("", "worse")


def test_times_of_another_machine_are_not_compared_but_errors_are() -> None:
    found = compare(
        report(row(1.0, error=1e-3)), report(row(9.0, error=2e-3), machine={**MACHINE, "processor": "another"})
    )
    assert (found.changes[0].time, found.changes[0].error) == ("", "worse")
    text = "\n".join(lines(found, "old.json"))
    assert "not comparable" in text
    assert "processor one there, another here" in text


def test_another_kernel_version_is_the_same_machine() -> None:
    assert compare(report(), report(machine={**MACHINE, "system": "Linux 7"})).different == ()


def test_rows_are_matched_by_what_was_done_and_counted_otherwise() -> None:
    before, after = report(row(), row(n_bands=3)), report(row(), row(samples=1000), row(light="sun"))
    found = compare(before, after)
    assert [change.after for change in found.changes] == [row()]
    assert (found.only_before, found.only_after) == (1, 2)
    assert "Only there: 1 rows; only here: 2." in lines(found, "old.json")


def test_what_one_of_the_two_did_not_measure_is_not_compared() -> None:
    unreached = not_measured("projection", "jittered", "green", 9, 100)
    found = compare(report(row()), report(unreached))
    assert (found.changes, found.only_before, found.only_after) == ((), 1, 0)
    found = compare(report(unreached), report(row()))
    assert (found.changes, found.only_before, found.only_after) == ((), 0, 1)


def test_a_report_read_back_is_the_report(tmp_path: Path) -> None:
    wanted = report(
        row(error=1e-3, note="a"), row(n_bands=3), yardstick_milliseconds={"median": 1.0}, renderer="llvmpipe"
    )
    (tmp_path / "report.json").write_text(wanted.as_json())
    assert read_report(tmp_path / "report.json") == wanted


GOOD = json.loads(report(row()).as_json())


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "an empty file"),
        ("[" * 100_000, "not JSON"),
        ("[]", "schema is None"),
        ("{}", "schema is None"),
        (json.dumps(GOOD | {"schema": "shviewer-report/999"}), "schema is 'shviewer-report/999'"),
        (json.dumps(GOOD | {"rows": [{"section": "projection"}]}), "damaged"),
        (json.dumps(GOOD | {"rows": [GOOD["rows"][0] | {"milliseconds": "fast"}]}), "damaged"),
        (json.dumps(GOOD | {"rows": 7}), "damaged"),
        (json.dumps(GOOD | {"machine": 7}), "damaged"),
    ],
)
def test_what_is_no_report_is_refused_in_one_line(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "old.json"
    path.write_text(text)
    with pytest.raises(UsageError, match=says) as refused:
        read_report(path)
    assert str(refused.value).startswith(str(path))
    assert "\n" not in str(refused.value)


def test_a_missing_report_is_refused_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read: no such file; check the path; name a report"):
        read_report(tmp_path / "old.json")
    with pytest.raises(UsageError, match="cannot be read"):
        read_report(tmp_path)
