"""The lines of `shviewer info` that only a coefficient file has: its convention and its origin."""

from __future__ import annotations

from dataclasses import dataclass

from shviewer.coefficients.stamp import stamp_of
from shviewer.lights.light import About


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
