"""Coefficients that are given: shown as what their file holds, or compared with a light."""

from __future__ import annotations

from dataclasses import replace

from shviewer.lights.coefficients.light import CoefficientLight
from shviewer.viewer.analysis import subject
from shviewer.viewer.state import ViewState, with_bands


def as_the_file_holds(state: ViewState, *, quantity: bool, bands: bool) -> ViewState:
    """The state, showing the quantity and the number of bands of its light if that is a coefficient file.

    quantity, bands: whether to follow the file. LightError if it is bad.
    """
    light = subject(replace(state, quantity="radiance", split_sun=False)).whole
    if not isinstance(light, CoefficientLight):
        return state
    if bands:
        state = with_bands(state, light.n_bands)
    return replace(state, quantity=light.quantity) if quantity else state
