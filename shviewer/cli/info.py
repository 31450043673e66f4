"""`shviewer info LIGHT [LIGHT ...]`: lights in figures."""

from __future__ import annotations

import argparse
import json
import sys

from shviewer.analysis.information import as_json_object, as_text, describe
from shviewer.cli.from_options import reading_from
from shviewer.errors import LightError, ShviewerError


def run(options: argparse.Namespace) -> int:
    """Every light that can be read is described; the exit code is that of the first that cannot."""

    reading = reading_from(options)
    exit_code = 0
    objects: list[dict[str, object]] = []
    for number, text in enumerate(options.lights):
        refused: str | None = None
        try:
            found = describe(text, reading)
        except ShviewerError as error:
            refused, code = str(error), error.exit_code
            objects.append({"light_argument": text, "error": refused})
        else:
            refused, code = found.refused, LightError.exit_code
            objects.append(as_json_object(found))
            if not options.json:
                print(("\n" if number else "") + as_text(found), flush=True)
        if refused is not None:
            print(f"shviewer: {refused}", file=sys.stderr)
            exit_code = exit_code or code
    if options.json:
        print(json.dumps(objects, indent=2, allow_nan=False))
    return exit_code
