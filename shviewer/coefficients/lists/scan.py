"""The numbers of a text in C, GLSL, HLSL, WGSL, JavaScript or no language, with their brackets, lines and names.

Nothing is computed: between the numbers stand separators, brackets, comments, and names of types, arrays and channels. Whatever
else stands there is refused, with its line.
"""

from __future__ import annotations

import re
from bisect import bisect_right

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.lists.names import names_place
from shviewer.coefficients.numbers import MAX_NUMBERS
from shviewer.errors import LightError
from shviewer.limits import MAX_BANDS

_COMMENT_OPENS = re.compile(r"//|#|/\*")
_TEMPLATE = re.compile(
    r"(?:array\s?<\s?)?vec[34]\s?<\s?\w{1,9}\s?>(?:\s?,\s?\w{1,9}\s?>)?|array\s?<\s?\w{1,20}\s?,\s?\w{1,9}\s?>"
)
_WORD = re.compile(
    r"[A-Za-z_][\w.]*(?:-\d+)?(?:\s{0,9}\[\s{0,9}\w{0,40}\s{0,9}\]){0,4}|[()\[\]{}=:]|[^\s,;()\[\]{}=:\"']+", re.ASCII
)
_NAME_BEGINS = re.compile(r"[A-Za-z_]", re.ASCII)
_DASH = re.compile(r"^[ \t]*- (?=[A-Za-z_])", re.MULTILINE)  # of a YAML list of names

_MOST_WORDS = 4 * MAX_NUMBERS


def plain_numbers(text: str) -> NDArray[np.float64]:
    """All numbers of a text, (k,), whatever their rows. LightError for anything else in it but brackets and comments."""
    return Scan(without_comments(text)).values


def without_comments(text: str) -> str:
    """The text with only the line breaks of its comments, in one pass; one that is never closed is left as it is.

    Comments are those of C, GLSL and Python.
    """
    parts, at, last_end = [], 0, text.rfind("*/")
    while opens := _COMMENT_OPENS.search(text, at):
        start, end = opens.span()
        if opens[0] != "/*":
            end = text.find("\n", start)
            end = len(text) if end < 0 else end
        elif end <= last_end:
            end = text.find("*/", end) + 2
        else:
            parts.append(text[at:end])
            at = end
            continue
        parts += text[at:start], "\n" * text.count("\n", start, end)
        at = end
    return "".join([*parts, text[at:]])


class Scan:
    """The numbers of a text, (k,), and of each its line, the innermost bracket around it, and the last name before it.

    A name has = or : after it, or ends with an l and m and stands in the line of its number. LightError for any other word.
    """

    def __init__(self, text: str) -> None:
        self.text = _DASH.sub("", _TEMPLATE.sub("", text))
        self._breaks = [match.start() for match in re.finditer("\n", self.text)]
        self.lines: list[int] = []
        self.brackets: list[int] = []
        self.owners: list[int] = []
        """Where the names stand in `names`; -1 for none."""
        self.names: list[str] = []
        self.values = np.array(self._read())

    def _read(self) -> list[float]:
        values: list[float] = []
        opened, inside, outer = 0, 0, list[int]()
        pending: list[re.Match[str]] = []  # names of which it is not known yet what they name
        for count, match in enumerate(_WORD.finditer(self.text)):
            word = match[0]
            if count > _MOST_WORDS or len(values) > MAX_NUMBERS:
                raise LightError(
                    f"more than {MAX_NUMBERS} numbers, which {MAX_BANDS} bands of three channels have, real and imaginary,"
                    " or far more words than numbers: keep the coefficients only"
                )
            if word in "([{":
                outer.append(inside)
                inside = opened = opened + 1
                pending.clear()  # the name of a type
            elif word in "=:" and pending:
                self.names.append(pending[-1][0])
                pending.clear()
            elif (value := number(word)) is not None:
                line = self._line(match)
                if len(pending) == 1 and names_place(pending[0][0]) and self._line(pending[0]) == line:
                    self.names.append(pending.pop()[0])
                if pending:
                    self._refuse(pending[0])
                values.append(value)
                self.lines.append(line)
                self.brackets.append(inside)
                self.owners.append(len(self.names) - 1)
            elif _NAME_BEGINS.match(word):
                pending.append(match)
            elif word in ")]}" and not pending:
                inside = outer.pop() if outer else 0
            else:
                self._refuse(pending[0] if pending else match)
        if pending:
            self._refuse(pending[0])
        return values

    def _line(self, match: re.Match[str]) -> int:
        return bisect_right(self._breaks, match.start()) + 1

    def _refuse(self, match: re.Match[str]) -> None:
        raise LightError(
            f"{match[0][:40]!r} in line {self._line(match)} is no number;"
            " a bare list holds numbers, commas, brackets, names and comments"
        )


def number(word: str) -> float | None:
    """A number, perhaps with the suffix of C, GLSL or HLSL; None for any other word."""
    if not word.isascii() or "_" in word:  # Python would read 1_0 and the digits of all scripts
        return None
    try:
        return float(word[:-1] if word[-1] in "fFhH" and word[:-1] not in ("in", "+in", "-in") else word)
    except ValueError:
        return None
