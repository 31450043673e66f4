"""Sum or map, by what frames have cost: imaginary machines whose direct frames take a + p (b + c n^2) for p pixels."""

from __future__ import annotations

import pytest

from shviewer.viewer.desktop.evaluation import BELIEF, LIMIT, Evaluation

PIXELS = 200_000.0


class Machine:
    """Draws frames and tells the evaluation what they cost, as the window does; its clock goes on with every frame."""

    def __init__(self, fixed: float, per_term: float, per_pixel: float = 0.0) -> None:
        """Milliseconds of a frame: whatever its size, per term and 200 000 pixels, and per 200 000 pixels."""
        self.fixed, self.per_term, self.per_pixel = fixed, per_term, per_pixel
        self.evaluation = Evaluation()
        self.direct_frames = 0
        self.disturbance = 0.0
        self.now = 100.0

    def show(self, n_bands: int, pixels: float = PIXELS) -> bool:
        """Draw until nothing is due; True if that ended with a map."""
        for _ in range(5):
            self.now += 0.02
            if self.evaluation.choose(n_bands, pixels, self.now):
                return True
            self.direct_frames += 1
            cost = self.fixed + pixels / PIXELS * (self.per_pixel + self.per_term * n_bands**2) + self.disturbance
            again = self.evaluation.drawn(n_bands, pixels, cost, self.now)
            if not again and not self.evaluation.choose(n_bands, pixels, self.now):
                return False
        raise AssertionError("it does not come to rest")


def test_a_fast_machine_always_sums() -> None:
    machine = Machine(0.5, 0.002)
    assert not any(machine.show(n) for n in (5, 32, 1, 16, 32))


def test_a_slow_machine_draws_from_the_map_where_the_sum_takes_longer_than_the_limit() -> None:
    machine = Machine(8.0, 0.25)  # 16 ms at 5.7 bands
    assert [n for n in range(1, 33) if machine.show(n)] == list(range(6, 33))


def test_what_is_slow_is_not_tried_again_with_more_bands() -> None:
    machine = Machine(8.0, 0.25)
    machine.show(9)
    drawn = machine.direct_frames
    assert all(machine.show(n) for n in (9, 10, 32))
    assert machine.direct_frames == drawn


def test_one_disturbed_frame_decides_nothing() -> None:
    machine = Machine(8.0, 0.1)
    machine.evaluation.drawn(5, PIXELS, 200.0, machine.now)
    assert not machine.show(5)
    assert not machine.show(6)


def test_a_machine_that_was_busy_at_the_start_sums_again_after_a_while() -> None:
    machine = Machine(2.0, 0.1)
    machine.disturbance = 20.0
    assert machine.show(5)
    machine.disturbance = 0.0
    assert machine.show(5)  # not at once
    machine.now += 2 * BELIEF
    assert not machine.show(5)


def test_the_slower_the_sum_the_later_it_is_tried_again() -> None:
    machine = Machine(8.0, 0.25)
    machine.show(32)  # 264 ms
    machine.now += 2 * BELIEF
    drawn = machine.direct_frames
    assert machine.show(32)
    assert machine.direct_frames == drawn
    machine.now += 20 * BELIEF
    assert machine.show(32)
    assert machine.direct_frames == drawn + 1  # one frame settles it


def test_the_sum_comes_back_with_fewer_bands_and_no_count_flickers() -> None:
    machine = Machine(8.0, 0.25)
    assert machine.show(12)
    down = {n: machine.show(n) for n in range(11, 0, -1)}
    assert [n for n, by_map in down.items() if by_map] == [11, 10, 9, 8, 7, 6]
    before = machine.direct_frames
    seen = [machine.show(n) for _ in range(3) for n in (5, 6, 7, 6, 5)]
    assert seen == [False] + 14 * [True]  # 5 bands take 14 ms: less than the limit, too much to come back
    assert machine.direct_frames == before + 1
    assert not machine.show(3)


def test_small_frames_say_nothing_of_large_ones() -> None:
    """What does not depend on the pixels is most of a small frame: zooming out and back must not change anything."""
    machine = Machine(4.0, 0.1, 3.0)
    assert not machine.show(5)
    for _ in range(6):
        assert not machine.show(5, 0.02 * PIXELS)
    assert not machine.show(5)


def test_a_window_that_grows_is_measured_anew() -> None:
    machine = Machine(0.0, 0.25, 4.0)  # 10.25 ms with 5 bands
    assert not machine.show(5)
    assert machine.show(5, 2 * PIXELS)
    assert not machine.show(5)


@pytest.mark.parametrize("n_bands", [1, 5, 32])
def test_a_window_without_pixels_divides_by_nothing(n_bands: int) -> None:
    evaluation = Evaluation()
    assert not evaluation.drawn(n_bands, 0.0, 1.0, 0.0)
    assert not evaluation.choose(n_bands, 0.0, 0.0)
    assert not evaluation.choose(n_bands, 10 * LIMIT, 1.0)
