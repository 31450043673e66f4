"""Makes OpenEXR files that the library's own writer does not make, or only in a roundabout way."""

import struct

import numpy as np
import OpenEXR
from lights.images.hdr_files import exr_file, exr_part, window

ONE_LEVEL, MIP_MAPPED, RIP_MAPPED = 0, 1, 2


def tiled_exr(pixels, mode=ONE_LEVEL, tile=16):
    """An uncompressed tiled file, by hand. pixels: (height, width, 3) float16 of level 0; all other levels are 7."""
    height, width = pixels.shape[:2]
    across, down = _level_sizes(width), _level_sizes(height)
    levels = {
        ONE_LEVEL: [(0, 0)],
        MIP_MAPPED: [(i, i) for i in range(max(len(across), len(down)))],
        RIP_MAPPED: [(i, j) for j in range(len(down)) for i in range(len(across))],
    }[mode]
    chunks = []
    for i, j in levels:
        size = (down[min(j, len(down) - 1)], across[min(i, len(across) - 1)], 3)
        level = pixels if (i, j) == (0, 0) else np.full(size, 7, np.float16)
        for y in range(0, size[0], tile):
            for x in range(0, size[1], tile):
                texels = level[y : y + tile, x : x + tile, ::-1].transpose(0, 2, 1).astype("<f2").tobytes()  # B, G, R
                chunks.append(struct.pack("<5i", x // tile, y // tile, i, j, len(texels)) + texels)
    head = struct.pack("<II", 20000630, 2 | 0x200) + b"".join(
        (
            _attribute(b"channels", b"chlist", b"".join(_channel(name) for name in (b"B", b"G", b"R")) + b"\0"),
            _attribute(b"compression", b"compression", b"\0"),
            _attribute(b"dataWindow", b"box2i", struct.pack("<4i", 0, 0, width - 1, height - 1)),
            _attribute(b"displayWindow", b"box2i", struct.pack("<4i", 0, 0, width - 1, height - 1)),
            _attribute(b"lineOrder", b"lineOrder", b"\0"),
            _attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1.0)),
            _attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0.0, 0.0)),
            _attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1.0)),
            _attribute(b"tiles", b"tiledesc", struct.pack("<IIB", tile, tile, mode)),
            b"\0",
        )
    )
    starts = len(head) + 8 * len(chunks) + np.cumsum([0, *map(len, chunks[:-1])])
    return head + starts.astype("<u8").tobytes() + b"".join(chunks)


def _level_sizes(size):
    """Halved and rounded down to 1."""
    sizes = [size]
    while sizes[-1] > 1:
        sizes.append(sizes[-1] // 2)
    return sizes


def _attribute(name, kind, value):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value


def _channel(name):
    return name + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1)


def luminance_chroma_exr(luminance, chroma_red, chroma_blue, step=2, layer="", origin=(0, 0), **header):
    """Y at each texel, RY and BY at each `step`-th: (height / step, width / step)."""
    height, width = luminance.shape
    both = window(origin[0], origin[1], origin[0] + width - 1, origin[1] + height - 1)

    def coarse(samples):
        """The writer wants an array as large as the image and writes its first values."""
        padded = np.zeros(luminance.size, samples.dtype)
        padded[: samples.size] = samples.ravel()
        return OpenEXR.Channel(padded.reshape(luminance.shape), step, step)

    channels = {"Y": OpenEXR.Channel(luminance), "RY": coarse(chroma_red), "BY": coarse(chroma_blue)}
    named = {layer + name: channel for name, channel in channels.items()}
    return exr_file(named, **{"dataWindow": both, "displayWindow": both, **header})


def luminance_chroma_of(pixels, weights):
    """Y, RY and BY of (height, width, 3) RGB, at every texel; the definition."""
    luminance = pixels @ np.asarray(weights)
    return luminance, pixels[..., 0] / luminance - 1, pixels[..., 2] / luminance - 1


def deep_part(name, height=4, width=8):
    """Three samples of R, G and B in each texel."""
    samples = np.empty((height, width), object)
    for place in np.ndindex(height, width):
        samples[place] = np.ones(3, np.float32)
    channels = {channel: samples.copy() for channel in "RGB"}
    return exr_part(name, channels, type=OpenEXR.deepscanline, compression=OpenEXR.ZIPS_COMPRESSION)
