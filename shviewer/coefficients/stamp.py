"""The stamp of a coefficient file: keys and values, the same in JSON, in NPZ and in the comments of CSV, C and GLSL.

Schema 1. A reader needs the first three keys; the others are for people, and must not contradict them.

    shviewer-coefficients   1
    convention              a text for parse_convention, such as "three" or "shviewer,y-up,no-phase"
    quantity                radiance or irradiance, perhaps -over-pi, or glossy:R of a roughness R, such as glossy:0.4
    basis, phase, index, axes, normalisation, one-over-pi     what `convention` and `quantity` mean, in set words
    program, layout         the program that reads it, and how the program itself arranges the numbers
    use                     what to type so that the program takes them (use.py), with the rows as the file has them
    unity-vectors           the seven vectors of Unity's shaders, in a file for Unity
    bands, rows, columns    n, n^2, and the names of the columns
    encoding                one of ENCODINGS of harmonics/quantities: the rows are what engines store of an irradiance,
    numbers                 what each row is called, as in
    formula                 which gives the irradiance in a direction
    through                 the encoding that the rows have been through, which are bands, as its formula takes no window
    light, light-is, light-notes, window, muted, method, samples, seed
    turned                  the rotation of the light before it was written, if it was turned: a matrix row by row, in our axes
    suns                    how many were left out of the light, if any were; of each, sun-1 having the greatest flux,
    sun-1-direction         x y z in the file's axes, the unit vector towards it,
    sun-1-irradiance        red green blue, of a surface that faces it, not divided by pi: that of a directional light,
    sun-1-radiance          red green blue, of a disc of uniform radiance with that irradiance,
    sun-1-width             the angle across this disc in degrees
    relative-l2, left-out, added, max-error, minimum, negative-area, irradiance-relative-l2
    minimum-bound                       that no direction is below; max-error and max-error-bound are in older files only

Errors compare the coefficients in the rows with the light; relative errors are over all channels. max-error and minimum are in
units of the radiance, or of the irradiance before it is divided by pi. An unknown key is ignored; a later schema is refused.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.quantities import QUANTITIES, is_over_pi
from shviewer.coefficients.texts import convention_text, parse_convention
from shviewer.errors import LightError, refused_as
from shviewer.harmonics.quantities.names import GLOSSY, quantity_of
from shviewer.words import one_line

SCHEMA = 1
SCHEMA_KEY = "shviewer-coefficients"
SUNS_KEY = "suns"
ENCODING_KEY = "encoding"

TABLE_BEGINS, TABLE_ENDS = "coefficients begin", "coefficients end"
"""The words of two comments in source code; between them stand the numbers, and nothing else."""

Value = str | int | float | None
Stamp = Mapping[str, Value]


def stamp_of(convention: Convention, quantity: str, n_bands: int) -> dict[str, Value]:
    """The keys that follow from the convention, the quantity held and the number of bands."""
    columns = "red green blue"
    if convention.complex:
        columns = " ".join(f"{name} {name}-imaginary" for name in columns.split())
    return {
        SCHEMA_KEY: SCHEMA,
        "convention": convention_text(convention),
        "quantity": convention.quantity or quantity,
        **_in_words(convention, convention.quantity or quantity),
        "program": convention.program,
        "layout": convention.layout,
        "bands": n_bands,
        "rows": n_bands**2,
        "columns": columns,
    }


def _in_words(convention: Convention, quantity: str) -> dict[str, Value]:
    return {
        "basis": convention.basis,
        "phase": convention.phase_words,
        "index": convention.index,
        "axes": convention.axes.words,
        "normalisation": convention.scale,
        "one-over-pi": "divided by pi" if is_over_pi(quantity) else "not divided by pi",
    }


def safe(said: Mapping[str, object]) -> Stamp:
    """The stamp of a file, safe to print: texts on one line without control characters, and numbers; nothing else."""
    return {
        one_line(key): one_line(value) if isinstance(value, str) else value
        for key, value in said.items()
        if isinstance(value, str | int | float | None)
    }


def _is_glossy(quantity: object) -> bool:
    try:
        return isinstance(quantity, str) and quantity.startswith(GLOSSY) and quantity_of(quantity) == quantity
    except ValueError:
        return False


def read_stamp(stamp: Stamp) -> Convention:
    """The convention that a stamp states, with its quantity.

    LightError for a later schema, a missing key or a contradiction.
    """
    schema = stamp.get(SCHEMA_KEY)
    if str(schema) != str(SCHEMA):
        raise LightError(
            f"{SCHEMA_KEY} {schema}: this version reads schema {SCHEMA}; update shviewer, or write the file again with this one"
        )
    text, quantity = stamp.get("convention"), stamp.get("quantity")
    if not isinstance(text, str) or not (quantity in QUANTITIES or _is_glossy(quantity)):
        raise LightError(
            f"convention {text!r}, quantity {quantity!r}: a stamp needs both, the latter one of {', '.join(QUANTITIES)} or "
            "glossy:R, such as glossy:0.4"
        )
    with refused_as(LightError):
        convention = parse_convention(text)
    if convention.quantity not in (None, quantity):
        raise LightError(
            f"convention {text} holds {convention.quantity}, but quantity says {quantity}: correct one of them"
        )
    for key, words in _in_words(convention, str(quantity)).items():
        if key in stamp and stamp[key] != words:
            raise LightError(f"{key} says {stamp[key]!r}, but convention {text} means {words!r}: correct one of them")
    return replace(convention, quantity=str(quantity))
