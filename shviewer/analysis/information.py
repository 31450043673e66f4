"""A light in figures, for `shviewer info`. The same functions make the window's figures."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from shviewer.analysis.figures import needs
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.reconstruction import reconstruction_of
from shviewer.analysis.roughness import TOLD_BANDS, staircase
from shviewer.analysis.subjects import subject
from shviewer.analysis.values import Values, values_of
from shviewer.coefficients.stamp import stamp_of
from shviewer.errors import LightError, ShviewerError
from shviewer.harmonics.extremes.error_grid import Triple, triple
from shviewer.harmonics.metrics import LUMINANCE
from shviewer.lights.find import file_version, split_light
from shviewer.lights.images.radiance_files import IMAGE_SUFFIXES
from shviewer.lights.light import About, Light
from shviewer.lights.reading import Reading
from shviewer.lights.suns.sun import Sun
from shviewer.limits import MAX_BANDS
from shviewer.words import theta_phi_degrees

TOLERANCES = (0.10, 0.05, 0.01)
SHOWN_BANDS = 9


@dataclass(frozen=True)
class BandsNeeded:
    """The smallest numbers of bands whose relative L2 error is within the tolerance; None if none up to `searched` is."""

    tolerance: float
    """The relative L2 error that is allowed, as a share."""
    radiance: int | None
    """The fewest bands that show the light so well; None if none up to `searched` do."""
    irradiance: int | None
    """The same of its irradiance."""
    searched: int
    """The most bands that were tried."""


@dataclass(frozen=True)
class RoughnessServed:
    """What glossy surfaces so many bands serve, within 5 %."""

    bands: int
    """How many."""
    ranges: tuple[tuple[float, float], ...]
    """Ranges of roughness, of 0.1 to 1, each from its least to its most; none if they serve no roughness."""
    words: str
    """The ranges in words."""


@dataclass(frozen=True)
class SunInformation:
    """A compact source, as a disc."""

    direction: Triple
    """Where its centre is."""
    theta_phi_degrees: tuple[float, float]
    """The same as the angle from +z and the azimuth from +x towards +y."""
    width_degrees: float
    """The angle that it is wide."""
    radiance: Triple
    """The radiance of the disc."""
    irradiance: Triple
    """The irradiance of a surface that faces it."""
    share_of_flux: float
    """Its part of the light's flux, both as the mean of the channels."""
    clipped: bool
    """Whether the image is clipped there, so that it had more."""


@dataclass(frozen=True)
class CoefficientInformation:
    """The convention and the origin of the numbers in a file."""

    bands: int
    """How many it has."""
    encoding: str
    """What engines store of an irradiance, by its name, where the numbers are that; else ""."""
    quantity: str
    """The quantity in the file: radiance, irradiance or irradiance-over-pi."""
    convention: str
    """What --convention takes."""
    program: str
    """The program whose convention it is."""
    basis: str
    """The functions, in words."""
    phase: str
    """Whether they keep the Condon-Shortley phase, in words."""
    index: str
    """The order of the rows."""
    axes: str
    """Its axes in ours, in words."""
    normalisation: str
    """The normalisation of the functions."""
    stamped: bool
    """Whether the file itself names its convention."""
    implied: bool
    """Whether the kind of file implies it; if neither, the user named it."""
    stamp: dict[str, str | int | float | None]
    """Everything the file says; empty for a bare list."""


@dataclass(frozen=True)
class Information:
    """Everything that `shviewer info` says about one LIGHT."""

    light_argument: str
    """LIGHT as it was given."""
    light: str
    """The name of the light."""
    description: str
    """What kind of light it is."""
    file: str
    """The file, or where a built-in light comes from."""
    file_bytes: int
    """Its size in bytes; 0 if it is not known."""
    encoding: str | None
    """How an image is stored."""
    size: tuple[int, int] | None
    """Width and height of an image as it is stored."""
    layout: str | None
    """The layout that the image is read in."""
    refused: str | None
    """Why the viewer refuses the image unless it is repaired; the fields below then describe the repaired image."""
    notes: tuple[str, ...]
    """What was assumed of the file, and what was done to its values."""
    values: Values
    mean: Triple
    """The mean radiance, weighted by solid angle."""
    mean_luminance: float
    """The Rec. 709 luminance of the mean."""
    peak: float
    """The radiance that is largest in magnitude in any channel, with its sign."""
    peak_direction: Triple
    """The direction of the peak, in the light's own frame like all directions here."""
    peak_theta_phi_degrees: tuple[float, float]
    """The same as the angle from +z and the azimuth from +x towards +y."""
    irradiance_up: Triple
    """The irradiance of a surface that faces +z."""
    method: str
    """How the coefficients were computed."""
    energy_share: tuple[float, ...]
    """The share of the light's energy in each band."""
    bands_needed: tuple[BandsNeeded, ...]
    roughness_served: tuple[RoughnessServed, ...]
    suns: tuple[SunInformation, ...]
    """The suns that --split-sun takes out, the greatest flux first."""
    no_sun: str
    """Why it takes out none; "" if it does."""
    bands_needed_without_suns: tuple[BandsNeeded, ...]
    """The bands that the rest needs; empty if there are no suns."""
    coefficients: CoefficientInformation | None = None
    """The convention and origin of a coefficient file; None for other lights."""


def describe(light: str | Light, reading: Reading) -> Information:
    """The information on a light, or on the one that a text names. LightError if it cannot be shown.

    An image that is refused for its values is described as `sanitize` repairs it, with the reason in `refused`.
    """
    try:
        return _describe(light, reading)
    except LightError as refusal:
        named = isinstance(light, str) and split_light(light)[0].suffix.lower() in (*IMAGE_SUFFIXES, ".npy")
        if reading.sanitize or not named:
            raise
        try:
            return replace(_describe(light, replace(reading, sanitize=True)), refused=str(refusal))
        except ShviewerError:
            raise refusal from None


def _describe(given: str | Light, reading: Reading) -> Information:
    recipe = Recipe(given, reading)
    found = reconstruction_of(recipe, ahead=MAX_BANDS)
    light = found.subject.light
    about = light.about
    values, peak = values_of(light)
    mean = found.projection.coefficients[0] / (2 * np.sqrt(np.pi))
    text = given if isinstance(given, str) else ""
    file = file_version(text) if text else None
    split = subject(replace(recipe, split_sun=True))
    total = float(mean.mean()) * 4 * np.pi
    return Information(
        light_argument=text,
        light=light.name,
        description=light.description,
        file=str(split_light(text)[0]) if text else "",
        file_bytes=file.size if file is not None else 0,
        encoding=about.encoding,
        size=about.size,
        layout=about.layout,
        refused=None,
        notes=light.notes,
        values=values,
        mean=triple(mean),
        mean_luminance=float(mean @ LUMINANCE),
        peak=0.0 + (values.maximum if values.maximum >= -values.minimum else values.minimum),
        peak_direction=triple(peak),
        peak_theta_phi_degrees=theta_phi_degrees(peak),
        irradiance_up=triple(light.irradiance_up()),
        method=found.projection.method,
        energy_share=found.sums.energy_share[:SHOWN_BANDS],
        bands_needed=_needed(recipe),
        roughness_served=_served(recipe),
        suns=tuple(_sun(sun, total) for sun in split.suns),
        no_sun=split.refusal,
        bands_needed_without_suns=_needed(replace(recipe, split_sun=True)) if split.suns else (),
        coefficients=_coefficients(about),
    )


def _needed(recipe: Recipe) -> tuple[BandsNeeded, ...]:
    found = (needs(replace(recipe, tolerance=tolerance)) for tolerance in TOLERANCES)
    return tuple(BandsNeeded(need.tolerance, need.radiance, need.irradiance, need.searched) for need in found)


def _served(recipe: Recipe) -> tuple[RoughnessServed, ...]:
    found = staircase(recipe)
    counts = [n for n in TOLD_BANDS if n <= found.searched]
    return tuple(RoughnessServed(n, tuple(found.served(n)), found.words(n)) for n in counts)


def _sun(sun: Sun, total: float) -> SunInformation:
    """A sun as `shviewer info` tells it. total: the light's flux, the mean of the channels."""
    return SunInformation(
        direction=triple(sun.axis),
        theta_phi_degrees=theta_phi_degrees(sun.axis),
        width_degrees=float(np.degrees(2 * sun.half_angle)),
        radiance=triple(sun.radiance),
        irradiance=triple(sun.irradiance),
        share_of_flux=float(sun.flux.mean()) / total,
        clipped=sun.clipped,
    )


def _coefficients(about: About) -> CoefficientInformation | None:
    """The information on a coefficient file; None for a light that is none."""
    if (file := about.file) is None:
        return None
    stamp = stamp_of(file.convention, file.quantity, file.n_bands)
    keys = ("quantity", "program", "basis", "phase", "index", "axes", "normalisation")
    return CoefficientInformation(
        bands=file.n_bands,
        encoding=file.stored.name if file.stored else "",
        convention=about.convention or "",
        stamped=bool(file.stamp),
        implied=file.implied,
        stamp=dict(file.stamp),
        **{key: str(stamp[key]) for key in keys},
    )
