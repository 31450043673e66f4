"""The strip under the hairline: four figures, and how the light's energy is spread over the bands."""

from __future__ import annotations

from shviewer.analysis.figures import PENDING, Pending
from shviewer.viewer.overlay.band_axis import band_slots, band_step
from shviewer.viewer.overlay.lettering import ACCENT, FAINT, GREY, INK, NEGATIVE, RULE, UNUSED
from shviewer.viewer.overlay.painter import Painter
from shviewer.viewer.panes import Box
from shviewer.viewer.picture import Picture
from shviewer.words import percent, radiance, whole_percent


def write_figures(painter: Painter, picture: Picture) -> None:
    """Write four figures in fixed places, each with the longest of its labels that fits there, then a bar per band."""
    at, figures = painter.at, picture.figures
    y = at.hairline_y
    if 2 * at.margin < at.width:
        painter.draw.rectangle((at.margin, y, at.width - at.margin, y + max(0, round(at.scale) - 1)), fill=RULE)
    relative: tuple[str, ...] = ("relative L2 error",)
    largest: tuple[str, ...] = ("largest error",)
    error = minimum = negative = str(PENDING)
    if not isinstance(extremes := picture.extremes, Pending):
        error, minimum = (radiance(value, figures.peak) for value in (extremes.max_error, extremes.minimum))
        negative = percent(extremes.negative_area, 2)
        if extremes.max_error_bound is None:  # a Python function is known only where it was looked at
            largest = ("largest error found", *largest)
    if picture.subject.suns:
        relative = ("relative L2 error of rest", "L2 error of rest")
        largest = ("largest error of rest", "largest of rest", *largest)
    columns = (
        ("relative_l2", percent(figures.relative_l2, floor=figures.floor), relative),
        ("max_error", error, largest),
        ("minimum", minimum, ("minimum of a channel", "minimum")),
        ("negative_area", negative, ("luminance below zero",)),
    )
    face, room = painter.face(13), at.px(150) - at.px(6) - 1
    x = at.margin
    for name, value, labels in columns:
        for label in [text for text in labels[:-1] if face.getlength(text) < room] + [labels[-1]]:
            lines = ((name, y + at.px(36), value, 24, INK), (f"{name}_label", y + at.px(66), label, 13, GREY))
            if painter.texts(x, lines, "lm"):
                break
        if name == "negative_area" and name in painter.boxes:
            _swatch(painter, painter.boxes[name])
        x += at.px(150)
    _band_bars(painter, picture)


def _swatch(painter: Painter, value: Box) -> None:
    """Draw, beside a value, the colour that negative radiance has on the sphere."""
    side = (value.bottom - value.top) * 0.6
    box = Box(value.right + side, value.bottom - side, value.right + 2 * side, value.bottom)
    if painter.free(box._replace(left=box.left + painter.at.px(6))):
        painter.draw.rectangle(box, fill=NEGATIVE)
        painter.boxes["swatch"] = box


def _band_bars(painter: Painter, picture: Picture) -> None:
    """Draw the energy of each band: a bar filled as far as it is kept, hollow when muted, dim above n."""
    at, state = painter.at, picture.state
    slots = band_slots(state.bands_ahead)
    left = max((box.right for box in painter.boxes.values() if box.top > at.hairline_y), default=0) + at.px(24)
    face = painter.face(12)
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
    painter.draw.text(
        (first - at.px(16), base - at.px(5)), "energy, %" if numbers else "energy", FAINT, face, anchor="rm"
    )
    painter.draw.text((first - at.px(16), base + at.px(13)), "band", FAINT, face, anchor="rm")
    step = band_step(pitch, face.getlength("128") + 4)
    for band in range(slots):
        middle = first + (band + 0.5) * pitch
        share = shares[band] if band < len(shares) else 0.0
        share = share if share > picture.figures.floor**2 else 0.0  # below, it is rounding
        top = base - max(share * scale, 1.0)
        edge = (middle - bar / 2, top, middle + bar / 2, base)
        used = band < state.recipe.n_bands
        factor = min(max(picture.figures.factors[band], 0.0), 1.0) if used else 0.0
        if not used:
            painter.draw.rectangle(edge, fill=RULE)
        else:
            kept = base - factor * (base - top)
            painter.draw.rectangle(edge, outline=ACCENT, width=max(1, round(at.scale)))
            if factor:
                painter.draw.rectangle((edge[0], min(kept, base), edge[2], base), fill=ACCENT)
        if numbers and used:
            painter.draw.text((middle, top - at.px(9)), whole_percent(share), GREY, face, anchor="mm")
        if band % step == 0:
            ink = UNUSED if not used else FAINT if not factor else GREY
            painter.draw.text((middle, base + at.px(13)), str(band), ink, face, anchor="mm")
        if used and band == state.view.cursor and state.view.cursor_visible:
            y = base + at.px(3)
            painter.draw.rectangle((middle - bar / 2, y, middle + bar / 2, y + max(1, at.px(1.5))), fill=INK)
        painter.bars[band] = Box(middle - pitch / 2, base - tallest - at.px(16), middle + pitch / 2, base + at.px(20))
    painter.boxes["bars"] = Box(left, base - tallest - at.px(16), last, base + at.px(20))
