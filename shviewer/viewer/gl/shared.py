"""Numbers that CPU and GPU share: limits, numbers of cases, the contents of uniform blocks, and the GLSL constants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands, index, normalisation
from shviewer.harmonics.quantities.decoding import LINEAR, MEAN, ZONAL
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.harmonics.quantities.glossy import Glossy
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import MAX_LOBES
from shviewer.lights.suns.rule import MOST as MAX_SUNS
from shviewer.limits import MAX_DIRECT_BANDS
from shviewer.viewer.colour.tone import ACES, BRIGHTEST_EXPOSED, LOG_RANGE
from shviewer.viewer.view import ERRORS, TONES

CHOICES: dict[str, tuple[str, ...]] = {
    "SHOWN": ("ORIGINAL", "RECONSTRUCTION", "ERROR"),
    "ORIGINAL": ("LOBES", "MAP"),
    "RECONSTRUCTION": ("SUM", "MAP", *dict.fromkeys(encoding.formula.upper() for encoding in ENCODINGS.values())),
    "TONE": tuple(tone.upper() for tone in TONES),
    "PANE": ("SPHERE", "MAP"),
}
"""The choices that a program of shaders/sphere.frag is compiled for: one of each, and PROFILES and SAMPLES."""

BACKGROUND = (0.0203, 0.0203, 0.0232)
"""Linear RGB around the panes: a little above black, so that an unlit sphere is still seen."""

NEGATIVE_HUE = (0.06, 0.40, 1.0)
"""Linear RGB that negative luminance tends to."""

NEGATIVE_KNEE = 0.3
"""The magnitude of negative luminance, in units of white, that goes half-way to that colour."""

NEGATIVE_FILL = 0.34
"""How much of that colour a negative area has, so that its lines stand out."""

BARELY = 0.5 / 255
"""Half a step of white: what is closer to zero is neither negative nor light to the eye."""

RISING_INK, EDGE_INK, DARK_INK = (0.188, 0.402, 1.0), (0.434, 0.617, 1.0), (0.0212, 0.0212, 0.0252)
"""Linear RGB of the lines over what is negative, along its edge, and over what is beyond white or merely light."""

LINES = {
    "LIGHT_GROUND": 0.18,
    "RISING_PITCH": 5.0,
    "RISING_FAINT": 0.26,
    "RISING_GROWTH": 0.62,
    "RISING_DARK": 0.45,
    "EDGE_WIDTH": 1.1,
    "EDGE_STRENGTH": 0.9,
    "EDGE_FADE": 2.5,
    "BEYOND_PITCH": 6.0,
    "BEYOND_WIDTH": 1.1,
    "BEYOND_STRENGTH": 0.75,
    "BEYOND_RISE": 0.02,
}
"""The lines: pitch and width in pixels of the design, strength from 0 to 1.

Rising ones are RISING_FAINT where a channel is negative alone, and grow with the magnitude of a negative luminance. Over a
colour lighter than LIGHT_GROUND, where they would not be seen, they are dark, with RISING_DARK. The line of the edge fades
within EDGE_FADE pixels of a sphere's limb. The lines beyond white have their strength from BEYOND_RISE above it.
"""

SH_TERMS = MAX_DIRECT_BANDS**2
LOBE_SLOTS = 2 * MAX_LOBES + MAX_SUNS
ERROR_KINDS = tuple(kind.upper() for kind in ERRORS[1:])
FLOATS = {
    "NEGATIVE_KNEE": NEGATIVE_KNEE,
    "NEGATIVE_FILL": NEGATIVE_FILL,
    "BARELY": BARELY,
    **LINES,
    "LOG_RANGE": LOG_RANGE,
    "BRIGHTEST_EXPOSED": BRIGHTEST_EXPOSED,
    "STORED_MEAN": MEAN,
    "STORED_LINEAR": LINEAR,
    "STORED_ZONAL": ZONAL,
}
VECTORS = {
    "BACKGROUND": BACKGROUND,
    "NEGATIVE_HUE": NEGATIVE_HUE,
    "RISING_INK": RISING_INK,
    "EDGE_INK": EDGE_INK,
    "DARK_INK": DARK_INK,
}


def glsl_constants(chosen: Mapping[str, str | int] = MappingProxyType({})) -> str:
    """The text of constants.glsl, which shaders include for the numbers of this module and the choices of their program."""
    integers = {
        "SH_TERMS": SH_TERMS,
        "LOBE_SLOTS": LOBE_SLOTS,
        "PROFILE_CONSTANT": Constant.kind,
        "PROFILE_CLAMPED_LINEAR": ClampedLinear.kind,
        "PROFILE_DISC": Disc.kind,
        "PROFILE_GAUSSIAN": Gaussian.kind,
        "PROFILE_GLOSSY": Glossy.kind,
    }
    for name, values in (*CHOICES.items(), ("ERROR", ERROR_KINDS)):
        integers |= {f"{name}_{value}": number for number, value in enumerate(values)}
    lines = [f"#define {name} {value}" for name, value in integers.items()]
    lines += [
        f"#define {name} {value if isinstance(value, int) else f'{name}_{value}'}" for name, value in chosen.items()
    ]
    lines += [f"const float {name} = {value!r};" for name, value in FLOATS.items()]
    lines += [f"const vec3 {name} = vec3({', '.join(map(repr, value))});" for name, value in VECTORS.items()]
    lines.append(f"const float ACES[5] = float[5]({', '.join(map(repr, ACES))});")
    return "\n".join(lines) + "\n"


def pack_coefficients(coefficients: Array) -> NDArray[np.float32]:
    """The block ShBlock of shaders/sh.glsl, (SH_TERMS, 4): coefficients (n**2, 3) as the shader reads them, one after another.

    For m = 0, 1, ... and l = m, m+1, ...: the term of cos(m phi), then for m > 0 that of sin(m phi). A term is the
    coefficient times N(l, m) of basis.py, and in w the recurrence's q(l+1, m) = (2l+1)/(l+1+m).
    """
    rows, factors, steps = _term_order(count_bands(coefficients))
    packed = np.zeros((SH_TERMS, 4), dtype=np.float32)
    packed[: len(rows), :3] = coefficients[rows] * factors[:, None]
    packed[: len(rows), 3] = steps
    return packed


@lru_cache(maxsize=MAX_DIRECT_BANDS)
def _term_order(n_bands: int) -> tuple[NDArray[np.int64], Array, Array]:
    """The index, the factor N and the step q of each term."""
    norms = normalisation(n_bands)
    terms = [
        (index(l, sign * m), norms[l, m], (2 * l + 1) / (l + 1 + m))
        for m in range(n_bands)
        for l in range(m, n_bands)
        for sign in ((1, -1) if m else (1,))
    ]
    rows, factors, steps = zip(*terms, strict=True)
    return np.array(rows), np.array(factors), np.array(steps)


def pack_lobes(lobes: Sequence[Lobe]) -> NDArray[np.float32]:
    """The block LobeBlock of shaders/lobes.glsl, (LOBE_SLOTS, 3, 4): axis and kind, radiance, parameters."""
    packed = np.zeros((LOBE_SLOTS, 3, 4), dtype=np.float32)
    for row, lobe in zip(packed, lobes, strict=False):
        row[0] = *lobe.axis, lobe.profile.kind
        row[1, :3] = lobe.radiance
        row[2, :2] = lobe.profile.parameters
    return packed


def profile_bits(lobes: Sequence[Lobe]) -> int:
    """The kinds of the lobes' profiles as bits: the value of PROFILES in a program that draws them."""
    return sum(1 << kind for kind in {int(lobe.profile.kind) for lobe in lobes})
