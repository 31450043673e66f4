"""The sound files and texts of every door but that of images; each is mutated. A new seed is one line of SEEDS.

A name is "door/file": the door says what is done with the bytes (doors.py), the suffix how they are spoilt
(door_mutations.py). What a seed holds is read, or it is in REFUSED.
"""

from __future__ import annotations

import io
import json
from dataclasses import replace
from functools import cache

import numpy as np
from coefficients.found_lists import COLOURED
from helpers import frame_of, picture_of
from lights.images.ldr_files import saved_by_pillow
from seeds import seeds as image_seeds

from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.benchmark.rows.report import LightRecord, Report
from shviewer.benchmark.rows.row import Row
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.writing import FORMATS
from shviewer.resources import resource_folder
from shviewer.viewer.saving.stamp import metadata

_ROWS = np.round(np.random.default_rng(2).normal(size=(9, 3)), 4)
_CILM = np.zeros((2, 3, 3))
_CILM[0][np.tril_indices(3)], _CILM[1, 1:, 1:][np.tril_indices(2)] = _ROWS[:6, 0], _ROWS[6:, 0]
_LINES = "\n".join(" ".join(f"{x:g}" for x in row) for row in _ROWS)
_COMMAS = "\n".join(",".join(f"{x:g}" for x in row) for row in _ROWS)
_VECTORS = ",\n".join(f"    vec3({', '.join(f'{x:g}' for x in row)})" for row in _ROWS)
_BRACED = ",\n".join(f"    {{{', '.join(f'{x:g}f' for x in row)}}}" for row in _ROWS)
_LOBES = """description = "Every profile"
[[lobe]]
profile = "clamped-linear"
axis = [1, 0.5, 2]
radiance = [8, 6, 4]
slope = 2.5
offset = 0.1

[[lobe]]
profile = 'disc'  # a lamp
azimuth_degrees = -30
elevation_degrees = +12.5
radiance = 1e2
half_angle_degrees = 7
[[lobe]]
profile = "gaussian"
axis = [0.0, -1.0, 0]
radiance = [
    0.25,
    -0.5, 1,
]
sharpness = 40
[[lobe]]
profile = "constant"
radiance = 0.1
"""

SEEDS: dict[str, str] = {
    **{f"light/{name}": text for name, (text, _) in COLOURED.items()},
    # ---- scenes
    "light/every-profile.toml": _LOBES,
    "light/one-lobe.toml": '[[lobe]]\nprofile = "constant"\nradiance = 1\n',
    # ---- bare lists
    "light/rows.txt": _LINES,
    "light/grey.txt": "1 2 3 4 5 6 7 8 9\n",
    "light/commented.txt": f"# of three.js\n{_LINES}\n",
    "light/rows.csv": _COMMAS,
    "light/header.csv": f"red,green,blue\n{_COMMAS}\n",
    "light/degrees.csv": "l;m;value\n0;0;1,5\n1;-1;2,25\n1;0;-3\n1;1;0,5\n",
    "light/shtools.txt": "0, 0, 1.5, 0\n1, 0, 2, 0\n1, 1, 0.5, -1\n",
    "light/names.txt": "L00: 1, 2, 3\nL1_1: 4, 5, 6\nL10: 7 8 9\nL11: 1 1 1\n",
    "light/cmgen.txt": f"({', '.join('0.5' for _ in range(3))}); // L00, irradiance, pre-scaled base\n",
    "light/spreadsheet.txt": _LINES.replace(" ", ";").replace(".", ","),
    "light/counted.txt": f"9\n{_LINES}\n",
    "light/hlsl.h": f"static const float3 SH[9] = {{\n{_VECTORS.replace('vec3', 'float3')}\n}};\n",
    "light/three.json": json.dumps({"object": {"type": "LightProbe", "intensity": 2, "sh": _ROWS.ravel().tolist()}}),
    "light/babylon.json": json.dumps(
        {f"l{k}": dict(zip("xyz", _ROWS[1], strict=True)) for k in ("00", "1_1", "10", "11")}
    ),
    "light/gltf.json": json.dumps({"lights": [{"irradianceCoefficients": _ROWS.tolist(), "intensity": 1}]}),
    "light/objects.json": json.dumps([dict(zip("rgb", row, strict=True)) for row in _ROWS.tolist()]),
    "light/rows.json": json.dumps(_ROWS.tolist()),
    "light/flat.json": json.dumps(_ROWS.ravel().tolist()),
    "light/object.json": json.dumps({"name": "probe", "coefficients": _ROWS.tolist()}),
    "light/braced.h": f"/* SH */\n// red, green, blue\n{{\n{_BRACED}\n}}\n",
    "light/vectors.glsl": f"(\n{_VECTORS}  // the last\n)\n",
    "compare/rows.txt": _LINES,
    "compare/flat.json": json.dumps(_ROWS.ravel().tolist()),
    # ---- the command line: one argument a line
    "arguments/plain.argv": "green\n--bands\n9",
    "arguments/view.argv": "studio\n--exposure\n-1.5\n--tone\naces\n--error\nrelative\n--error-range\n20%\n--zoom\n1.5",
    "arguments/window.argv": "screenshot\no.png\ngreen\n--window\ngauss:3.5\n--mute\n1,3\n--basis\n2\n-1\n--no-marks",
    "arguments/camera.argv": "screenshot\no.exr\ngreen\n--camera\n30\n10\n--rotate-light\n-20\n45\n--size\n640\n320",
    "arguments/limits.argv": "screenshot\no.png\ngreen\n--max-side\n4096\n--max-megatexels\n0.5\n--max-file-mib\n8",
    "arguments/tolerance.argv": "screenshot\no.png\nhemisphere\n--tolerance\n5%\n--for\nirradiance",
    "arguments/jittered.argv": "screenshot\no.png\ngreen\n--method\njittered\n--samples\n1e3\n--seed\n7\n--split-sun",
    "arguments/compare.argv": "screenshot\no.png\ngreen\n--compare\nnine.json\n--error\nsigned\n--threshold\n0.01",
    "arguments/list.argv": "screenshot\no.png\nbare.txt\n--convention\nthree,+x+z-y,no-phase",
    "arguments/sweep.argv": "sweep\no.webp\ngreen\n--from\n2\n--to\n7\n--seconds\n0.5\n--lobes",
    "arguments/turn.argv": "sweep\no.gif\ngreen\n--turntable\n--frames\n12\n--bands\n4\n--evaluate\nmap",
    "arguments/info.argv": "info\nsky.hdr\nnine.json\n--json\n--layout\nlat-long",
    "arguments/images.argv": "info\nsky.hdr\nsky.exr:diffuse\n~/sky.png\n--sanitize",
    "arguments/project.argv": "project\ngreen\n-o\no.json\n--convention\nshviewer,4pi,m-swapped\n--axes\n+x+z-y",
    "arguments/program.argv": "project\nbare.txt\n-o\n-\n--format\nglsl\n--convention\nunity\n--input-convention\nambix,z-up",
    "arguments/report.argv": "report\ngreen\n--quick\n--budget\n9.5\n--methods\nbest,jittered\n--seed\n3",
    "arguments/help.argv": "screenshot\n--help",
    "arguments/keys.argv": "--list-keys",
}

REFUSED = ("light/complex.npy",)
"""Bare seeds are read in our own convention, which is wrong for this one; their mutants are read in many."""


@cache
def seeds() -> dict[str, bytes]:
    """Name -> bytes."""
    texts = {name: text.encode() for name, text in SEEDS.items()}
    return {**texts, **_scenes(), **_written(), **_arrays(), **_reports(), **_stamps(), **_references()}


def _scenes() -> dict[str, bytes]:
    return {
        f"light/{name}.toml": (resource_folder("assets") / f"scenes/{name}.toml").read_bytes() for name in ("green",)
    }


def _written() -> dict[str, bytes]:
    """What `shviewer project` writes: every format, and conventions whose numbers look different."""
    projected = project_recipe(Recipe("green", n_bands=3))
    files = {f"light/written.{kind}": projected.encode(CONVENTIONS["shviewer"], kind) for kind in FORMATS}
    files |= {
        f"light/complex.{kind}": projected.encode(CONVENTIONS["scipy"], kind)
        for kind in FORMATS
        if kind not in ("glsl", "hlsl")
    }
    irradiance = replace(CONVENTIONS["shviewer"], quantity="irradiance")
    encoded, cube = (
        project_recipe(Recipe("green", quantity="irradiance", n_bands=n_bands), name)
        for name, n_bands in (("zh3", 3), ("ambient-cube", 32))
    )
    return {
        **files,
        "light/filament.json": projected.encode(CONVENTIONS["filament"], "json"),
        "light/irradiance.csv": projected.encode(irradiance, "csv"),
        "compare/written.npz": files["light/written.npz"],
        **{f"light/zh3.{kind}": encoded.encode(CONVENTIONS["shviewer"], kind) for kind in ("json", "csv", "npz")},
        "compare/cube.json": cube.encode(CONVENTIONS["shviewer"], "json"),
    }


def _arrays() -> dict[str, bytes]:
    def saved(**arrays: np.ndarray) -> bytes:
        file = io.BytesIO()
        np.savez_compressed(file, **arrays)
        return file.getvalue()

    def single(array: np.ndarray) -> bytes:
        file = io.BytesIO()
        np.save(file, array)
        return file.getvalue()

    return {
        "light/single.npy": single(_ROWS),
        "light/half.npy": single(_ROWS.astype(">f2")),
        "light/complex.npy": single(_ROWS + 0j),
        "light/image.npy": single(np.linspace(0, 4, 96, dtype=np.float32).reshape(4, 8, 3)),
        "light/cilm.npy": single(_CILM),
        "compare/cilm.npy": single(_CILM),
        "light/planar.npy": single(np.asfortranarray(_ROWS.T)),
        "light/deflated.npz": saved(coefficients=_ROWS, other=np.arange(3)),
    }


def _reports() -> dict[str, bytes]:
    rows = [
        Row(section="projection", method="jittered", light="green", n_bands=n, samples=100, milliseconds=n / 7,
            low_quartile=0.1, high_quartile=3.0, repeats=5, error=0.01 * n, error_low=0.001, error_high=0.1)
        for n in (2, 5)
    ]  # fmt: skip
    rows.append(Row(section="reconstruction", method="direct", note="not measured"))
    report = Report(1, "shviewer report", {"processor": "any", "cores": 2}, {"numpy": "2"}, "GL", rows, complete=True)
    report.yardstick_milliseconds = {"median": 2.0, "low_quartile": 1.9, "high_quartile": 2.2}
    report.lights = {"green": LightRecord("lobes", "closed form", 0.0, {"0.05": 15}, [0.9, 0.1])}
    return {"against/report.json": report.as_json().encode()}


def _stamps() -> dict[str, bytes]:
    plain, busy = picture_of(), picture_of(error="relative", error_range=0.2, muted=frozenset({1}), basis=(2, 1))
    texts = {name: metadata(picture, frame_of(picture), "GL") for name, picture in (("plain", plain), ("busy", busy))}
    return {f"stamp/{name}.json": text.encode() for name, text in texts.items()}


def _references() -> dict[str, bytes]:
    codes = np.random.default_rng(3).integers(0, 256, (8, 12, 3)).astype(np.uint8)
    kinds = {"picture.png": "PNG", "picture.jpg": "JPEG", "picture.webp": "WEBP", "picture.bmp": "BMP"}
    images = ("deep.png", "grey.png", "animated.png", "progressive.jpg")
    return {
        **{f"reference/{name}": saved_by_pillow(codes, kind) for name, kind in kinds.items()},
        **{f"reference/{name}": image_seeds()[name] for name in images},
    }
