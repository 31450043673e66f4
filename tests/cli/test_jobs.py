"""A batch in several processes: the same files, the same order, and a light that kills its process fails alone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest
from helpers import ended
from places import ENVIRONMENT

from shviewer.cli import jobs
from shviewer.cli.jobs import in_order
from shviewer.errors import LightError
from shviewer.limits import Limits

LIGHTS = """
import os, signal, time

def even(directions):
    return 1 + directions[:, 2] ** 2

def deadly(directions):
    os.kill(os.getpid(), signal.SIGKILL)

def slow(directions):
    time.sleep(600)

def late(directions):
    time.sleep(0.01)
    print("late")
    return even(directions)

def soon(directions):
    print("soon")
    return even(directions)
"""


def shviewer(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "shviewer", *arguments],
        cwd=folder,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "lights.py").write_text(LIGHTS)
    return tmp_path


def named(prefix: str, light: str) -> str:
    """Work that a new process can be given."""
    return f"{prefix} {light} {os.getpid()}"


def test_results_come_in_the_order_of_the_lights_from_other_processes() -> None:
    lights = [str(number) for number in range(9)]
    found = [str(result).split() for result in in_order(partial(named, "made"), lights, 2)]
    assert [words[1] for words in found] == lights
    assert str(os.getpid()) not in {words[2] for words in found}


def most_memory(light: str) -> int:
    return Limits().most_memory or 0


def test_processes_share_the_memory_that_a_file_may_take() -> None:
    """Two have half each; what is available changes by less than that meanwhile."""
    alone = most_memory("")
    assert all(isinstance(found, int) and found <= 0.7 * alone for found in in_order(most_memory, ["a", "b"], 2))


def test_a_batch_that_is_soon_done_starts_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jobs, "_most", lambda: 2)
    lights = ["a", "b", "c"]
    assert {str(result).split()[2] for result in in_order(partial(named, "made"), lights, None)} == {str(os.getpid())}
    monkeypatch.setattr(jobs, "PAYS", 0.0)
    first, *others = (str(result).split()[2] for result in in_order(partial(named, "made"), lights, None))
    assert first == str(os.getpid())
    assert str(os.getpid()) not in others


def test_files_and_summary_do_not_depend_on_the_number_of_processes(folder: Path) -> None:
    lights = ["green", "hemisphere", "gone.hdr", "lights.py:late", "studio", "lights.py:soon"]
    options = ("--tolerance", "5%", "--for", "irradiance")
    one, two = (shviewer(folder, "project", *lights, *options, "-o", name, "--jobs", name) for name in "12")
    assert one.returncode == two.returncode == 1
    assert one.stdout.replace("1/", "2/") == two.stdout
    assert one.stderr.count("bands within 5 %") == 5
    assert one.stderr == two.stderr
    files = sorted(path.name for path in (folder / "1").iterdir())
    assert len(files) == 5
    for name in files:
        assert (folder / "1" / name).read_bytes() == (folder / "2" / name).read_bytes()


def test_a_light_that_kills_its_process_fails_alone(folder: Path) -> None:
    done = shviewer(folder, "info", "green", "lights.py:deadly", "hemisphere", "constant", "--jobs", "2")
    assert done.returncode == LightError.exit_code
    assert done.stderr.splitlines()[-1].startswith(
        "shviewer: lights.py:deadly: the process that worked on it was killed"
    )
    assert [line.split(":")[0] for line in done.stdout.splitlines() if line[:1].strip()] == [
        "green",
        "hemisphere",
        "constant",
        "all 3 lights",
    ]


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="children are found through /proc")
@pytest.mark.parametrize(("name", "after"), [("TERM", 0.5), ("KILL", 0.5), ("INT", 0.5), ("INT", 0.0)])
def test_no_process_outlives_the_one_that_started_it(folder: Path, name: str, after: float) -> None:
    """INT goes to all of them, as Ctrl+C in a terminal sends it, and none but the first says or does anything about it.

    after: seconds since they were started; at once, they still import.
    """
    command = [sys.executable, "-m", "shviewer", "info", "lights.py:slow", "lights.py:slow", "--jobs", "2"]
    with (
        open(folder / "said", "w") as said,
        subprocess.Popen(
            command, cwd=folder, env=ENVIRONMENT, stderr=said, stdout=said, start_new_session=True
        ) as parent,
    ):
        children = Path(f"/proc/{parent.pid}/task/{parent.pid}/children")
        end = time.monotonic() + 60
        while len(children.read_text().split()) < 3 and time.monotonic() < end:  # the resource tracker and two workers
            time.sleep(0.05)
        started = [int(pid) for pid in children.read_text().split()]
        time.sleep(after)
        (os.killpg if name == "INT" else os.kill)(parent.pid, signal.Signals[f"SIG{name}"])
        parent.wait(60)
    assert len(started) >= 2
    assert all(ended(pid, 60) for pid in started)
    assert (folder / "said").read_text() == ""
