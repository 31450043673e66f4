"""How the names of coefficient files end, and what each ending holds; known without loading what reads them."""

from __future__ import annotations

_TEXT, _ARRAYS = (".txt", ".h", ".glsl"), (".npz", ".npy")

HOLDS = {".json": "json", ".csv": "csv", **dict.fromkeys(_TEXT, "text"), **dict.fromkeys(_ARRAYS, "arrays")}

COEFFICIENT_SUFFIXES = tuple(HOLDS)
