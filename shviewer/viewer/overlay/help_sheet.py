"""The key table as a calm sheet over the dimmed picture: keys left, what they do, the present value right."""

from __future__ import annotations

from PIL import Image, ImageDraw, ImageFont

from shviewer.viewer.composition import Composition
from shviewer.viewer.keys import BINDINGS, Binding
from shviewer.viewer.state import State

Group = tuple[str, tuple[Binding, ...]]
DIM = (10, 10, 12, 232)
KEY_COLUMN = 10.5
"""Width of the column of keys, in type sizes."""

LEGEND = "blue: radiance below zero, the ringing of few bands; W takes it away"

TITLE, KEY, TEXT, VALUE = (100, 160, 255, 255), (236, 236, 240, 255), (178, 178, 188, 255), (236, 236, 240, 255)


def draw_help(sheet: Image.Image, state: State, composition: Composition, opengl: str) -> None:
    """Dim the sheet and write the table in two columns, as large as fits."""
    draw = ImageDraw.Draw(sheet)
    draw.rectangle((0, 0, composition.width, composition.height), fill=DIM)
    groups = list(BINDINGS.items())
    half = min(range(1, len(groups)), key=lambda at: max(_line_count(groups[:at]), _line_count(groups[at:])))
    columns = [groups[:half], groups[half:]]
    size = _fitting_size(columns, state, composition)
    face = ImageFont.load_default(size)
    line = size * 1.5
    most = max(_line_count(column) for column in columns)
    top = max((composition.height - most * line) / 2, line / 2)
    width = (composition.width - 3 * composition.margin) / 2
    for number, column in enumerate(columns):
        x = composition.margin + number * (width + composition.margin)
        y = top
        for title, rows in column:
            draw.text((x, y), title, TITLE, face)
            y += line
            for row in rows:
                draw.text((x, y), row.label, KEY, face)
                draw.text((x + KEY_COLUMN * size, y), row.help, TEXT, face)
                draw.text((x + width, y), _shortened(row.value(state)), VALUE, face, anchor="ra")
                y += line
            y += line * 0.6
    if top > 2 * line:
        y = composition.height - line * 1.2
        draw.text((composition.margin, y), opengl, TEXT, face)
        if face.getlength(opengl) + face.getlength(LEGEND) < composition.width - 4 * composition.margin:
            draw.text((composition.width - composition.margin, y), LEGEND, TEXT, face, anchor="ra")


def _line_count(column: list[Group]) -> float:
    return sum(1.6 + len(rows) for _, rows in column)


def _fitting_size(columns: list[list[Group]], state: State, composition: Composition) -> float:
    """The largest type, up to 15 pixels of the design, with which every line and column fits."""
    size = composition.px(15)
    width = (composition.width - 3 * composition.margin) / 2
    while size > 6:
        face = ImageFont.load_default(size)
        widest = max(
            KEY_COLUMN * size + face.getlength(row.help) + size + face.getlength(_shortened(row.value(state)))
            for column in columns
            for _, rows in column
            for row in rows
        )
        if widest <= width and max(map(_line_count, columns)) * size * 1.5 <= composition.height - size:
            return size
        size -= 0.5
    return size


def _shortened(value: str) -> str:
    return value if len(value) <= 18 else value[:17] + "..."
