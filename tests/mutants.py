"""Breaks the mathematics on purpose and shows which test notices: python tests/mutants.py [NAME ...]

The mutants are the misprints of the paper and the usual bugs of the field. Each is one replacement in a copy of the tree, on
which the tests of the mathematics run until the first failure. Exit 1 if one survives.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
TESTS = ("tests/harmonics", "tests/coefficients", "tests/lights", "--ignore=tests/lights/images/test_radiance_files.py")


class Mutant(NamedTuple):
    name: str
    file: str
    right: str
    wrong: str


BASIS, PROJECTION = "shviewer/harmonics/basis.py", "shviewer/harmonics/projection.py"
SCATTERED = "shviewer/harmonics/scattered.py"

MUTANTS = (
    Mutant(
        "recurrence without (l-m)",
        BASIS,
        "((2 * l - 1) / (l + np.arange(l)))",
        "((2 * l - 1) / (l + 0 * np.arange(l)))",
    ),
    Mutant("wrong double factorial", BASIS, "-np.sqrt((2 * m + 1) / (2 * m))", "-np.sqrt((2 * m - 1) / (2 * m))"),
    Mutant(
        "missing sin^m",
        BASIS,
        "_azimuth_powers(south * x, south * y, n_bands)",
        "_azimuth_powers(*(south * np.array([x, y]) / np.maximum(np.hypot(x, y), 1e-300)), n_bands)",
    ),
    Mutant(
        "K of signed m",
        BASIS,
        "np.multiply(row[:0:-1], sines[l:0:-1]",
        "np.multiply(row[:0:-1] / norms[l, l:0:-1, None] ** 2, sines[l:0:-1]",
    ),
    Mutant("no sqrt(2)", BASIS, "(np.sqrt(2) if m else 1)", "1"),
    Mutant("no 2l+1", BASIS, "np.sqrt((2 * l + 1) * (l + m) / ((2 * l - 1) * (l - m)))", "np.sqrt((l + m) / (l - m))"),
    Mutant(
        "sum to n^2",
        "shviewer/harmonics/metrics.py",
        "np.arange(count_bands(coefficients)) ** 2",
        "np.arange(1, count_bands(coefficients) + 1) ** 2 - 1",
    ),
    Mutant(
        "last band dropped",
        BASIS,
        "    for l in range(n_bands):\n        if l:",
        "    table[:] = 0\n    for l in range(n_bands - 1):\n        if l:",
    ),
    Mutant(
        "divide by the weight",
        SCATTERED,
        "np.multiply(values.T, weights, out=",
        "np.divide(values.T, weights, out=",
    ),
    Mutant(
        "4 pi/N on a theta grid",
        "shviewer/harmonics/quadrature.py",
        "    radius = 2 * np.sqrt(u * (1 - u))",
        "    u = np.sin(np.pi * u / 2) ** 2\n    radius = 2 * np.sqrt(u * (1 - u))",
    ),
    Mutant("missing sin(theta)", PROJECTION, "(sines[2:] - sines[:-2]) / 2", "cosines[1:-1] * 1.0"),
    Mutant("no Condon-Shortley phase", BASIS, "sectoral *= -np.sqrt", "sectoral *= np.sqrt"),
    Mutant(
        "sign of the sine", BASIS, "x * imaginary[m - 1] + y * real[m - 1]", "x * imaginary[m - 1] - y * real[m - 1]"
    ),
    Mutant(
        "m and -m swapped",
        BASIS,
        "    return real, imaginary\n",
        "    return imaginary + (np.arange(count) == 0)[:, None], real\n",
    ),
    Mutant(
        "float32 accumulation",
        SCATTERED,
        "self.sums = np.zeros((2 * n_bands, 3 * n_bands))",
        "self.sums = np.zeros((2 * n_bands, 3 * n_bands), np.float32)",
    ),
    Mutant(
        "samples of the south as if in the north",
        SCATTERED,
        "np.multiply(self.values[0], sign, out=self.values[1])",
        "self.values[1] = self.values[0]",
    ),
    Mutant("last block filled up with the one before", SCATTERED, "self.values[0, :, len(directions) :] = 0", "pass"),
    Mutant(
        "T(k) counted once for sin(k theta)/sin(theta)", SCATTERED, "    odd[..., 0] /= 2\n", "    odd[..., 1:] /= 2\n"
    ),
    Mutant(
        "Fejer's last cosine",
        "shviewer/harmonics/quadrature.py",
        "np.arange(1, rows // 2 + 1)",
        "np.arange(1, rows // 2)",
    ),
    Mutant(
        "half a texel off", PROJECTION, "(np.arange((height + 1) // 2) + 0.5)", "(np.arange((height + 1) // 2) + 0.0)"
    ),
    Mutant("image upside down", PROJECTION, "row_sums(image, ", "row_sums(image[::-1], "),
    Mutant(
        "south folded with the sign of the north",
        "shviewer/harmonics/row_transform.py",
        "(minus, plus) if parity else (plus, minus)",
        "(plus, minus) if parity else (minus, plus)",
    ),
    Mutant("east folded like west", PROJECTION, "west + east if mirrored else west - east", "west + east"),
    Mutant(
        "image mirrored",
        "shviewer/harmonics/quadrature.py",
        "np.pi * (1 - (2 * np.arange(n_columns) + 1) / n_columns)",
        "np.pi * ((2 * np.arange(n_columns) + 1) / n_columns - 1)",
    ),
    Mutant("texels as points", PROJECTION, "np.sinc(np.arange(n_bands) / width)", "1.0"),
    Mutant(
        "squares instead of products of halves",
        "shviewer/harmonics/metrics.py",
        "(first * second).sum(axis=1)",
        "(first * first).sum(axis=1)",
    ),
    Mutant(
        "phase kept for programs without",
        "shviewer/coefficients/convention.py",
        "            found = found * alternating(orders(n_bands))\n        found = found * SCALES",
        "            found = found * 1.0\n        found = found * SCALES",
    ),
    Mutant(
        "axes the other way",
        "shviewer/coefficients/axes.py",
        "rotate(turned, matrix)",
        "rotate(turned, matrix.T)",
    ),
    Mutant(
        "1/pi forgotten",
        "shviewer/coefficients/convention.py",
        "np.pi if held == OVER_PI else 1 / np.pi",
        "np.pi if held == OVER_PI else 1",
    ),
    Mutant(
        "rotation the other way", "shviewer/harmonics/rotation.py", "here @ matrix, n_bands", "here @ matrix.T, n_bands"
    ),
    Mutant(
        "irradiance of the wrong sign at l = 4",
        "shviewer/harmonics/zonal.py",
        "ratio if z >= 0 or (l + m) % 2 == 0 else -ratio",
        "abs(ratio)",
    ),
    Mutant(
        "deringing on the grid alone",
        "shviewer/harmonics/deringing.py",
        "    factors[1:] *= 1 - lift",
        "    factors[1:] *= 1",
    ),
)


def mutated(mutant: Mutant, tree: Path) -> None:
    path = tree / mutant.file
    text = path.read_text(encoding="utf-8")
    if text.count(mutant.right) != 1:
        raise SystemExit(f"{mutant.name}: {mutant.file} holds its line {text.count(mutant.right)} times, not once")
    path.write_text(text.replace(mutant.right, mutant.wrong), encoding="utf-8")


def killer(mutant: Mutant, folder: Path) -> str:
    """The first test that fails on the mutant; "" if none does."""
    tree = folder / "tree"
    shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(".*", "__pycache__"))
    try:
        mutated(mutant, tree)
        command = [sys.executable, "-m", "pytest", "-x", "-q", "-n", "0", "-p", "no:cacheprovider", *TESTS]
        done = subprocess.run(
            command, cwd=tree, env={"PYTHONPATH": str(tree), "PATH": ""}, capture_output=True, text=True, check=False
        )
        failed = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, flags=re.MULTILINE)
        return failed[1].rpartition("::")[2] if failed else "" if done.returncode == 0 else done.stdout[-300:]
    finally:
        shutil.rmtree(tree)


def main(names: list[str]) -> int:
    survivors = 0
    with tempfile.TemporaryDirectory() as folder:
        for mutant in MUTANTS:
            if names and mutant.name not in names:
                continue
            test = killer(mutant, Path(folder))
            survivors += not test
            print(f"{mutant.name:<48}{test or 'SURVIVED'}", flush=True)
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
