"""Which evaluator belongs to which program, its directions, and coefficients that tell every convention from the others."""

from __future__ import annotations

import numpy as np
from coefficients import peer_evaluators as peers
from harmonics.independent import random_directions

from shviewer.coefficients.texts import parse_convention
from shviewer.harmonics.basis import Array

PEERS = {
    "filament": (peers.filament, 3),
    "three": (peers.three, 3),
    "unity": (peers.unity, 3),
    "unreal": (peers.unreal, 3),
    "ambix": (peers.ambix, 8),
    "sphericart": (peers.sphericart, 20),
    "scipy": (peers.scipy, 20),
    "babylon": (peers.babylon, 3),
    "playcanvas": (peers.playcanvas, 3),
    "cesium": (peers.filament, 3),
    "gltf": (peers.gltf, 3),
    "godot": (peers.godot, 3),
    "3dgs": (peers.gaussian_splatting, 4),
    "e3nn": (peers.e3nn, 4),
    "shtools": (peers.shtools, 8),
    "fuma": (peers.fuma, 4),
}
"""An evaluator of each program's numbers in that program's axes, and how many bands it is tried with.

Cesium's czm_sphericalHarmonics has Filament's nine terms.
"""

SHADED = ("filament", "unity", "babylon", "playcanvas", "cesium", "gltf", "godot")
"""Their evaluators give the irradiance over pi, the others the radiance."""

OF_IRRADIANCE = {"filament": 1, "unity": 1, "babylon": 1, "playcanvas": 1, "cesium": 1, "gltf": np.pi}
"""What their numbers hold, over the irradiance over pi. Godot's hold radiance over pi."""

THEIR_DIRECTIONS = {
    "filament": lambda x, y, z: (y, z, x),
    "three": lambda x, y, z: (x, z, -y),
    "unity": lambda x, y, z: (x, z, y),
    "unreal": lambda x, y, z: (-y, -x, z),
    "babylon": lambda x, y, z: (-y, z, x),
    "playcanvas": lambda x, y, z: (y, z, x),
    "cesium": lambda x, y, z: (x, z, -y),
    "gltf": lambda x, y, z: (-y, z, x),
    "godot": lambda x, y, z: (y, z, x),
    "directxmath": lambda x, y, z: (-y, z, x),
    "mitsuba": lambda x, y, z: (y, z, x),
}
"""Ours -> theirs, written out; the others have our axes."""

EXACT = 1e-12
"""The rounding of sums of up to 400 values of size 1."""


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
