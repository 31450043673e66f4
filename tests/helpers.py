"""What tests of several folders say in the same words."""

from __future__ import annotations

import os
from typing import NoReturn

import pytest


def unavailable(reason: str) -> NoReturn:
    """What a test needs is not on this machine: it is skipped with the reason; on CI, where all has to be, it fails."""
    if os.environ.get("CI"):
        pytest.fail(reason)
    pytest.skip(reason)
