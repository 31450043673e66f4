"""Numbers as they are set in the picture: a true minus, thin spaces, powers of ten."""

from __future__ import annotations

import math
import re
from functools import lru_cache

from shviewer.words import grouped, percent, radiance

MINUS, THIN = "\u2212", "\u202f"
"""The minus sign of mathematics, and a thin space at which no line breaks."""

RAISE = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
BEYOND = 1.01
"""A bound that lies further beyond what was found than this factor is said beside it."""


@lru_cache(maxsize=1024)
def typeset(text: str) -> str:
    """A text of words.py with its numbers as they are set: "-1.08e-5" as "−1.08 × 10⁻⁵", "5 %" with a thin space."""
    text = re.sub(r"(?<=\d)e\+?(-?)0*(\d+)", lambda found: f" × 10{(found[1] + found[2]).translate(RAISE)}", text)
    text = re.sub(r"(?<![\w.-])-(?=[\d.])", MINUS, text)
    text = re.sub(r"(?<=\d) (?=\d{3}(?!\d))", THIN, text)
    return text.replace(" %", f"{THIN}%")


def share(value: float, digits: int = 3, floor: float = 0.0) -> str:
    """A share of 1 in percent; below a thousandth of a percent it only says so."""
    if floor < 1e-5 and (0 < value < 1e-5 or value < floor):
        return typeset("< 0.001 %")
    return typeset(percent(value, digits, floor))


def value(found: float, peak: float, digits: int = 3) -> str:
    """A radiance, its thousands apart where it has more than four digits."""
    said = radiance(found, peak, digits)
    return typeset(grouped(int(said)) if re.fullmatch(r"-?\d{5,}", said) else said)


def bound_text(found: float, bound: float | None, peak: float, digits: int = 3) -> str:
    """The bound of an extreme that lies more than a hundredth beyond what was found, to stand after that; else "".

    digits: with fewer than three it is rounded away from what was found, so that it stays a bound.
    """
    if bound is None or abs(bound) <= abs(found) * BEYOND or abs(bound) <= 1e-6 * peak:
        return ""
    said, other = value(bound if digits == 3 else _outward(bound, digits), peak, digits), value(found, peak)
    if said == other:
        return ""
    return f" to {said}" if bound < 0 else f" – {said}"


def _outward(bound: float, digits: int) -> float:
    """The number of so many digits that is next, away from zero."""
    step = 10.0 ** (math.floor(math.log10(abs(bound))) - digits + 1)
    return math.copysign(step * math.ceil(abs(bound) / step - 1e-9), bound)
