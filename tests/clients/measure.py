"""Measure the programs anew, into measured.json, and then the guide's table: python tests/clients/measure.py"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from clients.drawing import Drawn, draw
from clients.known import PROGRAMS
from clients.measured import stated, write

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        draw(Path(folder))
        drawn = {name: Drawn(Path(folder), name) for name in PROGRAMS}
        for one in drawn.values():
            if one.failed:
                sys.exit(f"{one.name}: {one.failed}")
        write({name: stated(one) for name, one in drawn.items()})
