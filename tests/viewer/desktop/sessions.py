"""Sessions without a window, as several tests press their keys."""

from __future__ import annotations

from shviewer.viewer.desktop.session import Session

SCENE = '[[lobe]]\nprofile = "constant"\nradiance = {}\n'


def pressed(session: Session, *keys: str) -> Session:
    """The session after these keys, each with its picture; none of them is for a window."""
    for key in keys:
        assert session.press(key) is None, key
        session.prepare()
    return session
