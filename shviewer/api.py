"""The functions of `import shviewer`, each of which does what the command of its name does.

A light is what `find_light` takes: a text that the command line would take for LIGHT, a path, a function of directions, an
array, or a Light. `options` are those of the window, by their names in ViewState; OPTIONS_HELP lists them.

ShviewerError, with one line that says what to do, where an argument is out of range or a light is bad.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import fields, replace
from operator import index
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shviewer.errors import UsageError
from shviewer.harmonics import basis, synthesis
from shviewer.harmonics.basis import Array, count_bands

if (
    TYPE_CHECKING
):  # each function imports what it needs: mathematics alone loads no light, and what is projected is not drawn
    from shviewer.analysis.projected import Projected
    from shviewer.benchmark.run import Summary
    from shviewer.lights.light import Light
    from shviewer.viewer.state import ViewState

OPTIONS_HELP = """options:
        quantity        "radiance" (default) or "irradiance"
        window          "none", "hann", "lanczos", "gauss" or "dering"; window_width in bands, as many as are shown unless given
        muted           bands to leave out
        method          "best" (default, the light's own), "jittered" or "gauss-legendre", with `samples` and `seed`
        split_sun       take suns out of the light
        exposure_stops  fixed, instead of chosen from the light
        camera          azimuth and elevation, degrees
        zoom            0.25 to 16
        tone            "none" (default), "reinhard", "aces" or "log"
        error           "off" (default), "signed", "absolute" or "relative": a third sphere; error_range ends its colours
        marks           False: no rings at the minimum and the largest error
        lobe_view       surfaces whose radius is the magnitude; basis, such as (2, -1): one function as the second of them
        sheet           "convergence": the error against the number of bands
        evaluate        "direct", "map" or "auto" (default): how the reconstruction is drawn
        compare         somebody else's coefficients, shown instead of the light's own: a path, an array or a light of them
"""
"""At the end of the docstring of every function that takes them."""

LightLike: TypeAlias = "str | os.PathLike[str] | Light | Callable[[Any], ArrayLike] | NDArray[np.generic]"

OPTIONS = frozenset(
    (
        "quantity",
        "window",
        "window_width",
        "muted",
        "method",
        "samples",
        "seed",
        "split_sun",
        "exposure_stops",
        "camera",
        "zoom",
        "tone",
        "error",
        "error_range",
        "marks",
        "lobe_view",
        "basis",
        "sheet",
        "evaluate",
        "compare",
    )
)

_Function = TypeVar("_Function", bound=Callable[..., Any])


def _with_options(function: _Function) -> _Function:
    function.__doc__ = f"{function.__doc__}{OPTIONS_HELP}"
    return function


def reconstruct(coefficients: ArrayLike, directions: ArrayLike) -> Array:
    """The function with the coefficients (n**2, 3) of harmonics/basis.py in directions (..., 3) of any length: (..., 3).

    ShviewerError if n**2 is no square or a row has not three numbers, or for a direction that is zero or not finite.
    """
    try:
        numbers = np.asarray(coefficients, dtype=np.float64)
        if numbers.ndim != 2 or numbers.shape[1] != 3:
            raise UsageError(f"coefficients of shape {numbers.shape}: they are (n**2, 3), rows of red, green and blue")
        return synthesis.reconstruct(numbers, directions)
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


def evaluate_basis(directions: ArrayLike, n_bands: int) -> Array:
    """Every Y(l, m) of the first `n_bands` bands in directions (..., 3) of any length: (..., n_bands**2), float64.

    The convention is in harmonics/basis.py. ShviewerError for bad directions or too many bands.
    """
    try:
        return basis.evaluate_basis(directions, _whole(n_bands, "n_bands"))
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


WHOLE = ("samples", "seed")
NUMBERS = ("window_width", "exposure_stops", "zoom", "error_range")
WORDS = ("quantity", "window", "method", "tone", "error", "sheet", "evaluate")
PAIRS = {"camera": "azimuth and elevation in degrees, such as (30, 10)", "basis": "l and m, such as (2, -1)"}
NOT_SET = ("window_width", "exposure_stops", "error_range", "basis")
"""Those that may be None."""


def _checked(name: str, value: Any) -> Any:
    """An option of the type that it has to have. UsageError."""
    if value is None and name in NOT_SET:
        return None
    if name in WHOLE:
        return _whole(value, name)
    if name in NUMBERS and not _is_number(value):
        raise UsageError(f"{name} {value!r}: it must be a finite number")
    if name in WORDS and not isinstance(value, str):
        raise UsageError(f"{name} {value!r}: it must be a text")
    if name == "muted":
        if not isinstance(value, Iterable) or isinstance(value, str):
            raise UsageError(f"muted {value!r}: it must be several bands, such as [1, 3]")
        return frozenset(_whole(band, "muted band") for band in value)
    if name in PAIRS:
        if not (isinstance(value, Sequence) and len(value) == 2 and all(map(_is_number, value))):
            raise UsageError(f"{name} {value!r}: it must be {PAIRS[name]}")
        return tuple(_whole(part, name) for part in value) if name == "basis" else tuple(map(float, value))
    return value


def _checked_size(size: Any) -> tuple[int, int]:
    if not (isinstance(size, Sequence) and len(size) == 2):
        raise UsageError(f"size {size!r}: it must be width and height, such as (1280, 640)")
    return _whole(size[0], "width"), _whole(size[1], "height")


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.integer | np.floating) and bool(np.isfinite(value))


def find_light(what: LightLike, *, convention: str = "", sanitize: bool = False, layout: str = "auto") -> Light:
    """The light that `what` is.

    A text or a path is read as on the command line. A function takes unit directions (k, 3) and returns radiance (k, 3), or
    (k,) for grey, linear RGB. An array (n**2, 3) is coefficients in our convention, one of (height, width, 3) a lat-long image
    of linear radiance with +z on top and +x in the middle.
    convention: of a file that does not say its own, such as "three"; sanitize, layout: of an image.
    LightError if there is no such light or its file is bad.
    """
    from shviewer.lights import find
    from shviewer.lights.function import FunctionLight
    from shviewer.lights.reading import Reading

    if isinstance(what, str | os.PathLike):
        return find.find_light(os.fspath(what), Reading(sanitize=sanitize, layout=layout, convention=convention))
    if isinstance(what, np.ndarray):
        return _array_light(what)
    if hasattr(what, "integrand"):
        return cast("Light", what)
    if callable(what):
        return FunctionLight(what, getattr(what, "__name__", "function"))
    raise UsageError(f"a light of type {type(what).__name__}: give a name, a path, a function, an array or a Light")


def _array_light(array: NDArray[np.generic]) -> Light:
    from shviewer.lights.coefficient_light import CoefficientLight
    from shviewer.lights.environment import EnvironmentLight

    if not np.isfinite(array).all():
        raise UsageError("an array with NaN or infinite values is no light; radiance and coefficients are finite")
    if array.ndim == 3 and array.shape[2] == 3 and array.size:
        return EnvironmentLight(np.ascontiguousarray(array, dtype=np.float32))
    if array.ndim == 2 and array.shape[1] == 3 and not np.iscomplexobj(array):
        try:
            count_bands(array)
        except ValueError as error:
            raise UsageError(str(error)) from error
        return CoefficientLight(np.array(array, dtype=np.float64))
    raise UsageError(
        f"an array of shape {array.shape}: coefficients are (n**2, 3), a lat-long image is (height, width, 3)"
    )


def _state(light: LightLike, bands: int | None, options: dict[str, Any]) -> ViewState:
    """The state of the window with these options. UsageError for an unknown one."""
    from shviewer.analysis.comparison import as_the_file_holds
    from shviewer.viewer.state import ViewState
    from shviewer.viewer.view_limits import check

    if unknown := sorted(set(options) - OPTIONS):
        raise UsageError(
            f"option {unknown[0]!r}: there is {', '.join(field.name for field in fields(ViewState) if field.name in OPTIONS)}"
        )
    checked = {name: _checked(name, value) for name, value in options.items() if name != "compare"}
    count = None if bands is None else _whole(bands, "bands")
    found = find_light(light)
    if count is None:
        count = found.about.n_bands or ViewState.n_bands
    state = ViewState(lights=(found,), n_bands=count, **checked)
    check(state)
    if (given := options.get("compare")) is not None:
        state = _comparing(state, given)
        state = as_the_file_holds(state, quantity="quantity" not in options, bands=bands is None)
    return state


def _comparing(state: ViewState, given: LightLike) -> ViewState:
    from shviewer.analysis.compared_files import compared_with
    from shviewer.lights.coefficient_light import CoefficientLight

    if isinstance(given, str | os.PathLike):
        return compared_with(state, os.fspath(given), "compare=")[0]
    light = find_light(given)
    if not isinstance(light, CoefficientLight):
        raise UsageError(f"compare {light.name!r}: it must be coefficients, a file or an array (n**2, 3) of them")
    return replace(state, compare=light)


@_with_options
def project(light: LightLike, bands: int | None = None, **options: Any) -> Projected:
    """The first `bands` bands of a light, 1 to 128, with their error figures; by default 5, or all of a coefficient file.

    `Projected.coefficients` is (bands**2, 3) float64 in the convention of harmonics/basis.py, row l(l+1) + m; `save` writes a
    file and `numbers` converts, both for other programs, too. ShviewerError for whatever a caller can put right.

    """
    from shviewer.analysis.projected import project_state

    return project_state(_state(light, bands, options))


@_with_options
def screenshot(
    light: LightLike,
    bands: int | None = None,
    *,
    size: tuple[int, int] = (1280, 640),
    overlay: bool = True,
    **options: Any,
) -> NDArray[np.uint8]:
    """The picture of the window: (height, width, 3) uint8, sRGB, top row first. size: width and height in pixels.

    overlay: with captions and figures. GraphicsError where there is no OpenGL 3.3.

    """
    from shviewer.viewer.composition import compose
    from shviewer.viewer.picture import prepare
    from shviewer.viewer.screenshot import headless_renderer, render_rgb
    from shviewer.viewer.view_limits import check

    state = _state(light, bands, options)
    check(state, _checked_size(size))
    picture = prepare(state)
    with headless_renderer() as renderer:
        return render_rgb(renderer, picture, compose(*size, state.zoom, n_spheres=state.n_spheres), overlay=overlay)


@_with_options
def view(
    light: LightLike = "green", bands: int | None = None, *, size: tuple[int, int] = (1280, 640), **options: Any
) -> None:
    """Open the window and stay until it is closed. size: width and height in screen coordinates.

    NoDisplayError without a display, GraphicsError without OpenGL 3.3.

    """
    from shviewer.viewer.desktop import window
    from shviewer.viewer.view_limits import check

    state = _state(light, bands, options)
    check(state, _checked_size(size))
    window.run(state, size)


def report(
    of: LightLike | Iterable[LightLike] = (),
    folder: str | os.PathLike[str] = "shviewer-report",
    *,
    quick: bool = False,
    budget: float | None = None,
) -> Summary:
    """Measure speed against error on this machine and write report.md, .json, .csv and plots into `folder`.

    of: a light or several; none for the built-in choice. budget: seconds of measuring, 120 unless given; quick: 15 s in all.
    OutputError if nothing can be written there.
    """
    from shviewer.benchmark.options import DEFAULT_BUDGET, Options
    from shviewer.benchmark.run import write_report

    several = isinstance(of, Iterable) and not isinstance(of, str | os.PathLike | np.ndarray)
    chosen = [find_light(one) for one in (cast(Iterable[LightLike], of) if several else [cast(LightLike, of)])]
    wanted = Options(budget=DEFAULT_BUDGET if budget is None else budget, quick=quick, command="shviewer.report(...)")
    return write_report(chosen, Path(folder), wanted)


def _whole(value: object, name: str) -> int:
    """UsageError unless it is a whole number of some integer type."""
    try:
        if isinstance(value, bool):
            raise TypeError
        return index(value)  # type: ignore[arg-type]
    except TypeError:
        raise UsageError(f"{name} {value!r}: it must be a whole number, such as 5") from None
