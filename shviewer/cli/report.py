"""`shviewer report [LIGHT ...]`: speed against error on this machine, and the hard cases."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from shviewer.cli.options.inputs import reading_from
from shviewer.cli.status_line import status_line


def run(options: argparse.Namespace) -> int:
    given = vars(options)
    if options.stability and not any(given[name] for name in ("lights", "output", "quick", "peers", "against")):
        return _hard_cases(options)
    from shviewer.benchmark.options import Options
    from shviewer.benchmark.run import write_report

    alike = ("budget", "quick", "against", "stability", "peers", "moving", "seed", "force")
    wanted = Options(
        **{name: given[name] for name in alike},
        methods=tuple(options.methods.split(",")) if options.methods else (),
        reading=reading_from(options),
        shader=not options.no_shader,
    )
    with status_line() as line:
        folder = options.output or Path("shviewer-report")
        summary = write_report(options.lights, folder, wanted, progress=line.fraction if line else None)
    print(summary.text)
    print(f"wrote {summary.rows} rows: {', '.join(str(summary.folder / name) for name in summary.files)}")
    if summary.warning:
        print(f"shviewer: {summary.warning}", file=sys.stderr)
    return 1 if summary.stability_failed else 0


def _hard_cases(options: argparse.Namespace) -> int:
    from shviewer.benchmark.hard_cases import table

    with status_line() as line:
        outcomes = table.run(progress=line.show if line else None, shader=not options.no_shader)
    print(table.as_text(outcomes), end="")
    return 0 if all(outcome.passed for outcome in outcomes) else 1
