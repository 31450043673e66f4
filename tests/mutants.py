"""Breaks the mathematics on purpose and shows what notices: python tests/mutants.py [--stability] [NAME ...]

The mutants are the misprints of the paper and the usual bugs of the field. Each is one replacement in a copy of the tree. There
the tests of the mathematics run until the first failure, and `shviewer report --stability` as a user runs it; --stability
leaves the tests out. Exit 1 if one survives the tests, or if more than a tenth survive the report.
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
    """A file, or a folder one of whose files holds the line."""
    right: str
    wrong: str


BASIS, PROJECTION = "shviewer/harmonics/basis.py", "shviewer/harmonics/projection.py"
SCATTERED, QUADRATURE = "shviewer/harmonics/scattered.py", "shviewer/harmonics/quadrature.py"
METRICS, EXTREMES = "shviewer/harmonics/metrics.py", "shviewer/harmonics"
FILTERS, ZONAL = "shviewer/harmonics/filters.py", "shviewer/harmonics/zonal.py"
OVERLAP, CONVENTION = "shviewer/harmonics/overlap.py", "shviewer/coefficients/convention.py"

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
        "samples in the middle of their cells", QUADRATURE, "[:, None] + jitter[0]) / side", "[:, None] + 0.5) / side"
    ),
    Mutant("one random number for both coordinates", QUADRATURE, "+ jitter[1]) / side", "+ jitter[0]) / side"),
    Mutant(
        "samples of another cell",
        QUADRATURE,
        "v = (np.arange(side) + jitter[1])",
        "v = (np.arange(side) + 2 * jitter[1])",
    ),
    Mutant(
        "negative area of rows that all count alike", EXTREMES, "axis=1) @ self.row_share)", "axis=1).mean() / 192)"
    ),
    Mutant(
        "one round of search", "shviewer/harmonics/extremes/climbing.py", "DISPLAY_ROUNDS = 3", "DISPLAY_ROUNDS = 1"
    ),
    Mutant(
        "bends of a tenth of the height",
        "shviewer/harmonics/extremes/waves.py",
        "self.reach**2 / 4",
        "self.reach**2 / 40",
    ),
    Mutant("energy below zero over 4 pi", EXTREMES, "4 * np.pi * float(squares) / whole", "float(squares) / whole"),
    Mutant("luminance of Rec. 601", EXTREMES, "[0.2126, 0.7152, 0.0722]", "[0.299, 0.587, 0.114]"),
    Mutant("PSNR of the peak", METRICS, "np.log10(peak**2 / mean)", "np.log10(peak / mean)"),
    Mutant("PSNR without the channels", METRICS, "(4 * np.pi * mix.shape[1])", "(4 * np.pi)"),
    Mutant(
        "nothing added by windows and samples",
        METRICS,
        "(norm - kept).clip(min=0) + added) / norm",
        "(norm - kept).clip(min=0)) / norm",
    ),
    Mutant("muted bands are the ones on", METRICS, "invert=True", "invert=False"),
    Mutant(
        "Hann over half a period",
        FILTERS,
        "(1 + np.cos(np.pi * np.minimum(x, 1))) / 2",
        "np.cos(np.pi / 2 * np.minimum(x, 1))",
    ),
    Mutant("Lanczos squared", FILTERS, "np.sinc(x), 0.0", "np.sinc(x) ** 2, 0.0"),
    Mutant("Gauss without its 2", FILTERS, "((np.pi * x) ** 2) / 2", "((np.pi * x) ** 2)"),
    Mutant("edge of a clamped line", ZONAL, "np.pi / 3 * (2 + edge)", "np.pi / 3 * (2 - edge)"),
    Mutant("Bessel ratio one degree off", ZONAL, "ratio = 1 / ((2 * l + 1) / k", "ratio = 1 / ((2 * l - 1) / k"),
    Mutant("half a solid angle", ZONAL, "zonal[0] = 2 * np.pi * versine", "zonal[0] = np.pi * versine"),
    Mutant("Gaussians of a wrong chord", OVERLAP, "4 * k1 * k2 * np.sin", "2 * k1 * k2 * np.sin"),
    Mutant("ring of a cosine", OVERLAP, "rise * half_arc - swing", "rise * half_arc + swing"),
    Mutant("another spiral", QUADRATURE, "(np.sqrt(5) - 1) / 2", "(np.sqrt(3) - 1) / 2"),
    Mutant("Gauss-Legendre weights not squared", QUADRATURE, "weights = 2 / slope**2", "weights = 2 / np.abs(slope)"),
    Mutant(
        "SN3D the other way",
        CONVENTION,
        "np.sqrt(4 * np.pi / (2 * degrees(n_bands) + 1))",
        "np.sqrt(4 * np.pi * (2 * degrees(n_bands) + 1))",
    ),
    Mutant("3z^2-1 without its half", CONVENTION, "2.0, 1.0, 0.5, 1.0, 1.0", "2.0, 1.0, 1.0, 1.0, 1.0"),
    Mutant(
        "handedness by order",
        "shviewer/coefficients/axes.py",
        "turned * alternating(degrees(n_bands))  #",
        "turned * alternating(orders(n_bands))  #",
    ),
    Mutant(
        "quarters the other way",
        "shviewer/coefficients/axes.py",
        "(1, 0), (0, 1), (-1, 0), (0, -1)]",
        "(1, 0), (0, -1), (-1, 0), (0, 1)]",
    ),
    Mutant(
        "front face mirrored",
        "shviewer/lights/layouts/cube.py",
        '("+x", "-y", "-z"), ("-y"',
        '("+x", "+y", "-z"), ("-y"',
    ),
    Mutant(
        "cube texels weighed at their centres",
        "shviewer/lights/layouts/cube.py",
        "leggauss(12 if self.face < 16 else 6)",
        "leggauss(1)",
    ),
    Mutant(
        "bilinear shares swapped",
        "shviewer/lights/layouts/bilinear.py",
        "up * right, down * (1 - right)",
        "down * (1 - right), up * right",
    ),
    Mutant("map read half a column off", "shviewer/lights/lat_long.py", "shape[1] - 0.5)", "shape[1])"),
    Mutant(
        "rows weighed at their centres",
        "shviewer/lights/layouts/lat_long.py",
        "2 * np.sin(row_angles(self.height)) * np.sin(np.pi / (2 * self.height))",
        "np.sin(row_angles(self.height)) * np.pi / self.height",
    ),
    Mutant(
        "deringing on the grid alone",
        "shviewer/harmonics/deringing.py",
        "    factors[1:] *= 1 - lift",
        "    factors[1:] *= 1",
    ),
)


def texts(mutant: Mutant, tree: Path) -> dict[Path, str]:
    """The files of a tree that a mutant may be in, with their texts."""
    place = tree / mutant.file
    return {path: path.read_text(encoding="utf-8") for path in (place.rglob("*.py") if place.is_dir() else [place])}


def mutated(mutant: Mutant, tree: Path) -> None:
    files = texts(mutant, tree)
    times = sum(text.count(mutant.right) for text in files.values())
    if times != 1:
        raise SystemExit(f"{mutant.name}: {mutant.file} holds its line {times} times, not once")
    for path, text in files.items():
        path.write_text(text.replace(mutant.right, mutant.wrong), encoding="utf-8")


def noticed_by(mutant: Mutant, folder: Path, tests: bool) -> tuple[str, str]:
    """The first test and the first hard case that fail on the mutant; "" where none does, or "-" for tests not run."""
    tree = folder / "tree"
    shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(".*", "__pycache__"))
    try:
        mutated(mutant, tree)
        test = "-"
        if tests:
            done = run(tree, "-m", "pytest", "-x", "-q", "-n", "0", "-p", "no:cacheprovider", *TESTS)
            failed = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, flags=re.MULTILINE)
            test = failed[1].rpartition("::")[2] if failed else "" if done.returncode == 0 else done.stdout[-300:]
        done = run(tree, "-m", "shviewer", "report", "--stability")
        first = re.search(r"^FAIL +(.+?)  ", done.stdout, flags=re.MULTILINE)
        case = first[1] if first else done.stderr[-300:]
        return test, case if done.returncode == 1 else ""
    finally:
        shutil.rmtree(tree)


def run(tree: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = {"PYTHONPATH": str(tree), "PATH": ""}
    return subprocess.run(
        [sys.executable, *arguments], cwd=tree, env=environment, capture_output=True, text=True, check=False
    )


def main(arguments: list[str]) -> int:
    names = [name for name in arguments if name != "--stability"]
    chosen = [mutant for mutant in MUTANTS if not names or mutant.name in names]
    missed = [0, 0]
    with tempfile.TemporaryDirectory() as folder:
        for mutant in chosen:
            found = noticed_by(mutant, Path(folder), "--stability" not in arguments)
            missed = [count + (not name) for count, name in zip(missed, found, strict=True)]
            test, case = (name or "SURVIVED" for name in found)
            print(f"{mutant.name:<48}{test:<60}  {case}", flush=True)
    print(f"{len(chosen)} mutants: the tests miss {missed[0]}, the hard cases {missed[1]}")
    return 1 if missed[0] or missed[1] > len(chosen) / 10 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
