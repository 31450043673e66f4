"""One row of the report. What was not measured is None, never 0."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any


def finite(value: Any) -> Any:
    """The value; None for a number that is not finite, since JSON has no word for it."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


KINDS: Mapping[str, Any] = {"str": str, "int | None": int | None, "float | None": int | float | None}
"""The values that a column of each type may have; JSON writes whole numbers without a point."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """Times are wall milliseconds, errors relative L2 norms, memory is in MiB."""

    section: str
    """"projection", "reconstruction", "end to end", "peers" or "moving"."""
    method: str
    light: str = ""
    """Empty if no light is concerned."""
    n_bands: int | None = None
    samples: int | None = None
    """The number of samples asked for."""
    evaluations: int | None = None
    """How often the light was really evaluated; 0 for a closed form."""

    milliseconds: float | None = None
    """The median of `repeats` runs after a warm-up."""
    low_quartile: float | None = None
    high_quartile: float | None = None
    repeats: int | None = None
    set_up_milliseconds: float | None = None
    """The time to make samples and tables, which are kept."""

    error: float | None = None
    """||c - exact|| / ||exact|| of the coefficients; for random methods the median over seeds. None for the reference."""
    error_low: float | None = None
    """The smallest error over the seeds, and then the largest; None if nothing is random."""
    error_high: float | None = None
    reference_accuracy: float | None = None
    """How far the reference itself may be off; 0 if it is exact."""
    left_out: float | None = None
    """||light - its first n bands|| / ||light||."""
    total_error: float | None = None
    """||light - reconstruction|| / ||light||: total^2 = left_out^2 + error^2 (1 - left_out^2)."""
    arithmetic_error: float | None = None
    """The error of rounding in the evaluation of the sum, over the light's L2 norm like the other errors."""

    peak_mib: float | None = None
    """The most memory held at once, samples and result included, measured in a run of its own."""
    note: str = ""

    @property
    def measured(self) -> bool:
        """Whether it was measured; False for a row that there was no time for, as its note says."""
        return self.milliseconds is not None

    @property
    def key(self) -> tuple[str, str, str, int | None, int | None]:
        """The fields that are equal for the same measurement in different runs."""
        return self.section, self.light, self.method, self.n_bands, self.samples

    def as_dict(self) -> dict[str, Any]:
        """Every column; numbers that are not finite become None."""
        return {name: finite(value) for name, value in asdict(self).items()}

    @classmethod
    def from_dict(cls, columns: Mapping[str, Any]) -> Row:
        """The inverse of `as_dict`. TypeError or ValueError for a column that is missing, unknown or of another type."""
        row = cls(**columns)
        for field in fields(cls):
            value = getattr(row, field.name)
            if isinstance(value, bool) or not isinstance(value, KINDS[str(field.type)]):
                raise ValueError(f"{field.name} is {value!r}")
        return row


COLUMNS = tuple(field.name for field in fields(Row))


def not_measured(section: str, method: str, light: str, n_bands: int | None, samples: int | None = None) -> Row:
    """A row for which there was no time."""
    return Row(section=section, method=method, light=light, n_bands=n_bands, samples=samples, note="not measured")


def alike(first: Row, second: Row) -> bool:
    """Whether the quartiles of two times overlap. A time without quartiles counts as exact."""
    found = overlap(first.low_quartile, first.high_quartile, second.low_quartile, second.high_quartile)
    return first.milliseconds == second.milliseconds if found is None else found


def overlap(low: float | None, high: float | None, other_low: float | None, other_high: float | None) -> bool | None:
    """Whether two ranges have a number in common; None if an end is not known."""
    if low is None or high is None or other_low is None or other_high is None:
        return None
    return low <= other_high and other_low <= high
