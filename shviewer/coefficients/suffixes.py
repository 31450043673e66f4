"""The suffixes of coefficient files and their meaning, in a module of their own that loads no reader."""

from __future__ import annotations

_TEXT, _ARRAYS = (".txt", ".h", ".glsl", ".hlsl", ".js", ".cs"), (".npz", ".npy")

HOLDS = {
    ".json": "json",
    ".gltf": "json",
    ".csv": "csv",
    **dict.fromkeys(_TEXT, "text"),
    **dict.fromkeys(_ARRAYS, "arrays"),
}

COEFFICIENT_SUFFIXES = tuple(HOLDS)
