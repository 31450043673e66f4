"""The interface of every light, and the answers that most lights share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple, Protocol, cast

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.extremes.error_grid import Form
from shviewer.harmonics.quadrature import evaluate_rows
from shviewer.harmonics.quantities.names import IRRADIANCE
from shviewer.lights.lat_long import LatLongMap
from shviewer.notebook import InNotebooks

if TYPE_CHECKING:  # types that only some lights use are imported with those lights
    from shviewer.coefficients.reading import CoefficientFile
    from shviewer.lights.analytic.lobe import Lobe
    from shviewer.lights.suns.sun import Sun


class Light(Protocol):
    """A function on the sphere with values in linear RGB; it may be negative."""

    @property
    def name(self) -> str:
        """The name that the user knows: a built-in name, a file's stem or a function's name."""

    @property
    def description(self) -> str:
        """A few words under the name."""

    @property
    def notes(self) -> tuple[str, ...]:
        """Warnings worth a line each, such as negative texels."""

    @property
    def about(self) -> About:
        """The facts about the image or the coefficients that it is made of."""

    @property
    def best_method(self) -> str:
        """The method of `coefficients` in words: "closed form", "exact texel integrals", ..."""

    @property
    def lobes(self) -> tuple[Lobe, ...]:
        """The lobes whose sum it is, for the shader to evaluate; empty for any other light."""

    @property
    def map(self) -> LatLongMap | None:
        """The raster that the GPU samples; None for a sum of lobes."""

    def radiance(self, directions: Array) -> Array:
        """Unit directions (k, 3) -> radiance (k, 3), float64."""

    def rows(self, theta: Array, n_columns: int) -> Array:
        """The radiance on rows of a lat-long grid at angles theta (rows,) from +z: (rows, 3, n_columns)."""

    def integrand(self, directions: Array) -> Array:
        """The function that `coefficients` integrates in directions (k, 3): (k, 3).

        The radiance, or for an image its texels as areas, not interpolated.
        """

    def texels(self) -> Iterator[tuple[NDArray[np.floating], Array]]:
        """The texels of an image in blocks: radiance (k, 3) and steradians (k,); nothing for other lights."""

    def coefficients(self, n_bands: int) -> Array:
        """Coefficients (n_bands**2, 3) by the best way this light knows."""

    @property
    def most_bands(self) -> int:
        """The most bands that it has: `coefficients` can give no more, or nothing but zeros."""

    @property
    def kept_bands(self) -> int:
        """How many bands `coefficients` has at hand, so that asking for no more takes no time worth measuring."""

    def anew(self) -> Light | None:
        """The same light with nothing at hand of its coefficients, so that they take their time; None if it keeps none."""

    def products(self) -> Array:
        """Integrals of f_i f_j over the sphere for channels i and j, (3, 3), by the same quadrature as `coefficients`."""

    def accuracy(self) -> float:
        """How far a relative L2 error of this light may be off for want of quadrature points; 0 if exact."""

    def landmarks(self) -> Array:
        """Directions (j, 3) of features that a grid might step over, such as the axis of a sun."""

    @property
    def form(self) -> Form | None:
        """The parts between which its error can be bounded; None if it is known only where it is looked at."""

    @property
    def source(self) -> Light:
        """The light that was convolved to make it; itself, if it is radiance."""

    @property
    def quantity(self) -> str:
        """The quantity that its values are: "radiance", "irradiance" or "glossy:0.4"."""

    def from_source(self, coefficients: Array) -> Array:
        """Coefficients (n**2, 3) of the source -> those of this light."""

    def through(self, quantity: str) -> Light:
        """Another quantity of its source as a light; itself, if it is that. ValueError if unknown."""

    def irradiance(self) -> Light:
        """`through("irradiance")`"""

    def irradiance_up(self) -> Array:
        """The irradiance of a surface that faces +z, (3,)."""

    def split_suns(self, wanted: int | str = "auto") -> Split:
        """The light without its suns, and the suns. LightError, one line, if it has none.

        wanted: "auto" for suns alone, or how many compact sources, lamps among them, or "all".
        """

    def __hash__(self) -> int:
        """A hash by identity, since results for a light are remembered."""


class Split(NamedTuple):
    """A light = rest + suns."""

    rest: Light
    suns: tuple[Sun, ...]
    """The suns, the greatest flux first."""


@dataclass(frozen=True)
class About:
    """Facts about an image or coefficients; None for those that a light does not have."""

    encoding: str | None = None
    """The format of an image's file, in words."""
    size: tuple[int, int] | None = None
    """Width and height of an image as it is stored, texels."""
    layout: str | None = None
    """The name of an image's layout."""
    n_bands: int | None = None
    """How many bands coefficients have."""
    quantity: str | None = None
    """The quantity of the coefficients as they were given: "radiance" or "irradiance"."""
    convention: str | None = None
    """The convention in which they were given, a text without the quantity."""
    file: CoefficientFile | None = None
    """The file they were read from."""


class LightBase(InNotebooks, ABC):
    """The answers of a light that has no better ones."""

    KEEPS: ClassVar[tuple[str, ...]] = ()
    """The attributes in which `coefficients` keeps what it has found."""

    def __repr__(self: Light) -> str:
        return f"<{self.name}: {self.description}>"

    @property
    def about(self) -> About:
        return About()

    @abstractmethod
    def radiance(self, directions: Array) -> Array: ...

    def irradiance(self: Light) -> Light:
        return self.through(IRRADIANCE)

    def rows(self, theta: Array, n_columns: int) -> Array:
        return evaluate_rows(self.radiance, theta, n_columns)

    def integrand(self, directions: Array) -> Array:
        return self.radiance(directions)

    @property
    def kept_bands(self) -> int:
        return 0

    def anew(self) -> Light | None:
        if not self.KEEPS:
            return None
        found = cast("Light", copy(self))
        for name in self.KEEPS:
            vars(found).pop(name, None)
        return found

    def texels(self) -> Iterator[tuple[NDArray[np.floating], Array]]:
        return iter(())

    def accuracy(self) -> float:
        return 0.0

    def landmarks(self) -> Array:
        return np.zeros((0, 3))

    @property
    def form(self) -> Form | None:
        return None

    def split_suns(self: Light, wanted: int | str = "auto") -> Split:
        raise LightError(f"{self.name}: only images and sums of lobes can be split; show it with its sun")
