"""What `shviewer project` writes: the coefficients of a state, in our convention, and everything that is known of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from shviewer import __version__
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.conventions.convention import Convention
from shviewer.lights.coefficients.stamp import Value, stamp_of
from shviewer.viewer.analysis import Figures, Subject, project, reconstruct, sampling_of, subject
from shviewer.viewer.layout import MAX_DIRECT_BANDS, MAX_SHOWN_BANDS
from shviewer.viewer.picture import check
from shviewer.viewer.state import ViewState, light_name


@dataclass(frozen=True, eq=False)
class Projected:
    """Coefficients of a light in our convention, (n**2, 3) float64: muted bands are zero and the window is applied.

    `quantity` is "radiance" or "irradiance"; `figures` compare them with the light. `about` says where they come from.
    """

    coefficients: Array
    quantity: str
    figures: Figures
    about: dict[str, Value]
    name: str

    @property
    def n_bands(self) -> int:
        return count_bands(self.coefficients)

    def stamp(self, convention: Convention, n_bands: int) -> dict[str, Value]:
        """What a file with these coefficients in that convention says of itself."""
        return {**stamp_of(convention, self.quantity, n_bands), "written-by": f"shviewer {__version__}", **self.about}


def project_state(state: ViewState) -> Projected:
    """The coefficients that the window shows in that state. LightError or UsageError, as in `picture.prepare`."""
    check(state)
    shown = subject(state)
    bands = MAX_DIRECT_BANDS if state.n_bands <= MAX_DIRECT_BANDS else MAX_SHOWN_BANDS
    projection = project(shown.light, *sampling_of(state), bands)
    coefficients, figures = reconstruct(
        shown.light, projection, state.n_bands, state.muted_shown, state.window, state.window_width
    )
    about: dict[str, Value] = {
        **_light(state, shown),
        "window": _window(state),
        "muted": " ".join(map(str, state.muted_shown)) or "none",
        "method": projection.method,
        "samples": projection.evaluations,
        "seed": state.seed if state.method == "jittered" else None,
        **_errors(figures),
    }
    about = {key: value for key, value in about.items() if value is not None and value != ""}
    return Projected(coefficients, state.quantity, figures, about, shown.light.name)


def _light(state: ViewState, shown: Subject) -> dict[str, Value]:
    light, suns = shown.light, shown.suns
    without = f"; {len(suns)} sun{'s' if len(suns) > 1 else ''} left out" if suns else ""
    return {
        "light": _one_line(light_name(state.light)),
        "light-is": _one_line(light.description + without),
        "light-notes": _one_line("; ".join(light.notes)),
    }


def _window(state: ViewState) -> str:
    if state.window in ("none", "dering"):
        return state.window
    return f"{state.window} of {state.window_width or state.n_bands:g} bands"


def _errors(figures: Figures) -> dict[str, Value]:
    whole, extremes = figures.channels["all"], figures.extremes
    errors = {
        "relative-l2": whole.relative_l2,
        "left-out": whole.left_out,
        "added": whole.added,
        "max-error": extremes.max_error,
        "minimum": extremes.minimum,
        "negative-area": extremes.negative_area,
        "irradiance-relative-l2": figures.irradiance_relative_l2,
    }
    return {key: float(value) for key, value in errors.items() if np.isfinite(value)}


def _one_line(text: str) -> str:
    """Fit for a comment: no line break could end it, and no `*/`."""
    printable = "".join(character if character.isprintable() else " " for character in text)
    return " ".join(printable.replace("*/", "* /").split())
