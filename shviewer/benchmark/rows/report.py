"""A whole report: its rows, and everything that one must know to trust or to repeat them."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from shviewer.analysis.options import is_number
from shviewer.benchmark.rows.row import Row
from shviewer.errors import LightError, UsageError
from shviewer.files import read_bytes
from shviewer.limits import DEFAULT_LIMITS
from shviewer.words import one_line

SCHEMA = "shviewer-report/1"
DISTURBANCE = "disturbance"
"""The key in the report's `extra` of the yardstick's time by the clock over that of the processor."""

DISTURBED = 1.1
"""From this ratio on other programs are said to disturb: on a quiet machine it is 1.00 to 1.03."""

HEAD = (
    "complete",
    "command",
    "seed",
    "versions",
    "machine",
    "renderer",
    "yardstick_milliseconds",
    "not_measured",
    "extra",
)
"""The fields of a Report in front of its lights and rows, in the order of the file."""

MAX_FILE_BYTES = 2**24
"""Thirty times as much as a whole report takes."""

LONGEST_TEXT = 300
"""The most letters of a text that is read from a report."""

NOTES = "notes"
"""The key of Report.extra under which the lines on what a section lacks are kept."""

YARDSTICK = ("median", "low_quartile", "high_quartile")


@dataclass(frozen=True)
class LightRecord:
    """The exact answers on one light. TypeError or ValueError for a value of another kind, as in a damaged file."""

    description: str
    best_method: str
    accuracy: float
    """How far the reference may be off, relative to its norm; 0 if it is exact."""
    bands_within: dict[str, int | None]
    """Tolerance, such as "0.05" -> the fewest bands with that relative L2 error; None if no count searched has."""
    error_by_bands: list[float]
    """The relative L2 error of the exact coefficients with 1, 2, ... bands."""

    @property
    def best_way(self) -> str:
        """The best method within a sentence: "Gauss-Legendre (51 200 points)"."""
        way, _, points = self.best_method.partition(";")[0].partition(", ")
        return f"{way} ({points})" if points else way

    @property
    def best_misses(self) -> str:
        """What it may miss; "" for nothing."""
        return self.best_method.partition(";")[2].strip()

    def __post_init__(self) -> None:
        numbers = [self.accuracy, *self.error_by_bands, *map(float, self.bands_within)]
        if not self.error_by_bands or not all(map(is_number, numbers)):
            raise ValueError("a light without its errors")


@dataclass
class Report:
    """The content of report.json, which grows section by section. The page is made of it and of nothing else."""

    seed: int
    command: str
    machine: dict[str, Any]
    versions: dict[str, str]
    renderer: str | None = None
    """The OpenGL that drew; None if there was none."""
    rows: list[Row] = field(default_factory=list)
    """All rows, with those that were not measured for want of time: see Row.measured."""
    lights: dict[str, LightRecord] = field(default_factory=dict)
    not_measured: list[str] = field(default_factory=list)
    """Lines on the measurements that there was no time for, one for each kind."""
    yardstick_milliseconds: dict[str, float] | None = None
    complete: bool = False
    extra: dict[str, Any] = field(default_factory=dict)
    """Section -> its results that are no rows, as JSON. NOTES -> section -> lines on what is missing in it, and why."""

    def measured(self, section: str) -> list[Row]:
        """The rows of one section that were measured."""
        return [row for row in self.rows if row.section == section and row.measured]

    def note(self, section: str, lines: Iterable[str]) -> None:
        """Keep lines on what a section lacks."""
        self.extra.setdefault(NOTES, {}).setdefault(section, []).extend(lines)

    def notes(self, section: str) -> list[str]:
        """The lines on what a section lacks."""
        return list(self.extra.get(NOTES, {}).get(section, []))

    @property
    def warning(self) -> str:
        """One line if other programs took so much of the processor that the times are not to be trusted; else ""."""
        share = self.extra.get(DISTURBANCE, 1.0)
        if not is_number(share) or share < DISTURBED:
            return ""
        return (
            f"the machine was busy: a fixed piece of work took {share:.3g} times as long as it worked, so that the times are "
            "not to be trusted; measure again when nothing else runs"
        )

    def as_json(self) -> str:
        page = {"schema": SCHEMA} | {name: getattr(self, name) for name in HEAD}
        # one light and one row per line, so that the file can be read and two of them compared
        head = json.dumps(page, indent=1, allow_nan=False).removesuffix("\n}")
        lights = ",".join(f"\n  {json.dumps(name)}: {_line(asdict(record))}" for name, record in self.lights.items())
        rows = ",".join(f"\n  {_line(row.as_dict())}" for row in self.rows)
        return f'{head},\n "lights": {{{lights}}},\n "rows": [{rows}]\n}}\n'


def _line(value: object) -> str:
    return json.dumps(value, allow_nan=False)


def _safe(value: Any) -> Any:
    """A value of JSON, its texts on one line each and without control characters. ValueError for a number not finite."""
    if isinstance(value, dict):
        return {one_line(key): _safe(part) for key, part in value.items()}
    if isinstance(value, list):
        return [_safe(part) for part in value]
    if isinstance(value, int | float) and not is_number(value):
        raise ValueError(f"a number in it is {value if isinstance(value, float) else 'beyond 1e308'}")
    return one_line(value, LONGEST_TEXT) if isinstance(value, str) else value


def read_report(path: Path) -> Report:
    """A report.json that this program wrote. UsageError if it cannot be read, or is of another kind or schema."""
    try:
        data = read_bytes(path, DEFAULT_LIMITS, MAX_FILE_BYTES, f"a report has at most {MAX_FILE_BYTES}")
        page = _safe(json.loads(data.decode()))
    except LightError as error:
        raise UsageError(f"{path}: cannot be read: {error}; name a report.json") from error
    except (ValueError, RecursionError) as error:
        raise UsageError(f"{path}: not JSON: {error}; name a report.json") from error
    schema = page.get("schema") if isinstance(page, dict) else None
    if schema != SCHEMA:
        raise UsageError(
            f"{path}: its schema is {schema!r}, not {SCHEMA!r}; compare with a report that this version wrote"
        )
    try:
        yardstick = page["yardstick_milliseconds"]
        if yardstick is not None:
            if not all(map(is_number, yardstick.values())):  # float() would read "nan"
                raise ValueError("a yardstick that is no number")
            yardstick = {str(name): float(value) for name, value in yardstick.items()}
        return Report(
            seed=int(page["seed"]),
            command=str(page["command"]),
            machine=dict(page["machine"]),
            versions=dict(page["versions"]),
            renderer=page["renderer"],
            rows=[Row.from_dict(row) for row in page["rows"]],
            lights={str(name): LightRecord(**record) for name, record in page["lights"].items()},
            not_measured=[str(line) for line in page["not_measured"]],
            extra=dict(page["extra"]),
            yardstick_milliseconds=yardstick,
            complete=bool(page["complete"]),
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UsageError(f"{path}: damaged: {type(error).__name__}: {error}; name a whole report.json") from error
