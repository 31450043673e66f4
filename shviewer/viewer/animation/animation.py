"""Animations: a band sweep, as the window plays it, or a turn of the camera, frame by frame, in a file.

A frame is the screenshot of its state: it goes through the same calls, in one headless context.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from shviewer.errors import UsageError
from shviewer.limits import BRIGHTEST, MAX_BANDS
from shviewer.outputs import ANYTHING, Replacing, check_place, write_atomically
from shviewer.progress import tell
from shviewer.viewer.animation.encoders import encode_gif, encode_webp
from shviewer.viewer.animation.metronome import SWEEP_SECONDS, TURN_FRAMES, TURN_SECONDS
from shviewer.viewer.composing.composition import Composition
from shviewer.viewer.control.actions import with_bands
from shviewer.viewer.control.playing import step_sweep, wants_range
from shviewer.viewer.picture import Picture, error_end, prepare
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.screenshot import headless_renderer, render_rgb
from shviewer.viewer.state import State, changed

Progress = Callable[[float, float, str], None]
"""A function that is told the share done, the seconds left, and the step at work."""

ENCODERS = {".gif": (encode_gif, 2), ".webp": (encode_webp, 1)}
"""Suffix -> the encoder, and how often it draws each frame."""

HOLD = 3
"""How many times longer a band sweep shows its last frame than the others."""

SECONDS_RANGE = (0.02, 60.0)
"""The shortest and longest time of a frame. Browsers show shorter GIF frames for a tenth of a second."""

MAX_FRAMES = 720
MAX_SECONDS = 655.0
"""The longest animation: the longest that GIF can show one frame, since equal frames are joined to one."""

MAX_PIXELS = 2**29
"""The most pixels of all frames together, a byte each while a GIF is encoded; 72 frames of 3840 x 1920 are just below."""


@dataclass(eq=False)
class Animation:
    """The states of the frames, how long each is shown, and `portrait`, the state that the description tells.

    UsageError if it is too long.
    """

    states: tuple[State, ...]
    milliseconds: tuple[int, ...]
    portrait: State
    about: dict[str, object]
    """The kind of animation and its numbers, for the description."""

    def __post_init__(self) -> None:
        total = sum(self.milliseconds) / 1000
        if total > MAX_SECONDS:
            raise UsageError(f"{len(self.states)} frames last {total:g} s: at most {MAX_SECONDS:g}; lower --seconds")

    def picture(self, number: int, *, written: bool) -> Picture:
        """The picture of a frame. written: as for `prepare`."""
        return prepare(self.states[number], written=written)


def band_sweep(state: State, first: int, last: int, seconds: float = SWEEP_SECONDS) -> Animation:
    """The state with `first` to `last` bands, as the window plays it. UsageError for bands that cannot be swept."""
    for option, n_bands in (("from", first), ("to", last)):
        if not 1 <= n_bands <= MAX_BANDS:
            raise UsageError(f"--{option} {n_bands}: the viewer shows 1 to {MAX_BANDS} bands")
    if first > last:
        raise UsageError(f"--from {first} --to {last}: a sweep adds bands; let --from be at most --to")
    states = with_one_range(_swept(state, first, last))
    shown = in_milliseconds(seconds)
    about: dict[str, object] = {"kind": "bands", "from": first, "to": last}
    return Animation(tuple(states), (*[shown] * (len(states) - 1), HOLD * shown), states[-1], about)


def _swept(state: State, first: int, last: int) -> list[State]:
    """The state with `first` to `last` bands, each with a range of its own."""
    step = changed(with_bands(state, first), sweep_to=last if first < last else None)
    states = [step]
    while step.view.sweep_to is not None:
        step = step_sweep(step)
        states.append(step)
    return states


def ranged(state: State) -> State:
    """The state, if it wants that, with the range that its frames have in a file."""
    if not wants_range(state):
        return state
    to = state.view.sweep_to
    (first, *_) = with_one_range([state] if to is None else _swept(state, 1, to))
    return changed(state, error_range=first.view.error_range, range_held=True)


def with_one_range(states: list[State]) -> list[State]:
    """The states with one range of the error's colours, the largest of them: an error that grows or falls is seen to.

    Unless no error is shown, or its range is given.
    """
    if states[0].view.error == "off" or states[0].view.error_range is not None:
        return states
    end = 0.0
    for number, state in enumerate(states):
        tell("finding the range of the errors", number / len(states))
        end = max(end, error_end(state))
    digit = 10.0 ** (math.floor(math.log10(end)) - 1)
    error_range = min(float(f"{digit * math.ceil(end / digit - 1e-9):.2g}"), BRIGHTEST)
    return [changed(state, error_range=error_range, range_held=True) for state in states]


def turntable(state: State, frames: int = TURN_FRAMES, seconds: float = TURN_SECONDS) -> Animation:
    """The camera once round in equal steps, beginning where it stands. UsageError for a number of frames out of range."""
    if not 2 <= frames <= MAX_FRAMES:
        raise UsageError(f"--frames {frames}: a turn has 2 to {MAX_FRAMES}")
    state = prepare(state).placed(state)
    assert state.view.camera is not None
    turned = "map_centre" if state.view.whole_sphere else "camera"
    azimuth, elevation = getattr(state.view, turned)
    states = [changed(state, **{turned: ((azimuth + 360 * k / frames) % 360, elevation)}) for k in range(frames)]
    return Animation(tuple(states), (in_milliseconds(seconds),) * frames, state, {"kind": "turntable"})


def in_milliseconds(seconds: float) -> int:
    """Milliseconds of a frame, in whole hundredths of a second, as GIF keeps them. UsageError outside SECONDS_RANGE."""
    least, most = SECONDS_RANGE
    if not least <= seconds <= most:
        raise UsageError(f"--seconds {seconds:g}: a frame is shown for {least:g} to {most:g} s")
    return 10 * round(100 * seconds)


def save_animation(
    animation: Animation,
    composition: Composition,
    out: Path,
    *,
    overlay: bool = True,
    progress: Progress | None = None,
    replacing: Replacing = ANYTHING,
) -> Picture:
    """Draw all frames without a window and write `out`, .gif or .webp; return the picture that the description tells.

    UsageError, LightError, GraphicsError, ShaderError or OutputError if that is impossible; then `out` is what it was.
    """
    if out.suffix.lower() not in ENCODERS:
        raise UsageError(f"{out}: OUT must end in {' or '.join(ENCODERS)}")
    encode, times_drawn = ENCODERS[out.suffix.lower()]
    count, (width, height) = len(animation.states), (composition.width, composition.height)
    if count * width * height > MAX_PIXELS:
        most = math.isqrt(MAX_PIXELS // count * width // height)
        raise UsageError(
            f"{count} frames of {width} x {height}: at most {MAX_PIXELS / 1e6:.0f} megapixels in all; "
            f"take fewer, or a --size up to {most} {most * height // width}"
        )
    check_place(out)
    portrait = prepare(animation.portrait)
    replacing.check(out)
    with headless_renderer() as renderer:
        began, drawings, drawn = perf_counter(), count * times_drawn, 0

        def draw(number: int) -> NDArray[np.uint8]:
            nonlocal drawn
            if progress is not None:
                left = (perf_counter() - began) * (drawings - drawn) / drawn if drawn else 0.0
                progress(drawn / drawings, left, f"frame {number + 1} of {count}")
            drawn += 1
            return render_rgb(renderer, animation.picture(number, written=overlay), composition, overlay=overlay)

        text = describe(animation, portrait, composition, renderer.version, overlay=overlay)
        data = encode(draw, animation.milliseconds, text)
    write_atomically(out, data)
    return portrait


def describe(
    animation: Animation, portrait: Picture, composition: Composition, opengl: str, *, overlay: bool = True
) -> str:
    """JSON that describes the animation and one of its pictures: the last of a band sweep, the first of a turn."""
    frames = {"frames": len(animation.states), "milliseconds": list(animation.milliseconds)}
    described = json.loads(metadata(portrait, composition, opengl, overlay=overlay))
    return json.dumps({**described, "animation": {**animation.about, **frames}}, allow_nan=False)
