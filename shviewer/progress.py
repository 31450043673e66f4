"""What a long computation is doing, told to whoever listens; the listener may end it. Without a listener nothing happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Listener = Callable[[str, float | None], None]
"""Takes what is being done, and the share that is done, 0 to 1, where it is known. It may raise Stopped."""


class Stopped(BaseException):
    """Nobody wants the result any more. No Exception, so that nothing takes it for a fault of a file."""


_LISTENER: ContextVar[Listener | None] = ContextVar("listener", default=None)


def tell(what: str = "", share: float | None = None) -> None:
    """Say what is being done; "" for what was said last. Raises Stopped if the result is no longer wanted."""
    listener = _LISTENER.get()
    if listener is not None:
        listener(what, share)


@contextmanager
def listening(listener: Listener) -> Iterator[None]:
    """Let `listener` hear what this thread does in the body."""
    token = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(token)


def in_words(what: str, share: float | None) -> str:
    """ "reading sky.exr 40 %" """
    return what if share is None or not what else f"{what} {100 * share:.0f} %"
