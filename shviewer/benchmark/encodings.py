"""The section of the report on encodings of irradiance: what four, five and nine floats a channel keep of shading."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from shviewer.analysis.figures import error_grid, grid_rows
from shviewer.analysis.subjects import through
from shviewer.benchmark.measured_lights import MeasuredLight
from shviewer.benchmark.page.tables import bullet, percent, table
from shviewer.harmonics.quantities.encodings import BANDS, ENCODINGS, GEOMERICS_BANDS, REPORTED
from shviewer.harmonics.quantities.names import IRRADIANCE

TITLE = "Irradiance in few floats"
KEY = "encodings"
"""The key in the report's `extra`."""

EXPLAINED = """\
What engines store of the irradiance, made of the light's first nine coefficients. Errors are relative L2 over the sphere of
normals and all channels, exact (Parseval: each encoding is a sum of bands, Geomerics' a sum of 32, which leave less than 1e-5
of its peak); largest error and minimum are searched for and relative to the largest irradiance. *A float saves* is how much
less error each number brings beyond the mean alone, in percent points. *Shared axis* is one axis for all channels. *Solved*
changes band 1 as well, so that five floats are as near as they can be. The last row is a **trap**: with coefficients of
radiance in an orthonormal basis, the formula as it stands in common code makes every surface 12.84 % too bright and takes the
light for less one-sided than it is; its 1/2 is right only where band 1 is that of irradiance."""


@dataclass(frozen=True)
class Kept:
    """What one encoding keeps of one light's irradiance."""

    light: str
    encoding: str
    words: str
    floats: int
    relative_l2: float
    largest_error: float
    """Over the largest irradiance, and so is the minimum."""
    minimum: float
    saved_by_a_float: float
    """How much less the relative L2 error is than that of the mean alone, divided by floats - 1."""


def kept_of(measured: MeasuredLight) -> list[Kept]:
    """What all encodings keep of a light. A black one has none."""
    light = through(measured.light, IRRADIANCE)
    exact, norm = light.from_source(measured.exact[: GEOMERICS_BANDS**2]), float(np.trace(light.products()))
    if norm == 0:
        return []
    grid = error_grid(light, grid_rows(GEOMERICS_BANDS))
    alone = np.sqrt(max(norm - float((exact[0] ** 2).sum()), 0.0) / norm)
    found = []
    for name, encoding in REPORTED.items():
        if name == "l2-deringed" and (exact[0] < 0).any():
            continue  # no factors take a negative mean away
        made = encoding.make(measured.exact[: BANDS**2])
        shown = np.zeros_like(exact)
        shown[: len(made)] = made
        squared = max(norm - float((exact**2).sum()), 0.0) + float(((exact - shown) ** 2).sum())
        error = float(np.sqrt(squared / norm))
        extremes = grid.compare(made)
        found.append(
            Kept(
                measured.name,
                name,
                encoding.words,
                encoding.floats,
                error,
                extremes.max_error / grid.peak,
                extremes.minimum / grid.peak,
                (float(alone) - error) / (encoding.floats - 1),
            )
        )
    return found


def as_extra(found: Sequence[Kept]) -> list[dict[str, Any]]:
    return [asdict(kept) for kept in found]


def as_markdown(found: Sequence[Kept]) -> str:
    lights = dict.fromkeys(kept.light for kept in found)
    lines = [EXPLAINED, ""]
    for light in lights:
        lines.append(bullet(f"{light}: {_ranking([kept for kept in found if kept.light == light])}"))
    rows = [
        (
            kept.light,
            kept.words,
            str(kept.floats),
            percent(kept.relative_l2),
            percent(kept.largest_error),
            f"{100 * kept.minimum:z.2f} %",
            f"{100 * kept.saved_by_a_float:.2f}",
        )
        for kept in found
    ]
    headings = ("light", "encoding", "floats", "relative L2", "largest error", "minimum", "a float saves")
    return "\n".join([*lines, "", *table(headings, rows, left=2)])


def _ranking(found: Sequence[Kept]) -> str:
    """Which of four, five and nine floats keeps most."""
    offered = [kept for kept in found if kept.encoding in ENCODINGS]
    best = {
        floats: min((one for one in offered if one.floats == floats), key=lambda one: round(one.relative_l2, 6))
        for floats in (4, 5, 9)
    }
    plain = next(kept for kept in offered if kept.encoding == "l1")
    return (
        f"of four floats {best[4].words} is best, {percent(best[4].relative_l2)} (L1 as it is {percent(plain.relative_l2)}); "
        f"five leave {percent(best[5].relative_l2)} ({best[5].words}), nine {percent(best[9].relative_l2)}."
    )
