"""The command line. Each mode is imported in its own branch: --help and --version load neither numpy nor OpenGL.

numpy's matrix products get one thread, unless the environment says otherwise: they are too small here for more, and threads
that wait for each other on a busy machine take ten times as long.
"""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Sequence
from importlib import import_module

from shviewer.children import follow_parent
from shviewer.cli.options.modes import MODES, PARSERS
from shviewer.errors import OutputError, ShviewerError, UsageError, within_memory
from shviewer.words import near

THREADS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code. argparse itself exits with 2 on arguments it cannot read."""
    follow_parent()
    for name in THREADS:
        os.environ.setdefault(name, "1")
    arguments = list(sys.argv[1:] if argv is None else argv)
    try:
        if arguments[:1] == ["help"]:
            return int(import_module("shviewer.cli.help").run(arguments[1:]))
        _check_first(arguments)
        arguments = _with_names(arguments)
        mode, rest = (arguments[0], arguments[1:]) if arguments[:1] and arguments[0] in MODES else ("view", arguments)
        options = PARSERS[mode]().parse_intermixed_args(rest)
        import_module("shviewer.memory").keep_freed()
        with within_memory():
            code: int = import_module(f"shviewer.cli.{mode}").run(options)
        if sys.stdout is not None:
            sys.stdout.flush()  # here, where a full disk can still be said
        return code
    except ShviewerError as error:
        print(f"shviewer: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # the reader has stopped, as in `shviewer --list-lights | head -1`
        _silence_stdout()
        return 0
    except OSError as error:
        if error.filename is not None or error.errno not in STDOUT_FAILS:
            raise
        _silence_stdout()
        print(f"shviewer: stdout cannot be written: {error.strerror}; send it elsewhere", file=sys.stderr)
        return OutputError.exit_code


STDOUT_FAILS = (errno.ENOSPC, errno.EIO, errno.EFBIG)
"""What a full or broken place behind stdout says; any other OSError without a file name is a fault of this program."""


def _silence_stdout() -> None:
    """Point stdout nowhere, so that what it still holds troubles nobody at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _with_names(arguments: list[str]) -> list[str]:
    """The arguments, those after -- as names even if they begin with -. UsageError for another that names a file so."""
    at = arguments.index("--") if "--" in arguments else len(arguments)
    for text in arguments[:at]:
        if len(text) > 2 and text[0] == "-" != text[1] and os.path.exists(text):
            raise UsageError(f"{text}: a name that begins like an option; write ./{text}")
    return arguments[:at] + [f"./{text}" if text.startswith("-") else text for text in arguments[at + 1 :]]


def _check_first(arguments: list[str]) -> None:
    """UsageError if the first argument is nearly the name of a mode, and no file."""
    first = arguments[0] if arguments else ""
    unknown = first and not first.startswith("-") and first not in MODES and not os.path.exists(first)
    if unknown and (found := near(first, [*MODES, "help"], most=1)):
        raise UsageError(f"{first!r} is neither a mode nor a light; did you mean shviewer {found[0]}?")
