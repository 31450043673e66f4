"""Everything a frame depends on, and what can be done to it: functions from one state to the next."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from shviewer.lights.coefficients.light import CoefficientLight
from shviewer.lights.layouts.recognise import LAYOUTS
from shviewer.lights.light import Light
from shviewer.lights.radiance_files import DEFAULT_READING, Reading
from shviewer.viewer.camera import IDENTITY, Quaternion, turned_by_drag
from shviewer.viewer.layout import MAX_DIRECT_BANDS, MAX_SHOWN_BANDS

METHODS = ("best", "jittered", "gauss-legendre")
QUANTITIES = ("radiance", "irradiance")
WINDOWS = ("none", "hann", "lanczos", "gauss", "dering")
LAYOUT_CHOICES = ("auto", *LAYOUTS)
MIN_SAMPLES, MAX_KEY_SAMPLES = 16, 1_000_000
CAMERA_HOME = (78.0, 22.0)
"""Azimuth and elevation of the camera, degrees: both lobes of Green's light are in sight."""

EXPOSURE_STEP = 0.5
MAX_EXPOSURE = 64.0
ZOOM_RANGE = (0.25, 16.0)


@dataclass(frozen=True)
class ViewState:
    """Equal states of equal size give equal pixels; those after `reloads` are wishes to the window, not to the picture."""

    lights: tuple[str | Light, ...] = ("green",)
    light_index: int = 0
    reading: Reading = DEFAULT_READING
    n_bands: int = 5
    muted: frozenset[int] = frozenset()
    cursor: int = 0
    cursor_visible: bool = False
    quantity: str = "radiance"
    compare: CoefficientLight | None = None
    """Given coefficients, shown instead of the light's own; no more bands than they have are shown."""
    split_sun: bool = False
    """Take compact sources out of the light as discs, where it has any, and project the rest."""
    window: str = "none"
    window_width: float | None = None
    """In bands; where it is None, as many as are shown."""
    tolerance: float = 0.05
    method: str = "best"
    samples: int = 10_000
    seed: int = 0
    exposure_stops: float | None = None
    exposure_offset: float = 0.0
    """Stops added to the exposure, which is `exposure_stops` or, where that is None, chosen from the light."""
    camera: tuple[float, float] = CAMERA_HOME
    light_rotation: Quaternion = IDENTITY
    zoom: float = 1.0
    help_visible: bool = False
    plane_visible: bool = False
    """Show time against error of the light's projections so far, which no two runs agree on."""
    message: str = ""
    reloads: int = 0
    """Counts the wishes to read the light's file anew: the picture before is not that of the state after."""
    fullscreen: bool = field(default=False, compare=False)
    closing: bool = field(default=False, compare=False)
    screenshots: int = field(default=0, compare=False)
    fits: int = field(default=0, compare=False)
    """Counts the wishes for as many bands as the tolerance asks for, which depends on the light."""
    layout_tried: str = field(default="", compare=False)
    """The layout asked for last, from which the next follows even if the image could not have it; "" for the reading's."""

    @property
    def light(self) -> str | Light:
        return self.lights[self.light_index]

    @property
    def muted_shown(self) -> tuple[int, ...]:
        """The muted bands among those in use."""
        return tuple(sorted(band for band in self.muted if band < self.n_bands))


Action = Callable[[ViewState], ViewState]


def more_bands(count: int) -> Action:
    return lambda state: with_bands(state, state.n_bands + count)


def with_bands(state: ViewState, n_bands: int) -> ViewState:
    most = min(state.compare.n_bands, MAX_SHOWN_BANDS) if state.compare else MAX_SHOWN_BANDS
    if state.compare and n_bands > most:
        state = replace(state, message=state.compare.extent)
    n_bands = min(max(n_bands, 1), most)
    return replace(state, n_bands=n_bands, cursor=min(state.cursor, n_bands - 1))


def toggle_band(state: ViewState, band: int) -> ViewState:
    """Mute a band or take it back; one that is not in use only says so."""
    return replace(state, muted=state.muted ^ {band}) if band < state.n_bands else not_in_use(state, band)


def not_in_use(state: ViewState, band: int) -> ViewState:
    return replace(state, message=f"band {band} is above the {state.n_bands} in use: Up adds bands")


def solo_band(state: ViewState, band: int) -> ViewState:
    """Only this band; once more: all of them."""
    others = frozenset(range(MAX_SHOWN_BANDS)) - {band}
    if band >= state.n_bands:
        return not_in_use(state, band)
    return replace(state, muted=frozenset() if state.muted == others else others)


def move_cursor(step: int) -> Action:
    """Along the band bars; the first press only shows where the cursor is."""

    def action(state: ViewState) -> ViewState:
        moved = (state.cursor + step) % state.n_bands if state.cursor_visible else state.cursor
        return replace(state, cursor=moved, cursor_visible=True)

    return action


def toggle_cursor(state: ViewState) -> ViewState:
    return replace(toggle_band(state, state.cursor), cursor_visible=True)


def next_light(step: int) -> Action:
    return lambda state: replace(state, light_index=(state.light_index + step) % len(state.lights), layout_tried="")


def next_layout(state: ViewState) -> ViewState:
    """Through all layouts, for this image and those opened afterwards."""
    last = state.layout_tried or state.reading.layout
    layout = LAYOUT_CHOICES[(LAYOUT_CHOICES.index(last) + 1) % len(LAYOUT_CHOICES)]
    return replace(state, reading=replace(state.reading, layout=layout), layout_tried=layout)


def toggle_sanitizing(state: ViewState) -> ViewState:
    """Of this image and those opened afterwards."""
    return replace(state, reading=replace(state.reading, sanitize=not state.reading.sanitize))


def next_window(state: ViewState) -> ViewState:
    """Through all windows; deringing, which takes up to MAX_DIRECT_BANDS bands, is left out above them."""
    names = WINDOWS if state.n_bands <= MAX_DIRECT_BANDS else WINDOWS[:-1]
    at = names.index(state.window) if state.window in names else len(names) - 1
    return replace(state, window=names[(at + 1) % len(names)])


def next_quantity(state: ViewState) -> ViewState:
    return replace(state, quantity=QUANTITIES[(QUANTITIES.index(state.quantity) + 1) % len(QUANTITIES)])


def toggle_split(state: ViewState) -> ViewState:
    return replace(state, split_sun=not state.split_sun)


def next_method(state: ViewState) -> ViewState:
    if state.compare:
        return replace(state, message=f"the coefficients are those of {state.compare.name}, and no method's")
    return replace(state, method=METHODS[(METHODS.index(state.method) + 1) % len(METHODS)])


def scale_samples(factor: float) -> Action:
    def action(state: ViewState) -> ViewState:
        if state.method == "best":
            return replace(state, message="no samples are drawn in this light's best way: M changes the method")
        return replace(
            state, samples=int(min(max(state.samples * factor, MIN_SAMPLES), max(state.samples, MAX_KEY_SAMPLES)))
        )

    return action


def expose(step: float) -> Action:
    def action(state: ViewState) -> ViewState:
        return replace(state, exposure_offset=min(max(state.exposure_offset + step, -MAX_EXPOSURE), MAX_EXPOSURE))

    return action


def auto_exposure(state: ViewState) -> ViewState:
    return replace(state, exposure_stops=None, exposure_offset=0.0)


def reset(state: ViewState) -> ViewState:
    """Everything but the light and the window as it was at the start."""
    return ViewState(
        lights=state.lights,
        light_index=state.light_index,
        reading=state.reading,
        compare=state.compare,
        reloads=state.reloads,
        fullscreen=state.fullscreen,
        screenshots=state.screenshots,
        fits=state.fits,
        layout_tried=state.layout_tried,
        tolerance=state.tolerance,
    )


def reload(state: ViewState) -> ViewState:
    """Read the light's file anew and keep every other setting."""
    return replace(state, reloads=state.reloads + 1)


def escape(state: ViewState) -> ViewState:
    """Close the help, or else the time-error plane, or else the window."""
    if state.help_visible:
        return replace(state, help_visible=False)
    return replace(state, plane_visible=False) if state.plane_visible else replace(state, closing=True)


def orbit(state: ViewState, right: float, up: float) -> ViewState:
    """Turn both spheres as if their front was dragged, in radii of a sphere."""
    azimuth, elevation = state.camera
    azimuth = (azimuth - right * 180 / math.pi) % 360
    elevation = min(max(elevation - up * 180 / math.pi, -90.0), 90.0)
    return replace(state, camera=(azimuth, elevation))


def rotate_light(state: ViewState, right: float, up: float) -> ViewState:
    """Turn the light as if the front of a sphere was dragged, in radii of a sphere."""
    return replace(state, light_rotation=turned_by_drag(state.light_rotation, state.camera, right, up))


def zoom(state: ViewState, steps: float) -> ViewState:
    low, high = ZOOM_RANGE
    return replace(state, zoom=min(max(state.zoom * 1.1**steps, low), high))


def open_light(state: ViewState, light: str | Light) -> ViewState:
    """Show `light`, adding it to those that Left and Right go through."""
    lights = state.lights if light in state.lights else (*state.lights, light)
    return replace(state, lights=lights, light_index=lights.index(light), layout_tried="", message="")


def describe_muted(state: ViewState) -> str:
    """ "muted 1, 3-5", "only band 2", or "" """
    bands = state.muted_shown
    if not bands:
        return ""
    if len(bands) == state.n_bands - 1 and state.n_bands > 2:
        return f"only band {next(band for band in range(state.n_bands) if band not in bands)}"
    runs: list[list[int]] = []
    for band in bands:
        if runs and band == runs[-1][-1] + 1:
            runs[-1].append(band)
        else:
            runs.append([band])
    return "muted " + ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)


def describe_window(state: ViewState) -> str:
    """ "Hann window", "Hann window of 6", "deringed", or "" """
    if state.window in ("none", "dering"):
        return "deringed" if state.window == "dering" else ""
    width = f" of {state.window_width:g}" if state.window_width else ""
    return f"{state.window.capitalize()} window{width}"


def describe_sanitizing(state: ViewState) -> str:
    return "repaired" if state.reading.sanitize else "as they are"


def light_name(light: str | Light) -> str:
    return light.replace("\\", "/").rpartition("/")[2] if isinstance(light, str) else light.name


def describe_exposure(state: ViewState) -> str:
    base = "auto" if state.exposure_stops is None else f"{state.exposure_stops:+g}"
    return base if not state.exposure_offset else f"{base} {state.exposure_offset:+g}"
