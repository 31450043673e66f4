"""python -m shviewer, and the command shviewer."""

import sys

from shviewer.ending import end_by_signals


def main() -> int:
    """Run the command line of this process. Signals are heard first: most of the time until a picture is that of imports."""
    end_by_signals()
    from shviewer.cli.main import main as run

    return run()


if __name__ == "__main__":
    sys.exit(main())
