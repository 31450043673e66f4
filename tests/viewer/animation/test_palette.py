"""One palette for all frames: no colour is far from its entry, however rare it is."""

from __future__ import annotations

import numpy as np
import pytest

from shviewer.viewer.animation.palette import BLOCK, ColourCount, SharedPalette

GREY, BLUE, INK = (39, 39, 42), (32, 98, 160), (236, 236, 240)


def palette_of(*frames: np.ndarray, most: int = 256) -> SharedPalette:
    counted = ColourCount()
    for frame in frames:
        counted.add(frame)
    return counted.palette(most)


def ramp(count: int = 64) -> np.ndarray:
    """Colours that fill a cube far beyond what a palette can hold."""
    return np.random.default_rng(0).integers(0, 256, (count, 64, 3), dtype=np.uint8)


def test_few_colours_are_kept_exactly_and_the_most_frequent_comes_first() -> None:
    frame = np.full((8, 8, 3), GREY, dtype=np.uint8)
    frame[0, :2], frame[1, 1] = BLUE, INK
    palette = palette_of(frame)
    assert sorted(map(tuple, palette.colours.tolist())) == sorted([GREY, BLUE, INK])
    assert tuple(palette.colours[0]) == GREY
    np.testing.assert_array_equal(palette.colours[palette.indices(frame)], frame)


def test_a_single_pixel_of_a_single_frame_keeps_its_colour_among_a_million_others() -> None:
    dull = np.clip(np.random.default_rng(0).normal(60, 8, (512, 512, 3)), 0, 255).astype(np.uint8)
    rare = dull.copy()
    rare[7, 9] = (20, 90, 250)
    palette = palette_of(dull, dull, rare, dull, most=64)
    np.testing.assert_allclose(palette.colours[palette.indices(rare[7, 9])], rare[7, 9], rtol=0, atol=1)


@pytest.mark.parametrize("most", [2, 20, 255])
def test_every_bin_gets_the_nearest_of_the_colours(most: int) -> None:
    frame = ramp(16)
    palette = palette_of(frame, most=most)
    assert len(palette.colours) == most
    pixels = frame.reshape(-1, 3).astype(float)
    distance = ((pixels[:, None] - palette.colours.astype(float)) ** 2).sum(axis=2)
    taken = distance[np.arange(len(pixels)), palette.indices(frame).ravel()]
    # entries are rounded and stand for the mean of a bin: in each channel a pixel may seem (1 + 1/2) off
    slack = 2 * np.sqrt(3) * 1.5
    assert (np.sqrt(taken) <= np.sqrt(distance.min(axis=1)) + slack).all()


def test_a_frame_larger_than_a_block_is_counted_whole() -> None:
    frame = np.full((BLOCK + 5, 1, 3), GREY, dtype=np.uint8)
    frame[-1] = BLUE
    counted = ColourCount()
    counted.add(frame)
    assert counted.counts.sum() == BLOCK + 5
    assert {tuple(colour) for colour in counted.palette().colours.tolist()} == {GREY, BLUE}
