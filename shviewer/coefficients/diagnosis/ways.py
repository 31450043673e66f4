"""Ways to take the rows of a list, before anything is turned: its sequence, its order, its functions."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from shviewer.coefficients.convention import from_complex
from shviewer.coefficients.numbers import Listed, Numbers, as_table, in_sequence
from shviewer.coefficients.parts.channels import BY_CHANNEL, FLAT_BY_CHANNEL, INTERLEAVED
from shviewer.coefficients.parts.rows import ACN, ORDERS, row_order
from shviewer.coefficients.parts.scales import FUMA_BANDS, POLYNOMIAL_BANDS, SCALES
from shviewer.coefficients.texts import SHIFT
from shviewer.errors import LightError, refused_as
from shviewer.harmonics.basis import Array, count_bands

FUMA_ORDERS = (ACN, "order-fuma", "order-fuma-inverse")

BY_DEGREE = ("orthonormal", "4pi", "schmidt", "sn3d")
"""Normalisations whose factors are those of the degree; the others are undone here, before orders are mixed."""


@dataclass(frozen=True)
class Taken:
    """How the rows are taken."""

    sequence: str = ""
    order: str = ACN
    scales: tuple[str, ...] = BY_DEGREE
    """The normalisations that the table may still have."""
    shift: float = 0.0
    complex: bool = False


class Way(NamedTuple):
    """One way to take the rows, and the table that is left to be turned, in our order of rows, (n**2, 3)."""

    table: Array
    taken: Taken


def ways(listed: Listed, usual: str = "") -> Iterator[Way]:
    """Every way to take the rows of a list. usual: the sequence in which it was read. LightError if it is no table at all."""
    if np.iscomplexobj(listed.numbers) or (listed.numbers.ndim == 2 and listed.numbers.shape[1] in (2, 6)):
        yield from _complex(listed)
        return
    for sequence, numbers in _sequences(listed, usual):
        table = np.asarray(as_table(numbers), dtype=np.float64)
        n_bands = count_bands(table)
        for order in ORDERS if n_bands > 1 and not listed.placed else (ACN,):
            with suppress(ValueError):  # more bands than the order has
                rows = np.empty_like(table)
                rows[row_order(order, n_bands)] = table
                yield Way(rows, Taken(sequence, order))
                if n_bands <= POLYNOMIAL_BANDS and n_bands > 1:
                    undone = rows / SCALES["polynomial"][0](n_bands)[:, None]
                    yield Way(undone, Taken(sequence, order, ("polynomial",)))
                if n_bands <= FUMA_BANDS and order in FUMA_ORDERS:
                    yield Way(rows / SCALES["fuma"][0](n_bands)[:, None], Taken(sequence, order, ("fuma",)))
        shifted = table.copy()
        shifted[0] += SHIFT * np.sqrt(4 * np.pi)
        yield Way(shifted, Taken(sequence, scales=("orthonormal",), shift=SHIFT))


def sequence_of(sequence: str, flat: bool) -> str:
    """What a sequence means for a list with or without rows: "" if it leaves it as it stands, or one of SEQUENCES."""
    if sequence == FLAT_BY_CHANNEL:
        return BY_CHANNEL if flat else ""
    return sequence


def _sequences(listed: Listed, usual: str) -> Iterator[tuple[str, Numbers]]:
    """The numbers as they were read, and then as they were not."""
    usual = sequence_of(usual, listed.numbers.ndim == 1)
    yield usual, in_sequence(listed, usual) if usual else listed.numbers
    other = INTERLEAVED if (usual or (BY_CHANNEL if listed.planar else INTERLEAVED)) == BY_CHANNEL else BY_CHANNEL
    with suppress(LightError):
        numbers = in_sequence(listed, other)
        if len(numbers) > 1:
            yield other, numbers


def _complex(listed: Listed) -> Iterator[Way]:
    table = as_table(listed.numbers, complex_pairs=True)
    with refused_as(LightError):
        yield Way(from_complex(table), Taken(scales=("orthonormal",), complex=True))
