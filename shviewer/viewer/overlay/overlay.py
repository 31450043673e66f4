"""Captions, figures, band bars and the sheets over them: one RGBA image as large as the frame, redrawn on every change.

What does not fit is left out, least important first: the hint, then the bars, then all figures but the relative error.
Every piece reports its box, so that a click finds its bar and a test can see that nothing overlaps.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from shviewer.analysis.comparison import agrees
from shviewer.analysis.figures import PENDING, Pending
from shviewer.harmonics.quantities.names import in_words, roughness_of
from shviewer.viewer.composition import Composition
from shviewer.viewer.overlay.captions import write_captions
from shviewer.viewer.overlay.colour_bar import draw_colour_bar
from shviewer.viewer.overlay.figure_strip import write_figures
from shviewer.viewer.overlay.help_sheet import draw_help
from shviewer.viewer.overlay.layers import Layer, strips
from shviewer.viewer.overlay.lettering import FAINT, GREY, WARNING
from shviewer.viewer.overlay.painter import Painter
from shviewer.viewer.overlay.plots.band_series import band_series
from shviewer.viewer.overlay.plots.convergence import Convergence, draw_convergence
from shviewer.viewer.overlay.plots.plane import Plane, draw_plane, measured
from shviewer.viewer.panes import Box
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import describe_exposure
from shviewer.words import radiance, theta_phi_degrees

HINT = "Up/Down bands     0-9 mute     M method     E exposure     H help"
NOT_TIMED = "time against error: nothing was projected that could be timed; M changes the method"
NO_ROOM = {
    "plane": "no room for time against error: enlarge the window, or B",
    "convergence": "no room for error against bands: enlarge the window, or G",
}


@dataclass
class Overlay:
    """image: (height, width, 4) uint8, straight alpha. boxes: name -> where it was drawn. bars: band -> where to click."""

    image: NDArray[np.uint8]
    layers: tuple[Layer, ...]
    """The parts of the image that are not empty."""
    boxes: dict[str, Box] = field(default_factory=dict)
    bars: dict[int, Box] = field(default_factory=dict)
    plane: Plane | None = None
    """The time-error plane, if it is shown; the boxes of its texts are among `boxes`, too."""
    convergence: Convergence | None = None
    """The convergence plot, if it is shown; likewise."""

    @property
    def sheet(self) -> Box | None:
        """The box of the sheet over the spheres, if there is one."""
        shown = self.plane or self.convergence
        return shown.box if shown else None

    @property
    def obstacles(self) -> tuple[Box, ...]:
        """The boxes of all text and of the sheet, which marks and probed values keep clear of."""
        return (*self.boxes.values(), *((self.sheet,) if self.sheet else ()))


def draw_overlay(
    picture: Picture, composition: Composition, *, timing: bool = False, opengl: str = "", status: str = ""
) -> Overlay:
    """Draw all text and sheets that go over the spheres.

    timing: also say how many milliseconds the projection took, which no two runs agree on. opengl: named in the help.
    status: what is being done meanwhile, in place of messages.
    """
    sheet = Image.new("RGBA", (composition.width, composition.height))
    painter = Painter(ImageDraw.Draw(sheet), composition)
    write_captions(painter, picture, timing)
    painter.boxes.update(draw_colour_bar(sheet, picture, composition))
    write_figures(painter, picture)
    wanted = "" if picture.state.view.help_visible else picture.state.view.sheet
    drawing = sheet, picture, composition, list(painter.boxes.values())
    plane = draw_plane(*drawing) if wanted == "plane" else None
    convergence = draw_convergence(*drawing) if wanted == "convergence" else None
    shown = plane or convergence
    painter.boxes.update(shown.boxes if shown else {})
    timed = wanted != "plane" or measured(picture)
    _write_hint(painter, picture, (NO_ROOM[wanted] if timed else NOT_TIMED) if wanted and not shown else "", status)
    if picture.state.view.help_visible:
        draw_help(sheet, picture.state, composition, opengl)
    image = np.asarray(sheet)
    return Overlay(image, strips(image), painter.boxes, painter.bars, plane, convergence)


def status_layers(status: str, composition: Composition) -> tuple[Layer, ...]:
    """What is being done, where messages stand; for a window that has no picture yet."""
    sheet = Image.new("RGBA", (composition.width, composition.height))
    painter = Painter(ImageDraw.Draw(sheet), composition)
    painter.text("message", composition.margin, _hint_y(composition), status, 13, GREY, "lm")
    return strips(np.asarray(sheet))


def foresee(picture: Picture) -> None:
    """Compute what the text of a picture needs beyond the picture, so that drawing it takes no time for the light."""
    if picture.state.view.sheet == "convergence":
        band_series(picture)


def _write_hint(painter: Painter, picture: Picture, remark: str = "", status: str = "") -> None:
    """Write what is being done, a message, a remark, the suns split off, or the most useful keys; at the right the exposure."""
    at, state = painter.at, picture.state
    y = _hint_y(at)
    message = status or state.view.message or remark or picture.verdict or picture.subject.refusal.partition(";")[0]
    if message:
        face = painter.face(13)
        text = message
        while text and face.getlength(text) > at.width - 2 * at.margin:
            text = text[:-4].rstrip(" .") + "..." if len(text) > 8 else ""
        good = message == status or (message == picture.verdict and agrees(message))
        painter.text("message", at.margin, y, text, 13, GREY if good else WARNING, "lm")
    curve = "" if state.view.tone == "none" else f", {state.view.tone} curve"
    stops = f"exposure {picture.exposure_stops:+z.1f} stops ({describe_exposure(state.view)}){curve}"
    needs, far = picture.needs, at.width - at.margin
    within = f"within {100 * state.recipe.tolerance:g} %: {PENDING}"
    if not isinstance(needs, Pending):
        radiance, irradiance = (str(count or f"over {needs.searched}") for count in (needs.radiance, needs.irradiance))
        bands = "band" if needs.radiance == 1 else "bands"
        within = f"within {100 * needs.tolerance:g} %: {radiance} {bands}, for irradiance {irradiance}"
        if roughness_of(state.recipe.quantity) is not None:
            within += f", for {in_words(state.recipe.quantity)}: {needs.shown or f'over {needs.searched}'}"
    any(painter.text("exposure", far, y, text, 12, GREY, "rm") for text in (f"{within}     {stops}", within, stops))
    if not message:
        hints = [*_describe_suns(picture), HINT]
        any(painter.text("hint", at.margin, y, text, 12, GREY if text is not HINT else FAINT, "lm") for text in hints)


def _hint_y(at: Composition) -> float:
    return at.hairline_y + at.px(104)


def _describe_suns(picture: Picture) -> list[str]:
    """The suns and what splitting them off saves, in words, the longest text first; empty if there are no suns."""
    suns, before = picture.subject.suns, picture.needs_unsplit
    if not suns or before is None:
        return []
    unsplit = f"with it {PENDING} bands"
    if not isinstance(before, Pending):
        counts = (str(count or f"over {before.searched}") for count in (before.radiance, before.irradiance))
        unsplit = "with it {} bands, irradiance {}".format(*counts)
    sun = suns[0]
    theta, phi = theta_phi_degrees(sun.axis)
    place = f"theta {theta:.1f}, phi {phi:z.1f}"
    size = f"{np.degrees(2 * sun.half_angle):.2g} deg wide{', clipped in the file' if sun.clipped else ''}"
    colour = " ".join(radiance(value, 0.0) for value in sun.irradiance)
    count = "sun" if len(suns) == 1 else f"{len(suns)} suns, the first"
    return [
        f"{count} at {place}, {size}, irradiance {colour}; {unsplit}",
        f"{count} at {place}, {size}; {unsplit}",
        f"{count} at {place}, {size}",
    ]
