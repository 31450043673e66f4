"""Measuring projections: methods x samples x bands of every light, time against the error of the coefficients.

One group is a light with one number of bands; all its experiments take turns, so that their times can be compared. Random
methods draw new samples for each of the first SEEDS repeats, outside the clock, which gives time and spread in one go.
"""

from __future__ import annotations

import sys
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

from shviewer.benchmark import costs
from shviewer.benchmark.experiments import BEST, METHODS, PAPER, PAPER_SAMPLES, Method, Prepared
from shviewer.benchmark.measurement import Measurement, timed
from shviewer.benchmark.subjects import Subject
from shviewer.benchmark.timing import Timing, time_interleaved, wall_milliseconds
from shviewer.harmonics.basis import Array
from shviewer.harmonics.metrics import relative, squared_error
from shviewer.lights.light import Light
from shviewer.words import grouped

SECTION = "projection"
SEEDS = 5
AT_LEAST = 5
"""Repeats. Each experiment is run twice more: cold, and for its memory."""

RUNS = AT_LEAST + 2
SET_UPS, SHORT = 3, 50.0
"""Setting up is timed so often, if all but the last take less than so many milliseconds."""

FILLING = 1.0
"""Seconds that a group may spend on more repeats of what is fast."""

Experiment = tuple[Method, int | None]
Omission = tuple[Experiment, str, int]
"""What was left out, of which light, with how many bands."""

Measured = Callable[[list[Measurement]], object]
Tell = Callable[[float, str], object]
"""Told how much of the section is done, 0 to 1, and what comes next."""


@dataclass
class Group:
    """A light, a number of bands, and what is run: with the seconds that each experiment is expected to take in all."""

    subject: Subject
    n_bands: int
    seconds: dict[Experiment, float] = field(default_factory=dict)
    kept_last: frozenset[Experiment] = frozenset()
    """What an answer to "what to use" needs, left out only if nothing else is left."""

    def total(self) -> float:
        return sum(self.seconds.values()) + min(FILLING, 0.05 * len(self.seconds))


def plan(
    subjects: Sequence[Subject], bands: Sequence[int], samples: Sequence[int], methods: Sequence[str] = ()
) -> list[Group]:
    """Every experiment, each light with its own band counts for the tolerances added, there to PAPER_SAMPLES at most.

    methods: names, to which BEST is added; none for all.
    """
    chosen = [method for method in METHODS if not methods or method.name in (BEST, *methods)]
    groups = []
    for subject in subjects:
        evaluation = costs.evaluation_seconds(subject.light)
        needed = {n for n in subject.needs.values() if n is not None}
        for n_bands in sorted({*bands, *needed}):
            group = Group(subject, n_bands)
            counts = samples if n_bands in bands else [n for n in samples if n <= PAPER_SAMPLES]
            counts = sorted({*counts, PAPER_SAMPLES}) if n_bands in needed else counts
            for method in chosen:
                if not method.applies(subject.light):
                    continue
                for count in counts if method.takes_samples else (None,):
                    run = costs.run_seconds(method, subject.light, count, n_bands, evaluation)
                    making = costs.set_up_seconds(method, count) * (RUNS if method.random else 2)
                    group.seconds[method, count] = RUNS * run + making
            group.kept_last = frozenset(
                (method, count)
                for method, count in group.seconds
                if n_bands in needed and (method.name == BEST or (method.name == PAPER and count == PAPER_SAMPLES))
            )
            groups.append(group)
    return groups


def fit(groups: Sequence[Group], budget: float) -> list[Omission]:
    """Leave out the longest experiments until the rest fits `budget` seconds; returns what was left out.

    Repeats have been cut to AT_LEAST already: what remains of the budget is filled with more of them.
    """
    total = sum(group.total() for group in groups)
    everything = [
        (experiment in group.kept_last, -seconds, number, experiment)
        for number, group in enumerate(groups)
        for experiment, seconds in group.seconds.items()
    ]
    left_out = []
    for _, _, number, experiment in sorted(everything, key=lambda item: item[:3]):
        if total <= budget:
            break
        group = groups[number]
        before = group.total()
        del group.seconds[experiment]
        total += group.total() - before
        left_out.append((experiment, group.subject.name, group.n_bands))
    return left_out


def describe(left_out: Sequence[Omission]) -> list[str]:
    """A line per experiment: where it is missing."""
    bands: dict[str, dict[str, list[int]]] = {}
    for (method, samples), light, n_bands in left_out:
        words = method.words if samples is None else f"{method.words} {grouped(samples)}"
        bands.setdefault(words, {}).setdefault(light, []).append(n_bands)
    return [
        f"{words}: {'; '.join(f'{light}, {_listed(counts)} bands' for light, counts in sorted(lights.items()))}"
        for words, lights in bands.items()
    ]


def _listed(counts: Sequence[int]) -> str:
    return " ".join(map(str, sorted(counts)))


def measure(
    groups: Sequence[Group], budget: float, seed: int, measured: Measured, tell: Tell, filling: float = FILLING
) -> list[Omission]:
    """Run the groups; `measured` gets the rows of each as soon as they are there. Returns what was left out on the way.

    filling: seconds that a group may spend on repeats beyond AT_LEAST, where the budget has them. Where the machine is
    slower than the table, later groups are cut to what is left of the `budget`, in seconds.
    """
    start = perf_counter()
    left_out: list[Omission] = []
    planned = [group.total() for group in groups]
    for number, group in enumerate(groups):
        tell(sum(planned[:number]) / max(sum(planned), 1e-9), f"{group.subject.name}, {group.n_bands} bands")
        elapsed, done, to_do = perf_counter() - start, sum(planned[:number]), sum(planned[number:])
        allowed = max(0.0, budget - elapsed) * planned[number] / max(to_do, 1e-9)
        pace = max(0.25, elapsed / done) if done > 0.5 else 1.0
        if group.total() * pace > 1.3 * allowed:
            left_out += fit([group], allowed / pace)
        if group.seconds:
            spare = allowed - pace * sum(group.seconds.values())
            measured(_measure_group(group, min(filling, max(0.0, spare)), seed))
    tell(1.0, "")
    return left_out


@dataclass
class _Running:
    """One experiment while its group runs."""

    prepared: Prepared
    cold: float
    """Milliseconds of setting up and projecting once."""
    peak_mib: float
    found: list[Array] = field(default_factory=list)
    """Of the first repeats; one is enough where nothing is random."""


def _measure_group(group: Group, filling: float, seed: int) -> list[Measurement]:
    light, n_bands = group.subject.light, group.n_bands
    running = {experiment: _set_up(experiment, light, n_bands, seed) for experiment in group.seconds}

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
        budget=AT_LEAST / RUNS * sum(group.seconds.values()) + filling,
        at_least=AT_LEAST,
        warm_up=0,
        before=before,
    )
    return [_row(group, experiment, running[experiment], timing) for experiment, timing in timings.items()]


def _set_up(experiment: Experiment, light: Light, n_bands: int, seed: int) -> _Running:
    """Samples and tables made anew and timed, then once more, warm, for the memory. This is the warm-up, too."""
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
    tracemalloc.start()
    try:
        prepared = method.prepare(light, samples or 0, seed, n_bands)
        tracemalloc.reset_peak()
        prepared.project()
        peak = tracemalloc.get_traced_memory()[1] / 2**20
    finally:
        tracemalloc.stop()
    return _Running(prepared, float(np.median(cold)), peak)


def forget_tables() -> None:
    """Empty every table that harmonics/ remembers, so that setting up starts from nothing."""
    for name, module in list(sys.modules.items()):
        if name.startswith("shviewer.harmonics."):
            for value in list(vars(module).values()):
                if callable(getattr(value, "cache_clear", None)):
                    value.cache_clear()


@dataclass(frozen=True)
class Errors:
    """Of one projection, all relative: see Measurement."""

    error: float
    truncation: float
    total: float


def errors_of(subject: Subject, coefficients: Array) -> Errors:
    """Coefficients (n_bands**2, 3) against the light's own, by the metrics of the window."""
    norm, exact = subject.products.diagonal(), subject.exact[: len(coefficients)]
    left_out, added = squared_error(norm, exact, coefficients)
    return Errors(relative(added, (exact**2).sum(axis=0)), relative(left_out, norm), relative(left_out + added, norm))


def _row(group: Group, experiment: Experiment, state: _Running, timing: Timing) -> Measurement:
    method, samples = experiment
    found = [errors_of(group.subject, coefficients) for coefficients in state.found]
    errors = [each.error for each in found]
    reference = method.name == BEST
    return Measurement(
        section=SECTION,
        light=group.subject.name,
        method=method.name,
        n_bands=group.n_bands,
        samples=samples,
        evaluations=state.prepared.evaluations,
        **timed(timing),
        set_up_milliseconds=max(0.0, state.cold - timing.median),
        error=None if reference else float(np.median(errors)),
        error_low=min(errors) if method.random else None,
        error_high=max(errors) if method.random else None,
        reference_accuracy=group.subject.light.accuracy(),
        truncation=found[0].truncation,
        total_error=found[0].truncation if reference else float(np.median([each.total for each in found])),
        peak_mib=state.peak_mib,
        note=f"the reference: {group.subject.light.best_method}" if reference else "",
    )
