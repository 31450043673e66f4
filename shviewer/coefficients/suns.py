"""Suns that were split off, in the form that programs need beside coefficients of the rest: directional lights."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from shviewer.coefficients.parts.axes import Axes
from shviewer.coefficients.stamp import SUNS_KEY, Value
from shviewer.harmonics.basis import Array


class DirectionalLight(NamedTuple):
    """A sun as a directional light, in our axes: a unit vector towards it, and linear RGB."""

    direction: Array
    irradiance: Array
    """The irradiance of a surface that faces the sun, (3,)."""
    radiance: Array
    """The radiance of a uniform disc with this irradiance, (3,)."""
    width_degrees: float
    """The angle across this disc."""
    clipped: bool = False
    """Whether its image is clipped there, so that it had more than this."""


def sun_keys(suns: Sequence[DirectionalLight], axes: Axes) -> dict[str, Value]:
    """The stamp's keys about the suns, the greatest flux first; empty if there are none."""
    found: dict[str, Value] = {SUNS_KEY: len(suns)} if suns else {}
    for number, sun in enumerate(suns, 1):
        found |= {
            f"sun-{number}-direction": _exactly(axes.matrix @ sun.direction),
            f"sun-{number}-irradiance": _exactly(sun.irradiance),
            f"sun-{number}-radiance": _exactly(sun.radiance),
            f"sun-{number}-width": sun.width_degrees,
            **({f"sun-{number}-clipped": 1} if sun.clipped else {}),
        }
    return found


def sun_left_out(sun: DirectionalLight, axes: Axes) -> str:
    """One line about a sun that was left out and the directional light in its place."""
    direction, irradiance = _briefly(axes.matrix @ sun.direction), _briefly(sun.irradiance)
    more = "; the image is clipped there: the sun had more" if sun.clipped else ""
    return f"sun left out: a directional light from ({direction}), irradiance {irradiance}{more}"


def _exactly(numbers: Iterable[float]) -> str:
    return " ".join(repr(float(number) + 0.0) for number in numbers)  # no negative zeros


def _briefly(numbers: Iterable[float]) -> str:
    return " ".join(f"{number:.4g}" for number in np.round(list(numbers), 12) + 0.0)
