"""What a projection costs, against the peers: python tests/benchmarks/projection.py [--quick]

Every figure is CPU time of one thread, the median of interleaved runs, each the second of two in a row. All start from the same
image, interleaved RGB in float32, and end with the coefficients of three channels; what a peer has to copy or convert for that
is its own cost, its set-up and our tables are not counted (ours are printed). "x reading" is a multiple of reading the image
once (its sum).

Goals: at least 2 times faster than the fastest peer in float32 from 512 to 8192 columns, and in float64 from 1024 columns up to
32 bands; 4 times at 4096 x 2048 up to 16 bands, within 4 readings there up to 9 bands; the error within 2e-8 of the largest
coefficient, 1e-14 in float64; at most 64 MiB beside the image. Ours in float64 is compared with the peers that work in float64.
"/ bound" says by how much the fastest peer is slower than the passes that numpy cannot do without (`least_work`): where that is
less than 2, or hardly more, numpy cannot reach the goal. Where a peer is too slow to be run whole it is timed on a part, in
proportion, and marked ~.

Peers are the extra `bench` (pip install -e '.[bench]'); one that is missing is named and left out. Texels are points to them,
at the centres, weighted by their solid angle: their coefficients differ by the square of half a texel, and only ours are
compared for their error.
"""

from __future__ import annotations

import os
import sys
import tracemalloc
from collections.abc import Callable
from functools import partial
from time import perf_counter

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = os.environ["RAYON_NUM_THREADS"] = "1"

import numpy as np
from measure import cpu_milliseconds, machine, medians

from shviewer.benchmark.measuring.peers import IMAGE_PEERS, available
from shviewer.harmonics.basis import evaluate_basis
from shviewer.harmonics.projection import rows as projection
from shviewer.harmonics.projection.row_transform import (
    BLOCK_ROWS,
    FEWEST_ROWS,
    FOLD_BANDS,
    FOLD_VALUES,
    FOLDED_VALUES,
    NARROW,
    _step,
)
from shviewer.harmonics.projection.rows import project_image, project_product
from shviewer.harmonics.projection.scattered import project_samples
from shviewer.harmonics.quadrature import gauss_legendre, jittered
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.theta_series import degrees_and_orders, from_waves, series_by_parity, theta_series
from shviewer.lights.find import built_in_lights, find_light
from shviewer.lights.layouts.lat_long import LatLongLayout

ImagePeer = Callable[[np.ndarray, int], object]

WIDTHS = (512, 1024, 2048, 4096, 8192)
BANDS = (3, 5, 9, 16, 32, 64)
SAMPLED_BANDS = (4, 9, 16, 32, 64)


def loop_peer(texels: int) -> ImagePeer:
    """The loop of the textbooks: one texel after the other, as many as `texels`, spread over the image."""

    def project(image: np.ndarray, n_bands: int) -> object:
        height, width = image.shape[:2]
        solid_angle, found = LatLongLayout(height, width).solid_angles(), np.zeros((n_bands**2, 3))
        for i in range(0, height * width, max(1, height * width // texels)):
            row, column = divmod(i, width)
            theta, phi = np.pi * (row + 0.5) / height, np.pi * (1 - 2 * (column + 0.5) / width)
            direction = np.array([[np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)]])
            found += evaluate_basis(direction, n_bands).T * (image[row, column] * solid_angle[row])
        return found

    return project


def installed() -> dict[str, ImagePeer]:
    missing: list[str] = []
    found = available(IMAGE_PEERS, missing)
    for line in missing:
        print(f"without {line}; pip install -e '.[bench]'")
    return found


def photograph(width: int) -> np.ndarray:
    """A built-in map, its texels repeated, and noise like a camera's: (width / 2, width, 3) float32."""
    texels = find_light("film_studio").map.texels
    rows, columns = np.arange(width // 2) * len(texels) // (width // 2), np.arange(width) * texels.shape[1] // width
    noise = np.random.default_rng(0).gamma(30.0, 1 / 30, (width // 2, width, 3))
    return (texels[np.ix_(rows, columns)] * noise).astype(np.float32)


def second_time(work: Callable[[], object]) -> float:
    """Milliseconds of the second of two runs: in the first one pays for memory that another has given back to the system."""
    work()
    return cpu_milliseconds(work)


def scaled(peer: ImagePeer, share: float, image: np.ndarray, n_bands: int) -> float:
    """Milliseconds of the whole when only a share of it was run."""
    start = perf_counter()
    peer(image, n_bands)
    return 1000 * (perf_counter() - start) / share


def least_work(image: np.ndarray, n_bands: int, precision: type[np.floating]) -> Callable[[], object]:
    """The passes over an image that numpy cannot do without, on numbers that mean nothing: the bound.

    Conversion for float64, sum and difference of the halves of a row and, for many bands, of north and south, the products with
    waves along theta, then of folded columns along phi, and then with the series of the basis. Below NARROW columns in float64,
    as there float32 does not keep to 2e-8. More folds, about pi/4, halve the products again, but take longer than they save.
    """
    rows, columns = image.shape[:2]
    precision = np.float64 if columns < NARROW else precision
    folds = 1 + (n_bands >= FOLD_BANDS)
    flat = image.reshape(rows, 2, columns // 2 * 3)
    height, width = min(BLOCK_ROWS, rows // 2), flat.shape[2]
    if folds == 2 and precision is np.float64:
        height = min(height, max(FEWEST_ROWS, FOLDED_VALUES // (4 * width)))
    n_functions, some = n_bands // folds, max(1, FOLD_VALUES // flat[0].size)
    step = _step(n_functions, height, width)
    halves, folded = np.ones((folds, 2, some, width), precision), np.ones((2 * folds, height, width), precision)
    along_theta = np.ones((n_functions, height), precision)
    sums, along_phi = np.ones((2, columns // 4, 3 * n_bands)), np.ones((n_bands // 2, columns // 4))
    by_order = np.ones((n_bands, 2, 3, n_bands))
    product = np.empty((step, n_functions), precision)

    def work() -> None:
        for top in range(0, rows // folds, height):
            for start in range(0, min(height, rows // folds - top), some):
                out = folded[:, start : min(start + some, rows // folds - top)]
                here = halves[..., : out.shape[1], :] if folds == 2 else out[None]
                for half in here:
                    left, right = flat[top + start : top + start + out.shape[1]].swapaxes(0, 1)
                    if precision is np.float64:
                        np.copyto(half, (left, right))
                        left, right = half
                    np.add(left, right, out=half[0])
                    np.subtract(left, right, out=half[1])
                if folds == 2:
                    np.add(*here, out=out[:2])
                    np.subtract(*here, out=out[2:])
            for part in folded:
                for first in range(0, width, step):
                    columns_here = part[:, first : first + step]
                    np.matmul(columns_here.T, along_theta.T, out=product[: columns_here.shape[1]])
        west, east = sums
        for fold in (np.add, np.subtract, np.add, np.subtract):
            np.matmul(along_phi, fold(west, east))
        from_waves(by_order)

    return work


def images(widths: tuple[int, ...], found: dict[str, ImagePeer]) -> None:
    names = ["ducc0 f32", "ducc0 f64", "shtns", "pyshtools", "sphericart", "loop"]
    print(f"\n{'image':<12}{'n':>3}{'ms':>9}{'x reading':>10}{'error':>9}{'f64 ms':>9}", end="")
    print(
        "".join(f"{name:>12}" for name in names), f"{'fastest / ours':>16}{'/ bound':>9}{'f64 / f64':>11}{'/ bound':>9}"
    )
    for width in widths:
        image = photograph(width)
        for n_bands in BANDS:
            fast = {name: peer for name, peer in found.items() if name != "sphericart"}
            if width >= 4096:
                fast.pop("pyshtools", None)
            work = {
                "ours": partial(project_image, image, n_bands, np.float32),
                "f64": partial(project_image, image, n_bands),
                "read": image.sum,
                "bound": least_work(image, n_bands, np.float32),
                "bound f64": least_work(image, n_bands, np.float64),
                **{name: partial(peer, image, n_bands) for name, peer in fast.items()},
            }
            times = {name: (ms, "") for name, ms in medians(work, 25 if width == 512 else 5, second_time).items()}
            if width == 4096 and "pyshtools" in found:
                times["pyshtools"] = (scaled(found["pyshtools"], 1.0, image, n_bands), "")
            if "sphericart" in found:
                share = max(1, width * width // 2 * n_bands**2 // 2**29)
                times["sphericart"] = (
                    scaled(partial(found["sphericart"], share=share), 1 / share, image, n_bands),
                    "~" if share > 1 else "",
                )
            times["loop"] = (scaled(loop_peer(500), 500 / (width * width / 2), image, n_bands), "~")
            exact, quick = project_image(image, n_bands), project_image(image, n_bands, np.float32)
            error = np.abs(quick - exact).max() / np.abs(exact).max()
            ours = times["ours"][0]
            peers = {name: ms for name, (ms, _) in times.items() if name in names}
            fastest = min(peers.values(), default=float("nan"))
            exact_fastest = min((ms for name, ms in peers.items() if name != "ducc0 f32"), default=float("nan"))
            print(f"{width:>5} x {width // 2:<4}{n_bands:>3}{ours:>9.2f}{ours / times['read'][0]:>10.1f}", end="")
            print(f"{error:>9.0e}{times['f64'][0]:>9.2f}", end="")
            print(
                "".join(
                    f"{mark + format(ms, '.2f') if ms else '-':>12}"
                    for ms, mark in (times.get(n, (0, "")) for n in names)
                ),
                end="",
            )
            print(f"{fastest / ours:>15.1f}x{fastest / times['bound'][0]:>8.1f}x", end="")
            ratios = (exact_fastest / times[name][0] for name in ("f64", "bound f64"))
            print("{:>10.1f}x{:>8.1f}x".format(*ratios), flush=True)


def tables_and_memory() -> None:
    image = photograph(4096)
    print("\ntables and memory, 4096 x 2048")
    for n_bands in (9, 64):
        for remembered in (theta_series, series_by_parity, degrees_and_orders, projection._rows_of_texels):
            remembered.cache_clear()
        projection._columns_of_texels.cache_clear()
        start = perf_counter()
        project_image(image, n_bands, np.float32)
        first = 1000 * (perf_counter() - start)
        tracemalloc.start()
        project_image(image, n_bands, np.float32)
        peak = tracemalloc.get_traced_memory()[1] / 2**20
        tracemalloc.stop()
        again = medians({"again": partial(project_image, image, n_bands, np.float32)}, 3)["again"]
        print(f"{n_bands:>3} bands: first {first:.1f} ms, again {again:.1f} ms; {peak:.1f} MiB beside the image")


def maps() -> None:
    print("\nsynthesis of a 2048 x 1025 map, float32; x copying a map of that size")
    other = np.ones((1025, 2048, 3), np.float32)
    target = np.empty_like(other)
    for n_bands in (3, 9, 16, 32, 64, 128):
        coefficients = np.random.default_rng(0).standard_normal((n_bands**2, 3))
        work = {
            "map": lambda c=coefficients: Synthesis(c).pole_to_pole(1025, 2048),
            "copy": lambda: np.copyto(target, other),
        }
        times = medians(work, 7)
        print(f"{n_bands:>3} bands {times['map']:8.2f} ms {times['map'] / times['copy']:6.1f} x")


def lobes() -> None:
    print("\nclosed forms, goal: 16 bands under 1 ms")
    for name, path in built_in_lights().items():
        if path.suffix == ".toml":
            light = find_light(name)
            times = medians({str(n): partial(light.coefficients, n) for n in SAMPLED_BANDS}, 15)
            print(f"{name:<12}", ", ".join(f"{n} bands {ms:.2f} ms" for n, ms in times.items()))


def sampled() -> None:
    print("\nGreen's light from samples, 16 bands; error of the largest coefficient")
    light = find_light("green")
    exact = light.coefficients(16)
    for samples in (10_000, 100_000):
        directions, rule = jittered(samples, 0), gauss_legendre(samples)
        candidates = {
            "jittered": partial(project_samples, light.radiance, directions, 16),
            "gauss-legendre": partial(project_product, light.radiance, rule, 16),
        }
        times = medians(candidates, 5)
        for name, work in candidates.items():
            found = work()
            coefficients = found[0] if isinstance(found, tuple) else found
            error = np.abs(coefficients - exact).max() / np.abs(exact).max()
            print(f"{name:<15}{samples:>7} samples {times[name]:8.2f} ms, error {error:.1e}")


def main() -> None:
    quick = "--quick" in sys.argv[1:]
    print(machine(), "- one thread")
    images(WIDTHS[:1] if quick else WIDTHS, installed())
    tables_and_memory()
    maps()
    lobes()
    sampled()


if __name__ == "__main__":
    main()
