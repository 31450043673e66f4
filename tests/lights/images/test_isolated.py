"""What shviewer.lights.images.isolated promises: whatever happens to the child, one line, and this process lives.

A child imports from the same path as this process. So a test breaks it by a module of its own in front of the path: an
`OpenEXR` that dies, or a `shviewer` that answers rubbish. This process has imported the real ones already.
"""

import json
import os
import sys
import threading
from pathlib import Path

import numpy as np
import pytest
from helpers import refusal
from lights.images.exr_files import luminance_chroma_exr
from lights.images.hdr_files import assert_same, bare_exr, exr_file, halves

from shviewer.errors import LightError
from shviewer.lights.images import isolated
from shviewer.lights.images.isolated import decode_isolated
from shviewer.lights.images.openexr import decode_openexr
from shviewer.limits import DEFAULT_LIMITS, Limits

PLANE = np.ones((4, 8), np.float32)
AP1 = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
GOOD = exr_file({"RGB": halves()})


@pytest.fixture
def child_library(tmp_path, monkeypatch):
    """Gives the child a library with this source."""

    def install(source):
        (tmp_path / "OpenEXR.py").write_text(source)
        monkeypatch.syspath_prepend(str(tmp_path))

    return install


@pytest.fixture
def child_answer(tmp_path, monkeypatch):
    """Gives the child another program: `answer()` with this body, in which `out` is its binary stdout."""

    def install(body):
        folder = tmp_path / "shviewer" / "lights" / "images"
        folder.mkdir(parents=True)
        for package in (folder, folder.parent, folder.parent.parent):
            (package / "__init__.py").touch()
        (folder / "isolated.py").write_text(f"import os, sys\nout = sys.stdout.buffer\ndef answer():\n    {body}\n")
        monkeypatch.syspath_prepend(str(tmp_path))

    return install


def refused(data=GOOD):
    return refusal(decode_isolated, data, DEFAULT_LIMITS)


@pytest.mark.parametrize(
    ("data", "layer"),
    [
        (GOOD, ""),
        (exr_file({"RGB": halves(300, 500)}, chromaticities=AP1), ""),  # more than a pipe holds
        (luminance_chroma_exr(PLANE, PLANE[::2, ::2], PLANE[::2, ::2]), ""),
        (exr_file({f"key.{c}": PLANE for c in "RGB"}), "key"),
        (exr_file({"RGB": halves(24, 4)}, envmap=1), ""),
        (exr_file({"Y": halves(130, 7)[..., 0].copy()}), ""),
        (exr_file({"R": PLANE, "G": PLANE.astype(np.float16), "B": PLANE.astype(np.float16)}), ""),
    ],
    ids=["plain", "converted", "luminance-chroma", "layer", "attribute", "grey", "mixed"],
)
def test_a_child_gives_the_pixels_and_notes_of_this_process(data, layer):
    here, there = decode_openexr(data, layer=layer), decode_isolated(data, layer=layer)
    assert_same(there.pixels, here.pixels)
    assert (there.encoding, there.notes, there.layout) == (here.encoding, here.notes, here.layout)


@pytest.mark.parametrize(
    ("data", "limits", "layer"),
    [
        (bare_exr(), DEFAULT_LIMITS, ""),
        (bare_exr(deep=True), DEFAULT_LIMITS, ""),
        (GOOD, Limits(side=7), ""),
        (GOOD, DEFAULT_LIMITS, "no\nsuch \N{SNOWMAN} \udcff"),
        (GOOD[:5] * 10**6, DEFAULT_LIMITS, ""),
    ],
    ids=["damaged", "deep", "too large", "no such layer", "five megabytes of nothing"],
)
def test_a_child_refuses_in_the_words_of_this_process(capfd, data, limits, layer):
    here = refusal(decode_openexr, data, limits, layer)
    assert refusal(decode_isolated, data, limits, layer) == here
    assert capfd.readouterr() == ("", "")


def test_an_infinite_value_survives_the_way():
    pixels = halves().astype(np.float32)
    pixels[0, 0] = (np.inf, -np.inf, np.nan)
    assert_same(decode_isolated(exr_file({"RGB": pixels})).pixels, pixels)


@pytest.mark.parametrize("name", ["SIGSEGV", "SIGABRT", "SIGKILL"])
@pytest.mark.skipif(os.name == "nt", reason="no signals")
def test_a_child_that_is_killed_is_one_line(child_library, capfd, name):
    child_library(f"import os, signal; os.kill(os.getpid(), signal.{name})")
    assert refused().startswith(f"decoding it crashed ({name}); the rest of the program is unharmed")
    assert capfd.readouterr() == ("", "")


def test_a_child_that_ends_is_one_line(child_library):
    child_library("import os; os._exit(7)")
    assert "gave no usable answer (exit status 7)" in refused()


def test_a_child_that_hangs_is_ended(child_library, monkeypatch, tmp_path):
    pid = tmp_path / "pid"
    child_library(f"import os, time; open({str(pid)!r}, 'w').write(str(os.getpid())); time.sleep(600)")
    for limit in (1.0, 8.0, 64.0):  # a busy machine takes long to get to where the child hangs
        monkeypatch.setattr(isolated, "TIME_LIMIT", limit)
        assert f"decoding it took more than {limit:g} s" in refused()
        if pid.exists() and pid.read_text():
            break
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid.read_text()), 0)


def test_a_child_that_takes_nothing_in_is_ended(child_answer, monkeypatch):
    monkeypatch.setattr(isolated, "TIME_LIMIT", 1.0)
    child_answer("import time; time.sleep(600)")
    assert "decoding it took more than 1 s" in refusal(
        decode_isolated, bytes(10**6), DEFAULT_LIMITS
    )  # more than a pipe holds


HEAD = {"height": 1, "width": 1, "encoding": "OpenEXR", "notes": [], "layout": None, "halves": False}


@pytest.mark.parametrize(
    "answer",
    [
        b"",
        b"rubbish\n",
        b"\xff\xfe\n",
        b"[" * 10**5 + b"\n",
        b"7" * 10**4 + b"\n",
        b"{}\n",
        b'{"height": 1, "width": 1}\n',
        json.dumps(HEAD).encode() + b"\n" + bytes(11),
        json.dumps({**HEAD, "height": -1}).encode() + b"\n",
        json.dumps({**HEAD, "height": 10**9, "width": 10**9}).encode() + b"\n",
        json.dumps({**HEAD, "width": 1.0}).encode() + b"\n" + bytes(12),
        json.dumps({**HEAD, "halves": True}).encode() + b"\n" + bytes(5),
        json.dumps({**HEAD, "halves": 1}).encode() + b"\n" + bytes(12),
        json.dumps({**HEAD, "layout": 3}).encode() + b"\n" + bytes(12),
    ],
    ids=lambda answer: ascii(answer[:40]),
)
def test_a_child_that_answers_rubbish_is_one_line(child_answer, tmp_path, answer):
    file = tmp_path / "answer"
    file.write_bytes(answer)
    child_answer(f"out.write(open({str(file)!r}, 'rb').read())")
    assert "gave no usable answer;" in refused()


def test_a_child_whose_first_line_does_not_end_is_stopped(child_answer):
    head = json.dumps(HEAD).encode() + b"\n" + bytes(12)
    child_answer(f"out.write(b' ' * 2**21 + {head!r}); out.flush(); import time; time.sleep(600)")
    assert "gave no usable answer;" in refused()


def test_a_child_that_has_answered_is_not_waited_for(child_answer, monkeypatch):
    head = json.dumps(HEAD).encode() + b"\n" + np.ones(3, np.float32).tobytes()
    child_answer(f"import time; out.write({head!r}); out.flush(); time.sleep(600)")
    stopped = []
    monkeypatch.setattr(isolated, "_stop", lambda child, late: (stopped.append(child), child.kill()))
    assert_same(decode_isolated(GOOD).pixels, np.ones((1, 1, 3)))
    assert not stopped  # it would be, after TIME_LIMIT


def test_a_programming_error_in_the_child_is_named(child_library):
    child_library(r"raise ZeroDivisionError('by\nzero')")
    assert r"decoding it failed (ZeroDivisionError: by\nzero);" in refused()


def test_a_child_without_memory_says_so_as_this_process_would(child_library):
    child_library("raise MemoryError")
    with pytest.raises(MemoryError):
        decode_isolated(GOOD)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="RLIMIT_AS and /proc are Linux's")
def test_the_memory_and_the_time_of_a_child_are_bounded(child_library):
    child_library(
        "import mmap, os, resource\n"
        "assert os.getsid(0) == os.getpid()\n"  # Ctrl+C in the terminal does not reach it
        "assert resource.getrlimit(resource.RLIMIT_CORE)[0] == 0\n"
        "assert resource.getrlimit(resource.RLIMIT_CPU)[0] >= 60\n"
        "mmap.mmap(-1, 2**29).close()\n"  # half of what it has besides the image
        "unreserved = getattr(mmap, 'MAP_NORESERVE', 0x4000)\n"
        "try: mmap.mmap(-1, 2**36, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | unreserved)\n"
        "except OSError: raise ImportError('bounded')\n"
    )
    assert "(bounded)" in refused()


def test_what_a_child_prints_goes_nowhere(child_library, capfd):
    child_library(
        "import os, sys; os.write(1, b'one'); os.write(2, b'two'); print('three'); sys.stdout.flush()\n"
        "raise ImportError('after printing')"
    )
    assert "(after printing)" in refused()
    assert capfd.readouterr() == ("", "")


def test_a_module_in_the_working_directory_is_not_imported(monkeypatch, tmp_path):
    for name in ("numpy", "json", "OpenEXR", "sitecustomize"):
        (tmp_path / f"{name}.py").write_text("import os; os._exit(9)")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [entry for entry in sys.path if entry and Path(entry) != tmp_path])
    assert_same(decode_isolated(GOOD).pixels, halves())


def test_without_a_new_process_the_reason_is_given(monkeypatch):
    monkeypatch.setattr(sys, "executable", "/no/such/python")
    assert refused().startswith("no process to decode it can be started (No such file or directory);")


def test_no_thread_and_no_file_is_left_behind(child_library):
    threads = threading.active_count()
    descriptors = set(os.listdir("/proc/self/fd")) if Path("/proc/self/fd").exists() else set()
    child_library("import os; os._exit(7)")
    refused()
    assert threading.active_count() == threads
    assert not descriptors or set(os.listdir("/proc/self/fd")) == descriptors


def test_the_door_decodes_openexr_files_in_a_child_when_asked(read, child_library):
    child_library("import os; os._exit(7)")
    assert_same(read(GOOD, "light.exr").pixels, halves())
    with pytest.raises(LightError, match=r"light\.exr: decoding it gave no usable answer"):
        read(GOOD, "light.exr", isolated=True)


def test_the_door_says_which_file_did_not_fit_in_the_memory_of_a_child(read, child_library):
    child_library("raise MemoryError")
    with pytest.raises(LightError, match=r"light\.exr: not enough memory"):
        read(GOOD, "light.exr", isolated=True)
