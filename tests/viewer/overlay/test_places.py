"""A seeded walk through states, sizes, cameras and numbers: texts keep apart, nothing is cut, nothing is said twice."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from helpers import Lazily, frame_of, picture_of
from viewer.overlay.collisions import faults
from viewer.overlay.written import texts_of

from shviewer.analysis.figures import Figures
from shviewer.lights.function import FunctionLight
from shviewer.viewer import message
from shviewer.viewer.overlay.overlay import draw_overlay
from shviewer.viewer.picture import Picture
from shviewer.viewer.state import changed
from shviewer.viewer.work import Work

SIZES = [
    *[(400, 300), (640, 320), (640, 480), (800, 800), (1000, 700), (1280, 640), (1280, 720)],
    *[(1600, 1000), (1920, 1080), (900, 1600), (500, 1000)],
]
SEEDS = range(6)
LONG = "a_light_whose_name_is_much_longer_than_anybody_would_ever_want_it_to_be_in_a_caption"
SUN = {"light": "sun-sky", "split_sun": True, "muted": frozenset({3, 4}), "n_bands": 9}
PICTURES = Lazily(
    {
        "all apart": lambda: picture_of(**SUN, window="hann", error="signed"),
        "all apart, maps": lambda: picture_of(**SUN, window="hann", error="relative", whole_sphere=True),
        "maps": lambda: picture_of("studio", n_bands=9, whole_sphere=True),
        "beside": lambda: picture_of("studio", n_bands=10, window="lanczos", beside="no-window"),
        "surfaces": lambda: picture_of(n_bands=8, lobe_view=True, zoom=2.0, error="signed"),
        "glossy": lambda: picture_of("sun-sky", quantity="glossy:0.4", n_bands=9, split_sun=True),
        "roughness": lambda: picture_of(by_roughness=True, n_bands=9, error="absolute"),
        "encoded": lambda: picture_of(quantity="irradiance", encode="zh3", n_bands=3, error="signed"),
        "function": lambda: picture_of(
            FunctionLight(lambda d: 1 + d[:, 2], LONG), n_bands=40, muted=frozenset({1, 3, 5, 7, 9}), error="absolute"
        ),
        "times": lambda: picture_of(
            "sun-sky", n_bands=5, sheet="plane", method="jittered", samples=2_500, split_sun=True
        ),
        "sampled": lambda: picture_of("sun-sky", n_bands=32, method="jittered", samples=20_000, window="hann"),
    }
)


def with_numbers(shown: Picture, chance: random.Random) -> Picture:
    """The picture with numbers of any length: powers of ten, shares near 0 and 1, bounds near and far."""
    assert isinstance(shown.figures, Figures)
    unit, beyond = 10.0 ** chance.randint(-7, 9), chance.choice((1.0, 1.06, 1.7))
    error, minimum = unit * chance.uniform(0.1, 10), -unit * chance.choice((0.0, chance.uniform(0.1, 10)))
    extremes = replace(
        shown.figures.extremes,
        max_error=error,
        max_error_bound=beyond * error,
        minimum=minimum,
        minimum_bound=beyond * minimum,
        negative_area=chance.choice((0.0, 1e-7, 0.0022, 0.42, 0.99996)),
        peak=20 * unit,
    )
    relative = chance.choice((1e-7, 2.34e-5, 0.0525, 0.999996, 12.3))
    channels = {name: replace(one, relative_l2=relative) for name, one in shown.figures.channels.items()}
    figures = replace(shown.figures, extremes=extremes, channels=channels, peak=20 * unit, floor=1e-9)
    return replace(shown, figures=figures)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", PICTURES)
def test_whatever_is_shown_all_text_has_its_place(name: str, seed: int) -> None:
    chance = random.Random(f"{name} {seed}")
    shown = PICTURES[name]
    if not shown.state.view.whole_sphere:
        shown = shown.seen(changed(shown.state, camera=(chance.uniform(0, 360), chance.uniform(-60, 60))))
    if seed:
        shown = with_numbers(shown, chance)
    for size in chance.sample(SIZES, 3):
        at = frame_of(shown, *size)
        assert faults(shown, at, draw_overlay(shown, at, timing=True)) == [], size


@pytest.mark.parametrize("seed", range(12))
def test_at_any_size_of_window_and_monitor_too(seed: int) -> None:
    """With messages, with work, and with a band under the mouse."""
    chance = random.Random(seed)
    for _ in range(4):
        shown = with_numbers(PICTURES[chance.choice(list(PICTURES))], chance)
        said = chance.choice(("", message.warning("a warning that is as long as two lines of a small window " * 2)))
        shown = replace(shown, state=changed(shown.state, message=said))
        size, scale = (chance.randint(320, 1900), chance.randint(280, 1200)), chance.choice((1.0, 1.25, 2.0))
        at = frame_of(shown, *size, scale)
        work = chance.choice((None, None, Work("projecting 40 960 000 jittered samples", 0.43, 3.0)))
        drawn = draw_overlay(shown, at, work=work, hovered=chance.choice((None, 3)))
        assert faults(shown, at, drawn) == [], (shown.light.name, size, scale)


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("maps", [False, True])
def test_what_was_changed_is_said_at_every_size(size: tuple[int, int], maps: bool) -> None:
    """A picture in a report of a fault must say which window it has, which bands are muted, and that a sun is apart."""
    shown = PICTURES["all apart, maps" if maps else "all apart"]
    said = " | ".join(
        piece.text for piece in texts_of(draw_overlay(shown, frame_of(shown, *size))) if "key" not in piece.name
    )
    least = 1 if size == (400, 300) else 2 if size in ((500, 1000), (640, 320)) else 3
    assert sum(any(words in said for words in part) for part in (("Hann",), ("muted",), ("sun apart",))) >= least
    assert said.count("exposure") + said.count(" stops") <= 2


@pytest.mark.parametrize("size", [(400, 300), (500, 1000), (640, 360), (720, 720), (1280, 640)], ids=str)
def test_what_was_changed_of_surfaces_is_said_beside_their_radius(size: tuple[int, int]) -> None:
    shown = picture_of("studio", n_bands=9, window="hann", muted=frozenset({3}), lobe_view=True, error="signed")
    said = " | ".join(piece.text for piece in texts_of(draw_overlay(shown, frame_of(shown, *size))))
    assert all(words in said for words in ("muted 3", "Hann", "radius: ")), said
