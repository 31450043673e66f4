"""A logarithmic axis in pixels, and the round values that are written along it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

MANTISSAS = ((1.0, 2.0, 5.0), (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0))
"""Mantissas of ticks where an axis holds fewer than two powers of ten; every factor of two holds two of the last row."""


@dataclass(frozen=True)
class Axis:
    """A logarithmic axis: `low` stands at pixel `start`, `high` at `end`."""

    low: float
    high: float
    start: float
    end: float

    def at(self, value: float) -> float:
        """The pixel of a value."""
        return self.start + (self.end - self.start) * math.log(value / self.low) / math.log(self.high / self.low)

    def ticks(self, apart: float) -> list[float]:
        """Round values at least `apart` pixels from each other: powers of ten if two fit in, else fractions of them."""
        first, last = math.floor(math.log10(self.low)), math.ceil(math.log10(self.high))
        decades = range(first, last + 1)
        choices = [[10.0**k for k in decades if k % step == 0] for step in range(1, len(decades))]
        choices += [[float(f"{m}e{k}") for k in decades for m in mantissas] for mantissas in MANTISSAS]
        found: list[float] = []
        for choice in choices:
            inside = [value for value in choice if self.low <= value <= self.high]
            places = sorted(map(self.at, inside))
            if all(right - left >= apart for left, right in pairwise(places)):
                found = max(found, inside, key=len)
            if len(found) > 1:
                break
        return found


def padded_axis(
    low: float, high: float, least: float, start: float, end: float, before: float, after: float, *, centred: bool
) -> Axis:
    """An axis from low to high, or over a factor of `least` if that is more, with so many pixels free before and after."""
    if high < low * least:
        centre = math.sqrt(low * high) if centred else low * math.sqrt(least)
        low, high = centre / math.sqrt(least), centre * math.sqrt(least)
    per_pixel = math.log(high / low) / max(abs(end - start) - before - after, 1.0)
    return Axis(low * math.exp(-before * per_pixel), high * math.exp(after * per_pixel), start, end)
