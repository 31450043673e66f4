"""The numbers of a coefficient file as a table of n**2 rows and three channels, whatever its text looks like.

The text may hold n**2 rows of three, three rows of n**2 (one per channel), 3 n**2 numbers in one list (red, green, blue of
each coefficient), or n**2 numbers, which are grey. The last two cannot be confused: 3 n**2 is no square.
"""

from __future__ import annotations

import re
from math import isqrt

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.limits import MAX_BANDS

MAX_NUMBERS = 6 * MAX_BANDS**2
"""The most numbers in a file: real and imaginary parts of three channels."""

_COMMENT_OPENS = re.compile(r"//|#|/\*")
_PUNCTUATION = re.compile(r"[\s,;(){}\[\]]+")


def plain_numbers(text: str) -> NDArray[np.float64]:
    """All numbers of a text, (k,), separated by commas, semicolons, brackets and spaces, without those in comments.

    Comments are those of C, GLSL and Python. LightError, with the line, for anything else in the text.
    """
    bare = _without_comments(text)
    words = [word for word in _PUNCTUATION.split(bare) if word]
    if len(words) > MAX_NUMBERS:
        raise LightError(
            f"{len(words)} numbers: {MAX_BANDS} bands of three channels, real and imaginary, have {MAX_NUMBERS}"
        )
    try:
        if not bare.isascii() or "_" in bare:  # Python would read 1_0 and the digits of all scripts
            raise ValueError
        return np.array([float(word.removesuffix("f")) for word in words])
    except ValueError:
        bad = next(word for word in words if not _is_number(word))
        line = next(number for number, row in enumerate(bare.splitlines(), 1) if bad in row)
        raise LightError(
            f"{bad[:40]!r} in line {line} is no number; a bare list holds numbers, commas, brackets and comments only"
        ) from None


def _without_comments(text: str) -> str:
    """The text with only the line breaks of its comments, in one pass; one that is never closed is left as it is."""
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


def _is_number(word: str) -> bool:
    if not word.isascii() or "_" in word:
        return False
    try:
        float(word.removesuffix("f"))
    except ValueError:
        return False
    return True


def as_table(numbers: NDArray[np.generic], *, complex_pairs: bool = False) -> NDArray[np.generic]:
    """The numbers as a table (n**2, 3), float64. complex_pairs: complex128, from complex numbers or pairs of real ones.

    LightError for a length that fits no n, more than MAX_BANDS bands, or a value that is not finite.
    """
    if numbers.size > MAX_NUMBERS:
        raise LightError(f"{numbers.size} numbers: at most {MAX_BANDS} bands, {MAX_NUMBERS} numbers, are read")
    if np.iscomplexobj(numbers) and not complex_pairs:
        raise LightError("complex numbers; of the conventions only scipy has them: --convention scipy")
    wide = np.asarray(numbers, dtype=np.complex128 if np.iscomplexobj(numbers) else np.float64)
    if complex_pairs and not np.iscomplexobj(wide):
        if wide.shape[-1:] and wide.shape[-1] % 2:
            raise LightError(
                f"rows of {wide.shape[-1]} numbers; complex ones are pairs, real and imaginary part: six to a row"
            )
        wide = wide[..., 0::2] + 1j * wide[..., 1::2]
    if not np.isfinite(wide).all():
        row = int(np.argmin(np.isfinite(wide).reshape(len(wide), -1).all(axis=1)))
        where = f"{'row' if wide.ndim > 1 else 'number'} {row} (from 0)"
        raise LightError(f"{where} is not finite; coefficients are finite numbers: project the light again")
    table = wide.T if wide.ndim == 2 and wide.shape[0] == 3 and wide.shape[1] != 3 else wide
    flat = table.reshape(-1)
    n_bands = isqrt(flat.size)
    if n_bands**2 == flat.size and (table.ndim == 1 or table.shape[1] == 1) and n_bands:
        return np.repeat(flat[:, None], 3, axis=1)
    if table.ndim == 2 and table.shape[1] != 3:
        raise LightError(f"rows of {table.shape[1]} numbers; a row holds red, green and blue")
    rows = flat.size / 3
    n_bands = max(1, round(rows**0.5))
    if n_bands**2 != rows:
        what = f"{rows:g} rows of three" if flat.size % 3 == 0 else f"{flat.size} numbers"
        raise LightError(
            f"{what}: n bands have n^2 rows; near are n = {n_bands} ({n_bands**2} rows) and "
            f"n = {n_bands + (1 if n_bands**2 < rows or n_bands == 1 else -1)}"
        )
    return np.ascontiguousarray(flat.reshape(-1, 3))
