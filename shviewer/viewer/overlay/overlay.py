"""Everything that is written: pieces in blocks, each of which is drawn and uploaded again only when it changes.

What does not fit is left out, least important first. Every text reports its box, so that a click finds its band and a test
can see that nothing overlaps.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.numbers_area import Line
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.message import kind_of
from shviewer.viewer.overlay.captions import caption_blocks, exposure_pieces
from shviewer.viewer.overlay.colour_bar import azimuth_pieces, colour_bar_pieces
from shviewer.viewer.overlay.drawing import layer_of, lettering
from shviewer.viewer.overlay.figures import answer_pieces, figure_pieces
from shviewer.viewer.overlay.foot import INKS, foot_pieces, said_of, takes_legend
from shviewer.viewer.overlay.help_sheet import help_blocks
from shviewer.viewer.overlay.inks import INK
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.letters.lettering import SEMIBOLD
from shviewer.viewer.overlay.letters.numerals import typeset
from shviewer.viewer.overlay.pieces import Piece, Text
from shviewer.viewer.overlay.plots.band_series import band_series
from shviewer.viewer.overlay.plots.curve import axes_of, curve_blocks, least_slots
from shviewer.viewer.overlay.plots.legend import hovered_pieces, legend_pieces
from shviewer.viewer.overlay.plots.plane import Plane, measured, plane_legend, plane_of, plane_pieces
from shviewer.viewer.overlay.plots.steps import steps_legend, steps_of, steps_pieces
from shviewer.viewer.overlay.plots.stored import stored_errors, stored_legend, stored_pieces
from shviewer.viewer.overlay.plots.trace import trace_pieces
from shviewer.viewer.overlay.working import hairline_pieces, turning_pieces, work_pieces
from shviewer.viewer.picture import Picture
from shviewer.viewer.work import Work

NOT_TIMED = "nothing was projected that could be timed; M changes the method"
SENTENCE = 470.0
"""Room for the sentences that explain what is plotted, in pixels of the design."""

NO_ROOM = "no room for {}: enlarge the window; {} closes it"


@dataclass(frozen=True, eq=False)
class Overlay:
    """Everything written, in blocks of pieces, and the boxes in which a click finds bands."""

    blocks: tuple[tuple[Piece, ...], ...]
    bars: dict[int, Box]

    @cached_property
    def layers(self) -> tuple[Layer, ...]:
        """The layers of everything written, one of each block; drawn when first asked for."""
        return tuple(found for found in map(layer_of, self.blocks) if found is not None)

    def drawing(self) -> Iterator[None]:
        """Draw the layers a little at a time; the first help takes a tenth of a second."""
        if "layers" not in self.__dict__:
            for block in self.blocks:
                yield from lettering(block)
                layer_of(block)
                yield

    @cached_property
    def boxes(self) -> dict[str, Box]:
        """The boxes of all pieces that have a name, which marks and probed values keep clear of."""
        return {piece.name: piece.box for block in self.blocks for piece in block if piece.name}


def draw_overlay(
    picture: Picture,
    composition: Composition,
    *,
    timing: bool = False,
    opengl: str = "",
    work: Work | None = None,
    hovered: int | None = None,
    pace: float | None = None,
) -> Overlay:
    """Draw everything that is written.

    timing: also say what holds in this session alone: how many milliseconds the projection took, and that there are other
    lights. opengl: named in the help.
    work: what is at work meanwhile, in place of messages and of OpenGL's name. hovered: the band under the mouse.
    pace: frames a second of a light that turns.
    """
    at, state = composition, picture.state
    if state.view.help_visible:
        said, page = state.view.message if work is None else "", state.view.help_page
        if said:
            return _overlay(help_blocks(state, at, typeset(said), page, INKS[kind_of(said)]))
        return _overlay(help_blocks(state, at, opengl if work is None else f"{work.words}; Esc stops", page))
    numbers = at.numbers
    heads, feet, unsaid = caption_blocks(picture, at, timing)
    blocks = [*heads, colour_bar_pieces(picture, at), *azimuth_pieces(at)]
    plane = plane_of(picture, at) if state.view.sheet == "plane" else None
    said = said_of(picture, _missing(picture, at, plane))
    told = bool(said) or work is not None
    turning = bool(numbers.foot and state.view.turning and not told)
    shared = numbers.on_foot(numbers.exposure)
    exposure: list[Piece] = []
    if numbers.exposure and not (shared and (told or turning)):
        exposure = exposure_pieces(picture, at, numbers.exposure, unsaid)
    line, foot = numbers.legend, list[Piece]()
    explained = plane or state.view.by_roughness or state.view.encode or hovered is not None
    if turning:
        foot = turning_pieces(at, picture, pace)
    elif work is not None:
        foot = work_pieces(at, work)
    elif explained and not said and (line is None or line.right - line.left < at.px(SENTENCE)):  # in place of keys
        line, exposure = numbers.foot, [] if shared else exposure
    else:
        after = round(max((piece.box.right for piece in exposure), default=0) + at.px(18)) if shared else 0
        others = timing and len(state.lights) > 1
        foot = foot_pieces(at, said, after=after, proposed="U" if picture.sun_to_blame else "", others=others)
    answers, figures = answer_pieces(picture, at), figure_pieces(picture, at)
    if numbers.foot is None and told:  # the message takes the place of the last line there is
        over = min((piece.box.top for piece in foot if isinstance(piece, Text)), default=at.height)
        kept = answers if numbers.figures and over > numbers.answers[0].label else []
        answers, figures, feet = kept, [], feet if numbers.answers else []
        if not (numbers.figures or numbers.answers):
            blocks = heads
    blocks += [*feet, hairline_pieces(at, work), answers, figures, exposure, foot]
    if numbers.curve is None:
        return _overlay(_beside(blocks, foot, at))
    plotted, legend, title, bars = _plotted(picture, at, line, plane, hovered)
    blocks += plotted
    if not (numbers.on_foot(numbers.legend) and (work is not None or takes_legend(at, said))):
        blocks.append(legend)
    if (head := numbers.curve_head) is not None:
        size = at.px(12.0 if at.compact else 15.0)
        blocks.append([Text("curve_head", head.left, head.baseline, title, size, INK, SEMIBOLD)])
    return _overlay(_beside(blocks, foot, at), bars)


def _beside(blocks: Sequence[Sequence[Piece]], foot: Sequence[Piece], at: Composition) -> Sequence[Sequence[Piece]]:
    """Blocks without the texts that a message of two lines stands on or beside, such as the numbers of bands."""
    lines = [piece.box for piece in foot if piece.name.startswith("message")]
    if len(lines) < 2 or at.numbers.foot is None:
        return blocks
    taken = Box(lines[0].left, lines[0].top, at.width, lines[-1].bottom)

    def stays(piece: Piece) -> bool:
        return piece in foot or not isinstance(piece, Text) or not piece.box.overlaps(taken)

    return [[piece for piece in block if stays(piece)] for block in blocks]


def _missing(picture: Picture, at: Composition, plane: Plane | None) -> str:
    """Why what was asked for in place of the curve is not there; "" if it is, or if nothing was."""
    view = picture.state.view
    if view.sheet == "plane":
        return (
            ""
            if plane
            else NO_ROOM.format("time against error", "B")
            if measured(picture)
            else NOT_TIMED * picture.complete
        )
    return NO_ROOM.format("bands against roughness", "J") if view.by_roughness and at.numbers.curve is None else ""


def _plotted(
    picture: Picture, at: Composition, line: Line | None, plane: Plane | None, hovered: int | None
) -> tuple[list[list[Piece]], list[Piece], str, dict[int, Box]]:
    """What is plotted: its blocks, what explains it on a line, if there is one, its head, and where a click finds bands."""
    view, legend, bars = picture.state.view, list[Piece](), dict[int, Box]()
    if plane is not None:
        blocks, head = [plane_pieces(plane, at)], "time against error"
        legend = plane_legend(plane, picture, line, at) if line else []
    elif view.by_roughness:
        steps, head = steps_of(picture), "bands against roughness"
        blocks = [steps_pieces(steps, picture, at)]
        legend = steps_legend(steps, picture, line, at) if line else []
    elif view.encode:
        blocks, head = [stored_pieces(stored_errors(picture), picture, at)], "error of each encoding"
        legend = stored_legend(picture, line, at) if line else []
    else:
        series, head = band_series(picture, least_slots(at)), "error against bands"
        axes = axes_of(series, at)
        bars = {band: axes.slot(band, at.px(20)) for band in range(axes.slots)}
        blocks = curve_blocks(series, picture.state, at)
        if line and hovered is not None and hovered < series.slots:
            legend = hovered_pieces(series, hovered, line, at)
        elif line:
            legend = legend_pieces(picture.state, line, at)
    return blocks, trace_pieces(view.trace, line, at) if view.trace and line else legend, head, bars


def status_layers(work: Work, composition: Composition) -> tuple[Layer, ...]:
    """What is being done, where messages stand; for a window that has no picture yet."""
    blocks = [hairline_pieces(composition, work), work_pieces(composition, work)]
    return _overlay(blocks).layers


def foresee(picture: Picture) -> None:
    """Compute what the text of a picture needs beyond the picture, so that drawing it takes no time for the light."""
    band_series(picture)
    if picture.state.view.by_roughness:
        steps_of(picture)
    elif picture.state.view.encode:
        stored_errors(picture)


def _overlay(blocks: Sequence[Sequence[Piece]], bars: dict[int, Box] | None = None) -> Overlay:
    return Overlay(tuple(tuple(block) for block in blocks if block), bars or {})
