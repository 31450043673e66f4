"""Measuring projections: methods x samples x bands of every light, time against the error of the coefficients.

One round is a light with one number of bands and one number of samples; all its experiments take turns, so that their times
can be compared. Rounds come smallest first, until the time is up. Random methods draw new samples for each of the first SEEDS
repeats, outside the clock, which gives time and spread in one go.
"""

from __future__ import annotations

import sys
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from time import perf_counter
from typing import NamedTuple

import numpy as np

from shviewer.benchmark.measuring.experiments import BEST, METHODS, PAPER, PAPER_SAMPLES, Method, Prepared
from shviewer.benchmark.measuring.measured_lights import MeasuredLight
from shviewer.benchmark.measuring.timing import Timing, time_interleaved, wall_milliseconds
from shviewer.benchmark.rows.row import Row, not_measured
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import relative, squared_error
from shviewer.lights.light import Light

SECTION = "projection"
SEEDS = 5
AT_LEAST = 5
"""The fewest repeats. Each experiment is run twice more: cold, and for its memory."""

SET_UPS, SHORT = 3, 50.0
"""The most times that setting up is timed, and the milliseconds in all after which it is not timed again."""

FILLING = 0.1
"""Seconds that a round may spend on more repeats of fast experiments."""

Experiment = tuple[Method, int | None]
"""A method, and its number of samples."""


@dataclass(frozen=True, eq=False)
class Round:
    """A light, a number of bands, and the experiments that take turns: methods with one number of samples."""

    measured: MeasuredLight
    n_bands: int
    experiments: list[Experiment] = field(default_factory=list)


def plan(
    lights: Sequence[MeasuredLight], bands: Sequence[int], samples: Sequence[int], methods: Sequence[str] = ()
) -> list[Round]:
    """The rounds with every experiment, smallest first: by samples, then by bands, then light by light.

    To the bands, each light adds its own counts for the tolerances, with at most PAPER_SAMPLES samples. methods: names, to
    which BEST is added; empty for all.
    """
    chosen = [method for method in METHODS if not methods or method.name in (BEST, *methods)]
    rounds: dict[tuple[int, int, int], Round] = {}
    for number, measured in enumerate(lights):
        needed = {n for n in measured.needs.values() if n is not None}
        for n_bands in {*bands, *needed}:
            counts = samples if n_bands in bands else [n for n in samples if n <= PAPER_SAMPLES]
            counts = sorted({*counts, PAPER_SAMPLES}) if n_bands in needed else counts
            for method in chosen:
                if not method.applies(measured.light):
                    continue
                for count in counts if method.takes_samples else (None,):
                    place = _size(method, measured.light, count), n_bands, number
                    rounds.setdefault(place, Round(measured, n_bands)).experiments.append((method, count))
    return [rounds[place] for place in sorted(rounds)]


def _size(method: Method, light: Light, samples: int | None) -> int:
    """The number of points to sum. The paper's samples are in one round with the best way, for the main comparison."""
    if samples is None:
        return method.points(light)
    return 0 if (method.name, samples) == (PAPER, PAPER_SAMPLES) else samples


def measure(
    rounds: Sequence[Round],
    left: Callable[[], float],
    seed: int,
    add: Callable[[list[Row]], object],
    tell: Callable[[str], object],
    filling: float = FILLING,
) -> None:
    """Run the rounds while there is time; `add` gets the rows of each round, with those not measured, as soon as it is done.

    left: tells the seconds that are left. filling: seconds that a round may spend on repeats beyond AT_LEAST. An experiment
    is begun if it fits into the time left, estimated from the next smaller one of its method and light in proportion to the
    samples; if there is no smaller one, it is run once to know.
    """
    known: dict[tuple[str, Experiment, int], float] = {}
    for round_ in rounds:
        name, n_bands = round_.measured.name, round_.n_bands
        tell(f"{name}, {n_bands} bands")
        running: dict[Experiment, _Running] = {}
        reserved = 0.0
        for experiment in round_.experiments:
            if reserved + _expected(known, name, experiment, n_bands) >= left():
                continue
            cold = _cold(experiment, round_.measured.light, n_bands, seed)
            known[name, experiment, n_bands] = (AT_LEAST + 2) * cold / 1000
            rest = (AT_LEAST + 1) * cold / 1000
            if reserved + rest < left():
                running[experiment] = _warm(experiment, round_.measured.light, n_bands, seed, cold)
                reserved += rest
        if running:
            add(_measure_round(round_, running, max(0.0, min(filling, left() - reserved)), seed))
        skipped = [experiment for experiment in round_.experiments if experiment not in running]
        if skipped:
            add([not_measured(SECTION, method.name, name, n_bands, samples) for method, samples in skipped])


def _expected(
    known: dict[tuple[str, Experiment, int], float], light: str, experiment: Experiment, n_bands: int
) -> float:
    """The seconds that an experiment should take; 0 if nothing smaller has been run."""
    method, samples = experiment
    smaller = [
        seconds * ((samples or 1) / (count or 1))
        for (name, (other, count), bands), seconds in known.items()
        if name == light and other is method and (count or 0) <= (samples or 0) and bands <= n_bands
    ]
    return smaller[-1] if smaller else 0.0


@dataclass
class _Running:
    """One experiment while its round runs."""

    prepared: Prepared
    cold: float
    """Milliseconds of setting up and projecting once."""
    peak_mib: float
    found: list[Array] = field(default_factory=list)
    """Coefficients of the first repeats; of one repeat if nothing is random."""


def _measure_round(round_: Round, running: dict[Experiment, _Running], filling: float, seed: int) -> list[Row]:
    light, n_bands = round_.measured.light, round_.n_bands

    def before(experiment: Experiment, repeat: int) -> None:
        method, samples = experiment
        if method.random and 0 < repeat < SEEDS:
            running[experiment].prepared = method.prepare(light, samples or 0, seed + repeat, n_bands)

    def work(experiment: Experiment) -> Callable[[], object]:
        state, wanted = running[experiment], SEEDS if experiment[0].random else 1

        def run() -> None:
            coefficients = state.prepared.project()
            if len(state.found) < wanted:
                state.found.append(coefficients)

        return run

    timings = time_interleaved(
        {experiment: work(experiment) for experiment in running},
        budget=AT_LEAST / 1000 * sum(state.cold for state in running.values()) + filling,
        at_least=AT_LEAST,
        warm_up=False,
        before=before,
    )
    return [_row(round_, experiment, running[experiment], timing) for experiment, timing in timings.items()]


def _cold(experiment: Experiment, light: Light, n_bands: int, seed: int) -> float:
    """Milliseconds of one run with samples and tables made anew. It serves as the warm-up, too."""
    method, samples = experiment
    cold: list[float] = []
    while len(cold) < (SET_UPS if sum(cold) < SHORT else 1):
        forget_tables()
        start = perf_counter()
        prepared = method.prepare(light, samples or 0, seed, n_bands)
        making = 1000 * (perf_counter() - start)
        if method.name == BEST:
            making = 0.0  # nothing is made: a function's evaluations were counted
        cold.append(making + wall_milliseconds(prepared.project))
        del prepared
    return float(np.median(cold))


def _warm(experiment: Experiment, light: Light, n_bands: int, seed: int, cold: float) -> _Running:
    """Run once more, to measure the memory."""
    method, samples = experiment
    tracemalloc.start()
    try:
        prepared = method.prepare(light, samples or 0, seed, n_bands)
        tracemalloc.reset_peak()
        prepared.project()
        peak = tracemalloc.get_traced_memory()[1] / 2**20
    finally:
        tracemalloc.stop()
    return _Running(prepared, cold, peak)


def forget_tables() -> None:
    """Empty every table that harmonics/ remembers, so that setting up starts from nothing."""
    for name, module in list(sys.modules.items()):
        if name.startswith("shviewer.harmonics."):
            for value in list(vars(module).values()):
                if callable(getattr(value, "cache_clear", None)):
                    value.cache_clear()


class Errors(NamedTuple):
    """The relative errors of one projection: see Row."""

    error: float
    left_out: float
    total: float


def projection_errors(measured: MeasuredLight, coefficients: Array) -> Errors:
    """The errors of coefficients (n_bands**2, 3) against the light's own, by the metrics of the window."""
    norm, exact = measured.products.diagonal(), measured.exact[: len(coefficients)]
    left_out, added = squared_error(norm, exact, coefficients)
    return Errors(relative(added, (exact**2).sum(axis=0)), relative(left_out, norm), relative(left_out + added, norm))


def _row(round_: Round, experiment: Experiment, state: _Running, timing: Timing) -> Row:
    method, samples = experiment
    found = [projection_errors(round_.measured, coefficients) for coefficients in state.found]
    errors = [each.error for each in found]
    reference = method.name == BEST
    return Row(
        section=SECTION,
        light=round_.measured.name,
        method=method.name,
        n_bands=round_.n_bands,
        samples=samples,
        evaluations=state.prepared.evaluations,
        **timing._asdict(),
        set_up_milliseconds=max(0.0, state.cold - timing.milliseconds),
        error=None if reference else float(np.median(errors)),
        error_low=min(errors) if method.random else None,
        error_high=max(errors) if method.random else None,
        reference_accuracy=round_.measured.light.accuracy(),
        left_out=found[0].left_out,
        total_error=found[0].left_out if reference else float(np.median([each.total for each in found])),
        peak_mib=state.peak_mib,
        note=f"the reference: {round_.measured.light.best_method}" if reference else "",
    )
