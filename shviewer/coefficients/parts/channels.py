"""Channels of a list: the order of red, green and blue, and whether they come in turn or one after the other."""

from __future__ import annotations

from itertools import permutations

CHANNEL_ORDERS = tuple("".join(order) for order in permutations("rgb"))
"""The first is ours."""

RGB = CHANNEL_ORDERS[0]

BY_CHANNEL, INTERLEAVED = SEQUENCES = ("by-channel", "interleaved")
"""All of red, then of green, then of blue, wherever lines break; or red, green and blue in turn."""

FLAT_BY_CHANNEL = "flat-by-channel"
"""By channel in lists without rows, such as the container of a program has; rows are red, green, blue."""


def channel_places(order: str) -> list[int]:
    """Where our channels stand: the column of each column."""
    return [RGB.index(channel) for channel in order]
