"""The places of shaders/ and assets/, in a checkout and in an installed package."""

from __future__ import annotations

from pathlib import Path

from shviewer.errors import ShviewerError

PACKAGE = Path(__file__).parent


def resource_folder(kind: str) -> Path:
    """The folder "shaders" or "assets": in an installed package, or beside it in a checkout.

    ShviewerError if the installation is damaged.
    """
    for folder in (PACKAGE / kind, PACKAGE.parent / kind):
        if folder.is_dir():
            return folder
    raise ShviewerError(
        f"no folder {kind}/ in {PACKAGE} or beside it: the installation is incomplete; install it again"
    )
