"""Coefficients that are given: shown as what their file holds, or beside the light that they are said to be of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from shviewer.harmonics.basis import Array
from shviewer.harmonics.conventions.programs import CONVENTIONS
from shviewer.harmonics.conventions.suspects import usual_suspects
from shviewer.harmonics.filters import irradiance_factors, per_coefficient
from shviewer.lights.coefficients.light import CoefficientLight
from shviewer.lights.irradiance import IrradianceLight
from shviewer.lights.light import Light
from shviewer.viewer.layout import MAX_SHOWN_BANDS
from shviewer.viewer.memory import remember
from shviewer.viewer.projections import BEST, project
from shviewer.viewer.state import ViewState
from shviewer.viewer.subjects import subject

BAD = 0.02
"""Given coefficients that are farther off than this, relative to the light's own in the same bands, are looked into."""

LONGEST_NAME = 28
"""Characters in a caption."""

EXACT = 1e-6
"""What is no farther off is the same, up to six printed digits."""

EXPLAINED = 0.25
"""A suspect is named if its error is at most this, and at most this part of the one without it."""


def as_the_file_holds(state: ViewState, *, quantity: bool, bands: bool) -> ViewState:
    """The state, showing the quantity and the bands of the coefficient file it compares with, or whose light it shows.

    quantity, bands: whether to follow the file; more bands than a compared file has are never shown. LightError if the light
    is bad.
    """
    file = state.compare or subject(replace(state, quantity="radiance", split_sun=False)).whole
    if not isinstance(file, CoefficientLight):
        return state
    if bands:
        state = replace(state, n_bands=min(file.n_bands, MAX_SHOWN_BANDS))
    elif state.compare and state.n_bands > file.n_bands:
        state = replace(state, n_bands=file.n_bands, message=file.extent)
    return replace(state, quantity=file.quantity) if quantity else state


def caption(state: ViewState) -> str:
    """Whose coefficients are shown, to stand before their number; "" for the light's own."""
    if state.compare is None:
        return ""
    name = state.compare.name
    return f"{name if len(name) <= LONGEST_NAME else f'{name[:11]}...{name[-14:]}'}: "


@remember(most=4)
def suspicion(light: Light, given: CoefficientLight) -> str:
    """One line on given coefficients that are not the light's: by which usual mistake they fit; "" if they do as they are."""
    exact = project(light, *BEST, given.n_bands).coefficients / light.unit
    shown = project(light, given, 0, 0, given.n_bands).coefficients / light.unit
    norm, off = float(np.linalg.norm(exact)), float(np.linalg.norm(exact - shown))
    if off <= BAD * norm:
        return ""
    says = f"{given.name} is {_percent(off / norm) if norm else 'wholly'} off"
    best = usual_suspects(exact, shown, _readings(light, given))[0]
    if not best.changes or best.error > EXPLAINED * min(1.0, off / norm if norm else 0.0):
        return f"{says}, which no usual mistake explains"
    return f"{says}, but {_percent(best.error)} if its numbers are {best.words}"


def _readings(light: Light, given: CoefficientLight) -> dict[str, Array]:
    """The file's own numbers as each program's convention would have them, of the quantity shown."""
    found: dict[str, Array] = {}
    if given.file is None:
        return found
    for name, convention in CONVENTIONS.items():
        bands = convention.most_bands or given.n_bands
        same = name == given.file.convention.name or np.iscomplexobj(given.file.numbers) != convention.complex
        if same or given.n_bands > bands:
            continue
        radiance = CoefficientLight.of_numbers(given.file.numbers, convention).given
        cosine = irradiance_factors(given.n_bands) if isinstance(light, IrradianceLight) else np.ones(given.n_bands)
        found[name] = radiance * per_coefficient(cosine) / light.unit
    return found


def _percent(share: float) -> str:
    if share < EXACT:
        return "not at all"
    return f"{100 * share:.2g} %" if share < 0.1 else f"{100 * share:.0f} %"
