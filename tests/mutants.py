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


BROKEN: dict[str, tuple[tuple[str, str, str], ...]] = {
    "harmonics/evaluation/recurrence.py": (
        ("recurrence without (l-m)", "(l + np.arange(len(ratio)))", "(l + 0 * np.arange(len(ratio)))"),
        ("wrong double factorial", "-np.sqrt((2 * m + 1) / (2 * m))", "-np.sqrt((2 * m - 1) / (2 * m))"),
        (
            "missing sin^m",
            "np.multiply(x, south, out=real[1])",
            "np.divide(x * south, np.maximum(np.hypot(x, y), 1e-300), out=real[1])",
        ),
        (
            "K of signed m",
            "np.multiply(row[:0:-1], imaginary[l:0:-1]",
            "np.multiply(row[:0:-1] / norms[l, l:0:-1, None] ** 2, imaginary[l:0:-1]",
        ),
        ("no sqrt(2)", "(np.sqrt(2) if m else 1)", "1"),
        ("no 2l+1", "np.sqrt((2 * l + 1) * (l + m) / ((2 * l - 1) * (l - m)))", "np.sqrt((l + m) / (l - m))"),
        (
            "last band dropped",
            "        for l in range(self.n_bands):\n",
            "        table[:] = 0\n        for l in range(self.n_bands - 1):\n",
        ),
        ("no Condon-Shortley phase", "sectoral *= -np.sqrt", "sectoral *= np.sqrt"),
        ("sign of the sine", "imaginary[l] += turned[0]", "imaginary[l] -= turned[0]"),
        (
            "m and -m swapped",
            "np.multiply(row, real[: l + 1], out=",
            "np.multiply(row, np.concatenate([real[:1], imaginary[1 : l + 1]]), out=",
        ),
    ),
    "harmonics/metrics.py": (
        (
            "sum to n^2",
            "np.arange(count_bands(coefficients)) ** 2",
            "np.arange(1, count_bands(coefficients) + 1) ** 2 - 1",
        ),
        ("squares instead of products of halves", "(first * second).sum(axis=1)", "(first * first).sum(axis=1)"),
        ("PSNR of the peak", "np.log10(peak**2 / mean)", "np.log10(peak / mean)"),
        ("PSNR without the channels", "(4 * np.pi * mix.shape[1])", "(4 * np.pi)"),
        (
            "nothing added by windows and samples",
            "(norm - kept).clip(min=0) + added) / norm",
            "(norm - kept).clip(min=0)) / norm",
        ),
        ("muted bands are the ones on", "invert=True", "invert=False"),
    ),
    "harmonics/projection/scattered.py": (
        ("divide by the weight", "np.multiply(values.T, weights, out=", "np.divide(values.T, weights, out="),
        (
            "float32 accumulation",
            "self.sums = np.zeros((2 * n_bands, 3 * n_bands))",
            "self.sums = np.zeros((2 * n_bands, 3 * n_bands), np.float32)",
        ),
        (
            "samples of the south as if in the north",
            "np.multiply(self.values[0], self.waves.south(), out=self.values[1])",
            "self.values[1] = self.values[0]",
        ),
        ("last block filled up with the one before", "self.values[0, :, len(directions) :] = 0", "pass"),
    ),
    "harmonics/evaluation/monomials.py": (
        (
            "directions of many are taken as they are",
            "if not self._take(directions, table[1:4]):",
            "if self._take(directions, table[1:4]) is None:",
        ),
        (
            "x^2 + y^2 + z^2 without z",
            "np.roll(before, 2, axis=0) + np.roll(before, 2, axis=1)",
            "np.roll(before, 2, axis=0)",
        ),
        ("rows of monomials times Y, not over its factor", "(factor * SCALE ** (2 * q))", "SCALE ** (2 * q)"),
        ("y^2 in the wrong monomials", "(old[-q:], z, new[count:-1])", "(old[:q], z, new[count:-1])"),
    ),
    "harmonics/evaluation/products.py": (
        ("T(k) of |z| in the south", "chebyshev[1::2] *= self.waves.south()", "pass"),
        ("last block not full", "min(start, count - size)", "start"),
    ),
    "harmonics/evaluation/waves.py": (
        ("T(k) counted once for sin(k theta)/sin(theta)", "    odd[..., 0] /= 2\n", "    odd[..., 1:] /= 2\n"),
    ),
    "harmonics/areas/ball.py": (("edges that do not end at the rim", "np.minimum(x, rho)", "np.minimum(x, 2 * rho)"),),
    "harmonics/areas/boundary.py": (
        ("no area around the pole", "areas[::2] -= sums", "areas[::2] -= 0 * sums"),
        ("no linear term", "areas[1::2, ..., 1] += sums", "areas[1::2, ..., 1] += 0 * sums"),
    ),
    "harmonics/areas/cycling.py": (
        ("turned about y alone", "((-1j) ** (m % 4))", "(1.0 ** (m % 4))"),
        ("m = 0 counted as often as others", "real[1:] *= np.sqrt(2)", "real *= np.sqrt(2)"),
    ),
    "harmonics/quadrature.py": (
        (
            "4 pi/N on a theta grid",
            "    radius = 2 * np.sqrt(u * (1 - u))",
            "    u = np.sin(np.pi * u / 2) ** 2\n    radius = 2 * np.sqrt(u * (1 - u))",
        ),
        ("Fejer's last cosine", "np.arange(1, rows // 2 + 1)", "np.arange(1, rows // 2)"),
        (
            "image mirrored",
            "np.pi * (1 - (2 * np.arange(n_columns) + 1) / n_columns)",
            "np.pi * ((2 * np.arange(n_columns) + 1) / n_columns - 1)",
        ),
        ("samples in the middle of their cells", "[:, None] + jitter[0]) / side", "[:, None] + 0.5) / side"),
        ("one random number for both coordinates", "+ jitter[1]) / side", "+ jitter[0]) / side"),
        ("samples of another cell", "v = (np.arange(side) + jitter[1])", "v = (np.arange(side) + 2 * jitter[1])"),
        ("another spiral", "(np.sqrt(5) - 1) / 2", "(np.sqrt(3) - 1) / 2"),
        ("Gauss-Legendre weights not squared", "weights = 2 / slope**2", "weights = 2 / np.abs(slope)"),
    ),
    "harmonics/projection/rows.py": (
        ("missing sin(theta)", "(sines[2:] - sines[:-2]) / 2", "cosines[1:-1] * 1.0"),
        ("half a texel off", "(np.arange((height + 1) // 2) + 0.5)", "(np.arange((height + 1) // 2) + 0.0)"),
        ("image upside down", "row_sums(image, ", "row_sums(image[::-1], "),
        ("east folded like west", "west + east if mirrored else west - east", "west + east"),
        ("texels as points", "np.sinc(np.arange(n_bands) / width)", "1.0"),
    ),
    "harmonics/projection/row_transform.py": (
        (
            "south folded with the sign of the north",
            "((0, even), (1, odd), (0, odd), (1, even))",
            "((0, even), (1, even), (0, odd), (1, odd))",
        ),
    ),
    "harmonics/sampling/spread.py": (
        ("waves not over those of the bump", "function(along) / wave[order, None]", "function(along)"),
    ),
    "harmonics/theta_series.py": (
        ("k = 0 counted whole where no table is", "np.where(k == 0, 0.5, 1.0)", "np.where(k == 0, 1.0, 1.0)"),
    ),
    "harmonics/synthesis.py": (("m = 0 halved in a row", "np.where(first > 0, 2, 1)", "np.where(first > 0, 2, 2)"),),
    "coefficients/convention.py": (
        (
            "phase kept for programs without",
            "            found = found * alternating(orders(n_bands))\n        found = found * self",
            "            found = found * 1.0\n        found = found * self",
        ),
        (
            "rows in the inverse order",
            "self.factor * found[self.rows(n_bands)]",
            "self.factor * found[np.argsort(self.rows(n_bands))]",
        ),
        ("the mean not shifted", "found[0] -= self._shift", "found[0] -= 0"),
    ),
    "coefficients/parts/quantities.py": (
        ("1/pi forgotten", "np.pi if is_over_pi(held) else 1 / np.pi", "np.pi if is_over_pi(held) else 1"),
    ),
    "coefficients/parts/scales.py": (
        (
            "SN3D the other way",
            "np.sqrt(4 * np.pi / (2 * degrees(n_bands) + 1))",
            "np.sqrt(4 * np.pi * (2 * degrees(n_bands) + 1))",
        ),
        ("3z^2-1 without its half", "2.0, 1.0, 0.5, 1.0, 1.0", "2.0, 1.0, 1.0, 1.0, 1.0"),
    ),
    "coefficients/parts/axes.py": (
        ("axes the other way", "rotate(turned, matrix)", "rotate(turned, matrix.T)"),
        (
            "handedness by order",
            "turned * alternating(degrees(n_bands))  #",
            "turned * alternating(orders(n_bands))  #",
        ),
        ("quarters the other way", "(1, 0), (0, 1), (-1, 0), (0, -1)]", "(1, 0), (0, -1), (-1, 0), (0, 1)]"),
    ),
    "harmonics/rotation.py": (
        ("rotation the other way", "quarter.T if back else quarter", "quarter if back else quarter.T"),
    ),
    "harmonics/zonal.py": (
        ("irradiance of the wrong sign at l = 4", "ratio if z >= 0 or (l + m) % 2 == 0 else -ratio", "abs(ratio)"),
        ("edge of a clamped line", "np.pi / 3 * (2 + edge)", "np.pi / 3 * (2 - edge)"),
        ("Bessel ratio one degree off", "ratio = 1 / ((2 * l + 1) / k", "ratio = 1 / ((2 * l - 1) / k"),
        ("half a solid angle", "zonal[0] = 2 * np.pi * versine", "zonal[0] = np.pi * versine"),
    ),
    "harmonics": (
        ("negative area of rows that all count alike", "axis=1) @ (z[:-1] - z[1:])", "axis=1).sum() * 2 / len(theta)"),
        ("energy below zero over 4 pi", "4 * np.pi * float(squares) / whole", "float(squares) / whole"),
        ("luminance of Rec. 601", "[0.2126, 0.7152, 0.0722]", "[0.299, 0.587, 0.114]"),
    ),
    "harmonics/extremes/climbing.py": (("one round of search", "DISPLAY_ROUNDS = 3", "DISPLAY_ROUNDS = 1"),),
    "harmonics/extremes/both_sides.py": (("the lowest error alone", "for sign in (1, -1)", "for sign in (1, 1)"),),
    "harmonics/extremes/band_limited.py": (
        ("bends of a tenth of the height", "self.moved(2) / 4", "self.moved(2) / 40"),
        ("cells above an open row left out", "beside[1:] |= rows", "pass"),
        ("bends above taken for those below", "np.multiply(seconds, sign, out=seconds)", "seconds"),
    ),
    "harmonics/filters.py": (
        (
            "Hann over half a period",
            "(1 + np.cos(np.pi * np.minimum(x, 1))) / 2",
            "np.cos(np.pi / 2 * np.minimum(x, 1))",
        ),
        ("Lanczos squared", "np.sinc(x), 0.0", "np.sinc(x) ** 2, 0.0"),
        ("Gauss without its 2", "((np.pi * x) ** 2) / 2", "((np.pi * x) ** 2)"),
    ),
    "harmonics/overlap.py": (
        ("Gaussians of a wrong chord", "4 * k1 * k2 * np.sin", "2 * k1 * k2 * np.sin"),
        ("ring of a cosine", "rise * half_arc - swing", "rise * half_arc + swing"),
    ),
    "lights/layouts/arrangements.py": (
        ("front face mirrored", '("+x", "-y", "-z"), ("-y"', '("+x", "+y", "-z"), ("-y"'),
    ),
    "lights/layouts/cube.py": (
        ("cube texels weighed at their centres", "leggauss(12 if self.face < 16 else 6)", "leggauss(1)"),
    ),
    "lights/layouts/bilinear.py": (
        ("bilinear shares swapped", "up * right, down * (1 - right)", "down * (1 - right), up * right"),
    ),
    "lights/lat_long.py": (("map read half a column off", "shape[1] - 0.5)", "shape[1])"),),
    "lights/layouts/lat_long.py": (
        (
            "rows weighed at their centres",
            "2 * np.sin(row_angles(self.height)) * np.sin(np.pi / (2 * self.height))",
            "np.sin(row_angles(self.height)) * np.pi / self.height",
        ),
    ),
    "harmonics/deringing.py": (("deringing on the grid alone", "    factors[1:] *= 1 - lift", "    factors[1:] *= 1"),),
}
"""File or folder of shviewer/ -> what a mutant is called, the right line and the wrong one."""

MUTANTS = tuple(
    Mutant(name, f"shviewer/{file}", right, wrong) for file, rows in BROKEN.items() for name, right, wrong in rows
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
