"""The fragment shader's sum of coefficients, in float32, compared with evaluate_basis in float64; and what it draws."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from shviewer.harmonics.basis import Array, count_bands, degrees, evaluate_basis
from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import Disc, orient
from shviewer.viewer.camera import world_from_view

if TYPE_CHECKING:
    from shviewer.viewer.composing.panes import Sphere
    from shviewer.viewer.gl.renderer import Renderer

WIDTH, HEIGHT = 320, 160
CENTRE = (240.5, 79.5)
"""The centre of the right sphere, on the centre of a pixel, which then looks exactly along the view's z."""

RADIUS = 78.0
NEAREST_RIM = 0.2
"""The least part of a normal along the view with which a pixel is compared."""

BLOCK = 2048
FROM_NORTH, FROM_SOUTH = np.eye(3), np.diag([1.0, -1.0, -1.0])
"""world_from_view of cameras over the poles, in which a pixel meets the pole without rounding."""

OBLIQUE = world_from_view(78.0, 22.0)
"""The matrix of a camera that is on no axis."""

SEED = 20_240_601
"""The seed of everything random in the table."""

SUN_AXIS = (0.36, -0.48, 0.8)
SUN, SKY, SUN_HALF_ANGLE = 1.6e9, 1e3, 0.265
"""Radiances of sun and sky, in any unit, and the sun's half-angle in degrees."""


@dataclass(frozen=True, eq=False)
class DrawnSum:
    """A sphere showing the sum of `coefficients`, (n**2,)."""

    coefficients: Array
    world_from_view: Array = field(default_factory=lambda: FROM_NORTH)
    radius: float = RADIUS
    """The radius in pixels; a large one magnifies the middle."""


def bound(views: list[DrawnSum]) -> float:
    """The bound, 1e-6 n of the peak: float32 rounding in the recurrence, measured to n = 128."""
    return 1e-6 * max(count_bands(view.coefficients) for view in views)


def error_of(view: DrawnSum, renderer: Renderer) -> float:
    """The largest difference over the pixels from float64, relative to the largest magnitude on the whole sphere."""
    from shviewer.viewer.composing.composition import compose
    from shviewer.viewer.composing.panes import Box, Sphere
    from shviewer.viewer.drawn import DirectSum
    from shviewer.viewer.picture import prepare
    from shviewer.viewer.screenshot import render_linear
    from shviewer.viewer.state import state_of

    n_bands = count_bands(view.coefficients)
    coefficients = np.repeat(view.coefficients[:, None], 3, axis=1)
    picture = replace(
        prepare(state_of(n_bands=n_bands)),
        coefficients=coefficients,
        drawn=DirectSum(coefficients),
        world_from_view=view.world_from_view,
        light_from_world=np.eye(3),
    )
    box = Box(WIDTH / 2, 0, WIDTH, HEIGHT)
    sphere = Sphere(*CENTRE, view.radius, box)
    hidden = Sphere(-9.0, -9.0, 1.0, Box(0, 0, 0, 0))
    drawn = render_linear(renderer, picture, replace(compose(WIDTH, HEIGHT), panes=(hidden, sphere)))
    normals, inside = normals_on(sphere, np.arange(WIDTH // 2, WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    directions = normals @ view.world_from_view.T
    wanted = in_blocks(lambda part: evaluate_basis(part, n_bands) @ view.coefficients, directions)
    difference = float(np.abs(drawn[:, WIDTH // 2 :][inside] - wanted[:, None]).max())
    return difference / max(float(np.abs(wanted).max()), _peak(coefficients))


def normals_on(sphere: Sphere, x: NDArray[np.floating], y: NDArray[np.floating]) -> tuple[Array, NDArray[np.bool_]]:
    """The normals (k, 3), in view space, of those pixels with centres (x, y) that lie on a sphere; and which, (rows, columns).

    Pixels next to the rim are left out: there float32 does not know the normal to 1e-6, whatever is drawn.
    """
    right, up = np.meshgrid((x - sphere.x) / sphere.radius, (sphere.y - y) / sphere.radius)
    facing = np.sqrt((1 - right**2 - up**2).clip(min=0))
    inside = facing > NEAREST_RIM
    return np.stack([right, up, facing], axis=-1)[inside], inside


def in_blocks(function: Callable[[Array], Array], directions: Array) -> Array:
    """A function of directions (k, 3), a part of them at a time."""
    return np.concatenate([function(directions[i : i + BLOCK]) for i in range(0, len(directions), BLOCK)])


def _peak(coefficients: Array) -> float:
    """The largest value on the whole sphere, seen on a grid of eight rows per band."""
    rows = 8 * count_bands(coefficients)
    return float(np.abs(Synthesis(coefficients).on_rows(np.linspace(0, np.pi, rows), 2 * rows)).max())


@contextmanager
def renderer_or_reason(wanted: bool) -> Iterator[Renderer | str]:
    """A renderer, or the reason why there is none."""
    if not wanted:
        yield "not asked for"
        return
    with ExitStack() as stack:
        try:
            from shviewer.viewer.screenshot import headless_renderer

            renderer = stack.enter_context(headless_renderer())
        except Exception as error:
            yield f"{type(error).__name__}: {error}"
            return
        yield renderer


def delta(direction: Sequence[float]) -> Array:
    """Coefficients of a point light of 32 bands, which peaks at n^2/4pi and cancels to nothing elsewhere."""
    return evaluate_basis(np.array(direction), 32)


def noise(n_bands: int) -> Array:
    return np.random.default_rng(SEED).normal(size=n_bands**2)


def pole_views() -> list[DrawnSum]:
    """Both poles in the middle, whole and magnified 50, 1e4 and 1e8 times, for white noise and a point light beside."""
    everything = [noise(32), delta([1e-3, 2e-3, 1]), delta([1e-3, 2e-3, -1])]
    glasses = (78.0, 4e3, 1e6, 1e10)
    return [
        DrawnSum(c, camera, radius) for c in everything for camera in (FROM_NORTH, FROM_SOUTH) for radius in glasses
    ]


def seam_views() -> list[DrawnSum]:
    """A camera on -x: the seam runs down the middle, whole and magnified."""
    from_behind = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    return [DrawnSum(c, from_behind, r) for c in (noise(32), delta([-1, 1e-3, 0.2])) for r in (78.0, 1e6)]


def factorial_views() -> list[DrawnSum]:
    """All orders of the degrees 17 to 31, where factorials have left float32."""
    return [DrawnSum(np.where(degrees(32) >= 17, lights, 0), OBLIQUE) for lights in (noise(32), delta([1, 2, 3]))]


def noise_views() -> list[DrawnSum]:
    """White noise from several sides."""
    return [DrawnSum(noise(n), camera) for n in (2, 16, 32) for camera in (OBLIQUE, FROM_NORTH, FROM_SOUTH)]


def sun_views() -> list[DrawnSum]:
    """The sun and the sky in 32 bands."""
    sun = orient(Disc(float(np.radians(SUN_HALF_ANGLE))).zonal(32), np.array(SUN_AXIS)) * (SUN - SKY)
    sun[0] += SKY * np.sqrt(4 * np.pi)
    return [DrawnSum(sun, OBLIQUE), DrawnSum(sun)]


def cancelling_views() -> list[DrawnSum]:
    """Two suns of +-1e6 close together over 1e-3: away from them terms of 1e6 have to leave 1e-3."""
    pair = (delta([0.6, 0, 0.8]) - delta([0.62, 0.01, 0.8])) * 1e6
    pair[0] += 1e-3 * np.sqrt(4 * np.pi)
    return [DrawnSum(pair, OBLIQUE), DrawnSum(pair), DrawnSum(pair, FROM_SOUTH)]
