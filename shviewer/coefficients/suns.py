"""Suns that were split off, as a program needs them beside coefficients of the rest: directional lights in its own axes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from shviewer.coefficients.axes import Axes
from shviewer.coefficients.stamp import SUNS_KEY, Value
from shviewer.harmonics.basis import Array


class DirectionalLight(NamedTuple):
    """A sun as a program takes it, in our axes: a unit vector towards it, then linear RGB."""

    direction: Array
    irradiance: Array
    """What a surface that faces the sun receives, (3,)."""
    radiance: Array
    """What a disc of uniform radiance has that gives this irradiance, (3,)."""
    width_degrees: float
    """The angle across this disc."""


def sun_keys(suns: Sequence[DirectionalLight], axes: Axes) -> dict[str, Value]:
    """What the stamp says of them, the greatest flux first; nothing if there are none."""
    found: dict[str, Value] = {SUNS_KEY: len(suns)} if suns else {}
    for number, sun in enumerate(suns, 1):
        found |= {
            f"sun-{number}-direction": _exactly(axes.matrix @ sun.direction),
            f"sun-{number}-irradiance": _exactly(sun.irradiance),
            f"sun-{number}-radiance": _exactly(sun.radiance),
            f"sun-{number}-width": sun.width_degrees,
        }
    return found


def sun_left_out(sun: DirectionalLight, axes: Axes) -> str:
    """One line: a directional light in its place."""
    direction, irradiance = _briefly(axes.matrix @ sun.direction), _briefly(sun.irradiance)
    return f"sun left out: a directional light from ({direction}), irradiance {irradiance}"


def _exactly(numbers: Iterable[float]) -> str:
    return " ".join(repr(float(number) + 0.0) for number in numbers)  # no negative zeros


def _briefly(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.4g}" for number in np.round(list(numbers), 12) + 0.0)
