"""The result of `shviewer project`: the coefficients of a recipe, in our convention, with figures and origin."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shviewer.analysis.figures import Figures, Sums, irradiance_error, lows_of
from shviewer.analysis.origin import ERRORS, origin_of
from shviewer.analysis.recipe import Recipe, check_encoding
from shviewer.analysis.reconstruction import reconstruction_of
from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.channels import SEQUENCES
from shviewer.coefficients.parts.quantities import whole
from shviewer.coefficients.stamp import Value, stamp_of
from shviewer.coefficients.stored_code import check_stored, in_axes
from shviewer.coefficients.suns import sun_keys
from shviewer.coefficients.texts import parse_convention
from shviewer.coefficients.writing import encode, encode_stored
from shviewer.errors import LightError, UsageError, refused_as
from shviewer.harmonics.basis import Array, count_bands
from shviewer.harmonics.extremes.error_grid import Lows, Triple
from shviewer.harmonics.quantities.encodings import Stored
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE
from shviewer.harmonics.rotation import check_rotation, rotate
from shviewer.lights.find import file_of
from shviewer.lights.suns.sun import Sun
from shviewer.limits import MAX_BANDS
from shviewer.notebook import InNotebooks
from shviewer.outputs import Replacing, write_atomically
from shviewer.version import __version__
from shviewer.words import counted


@dataclass(frozen=True, eq=False)
class Projected(InNotebooks):
    """Coefficients of a light in our convention, (n**2, 3) float64: muted bands are zero and the window is applied.

    `quantity` is "radiance", "irradiance" or one such as "glossy:0.4"; `figures` compare them with the light. `about` says
    where they come from.
    """

    coefficients: Array
    quantity: str
    sums: Sums
    """The figures that need no search."""
    lows: Lows
    """The lowest of the reconstruction, and how much of it is below zero."""
    irradiance_relative_l2: float
    """As in `Figures`."""
    about: dict[str, Value]
    name: str
    relative_l2_as: dict[str, float] = field(default_factory=dict)
    """The relative L2 errors of "radiance", of "irradiance" and of the quantity, whichever the coefficients hold."""
    suns: tuple[Sun, ...] = ()
    """The suns left out of the light, and so of the coefficients; the greatest flux first, in our axes."""
    inputs: tuple[Path, ...] = ()
    """The files that the light, and coefficients compared with it, were read from."""
    notes: tuple[str, ...] = ()
    """The notes on the light, such as negative texels, and why no sun was found where one was asked for."""
    below_zero: str = ""
    """One line on how far below zero it goes, to be printed once it is written."""
    searched: Figures | None = None
    """All figures, once they have been asked for."""
    turn: Array | None = None
    """The rotation (3, 3) by which it was turned; None for none."""
    recipe: Recipe | None = None
    """The recipe, which a notebook draws. It may hold an image, so it is not pickled."""
    encoding: str = ""
    """One of ENCODINGS, whose bands the coefficients are."""
    stored: Stored | None = None
    """Its numbers, which are written in place of the bands; None where a window or muted bands leave it no formula."""

    def __repr__(self) -> str:
        return f"<{self.name}: {self.quantity} in {self.extent}, relative L2 error {self.sums.relative_l2:.3g}>"

    def __getstate__(self) -> dict[str, object]:
        return vars(self) | {"recipe": None, "searched": self._all_figures()}

    @property
    def figures(self) -> Figures:
        """All figures. Those of the error are searched for when they are first asked for: no file holds them.

        LightError if the light has to be read again for that, and has changed.
        """
        figures = self._all_figures()
        if self.turn is None:
            return figures
        extremes = figures.extremes
        largest, lowest = (
            cast(Triple, tuple((self.turn @ np.array(direction)).tolist()))
            for direction in (extremes.max_error_direction, extremes.minimum_direction)
        )
        return replace(figures, extremes=replace(extremes, max_error_direction=largest, minimum_direction=lowest))

    def _all_figures(self) -> Figures:
        """The figures of the light as it is, not turned. It holds no light, which may be an image: that is looked up."""
        if self.searched is None:
            turn = None if self.turn is None else _by_rows(self.turn)
            if (
                self.recipe is None
                or (found := reconstruction_of(self.recipe, 0, self.encoding, turn)).sums != self.sums
            ):
                raise LightError(f"{self.name} has changed since it was projected: project it again")
            object.__setattr__(self, "searched", found.figures)
            return found.figures
        return self.searched

    @property
    def n_bands(self) -> int:
        return count_bands(self.coefficients)

    @property
    def extent(self) -> str:
        """What is written, in words: "5 bands", or "5 numbers a channel, zh3" """
        if self.stored is None:
            return counted(self.n_bands, "band")
        return f"{len(self.stored.numbers)} numbers a channel, {self.stored.name}"

    def numbers(self, convention: str = "shviewer") -> NDArray[np.generic]:
        """The numbers that a program expects, (n**2, 3) float64, or complex128 for "scipy".

        convention: as --convention takes it. UsageError if it is unknown or contradictory, or for more bands than it has.
        """
        with refused_as(UsageError):
            return self._in(parse_convention(convention))

    def turned(self, rotation: ArrayLike) -> Projected:
        """The same of the light carried along by a rotation, a 3 x 3 matrix, v_out = M v_in. ValueError for another matrix.

        Suns and the directions of the figures turn with it; other figures stay. An ambient cube and its figures are made anew.
        """
        matrix = check_rotation(rotation)
        whole = matrix if self.turn is None else matrix @ self.turn
        still, by = self, matrix
        if self.stored is not None and not self.stored.encoding.turns:
            if self.recipe is None:
                raise LightError(f"{self.name}: a cube that is turned is made of the light: project that again")
            still, by = project_recipe(self.recipe, self.encoding, _by_rows(whole)), whole
        return replace(
            still,
            coefficients=rotate(still.coefficients, by),
            stored=still.stored and still.stored.turned(by),
            turn=whole,
            about=still.about | {"turned": " ".join(f"{value:.12g}" for value in whole.ravel() + 0.0)},
            suns=tuple(replace(sun, axis=by @ sun.axis) for sun in still.suns),
        )

    def save(self, path: str | os.PathLike[str], convention: str = "shviewer", *, force: bool = False) -> None:
        """Write a .json, .csv, .npz, .h, .glsl, .hlsl, .js or .cs file, with everything stamped on it, whole or not at all.

        A file that the light was read from is never replaced, and one that shviewer did not write only by `force`.
        UsageError for another suffix or a convention that does not fit, OutputError if it cannot be written.
        """
        if not isinstance(path, str | os.PathLike):
            raise UsageError(f"a file of type {type(path).__name__}: give a path; numbers() has the numbers alone")
        with refused_as(UsageError):
            chosen = parse_convention(convention)
        out = Path(path)
        data = self.encode(chosen, out.suffix.lower()[1:])
        Replacing(self.inputs, force).check(out)
        write_atomically(out, data)

    def encode(self, convention: Convention, kind: str) -> bytes:
        """The bytes of a coefficient file; kind: one of `coefficients.writing.FORMATS`.

        UsageError if the convention has too few bands, cannot hold the quantity, or cannot be written as `kind`.
        """
        with refused_as(UsageError):
            if self.stored is not None:
                return encode_stored(self.stored, self.stamp(convention, self.n_bands), convention, kind, self.name)
            numbers = self._in(convention)
            return encode(numbers, self.stamp(convention, count_bands(numbers)), convention, kind, self.name)

    def _in(self, convention: Convention) -> NDArray[np.generic]:
        """The rows in a convention. ValueError if it cannot have them."""
        if self.stored is not None:
            check_stored(self.stored.encoding, convention)
            return in_axes(self.stored, convention.axes)
        if convention.sequence in SEQUENCES:
            raise ValueError(
                f"{convention.sequence} says how a list is read; what is written has a row for each l and m: leave it out"
            )
        return convention.from_ours(self.coefficients, self.quantity)

    def stamp(self, convention: Convention, n_bands: int) -> dict[str, Value]:
        """The stamp of a file with these coefficients in a convention."""
        about = {**stamp_of(convention, self.quantity, n_bands), "written-by": f"shviewer {__version__}", **self.about}
        if self.stored is not None:
            del about["bands"]
            about["rows"] = len(self.stored.numbers)
        written = whole(str(about["quantity"]))
        if written != self.quantity:  # the errors of one quantity are not those of the other
            about = {key: value for key, value in about.items() if key not in ERRORS}
            if written == IRRADIANCE:
                about["relative-l2"] = self.irradiance_relative_l2
        return about | sun_keys([sun.directional_light for sun in self.suns], convention.axes)


def project_recipe(recipe: Recipe, encoding: str = "", turn: tuple[float, ...] | None = None) -> Projected:
    """The coefficients that the window shows for a recipe. LightError or UsageError, as in `reconstruction_of`.

    encoding: one of ENCODINGS, or "" for the bands; turn: the rotation of the light, row by row, for whose axes a cube is made.
    """
    if encoding:
        check_encoding(recipe, encoding)
    found = reconstruction_of(recipe, MAX_BANDS, encoding, turn)
    shown, projection, of_radiance = found.subject, found.projection, found.sums
    known = shown.light, projection, recipe.shown
    shading, lows = irradiance_error(*known), lows_of(*known)
    if recipe.quantity != RADIANCE and not encoding:
        of_radiance = reconstruction_of(replace(recipe, quantity=RADIANCE)).sums
    errors = {IRRADIANCE: shading} if encoding else {RADIANCE: of_radiance.relative_l2, IRRADIANCE: shading}
    errors[recipe.quantity] = found.sums.relative_l2
    about = origin_of(recipe, shown, projection, found.sums, lows, shading)
    if encoding and found.stored is None:
        about["through"] = encoding
    given = [recipe.light, *([recipe.compare] if recipe.compare else [])]
    inputs = tuple(path for path in map(file_of, given) if path)
    notes = (*shown.light.notes, *([shown.refusal] if shown.refusal else []))
    return Projected(
        found.coefficients,
        recipe.quantity,
        found.sums,
        lows,
        shading,
        about,
        shown.light.name,
        errors,
        shown.suns,
        inputs,
        notes,
        recipe=recipe,
        encoding=encoding,
        stored=found.stored,
    )


def _by_rows(matrix: Array) -> tuple[float, ...]:
    return tuple(matrix.ravel().tolist())
