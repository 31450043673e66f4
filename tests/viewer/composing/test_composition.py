"""Where things stand, at every size of frame."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import replace

import pytest

from shviewer.viewer.composing.composition import Composition, compose, frame_for
from shviewer.viewer.composing.panes import Box, Sphere
from shviewer.viewer.view import View

SIZES = [
    *[(400, 300), (500, 300), (640, 320), (640, 480), (700, 400), (700, 600), (800, 480), (899, 479), (900, 300)],
    *[(900, 640), (1000, 400), (1024, 768), (1280, 640), (1280, 720), (1366, 768), (1440, 900), (1600, 900)],
    *[(1920, 1080), (2560, 1280), (2560, 1440), (3840, 2160), (3000, 500), (400, 600), (500, 1000), (500, 1600)],
    *[(600, 900), (900, 1200), (1000, 1000), (1080, 1920), (2160, 3840)],
]
KINDS = [(panes, maps) for panes in (2, 3) for maps in (False, True)]
EVERY = [(*size, *kind) for size in SIZES for kind in KINDS]


def frame(width: int, height: int, n_spheres: int, maps: bool, content_scale: float = 1.0) -> Composition:
    return compose(width, height, 1.0, content_scale, n_spheres, whole_sphere=maps)


def pictures(at: Composition) -> list[Box]:
    """The rectangle of every pane's picture."""
    if at.maps:
        return [pane.clip for pane in at.maps]
    return [Box(s.x - s.radius, s.y - s.radius, s.x + s.radius, s.y + s.radius) for s in at.spheres]


def parts(at: Composition) -> Iterator[tuple[str, Box]]:
    """Everything that has a place, by name; a text as high as its type."""
    for number, box in enumerate(pictures(at)):
        yield f"pane {number}", box
    if at.colour_bar:
        yield "colour bar", at.colour_bar
    if at.hairline.bottom <= at.height and at.hairline.right < at.width:
        yield "hairline", at.hairline
    numbers = at.numbers
    answer, figure, label = (at.px(size) for size in (numbers.answer_size, numbers.figure_size, numbers.label_size))
    for number, cell in enumerate(numbers.answers):
        yield f"answer {number}", Box(cell.left, cell.value - 0.73 * answer, cell.right - 1, cell.label + 0.2 * label)
    for number, cell in enumerate(numbers.figures):
        yield f"figure {number}", Box(cell.left, cell.value - 0.73 * figure, cell.right - 1, cell.label + 0.2 * label)
    if numbers.curve:
        below = at.px(8 if at.compact else 20)
        yield "curve", numbers.curve._replace(bottom=numbers.curve.bottom + below)
    small = at.px(11 if at.compact else 12)
    for name, line in (("legend", numbers.legend), ("foot", numbers.foot), ("exposure", numbers.exposure)):
        shared = name == "exposure" and line and numbers.foot and numbers.foot.baseline == line.baseline
        if line and not shared:
            yield name, Box(line.left, line.baseline - 0.73 * small, line.right, line.baseline + 0.2 * small)


@pytest.mark.parametrize("place", EVERY, ids=str)
def test_nothing_overlaps_and_the_margins_are_kept(place: tuple[int, int, int, bool]) -> None:
    """A pixel of rounding is allowed."""
    at = frame(*place)
    found = dict(parts(at))
    for name, box in found.items():
        assert box.left >= at.margin - 1, name
        assert box.right <= at.width - at.margin + 1, name
        assert box.top >= at.px(10), name
        assert box.bottom <= at.height - at.px(4), name
        assert box.width > 0, name
        assert box.height > 0, name
    for (one, box), (two, other) in itertools.combinations(found.items(), 2):
        inner = box._replace(left=box.left + 1, top=box.top + 1, right=box.right - 1, bottom=box.bottom - 1)
        assert not inner.overlaps(other), (one, two)


@pytest.mark.parametrize("place", EVERY, ids=str)
def test_captions_are_clear_of_their_panes_and_of_each_other(place: tuple[int, int, int, bool]) -> None:
    at = frame(*place)
    size = at.px(12 if at.compact else 15)
    rows = []
    for pane, caption in zip(at.panes, at.captions, strict=True):
        assert caption.head.right - caption.head.left > at.px(34)  # "error" has room, at every size
        lines = [(caption.head, size), *((line, at.px(12)) for line in (*caption.lines, caption.foot) if line)]
        for line, high in lines:
            box = Box(line.left, line.baseline - 0.73 * high, line.right, line.baseline)
            assert not pane.touches(box)
            assert 0 <= box.top < box.bottom <= at.height
            rows.append((box, caption))
    for (box, one), (other, two) in itertools.combinations(rows, 2):
        assert one is two or not box.overlaps(other)


@pytest.mark.parametrize("place", EVERY, ids=str)
def test_panes_are_equal_whole_and_as_large_as_their_share_of_the_frame(place: tuple[int, int, int, bool]) -> None:
    at = frame(*place)
    sizes = {(box.width, box.height) for box in pictures(at)}
    assert len(sizes) == 1
    ((wide, high),) = sizes
    assert wide == (2 * high if at.maps else high)
    assert all(side == int(side) for box in pictures(at) for side in box)
    assert high > (0.16 if at.maps else 0.24) * min(at.width, at.height)


@pytest.mark.parametrize("place", [(*size, *kind) for size in SIZES for kind in KINDS], ids=str)
def test_answers_and_error_are_there_from_the_smallest_window_on(place: tuple[int, int, int, bool]) -> None:
    numbers = frame(*place).numbers
    assert len(numbers.answers) == 2
    assert len(numbers.figures) >= 4
    assert numbers.label_size >= (11 if frame(*place).compact else 12)


@pytest.mark.parametrize("size", [size for size in SIZES if size not in {(400, 300), (500, 300), (400, 600)}], ids=str)
def test_the_curve_is_there_but_in_the_smallest_windows(size: tuple[int, int]) -> None:
    for n_spheres in (2,) if size[0] < 700 else (2, 3):
        assert frame(*size, n_spheres, False).numbers.curve is not None


@pytest.mark.parametrize("kind", KINDS, ids=str)
@pytest.mark.parametrize(
    ("low", "high"), [((640, 320), (900, 480)), ((400, 300), (640, 320)), ((1280, 640), (1400, 800))]
)
def test_a_larger_frame_never_has_smaller_panes(
    low: tuple[int, int], high: tuple[int, int], kind: tuple[int, bool]
) -> None:
    before, after = pictures(frame(*low, *kind))[0], pictures(frame(*high, *kind))[0]
    assert after.height >= 0.85 * before.height  # a frame that is no longer compact has larger type


def test_the_design_size_is_the_design() -> None:
    at = compose(1280, 640)
    assert at.scale == 1
    assert [s.x for s in at.spheres] == pytest.approx([326, 954], abs=1)
    assert [s.y for s in at.spheres] == pytest.approx([242, 242], abs=1)
    assert at.spheres[0].radius == pytest.approx(222, abs=1)
    assert at.hairline == Box(24, 480, 1256, 481)
    assert at.numbers.curve == Box(652, 498, 1256, 592)
    assert [cell.left for cell in at.numbers.figures] == [24, 145, 266, 387, 508]
    assert (at.captions[0].head.baseline, at.captions[0].lines[0].baseline) == (34, 52)


def test_three_spheres_fill_their_panes_and_the_curve_gets_two_thirds() -> None:
    at = compose(1280, 720, n_spheres=3)
    assert [s.x for s in at.spheres] == pytest.approx([220, 640, 1060], abs=1)
    assert 2 * at.spheres[0].radius == pytest.approx(392, abs=1)
    assert at.numbers.curve is not None
    assert at.numbers.curve.left == 444


def test_a_tall_window_has_its_panes_under_each_other() -> None:
    at = compose(500, 1000)
    assert at.spheres[0].x == at.spheres[1].x == pytest.approx(250, abs=1)
    assert 2 * at.spheres[0].radius == pytest.approx(344, abs=2)
    assert at.hairline.top == pytest.approx(732, abs=1)


def test_the_error_of_maps_makes_two_rows_of_two_and_the_curve_is_the_fourth() -> None:
    at = compose(1280, 640, n_spheres=3, whole_sphere=True)
    first, second, third = pictures(at)
    assert first.left == third.left
    assert first.top == second.top < third.top
    assert at.numbers.curve is not None
    assert (at.numbers.curve.left, at.numbers.curve.right) == pytest.approx((second.left, second.right), abs=1)
    assert at.hairline.height > at.hairline.width
    row = compose(1280, 640, n_spheres=2, whole_sphere=True)
    assert first.width > 0.75 * pictures(row)[0].width


@pytest.mark.parametrize("size", [(820, 560), (1600, 640), (2000, 400), (1000, 700)])
@pytest.mark.parametrize("n_panes", [2, 3])
def test_maps_beside_each_other_begin_with_their_numbers(size: tuple[int, int], n_panes: int) -> None:
    at = compose(*size, n_spheres=n_panes, whole_sphere=True)
    assert abs(at.maps[0].clip.left - at.numbers.answers[0].left) <= 1 or at.hairline.height > at.hairline.width
    assert abs(at.maps[0].clip.left - at.margin) <= 1


def test_maps_with_their_error_stand_on_the_margin_like_the_foot() -> None:
    at = compose(1280, 640, n_spheres=3, whole_sphere=True)
    assert at.numbers.foot is not None
    assert [(at.maps[n].clip.left, at.maps[n].clip.width) for n in (0, 1, 2)] == [(24, 484), (532, 484), (24, 484)]
    assert at.captions[0].head.left == at.numbers.foot.left == 24


@pytest.mark.parametrize("size", [(720, 720), (640, 640), (800, 800), (1000, 900)])
def test_figures_stand_in_two_rows_before_their_columns_are_narrow(size: tuple[int, int]) -> None:
    at = compose(*size)
    figures = at.numbers.figures
    assert min(cell.right - cell.left for cell in figures) >= 84 * at.scale
    assert len({cell.value for cell in figures}) == (2 if at.numbers.foot.right < size[0] / 2 else 1)


def test_twice_the_pixels_is_the_same_picture_twice_as_large() -> None:
    """But for the rounding to whole pixels."""
    small, large = compose(1280, 640), compose(2560, 1280)
    assert large.scale == 2 * small.scale
    for one, two in zip(small.spheres, large.spheres, strict=True):
        assert (two.x, two.y, two.radius) == pytest.approx((2 * one.x, 2 * one.y, 2 * one.radius), abs=2)
    assert large.hairline.top == 2 * small.hairline.top


def test_type_follows_the_monitors_content_scale_and_never_shrinks() -> None:
    assert compose(640, 320).scale == 1
    assert compose(1280, 640, content_scale=2.0).scale == 2
    assert compose(1280, 640, content_scale=2.0).compact
    assert compose(2560, 1280, content_scale=2.0).scale == 2


@pytest.mark.parametrize("zoom", [1.01, 4.0])
def test_enlarged_spheres_are_cut_between_their_panes_and_at_the_hairline(zoom: float) -> None:
    for n_spheres in (2, 3):
        at = compose(1280, 640, zoom, n_spheres=n_spheres)
        plain = compose(1280, 640, n_spheres=n_spheres)
        assert at.over
        for one, enlarged in zip(plain.spheres, at.spheres, strict=True):
            assert enlarged.radius == zoom * one.radius
            assert (enlarged.x, enlarged.y) == (one.x, one.y)
            assert enlarged.clip.bottom <= at.hairline.top
        for one, two in itertools.pairwise(at.spheres):
            assert one.clip.right < two.clip.left
        assert (at.spheres[0].clip.left, at.spheres[0].clip.top, at.spheres[-1].clip.right) == (0, 0, 1280)


@pytest.mark.parametrize("width", [64, 100, 200, 320, 900, 8192])
@pytest.mark.parametrize("height", [64, 100, 160, 640, 8192])
@pytest.mark.parametrize("kind", KINDS, ids=str)
def test_every_frame_that_is_allowed_has_panes_in_it(width: int, height: int, kind: tuple[int, bool]) -> None:
    for content_scale in (1.0, 2.0):
        at = frame(width, height, *kind, content_scale)
        for box in pictures(at):
            assert box.width > 0
            assert 0 <= box.left < box.right <= width
            assert 0 <= box.top < box.bottom <= height


def test_a_box_holds_its_left_top_and_not_its_right_bottom() -> None:
    box = Box(2, 3, 5, 7)
    assert box.contains(2, 3)
    assert box.contains(4.9, 6.9)
    assert not any(box.contains(*point) for point in ((5, 3), (2, 7), (1.9, 4), (3, 2.9)))


def test_a_sphere_touches_a_box_only_where_it_is_seen() -> None:
    sphere = Sphere(50, 50, 20, Box(0, 0, 100, 60))
    assert sphere.touches(Box(45, 45, 55, 55))
    assert sphere.touches(Box(69, 49, 90, 51))
    assert not sphere.touches(Box(71, 49, 90, 51))
    assert not sphere.touches(Box(65, 65, 90, 90))  # beside the rim, though within its square
    assert not sphere.touches(Box(45, 61, 55, 69))  # cut away


def test_a_frame_is_laid_out_once_for_a_view() -> None:
    """Whatever asks for it: a frame of the window asked three times, which cost it more Python than its uniforms."""
    seen = View(zoom=1.25, whole_sphere=True)
    assert frame_for(seen, 1111, 555) is frame_for(seen, 1111, 555)
    assert frame_for(replace(seen, marks=False), 1111, 555) is frame_for(seen, 1111, 555)
    assert frame_for(replace(seen, zoom=1.5), 1111, 555) == compose(1111, 555, 1.5, whole_sphere=True)
