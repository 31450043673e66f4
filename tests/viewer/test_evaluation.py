"""Sum or map, by what frames have cost: an imaginary machine whose direct frames take a + b n^2."""

from __future__ import annotations

import pytest

from shviewer.viewer.evaluation import LIMIT, Evaluation

PIXELS = 155_000.0


class Machine:
    """Draws frames and tells the evaluation what they cost, as the window does."""

    def __init__(self, fixed: float, per_term: float) -> None:
        self.fixed, self.per_term = fixed, per_term
        self.evaluation = Evaluation()
        self.direct_frames = 0
        self.disturbance = 0.0

    def cost(self, n_bands: int) -> float:
        return self.fixed + self.per_term * n_bands**2

    def show(self, n_bands: int) -> bool:
        """Draw until nothing is due; True if that ended with a map."""
        for _ in range(5):
            if self.evaluation.choose(n_bands, PIXELS):
                return True
            self.direct_frames += 1
            again = self.evaluation.drawn(n_bands, PIXELS, self.cost(n_bands) + self.disturbance)
            self.disturbance = 0.0
            if not again and not self.evaluation.choose(n_bands, PIXELS):
                return False
        raise AssertionError("it does not come to rest")


def test_a_fast_machine_always_sums() -> None:
    machine = Machine(0.5, 0.002)
    assert not any(machine.show(n) for n in (5, 32, 1, 16, 32))


def test_a_slow_machine_draws_from_the_map_where_the_sum_takes_longer_than_the_limit() -> None:
    machine = Machine(8.0, 0.25)  # 16 ms at 5.7 bands
    assert [n for n in range(1, 33) if machine.show(n)] == list(range(6, 33))


def test_what_is_slow_once_is_not_tried_again_with_more_bands() -> None:
    machine = Machine(8.0, 0.25)
    machine.show(9)
    drawn = machine.direct_frames
    assert all(machine.show(n) for n in (9, 10, 32))
    assert machine.direct_frames == drawn


def test_one_disturbed_frame_decides_nothing() -> None:
    machine = Machine(8.0, 0.1)
    machine.disturbance = 200.0
    assert not machine.show(5)
    assert not machine.show(6)


def test_the_sum_comes_back_with_fewer_bands_and_no_count_flickers() -> None:
    machine = Machine(8.0, 0.25)
    assert machine.show(12)
    down = [machine.show(n) for n in range(11, 0, -1)]
    assert down[-1] is False  # one band is summed
    again = [[machine.show(n) for n in (5, 6, 7, 6, 5)] for _ in range(3)]
    assert again[1] == again[2]
    before = machine.direct_frames
    for _ in range(20):
        machine.show(7)
    assert machine.direct_frames == before or not machine.show(7)


def test_a_larger_window_is_slower() -> None:
    evaluation = Evaluation()
    for _ in range(2):
        evaluation.drawn(5, PIXELS, LIMIT / 2)
    assert not evaluation.choose(5, PIXELS)
    assert evaluation.choose(5, 3 * PIXELS)
    assert not evaluation.choose(5, PIXELS)


@pytest.mark.parametrize("n_bands", [1, 5, 32])
def test_a_window_without_pixels_divides_by_nothing(n_bands: int) -> None:
    evaluation = Evaluation()
    assert not evaluation.drawn(n_bands, 0.0, 1.0)
    assert not evaluation.choose(n_bands, 0.0)
