"""python -m shviewer, and the command shviewer."""

import signal
import sys

if __name__ == "__main__" and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # nothing is begun during the next import: no traceback, just the end

from shviewer.ending import end_by_signals


def main() -> int:
    """Run the command line of this process. Signals are heard first: most of the time until a picture is that of imports."""
    end_by_signals()
    from shviewer.cli.main import main as run

    return run()


if __name__ == "__main__":
    sys.exit(main())
