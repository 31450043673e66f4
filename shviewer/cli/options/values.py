"""How the values of options are read. argparse says an ArgumentTypeError in one line, with the name of the option."""

from __future__ import annotations

import argparse
import math
from contextlib import suppress

from shviewer.analysis.options import bands_in
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.names import quantity_of


def finite(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a finite number")
    return value


def whole(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number, such as 5") from None


def count(text: str) -> int:
    value = finite(text)  # 1e6 is a count, too
    if value != int(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number")
    return int(value)


def positive(text: str) -> float:
    value = finite(text)
    if not value > 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not positive")
    return value


def positive_count(text: str) -> int:
    return int(positive(str(count(text))))


def share(text: str) -> float:
    value = finite(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text!r}: a share is 0 to 1")
    return value


def tolerance(text: str) -> float:
    value = finite(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    if not 0 < value < 1:
        hint = f"did you mean {text}%?" if 1 <= value < 100 and not text.endswith("%") else "such as 0.05 or 5%"
        raise argparse.ArgumentTypeError(f"{text!r}: a tolerance is between 0 and 1; {hint}")
    return value


def whole_or_word(text: str) -> int | str:
    return int(text) if text.isdecimal() else text


def band_list(text: str) -> frozenset[int]:
    try:
        return bands_in(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def quantity(text: str) -> str:
    """The one name of a quantity; a text that is none is refused with the other options."""
    with suppress(ValueError):
        return quantity_of(text)
    return text


def number_of(text: str, what: str) -> float:
    """The number. UsageError, which says what it should be, if it is none."""
    try:
        return finite(text)
    except argparse.ArgumentTypeError as error:
        raise UsageError(f"{what} {error}") from error
