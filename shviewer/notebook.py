"""How lights and projections show themselves in a notebook: as their picture."""

from __future__ import annotations

import warnings
from collections.abc import Callable

from shviewer.errors import ShviewerError

drawing: Callable[[object], bytes] | None = None
"""The PNG of a light or a projection. What draws stands above them: `import shviewer` sets it."""


class InNotebooks:
    """What IPython asks of a result that is a picture."""

    def _repr_png_(self) -> bytes | None:
        """The bytes of a PNG; None, with a warning, where it cannot be drawn."""
        try:
            return drawing(self) if drawing else None
        except ShviewerError as error:
            warnings.warn(str(error), stacklevel=2)
            return None
