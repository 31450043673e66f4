"""What is said about each pane: what it is, and what must not be missed of it, in wordings from long to short."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from shviewer.analysis.comparing.comparison import caption
from shviewer.analysis.recipe import Recipe
from shviewer.harmonics.basis import index
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE, in_words
from shviewer.viewer.beside import Beside, words_of
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.drawn import DirectSum, Encoded, SplineMap, Surfaces
from shviewer.viewer.overlay.letters.numerals import share, typeset
from shviewer.viewer.overlay.setting import Part
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import describe_basis, describe_muted, describe_window
from shviewer.words import counted, grouped, radiance, theta_phi_degrees

ERRORS: dict[str, Part] = {
    "signed": ("reconstruction − original", "signed"),
    "absolute": ("absolute",),
    "relative": ("relative to the original", "relative"),
}


class Words(NamedTuple):
    """A head, the parts of what is said about it in their order, and those among them that no picture may hide."""

    head: str
    parts: Sequence[Part]
    must: Sequence[Part] = ()


def words_of_panes(picture: Picture, at: Composition) -> Iterator[tuple[str, Words]]:
    """The words of each pane, after its name."""
    yield "original", _original_words(picture, at)
    yield "reconstruction", _reconstruction_words(picture, at)
    if picture.error_scale is not None:
        yield "error", _error_words(picture)
    elif picture.beside is not None:
        yield "error", _beside_words(picture, picture.beside)


def _original_words(picture: Picture, at: Composition) -> Words:
    light = picture.subject.whole
    size = light.about.size
    asked = picture.state.recipe.quantity
    quantity = "original" if asked == RADIANCE else in_words(asked)
    what = f"{size[0]} × {size[1]}" if size else light.description
    suns = len(picture.subject.suns) if isinstance(picture.drawn, Surfaces) else 0
    without = ("without sun" if suns == 1 else "without suns",) if suns else ()
    notes: list[Part] = [(note,) for note in notes_of(picture)]
    if at.compact:  # there they stand beside the exposure
        return Words(picture.light.name, [])
    parts = [(quantity,), (what, what.partition(" (")[0]), *notes, without, *_clipped(picture, 0)]
    return Words(picture.light.name, parts, notes)


def notes_of(picture: Picture) -> list[str]:
    """What must not be missed of a light."""
    light = picture.subject.whole
    low_range = "(LDR)" in (light.about.encoding or "")
    return ["LDR"] * low_range + [counted(len(light.notes), "note")] * bool(light.notes)


def _changes(picture: Picture) -> list[Part]:
    """What sets the reconstruction apart from the plain sum of its bands."""
    recipe, suns = picture.state.recipe, len(picture.subject.suns)
    apart = ("sun apart" if suns == 1 else f"{suns} suns apart") if suns else "no sun" * bool(picture.subject.refusal)
    muted, count = describe_muted(recipe), len(recipe.muted_shown)
    fewer = (f"{counted(count, 'band')} muted", f"{count} muted") if muted else ()
    window = describe_window(recipe)
    return [(muted, *fewer), (window, window.partition(" of ")[0], window.partition(" ")[0]), (apart,)]


def _reconstruction_words(picture: Picture, at: Composition) -> Words:
    recipe, view = picture.state.recipe, picture.state.view
    head = f"{caption(recipe)}{counted(recipe.n_bands, 'band')}"
    if view.basis is not None:
        value = float(picture.projection.coefficients[index(*view.basis)] @ LUMINANCE)
        coefficient = f"coefficient {radiance(value, picture.figures.peak)}"
        return Words(typeset(describe_basis(view)), [(coefficient,), ("radius: magnitude",)])
    changes = _changes(picture)
    if name := view.encode or _encoding_given(recipe):
        kept = f"{ENCODINGS[name].floats} numbers"
        return Words(f"{caption(recipe)}{ENCODINGS[name].words}", [(f"{kept} a channel", kept), *changes], changes)
    method, _, missed = picture.projection.method.partition("; ")
    method = "" if any(places.foot for places in at.captions[1:2]) else method
    count = f"{grouped(recipe.n_bands**2)} coefficient{'' if recipe.n_bands == 1 else 's'}"
    may_miss: Part = (_short(missed), _shorter(missed))
    parts = [(count,), *changes, (method,), may_miss, *_clipped(picture, 1)]
    return Words(head, parts, [*changes, may_miss])


def _encoding_given(recipe: Recipe) -> str:
    """The encoding whose whole irradiance the coefficients are that are compared; "" if they are no such."""
    given = recipe.compare
    if given is None or given.stored is None or (recipe.quantity, recipe.n_bands) != (IRRADIANCE, given.n_bands):
        return ""
    return given.stored.name


def _short(missed: str) -> str:
    """ "features narrower than 3 degrees may be missed" in fewer letters."""
    return re.sub(r" ([\d.]+) degrees", r" \1°", missed.replace("narrower than", "under"))


def _shorter(missed: str) -> str:
    """The same in the fewest: "may miss < 3°"."""
    return re.sub(r"^features under (.*) may be missed$", r"may miss < \1", _short(missed))


def _error_words(picture: Picture) -> Words:
    kind = "signed" if isinstance(picture.drawn, Surfaces) else picture.state.view.error
    return Words("error", [ERRORS[kind], *_clipped(picture, 2)])


def _beside_words(picture: Picture, second: Beside) -> Words:
    """Another reconstruction in place of the error: which, and how far it is from the light."""
    reached = share(second.found.sums.relative_l2, floor=second.found.sums.floor)
    what = words_of(picture.state.view.beside, second.found.recipe)
    return Words(f"{what[0].lower()}{what[1:]}", [(f"relative L2 error {reached}", f"error {reached}")])


def _clipped(picture: Picture, pane: int) -> list[Part]:
    """Whether the circle cuts a surface."""
    cut = isinstance(picture.drawn, Surfaces) and picture.drawn.shown[pane].clipped
    return [("cut at the circle", "cut")] if cut else []


def describe_evaluation(picture: Picture, timing: bool) -> str:
    """How the reconstruction is drawn. timing: whether the picture may depend on the machine; if not, the sum is not named."""
    match picture.drawn:
        case DirectSum():
            return "summed per pixel" if timing else ""
        case Encoded():
            return "its formula per pixel"
        case SplineMap(splines):
            height, width = splines.shape[:2]
            return f"from a map of {width} × {height}"
        case Surfaces():
            return ""


def describe_suns(picture: Picture) -> str:
    """The greatest sun that was split off, in a few words; "" if none was."""
    if not picture.subject.suns:
        return ""
    theta, phi = theta_phi_degrees(picture.subject.suns[0].axis)
    return f"sun at theta {theta:.0f}°, phi {phi:z.0f}°"
