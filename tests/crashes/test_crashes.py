"""Whatever happens while a file is written: it is the old one or the whole new one, and nothing stays beside it."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import moments
import pytest
from helpers import ended
from places import ENVIRONMENT

from shviewer import ending
from shviewer.children import LEASH, leash

pytestmark = pytest.mark.skipif(os.name != "posix", reason="processes, signals and limits as POSIX has them")

VICTIM = Path(__file__).with_name("victim.py")

DECODES_FOR_EVER = """
from shviewer.lights.images import isolated
isolated._CHILD = (
    "import sys; sys.path[:] = sys.argv[1:]; import os, time; from shviewer.lights.images import isolated;"
    "isolated.read_openexr = lambda *_: (os.mkdir(str(os.getpid())), time.sleep(600));"
    "isolated.answer()"
)
isolated.decode_isolated(b"any bytes")
"""


def test_a_file_that_fails_or_is_killed_at_any_step_is_old_or_new_and_never_torn(tmp_path: Path) -> None:
    """Four runs of every kind of output; `python tests/crashes/victim.py FOLDER` makes all 2000."""
    command = [sys.executable, str(VICTIM), str(tmp_path), "--some", "4"]
    done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=True)
    assert done.stdout == "56 runs\n"


@pytest.mark.parametrize("mode", ["screenshot", "project", "sweep", "report"])
def test_a_signal_at_any_moment_leaves_no_file_and_no_child(tmp_path: Path, mode: str) -> None:
    """One moment each, another one for each mode; `python tests/crashes/moments.py` sends many."""
    chance = random.Random(mode)
    sent = moments.send(mode, chance.choice(moments.SIGNALS[:3]), 0.4 * moments.MODES[mode][0], tmp_path)
    assert not sent.found
    assert sent.code in (0, 128 + sent.number, -sent.number)  # below zero: it came before the first line of ours


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_the_process_that_decodes_an_exr_dies_with_its_parent(tmp_path: Path, number: signal.Signals) -> None:
    with subprocess.Popen([sys.executable, "-c", DECODES_FOR_EVER], cwd=tmp_path, env=ENVIRONMENT) as parent:
        while not (names := os.listdir(tmp_path)):
            assert parent.poll() is None
            time.sleep(0.02)
        child = int(names[0])
        assert not ended(child, 0.1)
        parent.send_signal(number)
    assert ended(child)


def test_a_child_on_a_leash_ends_when_it_is_let_go() -> None:
    code = "from shviewer.children import follow_parent; follow_parent(); import time; time.sleep(600)"
    with leash(ENVIRONMENT) as (stdin, environment):
        child = subprocess.Popen([sys.executable, "-c", code], stdin=stdin, env=environment)
        assert environment[LEASH]
        assert child.poll() is None
    assert child.wait(10) == 1


def test_what_is_left_is_done_by_a_signal_too(tmp_path: Path) -> None:
    code = (
        "import os, signal, time\nfrom shviewer.ending import at_the_end, end_by_signals, temporary_folder\n"
        "end_by_signals()\n"
        "with at_the_end(lambda: open('done', 'w')), temporary_folder() as folder:\n"
        "    (folder / 'file').touch()\n    print(folder, flush=True)\n    time.sleep(600)\n"
    )
    command = [sys.executable, "-c", code]
    environment = {**ENVIRONMENT, "TMPDIR": str(tmp_path)}
    with subprocess.Popen(command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE) as child:
        assert child.stdout is not None
        folder = Path(child.stdout.readline().decode().strip())
        assert folder.is_dir()
        child.send_signal(signal.SIGHUP)
    assert child.returncode == 128 + signal.SIGHUP
    assert [path.name for path in tmp_path.iterdir()] == ["done"]


def test_an_error_of_what_is_left_does_not_hide_the_one_before() -> None:
    with pytest.raises(KeyboardInterrupt), ending.at_the_end(lambda: 1 // 0):
        raise KeyboardInterrupt
    with pytest.raises(ZeroDivisionError), ending.at_the_end(lambda: 1 // 0):
        pass


def test_signals_that_are_ignored_stay_ignored() -> None:
    """As nohup and shells ask it of background jobs."""
    code = (
        "import signal; signal.signal(signal.SIGHUP, signal.SIG_IGN)\nfrom shviewer.ending import end_by_signals\n"
        "end_by_signals(); print(signal.getsignal(signal.SIGHUP) == signal.SIG_IGN)"
    )
    done = subprocess.run([sys.executable, "-c", code], env=ENVIRONMENT, capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"
