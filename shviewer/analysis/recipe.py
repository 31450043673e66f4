"""The recipe: everything that coefficients and their figures follow from, and nothing about how they are shown."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from shviewer.analysis.options import (
    BandSet,
    Choice,
    Flag,
    Number,
    Quantity,
    Share,
    Whole,
    WholeOr,
    check_options,
    option,
)
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.names import ENCODED_BANDS, IRRADIANCE, RADIANCE
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS, MAX_SAMPLES
from shviewer.words import counted

if TYPE_CHECKING:
    from shviewer.lights.coefficient_light import CoefficientLight
    from shviewer.lights.light import Light

METHODS = ("best", "jittered", "gauss-legendre")
WINDOWS = ("none", "hann", "lanczos", "gauss", "dering")


def window_of(text: str) -> dict[str, str | float | None]:
    """The options that a window is, perhaps with its width, as in "hann:4". UsageError for a width that cannot be."""
    window, separator, width = text.partition(":")
    if not separator:
        return {"window": window, "window_width": None}
    if window in ("none", "dering"):
        raise UsageError(f"window {text!r}: {window} has no width; hann, lanczos and gauss have one")
    try:
        return {"window": window, "window_width": float(width)}
    except ValueError:
        raise UsageError(f"window {text!r}: its width must be a number of bands, such as {window}:4") from None


class Shown(NamedTuple):
    """The part of a projection that is shown: the bands in use, the muted ones among them, the window and its width."""

    n_bands: int
    muted: tuple[int, ...] = ()
    window: str = "none"
    window_width: float | None = None


@dataclass(frozen=True)
class Recipe:
    """A light and all options that its numbers depend on. Equal recipes give equal numbers."""

    light: str | Light = "green"
    """A text that `find_light` takes, or a light."""
    reading: Reading = DEFAULT_READING
    n_bands: int = option(
        5,
        Whole(1, MAX_BANDS, "{} bands", f"the viewer shows 1 to {MAX_BANDS}"),
        f"number of bands, 1 to {MAX_BANDS} (default 5)",
        "--bands N",
    )
    tolerance: float = option(
        0.05,
        Share(0, 1, "it must be between 0 and 1, such as 0.05 or 5%", closed=False),
        "as many bands as keep the relative L2 error within T, such as 5% or 0.05; with --bands, what counts as enough",
        "--tolerance T",
    )
    quantity: str = option(
        RADIANCE,
        Quantity(),
        "radiance (default), irradiance: what a white Lambertian surface receives, or glossy:R, such as glossy:0.4: what a"
        " glossy surface of roughness R reflects (0.1 to 1)",
        "--for WHAT",
    )
    split_sun: bool = option(
        False,
        Flag(),
        "take suns out of the light as discs of their own and project the rest",
        "--split-sun",
        const=True,
    )
    suns: int | str = option(
        "auto",
        WholeOr(("auto", "all"), 16),
        "what --split-sun takes: auto (default), one or two suns; or so many of the compact sources, lamps among them; or all",
        "--suns N",
    )
    window: str = option(
        "none",
        Choice(WINDOWS),
        "none, hann, lanczos, gauss (WIDTH in bands, default N) or dering",
        "--window W[:WIDTH]",
    )
    window_width: float | None = option(
        None,
        Number(0, float("inf"), "it must be positive and finite, in bands", closed=False),
        "width of the window in bands; as many as are shown unless given",
    )
    muted: frozenset[int] = option(
        frozenset(), BandSet(MAX_BANDS), "bands to leave out, such as 1,3 or 2-4", "--mute L,L"
    )
    method: str = option(
        "best", Choice(METHODS), "best (of this light), jittered (the paper's) or gauss-legendre", "--method M"
    )
    samples: int = option(
        10_000,
        Whole(1, MAX_SAMPLES, "{} samples", f"there must be 1 to {MAX_SAMPLES}"),
        "number of samples of the sampled methods (default 10000)",
        "--samples K",
    )
    seed: int = option(
        0,
        Whole(0, float("inf"), "seed {}", "it must not be negative"),
        "seed of the jittered samples (default 0)",
        "--seed S",
    )
    turn: tuple[float, ...] | None = None
    """The matrix from directions of the world to those of the light, row by row, where the light is projected as it stands in
    the world: samples then stand still while it turns. None: it is projected as it was defined."""
    compare: CoefficientLight | None = None
    """Given coefficients, shown instead of the light's own; no more bands than they have are shown."""

    @property
    def muted_shown(self) -> tuple[int, ...]:
        """The muted bands among those in use."""
        return tuple(sorted(band for band in self.muted if band < self.n_bands))

    @property
    def shown(self) -> Shown:
        return Shown(self.n_bands, self.muted_shown, self.window, self.window_width)

    @property
    def projected_bands(self) -> int:
        """The number of bands to project: more than are shown, so that a few more or fewer cost nothing."""
        return MAX_DIRECT_BANDS if self.n_bands <= MAX_DIRECT_BANDS else MAX_BANDS

    def check(self) -> None:
        """UsageError unless every option is within its range."""
        check_options(self)


def check_encoding(recipe: Recipe, encoding: str) -> None:
    """UsageError unless the recipe's numbers are those of an encoding."""
    if recipe.quantity != IRRADIANCE:
        raise UsageError(f"encode {encoding}: engines store it of irradiance; give --for irradiance")
    if recipe.compare:
        raise UsageError(f"encode {encoding}: coefficients that are compared are shown as they are; leave one out")
    if recipe.n_bands != ENCODED_BANDS[encoding]:
        bands = counted(ENCODED_BANDS[encoding], "band")
        raise UsageError(
            f"encode {encoding}: it stands for {bands}, not {recipe.n_bands}; leave out the number of bands"
        )


NEEDS: dict[str, tuple[Callable[[Recipe], bool], str]] = {
    "suns": (lambda recipe: recipe.split_sun, "it says what {split_sun} takes; give that, too"),
    "samples": (
        lambda recipe: recipe.method != "best",
        "the best method draws none; give {method} jittered or gauss-legendre, too",
    ),
    "seed": (lambda recipe: recipe.method == "jittered", "jittered samples have one; give {method} jittered, too"),
    "muted": (
        lambda recipe: len(recipe.muted_shown) == len(recipe.muted),
        "bands are counted from 0, and there are {bands}; leave out what is above",
    ),
}
"""Options that can be without any effect: whether a recipe lets them have one, and what is missing, {option} by its name."""

OF_SAMPLES = ("samples", "seed")
"""Options that have an effect on a second reconstruction by another method, too."""


def idle(recipe: Recipe, given: Iterable[str]) -> list[str]:
    """The options among those given that change nothing in a recipe."""
    return [name for name in given if name in NEEDS and not NEEDS[name][0](recipe)]


def what_it_needs(name: str, recipe: Recipe, names: Mapping[str, str]) -> str:
    """What is missing for an option to have an effect. names: the name of each option where it was given."""
    return NEEDS[name][1].format(bands=counted(recipe.n_bands, "band"), **names)


def light_name(light: str | Light) -> str:
    """The short name of a light: the last part of its path."""
    return light.replace("\\", "/").rpartition("/")[2] if isinstance(light, str) else light.name
