"""What opening an image costs: python tests/benchmarks/reading.py

Goals, CPU time, one thread each, files in a temporary folder (so in memory after the warm-up):
    a 4096 x 2048 .hdr in the new packing in no more time than OpenImageIO takes (pip install OpenImageIO);
    packets made to be slow in at most 20 times an ordinary file of that size.
"ours" is read_radiance_image: with the checks of values. The pictures are smooth skies with a sun, some clouds and one
percent of noise: their mantissas are literals and their exponents runs, as in photographs.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import ModuleType

os.environ["OPENBLAS_NUM_THREADS"] = "1"
sys.path.append(str(Path(__file__).resolve().parents[1]))  # tests/

import numpy as np
import OpenEXR
from lights.images.hdr_files import exr_file, one_value_packets
from measure import cpu_milliseconds, machine, medians

from shviewer.lights.images.radiance_files import read_radiance_image

SIZES = ((512, 256), (2048, 1024), (4096, 2048))
LARGEST = SIZES[-1]


def picture(width: int, height: int) -> np.ndarray:
    """(height, width, 3) float32 radiance."""
    rng = np.random.default_rng(0)
    u, v = np.linspace(0, 1, width), np.linspace(0, 1, height)[:, None]
    waves = sum(np.sin(2 * np.pi * (k * u + k * k * v + k / 7)) / k for k in (1, 2, 3, 5, 8, 13))
    sun = 5000 * np.exp(-((u - 0.3) ** 2 + (v - 0.2) ** 2) / 2e-4)
    grey = np.exp(1.5 * waves - 3 * v) + sun
    colour = grey[..., None] * (0.7, 0.9, 1.2) * (1 + 0.01 * rng.standard_normal((height, width, 3)))
    return np.maximum(colour, 0.0).astype(np.float32)


def rgbe_of(radiance: np.ndarray) -> np.ndarray:
    """(height, width, 4) uint8."""
    _, exponent = np.frexp(radiance.max(axis=2))
    mantissas = np.clip(np.rint(np.ldexp(radiance, 8 - exponent[..., None])), 0, 255)
    return np.concatenate([mantissas, exponent[..., None] + 128], axis=2).astype(np.uint8)


def newly_packed(rgbe: np.ndarray) -> bytes:
    """A .hdr file with a run wherever four values or more are the same, as Radiance writes it."""
    height, width = rgbe.shape[:2]
    packed = [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width)]
    for row in rgbe:
        packed.append(bytes((2, 2, width >> 8, width & 255)))
        for channel in row.T:
            edges = np.concatenate([[0], np.flatnonzero(np.diff(channel)) + 1, [width]])
            runs = np.flatnonzero(np.diff(edges) >= 4)
            values, done = channel.tobytes(), 0
            for start, stop in zip(edges[runs].tolist(), edges[runs + 1].tolist(), strict=True):
                packed += literals(values[done:start])
                packed += [bytes((128 + min(127, stop - i), values[start])) for i in range(start, stop, 127)]
                done = stop
            packed += literals(values[done:])
    return b"".join(packed)


def literals(values: bytes) -> list[bytes]:
    return [bytes((len(values[i : i + 128]),)) + values[i : i + 128] for i in range(0, len(values), 128)]


def old_markers(width: int, height: int) -> bytes:
    """Every texel but the last is followed by four markers that repeat it 0 times: no chain may be longer."""
    texel = b"\x80\x40\x20\x80"
    scanline = (texel + b"\1\1\1\0" * 4) * (width - 1) + texel
    return b"#?RADIANCE\n\n-Y %d +X %d\n" % (height, width) + scanline * height


def packets(width: int, height: int, packet: bytes, values: int, ending: bytes = b"") -> bytes:
    """Each channel is this packet again and again, and `ending` where that is not the whole width."""
    scanline = bytes((2, 2, width >> 8, width & 255)) + (packet * (width // values) + ending) * 4
    return b"#?RADIANCE\n\n-Y %d +X %d\n" % (height, width) + scanline * height


def false_beginnings(width: int, height: int, decoys: int) -> bytes:
    """So many places in every scanline look like the next one's beginning; the rest are packets of one value."""
    header = bytes((2, 2, width >> 8, width & 255))
    scanline = header + (b"\4" + header) * decoys + b"\1\x80" * 4 * (width - decoys)
    return b"#?RADIANCE\n\n-Y %d +X %d\n" % (height, width) + scanline * height


def slow_files(width: int, height: int) -> dict[str, bytes]:
    return {
        "packets of 1 value": one_value_packets(height, width),
        "packets of 2 values": packets(width, height, b"\2\x80\x81", 2),
        "packets of 3 values": packets(width, height, b"\3\x80\x81\x82", 3, b"\x81\x80" * (width % 3)),
        "runs of 1 and 2 in turn": packets(width, height, b"\x81\x80\x82\x81", 3, b"\x81\x80" * (width % 3)),
        "chains of old markers": old_markers(width, height),
        "false beginnings, 3 a scanline": false_beginnings(width, height, 3),
        "false beginnings, 40 a scanline": false_beginnings(width, height, 40),
    }


def openimageio() -> ModuleType | None:
    try:
        import OpenImageIO
    except ImportError:
        print("OpenImageIO is missing (pip install OpenImageIO): only our own times")
        return None
    OpenImageIO.attribute("threads", 1)
    return OpenImageIO


def read_with(openimageio: ModuleType, path: Path) -> object:
    file = openimageio.ImageInput.open(str(path))
    pixels = file.read_image("float")
    file.close()
    return pixels


def compare(what: str, path: Path, peer: ModuleType | None, repeats: int) -> None:
    candidates: dict[str, Callable[[], object]] = {"ours": partial(read_radiance_image, path)}
    if peer is not None:
        candidates["OpenImageIO"] = partial(read_with, peer, path)
    times = medians(candidates, repeats, cpu_milliseconds)
    ratio = f"{times['ours'] / times['OpenImageIO']:6.2f} x" if peer else ""
    print(f"{what:<34}", "".join(f"{name} {ms:8.1f} ms   " for name, ms in times.items()), ratio, flush=True)


def main() -> None:
    print(machine())
    peer = openimageio()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "light.hdr"
        for width, height in SIZES:
            path.write_bytes(newly_packed(rgbe_of(picture(width, height))))
            compare(f".hdr new packing {width} x {height}", path, peer, 7)
        flat = rgbe_of(picture(*LARGEST))
        flat_path = Path(folder) / "flat.hdr"
        flat_path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % LARGEST[::-1] + flat.tobytes())
        compare(f".hdr flat {LARGEST[0]} x {LARGEST[1]}", flat_path, peer, 5)

        exr = Path(folder) / "light.exr"
        halves = picture(*LARGEST).astype(np.float16)
        exr.write_bytes(exr_file({"RGB": halves}, compression=OpenEXR.ZIP_COMPRESSION))
        compare(f".exr half ZIP {LARGEST[0]} x {LARGEST[1]}", exr, peer, 5)

        slow = Path(folder) / "slow.hdr"
        for name, data in slow_files(*LARGEST).items():
            slow.write_bytes(data)
            candidates = {"ordinary": partial(read_radiance_image, path), "slow": partial(read_radiance_image, slow)}
            times = medians(candidates, 3, cpu_milliseconds)
            print(
                f"{name:<34} {times['slow']:8.1f} ms   {times['slow'] / times['ordinary']:6.2f} x an ordinary file of"
                f" {LARGEST[0]} x {LARGEST[1]}",
                flush=True,
            )


if __name__ == "__main__":
    main()
