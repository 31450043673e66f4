"""Names in a list: of channels, such as r, x or red, and of coefficients, such as L1m1, l1_1 or sh[3]."""

from __future__ import annotations

import re
from collections.abc import Sequence

CHANNELS = ("red", "green", "blue")

_CHANNELS = (("r", "g", "b", "a"), ("x", "y", "z", "w"), (*CHANNELS, "alpha"))
_PLACE = re.compile(r".*?[A-Za-z_](\d)([_mMnN-]{0,2})(\d)", re.ASCII)
_INDEX = re.compile(r"(.*?)\[\s*(\d{1,5})\s*\]", re.ASCII)


def channel_order(names: Sequence[str]) -> list[int] | None:
    """Where red, green, blue and perhaps alpha stand among the first three or four names; None unless these are repeated
    to the end.
    """
    words = [name.strip("_").lower() for name in names]
    for channels in (3, 4):
        first = words[:channels]
        if words == first * (len(words) // channels):
            for known in _CHANNELS:
                if set(first) == set(known[:channels]):
                    return [first.index(name) for name in known[:channels]]
    return None


def channel_at_end(name: str) -> str:
    """ "shR", "sh_red" and "red[9]" as R, or red."""
    word = name.split("[")[0].strip("_")
    return next((colour for colour in CHANNELS if word.lower().endswith(colour)), word[-1:])


def names_place(name: str) -> bool:
    """Whether a name ends with an l and m."""
    return _PLACE.fullmatch(name) is not None


def are_places(names: Sequence[str]) -> bool:
    """Whether names with places have an l and m, and not only the number of the row, as sh[3]."""
    return not _INDEX.fullmatch(names[0])


def places_of(names: Sequence[str]) -> list[int] | None:
    """The index l(l+1) + m of each name, such as L00, l1_1, L1m1 or sh[0]; None unless all n**2 are named once.

    An underscore alone may be a minus, as in Babylon's l1_1 beside l11, or part l and m, as in L1_1 beside L1_m1.
    """
    everything = list(range(len(names)))
    indices = [found for name in names if (found := _INDEX.fullmatch(name))]
    if len(indices) == len(names) and len({found[1] for found in indices}) == 1:
        place = [int(found[2]) for found in indices]
        return place if sorted(place) == everything else None
    parts = [found.groups() for name in names if (found := _PLACE.fullmatch(name))]
    for minus in ("mMnN-_", "mMnN-"):
        orders = [(int(l), int(m) * (-1 if set(sign) & set(minus) else 1)) for l, sign, m in parts]
        place = [l * (l + 1) + m for l, m in orders if abs(m) <= l]
        if sorted(place) == everything:
            return place
    return None
