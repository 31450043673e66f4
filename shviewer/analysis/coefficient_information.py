"""The lines of `shviewer info` that only a coefficient file has: its convention and its origin."""

from __future__ import annotations

from dataclasses import dataclass

from shviewer.coefficients.stamp import SCHEMA_KEY, Stamp, stamp_of
from shviewer.lights.light import About
from shviewer.words import counted

FIGURES = {"relative-l2": "relative L2 error", "max-error": "largest error", "minimum": "minimum"}


@dataclass(frozen=True)
class CoefficientInformation:
    """The convention and the origin of the numbers in a file."""

    bands: int
    quantity: str
    """The quantity in the file: radiance, irradiance or irradiance-over-pi."""
    convention: str
    program: str
    basis: str
    phase: str
    index: str
    axes: str
    normalisation: str
    stamped: bool
    """Whether the file itself names its convention; if not, the user named it."""
    stamp: dict[str, str | int | float | None]
    """Everything the file says; empty for a bare list."""


def describe_coefficients(about: About) -> CoefficientInformation | None:
    """The information on a coefficient file; None for a light that is none."""
    if (file := about.file) is None:
        return None
    words = {key: str(value) for key, value in stamp_of(file.convention, file.quantity, file.n_bands).items()}
    return CoefficientInformation(
        bands=file.n_bands,
        quantity=words["quantity"],
        convention=about.convention or "",
        program=words["program"],
        basis=words["basis"],
        phase=words["phase"],
        index=words["index"],
        axes=words["axes"],
        normalisation=words["normalisation"],
        stamped=bool(file.stamp),
        stamp=dict(file.stamp),
    )


def coefficient_rows(found: CoefficientInformation) -> list[tuple[str, str]]:
    """The lines to print: label and text."""
    said = "as the file says" if found.stamped else "as named on the command line; the file does not say"
    rows = [
        (
            "coefficients",
            f"{counted(found.bands, 'band')}, {counted(found.bands**2, 'row')}, {found.quantity.replace('-', ' ')}",
        ),
        ("convention", f"{found.convention} ({found.program}), {said}"),
        ("basis", f"{found.basis}; {found.phase}; index {found.index}"),
        ("axes", found.axes),
    ]
    return rows + _origin(found.stamp)


def _origin(stamp: Stamp) -> list[tuple[str, str]]:
    if SCHEMA_KEY not in stamp:
        return []
    parts = [f"{stamp.get('light', 'an unnamed light')} ({stamp.get('light-is', 'not described')})"]
    parts += [str(stamp[key]) for key in ("method",) if key in stamp]
    parts += [
        f"{key} {stamp[key]}" for key in ("samples", "seed", "window", "muted") if stamp.get(key) not in (None, "none")
    ]
    parts.append(f"written by {stamp.get('written-by', 'an unknown program')}")
    figures = [f"{words} {float(str(stamp[key])):.4g}" for key, words in FIGURES.items() if _is_number(stamp.get(key))]
    return [("origin", ", ".join(parts)), *([("figures there", ", ".join(figures))] if figures else [])]


def _is_number(value: object) -> bool:
    try:
        float(str(value))
    except ValueError:
        return False
    return True
