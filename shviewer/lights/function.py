"""A light that is a Python function of directions."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike

from shviewer.errors import LightError
from shviewer.files import naming, read_bytes
from shviewer.harmonics.basis import Array, check_bands, count_bands
from shviewer.harmonics.sampling.sampled import Sampled, sample
from shviewer.harmonics.theta_series import MAX_SEPARABLE_BANDS
from shviewer.lights.convolved import RadianceLight
from shviewer.lights.lat_long import LatLongMap
from shviewer.limits import DEFAULT_LIMITS, Limits, check_brightness
from shviewer.words import grouped, meant, theta_phi_degrees

MAX_CODE_BYTES = 2**22

SAMPLED_BANDS = 128
"""The bands of a function that are at hand once it is sampled."""

NOTHING = 1e-5
"""A relative L2 error of those that is less leaves nothing for more bands to hold."""

UNCERTAIN = 5e-4
"""An uncertainty of the figures above this is said in a note."""

NEWS = 1.5
"""A radiance that is this many times the largest one that the coefficients are made of is news."""

MOST_LANDMARKS = 8
NEAR = np.cos(np.radians(6))
"""The cosine of an angle: so near to a place that was refined, nothing is news."""


DirectionFunction = Callable[[Array], ArrayLike]
"""Unit directions (k, 3) -> radiance (k, 3), or (k,) for grey."""


@dataclass(frozen=True, eq=False, repr=False)
class FunctionLight(RadianceLight):
    """The light of a `function` that takes unit directions (k, 3) and returns radiance (k, 3), or (k,) for grey.

    LightError if it raises, or returns another shape, a value that is not finite, or more radiance than can be shown.
    """

    function: DirectionFunction
    name: str = "function"
    _news: list[tuple[float, tuple[float, ...]]] = field(default_factory=list, init=False, repr=False)
    """The largest radiance that was met after the function had been sampled, and is not in the samples, and its direction."""

    KEEPS = ("_held", "_sampled")
    lobes = ()

    @property
    def description(self) -> str:
        return "Python function"

    @property
    def best_method(self) -> str:
        sampled = self._sampled
        rows, evaluations = sampled.rows, sampled.evaluations
        rule, points = ("Gauss-Legendre", 2 * rows**2) if rows else ("adaptive cells", evaluations)
        return f"{rule}, {grouped(points)} points; {self._missed}"

    @property
    def _missed(self) -> str:
        return f"features narrower than {self._sampled.seen_degrees:.2g} degrees may be missed"

    @property
    def notes(self) -> tuple[str, ...]:
        sampled, notes = self._sampled, list[str]()
        if sampled.accuracy > UNCERTAIN:
            points = f"{sampled.evaluations} points leave the figures uncertain by {sampled.accuracy:.2%}"
            notes.append(f"not smooth: {points}; {self._missed}")
        if not self._steady:
            notes.append("its values for the same directions differ from call to call: what is shown is one of many")
        if self._news:
            radiance, direction = max(self._news)
            theta, phi = theta_phi_degrees(np.array(direction))
            where = f"theta {theta:.2f}, phi {phi:z.2f} degrees"
            notes.append(f"radiance {radiance:.3g} at {where} is not in the coefficients: {self._missed}")
        return tuple(notes)

    def radiance(self, directions: Array) -> Array:
        try:
            with np.errstate(all="ignore"):  # what is not finite is refused below
                returned = self.function(directions.copy())  # it may write into its argument
        except (Exception, SystemExit) as error:
            last = traceback.extract_tb(error.__traceback__)[-1]
            where = "" if last.filename == __file__ else f" at {Path(last.filename).name}:{last.lineno}"
            said = f"{self.name}: the function raised {type(error).__name__}{where}: {error}"
            if isinstance(error, TypeError | ValueError | IndexError):  # as code for a single direction does
                said += f"; it is called with all directions at once, an array {directions.shape}"
            raise LightError(said) from error
        values = self._plain(returned)
        if values.shape == (len(directions),):
            values = np.repeat(values[:, None], 3, axis=1)
        if values.shape != (len(directions), 3):
            raise LightError(
                f"{self.name}: for directions of shape {directions.shape} the function returned shape {values.shape}; "
                f"it must be {(len(directions), 3)} or {(len(directions),)}"
            )
        least, most = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
        if not (np.isfinite(least) and np.isfinite(most)):
            bad = int(np.argmin(np.isfinite(values).all(axis=1)))
            raise LightError(
                f"{self.name}: the function returned {values[bad].tolist()} for direction {directions[bad].tolist()}; "
                "radiance must be finite"
            )
        check_brightness(max(-least, most), self.name)
        known: Sampled | None = vars(self).get("_sampled")
        if known is not None and max(-least, most) > NEWS * known.peak:
            self._note_news(directions, values, known)
        return values

    def _plain(self, returned: ArrayLike) -> Array:
        """What the function returned as float64. LightError if it is not plain real numbers."""
        if returned is None:
            raise LightError(f"{self.name}: the function returned None; end it with return radiance")
        try:
            found = np.asarray(returned)
            masked = isinstance(returned, np.ma.MaskedArray)
            if found.dtype.kind not in "cMm" and not masked:
                return found.astype(np.float64)
            fault = "a masked array" if masked else f"values of type {found.dtype}"
        except (TypeError, ValueError) as error:
            fault = f"what is no array of numbers ({error})"
        raise LightError(f"{self.name}: the function returned {fault}; radiance is plain real numbers")

    def _note_news(self, directions: Array, values: Array, known: Sampled) -> None:
        size = np.abs(values).max(axis=1)
        news = np.flatnonzero(size > NEWS * known.peak)
        if len(known.places):
            news = news[(directions[news] @ known.places.T).max(axis=1) < NEAR]
        if len(news):
            best = news[size[news].argmax()]
            self._news[:] = [max([*self._news, (float(size[best]), tuple(directions[best].tolist()))])]

    def coefficients(self, n_bands: int) -> Array:
        """As in Light. The most bands asked for so far are kept."""
        check_bands(n_bands, MAX_SEPARABLE_BANDS)
        if len(self._held[0]) < n_bands**2:
            self._held[0] = self._sampled.with_more_bands(self.radiance, n_bands)
        return self._held[0][: n_bands**2]

    @cached_property
    def _steady(self) -> bool:
        """Whether it gives the same values for the same directions."""
        return np.array_equal(self.radiance(np.eye(3)), self.radiance(np.eye(3)))

    @cached_property
    def _held(self) -> list[Array]:
        return [self._sampled.coefficients]

    @property
    def most_bands(self) -> int:
        return SAMPLED_BANDS if self._sampled.left_out < NOTHING else MAX_SEPARABLE_BANDS

    @property
    def kept_bands(self) -> int:
        if "_held" in vars(self):
            return count_bands(self._held[0])
        return SAMPLED_BANDS if "_sampled" in vars(self) else 0  # for its map

    def products(self) -> Array:
        return self._sampled.products

    def accuracy(self) -> float:
        return max(self._sampled.accuracy, 1.0) if self._news else self._sampled.accuracy

    def landmarks(self) -> Array:
        return self._sampled.places[:MOST_LANDMARKS]

    @cached_property
    def map(self) -> LatLongMap:
        return LatLongMap(self._sampled.texels, rows_on_poles=True)

    @cached_property
    def _sampled(self) -> Sampled:
        return sample(self.radiance, SAMPLED_BANDS)


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
        offer = meant(function, there, f"there is: {', '.join(there) or 'none'}")
        raise LightError(f"{path}: no function {function!r}; {offer}")
    return FunctionLight(found, function)
