"""Lists of numbers in text: with or without brackets, names and a header."""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby

import numpy as np

from shviewer.coefficients.lists.columns import header_of, read_columns
from shviewer.coefficients.lists.commas import DECIMAL_COMMAS, with_points
from shviewer.coefficients.lists.names import are_places, channel_at_end, channel_order, places_of
from shviewer.coefficients.lists.scan import Scan, without_comments
from shviewer.coefficients.numbers import Listed, Numbers, arranged, holds_light
from shviewer.errors import LightError

_AS_ASCII = str.maketrans({"\u2212": "-", "\u00a0": " ", "\u2009": " ", "\u202f": " "})
"""A minus sign and the spaces that type-setters use."""

_UNITY = [f"sh[{i:>2}]" for i in range(27)]
"""The names in Unity's YAML of a SphericalHarmonicsL2: all of red, then of green, then of blue."""


def read_list(text: str, *, table: bool = False, sort: bool = True) -> Listed:
    """The list in a text, and one line on each guess. table: its lines are rows, as in CSV.

    sort: by the columns l and m, if a header has them. LightError if it is anything but a list.
    """
    bare = without_comments(text).translate(_AS_ASCII)
    first, _, rest = bare.lstrip().partition("\n")
    if not first:
        raise LightError("no rows; a list has n^2 rows of red, green, blue")
    if header := header_of(first, table):
        return read_columns(*header, rest.splitlines(), sort)
    pointed = with_points(bare)
    found = _rows_of(Scan(pointed), wrapped=not table)
    if pointed != bare:
        found = replace(found, notes=(DECIMAL_COMMAS, *found.notes))
    if "pre-scaled base" not in text or "irradiance" not in text:
        return found
    why = "its comments, irradiance and pre-scaled base, are those of Filament's cmgen, without --no-mirror: taken as filament"
    return replace(found, implied="filament", implied_by=why)


def _rows_of(scan: Scan, wrapped: bool) -> Listed:
    """The numbers in rows: by their names, else by brackets, else by lines; without a first one that counts these."""
    owners, sizes = _runs(scan.owners)
    if len(owners) > 1:
        return _by_name(scan, owners, sizes)
    values, (brackets, sizes) = scan.values, _runs(scan.brackets)
    counted = len(sizes) > 2 and sizes[0] == 1 and bool(values[0] == len(sizes) - 1)
    brackets, sizes = brackets[counted:], sizes[counted:]
    if len(brackets) > 1 and 0 not in brackets and len(set(brackets)) == len(brackets):
        found = arranged(_even(values[counted:], sizes, "brackets"))
    else:
        _, sizes = _runs(scan.lines)
        alone = len(sizes) > 2 and sizes[0] == 1 < sizes[1]  # the first, in its line
        after = sizes[1:] if alone else [1] * (values.size - 1)
        counted = (alone or values.size > 4) and _counts(values[0], after)
        if counted and not alone and holds_light(values.size):
            raise LightError(
                f"{values.size} numbers, of which the first, {values[0]:g}, may be how many rows follow; remove it if it is,"
                " or save the list as JSON"
            )
        rows = values[counted:]
        if counted:
            sizes = after if alone else [rows.size]
        found = arranged(rows.reshape(len(sizes), -1) if len(set(sizes)) == 1 else rows, wrapped=wrapped)
    if not counted:
        return found
    return replace(found, notes=(f"its first number, {values[0]:g}, says how many rows follow", *found.notes))


def _runs(labels: list[int]) -> tuple[list[int], list[int]]:
    """The labels, each once where it stands several times in a row, and how often it does."""
    runs = [(label, len(list(same))) for label, same in groupby(labels)]
    return [label for label, _ in runs], [size for _, size in runs]


def _counts(first: float, sizes: list[int]) -> bool:
    """Whether a number is how many rows or numbers come after it, which have these sizes."""
    total = sum(sizes)
    return holds_light(total) and first in {len(sizes), total, total / 3}


def _even(values: Numbers, sizes: list[int], what: str) -> Numbers:
    """The values as rows of one size; flat, if the sizes are those of bands, 1, 3, 5 ... . LightError for any others."""
    if len(set(sizes)) == 1:
        return values.reshape(len(sizes), -1)
    if any(sizes == [channels * (2 * l + 1) for l in range(len(sizes))] for channels in (1, 3)):
        return values
    odd = next(size for size in sizes if size != sizes[0])
    raise LightError(f"{what} with {sizes[0]} numbers and with {odd}; rows are equally long: complete or remove some")


def _by_name(scan: Scan, owners: list[int], sizes: list[int]) -> Listed:
    """Rows or lists of which each has a name: of a channel, of an l and m, or with an index. LightError for other names."""
    names = [scan.names[owner] if owner >= 0 else "" for owner in owners]
    values, single = scan.values, set(sizes) == {1}
    if single and names == _UNITY:
        return Listed(values.reshape(3, 9).T, implied="unity", implied_by="sh[ 0] to sh[26] of Unity: taken as unity")
    if single and (order := channel_order([name.split(".")[-1] for name in names])):
        rows = values.reshape(-1, len(order))[:, order]
        of_rows = [scan.names[i] for i in sorted(set(range(len(scan.names))) - set(owners))]
        place = places_of(of_rows) if len(of_rows) == len(rows) else None
        found = arranged(rows if place is None else rows[np.argsort(place)])
        return replace(found, placed=place is not None and are_places(of_rows))
    if len(names) == 3 and len(set(sizes)) == 1 and (order := channel_order([channel_at_end(name) for name in names])):
        return arranged(values.reshape(3, -1)[order])
    place = places_of(names)
    if place is None:
        shown = ", ".join(name.split("[")[0][:20] or "one without a name" for name in names[:4])
        raise LightError(
            f"{len(names)} lists of numbers, with the names {shown}; keep the one that holds the coefficients"
        )
    rows = _even(values, sizes, "names")
    found = arranged(rows[np.argsort(place)]) if rows.ndim == 2 else Listed(rows)
    return replace(found, placed=are_places(names))
