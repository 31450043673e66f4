"""A light that is a coefficient file: band-limited, so that everything about it is a finite sum.

A light is radiance. A file that holds irradiance becomes the radiance with just that irradiance, so that the viewer shows the
file's own numbers as irradiance, and they can be written as either. One of what engines store of irradiance becomes the
radiance of as many bands as that tells, at most three, and its irradiance what the formula decodes (decoded.py).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from shviewer.coefficients.parts.quantities import recovered_radiance
from shviewer.coefficients.programs import CONVENTIONS, OURS
from shviewer.coefficients.reading import CoefficientFile, read_coefficients
from shviewer.coefficients.stamp import SUNS_KEY
from shviewer.coefficients.texts import convention_text
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.quantities.encodings import Stored
from shviewer.harmonics.quantities.kernels import kernel_of
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE
from shviewer.harmonics.synthesis import Synthesis
from shviewer.lights.convolved import UP, ConvolvedSum, FiniteSum, RadianceLight, convolved
from shviewer.lights.decoded import DecodedIrradiance
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import About, Light
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.limits import MAX_BANDS, check_brightness
from shviewer.words import counted, one_line

MAP_SIZE = (1025, 2048)


@dataclass(frozen=True, eq=False, repr=False)
class CoefficientLight(FiniteSum, RadianceLight):
    """The light of given coefficients; `given`: radiance in our convention, (n**2, 3), float64."""

    given: Array
    name: str = "coefficients"
    file: CoefficientFile | None = None
    """The file as it was read, with its own numbers."""

    best_method = "coefficients as given"
    lobes = ()

    def __post_init__(self) -> None:
        """LightError for more radiance than can be shown: the largest is at least the root of the mean square."""
        largest = float(np.abs(self.given).max())
        shares = self.given / (largest or 1.0)  # whose squares stay within float64
        check_brightness(largest * float(np.sqrt((shares**2).sum(axis=0).max() / (4 * np.pi))), self.name)

    @classmethod
    def read(cls, path: Path, reading: Reading = DEFAULT_READING) -> CoefficientLight:
        """Read a coefficient file. LightError if it is bad or does not name its convention."""
        light = cls.of_file(read_coefficients(path, reading.convention, reading.limits), str(path))
        return replace(light, name=one_line(path.stem))  # errors name the file, all else the light

    @classmethod
    def of_file(cls, file: CoefficientFile, name: str) -> CoefficientLight:
        """The light of a file that has been read, which holds the coefficients of the light or of its irradiance."""
        if file.stored is None:
            return cls(_radiance(file.coefficients, file.quantity), name, file)
        told = file.stored.radiance
        return cls(np.pad(told, ((0, len(file.coefficients) - len(told)), (0, 0))), name, file)

    @property
    def n_bands(self) -> int:
        return count_bands(self.given)

    @property
    def extent(self) -> str:
        """The message where more bands are asked for: "sh.txt has 3 bands"."""
        return f"{self.name} has {counted(self.n_bands, 'band')}"

    @property
    def quantity(self) -> str:
        """The quantity of the file's numbers: "radiance" or "irradiance"."""
        return self.file.quantity if self.file else RADIANCE

    @property
    def convention(self) -> str:
        """The convention of the file, a text without the quantity."""
        if self.file is None:
            return OURS.name
        held = self.file.convention
        return convention_text(replace(held, quantity=CONVENTIONS[held.name].quantity))

    @property
    def about(self) -> About:
        return About(n_bands=self.n_bands, quantity=self.quantity, convention=self.convention, file=self.file)

    @property
    def description(self) -> str:
        origin = self.file.stamp.get("light") if self.file else None
        if self.stored is not None:
            return f"{self.stored.encoding.words}{f' (of {origin})' if origin else ''}"
        return f"{counted(self.n_bands, 'band')}, {self.convention.split(',')[0]}{f', of {origin}' if origin else ''}"

    @property
    def stored(self) -> Stored | None:
        """What an engine stores of its irradiance, where its file holds that."""
        return self.file.stored if self.file else None

    @property
    def read_as(self) -> str:
        """How its numbers were read, in words."""
        return f"decoded as {self.stored.encoding.words}" if self.stored else f"read as {self.convention}"

    @property
    def notes(self) -> tuple[str, ...]:
        if self.file is None:
            return ()
        suns, notes = str(self.file.stamp.get(SUNS_KEY, 0)), self.file.notes
        if suns != "0":
            notes = (*notes, f"{suns} sun{'s' if suns != '1' else ''} left out; the file says where and how bright")
        if self.quantity == RADIANCE:
            return notes
        if self.stored is not None:
            told = f"its first {count_bands(self.stored.radiance)} bands"
            return (*notes, f"holds irradiance, as {self.stored.name}; the radiance is recovered from {told}")
        lost = recovered_radiance(self.file.coefficients, self.quantity)[1]
        bands = f"band{'s' if len(lost) > 1 else ''} {', '.join(map(str, lost))}"
        unknown = f", which tells nothing of {bands}" if lost else ""
        return (*notes, f"holds {self.quantity}; the radiance is recovered from it{unknown}")

    @cached_property
    def synthesis(self) -> Synthesis:
        return Synthesis(self.given)

    def coefficients(self, n_bands: int) -> Array:
        found = np.zeros((n_bands**2, 3))
        kept = min(n_bands, self.n_bands) ** 2
        found[:kept] = self.given[:kept]
        return found

    @property
    def kept_bands(self) -> int:
        return MAX_BANDS

    def products(self) -> Array:
        return np.asarray(self.given.T @ self.given)

    def through(self, quantity: str) -> Light:
        if self.stored is not None and quantity == IRRADIANCE:
            return DecodedIrradiance(self, kernel_of(quantity), self.stored)
        return convolved(self, quantity, ConvolvedSum)

    def irradiance_up(self) -> Array:
        return super().irradiance_up() if self.stored is None else np.asarray(self.stored.irradiance(UP[None])[0])

    @property
    def most_bands(self) -> int:
        return self.n_bands

    @cached_property
    def map(self) -> LatLongMap:
        return LatLongMap(self.synthesis.pole_to_pole(*MAP_SIZE), rows_on_poles=True)


def _radiance(held: Array, quantity: str) -> Array:
    """The radiance of which coefficients (n**2, 3) hold that quantity."""
    return held if quantity == RADIANCE else recovered_radiance(held, quantity)[0]
