"""The inputs, each a function of a seed and its number, and who judges them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random
from typing import Protocol

import door_seeds
import seeds as image_seeds
from door_mutations import spoilt
from doors import DoorWitness
from mutations import mutated
from promise import BrokenPromise, Witness

COUNT = 20_000
_SHARES = {".hdr": 39, ".exr": 26, ".png": 13, ".jpg": 9} | {".tif": 3, ".dds": 3, ".pfm": 2, ".npy": 2}
_SHARES |= dict.fromkeys((".psd", ".bmp", ".webp"), 1)
"""Percent of the mutations; the reader of .hdr is the one written here. Kinds without a seed have none."""

_DOOR_SHARES = {"light": 64, "compare": 4, "against": 6, "reference": 4, "stamp": 8, "arguments": 14}
_LARGE = 2048  # bytes; of seeds up to this size every truncation is tried

_seeds = image_seeds.seeds


class Judge(Protocol):
    """What sees whether a promise is kept, on one input after the other."""

    def check(self, name: str, data: bytes) -> bool:
        """Whether the input was accepted. BrokenPromise if the reader misbehaved."""


class Inputs(Protocol):
    """A numbered set of files, the same in every process."""

    def judge(self) -> Judge: ...

    def __len__(self) -> int: ...

    def __getitem__(self, number: int) -> tuple[str, bytes]:
        """The name of the seed and the file made of it."""


@dataclass(frozen=True)
class Mutations:
    seed: int
    count: int = COUNT

    def judge(self) -> Judge:
        return warmed_up(Witness, _seeds())

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, number: int) -> tuple[str, bytes]:
        random = Random(f"{self.seed}/{number}")
        kinds = [kind for kind in _SHARES if _names(kind)]
        (kind,) = random.choices(kinds, [_SHARES[kind] for kind in kinds])
        names = _names(kind)
        name, other = random.choice(names), random.choice(names)
        return name, mutated(_seeds()[name], kind, random, _seeds()[other])


@dataclass(frozen=True)
class DoorMutations:
    """For every door but that of images."""

    seed: int
    count: int = COUNT

    def judge(self) -> Judge:
        return warmed_up(DoorWitness, door_seeds.seeds())

    def __len__(self) -> int:
        return self.count

    def __getitem__(self, number: int) -> tuple[str, bytes]:
        random = Random(f"doors/{self.seed}/{number}")
        (door,) = random.choices(list(_DOOR_SHARES), list(_DOOR_SHARES.values()))
        alike = random.choice(list(_door_names(door).values()))
        name = random.choice(alike)
        found = door_seeds.seeds()
        return name, spoilt(name, found[name], tuple(found[other] for other in alike), random)


@dataclass(frozen=True)
class Truncations:
    """The beginnings of each seed, from nothing to all but one byte; of large ones about `_LARGE` of them."""

    def judge(self) -> Judge:
        return warmed_up(Witness, _seeds())

    def __len__(self) -> int:
        return len(_truncations())

    def __getitem__(self, number: int) -> tuple[str, bytes]:
        name, length = _truncations()[number]
        return name, _seeds()[name][:length]


@cache
def _names(kind: str) -> list[str]:
    return [name for name in _seeds() if name.endswith(kind)]


@cache
def _door_names(door: str) -> dict[str, list[str]]:
    """Suffix -> the seeds of a door with that suffix: of each are as many mutations, however many seeds there are."""
    names: dict[str, list[str]] = {}
    for name in door_seeds.seeds():
        if name.startswith(f"{door}/"):
            names.setdefault(Path(name).suffix, []).append(name)
    return names


def warmed_up(judge: Callable[[], Judge], sound: dict[str, bytes]) -> Judge:
    """A judge that begins when all that is loaded late is loaded: imports and first allocations are no input's fault."""
    first = judge()
    for name, data in sound.items():
        verdict(first, name, data)
    return judge()


@cache
def _truncations() -> list[tuple[str, int]]:
    return [
        (name, length) for name, data in _seeds().items() for length in range(0, len(data), 1 + len(data) // _LARGE)
    ]


def verdict(witness: Judge, name: str, data: bytes) -> bool | str:
    """Whether it was accepted, or how the promise was broken."""
    try:
        return witness.check(name, data)
    except BrokenPromise as broken:
        return str(broken)
