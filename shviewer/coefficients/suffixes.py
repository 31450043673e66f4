"""How the names of coefficient files end, and what each ending holds; known without loading what reads them."""

from __future__ import annotations

HOLDS = {
    ".json": "json",
    ".csv": "csv",
    ".txt": "text",
    ".h": "text",
    ".glsl": "text",
    ".npz": "arrays",
    ".npy": "arrays",
}

COEFFICIENT_SUFFIXES = tuple(HOLDS)
