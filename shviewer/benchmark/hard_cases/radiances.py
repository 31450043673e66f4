"""Hard cases of radiances: zero, NaN and infinity, and numbers at the ends of what lights may have and float64 holds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from shviewer.benchmark.hard_cases.figures import shown_as
from shviewer.benchmark.hard_cases.outcome import Case, largest, worst
from shviewer.benchmark.hard_cases.shader import SEED, SUN_AXIS
from shviewer.ending import temporary_folder
from shviewer.errors import LightError
from shviewer.harmonics.basis import Array
from shviewer.harmonics.projection.rows import project_image
from shviewer.harmonics.zonal import Disc
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.lights.light import Light
from shviewer.limits import BRIGHTEST, DIMMEST


def bad_texels(read: Callable[[Path], object] = EnvironmentLight.read) -> float:
    """How many of NaN, +Inf and -Inf, one among 8192 texels, are read, or refused without their place. Bound: 0."""
    from shviewer.viewer.saving.picture_files import write_exr

    missed = 0
    with temporary_folder() as folder:
        for bad in (np.nan, np.inf, -np.inf):
            texels = np.ones((64, 128, 3), dtype=np.float32)
            texels[37, 101, 1] = bad
            write_exr(folder / "bad.exr", texels, "")
            try:
                read(folder / "bad.exr")
                missed += 1
            except LightError as error:
                missed += "row 37, column 101" not in str(error)
    return missed


def relative_figures(light: Light) -> list[float]:
    """Figures that a picture of 5 bands shows: the relative L2 error, and the energy of each band."""
    figures = shown_as(light, 5)
    return [figures.relative_l2, *figures.energy_share]


def black(figures: Callable[[Light], Sequence[float]] = relative_figures) -> float:
    """An image and a scene of radiance 0: relative error and energies read 0. Bound: 0; a NaN is an infinite error."""
    image = EnvironmentLight(LatLongMap(np.zeros((4, 8, 3), dtype=np.float32)))
    lights: tuple[Light, ...] = (image, LobeLight((Lobe(Disc(0.5), np.array(SUN_AXIS), np.zeros(3)),)))
    return max(largest(figures(light)) for light in lights)


def magnitudes() -> float:
    """An image times 2^-900 to 2^900 has the same coefficients times that, exactly. Bound: 0, not one bit."""
    image = np.random.default_rng(SEED).random((16, 32, 3))
    plain = project_image(image, 8)
    return max(largest(np.ldexp(project_image(np.ldexp(image, k), 8), -k) - plain) for k in (-900, -500, 500, 664, 900))


@worst
def subnormal_image() -> Iterator[Array]:
    """A constant image of 5e-324 to 1e-310, in units of 5e-324.

    Bound: each of 4 x 8 texel products may be rounded to a whole unit, once more per row and order: 64 units.
    """
    for radiance in (5e-324, 1e-320, 1e-310):
        found = project_image(np.full((4, 8, 3), radiance), 4)
        wanted = np.zeros((16, 3))
        wanted[0] = radiance * np.sqrt(4 * np.pi)
        yield (found - wanted) / 5e-324


def figures_at_any_radiance(figures: Callable[[Light], Sequence[float]] = relative_figures) -> float:
    """The relative figures of a sun of radiance 1e-30 and 1e30, the ends of what lights may have, against those of 1.

    Bound: 1e-12, rounding of sums.
    """

    def read(radiance: float) -> Array:
        lobe = Lobe(Disc(0.6), np.array(SUN_AXIS), np.array([1.0, 0.5, 0.25]) * radiance)
        return np.array(figures(LobeLight((lobe,))))

    plain = read(1.0)
    return max(largest(read(radiance) - plain) for radiance in (DIMMEST, BRIGHTEST))


CASES = (
    Case("NaN and Inf texels", "refused with their place (number missed)", 0.0, bad_texels),
    Case("black light", "reads 0", 0.0, black),
    Case("radiance times 2^-900 to 2^900", "coefficients scale exactly", 0.0, magnitudes),
    Case("subnormal radiance", "sqrt(4 pi) L, in units of 5e-324", 64.0, subnormal_image),
    Case("figures of radiance 1e-30 to 1e30", "those of radiance 1", 1e-12, figures_at_any_radiance),
)
