"""Captions, figures, band bars and the sheets over them: one RGBA image as large as the frame, drawn when something changes.

What does not fit is left out, least important first: the hint, then the bars, then all figures but the relative error.
Every piece reports its box, so that a click finds its bar and a test can see that nothing overlaps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from shviewer.harmonics.basis import index
from shviewer.harmonics.extremes import LUMINANCE
from shviewer.viewer.band_axis import band_slots, band_step
from shviewer.viewer.colour_bar import draw_colour_bar
from shviewer.viewer.comparison import caption
from shviewer.viewer.composition import Box, Composition
from shviewer.viewer.convergence import Convergence, draw_convergence
from shviewer.viewer.help_sheet import draw_help
from shviewer.viewer.layers import Layer, strips
from shviewer.viewer.lettering import (
    ACCENT,
    FAINT,
    GREY,
    INK,
    MIN_TYPE,
    NEGATIVE,
    RULE,
    UNUSED,
    WARNING,
    Ink,
    font,
    grouped,
    grouped_number,
    percent,
    radiance,
    shortened,
    whole_percent,
)
from shviewer.viewer.picture import Picture
from shviewer.viewer.plane import Plane, draw_plane
from shviewer.viewer.state import describe_basis, describe_exposure, describe_muted, describe_window

HINT = "Up/Down bands     0-9 mute     M method     E exposure     H help"
NO_ROOM = {
    "plane": "no room for time against error: enlarge the window, or B",
    "convergence": "no room for error against bands: enlarge the window, or G",
}


@dataclass
class Overlay:
    """image: (height, width, 4) uint8, straight alpha. boxes: name -> where it was drawn. bars: band -> where to click."""

    image: NDArray[np.uint8]
    layers: tuple[Layer, ...]
    """What of the image is not empty."""
    boxes: dict[str, Box] = field(default_factory=dict)
    bars: dict[int, Box] = field(default_factory=dict)
    plane: Plane | None = None
    """The time-error plane, if it is shown; what is written in it is among the boxes, too."""
    convergence: Convergence | None = None

    @property
    def sheet(self) -> Box | None:
        """Where a sheet lies over the spheres."""
        shown = self.plane or self.convergence
        return shown.box if shown else None

    @property
    def obstacles(self) -> tuple[Box, ...]:
        """What is written, and the sheet: what else is laid over the spheres keeps clear of."""
        return (*self.boxes.values(), *((self.sheet,) if self.sheet else ()))

    """Likewise."""


def draw_overlay(picture: Picture, composition: Composition, *, timing: bool = False, opengl: str = "") -> Overlay:
    """Everything that is written over the spheres.

    timing: also say how many milliseconds the projection took, which no two runs agree on. opengl: named in the help.
    """
    sheet = Image.new("RGBA", (composition.width, composition.height))
    painter = _Painter(ImageDraw.Draw(sheet), composition)
    painter.captions(picture, timing)
    painter.boxes.update(draw_colour_bar(sheet, picture, composition))
    painter.figures(picture)
    wanted = "" if picture.state.help_visible else picture.state.sheet
    drawing = sheet, picture, composition, list(painter.boxes.values())
    plane = draw_plane(*drawing) if wanted == "plane" else None
    convergence = draw_convergence(*drawing) if wanted == "convergence" else None
    shown = plane or convergence
    painter.boxes.update(shown.boxes if shown else {})
    painter.hint(picture, NO_ROOM[wanted] if wanted and not shown else "")
    if picture.state.help_visible:
        draw_help(sheet, picture.state, composition, opengl)
    image = np.asarray(sheet)
    return Overlay(image, strips(image), painter.boxes, painter.bars, plane, convergence)


class _Painter:
    """Draws pieces one after the other and remembers their boxes."""

    def __init__(self, draw: ImageDraw.ImageDraw, composition: Composition) -> None:
        self.draw = draw
        self.at = composition
        self.boxes: dict[str, Box] = {}
        self.bars: dict[int, Box] = {}

    def face(self, size: float) -> ImageFont.FreeTypeFont:
        """Type of `size` pixels of the design, but never too small to read."""
        return font(max(round(self.at.px(size)), MIN_TYPE))

    def text(self, name: str, x: float, y: float, text: str, size: float, ink: Ink, anchor: str) -> bool:
        """Draw unless it would leave the frame or touch another piece; `size` in pixels of the design."""
        return self.texts(x, ((name, y, text, size, ink),), anchor)

    def texts(self, x: float, lines: Sequence[tuple[str, float, str, float, Ink]], anchor: str) -> bool:
        """All of (name, y, text, size, ink) at one x, or none of them."""
        faces = [self.face(size) for _, _, _, size, _ in lines]
        boxes = {
            name: Box(*self.draw.textbbox((x, y), text, font=face, anchor=anchor))
            for (name, y, text, _, _), face in zip(lines, faces, strict=True)
            if text
        }
        if not boxes or not all(self.free(box) for box in boxes.values()):
            return False
        for (_, y, text, _, ink), face in zip(lines, faces, strict=True):
            self.draw.text((x, y), text, font=face, fill=ink, anchor=anchor)
        self.boxes.update(boxes)
        return True

    def free(self, box: Box) -> bool:
        gap = self.at.px(6)
        inside = box.left >= 0 and box.top >= 0 and box.right <= self.at.width and box.bottom <= self.at.height
        return (
            inside
            and not any(sphere.touches(box) for sphere in self.at.spheres)
            and not any(
                box.left < other.right + gap
                and other.left < box.right + gap
                and box.top < other.bottom + 1
                and other.top < box.bottom + 1
                for other in self.boxes.values()
            )
        )

    def captions(self, picture: Picture, timing: bool) -> None:
        """What each sphere is; in the corners what light it is and how it was projected."""
        at, state = self.at, picture.state
        y = at.caption_y
        left, right = (sphere.x for sphere in at.spheres[:2])
        muted = describe_muted(state)
        plural = "s" if state.n_bands > 1 else ""
        bands = f"{caption(state)}{state.n_bands} band{plural}, {state.n_bands**2} coefficient{plural}"
        original = "Original" if state.quantity == "radiance" else "Irradiance"
        suns = len(picture.subject.suns)
        if picture.surfaces and suns:
            original = f"{original} without sun{'s' if suns > 1 else ''}"
        if picture.surfaces and picture.surfaces[0].clipped:
            original = f"{original}, cut at the circle"
        self.text("original", left, y, original, 17, INK, "mm")
        apart = "" if not suns else "sun apart" if suns == 1 else f"{suns} suns apart"
        changes = [change for change in (apart, describe_window(state), muted) if change]
        if picture.surfaces and picture.surfaces[1].clipped:
            changes.append("cut at the circle")
        if state.basis is not None:
            value = float(picture.projection.coefficients[index(*state.basis)] @ LUMINANCE)
            bands, changes = describe_basis(state), [f"coefficient {radiance(value, picture.figures.extremes.peak)}"]
        captions = [", ".join([bands, *changes[:count]]) for count in range(len(changes), -1, -1)]
        any(self.text("reconstruction", right, y, caption, 17, INK, "mm") for caption in captions)
        projection = picture.projection
        method = projection.method
        if projection.evaluations is not None:
            method = f"{method}, {grouped(projection.evaluations)} {projection.evaluation_noun}"
        time = f"{projection.n_bands} bands projected in {grouped_number(projection.milliseconds)} ms" if timing else ""
        drawn = describe_evaluation(picture, timing)
        times = [", ".join(filter(None, (time, drawn))), drawn or time, time]
        far, below = at.width - at.margin, y + at.px(20)
        if state.error != "off":
            error = at.spheres[-1]
            kind = "Error" if state.lobe_view else f"{state.error.capitalize()} error"
            if picture.surfaces and picture.surfaces[2].clipped:
                kind = f"{kind}, cut at the circle"
            self.text("error", error.x, error.caption_y, kind, 17, INK, "mm")
        names = [shortened(picture.light.name, length) for length in (200, 32, 24, 16)]
        words, said = describe_light(picture), False
        if any(self.text("light", at.margin, y, name, 15, GREY, "lm") for name in names):
            said = any(self.text("description", at.margin, below, text, 12, FAINT, "lm") for text in words)
        else:
            any(self.text("light", at.margin, below, name, 15, GREY, "lm") for name in names)
        if not said and "LDR" in words:
            any(self.text("encoding", at.margin, line, "LDR", 12, FAINT, "lm") for line in (y, below))
        if self.text("method", far, y, method, 13, FAINT, "rm"):
            low = at.hairline_y - at.px(16)  # beside the colour bar, where the corner is taken
            any(self.text("time", far, below, text, 12, FAINT, "rm") for text in times) or any(
                self.text("time", at.margin, low, text, 12, FAINT, "lm") for text in times
            )
        else:
            both = f"{method}, {grouped_number(projection.milliseconds)} ms" if time else method
            self.text("method", far, below, both, 12, FAINT, "rm") or self.text(
                "method", far, below, method, 12, FAINT, "rm"
            )

    def figures(self, picture: Picture) -> None:
        """Four numbers in fixed places, each with the longest of its labels that fits there, then a bar per band."""
        at, figures = self.at, picture.figures
        y = at.hairline_y
        if 2 * at.margin < at.width:
            self.draw.rectangle((at.margin, y, at.width - at.margin, y + max(0, round(at.scale) - 1)), fill=RULE)
        extremes = figures.extremes
        relative: tuple[str, ...] = ("relative L2 error",)
        largest: tuple[str, ...] = ("largest error",)
        if picture.subject.suns:
            relative = ("relative L2 error of rest", "L2 error of rest")
            largest = ("largest error of rest", "largest of rest", *largest)
        columns = (
            ("relative_l2", percent(figures.relative_l2, floor=figures.floor), relative),
            ("max_error", radiance(extremes.max_error, extremes.peak), largest),
            ("minimum", radiance(extremes.minimum, extremes.peak), ("minimum",)),
            ("negative_area", percent(extremes.negative_area, 2), ("of the sphere negative",)),
        )
        face, room = self.face(13), at.px(150) - at.px(6) - 1
        x = at.margin
        for name, value, labels in columns:
            for label in [text for text in labels[:-1] if face.getlength(text) < room] + [labels[-1]]:
                lines = ((name, y + at.px(36), value, 24, INK), (f"{name}_label", y + at.px(66), label, 13, GREY))
                if self.texts(x, lines, "lm"):
                    break
            if name == "negative_area" and name in self.boxes:
                self.swatch(self.boxes[name])
            x += at.px(150)
        self.band_bars(picture)

    def swatch(self, value: Box) -> None:
        """Beside a value, the colour that negative radiance has on the sphere."""
        side = (value.bottom - value.top) * 0.6
        box = Box(value.right + side, value.bottom - side, value.right + 2 * side, value.bottom)
        if self.free(box._replace(left=box.left + self.at.px(6))):
            self.draw.rectangle(box, fill=NEGATIVE)
            self.boxes["swatch"] = box

    def band_bars(self, picture: Picture) -> None:
        """Energy of each band: filled as far as it is kept, hollow when muted, dim above n. A bar stays where it is."""
        at, state = self.at, picture.state
        slots = band_slots(state.bands_ahead)
        left = max((box.right for box in self.boxes.values() if box.top > at.hairline_y), default=0) + at.px(24)
        face = self.face(12)
        label_width = face.getlength("energy, %")
        first, last = left + label_width + at.px(16), at.width - at.margin
        pitch = (last - first) / slots
        if pitch < 3 or last - first < at.px(160):
            return
        base, tallest = at.hairline_y + at.px(71), at.px(42)
        shares = picture.figures.energy_share[:slots]
        scale = tallest / max(max(shares, default=0.0), 1e-300)
        bar = max(1.0, min(pitch * 0.62, at.px(31)))
        numbers = pitch > face.getlength("888") + 2
        self.draw.text(
            (first - at.px(16), base - at.px(5)), "energy, %" if numbers else "energy", FAINT, face, anchor="rm"
        )
        self.draw.text((first - at.px(16), base + at.px(13)), "band", FAINT, face, anchor="rm")
        step = band_step(pitch, face.getlength("128") + 4)
        for band in range(slots):
            middle = first + (band + 0.5) * pitch
            share = shares[band] if band < len(shares) else 0.0
            top = base - max(share * scale, 1.0)
            edge = (middle - bar / 2, top, middle + bar / 2, base)
            used = band < state.n_bands
            factor = min(max(picture.figures.factors[band], 0.0), 1.0) if used else 0.0
            if not used:
                self.draw.rectangle(edge, fill=RULE)
            else:
                kept = base - factor * (base - top)
                self.draw.rectangle(edge, outline=ACCENT, width=max(1, round(at.scale)))
                if factor:
                    self.draw.rectangle((edge[0], min(kept, base), edge[2], base), fill=ACCENT)
            if numbers and used:
                self.draw.text((middle, top - at.px(9)), whole_percent(share), GREY, face, anchor="mm")
            if band % step == 0:
                ink = UNUSED if not used else FAINT if not factor else GREY
                self.draw.text((middle, base + at.px(13)), str(band), ink, face, anchor="mm")
            if used and band == state.cursor and state.cursor_visible:
                y = base + at.px(3)
                self.draw.rectangle((middle - bar / 2, y, middle + bar / 2, y + max(1, at.px(1.5))), fill=INK)
            self.bars[band] = Box(middle - pitch / 2, base - tallest - at.px(16), middle + pitch / 2, base + at.px(20))
        self.boxes["bars"] = Box(left, base - tallest - at.px(16), last, base + at.px(20))

    def hint(self, picture: Picture, remark: str = "") -> None:
        """A message, a remark, what was split off, or else the most useful keys; on the right the exposure."""
        at, state = self.at, picture.state
        y = at.hairline_y + at.px(104)
        message = state.message or remark or picture.suspicion or picture.subject.refusal.partition(";")[0]
        if message:
            face = self.face(13)
            text = message
            while text and face.getlength(text) > at.width - 2 * at.margin:
                text = text[:-4].rstrip(" .") + "..." if len(text) > 8 else ""
            self.text("message", at.margin, y, text, 13, WARNING, "lm")
        stops = f"exposure {picture.exposure_stops:+.1f} stops ({describe_exposure(state)})"
        needs, far = picture.needs, at.width - at.margin
        radiance, irradiance = (str(count or f"over {needs.searched}") for count in (needs.radiance, needs.irradiance))
        bands = "band" if needs.radiance == 1 else "bands"
        within = f"{100 * needs.tolerance:g} % needs {radiance} {bands}, irradiance {irradiance}"
        any(self.text("exposure", far, y, text, 12, FAINT, "rm") for text in (f"{within}     {stops}", within, stops))
        if not message:
            hints = [*_describe_suns(picture), HINT]
            any(self.text("hint", at.margin, y, text, 12, GREY if text is not HINT else FAINT, "lm") for text in hints)


def describe_light(picture: Picture) -> list[str]:
    """The light in a few words, with what must not be missed; the description alone is the first thing to go."""
    light = picture.subject.whole
    encoding = getattr(getattr(light, "source", light), "encoding", None) or ""
    count = len(light.notes)
    marks = ["LDR"] * ("(LDR)" in encoding) + [f"{count} note{'s' if count > 1 else ''}"] * (count > 0)
    return [", ".join(words) for words in ([light.description, *marks], marks, marks[:1]) if words]


def describe_evaluation(picture: Picture, timing: bool) -> str:
    """How the reconstruction is drawn; in a picture that does not depend on the machine only if it is not the sum."""
    if picture.surfaces:
        return ""
    if picture.reconstruction_map is None:
        return "summed per pixel" if timing else ""
    height, width = picture.reconstruction_map.shape[:2]
    return f"from a map of {width} x {height}"


def _describe_suns(picture: Picture) -> list[str]:
    """What the suns are and what it buys to split them off, the longest form first; none if there are none."""
    suns, before = picture.subject.suns, picture.needs_unsplit
    if not suns or before is None:
        return []
    counts = (str(count or f"over {before.searched}") for count in (before.radiance, before.irradiance))
    unsplit = "with it {} bands, irradiance {}".format(*counts)
    sun = suns[0]
    theta = np.degrees(np.arctan2(np.hypot(sun.axis[0], sun.axis[1]), sun.axis[2]))
    phi = np.degrees(np.arctan2(sun.axis[1], sun.axis[0]))
    place = f"theta {theta:.1f}, phi {phi:z.1f}"
    size = f"{np.degrees(2 * sun.half_angle):.2g} deg wide"
    colour = " ".join(radiance(value, 0.0) for value in sun.irradiance)
    count = "sun" if len(suns) == 1 else f"{len(suns)} suns, the first"
    return [
        f"{count} at {place}, {size}, irradiance {colour}; {unsplit}",
        f"{count} at {place}, {size}; {unsplit}",
        f"{count} at {place}, {size}",
    ]
