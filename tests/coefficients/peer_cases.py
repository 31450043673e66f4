"""Which evaluator belongs to which program, its directions, and coefficients that tell every convention from the others."""

from __future__ import annotations

import numpy as np
from coefficients import peer_evaluators as peers
from harmonics.independent import random_directions

from shviewer.coefficients.programs import parse_convention
from shviewer.harmonics.basis import Array

PEERS = {
    "filament": (peers.filament, 3),
    "three": (peers.three, 3),
    "unity": (peers.unity, 3),
    "unreal": (peers.unreal, 3),
    "ambix": (peers.ambix, 8),
    "sphericart": (peers.sphericart, 20),
    "scipy": (peers.scipy, 20),
}

THEIR_DIRECTIONS = {
    "filament": lambda x, y, z: (y, z, x),
    "three": lambda x, y, z: (x, z, -y),
    "unity": lambda x, y, z: (x, z, y),
    "unreal": lambda x, y, z: (-y, -x, z),
}
"""Ours -> theirs, written out; the others have our axes."""

EXACT = 1e-12
"""Of sums of up to 400 values of size 1."""


def directions_here(count: int = 1000) -> Array:
    return np.asarray(random_directions(count, seed=1))


def theirs(name: str, directions: Array) -> Array:
    turned = THEIR_DIRECTIONS.get(name, lambda x, y, z: (x, y, z))(*directions.T)
    return np.stack(turned, axis=1)


def asymmetric(n_bands: int) -> Array:
    """Every coefficient of every channel another one, falling with the degree."""
    numbers = np.random.default_rng(0).normal(size=(n_bands**2, 3))
    return np.asarray(numbers / (1 + peers.degree(n_bands**2)[:, None]))


A = np.repeat([np.pi, 2 * np.pi / 3, np.pi / 4], [1, 3, 5])[:, None]
L = np.repeat([0, 1, 2], [1, 3, 5])[:, None]


def spoiled(exact: Array, *names: str) -> Array:
    """What is written by somebody with these mistakes, in the order in which a program makes them."""
    turned = {"y-up": "y-up", "y-up-left": "y-up-left", "forward": "+y+z+x"}
    modifiers = [turned[name] for name in names if name in turned]
    modifiers += ["no-phase"] * ("phase" in names) + ["m-swapped"] * ("order" in names)
    numbers = np.asarray(parse_convention(",".join(["shviewer", *modifiers])).from_ours(exact))
    for name, factor in (
        ("pi", 1 / np.pi),
        ("times pi", np.pi),
        ("4pi", 1 / np.sqrt(4 * np.pi)),
        ("A", A),
        ("no A", 1 / A),
        ("SN3D", 1 / np.sqrt(2 * L + 1)),
    ):
        numbers = numbers * factor if name in names else numbers
    return numbers
