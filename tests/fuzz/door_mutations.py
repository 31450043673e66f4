"""Ways to spoil what is no image, by the suffix of its seed."""

from __future__ import annotations

from pathlib import Path
from random import Random

from array_mutations import spoilt_npy, spoilt_npz
from mutations import mutated, spoilt_anywhere
from text_mutations import MOST_BYTES, encoded, laid_out, spoilt_text
from tree_mutations import spoilt_tree


def spoilt(name: str, data: bytes, others: tuple[bytes, ...], random: Random) -> bytes:
    """A copy of the seed `name` with a few things changed. others: the bytes of seeds of the same door."""
    suffix, other = Path(name).suffix, random.choice(others)
    if suffix in (".png", ".jpg", ".webp", ".bmp"):
        return mutated(data, suffix, random, other)
    if suffix in (".npz", ".npy"):
        data = (spoilt_npz if suffix == ".npz" else spoilt_npy)(data, random)
    elif suffix == ".json" and random.random() < 0.6:
        data = spoilt_tree(data, random)
    elif suffix in (".txt", ".csv", ".h", ".glsl", ".hlsl", ".js", ".cs") and random.random() < 0.15:
        data = encoded(laid_out(random), random)
    else:
        data = spoilt_text(data, other, random, suffix)
    if random.random() < 0.15:
        spoiled = bytearray(data)
        spoilt_anywhere(spoiled, random, other)
        data = bytes(spoiled)
    if suffix == ".argv":  # argparse takes time as the square of the number of flags, and whoever gives them has it
        return b"\n".join(data.split(b"\n")[:1000])[:MOST_BYTES]
    return data[: 9 * MOST_BYTES if random.random() < 0.01 else MOST_BYTES]
