"""Lines over what is negative and what is beyond white: pixel by pixel as float64 draws them, and told by every eye."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from helpers import frame_of, picture_of, to_srgb
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from viewer.colour.curves import toned
from viewer.gl.frames import map_frame, positions, square_frame

from shviewer.harmonics.basis import Array
from shviewer.harmonics.zonal import Constant
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import LobeLight
from shviewer.lights.function import FunctionLight
from shviewer.viewer.colour.colour_maps import linear as from_srgb
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.composing.panes import Sphere
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.picture import Picture
from shviewer.viewer.screenshot import render_linear, render_rgb
from shviewer.viewer.state import changed
from shviewer.viewer.view import TONES

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
BARELY = 0.5 / 255
BRIGHT, DARK, EDGE = (120, 170, 255), (40, 40, 44), (176, 206, 255)
NEGATIVE = np.array([0.06, 0.40, 1.0])

ORIGINAL, RECONSTRUCTION = 0, 1


def twin(picture: Picture, frame: Composition, radiance: Array, side: int) -> Iterator[Array]:
    """The colours, 0 to 255 as floats, of one pane's pixels (height, width, 3), with either kind of derivatives.

    radiance: what the pane shows, over the whole frame, top row first. OpenGL takes derivatives within blocks of two by two
    pixels, counted from the bottom left, of each row or of one row for both.
    """
    scale, (height, width) = max(frame.scale, 1.0), radiance.shape[:2]
    light = 2.0**picture.exposure_stops * radiance
    luminance = light @ LUMINANCE
    magnitude = toned(np.abs(luminance), picture.state.view.tone)
    darkness = (magnitude / (magnitude + 0.3))[..., None]
    fade = np.minimum(1, luminance / np.maximum(0.0722 * light.max(axis=-1), 1e-30))[..., None]
    positive = toned(np.maximum(light, 0), picture.state.view.tone) * fade
    plain = np.clip(np.where(luminance[..., None] < -BARELY, 0.34 * darkness * NEGATIVE, positive), 0, 1)

    x, y = np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5)
    lined, single = cover((x - y) / np.sqrt(2), 5 * scale, scale), light.min(axis=-1) < -BARELY
    strength = np.where(luminance < -BARELY, 0.26 + 0.62 * darkness[..., 0], 0.26 * single)
    bright, dark = mixed(plain, BRIGHT, strength * lined), mixed(plain, DARK, 0.45 * single * lined)
    shown = np.where((plain @ LUMINANCE)[..., None] > 0.18, dark, bright)
    if picture.state.view.tone == "none":
        strength = 0.75 * np.clip((luminance - 1) / 0.02, 0, 1)
        falling = mixed(plain, DARK, strength * cover((x + y) / np.sqrt(2), 6 * scale, 1.1 * scale))
        shown = np.where(luminance[..., None] > 1, falling, shown)

    pane = frame.panes[side]
    to_limb = np.full((height, width), 1e6)
    if isinstance(pane, Sphere):
        to_limb = (1 - np.linalg.norm(positions(frame, pane), axis=-1)) * pane.radius
    for slope in slopes(luminance):
        inside = -(luminance + BARELY) / np.maximum(slope, BARELY / 4)
        edge = np.clip(inside + 0.5, 0, 1) * np.clip(1.1 * scale + 0.5 - inside, 0, 1) * (luminance < 0)
        lined = mixed(shown, EDGE, 0.9 * edge * np.clip(to_limb / (2.5 * scale), 0, 1))
        yield 255 * to_srgb(lined if picture.state.view.marks else plain)


def cover(across: Array, pitch: float, width: float) -> Array:
    return np.clip(width / 2 + 0.5 - np.abs(across - pitch * np.round(across / pitch)), 0, 1)


def mixed(colour: Array, ink: tuple[int, int, int], strength: Array) -> Array:
    return np.asarray(colour + strength[..., None] * (from_srgb(np.array(ink, dtype=np.uint8)) - colour))


def slopes(values: Array) -> tuple[Array, Array]:
    """Lengths of the gradient in blocks of two by two from the bottom left, by row and column, and of one corner for all."""
    blocks = values[::-1].reshape(values.shape[0] // 2, 2, values.shape[1] // 2, 2)
    right, up = blocks[..., 1] - blocks[..., 0], blocks[:, 1] - blocks[:, 0]
    fine = np.hypot(right[..., None], up[:, None])
    coarse = np.hypot(right[:, :1, :, None], up[:, None, :, :1])
    return fine.reshape(values.shape)[::-1], np.broadcast_to(coarse, blocks.shape).reshape(values.shape)[::-1]


def assert_drawn_as_told(renderer: Renderer, picture: Picture, frame: Composition, side: int) -> Array:
    """Within a step of 255, for rounding and the ink's; return the mask of the pixels looked at."""
    radiance = render_linear(renderer, picture, frame).astype(np.float64)
    drawn = render_rgb(renderer, picture, frame, overlay=False).astype(np.float64)
    pane = frame.panes[side]
    if isinstance(pane, Sphere):  # the blocks of two by two at the limb have no radiance outside
        mask = np.linalg.norm(positions(frame, pane), axis=-1) < 1 - 3 / pane.radius
    else:
        mask = np.zeros(radiance.shape[:2], dtype=bool)
        mask[:, round(pane.clip.left) : round(pane.clip.right)] = True
    off = [np.abs(drawn - colours).max(axis=-1)[mask].max() for colours in twin(picture, frame, radiance, side)]
    assert min(off) <= 1.5, off
    return mask


FRAMES = {"spheres": square_frame(200), "maps": map_frame(256, 1.6, (150.0, 20.0))}


@pytest.mark.parametrize("form", FRAMES)
@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("light", ["green", "venice_sunset", "sun-sky"])
def test_negative_light_is_drawn_as_float64_draws_it(renderer: Renderer, light: str, scale: float, form: str) -> None:
    """The fill, its lines, those of single channels and the line of its edge."""
    picture = picture_of(light, n_bands=9)
    assert_drawn_as_told(renderer, picture, replace(FRAMES[form], scale=scale), RECONSTRUCTION)


@pytest.mark.parametrize("tone", TONES)
def test_every_curve_has_the_same_lines_but_for_those_beyond_white(renderer: Renderer, tone: str) -> None:
    picture = picture_of("venice_sunset", n_bands=6, tone=tone, exposure_stops=0.5)
    for side in (ORIGINAL, RECONSTRUCTION):
        assert_drawn_as_told(renderer, picture, FRAMES["spheres"], side)


@pytest.mark.parametrize("form", FRAMES)
def test_without_marks_there_are_no_lines(renderer: Renderer, form: str) -> None:
    picture = picture_of("green", marks=False, exposure_stops=1.0)
    assert_drawn_as_told(renderer, picture, FRAMES[form], RECONSTRUCTION)
    marked = picture_of("green", exposure_stops=1.0)
    frames = [render_rgb(renderer, shown, FRAMES[form], overlay=False) for shown in (picture, marked)]
    assert (frames[0] != frames[1]).any()


def test_numbers_have_no_lines(renderer: Renderer) -> None:
    marked, plain = (picture_of("green", marks=marks) for marks in (True, False))
    frame = FRAMES["spheres"]
    assert np.array_equal(render_linear(renderer, marked, frame), render_linear(renderer, plain, frame))


def test_where_light_ends_in_black_there_is_no_line(renderer: Renderer) -> None:
    """Green's lobes begin at zero; a line there would draw an outline round every lobe."""
    picture = picture_of("green", n_bands=3)
    mask = assert_drawn_as_told(renderer, picture, FRAMES["spheres"], ORIGINAL)
    drawn = render_rgb(renderer, picture, FRAMES["spheres"], overlay=False)[mask].astype(int)
    assert (drawn.max(axis=1) - drawn.min(axis=1)).max() <= 1  # grey


def test_beyond_white_every_other_curve_has_no_lines_of_its_own(renderer: Renderer) -> None:
    bright = LobeLight((Lobe(Constant(), np.array([0.0, 0.0, 1.0]), np.full(3, 4.0)),))
    for tone in TONES:
        picture = picture_of(bright, tone=tone, exposure_stops=0.0)
        mask = assert_drawn_as_told(renderer, picture, FRAMES["spheres"], ORIGINAL)
        drawn = render_rgb(renderer, picture, FRAMES["spheres"], overlay=False)[mask]
        assert (len(np.unique(drawn, axis=0)) > 1) == (tone == "none")


# --- other eyes

VISIONS = {
    "normal": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
}
"""Linear RGB as it is seen, severity 1 [Machado, Oliveira, Fernandes, "A Physiologically-based Model for Simulation of Color
Vision Deficiency", 2009, table 1]."""

WINDOW = 5


def structure(pixels: NDArray[np.uint8], vision: str) -> Array:
    """The standard deviation of CIE L* in windows of five by five pixels, (height - 4, width - 4)."""
    seen = np.clip(from_srgb(pixels) @ np.array(VISIONS[vision]).T, 0, 1) @ LUMINANCE
    lightness = np.where(seen > 216 / 24389, 116 * np.cbrt(seen) - 16, 24389 / 27 * seen)
    return np.asarray(sliding_window_view(lightness, (WINDOW, WINDOW)).std(axis=(2, 3)))


def all_in_window(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    return np.asarray(sliding_window_view(mask, (WINDOW, WINDOW)).all(axis=(2, 3)))


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize(("light", "n_bands"), [("green", 5), ("venice_sunset", 9), ("st_fagans_interior", 9)])
def test_negative_light_has_a_structure_that_light_has_not_to_every_eye(
    renderer: Renderer, light: str, n_bands: int, vision: str
) -> None:
    """The median over windows that lie wholly within: at least four times that of positive light, and of single channels."""
    picture = picture_of(light, n_bands=n_bands)
    frame = map_frame(640)
    exposed = 2.0**picture.exposure_stops * render_linear(renderer, picture, frame)[:, 640:]
    drawn = structure(render_rgb(renderer, picture, frame, overlay=False)[:, 640:], vision)
    luminance, lowest = exposed @ LUMINANCE, exposed.min(axis=-1)
    inside, channel, light_ = (
        drawn[all_in_window(mask)]
        for mask in (luminance < -0.01, (luminance > 0.01) & (lowest < -0.01), (lowest > 0.01) & (luminance < 1))
    )
    assert len(inside) > 150
    assert len(light_) > 1000
    assert np.median(inside) > max(4 * np.median(light_), 7)
    if len(channel) > 300:
        assert np.median(channel) > max(4 * np.median(light_), 5)


def test_a_channel_below_zero_is_seen_under_the_light_of_the_others(renderer: Renderer) -> None:
    light = FunctionLight(lambda directions: np.tile([-0.1, 0.5, 0.25], (len(directions), 1)), "no red")
    picture = picture_of(light, exposure_stops=0.0, n_bands=1)
    mask = assert_drawn_as_told(renderer, picture, FRAMES["spheres"], ORIGINAL)
    drawn = render_rgb(renderer, picture, FRAMES["spheres"], overlay=False)
    assert np.median(structure(drawn, "normal")[all_in_window(mask)]) > 3


@pytest.mark.parametrize(("zoom", "lined"), [(6.0, False), (16.0, True)])
def test_a_sun_apart_has_lines_only_where_there_is_room_for_several(
    renderer: Renderer, zoom: float, lined: bool
) -> None:
    """Half a degree is 12 or 33 pixels wide, where there is a line every 6: one would be a stroke like a fault."""
    shown = picture_of("sun-sky", n_bands=4, split_sun=True, zoom=zoom, exposure_stops=-4.0)
    shown = shown.seen(changed(shown.state, camera=towards(shown.subject.suns[0].axis)))
    frame = frame_of(shown)
    sphere = frame.spheres[RECONSTRUCTION]
    pixels = render_rgb(renderer, shown, frame, overlay=False).astype(int)
    reach = int(0.6 * sphere.radius * shown.subject.suns[0].half_angle)
    part = pixels[round(sphere.y) - reach : round(sphere.y) + reach, round(sphere.x) - reach : round(sphere.x) + reach]
    assert (part.min() < 200) == lined
    assert part.max() == 255


def towards(axis: Array) -> tuple[float, float]:
    """The camera in front of a direction."""
    return float(np.degrees(np.arctan2(axis[1], axis[0]))), float(np.degrees(np.arcsin(axis[2])))
