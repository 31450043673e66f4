"""Options: the kind of each, the rule for its values, and one line of help, stated once, beside the field that holds it.

The command line, the Python functions, the limits and the guide's tables are made from these. Nothing here loads numpy, so
that --help does not.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import field, fields
from operator import index
from typing import Any, NamedTuple, Protocol, TypeVar

from shviewer.errors import UsageError, refused_as
from shviewer.harmonics.quantities import names
from shviewer.limits import MAX_BANDS
from shviewer.words import meant

T = TypeVar("T")


class Kind(Protocol):
    """The values that an option may have."""

    def taken(self, name: str, value: Any) -> Any:
        """A caller's value as the field holds it. UsageError, with name, value and rule, for a value of another type."""

    def check(self, name: str, value: Any) -> None:
        """UsageError, with name, value and rule, for a value out of range."""


class Option(NamedTuple):
    """One option: a row of the guide's tables."""

    name: str
    default: Any
    kind: Kind
    help: str
    called: str = ""
    """Its name on the command line and what stands for its values there; "" if they are given with another option."""
    const: Any = None
    """The value that a flag without one stands for; None for an option that takes a value."""

    @property
    def flag(self) -> str:
        return self.called.partition(" ")[0]

    def may_be(self, value: Any) -> bool:
        """Whether the value is None, as only an option that is None by default may be."""
        return value is None and self.default is None


def option(default: T, kind: Kind, help: str, called: str = "", const: T | None = None) -> T:
    """Declare a field of a dataclass as an option, called "--camera AZIMUTH ELEVATION"."""
    held: T = field(default=default, metadata={"option": (kind, help, called, const)})
    return held


def options_of(*holders: type) -> dict[str, Option]:
    """The options of dataclasses by their names, in the order of their fields."""
    return {
        part.name: Option(part.name, part.default, *part.metadata["option"])
        for holder in holders
        for part in fields(holder)
        if "option" in part.metadata
    }


def taken(options: dict[str, Any], holder: type) -> dict[str, Any]:
    """The options that belong to a dataclass, as it holds them. UsageError for a value of another type."""
    given = {name: (row, options[name]) for name, row in options_of(holder).items() if name in options}
    return {name: None if row.may_be(value) else row.kind.taken(name, value) for name, (row, value) in given.items()}


def check_options(held: object) -> None:
    """UsageError unless every option of a dataclass is within its range."""
    for name, row in options_of(type(held)).items():
        if not row.may_be(value := getattr(held, name)):
            row.kind.check(name, value)


class Choice(NamedTuple):
    """One of a few words."""

    choices: tuple[str, ...]

    def taken(self, name: str, value: Any) -> Any:
        if not isinstance(value, str):
            raise UsageError(f"{_said(name)} {value!r}: it must be a text")
        return value

    def check(self, name: str, value: Any) -> None:
        if value not in self.choices:
            known = [choice for choice in self.choices if choice]
            rule = f"it must be one of {', '.join(known)}{', or empty' if '' in self.choices else ''}"
            raise UsageError(f"{_said(name)} {value!r}: {meant(str(value), known, rule)}")


class Whole(NamedTuple):
    """A whole number within bounds; in messages `says` puts the number into words, `rule` the bounds."""

    least: int
    most: float
    says: str
    rule: str

    def taken(self, name: str, value: Any) -> Any:
        return whole(value, name)

    def check(self, name: str, value: Any) -> None:
        if not self.least <= value <= self.most:
            raise UsageError(f"{self.says.format(value)}: {self.rule}")


class WholeOr(NamedTuple):
    """A whole number from 1 to `most`, or one of a few words."""

    words: tuple[str, ...]
    most: int

    def taken(self, name: str, value: Any) -> Any:
        return value if isinstance(value, str) else whole(value, name)

    def check(self, name: str, value: Any) -> None:
        if value not in self.words and not (isinstance(value, int) and 1 <= value <= self.most):
            rule = meant(str(value), self.words, f"it must be {', '.join(self.words)} or 1 to {self.most}")
            raise UsageError(f"{_said(name)} {value}: {rule}")


class Number(NamedTuple):
    """A finite number within bounds. closed: the bounds are allowed, too."""

    least: float
    most: float
    rule: str
    closed: bool = True
    called: str = ""
    """Its name in messages, if that is not the field's."""

    def taken(self, name: str, value: Any) -> Any:
        if not is_number(value):
            raise UsageError(f"{name} {value!r}: it must be a finite number")
        return float(value)

    def check(self, name: str, value: Any) -> None:
        inside = self.least <= value <= self.most if self.closed else self.least < value < self.most
        if not inside:
            raise UsageError(f"{self.called or _said(name)} {value:g}: {self.rule}")


class Share(Number):
    """A number that may be given in percent."""

    def taken(self, name: str, value: Any) -> Any:
        if isinstance(value, str) and value.endswith("%"):
            with suppress(ValueError):
                value = float(value[:-1]) / 100
        return super().taken(name, value)


class Flag:
    """True or False."""

    def taken(self, name: str, value: Any) -> Any:
        if not (isinstance(value, bool) or type(value).__name__ in ("bool", "bool_") or value in (0, 1)):
            raise UsageError(f"{name} {value!r}: it must be True or False")
        return bool(value)

    def check(self, name: str, value: Any) -> None:
        """Accept both values."""


class Quantity:
    """The name of a quantity."""

    words = (names.RADIANCE, names.IRRADIANCE, f"{names.GLOSSY}0.5")
    """Some of its names."""

    def taken(self, name: str, value: Any) -> Any:
        if not isinstance(value, str):
            raise UsageError(f"{name} {value!r}: {names.RULE}")
        with refused_as(UsageError, f"{name} "):
            return names.quantity_of(value)

    def check(self, name: str, value: Any) -> None:
        if self.taken(name, value) != value:
            raise UsageError(f"{name} {value!r}: it is written {self.taken(name, value)!r}")


class BandSet(NamedTuple):
    """Several bands, each counted from 0."""

    most: int

    def taken(self, name: str, value: Any) -> Any:
        if isinstance(value, str):
            with refused_as(UsageError, f"{name} "):
                return bands_in(value)
        if not isinstance(value, Iterable):
            raise UsageError(f"{name} {value!r}: it must be several bands, such as [1, 3]")
        return frozenset(whole(band, f"{name} band") for band in value)

    def check(self, name: str, value: Any) -> None:
        for band in sorted(value):
            if not 0 <= band < self.most:
                raise UsageError(f"{name} band {band}: bands are counted from 0 to {self.most - 1}")


class Pair(NamedTuple):
    """Two numbers, whole ones if `whole`; `what` names them in messages, with an example."""

    what: str
    whole: bool = False

    def taken(self, name: str, value: Any) -> Any:
        if not (isinstance(value, Sequence) and len(value) == 2 and all(map(is_number, value))):
            raise UsageError(f"{name} {value!r}: it must be {self.what}")
        return tuple(whole(part, name) for part in value) if self.whole else tuple(map(float, value))

    def check(self, name: str, value: Any) -> None:
        """Accept any two numbers."""


def bands_in(text: str) -> frozenset[int]:
    """The bands of a text such as "1,3" or "2-4". ValueError if it has others."""
    bands: set[int] = set()
    try:
        for part in filter(str.strip, text.split(",")):
            low, dash, high = part.partition("-")
            first, last = int(low), int(high if dash else low)
            if last < first:
                raise ValueError
            bands |= {first, *range(first, min(last, MAX_BANDS) + 1)}  # BandSet refuses what is beyond
    except ValueError:
        raise ValueError(f"{text!r}: bands are whole numbers and ranges, such as 1,3 or 2-4") from None
    return frozenset(bands)


def whole(value: Any, name: str) -> int:
    """The value as an int. UsageError unless it is a whole number of some integer type."""
    try:
        if isinstance(value, bool):
            raise TypeError
        return index(value)
    except TypeError:
        raise UsageError(f"{name} {value!r}: it must be a whole number, such as 5") from None


def is_number(value: Any) -> bool:
    """Whether a value is a finite number, of Python's or numpy's types."""
    try:
        return not isinstance(value, str | bytes) and math.isfinite(value)
    except (TypeError, OverflowError):
        return False


def _said(name: str) -> str:
    """A field's name in words."""
    return name.replace("_", " ")
