"""Where things stand, at every size of frame."""

from __future__ import annotations

import pytest

from shviewer.viewer.composition import Composition, compose
from shviewer.viewer.panes import Box, Sphere

SIZES = [(320, 160), (400, 300), (640, 320), (700, 400), (1280, 640), (2560, 1280), (900, 1200), (3000, 500)]
FRAMES = [(*size, scale) for size in SIZES for scale in (1.0, 2.0)]


def frame(width: int, height: int, content_scale: float) -> Composition:
    return compose(width, height, 1.0, content_scale)


@pytest.mark.parametrize("place", FRAMES)
def test_spheres_neither_meet_nor_leave_the_frame_nor_reach_the_hairline(place: tuple[int, int, float]) -> None:
    composition = frame(*place)
    left, right = composition.spheres
    assert left.radius == right.radius > 3
    assert left.y == right.y
    assert left.x + left.radius < composition.width / 2 < right.x - right.radius
    assert left.x - left.radius > 0
    assert right.x + right.radius < composition.width
    assert left.x == composition.width - right.x
    assert left.y - left.radius > 0
    assert left.y + left.radius <= composition.hairline_y < composition.height


@pytest.mark.parametrize("size", SIZES)
def test_captions_stand_above_the_spheres_and_figures_under_them(size: tuple[int, int]) -> None:
    composition = compose(*size)
    sphere = composition.spheres[0]
    assert 0 < composition.caption_y < sphere.y - sphere.radius + composition.px(20)
    if size != (320, 160):  # there the type is as small as it gets, and the strip is cut
        assert composition.hairline_y + composition.px(118) <= composition.height + 1
        assert sphere.y + sphere.radius < composition.hairline_y


def test_the_design_size_is_the_design() -> None:
    """About 70 % of the height is sphere; the hairline leaves 118 pixels for figures."""
    composition = compose(1280, 640)
    assert composition.scale == 1
    assert composition.spheres[0].x == 320
    assert 2 * composition.spheres[0].radius / 640 == pytest.approx(0.7, abs=0.02)
    assert composition.hairline_y == 522


def test_twice_the_pixels_is_the_same_picture_twice_as_large() -> None:
    small, large = compose(1280, 640), compose(2560, 1280)
    assert large.scale == 2 * small.scale
    for one, two in zip(small.spheres, large.spheres, strict=True):
        assert (two.x, two.y, two.radius) == (2 * one.x, 2 * one.y, 2 * one.radius)
    assert large.hairline_y == 2 * small.hairline_y


def test_type_follows_the_monitors_content_scale() -> None:
    assert compose(640, 320, 1.0, 1.0).scale == pytest.approx(0.7)
    assert compose(640, 320, 1.0, 2.0).scale == pytest.approx(1.4)
    assert compose(2560, 1280, 1.0, 2.0).scale == 2


def test_a_tall_window_centres_the_picture() -> None:
    composition = compose(900, 1200)
    sphere = composition.spheres[0]
    above, below = composition.caption_y, composition.height - composition.hairline_y
    assert above > 100
    assert abs((sphere.y - sphere.radius) - (composition.height - sphere.y - sphere.radius)) < 200
    assert below > 100


def test_zoom_enlarges_the_spheres_and_cuts_them_to_their_halves() -> None:
    plain, zoomed = compose(1280, 640), compose(1280, 640, 4.0)
    for one, four, edge in zip(plain.spheres, zoomed.spheres, ((0, 640), (640, 1280)), strict=True):
        assert four.radius == 4 * one.radius
        assert (four.x, four.y) == (one.x, one.y)
        assert edge[0] <= four.clip.left < four.clip.right <= edge[1]
        assert four.clip.bottom <= zoomed.hairline_y
        assert four.clip.top > zoomed.caption_y
    assert zoomed.spheres[0].clip.right < zoomed.spheres[1].clip.left


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
