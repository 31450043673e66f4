"""Draws panes: a light, its reconstruction or its error on a sphere or a map, by a program made for what is shown."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import moderngl
import numpy as np

from shviewer.harmonics.basis import count_bands
from shviewer.harmonics.zonal import Disc
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.lat_long import LatLongMap
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Pane, Pixels, Sphere
from shviewer.viewer.drawn import Drawn, Encoded, Source, SplineMap, Surfaces
from shviewer.viewer.gl.held import Held, kind_of
from shviewer.viewer.gl.programs import Program
from shviewer.viewer.gl.shared import CHOICES, FLOATS, profile_bits
from shviewer.viewer.picture import Picture
from shviewer.viewer.view import ERRORS

MOST_SAMPLES = 6
"""The most looks at a map along a side of a pixel."""

LEAST_HATCHED = 3
"""How many lines beyond white are the fewest that a sun has room for, if it has any."""

Chosen = tuple[str | int, ...]
"""What a program is made for: one of each of CHOICES, PROFILES and SAMPLES."""

Kind = tuple[object, ...]


class PaneRenderer:
    """One context's programs of sphere.frag. release() at the end."""

    def __init__(self, context: moderngl.Context, held: Held) -> None:
        self.programs: dict[Chosen, Program] = {}
        """By what they are made for, and whether they draw into a window: what Mesa has compiled for one framebuffer,
        it does not find on the disk for another."""
        self._context = context
        self._held = held

    def draw(self, picture: Picture, shown: str, pane: Pane, composition: Composition, *, linear: bool) -> None:
        """Draw a pane into the viewport, which is its `pixel_box`. linear: the radiance alone."""
        self._held.bind(picture, shown, beside=shown == "ERROR" and picture.beside is not None)
        picture, shown = _as_drawn(picture, shown)
        ends = np.cumsum([0, len(picture.original.lobes), len(picture.compared.lobes), len(picture.suns)]).tolist()
        source, lobes, suns = _source(picture, shown), tuple(ends[0:2]), tuple(ends[2:4])
        if shown == "ERROR":
            lobes, suns = tuple(ends[1:3]), (0, 0)
        program = self._program(_chosen(picture, shown, pane, linear=linear))
        light_from_pane = picture.light_from_world
        if isinstance(pane, Sphere):
            light_from_pane = light_from_pane @ picture.world_from_view
            program.set(radius=pane.radius)
        else:
            program.set(turn=pane.width)
        program.set(
            centre=(pane.x, composition.height - pane.y),
            light_from_pane=tuple(light_from_pane.T.ravel()),
            linear_output=linear,
            soft_edges=not linear,
            exposure=2.0**picture.exposure_stops,
            scale=max(composition.scale, 1.0),
            lines=float(picture.state.view.marks),
            n_bands=count_bands(picture.coefficients),
            original_lobes=lobes,
            sun_lobes=suns,
            wide_suns=shown != "RECONSTRUCTION" or _wide(picture.suns, pane, max(composition.scale, 1.0)),
            original_rows_on_poles=source.map is not None and source.map.rows_on_poles,
        )
        if isinstance(picture.drawn, Encoded):
            program.set(stored=[tuple(row) for row in picture.drawn.stored.with_axes.tolist()])
        scale = picture.error_scale
        if scale is not None:
            program.set(error_kind=ERRORS.index(scale.kind) - 1, error_range=scale.end, error_floor=scale.floor)
        program.draw()

    def release(self) -> None:
        for program in self.programs.values():
            program.release()

    def _program(self, chosen: Chosen) -> Program:
        """The program for some choices and for the framebuffer in use, made when first wanted."""
        key = *chosen, self._context.fbo.glo == 0
        if key not in self.programs:
            names = *CHOICES, "PROFILES", "SAMPLES"
            self.programs[key] = Program(self._context, "sphere.frag", dict(zip(names, chosen, strict=True)))
        return self.programs[key]


def kinds_of(picture: Picture, composition: Composition) -> set[Kind]:
    """Everything of a frame that compiling its programs depends on."""
    if isinstance(picture.drawn, Surfaces):
        return {(Surfaces,)}
    found = set[Kind]()
    for part, pane in shown_panes(picture, composition):
        one, shown = _as_drawn(picture, part)
        chosen = _chosen(one, shown, pane)
        found.add((chosen, kind_of(_source(one, shown).map if "MAP" in chosen[:2] else None)))
    return found


def _as_drawn(picture: Picture, shown: str) -> tuple[Picture, str]:
    """A second reconstruction is drawn as the one of a picture of its own."""
    if shown != "ERROR" or picture.beside is None:
        return picture, shown
    return replace(
        picture, coefficients=picture.beside.found.coefficients, drawn=picture.beside.drawn
    ), "RECONSTRUCTION"


def _source(picture: Picture, shown: str) -> Source:
    """The light that is drawn; that of the error is what is left without the suns, if there are any."""
    return picture.compared if shown == "ERROR" else picture.original


def _chosen(picture: Picture, shown: str, pane: Pane, *, linear: bool = False) -> Chosen:
    """The choices of a pane. What its program does not read makes no new one."""
    original = "LOBES" if picture.original.map is None or shown == "RECONSTRUCTION" else "MAP"
    reconstruction = _reconstruction(picture.drawn) if shown != "ORIGINAL" else "SUM"
    tone = "NONE" if shown == "ERROR" else picture.state.view.tone.upper()
    form = "SPHERE" if isinstance(pane, Sphere) else "MAP"
    lobes = picture.suns if shown == "RECONSTRUCTION" else _source(picture, shown).lobes
    samples = _samples(_source(picture, shown).map, pane) if original == "MAP" and not linear else 1
    return shown, original, reconstruction, tone, form, profile_bits(lobes), samples


def shown_panes(picture: Picture, composition: Composition) -> list[tuple[str, Pane]]:
    """What each pane shows, as a choice of SHOWN; the last one, if it has nothing to show, is left out."""
    panes = zip(CHOICES["SHOWN"], composition.panes, strict=False)
    third = picture.beside is not None or picture.error_scale is not None
    return [(shown, pane) for shown, pane in panes if shown != "ERROR" or third]


def pixel_box(pane: Pane, height: int) -> Pixels:
    """What is seen of a pane, in a frame so many pixels high; without width or height if nothing is."""
    left, top, right, bottom = pane.outline
    x, y = int(np.floor(left)), int(np.floor(height - bottom))
    return x, y, max(int(np.ceil(right)) - x, 0), max(int(np.ceil(height - top)) - y, 0)


def _wide(suns: Sequence[Lobe], pane: Pane, scale: float) -> bool:
    """Whether every sun is a few lines beyond white wide; a smaller one would have a stroke like a fault on it."""
    per_radian = pane.radius if isinstance(pane, Sphere) else pane.width / (2 * np.pi)
    widths = [2 * sun.profile.half_angle * per_radian for sun in suns if isinstance(sun.profile, Disc)]
    return all(width >= LEAST_HATCHED * FLOATS["BEYOND_PITCH"] * scale for width in widths)


def _reconstruction(drawn: Drawn) -> str:
    """The choice of a program that draws the reconstruction in that way."""
    match drawn:
        case Encoded(stored):
            return stored.encoding.formula.upper()
        case SplineMap():
            return "MAP"
        case _:
            return "SUM"


def _samples(original: LatLongMap | None, pane: Pane) -> int:
    """How many times along a side of a pixel a map is looked up: once for each of its texels, within MOST_SAMPLES."""
    if original is None:
        return 1
    turn = 2 * np.pi * pane.radius if isinstance(pane, Sphere) else pane.width
    return int(min(max(np.ceil(original.texels.shape[1] / turn), 1), MOST_SAMPLES))
