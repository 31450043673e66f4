"""What to type: the line of code that hands a file's numbers to its program, in the program's own language.

In the lines `rows` stands for the rows of the file, each red, green, blue. Other names are what the program calls such a thing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.stamp import Value
from shviewer.coefficients.table import Table
from shviewer.harmonics.basis import count_bands


class Use(NamedTuple):
    """A line of code. `{rows}`, `{bands}` and `{count}` stand for the table, n and n**2."""

    line: str
    language: str
    takes: tuple[str, ...] = ()
    """What it needs beside the rows, in JavaScript."""


JAVASCRIPT, PYTHON, CPP, CSHARP, GDSCRIPT = "js", "py", "c++", "cs", "gdscript"

USES = {
    "shviewer": Use("shviewer.find_light(path_of_this_file)", PYTHON),
    "filament": Use(
        "Filament.IndirectLight.Builder().irradianceSh({bands}, {rows}.flat()).build(engine)",
        JAVASCRIPT,
        ("Filament", "engine"),
    ),
    "three": Use("probe.sh.fromArray({rows}.flat())", JAVASCRIPT, ("probe",)),
    "unity": Use(
        "for (int i = 0; i < 9; i++) for (int c = 0; c < 3; c++) sh[c, i] = (float)rows[i][c]; "
        "RenderSettings.ambientProbe = sh;",
        CSHARP,
    ),
    "unreal": Use(
        "for (int32 i = 0; i < 9; ++i) {{ SH.R.V[i] = {rows}[i][0]; SH.G.V[i] = {rows}[i][1]; SH.B.V[i] = {rows}[i][2]; }}",
        CPP,
    ),
    "ambix": Use("channels = {rows}[:, 0]  # ACN; red: a bus of its own for each colour", PYTHON),
    "sphericart": Use("sphericart.SphericalHarmonics({bands} - 1).compute(directions) @ {rows}", PYTHON),
    "scipy": Use(
        "sum(c * sph_harm_y(l, m, theta, phi) for c, (l, m) in zip({rows}[:, 0] + 1j * {rows}[:, 1], "
        "((l, m) for l in range({bands}) for m in range(-l, l + 1)))).real  # red",
        PYTHON,
    ),
    "babylon": Use(
        "texture.sphericalPolynomial = BABYLON.SphericalPolynomial.FromHarmonics("
        "BABYLON.SphericalHarmonics.FromArray({rows}))",
        JAVASCRIPT,
        ("BABYLON", "texture"),
    ),
    "playcanvas": Use("material.ambientSH = new Float32Array({rows}.flat())", JAVASCRIPT, ("material",)),
    "cesium": Use(
        "model.imageBasedLighting.sphericalHarmonicCoefficients = {rows}.map((row) => new Cesium.Cartesian3(...row))",
        JAVASCRIPT,
        ("Cesium", "model"),
    ),
    "gltf": Use(
        "gltf.extensions.EXT_lights_image_based.lights[0].irradianceCoefficients = {rows}", JAVASCRIPT, ("gltf",)
    ),
    "godot": Use(
        "var data = lightmap.probe_data; data.sh = PackedColorArray(rows.map(func(row): return Color(row[0], row[1], "
        "row[2]))); lightmap.probe_data = data",
        GDSCRIPT,
    ),
    "3dgs": Use("f_dc, f_rest = {rows}[0], {rows}[1:].T.ravel()", PYTHON),
    "directxmath": Use(
        "for (size_t i = 0; i < {count}; ++i) red[i] = float({rows}[i][0]); XMSHEvalDirection(basis, {bands}, direction); "
        "float value = XMSHDot({bands}, basis, red);",
        CPP,
    ),
    "e3nn": Use(
        'o3.spherical_harmonics(list(range({bands})), xyz, normalize=True, normalization="integral") @ torch.tensor({rows})',
        PYTHON,
    ),
    "shtools": Use("pyshtools.SHCoeffs.from_array(pyshtools.shio.SHVectorToCilm({rows}[:, 0]))  # red", PYTHON),
    "spharpy": Use("spharpy.SphericalHarmonics({bands} - 1, coordinates).basis @ {rows}", PYTHON),
    "fuma": Use("channels = {rows}[:, 0]  # W X Y Z R ...; red: a bus of its own for each colour", PYTHON),
    "mitsuba": Use(
        "sum(y * mitsuba.Color3f(row) for y, row in zip(drjit.sh_eval(direction, {bands} - 1), {rows}))", PYTHON
    ),
}
"""Program -> what to type. The others give numbers and take none."""

IN_CPP = {
    "filament": "filament::math::float3 sh[{count}]; for (int i = 0; i < {count}; ++i) sh[i] = {{float({rows}[i][0]), "
    "float({rows}[i][1]), float({rows}[i][2])}}; filament::IndirectLight::Builder().irradiance({bands}, sh).build(*engine);",
    "unreal": USES["unreal"].line,
    "directxmath": USES["directxmath"].line,
}
"""The same for the arrays of a header."""

_ROWS = {
    ("json", JAVASCRIPT): "json.coefficients",
    ("json", PYTHON): 'numpy.array(json["coefficients"])',
    ("npz", PYTHON): 'file["coefficients"]',
}
"""The rows in a file of a kind that was read by the usual means, as `json` or `file`."""


def use_of(convention: Convention, kind: str, n_bands: int, symbol: str, function: str) -> str:
    """What to type for a file of a kind; "" if nothing is to be.

    symbol: the name of the table in source code; function: that of the function in a shader, in whose words of GLSL it is told.
    """
    if kind in ("glsl", "hlsl"):
        return f"vec3 value = {function}(direction);"
    if kind == "cs" and convention.name == "unity":
        return f"RenderSettings.ambientProbe = {symbol}.Probe();"
    use, source = USES.get(convention.name), kind in ("h", "js", "cs")
    line = IN_CPP.get(convention.name, "") if kind == "h" else use.line if use else ""
    if not use or not line or (kind == "js" and use.language != JAVASCRIPT) or kind == "cs":
        return ""
    rows = symbol if source else _ROWS.get((kind, use.language), "rows")
    if convention.complex and kind == "npz":
        line = line.replace("{rows}[:, 0] + 1j * {rows}[:, 1]", "{rows}[:, 0]")
    return line.format(rows=rows, bands=n_bands, count=n_bands**2)


def unity_vectors(numbers: NDArray[np.generic]) -> dict[str, tuple[float, float, float, float]]:
    """The seven vectors of Unity's shaders, from sh[c, i] as PackCoefficients of HDRP has it. numbers: (9, 3)."""
    sh = np.asarray(numbers, dtype=np.float64).T
    found: dict[str, tuple[float, float, float, float]] = {}
    for channel, c in zip("rgb", sh.tolist(), strict=True):
        found[f"unity_SHA{channel}"] = (c[3], c[1], c[2], c[0] - c[6])
    for channel, c in zip("rgb", sh.tolist(), strict=True):
        found[f"unity_SHB{channel}"] = (c[4], c[5], 3 * c[6], c[7])
    return found | {"unity_SHC": (float(sh[0, 8]), float(sh[1, 8]), float(sh[2, 8]), 1.0)}


def with_use(table: Table, kind: str) -> Table:
    """A table of coefficients with what to type after `layout`, and for Unity its vectors."""
    added: dict[str, Value] = {}
    if line := use_of(table.convention, kind, count_bands(table.numbers), table.symbol, table.function):
        added["use"] = line
    if table.convention.name == "unity":
        vectors = unity_vectors(table.numbers).items()
        added["unity-vectors"] = "; ".join(f"{name} = ({', '.join(map(repr, vector))})" for name, vector in vectors)
    return table.with_keys(added)
