"""Write tests/data/peer_values.json: values of the basis functions of programs that are not installed with the tests.

    python tests/coefficients/peer_values.py DIRECTXMATH E3NN

in an environment with numpy, spharpy and mitsuba. DIRECTXMATH is a checkout of Microsoft's DirectXMath, whose SHMath is
compiled (g++); E3NN is a folder with the unpacked package e3nn, whose polynomials are run on NumPy in place of torch.
Directions are in each program's own axes.
"""

from __future__ import annotations

import ast
import json
import math
import re
import subprocess
import sys
import tempfile
import types
from pathlib import Path

import numpy as np

N_BANDS = 6
OUT = Path(__file__).parents[1] / "data" / "peer_values.json"

MAIN = """
#include <cstdint>
#include <cstdio>
#include "DirectXSH.h"
int main() {
    float x, y, z, sh[36];
    while (scanf("%f %f %f", &x, &y, &z) == 3) {
        DirectX::XMSHEvalDirection(sh, 6, DirectX::XMVectorSet(x, y, z, 0));
        for (float value : sh) printf("%.9g ", value);
    }
}
"""
ANNOTATIONS = (
    "_In_ _In_opt_ _Out_ _Out_opt_ _Inout_ _Outptr_ _Use_decl_annotations_ _In_reads_(x) _In_reads_bytes_(x) _Out_writes_(x) "
    "_Out_writes_opt_(x) _Out_writes_bytes_(x) _Analysis_assume_(x) _Success_(x) _In_range_(x,y)"
)


def directxmath(checkout: Path, directions: np.ndarray) -> np.ndarray:
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        (work / "sal.h").write_text("".join(f"#define {name}\n" for name in ANNOTATIONS.split()))
        (work / "main.cpp").write_text(MAIN)
        includes = [f"-I{place}" for place in (work, checkout / "Inc", checkout / "SHMath")]
        sources = [str(work / "main.cpp"), str(checkout / "SHMath" / "DirectXSH.cpp")]
        command = [
            "g++",
            "-std=c++17",
            "-O1",
            "-w",
            "-D_XM_NO_INTRINSICS_",
            *includes,
            *sources,
            "-o",
            str(work / "run"),
        ]
        subprocess.run(command, check=True)
        given = "\n".join(" ".join(map(repr, row)) for row in directions.tolist())
        printed = subprocess.run([work / "run"], input=given, text=True, capture_output=True, check=True).stdout
    return np.array(printed.split(), dtype=float).reshape(len(directions), -1)


class Tensor(np.ndarray):
    """As much of torch.Tensor as these polynomials use."""

    def pow(self, exponent: float) -> Tensor:
        return self**exponent


def e3nn(folder: Path, directions: np.ndarray) -> np.ndarray:
    """o3.spherical_harmonics(..., normalization="integral"): its polynomials over sqrt(4 pi)."""
    tree = ast.parse((folder / "e3nn" / "o3" / "_spherical_harmonics.py").read_text())
    function = next(
        node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == "_spherical_harmonics"
    )
    function.decorator_list.clear()
    torch = types.SimpleNamespace(
        Tensor=Tensor, ones_like=np.ones_like, stack=lambda parts, dim: np.stack(parts, axis=dim)
    )
    names = {"torch": torch, "math": math}
    exec(compile(ast.Module([function], []), "e3nn", "exec"), names)
    values = names["_spherical_harmonics"](N_BANDS - 1, *directions.T.copy().view(Tensor))
    return np.asarray(values) / math.sqrt(4 * math.pi)


def mitsuba(directions: np.ndarray) -> np.ndarray:
    import drjit
    import mitsuba

    mitsuba.set_variant("scalar_rgb")
    return np.array([[float(v) for v in drjit.sh_eval(mitsuba.Vector3d(*row), N_BANDS - 1)] for row in directions])


def spharpy(directions: np.ndarray) -> np.ndarray:
    import spharpy
    from pyfar import Coordinates

    return np.real(spharpy.SphericalHarmonics(N_BANDS - 1, Coordinates(*directions.T)).basis)


def main() -> None:
    from importlib.metadata import version

    checkout, package = Path(sys.argv[1]), Path(sys.argv[2])
    directions = np.random.default_rng(3).normal(size=(4, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    (info,) = package.glob("e3nn-*.dist-info/METADATA")
    header = (checkout / "Inc" / "DirectXMath.h").read_text()
    programs = {
        "directxmath": (re.findall(r"DIRECTX_MATH_VERSION (\d+)", header)[0], directxmath(checkout, directions)),
        "e3nn": (re.findall(r"^Version: (.*)$", info.read_text(), re.MULTILINE)[0], e3nn(package, directions)),
        "mitsuba": (version("mitsuba"), mitsuba(directions)),
        "spharpy": (version("spharpy"), spharpy(directions)),
    }
    found = {
        "directions": directions.tolist(),
        "programs": {
            name: {"version": release, "values": [[float(f"{x:.10g}") for x in row] for row in values.tolist()]}
            for name, (release, values) in programs.items()
        },
    }
    text = json.dumps(found, indent=1)
    OUT.write_text(re.sub(r"\n +(?=[-\d\]])", " ", text) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
