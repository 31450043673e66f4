"""Decodes an image file in a child process, so that a file that breaks the library does not break the window.

The libraries, OpenEXR and OpenImageIO, are C++ and read files of unknown origin. A child that crashes, runs out of memory,
hangs or answers rubbish becomes one LightError; the child's own errors come back word for word.

    to the child, stdin:     {"limits": ..., "layer": ..., "kind": ..., "folder": ..., "bytes": n} newline, the file's n bytes;
                             closed when the answer is there
    from the child, stdout:  {"height": ..., "width": ..., ...} or {"error": ...} newline, the pixels as float32, or as
                             float16 if those are all that the file has; few rows at a time, made of the file's planes

Nothing that the child says is executed, and sizes are checked against the limits before memory is taken.

Cost by tests/benchmarks/isolated.py on two shared cores: a file of 64 x 32 texels takes 80 to 140 ms more than in this
process (the start of Python and numpy); a file of 4096 x 2048 texels in half and ZIP takes 306 ms instead of 162 (the same
start, and 100 MB through a pipe).
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterable
from dataclasses import asdict
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from shviewer.children import watch_stdin
from shviewer.ending import at_the_end, temporary_folder
from shviewer.errors import LightError
from shviewer.lights.images.decoded import Decoded
from shviewer.lights.images.openexr import Planes, float32_of, read_openexr
from shviewer.limits import DEFAULT_LIMITS, Limits

OPENEXR = "OpenEXR"

TIME_LIMIT = 60.0
"""Seconds from the start of the child to the end of its answer."""

# The child imports what this process would, wherever it was started, and nothing from the folder of the file.
_CHILD = "import sys; sys.path[:] = sys.argv[1:]; from shviewer.lights.images.isolated import answer; answer()"
_ROWS = 64  # read at a time
_LONGEST_LINE = 2**20  # bytes of the first line of an answer
_BYTES_PER_TEXEL = 4 * 4 + 3 * 4 + 2 * 4  # RGBA from the library, the result, and chroma at full resolution
_COPIES_OF_FILE = 4
_HEADROOM = 2**30  # bytes for everything that is no image
_PER_THREAD = 2**27  # bytes of address space that a thread of the library reserves, its stack and its heap
_NEXT_STEP = "the rest of the program is unharmed: export the file again, or convert it to .hdr"


def decode_isolated(data: bytes, limits: Limits = DEFAULT_LIMITS, layer: str = "", kind: str = OPENEXR) -> Decoded:
    """Decode in a child process: the result of `decode_openexr` for the same arguments, or its LightError or MemoryError.

    kind: any other is decoded by `decode_openimageio`, whose temporary file is removed even if the child dies.
    Raises LightError, too, if the child ends without an answer, or has not answered after TIME_LIMIT.
    """
    request = {"limits": asdict(limits), "layer": layer, "kind": kind, "bytes": len(data)}
    file = [data]
    del data
    if kind == OPENEXR:
        return _decode(request, file, limits)
    with temporary_folder() as folder:
        return _decode(request | {"folder": str(folder)}, file, limits)


def _decode(request: dict[str, Any], file: list[bytes], limits: Limits) -> Decoded:
    """The answer of a child. file: its bytes, which are taken out and let go once the child has them."""
    with _start() as child, at_the_end(child.kill):
        assert child.stdin is not None
        assert child.stdout is not None
        late = threading.Event()
        clock = threading.Timer(TIME_LIMIT, _stop, (child, late))
        feeder = threading.Thread(target=_feed, args=(child.stdin, request, file))
        status = None
        try:
            clock.start()
            feeder.start()
            decoded = _read_answer(child.stdout, limits)
            if decoded is None:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    status = child.wait(1.0)  # tells how it ended, if it ended by itself
        except RuntimeError as error:  # of threads, where memory or their number is limited
            raise LightError(f"{error}; close something, or convert it to .hdr") from None
        finally:
            clock.cancel()
            child.kill()  # a child that has answered has nothing left to do
            for thread in (clock, feeder):
                if thread.ident is not None:
                    thread.join()
            with contextlib.suppress(OSError):  # what it did not read
                child.stdin.close()
    if decoded is None:
        how = f"took more than {TIME_LIMIT:g} s" if late.is_set() else _how_it_ended(status)
        raise LightError(f"decoding it {how}; {_NEXT_STEP}")
    return decoded


def _start() -> subprocess.Popen[bytes]:
    """Start the child in a session of its own: Ctrl+C in the terminal is for this process, which then ends the child."""
    path = [os.path.abspath(entry) for entry in sys.path]
    try:
        return subprocess.Popen(
            [sys.executable, "-c", _CHILD, *path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},  # each of its threads reserves address space
            start_new_session=True,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
    except OSError as error:
        raise LightError(
            f"no process to decode it can be started ({error.strerror}); close something, or convert it to .hdr"
        ) from None


def _stop(child: subprocess.Popen[bytes], late: threading.Event) -> None:
    late.set()
    child.kill()


def _feed(stdin: IO[bytes], request: dict[str, Any], file: list[bytes]) -> None:
    with contextlib.suppress(OSError):  # the child may end before it has read everything
        stdin.write(json.dumps(request).encode() + b"\n")
        stdin.write(file.pop())
        stdin.flush()  # and left open: a child whose stdin is closed ends itself, as when this process is killed


def _read_answer(stdout: IO[bytes], limits: Limits) -> Decoded | None:
    """The child's answer; None if it is cut short or makes no sense. Raises the LightError or MemoryError of the child."""
    try:
        answer = json.loads(stdout.readline(_LONGEST_LINE))
    except (ValueError, RecursionError):
        return None
    match answer:
        case {"error": str(message)}:
            raise LightError(message)
        case {"failure": str(message)}:
            raise LightError(f"decoding it failed ({ascii(message[:160])[1:-1]}); {_NEXT_STEP}")
        case {"memory": True}:
            raise MemoryError
        case {
            "height": int(height),
            "width": int(width),
            "encoding": str(encoding),
            "notes": [*notes],
            "layout": (str() | None) as layout,
            "halves": bool(halves),
        }:
            try:
                limits.check_size(width, height)
            except LightError:
                return None
            pixels = np.empty((height, width, 3), np.float32)
            if _read_halves(stdout, pixels) if halves else _read_into(stdout, pixels.data.cast("B")):
                return Decoded(pixels, encoding, tuple(map(str, notes)), layout)
    return None


def _read_into(stdout: IO[bytes], wanted: memoryview) -> bool:
    """Fill `wanted`; return whether there were enough bytes."""
    return stdout.readinto(wanted) == len(wanted)  # type: ignore[attr-defined, no-any-return]


def _read_halves(stdout: IO[bytes], pixels: NDArray[np.float32]) -> bool:
    """Fill the pixels with half floats; return whether there were enough bytes."""
    some = np.empty((_ROWS, *pixels.shape[1:]), np.float16)
    for top in range(0, len(pixels), _ROWS):
        rows = pixels[top : top + _ROWS]
        block = some[: len(rows)]
        if not _read_into(stdout, block.data.cast("B")):
            return False
        float32_of(block, rows)
    return True


def _how_it_ended(status: int | None) -> str:
    """How the child ended, in words. status: None for a child that had to be ended."""
    if status is not None and status < 0:
        with contextlib.suppress(ValueError):
            return f"crashed ({signal.Signals(-status).name})"
    return "gave no usable answer" + (f" (exit status {status})" if status else "")


def answer() -> None:
    """The child's side: one request from stdin, its answer to stdout; what the library prints goes nowhere."""
    with os.fdopen(os.dup(1), "wb") as out, open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        request = json.loads(sys.stdin.buffer.readline())
        data = sys.stdin.buffer.read(request["bytes"])
        watch_stdin()
        limits = Limits(**request["limits"])
        _bound_resources(limits, len(data))
        pixels: Iterable[NDArray[np.floating]] = ()
        head: dict[str, Any]
        try:
            head, pixels = _answered(data, limits, request)
        except LightError as error:
            head = {"error": str(error)}
        except MemoryError:
            head = {"memory": True}
        except Exception as error:
            head = {"failure": f"{type(error).__name__}: {error}"}
        del data  # before the other process takes memory for the pixels
        out.write(json.dumps(head).encode() + b"\n")
        for rows in pixels:
            out.write(rows.data.cast("B"))


def _answered(
    data: bytes, limits: Limits, request: dict[str, Any]
) -> tuple[dict[str, Any], Iterable[NDArray[np.floating]]]:
    """The first line of an answer, and the pixels in pieces."""
    decoded = _decoded(data, limits, request)
    if isinstance(decoded, Planes):
        window, layout, pixels = decoded.part.window, decoded.part.layout, decoded.rows()
        height, width = window.height, window.width
    else:
        layout, pixels = decoded.layout, iter([decoded.pixels])
        height, width = decoded.pixels.shape[:2]
    head = {"height": height, "width": width, "encoding": decoded.encoding, "notes": decoded.notes}
    return {**head, "layout": layout, "halves": isinstance(decoded, Planes) and decoded.halves}, pixels


def _decoded(data: bytes, limits: Limits, request: dict[str, Any]) -> Decoded | Planes:
    """The radiance; as planes, if nothing changes their values."""
    if request["kind"] == OPENEXR:
        planes = read_openexr(data, limits, request["layer"])
        return planes if planes.plain else planes.decoded()
    from shviewer.lights.images.others.openimageio import decode_openimageio

    tempfile.tempdir = request["folder"]
    return decode_openimageio(data, limits, request["kind"])


def _bound_resources(limits: Limits, file_bytes: int) -> None:
    """Limits the memory, the processor time and the core dump of this process, where the system can."""
    try:
        import resource
    except ImportError:  # Windows
        return
    threads = os.cpu_count() or 1
    image = limits.texels * _BYTES_PER_TEXEL + _COPIES_OF_FILE * file_bytes
    most_memory = limits.most_memory
    needed = (image if most_memory is None else min(image, most_memory)) + _HEADROOM + threads * _PER_THREAD
    for kind, most in (
        (resource.RLIMIT_AS, _address_space() + needed),
        (resource.RLIMIT_CPU, int(TIME_LIMIT) * threads),
        (resource.RLIMIT_CORE, 0),
    ):
        soft, hard = resource.getrlimit(kind)
        lowest = min([most, *(limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY)])
        with contextlib.suppress(ValueError, OSError):  # macOS takes no limit of the address space
            resource.setrlimit(kind, (lowest, hard))


def _address_space() -> int:
    """The bytes of address space that this process uses; 0 where the system does not tell."""
    try:
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError):
        return 0
