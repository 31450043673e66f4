"""What the shader evaluates: a light, and one of the ways to draw its reconstruction, which `prepare` chooses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array
from shviewer.harmonics.quantities.encodings import Stored
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light
from shviewer.viewer.surface import Surface


class Source(NamedTuple):
    """The form in which the shader evaluates a light: its lobes, or a map."""

    lobes: tuple[Lobe, ...]
    map: LatLongMap | None


def source_of(light: Light) -> Source:
    """The form of a light for the shader. How its texels are held is found out here, so that OpenGL's thread need not."""
    if light.map is not None:
        _ = light.map.halves
    return Source(light.lobes, light.map)


@dataclass(frozen=True, eq=False)
class DirectSum:
    """Each pixel sums the bands: coefficients (n**2, 3), of at most MAX_DIRECT_BANDS bands."""

    coefficients: Array


@dataclass(frozen=True, eq=False)
class Encoded:
    """Each pixel evaluates the formula of an encoding, from the numbers that it keeps."""

    stored: Stored


@dataclass(frozen=True, eq=False)
class SplineMap:
    """Each pixel looks the reconstruction up: spline coefficients (rows, columns, 4), rows on the poles."""

    splines: NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Surfaces in place of the spheres: the light, its reconstruction or one basis function, and perhaps the error."""

    shown: tuple[Surface, ...]


Drawn: TypeAlias = DirectSum | Encoded | SplineMap | Surfaces
