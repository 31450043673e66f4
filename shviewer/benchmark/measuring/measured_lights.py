"""The lights of a report, with their exact coefficients and band counts, found before anything is timed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from shviewer.benchmark.rows.report import LightRecord
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import errors_by_band_count, smallest_band_count
from shviewer.lights.find import find_light
from shviewer.lights.light import Light
from shviewer.lights.reading import DEFAULT_READING, Reading

MOST_BANDS = 128
"""The number of bands up to which the count for a tolerance is searched."""

TOLERANCES = (0.1, 0.05, 0.01)


@dataclass(frozen=True, eq=False)
class MeasuredLight:
    """A light of the report and its exact answers."""

    name: str
    light: Light
    exact: Array
    """The exact coefficients, (MOST_BANDS**2, 3)."""
    products: Array
    """The light's products (harmonics/metrics.py), (3, 3)."""
    left_out: Array
    """The relative L2 error of the exact coefficients with n = 1 ... MOST_BANDS bands, (MOST_BANDS,)."""
    needs: dict[float, int | None]
    """Tolerance -> the smallest band count within it; None if none up to MOST_BANDS is."""

    @property
    def record(self) -> LightRecord:
        """What the report keeps of it."""
        needs = {f"{tolerance:g}": count for tolerance, count in self.needs.items()}
        light = self.light
        return LightRecord(light.description, light.best_method, light.accuracy(), needs, self.left_out.tolist())


def find_measured_lights(
    lights: Sequence[str | Light], tolerances: Sequence[float] = TOLERANCES, reading: Reading = DEFAULT_READING
) -> list[MeasuredLight]:
    """Measure every light, once. If two files have the same stem, the second is called by its whole text. LightError."""
    found: dict[str, MeasuredLight] = {}
    for number, text in enumerate(lights):
        if text in lights[:number]:
            continue
        light = find_light(text, reading) if isinstance(text, str) else text
        name = light.name if light.name not in found else str(text) if isinstance(text, str) else f"light {number + 1}"
        found[name] = measured_light(light, tolerances, name)
    return list(found.values())


def measured_light(light: Light, tolerances: Sequence[float] = TOLERANCES, name: str = "") -> MeasuredLight:
    """A light under its own or another name, with its exact coefficients and the error of their first bands."""
    exact, products = light.coefficients(MOST_BANDS), light.products()
    left_out = errors_by_band_count(products, exact, exact)
    needs = {tolerance: smallest_band_count(left_out, tolerance) for tolerance in tolerances}
    return MeasuredLight(name or light.name, light, exact, products, left_out, needs)
