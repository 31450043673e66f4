"""Error against bands: how the error of this light falls as bands are added, over the energy that each band holds.

Both panels share the axis of bands. The error with n bands stands at n and band l between l and l + 1. So the bars left of
the line at the present n are in use, and those right of it hold the energy that is left out.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain

from PIL import Image

from shviewer.analysis.figures import Pending
from shviewer.viewer.composition import Composition
from shviewer.viewer.overlay.band_axis import BandAxis
from shviewer.viewer.overlay.lettering import ACCENT, FAINT, GREY, INK, RULE, Ink
from shviewer.viewer.overlay.plots.band_series import band_series
from shviewer.viewer.overlay.plots.log_axis import Axis, padded_axis
from shviewer.viewer.overlay.plots.markers import LOOKS, Place
from shviewer.viewer.overlay.plots.sheet import Entry, Sheet, Size, place
from shviewer.viewer.panes import Box
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import describe_muted, describe_window
from shviewer.words import counted, percent, round_percent, short_count

MOST, LEAST = Size(440, 330), Size(230, 150)
"""Largest and smallest size of the sheet; a smaller one would not hold its curve."""

TWO_PANELS = 140
"""Height, in pixels of the design, that the energy, its caption and the curve need together."""

EXACT: Ink = (112, 112, 122, 255)
"""The ink of the best way's curve, behind that of samples."""

LEFT_OUT: Ink = (84, 84, 94, 255)
"""The ink of bars above n."""

HERE: Ink = (48, 74, 116, 255)
"""The ink of the line at the present n: the accent, much darker."""


@dataclass(frozen=True)
class Convergence:
    """The places of a drawn plot, in pixels: sheet, axes, curve, marks, bars, and the boxes of all texts."""

    box: Box
    bands: BandAxis
    error: Axis
    energy: Axis | None
    """The axis of the energy; None if there is no room for it, or no energy."""
    points: dict[int, Place]
    """n -> the point of the curve; none where the error is infinite."""
    shown: Place | None
    """The mark of the error as shown, if bands are muted or windowed."""
    needed: Place | None
    """The first point within the tolerance, if it is on the axis."""
    bars: dict[int, Box] = field(default_factory=dict)
    """Band -> its bar; none where it holds no energy."""
    boxes: dict[str, Box] = field(default_factory=dict)


def draw_convergence(
    image: Image.Image, picture: Picture, composition: Composition, taken: Iterable[Box]
) -> Convergence | None:
    """Draw the plot clear of the boxes that are taken; None, and nothing drawn, where it does not fit."""
    box = place(composition, taken, MOST, LEAST)
    if box is None:
        return None
    drawing = _Drawing(Sheet(image, composition, box, "convergence"), picture)
    drawing.axes()
    drawing.energy()
    drawing.curves()
    drawing.marks()
    drawing.labels()
    return drawing.found


class _Drawing:
    """One plot being drawn."""

    def __init__(self, sheet: Sheet, picture: Picture) -> None:
        self.sheet, self.picture, self.state = sheet, picture, picture.state
        self.series = series = band_series(picture)
        box, unit, energies = sheet.box, sheet.unit, series.energy.values()
        top, bottom = round(box.top + 58 * unit), round(box.bottom - 30 * unit)
        self.split = bottom - top >= TWO_PANELS * unit
        middle = round(bottom - 0.3 * (bottom - top))
        base = round(middle - 30 * unit) if self.split else bottom
        pad = sheet.radius + 6 * unit
        error = padded_axis(*series.span(), 1.0, base, top, pad, pad, centred=False)
        energy = None
        if self.split and energies:
            pad = 4 * unit
            energy = padded_axis(min(energies), max(energies), 10.0, bottom, middle, pad, pad, centred=False)
        self.levels = {"error": sheet.level_ticks(error), "energy": sheet.level_ticks(energy, 1.25) if energy else []}
        widest = max((sheet.width_of(round_percent(tick)) for tick in chain(*self.levels.values())), default=0)
        left, right = round(box.left + 24 * unit + widest), round(box.right - 18 * unit)
        self.area, self.lower = Box(left, top, right, base), Box(left, middle, right, bottom)
        pad = sheet.ring + 2 * unit
        bands = BandAxis(series.slots, left + pad, right - pad)
        points = {n: (bands.at(n), error.at(share)) for n, share in series.errors.items()}
        needed = series.needed if isinstance(series.needed, int) and series.needed <= series.slots else 0
        shown = (bands.at(self.state.recipe.n_bands), error.at(series.shown)) if series.shown is not None else None
        self.found = Convergence(box, bands, error, energy, points, shown, points.get(needed), boxes=sheet.boxes)

    def axes(self) -> None:
        """Draw title, captions, round values, and the line at the present n."""
        sheet, found, area, unit = self.sheet, self.found, self.area, self.sheet.unit
        caption = sheet.title(["error against bands"], "relative L2 error")
        if self.series.exact:
            words = f"{self.picture.projection.method} {short_count(self.state.recipe.samples)}"
            samples = Entry("samples", "line", words, LOOKS[self.state.recipe.method][1])
            room = caption._replace(left=caption.right + 14 * unit, right=area.right)
            sheet.legend(room, [samples, Entry("exact", "line", "exact", EXACT)])
        sheet.levels("error", found.error, self.levels["error"], area)
        sheet.rule(Box(area.left, area.bottom, area.right + 1, area.bottom + sheet.line), RULE)
        if self.split:
            words = "energy of each band" if found.energy else "no energy in any band"
            sheet.write("energy", caption.left, area.bottom + 14 * unit, words, FAINT, "lm")
        x, bottom = round(found.bands.at(self.state.recipe.n_bands)), self.lower.bottom
        sheet.rule(Box(x, area.top, x + sheet.line, bottom), HERE)
        y = bottom + 15 * unit
        sheet.write("bands", area.left - 8 * unit, y, "bands", FAINT, "rm")
        for n in found.bands.ticks(sheet.width_of("128") + 4):
            sheet.write(
                f"bands_{n}", found.bands.at(n), y, str(n), INK if n == self.state.recipe.n_bands else GREY, "mm"
            )

    def energy(self) -> None:
        """Draw a bar per band: filled as far as it is kept, hollow when muted, dim above n."""
        sheet, axis, bands, lower = self.sheet, self.found.energy, self.found.bands, self.lower
        if not self.split:
            return
        sheet.rule(Box(lower.left, lower.bottom, lower.right + 1, lower.bottom + sheet.line), RULE)
        if axis is None:
            return
        sheet.levels("energy", axis, self.levels["energy"], lower)
        width = round(min(0.62 * bands.pitch, 31 * sheet.unit))
        for band, share in self.series.energy.items():
            left = round(bands.at(band + 0.5) - width / 2)
            right = left + width
            if bands.pitch - width < 1.5:  # gaps of 1 and 2 pixels by turns would shimmer
                left, right = round(bands.at(band)), round(bands.at(band + 1))
            bar = Box(left, round(axis.at(share)), right, lower.bottom)
            self.found.bars[band] = bar
            if band not in self.series.kept:
                sheet.rule(bar, LEFT_OUT)
                continue
            sheet.frame(bar, ACCENT)
            if self.series.kept[band] > axis.low:
                sheet.rule(bar._replace(top=round(axis.at(self.series.kept[band]))), ACCENT)

    def curves(self) -> None:
        """Draw the tolerance, dashed, the exact curve, faint, and the curve."""
        sheet, found, area, series = self.sheet, self.found, self.area, self.series
        if found.error.low < series.tolerance < found.error.high:
            sheet.dashes(area.left, area.right, found.error.at(series.tolerance), FAINT)
        dot = min(2 * sheet.unit, 0.2 * found.bands.pitch)
        for errors, ink in ((series.exact, EXACT), (series.errors, LOOKS[self.state.recipe.method][1])):
            places = [(found.bands.at(n), found.error.at(share)) for n, share in errors.items()]
            if places:
                sheet.curve(area, places, ink, 1.5 * sheet.unit, dot if dot > 1.2 * sheet.unit else 0)

    def marks(self) -> None:
        """Mark the first point within the tolerance, the present n in a ring, and the error as shown, if off the curve."""
        sheet, found = self.sheet, self.found
        if found.needed:
            sheet.point("disc", sheet.radius, found.needed, INK)
        present = found.points.get(self.state.recipe.n_bands)
        if present:
            sheet.point("disc", sheet.radius, present, ACCENT)
            sheet.stamp("ring", sheet.ring, present, ACCENT)
        if found.shown:
            sheet.point("diamond", sheet.radius, found.shown, ACCENT)

    def labels(self) -> None:
        """Write the present error, the error as shown and the bands that the tolerance needs, in as many words as fit."""
        sheet, found, area, state, series = self.sheet, self.found, self.area, self.state, self.series
        share = self._percent(series.errors.get(state.recipe.n_bands, float("inf")))
        texts = [f"{counted(state.recipe.n_bands, 'band')}: {share}", share]
        self._beside("present", found.points.get(state.recipe.n_bands), texts, INK, sheet.ring + sheet.gap + 1)
        changes = ", ".join(filter(None, (describe_window(state.recipe), describe_muted(state.recipe))))
        if changes:
            share = self._percent(self.picture.figures.relative_l2)
            texts = [f"{changes}: {share}", f"as shown: {share}", share]
            self._beside("shown", found.shown, texts, ACCENT, sheet.radius + sheet.gap + 1)
        self._tolerance()
        if min(series.errors.values(), default=1.0) <= self.picture.figures.floor:
            text = "less cannot be measured"
            top = found.error.at(self.picture.figures.floor) - sheet.size_of(text)[1] - sheet.radius - sheet.gap
            sheet.put("floor", text, GREY, sheet.row(text, top, area)[::-1], area)

    def _beside(self, name: str, spot: Place | None, texts: list[str], ink: Ink, reach: float) -> None:
        """Write the first text that fits beside the mark; for a mark that is nowhere, at the top or half-way up."""
        sheet, area = self.sheet, self.area
        if spot is None:
            tops = area.top + 6 * sheet.unit, (area.top + area.bottom) / 2
            rows = [(text, sheet.row(text, top, area)) for text in texts for top in tops]
            any(sheet.put(name, text, ink, row, area) for text, row in rows)
            return
        ways = [(text, away) for text in texts for away in (False, True)]
        any(sheet.label(name, spot, text, ink, reach, area, away=away) for text, away in ways) or any(
            sheet.label(name, spot, text, ink, reach, area, away=True, over_lines=True) for text in texts
        )

    def _tolerance(self) -> None:
        """Write what the tolerance needs: over its line right of the curve, or under it left of the curve, else in a corner."""
        sheet, area, needs = self.sheet, self.area, self.picture.needs
        if isinstance(needs, Pending):
            return
        count = self.series.needed or f"over {needs.searched}"
        share = f"{100 * needs.tolerance:g} %"
        y, height = self.found.error.at(needs.tolerance), sheet.size_of("0")[1]
        for text in (f"{share} needs {count} band{'' if count == 1 else 's'}", f"{share}: {count}"):
            above, below = (
                sheet.row(text, y - height - sheet.gap, area),
                sheet.row(text, y + sheet.line + sheet.gap, area),
            )
            corner = sheet.row(text, area.top + sheet.gap, area)
            if sheet.put("tolerance", text, GREY, [*above[::-1], *below, *corner[::-1]], area):
                break

    def _percent(self, share: float) -> str:
        return percent(share, floor=self.picture.figures.floor * (1 + 1e-9))
