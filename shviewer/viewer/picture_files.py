"""Pictures as files: PNG and EXR that carry everything that made them, written whole or not at all, and compared."""

from __future__ import annotations

import io
import json
import math
import tempfile
import warnings
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from shviewer.errors import OutputError, UsageError
from shviewer.files import write_atomically
from shviewer.lights.suns.sun import Sun
from shviewer.version import __version__
from shviewer.viewer.colour_maps import map_of
from shviewer.viewer.composition import Composition
from shviewer.viewer.drawn import DirectSum, SplineMap, Surfaces
from shviewer.viewer.picture import Picture

EVALUATED = {DirectSum: "direct", SplineMap: "map", Surfaces: "surfaces"}
"""What the description of a picture says of how its reconstruction is drawn."""

PIXEL_STEP = 2
"""Two pixels differ if any channel does by more than this many of 255: rounding differs by 1 between drivers."""


def metadata(picture: Picture, composition: Composition, opengl: str, *, overlay: bool = True) -> str:
    """Everything that made the picture, as one JSON text; equal arguments give equal text."""
    state, figures, projection = picture.state, picture.figures, picture.projection
    extremes, scale = figures.extremes, picture.error_scale
    description: dict[str, Any] = {
        "version": __version__,
        "light": picture.light.name,
        "light_argument": state.recipe.light if isinstance(state.recipe.light, str) else None,
        "light_notes": list(picture.light.notes),
        "bands": state.recipe.n_bands,
        "muted": list(state.recipe.muted_shown),
        "quantity": state.recipe.quantity,
        "compare": state.recipe.compare
        and {"name": state.recipe.compare.name, "convention": state.recipe.compare.convention},
        "verdict": picture.verdict,
        "split_sun": state.recipe.split_sun,
        "suns": [_described(sun) for sun in picture.subject.suns],
        "window": state.recipe.window,
        "window_width": state.recipe.window_width,
        "factors": list(figures.factors),
        "method": state.recipe.method,
        "method_words": projection.method,
        "samples_asked": None if state.recipe.method == "best" else state.recipe.samples,
        "samples": projection.evaluations,
        "seed": state.recipe.seed if state.recipe.method == "jittered" else None,
        "sanitize": state.recipe.reading.sanitize,
        "layout": state.recipe.reading.layout,
        "exposure_stops": picture.exposure_stops,
        "tone": state.view.tone,
        "error": None
        if scale is None
        else {
            "kind": scale.kind,
            "range": scale.end,
            "floor": scale.floor if scale.kind == "relative" else None,
            "largest": scale.largest,
            "largest_direction_in_light": scale.direction.tolist(),
            "colour_map": map_of(scale.kind),
        },
        "overlay": overlay,
        "marks": state.view.marks,
        "sheet": state.view.sheet,
        "lobe_view": state.view.lobe_view,
        "basis": state.view.basis,
        "evaluated": EVALUATED[type(picture.drawn)],
        "size": [composition.width, composition.height],
        "camera_degrees": list(state.view.camera),
        "zoom": state.view.zoom,
        "world_from_view": picture.world_from_view.tolist(),
        "light_from_world": picture.light_from_world.tolist(),
        "spheres": {
            name: {"centre": [sphere.x, sphere.y], "radius": sphere.radius, "clip": list(sphere.clip)}
            for name, sphere in zip(("original", "reconstruction", "error"), composition.spheres, strict=False)
        },
        "opengl": opengl,
        "figures": {
            **{name: asdict(channel) for name, channel in figures.channels.items()},
            "relative_l2": figures.relative_l2,
            "relative_l2_floor": figures.floor,
            "irradiance_relative_l2": figures.irradiance_relative_l2,
            "max_error": extremes.max_error,
            "max_error_direction_in_light": list(extremes.max_error_direction),
            "minimum": extremes.minimum,
            "minimum_direction_in_light": list(extremes.minimum_direction),
            "negative_area": extremes.negative_area,
            "negative_energy": extremes.negative_energy,
            "peak": extremes.peak,
            "energy_share": list(figures.energy_share),
            "bands_needed": asdict(picture.needs),
            "bands_needed_unsplit": asdict(picture.needs_unsplit) if picture.needs_unsplit else None,
        },
    }
    return json.dumps(_finite(description), allow_nan=False)


def _described(sun: Sun) -> dict[str, Any]:
    return {
        "direction_in_light": sun.axis.tolist(),
        "half_angle_degrees": math.degrees(sun.half_angle),
        "solid_angle": sun.solid_angle,
        "radiance": sun.radiance.tolist(),
        "irradiance": sun.irradiance.tolist(),
    }


def _finite(value: Any) -> Any:
    """JSON has no infinity: an infinite PSNR (no error at all) is null."""
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_png(path: Path, pixels: NDArray[np.uint8], text: str, *, exclusive: bool = False) -> None:
    """A PNG with `text` under the key shviewer. OutputError if it cannot be written; FileExistsError if exclusive and taken."""
    information = PngInfo()
    information.add_itxt("shviewer", text)
    information.add_text("Software", f"shviewer {__version__}")
    buffer = io.BytesIO()
    Image.fromarray(pixels).save(buffer, "PNG", compress_level=4, pnginfo=information)
    write_atomically(path, buffer.getvalue(), exclusive=exclusive)


def write_exr(path: Path, pixels: NDArray[np.float32], text: str) -> None:
    """Float32 RGB with `text` in the attribute shviewer. OutputError if it cannot be written or OpenEXR is missing."""
    try:
        import OpenEXR
    except ImportError as error:
        raise OutputError(f"{path}: writing EXR needs the package OpenEXR (pip install OpenEXR)") from error
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, "shviewer": text}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "picture.exr"
        OpenEXR.File(header, {"RGB": pixels}).write(str(file))
        write_atomically(path, file.read_bytes())


def write_numbered(stem: str, pixels: NDArray[np.uint8], text: str) -> Path:
    """A PNG under the next free name stem-001.png, stem-002.png, ... in the current folder."""
    for number in range(1, 10_000):
        path = Path(f"{stem}-{number:03d}.png")
        if not path.exists():
            with suppress(FileExistsError):  # somebody else was faster
                write_png(path, pixels, text, exclusive=True)
                return path
    raise OutputError(f"{stem}-001.png to {stem}-9999.png all exist; move some away")


def compare_with_reference(pixels: NDArray[np.uint8], reference: Path, difference: Path, threshold: float) -> str:
    """ "" if at most the share `threshold` of the pixels differs by more than PIXEL_STEP of 255, else what differs.

    Then `difference` is written: the absolute difference, sixteen times as bright. UsageError if the reference is bad.
    """
    try:
        with warnings.catch_warnings(action="error"), Image.open(reference) as image:
            wanted = np.asarray(image.convert("RGB"))
    except FileNotFoundError as error:
        raise UsageError(f"{reference}: no such reference; make it with the same command, REF.png as OUT") from error
    except (OSError, ValueError, Warning, Image.DecompressionBombError) as error:
        raise UsageError(
            f"{reference}: not a readable picture; make it with the same command, REF.png as OUT"
        ) from error
    if wanted.shape != pixels.shape:
        return (
            f"{reference} is {wanted.shape[1]} x {wanted.shape[0]}, the picture {pixels.shape[1]} x {pixels.shape[0]}"
        )
    distance = np.abs(wanted.astype(np.int16) - pixels)
    share = float((distance.max(axis=2) > PIXEL_STEP).mean())
    if share <= threshold:
        return ""
    write_png(difference, np.minimum(distance * 16, 255).astype(np.uint8), json.dumps({"reference": str(reference)}))
    return (
        f"{share:.4%} of the pixels differ from {reference} by more than {PIXEL_STEP}/255 (allowed {threshold:.4%}, "
        f"largest {distance.max()}/255); see {difference}"
    )
