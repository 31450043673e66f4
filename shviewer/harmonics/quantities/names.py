"""Quantities and encodings by name, as options take them. Loads no numpy."""

from __future__ import annotations

from shviewer.words import meant

RADIANCE, IRRADIANCE = "radiance", "irradiance"
GLOSSY = "glossy:"
"""The beginning of the name of a glossy quantity; its roughness follows."""

LEAST_ROUGHNESS, MOST_ROUGHNESS = 0.1, 1.0

RULE = (
    f"it must be {RADIANCE}, {IRRADIANCE} or {GLOSSY}R with a roughness R of {LEAST_ROUGHNESS:g} to {MOST_ROUGHNESS:g}, "
    f"such as {GLOSSY}0.4, or of 0, which is {RADIANCE}"
)

NAMES = (RADIANCE, IRRADIANCE, f"{GLOSSY}0.4")
"""Some of all names."""

ENCODED_BANDS = {
    "l1": 2,
    "geomerics": 32,
    "hallucinated": 3,
    "hallucinated-shared": 3,
    "zh3": 3,
    "zh3-shared": 3,
    "zh3-solved": 3,
    "ambient-cube": 32,
    "ambient-cube-fitted": 32,
    "l2": 3,
    "l2-deringed": 3,
}
"""Encodings of irradiance (encodings.py), from few numbers to many -> the bands of the function that each stands for."""

CUBES = ("ambient-cube", "ambient-cube-fitted")
"""Those that stand in the axes of the world: of a light that is turned there is another."""


def glossy(roughness: float) -> str:
    """The quantity of that roughness, by its one name; radiance for 0."""
    return f"{GLOSSY}{roughness:.6g}" if roughness else RADIANCE


def quantity_of(text: str) -> str:
    """The one name of a quantity: "glossy:0.40" is "glossy:0.4", and "glossy:0" is "radiance". ValueError if there is none."""
    if text in (RADIANCE, IRRADIANCE):
        return text
    try:
        roughness = float(text.removeprefix(GLOSSY)) if text.startswith(GLOSSY) else -1.0
    except ValueError:
        roughness = -1.0
    if roughness != 0 and not LEAST_ROUGHNESS <= roughness <= MOST_ROUGHNESS:
        raise ValueError(f"{text!r}: {RULE if text.startswith(GLOSSY) else meant(text, NAMES, RULE)}")
    return glossy(roughness)


def roughness_of(quantity: str) -> float | None:
    """The roughness of a glossy quantity; None for any other."""
    return float(quantity.removeprefix(GLOSSY)) if quantity.startswith(GLOSSY) else None


def in_words(quantity: str) -> str:
    """ "radiance", "irradiance" or "roughness 0.4" """
    roughness = roughness_of(quantity)
    return quantity if roughness is None else f"roughness {roughness:g}"
