"""What it costs to decode an OpenEXR file in a child process. Run as `python tests/benchmarks/isolated.py`."""

from __future__ import annotations

import io
from functools import partial

import numpy as np
import OpenEXR
from measure import machine, medians

from shviewer.lights.images.isolated import decode_isolated
from shviewer.lights.images.openexr import decode_openexr


def half_zip(height: int, width: int) -> bytes:
    """A smooth sky with noise of 2 %, which ZIP packs to half."""
    y, x = np.mgrid[0:height, 0:width].astype(np.float32)
    smooth = np.stack([np.sin(x / 300), np.cos(y / 200), np.sin((x + y) / 500)], axis=2) + 1.0
    noisy = smooth * (1.0 + 0.02 * np.random.default_rng(0).random((height, width, 1), np.float32))
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION}
    written = io.BytesIO()
    OpenEXR.File(header, {"RGB": noisy.astype(np.float16)}).write(written)
    return written.getvalue()


def main() -> None:
    print(machine())
    print(f"{'half, ZIP':>12} {'here':>9} {'child':>9} {'more':>9} {'ratio':>6}")
    for height, width, repeats in ((32, 64, 21), (2048, 4096, 7)):
        data = half_zip(height, width)
        times = medians({"here": partial(decode_openexr, data), "child": partial(decode_isolated, data)}, repeats)
        here, child = times["here"], times["child"]
        print(f"{f'{width} x {height}':>12} {here:6.1f} ms {child:6.1f} ms {child - here:6.1f} ms {child / here:6.2f}")


if __name__ == "__main__":
    main()
