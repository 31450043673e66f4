"""The page as one HTML file: the Markdown that this program writes, in the look of the picture, with no library and no script.

Understood are headings, paragraphs, lists, tables, pictures, code and emphasis, as page/ writes them; all text is escaped.
Wide tables scroll by themselves, so that the page fits any width; printed, it is white, and its plots are dark on light.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from html import escape
from itertools import groupby

from shviewer.viewer.overlay.inks import ACCENT, GREY, GROUND, INK, RULE, Ink


def css(ink: Ink) -> str:
    """An ink as CSS: "rgb(236 236 240)"."""
    return f"rgb({' '.join(map(str, ink[:3]))})"


STYLE = f"""
:root {{ color-scheme: dark }}
body {{ background: {css(GROUND)}; color: {css(INK)}; font: 15px/1.5 Inter, system-ui, sans-serif; margin: 0 auto;
  max-width: 70em; padding: 1em; font-variant-numeric: tabular-nums }}
h1, h2, h3 {{ font-weight: 600; line-height: 1.2; margin: 1.6em 0 .5em }} h1 {{ margin-top: .5em }}
h2 {{ border-top: 1px solid {css(RULE)}; padding-top: 1em }}
p, ul {{ max-width: 48em }} a, code {{ color: {css(ACCENT)} }} code {{ overflow-wrap: anywhere }}
.wide {{ overflow-x: auto; margin: 1em 0 }} table {{ border-collapse: collapse; font-size: 13px }}
th, td {{ padding: 2px 10px; text-align: left; border-bottom: 1px solid {css(RULE)}; white-space: nowrap }}
th {{ color: {css(GREY)}; font-weight: 500 }} .n {{ text-align: right }}
img {{ max-width: 100%; width: 30em }} pre {{ overflow-x: auto }}
@media print {{
  :root {{ color-scheme: light }} body {{ background: white; color: black; font-size: 9pt; max-width: none }}
  a, code, th {{ color: black }} table {{ font-size: 7pt }} td, th {{ padding: 1px 5px }} .wide {{ overflow: visible }}
  img {{ filter: invert(1) hue-rotate(180deg) brightness(1.2); width: 20em; break-inside: avoid }}
  h2, h3 {{ break-after: avoid }}
}}
"""

Line = tuple[str, str]
"""The kind of block that a line belongs to, and the line."""


def as_html(text: str) -> str:
    """The page of a Markdown text that starts with its title."""
    title = escape(text.partition("\n")[0].lstrip("# "))
    body = "\n".join(
        _block(kind, [line for _, line in lines]) for kind, lines in groupby(_lines(text), lambda line: line[0])
    )
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>'
    return f'<!DOCTYPE html>\n<html lang="en">\n<head>{head}<style>{STYLE}</style></head>\n<body>\n{body}\n</body>\n</html>\n'


def _lines(text: str) -> Iterator[Line]:
    """Each line with its kind; kinds that follow each other without an empty line are one block."""
    kind, code = "", False
    for line in text.splitlines():
        if line.startswith("```"):
            code, kind = not code, ""
        elif code:
            yield "pre", line
        elif not line:
            yield "", ""
        elif found := re.match(r"(#{1,3}) ", line):
            kind = f"h{len(found[1])}"
            yield kind, line[found.end() :]
        else:
            kind = "table" if line.startswith(("| ", "|-")) else "ul" if line.startswith(("- ", "  ")) else "p"
            yield kind, line


def _block(kind: str, lines: list[str]) -> str:
    if kind == "table":
        return _table(lines)
    if kind == "ul":
        items = re.split(r"(?:^|\n)- ", "\n".join(lines))[1:]
        return "<ul>" + "".join(f"<li>{_inline(item)}</li>" for item in items) + "</ul>"
    if kind == "pre":
        return f"<pre>{escape(chr(10).join(lines))}</pre>"
    if kind.startswith("h"):
        return "".join(f"<{kind}>{_inline(line)}</{kind}>" for line in lines)
    return f"<p>{_inline(chr(10).join(lines))}</p>" if kind else ""


def _table(lines: list[str]) -> str:
    rows = [[cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    right = [cell.endswith(":") for cell in rows[1]]

    def row(cells: list[str], tag: str) -> str:
        marks = [' class="n"' if number else "" for number in right]
        cells = [f"<{tag}{mark}>{_inline(cell)}</{tag}>" for cell, mark in zip(cells, marks, strict=True)]
        return f"<tr>{''.join(cells)}</tr>"

    body = "\n".join(row(cells, "td") for cells in rows[2:])
    return f'<div class="wide"><table><thead>{row(rows[0], "th")}</thead><tbody>\n{body}\n</tbody></table></div>'


def _inline(text: str) -> str:
    """Plots beside the page, code and emphasis of a text; stars within code or a word are left as they are."""
    parts = re.split(r"`([^`]*)`", escape(text))
    for number, part in enumerate(parts):
        if number % 2:
            parts[number] = f"<code>{part}</code>"
            continue
        part = re.sub(r"(?<=\d)\s(?=%|\d{3}(?!\d))", "\N{NO-BREAK SPACE}", part)  # "5 %", "10 000"
        part = re.sub(r"!\[([^\]]*)\]\(([\w-]+\.svg)\)", r'<img src="\2" alt="\1">', part)
        part = re.sub(r"\*\*(\S.*?)\*\*", r"<strong>\1</strong>", part, flags=re.DOTALL)
        parts[number] = re.sub(r"(?<!\w)\*(\w.*?)\*(?!\w)", r"<em>\1</em>", part, flags=re.DOTALL)
    return "".join(parts)
