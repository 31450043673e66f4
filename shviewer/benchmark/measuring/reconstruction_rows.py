"""The cost of a band where the sum is evaluated, against its use: in the shader, from a map, and on the CPU.

Each time has two errors beside it: what the bands left out leave, and the arithmetic error of the evaluation.
Both are relative to the norm of the light and so can be compared: where they meet, more bands are of no use.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import nullcontext
from time import perf_counter

import numpy as np

from shviewer.benchmark.measuring.evaluations import (
    CACHED,
    CPU,
    DIRECT,
    FRAME,
    MAKING,
    MAP_32,
    MAP_64,
    MAP_SIZE,
    PER_FRAME,
    PER_MILLION,
    Evaluations,
    ShaderFrame,
    shader_methods,
)
from shviewer.benchmark.measuring.measured_lights import MeasuredLight
from shviewer.benchmark.measuring.timing import Timing, Work, time_interleaved, wall_milliseconds
from shviewer.benchmark.rows.row import Row, not_measured
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.screenshot import offscreen

SECTION = "reconstruction"
BANDS = (1, 2, 3, 5, 9, 16, 32, 64)
Name = tuple[str, int]


def reconstruction_rows(
    measured: MeasuredLight,
    drawing: Renderer | str,
    *,
    budget: float,
    at_most: float = math.inf,
    bands: Sequence[int] = BANDS,
    at_least: int = 3,
) -> list[Row]:
    """Rows of every evaluation of the light at every band count. LightError if it is too dim or too bright to be drawn.

    drawing: a renderer, or why nothing can be drawn, and then its rows are absent. budget: seconds for all timings, exceeded
    only to reach `at_least` runs of each; the errors, which warm everything up, take a few seconds more. at_most: seconds for
    everything. Band counts come smallest first; a count is not measured if the time of the one before does not fit into the
    rest.
    """
    begun = perf_counter()
    stages: dict[int, Evaluations] = {}
    errors: dict[Name, float | None] = {}
    works: dict[Name, Work] = {}
    turn = step = step_turn = 0.0  # seconds: of one run of every work; of the last band count, alone and of its works
    with nullcontext() if isinstance(drawing, str) else offscreen(drawing, FRAME) as target:
        frame = None if isinstance(drawing, str) or target is None else ShaderFrame(drawing, target)

        def before(name: Name, repeat: int) -> None:
            if frame is not None:
                frame.be_ready_for(name[0], stages[name[1]])

        for n_bands in sorted(bands):
            start = perf_counter()
            if start - begun + step + at_least * (turn + step_turn) >= at_most:
                break
            stage = stages[n_bands] = Evaluations(measured, n_bands)
            errors |= {(method, n_bands): error for method, error in stage.errors().items()}
            own = stage.works()
            if frame is not None:
                errors |= {(method, n_bands): error for method, error in frame.errors(stage).items()}
                own |= frame.works(stage)
            works |= {(method, n_bands): work for method, work in own.items()}
            step_turn = 0.0
            for method, work in own.items():
                before((method, n_bands), -1)
                step_turn += wall_milliseconds(work) / 1000
            turn += step_turn
            step = perf_counter() - start
        times = time_interleaved(works, budget=budget, at_least=at_least, warm_up=False, before=before)
    missing = [
        not_measured(SECTION, method, measured.name, n_bands)
        for n_bands in sorted(set(bands) - set(stages))
        for method in (*CPU, *(() if isinstance(drawing, str) else shader_methods(n_bands)))
    ]
    in_order = sorted(errors.items(), key=lambda item: item[0][1])
    return [_row(stages[n_bands], method, error, times) for (method, n_bands), error in in_order] + missing


def _row(stage: Evaluations, method: str, arithmetic_error: float | None, times: dict[Name, Timing]) -> Row:
    """The row of a method. A time on the CPU is scaled to a million directions."""
    drawn, timing = method in (DIRECT, CACHED), times[method, stage.n_bands]
    directions = MAP_SIZE[0] * MAP_SIZE[1] if method in (MAP_64, MAP_32) else len(stage.directions)
    scale = 1.0 if drawn else 1e6 / directions
    return Row(
        section=SECTION,
        method=method,
        light=stage.light_name,
        n_bands=stage.n_bands,
        milliseconds=timing.milliseconds * scale,
        low_quartile=timing.low_quartile * scale,
        high_quartile=timing.high_quartile * scale,
        repeats=timing.repeats,
        set_up_milliseconds=times[MAKING, stage.n_bands].milliseconds if method == CACHED else None,
        left_out=stage.left_out,
        arithmetic_error=arithmetic_error,
        total_error=float(np.hypot(stage.left_out, arithmetic_error or 0.0)),
        note=PER_FRAME if drawn else PER_MILLION,
    )
