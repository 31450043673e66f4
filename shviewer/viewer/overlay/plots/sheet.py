"""A sheet over the spheres on which something is plotted: where it lies, and how axes, marks and texts are put on it.

Texts are placed where nothing else is: the sheet knows which of its pixels hold a text or a mark, and which a line. The box
of every text is reported.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Box, Pane
from shviewer.viewer.overlay.lettering import FAINT, GREY, INK, MIN_TYPE, RULE, Ink, font
from shviewer.viewer.overlay.plots.log_axis import Axis
from shviewer.viewer.overlay.plots.markers import Place, curve_mask, marker_mask
from shviewer.words import round_percent

GROUND: Ink = (14, 14, 16, 236)


class Size(NamedTuple):
    """A size in pixels of the design."""

    width: float
    height: float


class Entry(NamedTuple):
    """An entry of a legend: what a mark of this shape and ink stands for."""

    name: str
    shape: str
    text: str
    ink: Ink


def place(composition: Composition, taken: Iterable[Box], most: Size, least: Size) -> Box | None:
    """The box in which a sheet covers least, clear of the boxes that are taken; None if it would be smaller than `least`.

    Low between two spheres side by side; where there are more, over the first, so that what is compared with it is seen.
    """
    unit, gap = _unit(composition), composition.px(10)
    cell, middle = _cell(composition, composition.panes)
    width = min(most.width * unit, cell.right - cell.left)
    left = min(max(middle - width / 2, cell.left), cell.right - width)
    top, bottom = cell.top, cell.bottom - gap
    for box in taken:
        if box.right > left - gap and box.left < left + width + gap and box.top < cell.bottom and box.bottom > cell.top:
            if box.top + box.bottom < cell.top + cell.bottom:
                top = max(top, box.bottom + gap)
            else:
                bottom = min(bottom, box.top - gap)
    top = max(bottom - most.height * unit, top)
    if width < least.width * unit or bottom - top < least.height * unit:
        return None
    return Box(round(left), round(top), round(left + width), round(bottom))


def _cell(composition: Composition, panes: Sequence[Pane]) -> tuple[Box, float]:
    """The box that a sheet has to stay in, and the x of its middle."""
    first, second = panes[:2]
    if len(panes) == 2 and first.y == second.y:
        margin, width = composition.margin, composition.width
        return Box(margin, composition.px(10), width - margin, composition.hairline.top), width / 2
    gap, clip = composition.px(10), first.clip
    return clip._replace(left=clip.left + gap, right=clip.right - gap), (clip.left + clip.right) / 2


def _unit(composition: Composition) -> float:
    """A pixel of the design, but not less than the smallest type makes it."""
    return max(composition.px(1), MIN_TYPE / 12)


class Sheet:
    """One sheet being drawn: first the things behind, then those in front, and labels where there is room."""

    def __init__(self, image: Image.Image, composition: Composition, box: Box, name: str) -> None:
        """Cover the box of the image; the boxes of all texts are named after `name`."""
        self.image, self.draw = image, ImageDraw.Draw(image)
        self.box, self.name = box, name
        self.unit = _unit(composition)
        self.line = max(1, round(self.unit))
        self.radius = max(round(4.5 * self.unit), 3)
        self.ring = 2 * self.radius
        self.gap = max(round(4 * self.unit), 4)
        self.face, self.title_face = (font(max(round(size * self.unit), MIN_TYPE)) for size in (12, 15))
        self.boxes: dict[str, Box] = {}
        shape = round(box.bottom - box.top), round(box.right - box.left)
        self._marked, self._lined = np.zeros(shape, bool), np.zeros(shape, bool)
        self.draw.rectangle((box.left, box.top, box.right - 1, box.bottom - 1), fill=GROUND)

    def width_of(self, text: str) -> float:
        return self.face.getlength(text)

    def size_of(self, text: str) -> tuple[float, float]:
        box = self.draw.textbbox((0, 0), text, font=self.face, anchor="lt")
        return box[2], box[3]

    def write(
        self,
        name: str,
        x: float,
        y: float,
        text: str,
        ink: Ink,
        anchor: str,
        face: ImageFont.FreeTypeFont | None = None,
    ) -> Box:
        """Write a text at a place where nothing else can be; return its box."""
        self.draw.text((x, y), text, ink, face or self.face, anchor=anchor)
        box = Box(*self.draw.textbbox((x, y), text, font=face or self.face, anchor=anchor))
        return self._report(name, box)

    def title(self, texts: Sequence[str], caption: str) -> Box:
        """Write the first of the texts that fits, or else the last, over a caption; return the caption's box."""
        left, room = self.box.left + 16 * self.unit, self.box.right - self.box.left - 32 * self.unit
        fitting = next((text for text in texts if self.title_face.getlength(text) <= room), texts[-1])
        self.write("title", left, self.box.top + 20 * self.unit, fitting, INK, "lm", self.title_face)
        return self.write("error", left, self.box.top + 41 * self.unit, caption, FAINT, "lm")

    def legend(self, room: Box, entries: Sequence[Entry]) -> bool:
        """Draw what each mark stands for, in a row that ends at the right of the room; nothing if the room is too narrow."""
        gap, apart = 14 * self.unit, self.radius + self.gap
        step = apart + self.radius + gap
        if sum(self.width_of(entry.text) + step for entry in entries) > room.right - room.left:
            return False
        x, y = room.right, (room.top + room.bottom) / 2
        for entry in reversed(entries):
            self.write(f"legend_{entry.name}", x, y, entry.text, entry.ink, "rm")
            x -= self.width_of(entry.text) + apart
            self.stamp(entry.shape, self.radius, (x, y), entry.ink)
            x -= self.radius + gap
        return True

    def levels(self, name: str, axis: Axis, ticks: Iterable[float], area: Box) -> None:
        """Draw rules across the area at round shares, and write the shares in percent left of it."""
        for number, value in enumerate(ticks):
            y = round(axis.at(value))
            self.rule(Box(area.left, y, area.right + 1, y + self.line), RULE)
            self.write(f"{name}_{number}", area.left - 8 * self.unit, y, round_percent(value), GREY, "rm")

    def level_ticks(self, axis: Axis, lines: float = 1.6) -> list[float]:
        """Round values that stand at least so many lines of type from each other."""
        return axis.ticks(lines * self.face.size)

    def rule(self, box: Box, ink: Ink) -> None:
        """Fill a box of whole pixels, which texts may cover; nothing for an empty box."""
        if box.left < box.right and box.top < box.bottom:
            self.draw.rectangle((box.left, box.top, box.right - 1, box.bottom - 1), fill=ink)

    def frame(self, box: Box, ink: Ink) -> None:
        """Draw the outline of a box of whole pixels."""
        self.draw.rectangle((box.left, box.top, box.right - 1, box.bottom - 1), outline=ink, width=self.line)

    def bar(self, box: Box, ink: Ink) -> None:
        """Fill a box that texts keep away from."""
        self.rule(box, ink)
        self._lined[self._part(Box(box.left - 1, box.top - 1, box.right + 1, box.bottom + 1))] = True

    def dashes(self, left: float, right: float, y: float, ink: Ink) -> None:
        """Draw a dashed level line that texts keep away from."""
        y, dash = round(y), 5 * self.unit
        for i in range(math.ceil((right - left) / (2 * dash))):
            x = left + 2 * i * dash
            self.draw.rectangle((x, y, min(x + dash, right), y + self.line - 1), fill=ink)
        self._lined[self._part(Box(left, y - 1, right, y + self.line + 1))] = True

    def curve(self, area: Box, places: Sequence[Place], ink: Ink, thickness: float, dot: float = 0) -> None:
        """Draw a line through the places, as far as it is in the area, with a dot of radius `dot` on each."""
        mask = curve_mask(area, places, thickness, dot)
        self.image.paste(ink, (round(area.left), round(area.top)), mask)
        self._lined[self._part(area)] |= np.asarray(mask) > 0

    def stamp(self, shape: str, radius: int, place: Place, ink: Ink) -> None:
        """Draw a marker."""
        mask = marker_mask(shape, radius, max(1.5, 0.35 * self.radius))
        corner = round(place[0] - mask.width / 2), round(place[1] - mask.height / 2)
        self.image.paste(ink, (*corner, corner[0] + mask.width, corner[1] + mask.height), mask)
        self._marked[self._part(Box(*(middle + side for side in (-radius, radius) for middle in place)))] = True

    def point(self, shape: str, radius: int, place: Place, ink: Ink) -> None:
        """Draw a marker with a rim in the ground's colour around it."""
        self.stamp(shape, radius + self.line, place, (*GROUND[:3], 255))
        self.stamp(shape, radius, place, ink)

    def label(
        self,
        name: str,
        place: Place,
        text: str,
        ink: Ink,
        reach: float,
        area: Box,
        *,
        away: bool = False,
        over_lines: bool = False,
    ) -> bool:
        """Write beside a mark of radius `reach`, if there is room; return whether. away: or else some lines off."""
        x, y = place
        width, height = self.size_of(text)
        above, below = y - reach - height, y + reach
        lefts = [x - share * width for share in (0.5, 0.1, 0.9, 0.3, 0.7)]
        lefts.append(min(max(lefts[0], area.left + 4), area.right - width - 4))
        further = [k * height for k in (1, 2, 3, 4)] if away else []
        tops = [above, below, *(above - far for far in further), *(below + far for far in further)]
        spots = [(x + reach, y - height / 2), (x - reach - width, y - height / 2)]
        return self.put(name, text, ink, spots + [(left, top) for top in tops for left in lefts], area, over_lines)

    def row(self, text: str, top: float, area: Box) -> list[Place]:
        """Places for a text along a level line, from the left of the area to its right."""
        first, last = area.left + 4, area.right - self.width_of(text) - 4
        return [(first + k / 20 * (last - first), top) for k in range(21)]

    def put(self, name: str, text: str, ink: Ink, spots: Iterable[Place], area: Box, over_lines: bool = False) -> bool:
        """Write at the first spot (left, top) where the text is within the area and touches nothing; return whether."""
        for spot in spots:
            at = round(spot[0]), round(spot[1])
            box = Box(*self.draw.textbbox(at, text, font=self.face, anchor="lt"))
            wide = Box(box.left - 3, box.top - 2, box.right + 3, box.bottom + 2)
            within = (
                wide.left >= area.left
                and wide.right <= area.right
                and wide.top >= area.top
                and wide.bottom <= area.bottom
            )
            part = self._part(wide)
            if within and not self._marked[part].any() and (over_lines or not self._lined[part].any()):
                self.draw.rectangle((box.left - 2, box.top - 1, box.right + 1, box.bottom), fill=GROUND)  # off the grid
                self.draw.text(at, text, ink, self.face, anchor="lt")
                self._report(name, box)
                return True
        return False

    def _report(self, name: str, box: Box) -> Box:
        self.boxes[f"{self.name}_{name}"] = box
        self._marked[self._part(box)] = True
        return box

    def _part(self, box: Box) -> tuple[slice, slice]:
        """The sheet's rows and columns in a box."""
        left, top = self.box.left, self.box.top
        rows = slice(max(round(box.top - top), 0), max(round(box.bottom - top), 0))
        return rows, slice(max(round(box.left - left), 0), max(round(box.right - left), 0))
