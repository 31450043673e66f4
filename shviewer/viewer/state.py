"""Everything a frame depends on, and what is said of it. What can be done to it is in actions.py."""

from __future__ import annotations

from dataclasses import dataclass, field

from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.layouts.recognise import LAYOUTS
from shviewer.lights.light import Light
from shviewer.lights.reading import DEFAULT_READING, Reading
from shviewer.viewer.camera import IDENTITY, Quaternion

METHODS = ("best", "jittered", "gauss-legendre")
QUANTITIES = ("radiance", "irradiance")
WINDOWS = ("none", "hann", "lanczos", "gauss", "dering")
LAYOUT_CHOICES = ("auto", *LAYOUTS)
SHEETS = ("", "plane", "convergence")
EVALUATIONS = ("auto", "direct", "map")
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
    error: str = "off"
    """What the third sphere shows of reconstruction minus original, if there is one: one of ERRORS."""
    error_range: float | None = None
    """Where the colours of the error end, in radiance or for the relative error in shares; where it is None, chosen."""
    tone: str = "none"
    marks: bool = True
    """Mark the minimum of the reconstruction and the largest error."""
    lobe_view: bool = False
    """Draw surfaces whose radius is the magnitude of the value, instead of spheres."""
    basis: tuple[int, int] | None = None
    """Degree l and order m of the one function that the lobe view shows in place of the reconstruction."""
    evaluate: str = "auto"
    """How the reconstruction is drawn: summed per pixel, looked up in a map of it, or whichever is fast enough."""
    sweep_to: int | None = None
    """While a sweep plays, the number of bands at which it ends."""
    help_visible: bool = False
    sheet: str = ""
    """One of SHEETS: "plane" is time against error so far, which no two runs agree on."""
    message: str = ""
    reloads: int = 0
    """Counts the wishes to read the light's file anew: the picture before is not that of the state after."""
    fullscreen: bool = field(default=False, compare=False)
    closing: bool = field(default=False, compare=False)
    screenshots: int = field(default=0, compare=False)
    fits: int = field(default=0, compare=False)
    """Counts the wishes for as many bands as the tolerance asks for, which depends on the light."""
    looks: int = field(default=0, compare=False)
    """Counts the wishes to look at the next mark, whose place depends on the light."""
    layout_tried: str = field(default="", compare=False)
    """The layout asked for last, from which the next follows even if the image could not have it; "" for the reading's."""

    @property
    def light(self) -> str | Light:
        return self.lights[self.light_index]

    @property
    def n_spheres(self) -> int:
        """Original, reconstruction and perhaps their difference."""
        return 2 if self.error == "off" else 3

    @property
    def bands_ahead(self) -> int:
        """Those in use, or during a sweep those it ends with: what bars and axes have to have room for."""
        return max(self.n_bands, self.sweep_to or 0)

    @property
    def muted_shown(self) -> tuple[int, ...]:
        """The muted bands among those in use."""
        return tuple(sorted(band for band in self.muted if band < self.n_bands))


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


def describe_basis(state: ViewState) -> str:
    """ "Y(2,-1)", or "" """
    return "" if state.basis is None else "Y({},{})".format(*state.basis)
