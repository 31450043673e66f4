"""A table that is written as a file: numbers, the same as text row by row, and the stamp."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.stamp import Value
from shviewer.harmonics.quantities.encodings import Stored


class TableRow(NamedTuple):
    """A row of a table: what it is, such as ("l", 0) and ("m", 0), and its numbers as text."""

    place: tuple[tuple[str, object], ...]
    numbers: list[str]

    @property
    def words(self) -> str:
        """ "l = 0, m = 0", or "c0" where there is one thing to say"""
        named = [f"{name} = {value}" for name, value in self.place]
        return ", ".join(named) if len(named) > 1 else str(self.place[0][1])


class Table(NamedTuple):
    """What is written, of coefficients or of what engines store of an irradiance."""

    numbers: NDArray[np.generic]
    """(k, 3), in the convention."""
    stamp: dict[str, Value]
    convention: Convention
    name: str
    """The name of the light."""
    rows: list[TableRow]
    """The numbers as text, each row with its place."""
    stored: Stored | None = None
    """What the numbers are of, if they are no coefficients alone."""

    @property
    def symbol(self) -> str:
        """The name of the array in source code."""
        return identifier(self.name)

    @property
    def function(self) -> str:
        """The name of the function in a shader: sh_NAME_QUANTITY, or with the encoding in place of the quantity."""
        held = self.stored.name if self.stored else self.stamp["quantity"]
        return re.sub(r"\W", "_", f"{self.symbol}_{held}")

    def comments(self, mark: str = "//") -> list[str]:
        """The stamp in lines that begin with `mark`."""
        shown = {key: repr(value) if isinstance(value, float) else value for key, value in self.stamp.items()}
        return [f"{mark} {key}: {value}" for key, value in shown.items()]

    def with_keys(self, added: dict[str, Value]) -> Table:
        """The table with more keys after `layout` in its stamp."""
        items = list(self.stamp.items())
        place = [*self.stamp].index("layout") + 1 if "layout" in self.stamp else len(items)
        return self._replace(stamp=dict([*items[:place], *added.items(), *items[place:]]))


def identifier(name: str) -> str:
    """The identifier sh_NAME, with only what C and GLSL allow in a name: letters, digits, single underscores."""
    return re.sub(r"_+", "_", "sh_" + re.sub(r"[^A-Za-z0-9]", "_", name)).rstrip("_")
