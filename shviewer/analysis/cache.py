"""The memory of the lights used last: a light is forgotten as a whole, with everything that was computed for it.

A bound per function would keep a light, and its image, alive as long as one result of one function is kept; so the bound
is on lights. The irradiance of a light belongs to that light, and so does what is left of it without its suns.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Iterable
from functools import wraps
from threading import RLock
from typing import Any, Concatenate, Generic, ParamSpec, TypeVar, cast

import numpy as np

from shviewer.lights.light import Light
from shviewer.progress import tell

P = ParamSpec("P")
R = TypeVar("R")

MOST_LIGHTS = 12
"""How many lights are remembered: all built-in ones and two of one's own."""

MOST_BYTES = 512 * 2**20
"""The most bytes in arrays of lights not in use: about six images of 4096 x 2048, with what was computed for them."""

SCALARS = {float, int, bool, str, type(None)}

Results = OrderedDict[Hashable, Any]
"""The results of one function for one light and its irradiance, the one used longest ago first."""


_Method = TypeVar("_Method", bound=Callable[..., Any])


def _alone(method: _Method) -> _Method:
    """Decorator: only one thread at a time is in such a method of one memory."""

    @wraps(method)
    def locked(self: Memory, *arguments: Any) -> Any:
        with self.lock:
            return method(self, *arguments)

    return cast(_Method, locked)


class Memory:
    """Lights by name, and results by light. A look-up counts as a use; the light used longest ago is forgotten first."""

    def __init__(self, most_lights: int = MOST_LIGHTS, most_bytes: int = MOST_BYTES) -> None:
        self.most_lights = most_lights
        self.most_bytes = most_bytes
        self.lock = RLock()
        self._known: OrderedDict[Light, dict[object, Results]] = OrderedDict()
        self._names: dict[Hashable, Light] = {}
        self._wholes: dict[Light, Light] = {}
        """Part -> whole: the light that another one was made from."""

    @_alone
    def __contains__(self, light: Light) -> bool:
        return self._source(light) in self._known

    @_alone
    def belongs(self, part: Light, whole: Light) -> None:
        """Let `part` count as `whole`: it is remembered and forgotten with it."""
        self._wholes[part] = self._source(whole)

    @_alone
    def named(self, name: Hashable) -> Light | None:
        """The light of that name, if it is still known."""
        light = self._names.get(name)
        if light is not None:
            self._use(light)
        return light

    @_alone
    def name(self, name: Hashable, light: Light) -> None:
        """Let `name` mean `light` from now on; the light that it meant before is forgotten."""
        light, before = self._source(light), self._names.get(name)
        if before is not None and before is not light:
            self.forget(before)
        self._names[name] = light
        self._use(light)

    @_alone
    def results(self, light: Light, function: object) -> Results:
        """The remembered results of `function` for the light; the caller may add to them."""
        return self._use(self._source(light)).setdefault(function, OrderedDict())

    @_alone
    def forget(self, light: Light) -> None:
        """Forget the light, its names and all its results."""
        light = self._source(light)
        self._known.pop(light, None)
        self._wholes = {part: whole for part, whole in self._wholes.items() if whole is not light}
        for name in [name for name, meant in self._names.items() if meant is light]:
            del self._names[name]

    @_alone
    def forget_results(self, function: object) -> None:
        """Forget the results of one function for every light."""
        for results in self._known.values():
            results.pop(function, None)

    @_alone
    def clear(self) -> None:
        self._known.clear()
        self._names.clear()
        self._wholes.clear()

    def _source(self, light: Light) -> Light:
        return self._wholes.get(light.source, light.source)

    def _use(self, light: Light) -> dict[object, Results]:
        if light not in self._known:
            self._make_room()
            self._known[light] = {}
        self._known.move_to_end(light)
        return self._known[light]

    def _make_room(self) -> None:
        """Make room for one more light. Sizes are taken now, when all results of the others have been computed."""
        sizes = [array_bytes(light, entry) for light, entry in self._known.items()]
        while sizes and (len(sizes) >= self.most_lights or sum(sizes) > self.most_bytes):
            del sizes[0]
            self.forget(next(iter(self._known)))


MEMORY = Memory()
"""The memory that the program uses."""


class Remembered(Generic[P, R]):
    """A function of a light and of hashable values whose last results for each light are kept in MEMORY."""

    def __init__(self, function: Callable[Concatenate[Light, P], R], most: int, doing: str) -> None:
        self.function = function
        self.most = most
        self.doing = doing
        self.__doc__ = function.__doc__

    def __call__(self, light: Light, *arguments: P.args, **named: P.kwargs) -> R:
        key = light, arguments, tuple(sorted(named.items()))
        with MEMORY.lock:
            results = MEMORY.results(light, self)
            if key in results:
                results.move_to_end(key)
                known: R = results[key]
                return known
        tell(self.doing)
        found = self.function(light, *arguments, **named)  # outside: threads that want other results need not wait
        with MEMORY.lock:
            results[key] = found
            if len(results) > self.most:
                results.popitem(last=False)
        return found

    def cache_clear(self) -> None:
        """Forget the results for all lights."""
        MEMORY.forget_results(self)


def remember(most: int, doing: str = "") -> Callable[[Callable[Concatenate[Light, P], R]], Remembered[P, R]]:
    """Decorator: keep the last `most` results for each light and its irradiance together. doing: told where one is made."""
    return lambda function: Remembered(function, most, doing)


def array_bytes(*roots: object) -> int:
    """Bytes of all arrays that can be reached through containers and this package's objects, each counted once."""
    total, seen, waiting = 0, set[int](), list(roots)
    while waiting:
        item = waiting.pop()
        if id(item) in seen:
            continue
        seen.add(id(item))
        if isinstance(item, np.ndarray):
            if item.base is None or not isinstance(item.base, np.ndarray):
                total += item.nbytes
            else:
                waiting.append(item.base)
        else:
            waiting.extend(part for part in _parts(item) if type(part) not in SCALARS)
    return total


def _parts(item: object) -> Iterable[object]:
    if isinstance(item, dict):
        return list(item.values())
    if isinstance(item, list | tuple | set | frozenset):
        return item
    if type(item).__module__.startswith("shviewer."):
        return list(vars(item).values()) if hasattr(item, "__dict__") else ()
    return ()
