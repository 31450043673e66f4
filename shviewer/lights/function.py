"""A light that is a Python function of directions."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike

from shviewer.errors import LightError
from shviewer.files import naming, read_bytes
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.harmonics.projection import project_product
from shviewer.harmonics.quadrature import gauss_legendre
from shviewer.lights.irradiance import RadianceLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.limits import DEFAULT_LIMITS, Limits, check_brightness

MAX_CODE_BYTES = 2**22

SAMPLED_BANDS = 128
"""The bands that decide how many points the quadrature needs; more are projected on request."""

FIRST_ROWS, LAST_ROWS = 160, 640
"""Gauss-Legendre rows to begin with (exact for products of two functions of 160 bands) and to stop at."""

MOVEMENT = 5e-4
"""The rows are doubled until the relative L2 error moves by no more than this with any number of bands."""


@dataclass(frozen=True, eq=False)
class _Sampling:
    """Results of a Gauss-Legendre rule of `rows` rows; `movement`: how far the errors moved at the last doubling."""

    rows: int
    coefficients: Array
    products: Array
    movement: float


DirectionFunction = Callable[[Array], ArrayLike]
"""Unit directions (k, 3) -> radiance (k, 3), or (k,) for grey."""


@dataclass(frozen=True, eq=False)
class FunctionLight(RadianceLight):
    """The light of a `function` that takes unit directions (k, 3) and returns radiance (k, 3), or (k,) for grey.

    LightError if it raises, or returns another shape, a value that is not finite, or more radiance than can be shown.
    """

    function: DirectionFunction
    name: str = "function"

    lobes = ()

    @property
    def description(self) -> str:
        return "Python function"

    @property
    def best_method(self) -> str:
        points = f"{2 * self._sampling.rows**2:,}".replace(",", " ")
        return f"Gauss-Legendre, {points} points"

    @property
    def notes(self) -> tuple[str, ...]:
        sampling = self._sampling
        if sampling.movement <= MOVEMENT:
            return ()
        return (f"not smooth: {2 * sampling.rows**2} points leave the figures uncertain by {sampling.movement:.2%}",)

    def radiance(self, directions: Array) -> Array:
        try:
            with np.errstate(all="ignore"):  # what is not finite is refused below
                found = np.asarray(self.function(directions.copy()))  # it may write into its argument
            if found.dtype.kind in "cMm" or isinstance(found, np.ma.MaskedArray):
                raise TypeError(f"radiance is plain real numbers, and these values are of type {found.dtype}")
            values = found.astype(np.float64)
        except (Exception, SystemExit) as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            where = f"{Path(last.filename).name}:{last.lineno}"
            raise LightError(f"{self.name}: the function raised {type(error).__name__} at {where}: {error}") from error
        if values.shape == (len(directions),):
            values = np.repeat(values[:, None], 3, axis=1)
        if values.shape != (len(directions), 3):
            raise LightError(
                f"{self.name}: for directions of shape {directions.shape} the function returned shape {values.shape}; "
                f"it must be {(len(directions), 3)} or {(len(directions),)}"
            )
        if not np.isfinite(values).all():
            bad = int(np.argmin(np.isfinite(values).all(axis=1)))
            raise LightError(
                f"{self.name}: the function returned {values[bad].tolist()} for direction {directions[bad].tolist()}; "
                "radiance must be finite"
            )
        check_brightness(float(np.abs(values).max(initial=0.0)), self.name)
        return values

    def coefficients(self, n_bands: int) -> Array:
        sampling = self._sampling
        if n_bands <= SAMPLED_BANDS:
            return sampling.coefficients[: n_bands**2]
        return project_product(self.radiance, gauss_legendre(2 * max(sampling.rows, n_bands + 1) ** 2), n_bands)[0]

    @property
    def kept_bands(self) -> int:
        return SAMPLED_BANDS if "_sampling" in vars(self) else 0

    def products(self) -> Array:
        return self._sampling.products

    def accuracy(self) -> float:
        return self._sampling.movement

    @cached_property
    def _sampling(self) -> _Sampling:
        """Sample with as many points as the function's sharpness needs, up to a limit."""
        rows, last = FIRST_ROWS, None
        while True:
            coefficients, products = project_product(self.radiance, gauss_legendre(2 * rows**2), SAMPLED_BANDS)
            errors = errors_by_band_count(products, coefficients, coefficients)
            movement = float("inf") if last is None else float(np.abs(errors - last).max())
            if movement <= MOVEMENT or 2 * rows > LAST_ROWS:
                return _Sampling(rows, coefficients, products, movement)
            rows, last = 2 * rows, errors

    @cached_property
    def map(self) -> LatLongMap:
        return LatLongMap.pole_to_pole(self.rows)


def load_function(path: Path, function: str, limits: Limits = DEFAULT_LIMITS) -> FunctionLight:
    """The light `function` of the Python file `path`. LightError if the file or the function is missing or fails.

    The file is compiled here and not through Python's cache, which takes two versions for one if they have the same size
    and were written in the same second.
    """
    with naming(str(path)):
        code = read_bytes(path, limits, MAX_CODE_BYTES, f"code of a light has at most {MAX_CODE_BYTES}")
    module = ModuleType(f"_light_function_{path.stem}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # dataclasses look their module up
    folder = str(path.parent.resolve())
    sys.path.insert(0, folder)  # as for a script: its neighbours can be imported
    try:
        exec(compile(code, path, "exec"), vars(module))
    except (Exception, SystemExit) as error:
        raise LightError(f"{path}: importing it raised {type(error).__name__}: {error}") from error
    finally:
        sys.path.remove(folder)
    found = getattr(module, function, None)
    if not callable(found):
        there = sorted(name for name, value in vars(module).items() if callable(value) and not name.startswith("_"))
        raise LightError(f"{path}: no function {function!r}; there is: {', '.join(there) or 'none'}")
    return FunctionLight(found, function)
