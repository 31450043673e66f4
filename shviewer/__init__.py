"""See a light beside its spherical-harmonic reconstruction, with error figures that can be trusted.

    find_light(what) -> Light                        a name, a file, a function, coefficients or an image
    info(light) -> Information                       what it is in figures, and how many bands it needs
    project(light, bands) -> Projected               coefficients, error figures, and files with the convention stamped on them
    reconstruct(coefficients, directions)            radiance (k, 3)
    evaluate_basis(directions, bands)                every Y(l, m), (..., bands**2); the convention is in harmonics/basis.py
    report(lights, folder)                           speed against error on this machine
    screenshot(light, bands) -> (height, width, 3)   the picture, without a window
    view(light, bands)                               the window

They are imported when they are first used: `import shviewer` alone loads neither numpy nor OpenGL. A mistake that a user can
put right raises ShviewerError.
"""

from __future__ import annotations

from shviewer.version import __version__

TYPE_CHECKING = False
"""What type checkers take for true, as typing.TYPE_CHECKING, which costs as much to import as all of this file."""

if TYPE_CHECKING:
    from shviewer.analysis.projected import Projected
    from shviewer.api import evaluate_basis, find_light, info, project, reconstruct, report
    from shviewer.errors import ShviewerError
    from shviewer.pictures import screenshot, view

__all__ = [
    "Projected",
    "ShviewerError",
    "__version__",
    "evaluate_basis",
    "find_light",
    "info",
    "project",
    "reconstruct",
    "report",
    "screenshot",
    "view",
]

_HOMES = {
    "ShviewerError": "shviewer.errors",
    "Projected": "shviewer.analysis.projected",
    **dict.fromkeys(("evaluate_basis", "find_light", "info", "project", "reconstruct", "report"), "shviewer.api"),
    **dict.fromkeys(("screenshot", "view"), "shviewer.pictures"),
}


def __getattr__(name: str) -> object:
    from importlib import import_module

    import shviewer.notebook as notebook

    if name not in _HOMES:
        raise AttributeError(f"module 'shviewer' has no attribute {name!r}")
    notebook.drawing = _drawing
    return getattr(import_module(_HOMES[name]), name)


def _drawing(shown: object) -> bytes:
    from shviewer.pictures import picture_bytes

    return picture_bytes(shown)


def __dir__() -> list[str]:
    return sorted(__all__)
