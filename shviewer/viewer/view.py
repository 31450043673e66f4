"""The view of a recipe's numbers: the camera, what is drawn over and beside the spheres, and the exposure and tone."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import hypot
from typing import TYPE_CHECKING, Any

from shviewer.analysis.options import Choice, Flag, Number, Pair, check_options, option
from shviewer.errors import UsageError
from shviewer.harmonics.quantities.names import ENCODED_BANDS
from shviewer.limits import BRIGHTEST, DIMMEST

if TYPE_CHECKING:
    from shviewer.viewer.camera import Quaternion

TONES = ("none", "reinhard", "aces", "log")
ERRORS = ("off", "signed", "absolute", "relative")
"""The choices for the third sphere; "off": there is none."""

BESIDES = ("off", "no-window", "method", "own")
"""The choices for a second reconstruction in its place; viewer/beside.py says what they are."""

SEEDS = ("fresh", "same")
"""The jittered samples of a light that turns: new ones in every frame, or the same in all."""

SHEETS = ("", "plane")
EVALUATIONS = ("auto", "direct", "map")
MAX_EXPOSURE = 64.0
ZOOM_RANGE = (0.25, 16.0)
ROUNDING = 1 + 1e-9
"""How far a place at a bound may be beyond it."""


@dataclass(frozen=True)
class View:
    """The options of the view. Equal recipes in equal views of equal size give equal pixels."""

    exposure_stops: float | None = option(
        None,
        Number(
            -MAX_EXPOSURE,
            MAX_EXPOSURE,
            f"it must be -{MAX_EXPOSURE:g} to {MAX_EXPOSURE:g} stops",
            called="exposure",
        ),
        "fixed, instead of chosen from the light",
        "--exposure STOPS",
    )
    exposure_offset: float = option(
        0.0,
        Number(-MAX_EXPOSURE, MAX_EXPOSURE, f"it must be -{MAX_EXPOSURE:g} to {MAX_EXPOSURE:g} stops"),
        "added to the exposure, fixed or chosen",
        "--exposure-offset STOPS",
    )
    tone: str = option("none", Choice(TONES), "curve after exposure: none, reinhard, aces or log", "--tone T")
    error: str = option(
        "off",
        Choice(ERRORS),
        "a third sphere, reconstruction minus original: off (default), signed, absolute or relative",
        "--error E",
    )
    beside: str = option(
        "off",
        Choice(BESIDES),
        "a third sphere in place of the error: what the same bands give without the window (no-window), by the other "
        "method (method), or by the light's own coefficients beside compared ones (own)",
        "--beside WHAT",
    )
    error_range: float | None = option(
        None,
        Number(DIMMEST, BRIGHTEST, f"it must be {DIMMEST:g} to {BRIGHTEST:g}"),
        "where its colours end: a radiance, or for the relative error such as 20%; chosen from the light unless given",
        "--error-range R",
    )
    marks: bool = option(
        True,
        Flag(),
        "no rings at the minimum and the largest error, and no lines over what is negative",
        "--no-marks",
        const=False,
    )
    lobe_view: bool = option(
        False,
        Flag(),
        "surfaces in place of spheres: radius is root of magnitude, colour is sign",
        "--lobes",
        const=True,
    )
    basis: tuple[int, int] | None = option(
        None,
        Pair("l and m, such as (2, -1)", whole=True),
        "the surface of one basis function Y(l, m) on the right",
        "--basis L M",
    )
    encode: str = option(
        "",
        Choice(("", *ENCODED_BANDS)),
        "show what engines store of the irradiance in few numbers, in place of bands: l1, geomerics, hallucinated, zh3, the"
        " last two also with -shared, zh3-solved, ambient-cube, ambient-cube-fitted, l2 or l2-deringed",
        "--encode NAME",
    )
    by_roughness: bool = option(
        False,
        Flag(),
        "plot the fewest bands within the tolerance against roughness, in place of error against bands",
        "--by-roughness",
        const=True,
    )
    sheet: str = ""
    """One of the SHEETS in place of the curve: "plane" is time against error in this session, and no two runs agree on it."""
    evaluate: str = option(
        "auto",
        Choice(EVALUATIONS),
        "sum the bands per pixel (direct), draw from a map, or auto (default): by the time that a frame takes",
        "--evaluate E",
    )
    camera: tuple[float, float] | None = option(
        None,
        Pair("azimuth and elevation in degrees, such as (30, 10)"),
        "where the camera stands, degrees; facing the light unless given",
        "--camera AZIMUTH ELEVATION",
    )
    """None: where `derived.camera_of` puts it."""
    whole_sphere: bool = option(
        False, Flag(), "the whole sphere as lat-long maps in place of spheres", "--map", const=True
    )
    map_centre: tuple[float, float] = option(
        (0.0, 0.0),
        Pair("azimuth and elevation in degrees, such as (180, 0)"),
        "what is in the middle of the maps, degrees",
        "--map-centre AZIMUTH ELEVATION",
    )
    light_rotation: Quaternion = (0.0, 0.0, 0.0, 1.0)
    zoom: float = option(
        1.0,
        Number(*ZOOM_RANGE, f"it must be {ZOOM_RANGE[0]:g} to {ZOOM_RANGE[1]:g}"),
        f"size of the spheres, {ZOOM_RANGE[0]:g} to {ZOOM_RANGE[1]:g} (default 1)",
        "--zoom Z",
    )
    pan: tuple[float, float] = option(
        (0.0, 0.0),
        Pair("two numbers, right and up, such as (0.5, 0)"),
        "move the spheres, in radii at zoom 1",
        "--pan RIGHT UP",
    )
    cursor: int = 0
    cursor_visible: bool = False
    sweep_to: int | None = None
    """While a sweep plays, the number of bands at which it ends."""
    turning: str = ""
    """While the light turns, one of SEEDS: what its jittered samples are in each frame."""
    range_held: bool = False
    """Whether the error's range is that of what plays, or played: it goes as soon as something else is shown."""
    trace: tuple[float, ...] = ()
    """How far the coefficients moved in each of the last frames of a turn, turned back, over the norm of the light."""
    help_visible: bool = False
    help_page: int = 0
    """How often PageDown was pressed in the help."""
    message: str = ""
    roughness: float = field(default=0.5, compare=False)
    """The roughness shown last, to which the quantity returns."""
    layout_tried: str = field(default="", compare=False)
    """The layout asked for last, from which the next follows even if the image could not have it; "" for the reading's."""

    @property
    def n_spheres(self) -> int:
        """The number of spheres: original, reconstruction and perhaps the error, or another reconstruction."""
        return 2 if self.error == self.beside == "off" else 3

    def check(self) -> None:
        """UsageError unless every option is within its range, and the third sphere shows one thing."""
        check_options(self)
        if "off" not in (self.error, self.beside):
            raise UsageError(f"error {self.error} and beside {self.beside}: a third sphere shows one of them")
        if hypot(*self.pan) > self.zoom * ROUNDING:
            far = f"pan {self.pan[0]:g} {self.pan[1]:g}"
            raise UsageError(f"{far}: at zoom {self.zoom:g} a sphere is moved by at most {self.zoom:g} radii")


LOOKED = ("camera", "map_centre", "zoom", "pan", "light_rotation")
"""Fields that say from where it is looked at what."""

POINTED = ("cursor", "cursor_visible")
PLAYED = ("sweep_to", "turning", "trace", "range_held")
SPOKEN = ("message", "help_visible", "help_page")
"""Fields of what points, plays and speaks, which make no step to be undone."""

REMEMBERED = ("roughness", "layout_tried")
"""Fields that no pixel depends on."""

STOPPED: dict[str, Any] = {"sweep_to": None, "turning": ""}
"""The values of a view in which nothing plays."""
