"""What tests of several folders say in the same words."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from typing import NoReturn, TypeVar

import pytest

T = TypeVar("T")


def unavailable(reason: str) -> NoReturn:
    """What a test needs is not on this machine: it is skipped with the reason; on CI, where all has to be, it fails."""
    if os.environ.get("CI"):
        pytest.fail(reason)
    pytest.skip(reason)


class Lazily(Mapping[str, T]):
    """Named values, each made when it is first asked for. While tests are collected only the names are."""

    def __init__(self, makers: Mapping[str, Callable[[], T]]) -> None:
        self._makers = makers
        self._made: dict[str, T] = {}

    def __getitem__(self, name: str) -> T:
        if name not in self._made:
            self._made[name] = self._makers[name]()
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)
