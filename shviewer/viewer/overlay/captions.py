"""Captions: what each sphere is, and in the corners which light it is, and how it was projected and drawn."""

from __future__ import annotations

from shviewer.analysis.comparison import caption
from shviewer.harmonics.basis import index
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quantities.names import RADIANCE, in_words
from shviewer.viewer.beside import words_of
from shviewer.viewer.drawn import DirectSum, SplineMap, Surfaces
from shviewer.viewer.overlay.lettering import FAINT, GREY, INK
from shviewer.viewer.overlay.painter import Painter
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import describe_basis, describe_muted, describe_window
from shviewer.words import counted, grouped, grouped_number, percent, radiance, shortened


def write_captions(painter: Painter, picture: Picture, timing: bool) -> None:
    """Write what each sphere is, and in the corners which light it is and how it was projected and drawn."""
    at, state = painter.at, picture.state
    y = at.caption_y
    left, right = (sphere.x for sphere in at.spheres[:2])
    muted = describe_muted(state.recipe)
    bands = f"{caption(state.recipe)}{counted(state.recipe.n_bands, 'band')}, {counted(state.recipe.n_bands**2, 'coefficient')}"
    quantity = state.recipe.quantity
    original = "Original" if quantity == RADIANCE else in_words(quantity).capitalize()
    suns = len(picture.subject.suns)
    surfaces = picture.drawn.shown if isinstance(picture.drawn, Surfaces) else ()
    if surfaces and suns:
        original = f"{original} without sun{'s' if suns > 1 else ''}"
    if surfaces and surfaces[0].clipped:
        original = f"{original}, cut at the circle"
    painter.text("original", left, y, original, 17, INK, "mm")
    apart = "" if not suns else "sun apart" if suns == 1 else f"{suns} suns apart"
    changes = [change for change in (apart, describe_window(state.recipe), muted) if change]
    if surfaces and surfaces[1].clipped:
        changes.append("cut at the circle")
    if state.view.basis is not None:
        value = float(picture.projection.coefficients[index(*state.view.basis)] @ LUMINANCE)
        bands, changes = describe_basis(state.view), [f"coefficient {radiance(value, picture.figures.peak)}"]
    captions = [", ".join([bands, *changes[:count]]) for count in range(len(changes), -1, -1)]
    any(painter.text("reconstruction", right, y, caption, 17, INK, "mm") for caption in captions)
    projection = picture.projection
    method, _, missed = projection.method.partition("; ")
    if projection.evaluations is not None:
        method = f"{method}, {grouped(projection.evaluations)} {projection.evaluation_noun}"
    spent = f"{grouped_number(projection.milliseconds)} ms" if timing and projection.milliseconds is not None else ""
    time = f"{projection.n_bands} bands projected in {spent}" if spent else ""
    drawn = describe_evaluation(picture, timing)
    times = [", ".join(filter(None, (time, drawn))), drawn or time, time]
    far, below = at.width - at.margin, y + at.px(20)
    if state.view.error != "off":
        error = at.spheres[-1]
        kind = "Error" if state.view.lobe_view else f"{state.view.error.capitalize()} error"
        if surfaces and surfaces[2].clipped:
            kind = f"{kind}, cut at the circle"
        painter.text("error", error.x, error.caption_y, kind, 17, INK, "mm")
    if picture.beside is not None:
        error, other = at.spheres[-1], picture.beside
        reached = f", error {percent(other.figures.relative_l2, floor=other.figures.floor)}"
        second = words_of(state.view.beside, other.recipe)
        any(
            painter.text("beside", error.x, error.caption_y, kind, 17, INK, "mm") for kind in (second + reached, second)
        )
    names = [shortened(picture.light.name, length) for length in (200, 32, 24, 16)]
    words, said = describe_light(picture), False
    if any(painter.text("light", at.margin, y, name, 15, GREY, "lm") for name in names):
        said = any(painter.text("description", at.margin, below, text, 12, FAINT, "lm") for text in words)
    else:
        any(painter.text("light", at.margin, below, name, 15, GREY, "lm") for name in names)
    if not said and "LDR" in words:
        any(painter.text("encoding", at.margin, line, "LDR", 12, FAINT, "lm") for line in (y, below))
    low = at.hairline_y - at.px(16)  # beside the colour bar, where the corner is taken
    unseen = [missed, missed.replace("narrower than", "under")]
    if painter.text("method", far, y, method, 13, FAINT, "rm"):
        any(painter.text("missed", far, below, text, 12, FAINT, "rm") for text in unseen)
        any(painter.text("time", far, below, text, 12, FAINT, "rm") for text in times) or any(
            painter.text("time", at.margin, low, text, 12, FAINT, "lm") for text in times
        )
    else:
        both = f"{method}, {spent}" if spent else method
        painter.text("method", far, below, both, 12, FAINT, "rm") or painter.text(
            "method", far, below, method, 12, FAINT, "rm"
        )
    if "missed" not in painter.boxes:
        any(painter.text("missed", at.margin, low, text, 12, FAINT, "lm") for text in unseen)


def describe_light(picture: Picture) -> list[str]:
    """The light in a few words, the longest text first: the description goes first, notes that must not be missed stay."""
    light = picture.subject.whole
    encoding = light.about.encoding or ""
    count = len(light.notes)
    marks = ["LDR"] * ("(LDR)" in encoding) + [counted(count, "note")] * (count > 0)
    return [", ".join(words) for words in ([light.description, *marks], marks, marks[:1]) if words]


def describe_evaluation(picture: Picture, timing: bool) -> str:
    """How the reconstruction is drawn. timing: whether the picture may depend on the machine; if not, the sum is not named."""
    match picture.drawn:
        case DirectSum():
            return "summed per pixel" if timing else ""
        case SplineMap(splines):
            height, width = splines.shape[:2]
            return f"from a map of {width} x {height}"
        case Surfaces():
            return ""
