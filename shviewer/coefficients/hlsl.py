"""HLSL from the GLSL that is written: the same table and function in the words of Direct3D, Unity and Unreal.

What is written uses little of both languages. They differ in the names of vectors, in how arrays begin and end, in that one
number makes no vector, and in that comparing vectors gives a vector.
"""

from __future__ import annotations

import re

_WORDS = (
    (r"const vec3 (\w+)\[(\d+)\] = vec3\[\d+\]\(", r"static const vec3 \1[\2] = {"),
    (r"^\);$", "};"),
    (r"\bvec3 sum;", "vec3 sum = vec3(0.0);"),
    (r"\b(\w) == vec3\(0\.0\)", r"all(\1 == vec3(0.0))"),
    (r"\b(\w) != vec3\(0\.0\)", r"any(\1 != vec3(0.0))"),
    (r"\bvec3\(0\.0\)", "vec3(0.0, 0.0, 0.0)"),
    (r"\bvec3\b", "float3"),
)
"""What is replaced by what, in this order."""


def hlsl_of(glsl: str) -> str:
    """A table and a function that `glsl_source` or `glsl_decoder` wrote, in HLSL of shader model 4 and later."""
    lines = glsl.splitlines(keepends=True)
    count = next(number for number, line in enumerate(lines) if not line.startswith("//"))
    comments, body = "".join(lines[:count]), "".join(lines[count:])
    for glsl_words, hlsl_words in _WORDS:
        body = re.sub(glsl_words, hlsl_words, body, flags=re.MULTILINE)
    return comments + body
