"""`shviewer info LIGHT [LIGHT ...]`: lights in figures."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict
from functools import partial

from shviewer.analysis.information import (
    BandsNeeded,
    CoefficientInformation,
    Information,
    describe,
)
from shviewer.analysis.values import DARK_PERCENTILE, Values
from shviewer.cli.jobs import in_order
from shviewer.cli.options.inputs import lights_within, reading_from
from shviewer.cli.status_line import speaking
from shviewer.coefficients.stamp import SCHEMA_KEY, Stamp
from shviewer.coefficients.stored_code import FORMULAS
from shviewer.errors import LightError, ShviewerError
from shviewer.harmonics.extremes.error_grid import Triple
from shviewer.harmonics.quantities.encodings import ENCODINGS
from shviewer.words import counted, one_line

SCHEMA = {"schema": 1}
"""In every JSON object: which keys there are. Keys are added, but none goes or changes its meaning under the same number."""

FIGURES = {"relative-l2": "relative L2 error", "max-error": "largest error", "minimum": "minimum"}
"""Figures of the stamp of a coefficient file, in words."""


def run(options: argparse.Namespace) -> int:
    """Every light that can be read is described; the exit code is that of the first that cannot."""
    reading = reading_from(options)
    exit_code = 0
    objects: list[dict[str, object]] = []
    told: list[Information] = []
    lights = lights_within(options)
    described = in_order(partial(describe, reading=reading), lights, options.jobs)
    for number, text in enumerate(lights):
        refused: str | None = None
        with speaking():
            found = next(described)
        if isinstance(found, ShviewerError):
            refused, code = str(found), found.exit_code
            objects.append({**SCHEMA, "light_argument": text, "error": refused})
        else:
            refused, code = found.refused, LightError.exit_code
            objects.append(SCHEMA | asdict(found))
            told.append(found)
            if not options.json:
                print(("\n" if number else "") + as_text(found), flush=True)
        if refused is not None:
            print(f"shviewer: {refused}", file=sys.stderr)
            exit_code = exit_code or code
    if len(told) > 1 and not options.json:
        print(f"\n{together(told)}")
    if options.json:
        print(json.dumps(objects, indent=2, allow_nan=False))
    return exit_code


def as_text(information: Information) -> str:
    """The information as aligned lines, one screen at most."""
    values, size, peak = information.values, information.size, information.peak_direction
    size_read = _bytes(information.file_bytes) if information.file_bytes else "of unknown size"  # a pipe
    rows = [("file", f"{information.file}, {size_read}")]
    if information.encoding:
        rows.append(("encoding", information.encoding))
    if size and information.layout:
        rows.append(("layout", f"{information.layout}, {size[0]} x {size[1]}"))
    if information.coefficients:
        rows += _coefficients(information.coefficients)
    if information.refused:
        rows += [("refused", information.refused), ("", "what follows is said of the image as --sanitize repairs it")]
    rows += [("note", note) for note in information.notes]
    rows.append(
        ("radiance", f"{_number(values.minimum)} to {_number(values.maximum)} in any channel ({values.source})")
    )
    if size and not information.refused:
        repaired = any(note.startswith("sanitised") for note in information.notes)
        none = f"no NaN, no infinity, {values.negative_values or 'none'} negative"
        rows.append(("bad values", "repaired, see note" if repaired else none))
    rows.append(("mean", f"{_numbers(information.mean)}, luminance {_number(information.mean_luminance)}"))
    rows += _dynamic_range(values)
    theta, phi = information.peak_theta_phi_degrees
    place = f"x y z {' '.join(f'{component:z.4f}' for component in peak)}"
    rows.append(("peak", f"{_number(information.peak)} at theta {theta:.2f}, phi {phi:z.2f} degrees; {place}"))
    rows.append(("irradiance up", _numbers(information.irradiance_up)))
    shares = " ".join(f"{100 * share:.2f}" for share in information.energy_share)
    rows.append(("energy, %", f"{shares} in bands 0 to {len(information.energy_share) - 1}; {information.method}"))
    rows += _bands("bands", information.bands_needed)
    rows += _roughness(information)
    rows += _suns(information)
    lines = [one_line(f"{information.light}: {information.description}")]
    return "\n".join(lines + [f"  {label:<18}{one_line(text)}" for label, text in rows])


def together(lights: Sequence[Information]) -> str:
    """How many bands shade how many of several lights, for each tolerance."""
    lines = [f"all {len(lights)} lights: bands that shade them, irradiance"]
    for each in zip(*(light.bands_needed for light in lights), strict=True):
        counts = [need.irradiance for need in each]
        known = sorted(count for count in counts if count is not None)
        serve = [f"{n} serve {sum(count <= n for count in known)}" for n in dict.fromkeys(known)]
        if known and len(known) == len(lights):
            serve[-1] = f"{known[-1]} serve all"
        words = ", ".join(serve) or f"none up to {each[0].searched}"
        lines.append(f"  {f'within {100 * each[0].tolerance:g} %':<18}{words}")
    return "\n".join(lines)


def _bands(what: str, counts: tuple[BandsNeeded, ...]) -> list[tuple[str, str]]:
    return [
        (
            f"{what}, {quantity}",
            ", ".join(
                f"{getattr(need, quantity) or f'over {need.searched}'} for {100 * need.tolerance:g} %"
                for need in counts
            ),
        )
        for quantity in ("radiance", "irradiance")
    ]


def _roughness(information: Information) -> list[tuple[str, str]]:
    """What glossy surfaces some numbers of bands serve, up to the first that serves a mirror."""
    told: list[str] = []
    for served in information.roughness_served:
        words = served.words.removeprefix("roughness ")
        told.append(
            f"{served.bands}, {words.replace('and rougher', 'on')}" if told else f"{served.bands} serve {words}"
        )
        if not served.words.startswith(("roughness", "no")):
            break
    return [("bands, roughness", f"for 5 %: {'; '.join(told)}")] if told else []


def _suns(information: Information) -> list[tuple[str, str]]:
    rows = []
    for sun in information.suns:
        theta, phi = sun.theta_phi_degrees
        share = f"{100 * sun.share_of_flux:.3g} % of the flux"
        place = f"at theta {theta:.2f}, phi {phi:z.2f}, {sun.width_degrees:.3g} deg wide"
        colour = " ".join(f"{value:.3g}" for value in sun.irradiance)
        clipped = "; the image is clipped there, it had more" if sun.clipped else ""
        rows.append(("sun", f"{share} {place}; irradiance {colour}{clipped}"))
    rows += _bands("rest", information.bands_needed_without_suns) if rows else []
    return rows or [("sun", f"none: {information.no_sun.partition(': ')[2].partition(';')[0]}")]


def _dynamic_range(values: Values) -> list[tuple[str, str]]:
    black = values.negative_or_black_area
    rows = [("black", f"{100 * black:.3g} % of the sphere has no luminance above 0")] if black else []
    if values.dynamic_range_stops is None or values.darkest is None:
        return rows
    ends = f"from {_number(values.darkest)}, the darkest {100 * DARK_PERCENTILE:g} % above 0 left out, to"
    text = f"{values.dynamic_range_stops:.1f} stops of luminance, {ends} {_number(values.brightest_luminance)}"
    return [("dynamic range", text), *rows]


def _bytes(count: int) -> str:
    if count < 2**10:
        return f"{count} bytes"
    return f"{count / 2**10:.1f} KiB" if count < 2**20 else f"{count / 2**20:.1f} MiB"


def _number(value: float) -> str:
    return f"{value:z.4g}"


def _numbers(values: Triple) -> str:
    return " ".join(map(_number, values))


def _coefficients(found: CoefficientInformation) -> list[tuple[str, str]]:
    """The lines to print: label and text."""
    said = "as named on the command line; the file does not say"
    if found.stamped or found.implied:
        said = "as the file says" if found.stamped else "as this kind of file implies"
    held = found.quantity.replace("-", " ")
    if found.encoding:
        encoding = ENCODINGS[found.encoding]
        count = counted(encoding.floats, "number")
        rows = [
            ("encoding", f"{count} a channel, {found.encoding}, {held}"),
            ("formula", FORMULAS[encoding.formula]),
        ]
    else:
        rows = [
            ("coefficients", f"{counted(found.bands, 'band')}, {counted(found.bands**2, 'row')}, {held}"),
            ("convention", f"{found.convention} ({found.program}), {said}"),
            ("basis", f"{found.basis}; {found.phase}; index {found.index}"),
        ]
    return [*rows, ("axes", found.axes), *_origin(found.stamp)]


def _origin(stamp: Stamp) -> list[tuple[str, str]]:
    if SCHEMA_KEY not in stamp:
        return []
    parts = [f"{stamp.get('light', 'an unnamed light')} ({stamp.get('light-is', 'not described')})"]
    parts += [str(stamp[key]) for key in ("method",) if key in stamp]
    parts += [
        f"{key} {stamp[key]}" for key in ("samples", "seed", "window", "muted") if stamp.get(key) not in (None, "none")
    ]
    parts.append(f"written by {stamp.get('written-by', 'an unknown program')}")
    figures = [
        f"{words} {float(str(stamp[key])):.4g}{_bound(stamp, key)}"
        for key, words in FIGURES.items()
        if _is_number(stamp.get(key))
    ]
    if len(figures) > 1 and str(stamp.get("quantity", "")).endswith("-over-pi"):
        figures[-1] += ", not divided by pi"
    use = [("to be typed", str(stamp["use"]))] if stamp.get("use") else []
    return [*use, ("origin", ", ".join(parts)), *([("figures there", ", ".join(figures))] if figures else [])]


def _bound(stamp: Stamp, key: str) -> str:
    """The bound of a figure in words, if the stamp has one."""
    value = stamp.get(f"{key}-bound")
    return f" (at {'least' if key == 'minimum' else 'most'} {float(str(value)):.4g})" if _is_number(value) else ""


def _is_number(value: object) -> bool:
    try:
        float(str(value))
    except ValueError:
        return False
    return True
