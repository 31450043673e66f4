"""What is written over the spheres: it fits, nothing overlaps, and it says what is so."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from helpers import Lazily, frame_of, overlap, picture_of
from numpy.typing import NDArray

from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.function import FunctionLight
from shviewer.viewer.composition import compose
from shviewer.viewer.overlay.band_axis import SLOT_COUNTS
from shviewer.viewer.overlay.captions import describe_light
from shviewer.viewer.overlay.lettering import ACCENT, WARNING
from shviewer.viewer.overlay.overlay import Overlay, draw_overlay
from shviewer.viewer.state import state_of
from shviewer.words import percent, radiance

SIZES = [
    (320, 160),
    (400, 300),
    (640, 320),
    (700, 400),
    (1280, 640),
    (2560, 1280),
    (2560, 1440),
    (900, 1200),
    (3000, 500),
    (500, 1600),
]
FRAMES = [(*size, scale) for size in SIZES for scale in (1.0, 2.0)]
LONG = "a_light_whose_name_is_much_longer_than_anybody_would_ever_want_it_to_be_in_a_caption"


LOW_RANGE = EnvironmentLight(
    np.random.default_rng(1).random((8, 16, 3), np.float32),
    name="photo",
    notes=("a",),
    encoding="PNG, 8 bit sRGB (LDR)",
)
PICTURES = Lazily(
    {
        "green": lambda: picture_of(),
        "muted": lambda: picture_of(n_bands=12, muted=frozenset({0, 2, 4, 6, 8, 10}), cursor=3, cursor_visible=True),
        "sampled": lambda: picture_of("sun-sky", n_bands=32, method="jittered", samples=1_000_000),
        "low range": lambda: picture_of(LOW_RANGE, n_bands=9),
        "split": lambda: picture_of("sun-sky", split_sun=True),
        "long name": lambda: picture_of(light=FunctionLight(lambda d: 1 + d[:, 2], LONG), n_bands=128),
        "message": lambda: picture_of(
            message="a-rather-long-path/" * 12 + "bad.hdr: an empty file (0 bytes); fetch or export it again"
        ),
        "zoomed": lambda: picture_of(zoom=3.0),
        "signed error": lambda: picture_of(error="signed"),
        "relative error": lambda: picture_of("venice_sunset", n_bands=9, error="relative", tone="log"),
        "tiny error": lambda: picture_of(n_bands=60, error="absolute", muted=frozenset({1, 2})),
        "zoomed error": lambda: picture_of(error="signed", zoom=2.5, split_sun=True, light="sun-sky"),
    }
)


@pytest.mark.parametrize("name", PICTURES)
@pytest.mark.parametrize("place", FRAMES, ids=str)
def test_nothing_overlaps_and_nothing_is_cut(name: str, place: tuple[int, int, float]) -> None:
    shown = PICTURES[name]
    composition = frame_of(shown, *place)
    drawn = draw_overlay(shown, composition, timing=True)
    assert drawn.image.shape == (place[1], place[0], 4)
    assert drawn.image.dtype == np.uint8
    for one, box in drawn.boxes.items():
        assert box.left < box.right, one
        assert box.top < box.bottom, one
        assert min(box.left, box.top) >= 0, one
        assert box.right <= place[0], one
        assert box.bottom <= place[1], one
        assert not any(sphere.touches(box) for sphere in composition.spheres), one
    for (one, box), (two, other) in itertools.combinations(drawn.boxes.items(), 2):
        assert not overlap(box, other), (one, two)


@pytest.mark.parametrize("name", PICTURES)
@pytest.mark.parametrize("place", FRAMES, ids=str)
def test_every_mark_is_in_a_box_that_was_reported(name: str, place: tuple[int, int, float]) -> None:
    """So that the test above sees all there is: outside the boxes there is only the hairline."""
    shown = PICTURES[name]
    composition = frame_of(shown, *place)
    drawn = draw_overlay(shown, composition)
    left = drawn.image[..., 3] > 0
    for box in drawn.boxes.values():
        left[int(box.top) - 1 : int(box.bottom) + 2, max(int(box.left) - 1, 0) : int(box.right) + 2] = False
    rows = np.flatnonzero(left.any(axis=1))
    assert set(rows) <= set(range(int(composition.hairline_y), int(composition.hairline_y + composition.scale) + 2))


@pytest.mark.parametrize("width", [64, 65, 100, 150, 320, 900])
@pytest.mark.parametrize("height", [64, 65, 100, 160, 640])
@pytest.mark.parametrize("content_scale", [1.0, 2.0])
def test_every_frame_that_is_allowed_can_be_drawn(width: int, height: int, content_scale: float) -> None:
    for shown in (PICTURES["green"], picture_of(help_visible=True)):
        composition = compose(width, height, 1.0, content_scale)
        assert draw_overlay(shown, composition, opengl="OpenGL 3.3").image.shape == (height, width, 4)


def test_at_half_size_the_captions_the_error_and_the_bars_are_there() -> None:
    boxes = draw_overlay(PICTURES["green"], compose(640, 320)).boxes
    assert {"original", "reconstruction", "light", "method", "relative_l2", "relative_l2_label", "bars"} <= set(boxes)


@pytest.mark.parametrize("size", [(640, 320), (720, 400), (1280, 640), (2560, 1280)])
@pytest.mark.parametrize("timing", [False, True])
def test_what_may_be_missed_of_a_function_is_said_at_every_size(size: tuple[int, int], timing: bool) -> None:
    boxes = draw_overlay(PICTURES["long name"], compose(*size), timing=timing).boxes
    assert "missed" in boxes
    assert "method" in boxes or size[0] < 1280


@pytest.mark.parametrize("size", [(1280, 640), (2560, 1280)])
def test_at_full_size_everything_is_there(size: tuple[int, int]) -> None:
    boxes = draw_overlay(PICTURES["green"], compose(*size), timing=True).boxes
    figures = {"relative_l2", "max_error", "minimum", "negative_area"}
    captions = {"original", "reconstruction", "light", "description", "method", "time"}
    assert set(boxes) == captions | figures | {f"{name}_label" for name in figures} | {
        "bars",
        "swatch",
        "exposure",
        "hint",
    }


def test_captions_stand_over_the_middles_of_their_spheres_and_in_the_corners() -> None:
    composition = compose(1280, 640)
    boxes = draw_overlay(PICTURES["green"], composition).boxes
    for name, sphere in zip(("original", "reconstruction"), composition.spheres, strict=True):
        assert (boxes[name].left + boxes[name].right) / 2 == pytest.approx(sphere.x, abs=1.5)
        assert boxes[name].bottom < sphere.y - sphere.radius
    assert boxes["light"].left == pytest.approx(composition.margin, abs=2)
    assert boxes["method"].right == pytest.approx(composition.width - composition.margin, abs=2)


def test_figures_keep_their_place_whatever_they_say() -> None:
    names = ("relative_l2", "max_error", "minimum", "negative_area")
    composition = compose(1280, 640)
    places = set()
    for shown in PICTURES.values():
        if shown.state.view.zoom == 1:
            boxes = draw_overlay(shown, composition).boxes
            places.add(tuple(round(boxes[f"{name}_label"].left) for name in names))
    assert len(places) == 1


def test_only_what_depends_on_the_state_differs_between_states() -> None:
    """Equal pictures are drawn equally; one band more is not."""
    composition = compose(640, 320)
    first, again = (draw_overlay(picture_of(n_bands=n), composition).image for n in (7, 7))
    np.testing.assert_array_equal(first, again)
    assert (first != draw_overlay(picture_of(n_bands=8), composition).image).any()


def test_the_time_is_said_only_when_asked_for() -> None:
    composition = compose(1280, 640)
    assert "time" not in draw_overlay(PICTURES["green"], composition).boxes
    assert "time" in draw_overlay(PICTURES["green"], composition, timing=True).boxes


TEN_SIZES = [*SIZES, (800, 400), (1920, 1080)]


@pytest.mark.parametrize("size", TEN_SIZES, ids=str)
@pytest.mark.parametrize("content_scale", [1.0, 2.0])
def test_splitting_a_sun_off_takes_no_figure_and_no_label_away(size: tuple[int, int], content_scale: float) -> None:
    composition = compose(*size, 1.0, content_scale)
    whole, split = (
        set(draw_overlay(picture_of("sun-sky", split_sun=wanted), composition).boxes) for wanted in (False, True)
    )
    figures = {
        f"{name}{end}" for name in ("relative_l2", "max_error", "minimum", "negative_area") for end in ("", "_label")
    }
    assert whole & figures <= split


# --- what must not be missed of a light


def written(drawn: Overlay, name: str) -> float:
    """The width of a piece."""
    return drawn.boxes[name].right - drawn.boxes[name].left


@pytest.mark.parametrize("quantity", ["radiance", "irradiance"])
@pytest.mark.parametrize(
    ("encoding", "notes", "end"),
    [
        ("OpenEXR", (), ""),
        ("PNG, 8 bit sRGB (LDR)", (), ", LDR"),
        ("OpenEXR", ("a",), ", 1 note"),
        (None, ("a", "b"), ", 2 notes"),
        ("JPEG, 8 bit sRGB (LDR)", ("a", "b"), ", LDR, 2 notes"),
    ],
)
def test_the_description_ends_in_what_must_not_be_missed(
    quantity: str, encoding: str | None, notes: tuple[str, ...], end: str
) -> None:
    light = EnvironmentLight(np.ones((4, 8, 3), np.float32), name="mine", notes=notes, encoding=encoding)
    shown = picture_of(light, quantity=quantity)
    assert describe_light(shown)[0] == light.description + end
    width = written(draw_overlay(shown, compose(1280, 640)), "description")
    bare = picture_of(light=EnvironmentLight(light.pixels, name="mine"), quantity=quantity)
    assert (width > written(draw_overlay(bare, compose(1280, 640)), "description")) == bool(end)


def test_where_the_description_has_no_room_it_goes_before_what_must_not_be_missed() -> None:
    light = EnvironmentLight(np.ones((4, 8, 3), np.float32), name="mine", notes=("a",), encoding="PNG (LDR)")
    assert describe_light(picture_of(light))[1:] == ["LDR, 1 note", "LDR"]


@pytest.mark.parametrize("size", TEN_SIZES[1:], ids=str)
@pytest.mark.parametrize("name", ["p", "ldr_photo", LONG])
def test_low_range_is_said_at_every_size_but_the_smallest(size: tuple[int, int], name: str) -> None:
    shown = picture_of(light=replace(LOW_RANGE, name=name))
    for content_scale in (1.0, 2.0):
        boxes = draw_overlay(shown, compose(*size, 1.0, content_scale)).boxes
        assert {"description", "encoding"} & set(boxes), content_scale


# --- bars


def bars_of(n_bands: int, **changes: object) -> Overlay:
    return draw_overlay(picture_of(n_bands=n_bands, **changes), compose(1280, 640))


@pytest.mark.parametrize("page", [(1, 10), (11, 16), (17, 32), (33, 64)])
def test_a_band_keeps_its_spot_for_every_number_of_bands_on_a_page(page: tuple[int, int]) -> None:
    first, last = (bars_of(n) for n in page)
    assert first.bars == last.bars
    assert len(first.bars) == SLOT_COUNTS[[10, 16, 32, 64].index(page[1])] >= page[1]


def test_bars_stand_side_by_side_and_a_click_finds_one() -> None:
    bars = bars_of(9).bars
    assert list(bars) == list(range(10))
    for band, box in bars.items():
        x, y = (box.left + box.right) / 2, (box.top + box.bottom) / 2
        assert [other for other, place in bars.items() if place.contains(x, y)] == [band]
    assert all(bars[band].right == pytest.approx(bars[band + 1].left) for band in range(9))


def column(drawn: Overlay, band: int) -> NDArray[np.uint8]:
    """The pixels of a band's bar, down to its foot."""
    box = drawn.bars[band]
    return drawn.image[int(box.top) : int(box.bottom) - 19, int(box.left) : int(box.right)]


def test_a_bar_in_use_is_full_a_muted_one_hollow_and_one_above_n_dim() -> None:
    drawn = bars_of(5, muted=frozenset({1}))
    blue = [np.all(column(drawn, band) == ACCENT, axis=-1) for band in range(6)]
    middles = [bar[:, bar.shape[1] // 2].sum() for bar in blue]
    assert middles[0] > 20  # 17 % of the energy
    assert middles[1] == 2  # its top and bottom edge
    assert blue[1].sum() > 100
    assert blue[5].sum() == 0
    assert (column(drawn, 5)[..., 3] > 0).any()


def test_the_height_of_a_bar_is_its_share_of_the_energy() -> None:
    """Green's light: 17, 22, 13, 22, 18 % in the first bands; a pixel is half a percent."""
    drawn = bars_of(5)
    shares = PICTURES["green"].figures.energy_share
    heights = [np.all(column(drawn, band) == ACCENT, axis=-1).any(axis=1).sum() for band in range(5)]
    ratios = np.array(heights) / np.array(shares[:5])
    np.testing.assert_allclose(ratios, ratios.mean(), rtol=0.06)


def test_the_cursor_is_shown_under_its_band_once_it_is_used() -> None:
    without, at_2 = bars_of(5), bars_of(5, cursor=2, cursor_visible=True)
    changed = np.flatnonzero((without.image != at_2.image).any(axis=(0, 2)))
    assert len(changed)
    assert without.bars[2].left <= changed.min()
    assert changed.max() <= without.bars[2].right
    np.testing.assert_array_equal(bars_of(5, cursor=2).image, without.image)


# --- messages and help


def test_a_message_takes_the_place_of_the_hint_and_is_shortened_to_fit() -> None:
    short = draw_overlay(picture_of(message="saved a.png"), compose(1280, 640))
    assert "hint" not in short.boxes
    for size in ((320, 160), (640, 320), (1280, 640)):
        box = draw_overlay(PICTURES["message"], compose(*size)).boxes["message"]
        assert box.right <= size[0]
    assert short.boxes["message"].right < box.right
    assert (np.abs(short.image[..., :3].astype(int) - WARNING[:3]).max(axis=-1) < 3).any()


def ink(drawn: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """What is lighter than the dimmed ground: all that is written on the help sheet."""
    return drawn[..., :3].max(axis=-1) > 60


@pytest.mark.parametrize(
    "size", [(400, 300), (500, 250), (640, 320), (1280, 640), (2560, 1280), (900, 1200), (3000, 500)]
)
def test_the_help_is_written_within_the_frame(size: tuple[int, int]) -> None:
    """Its present values may be long: then they are shortened, and nothing comes near an edge."""
    state = state_of("file.py:" + LONG, help_visible=True, n_bands=32, muted=frozenset(range(0, 32, 2)))
    shown = replace(picture_of(n_bands=32), state=state)
    composition = compose(*size)
    sheet = draw_overlay(shown, composition, opengl="OpenGL 4.5, llvmpipe (LLVM 15.0.6, 256 bits)").image
    written = ink(sheet)
    edge = round(composition.margin / 2)
    assert written.sum() > 2000
    assert not written[:2].any()
    assert not written[-2:].any()
    assert not written[:, :edge].any()
    assert not written[:, -edge:].any()
    middle = written[:, size[0] // 2 - 1 : size[0] // 2 + 1]
    assert not middle.any()  # the two columns do not meet
    assert (sheet[..., 3] >= 200).all()  # the picture is dimmed everywhere


def test_the_help_shows_present_values() -> None:
    composition = compose(1280, 640)
    five, six = (draw_overlay(picture_of(n_bands=n, help_visible=True), composition).image for n in (5, 6))
    rows = np.flatnonzero((five != six).any(axis=(1, 2)) & ink(five).any(axis=1))
    assert len(rows)


# --- numbers


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.0, "0 %"),
        (1e-9, "< 0.0001 %"),
        (1.1e-6, "0.0001 %"),
        (0.0123456, "1.23 %"),
        (0.283, "28.3 %"),
        (0.9998, "99.98 %"),
        (0.999999, "99.9999 %"),
        (1.0, "100 %"),
        (1.234, "123 %"),
        (16.0, "1600 %"),
        (float("inf"), "infinite"),
        (float("nan"), "infinite"),
    ],
)
def test_a_share_has_three_digits_and_never_rounds_up_to_100(share: float, text: str) -> None:
    assert percent(share) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (1e-13, "0"),
        (-1e-13, "0"),
        (1e-9, "1.00e-9"),
        (-0.137, "-0.137"),
        (0.0012345, "0.00123"),
        (0.26512, "0.265"),
        (5.0, "5.00"),
        (-42.42, "-42.4"),
        (99999.0, "99999"),
        (1.6e9, "1.60e9"),
        (-3.21e-7, "-3.21e-7"),
    ],
)
def test_a_radiance_has_three_digits_or_a_power_of_ten(value: float, text: str) -> None:
    assert radiance(value, 1e-6) == text


@pytest.mark.parametrize("size", [(1280, 640), (640, 320)])
@pytest.mark.parametrize("to", [9, 16, 32])
def test_through_a_sweep_every_bar_stays_where_it_is(size: tuple[int, int], to: int) -> None:
    composition = compose(*size)
    end = draw_overlay(picture_of(n_bands=to), composition)
    for n_bands in range(1, to, max(to // 8, 1)):
        drawn = draw_overlay(picture_of(n_bands=n_bands, sweep_to=to), composition)
        assert drawn.bars == end.bars
        assert drawn.boxes["bars"] == end.boxes["bars"]
    assert len(end.bars) > 9
