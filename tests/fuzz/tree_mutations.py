"""Ways to spoil the tree of a JSON document."""

from __future__ import annotations

import json
from copy import deepcopy
from random import Random
from typing import Any

from text_mutations import DEPTHS, NUMBERS, encoded


class _Raw(str):
    """Text that stands in a document as it is."""


class _Pairs(list[tuple[Any, Any]]):
    """An object whose keys may stand there twice."""


_VALUES = (
    *(_Raw(number) for number in NUMBERS),
    *(
        0,
        -1,
        1.5,
        "",
        "x",
        "nan",
        True,
        None,
        [],
        [[]],
        _Pairs(),
        [0] * 3,
        [[0] * 3] * 9,
        [None],
        "\x1b[2J\n",
        "\ud800",
        "x" * 2000,
    ),
)


def spoilt_tree(data: bytes, random: Random) -> bytes:
    tree = json.loads(data, object_pairs_hook=_Pairs)
    for _ in range(random.choice((1, 1, 2, 4))):
        holder = random.choice(_holders([tree]))
        _change(holder, random, tree)
    return encoded(_json(tree), random)


def _holders(value: Any) -> list[Any]:
    """Every list and object in a tree, itself included, but for empty ones."""
    found, left = [], [value]
    while left and len(found) < 2000:
        node = left.pop()
        if isinstance(node, list) and node:
            found.append(node)
            left += [pair[1] for pair in node] if isinstance(node, _Pairs) else node
    return found


def _change(holder: Any, random: Random, tree: Any) -> None:
    place = random.randrange(len(holder))
    pairs = isinstance(holder, _Pairs)
    key, value = holder[place] if pairs else (None, holder[place])
    match random.randrange(9):
        case 0 | 1 | 2:
            value = deepcopy(random.choice(_VALUES))  # a later change may be within it
        case 3:
            holder.insert(place, holder[place])
            return
        case 4:
            del holder[place]
            return
        case 5:
            deep = random.choice(DEPTHS[:4] if random.random() < 0.9 else DEPTHS[:7])
            value = _Raw("[" * deep + _json(value) + "]" * deep)
        case 6:
            key = random.choice(
                ("", "x", "coefficients", "shviewer-coefficients", "\x1b[2J", "y" * 500, "schema", "state")
            )
        case 7 if isinstance(value, list) and not isinstance(value, _Pairs):
            value = random.choice(
                (value[:-1], value * 2, value[::-1], [value], [x for row in value for x in ([row] * 3)])
            )
        case 8:
            value = random.choice(_holders([tree])) if len(_json(tree)) < 50_000 else 0
            value = _Raw(_json(value))
    holder[place] = (key, value) if pairs else value


def _json(value: Any) -> str:
    if isinstance(value, _Raw):
        return value
    if isinstance(value, _Pairs):
        return "{" + ", ".join(f"{json.dumps(key)}: {_json(part)}" for key, part in value) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_json, value)) + "]"
    return json.dumps(value)
