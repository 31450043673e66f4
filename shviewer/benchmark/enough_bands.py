"""The number of bands beyond which more do not pay: one sentence per light, made from its reconstruction rows."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from shviewer.benchmark.reconstruction_rows import CACHED, DIRECT, MAP_32, SECTION
from shviewer.benchmark.row import Row
from shviewer.harmonics.metrics import PARSEVAL_FLOOR


def where_bands_stop_paying(rows: Sequence[Row]) -> str:
    """One sentence on the rows of one light; "" if there are none.

    More bands stop paying where the truncation error falls below the arithmetic error; and, in the direct sum, where every
    further step multiplies the time by more, beyond the quartiles, than it divides the error.
    """
    rows = [row for row in rows if row.section == SECTION]
    drawn = {method: [row for row in rows if row.method == method] for method in (DIRECT, CACHED)}
    judged = drawn[CACHED] or [row for row in rows if row.method == MAP_32]
    if not judged:
        return ""
    last = judged[-1]
    met = next((row for row in judged if _number(row.truncation) <= _floor(row)), None)
    parts = [
        f"more than {_bands(met)} bring nothing: no more than {_percent(_floor(met))} is left out, which is lost in rounding"
        if met
        else f"more bands bring less error up to the {last.n_bands} measured, where {_percent(last.truncation)} is left out "
        f"and the arithmetic adds {_percent(last.arithmetic_error)}"
    ]
    if drawn[DIRECT]:
        parts += _direct_sum(drawn[DIRECT]) if met is None or met.n_bands != 1 else []
        parts += _crossing(drawn[DIRECT], drawn[CACHED])
    return f"{last.light}: {'; '.join(parts)}."


def _direct_sum(direct: list[Row]) -> list[str]:
    """The words on how far more bands pay in the direct sum."""
    steps = list(pairwise(direct))
    paying = [_number(a.total_error) > _slowdown(a, b) * _number(b.total_error) for a, b in steps]
    stop = max((number + 1 for number, pays in enumerate(paying) if pays), default=0)
    if stop == len(steps):
        return [f"summed in the shader they pay up to {_bands(direct[-1])}, {direct[-1].milliseconds:.0f} ms a frame"]
    here, after = direct[stop], direct[stop + 1]
    return [
        f"summed in the shader they stop paying at {_bands(here)}: {after.n_bands} take "
        f"{_number(after.milliseconds) / _number(here.milliseconds):.2f} times as long and leave "
        f"{_number(after.total_error) / max(_number(here.total_error), PARSEVAL_FLOOR):.2f} of the error"
    ]


def _slowdown(a: Row, b: Row) -> float:
    """How many times as long as a b takes; 1 if the quartiles overlap."""
    apart = _number(b.low_quartile) > _number(a.high_quartile)
    return _number(b.milliseconds) / _number(a.milliseconds) if apart else 1.0


def _crossing(direct: list[Row], cached: list[Row]) -> list[str]:
    """The words on the band count from which the cached map is faster."""
    by_bands = {row.n_bands: row for row in cached}
    faster = [row for row in direct if _slowdown(by_bands[row.n_bands], row) > 1]
    if not faster:
        return []
    first = by_bands[faster[0].n_bands]
    return [
        f"from {_bands(first)} on a cached map draws faster, {first.milliseconds:.0f} ms "
        f"after {first.set_up_milliseconds:.0f} ms to make it"
    ]


def _bands(row: Row) -> str:
    return f"{row.n_bands} band{'' if row.n_bands == 1 else 's'}"


def _floor(row: Row) -> float:
    """The truncation error below which it cannot be told from rounding."""
    return max(_number(row.arithmetic_error), PARSEVAL_FLOOR)


def _number(value: float | None) -> float:
    return 0.0 if value is None else value


def _percent(value: float | None) -> str:
    """A share in percent, two digits, without powers of ten."""
    return f"{np.format_float_positional(100 * _number(value), 2, unique=False, fractional=False, trim='-')} %"
