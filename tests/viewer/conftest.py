"""Whatever a session does behind its picture is waited for, so that no test depends on how busy the machine is."""

from __future__ import annotations

import pytest

from shviewer.viewer.desktop.behind import errands

PATIENCE = 60.0


@pytest.fixture(autouse=True)
def _patient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(errands, "AT_ONCE", PATIENCE)
