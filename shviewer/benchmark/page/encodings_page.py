"""The section on encodings of irradiance."""

from __future__ import annotations

from collections.abc import Sequence

from shviewer.benchmark.measuring.encodings import KEY, Kept
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.tables import bullet, error, significant, table
from shviewer.harmonics.metrics import PARSEVAL_FLOOR
from shviewer.harmonics.quantities.encodings import ENCODINGS

EXPLAINED = """\
What engines store of the irradiance, made of the light's first nine coefficients, and cubes of all, compared with the
light's own irradiance. Errors are relative L2 over the sphere of normals and all channels, exact (Parseval: each encoding
is a sum of bands, Geomerics' a sum of 32, which leave less than 1e-5 of its peak, and so are cubes, 5e-4 of their largest
face); largest error and minimum are searched for and relative to the largest irradiance. *A float saves*: how many percent
points less the error is than that of the mean alone, divided by the numbers beyond the mean. *Shared axis* is one axis for
all channels. *Solved* changes band 1 as well, so that five floats are as near as they can be, and a *fitted* cube has the
six faces that are nearest; a cube belongs to the axes of the world, so that its errors change when the light turns. The
last row is a **trap**: with coefficients of radiance in an orthonormal basis, the formula as it stands in common code makes
every surface 12.84 % too bright and takes the light for less one-sided than it is; its 1/2 is right only where band 1 is
that of irradiance."""


def lines(page: Page) -> list[str]:
    """A sentence per light, and a table of light and encoding."""
    found = [Kept(**kept) for kept in page.report.extra.get(KEY, [])]
    if not found:
        return []
    lights = dict.fromkeys(kept.light for kept in found)
    said = [bullet(f"{name}: {_ranking([kept for kept in found if kept.light == name])}") for name in lights]
    rows = [
        (
            kept.light,
            kept.words,
            str(kept.floats),
            _error(kept.relative_l2),
            _error(kept.largest_error),
            f"{100 * kept.minimum:z.2f} %",
            significant(100 * kept.saved_by_a_float),
        )
        for kept in found
    ]
    headings = ("light", "encoding", "floats", "relative L2", "largest error", "minimum", "a float saves")
    return [EXPLAINED, "", *said, "", *table(headings, rows, left=2)]


def _error(share: float) -> str:
    """An error in percent; 0 where it cannot be told from rounding."""
    return error(share if share > PARSEVAL_FLOOR else 0.0)


def _ranking(found: Sequence[Kept]) -> str:
    """The best encodings of four, five and nine floats."""
    offered = [kept for kept in found if kept.encoding in ENCODINGS]
    best = {
        floats: min((one for one in offered if one.floats == floats), key=lambda one: round(one.relative_l2, 6))
        for floats in (4, 5, 9)
    }
    plain = next(kept for kept in offered if kept.encoding == "l1")
    beside = "" if best[4] is plain else f" (L1 as it is leaves {_error(plain.relative_l2)})"
    return (
        f"of four floats {best[4].words} is best and leaves {_error(best[4].relative_l2)} of the irradiance{beside}; "
        f"of five {best[5].words}, {_error(best[5].relative_l2)}; of nine {best[9].words}, {_error(best[9].relative_l2)}."
    )
