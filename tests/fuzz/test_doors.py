"""Whatever comes through any door but that of images: it is read or refused in one line, soon, and nothing else happens.

The number of inputs is that of SHVIEWER_FUZZ, 20 000 on CI, fewer elsewhere; `harness.py --doors --forever` goes on.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path

import doors
import harness
import numpy as np
import promise
import pytest
from door_seeds import REFUSED, seeds
from doors import DOORS, DoorWitness
from harness import FOUND, examine
from inputs import DoorMutations, Judge, verdict
from minimise import minimised
from test_fuzz import assert_none_broken

import shviewer
from shviewer.errors import LightError

COUNT = int(os.environ.get("SHVIEWER_FUZZ", 20_000 if os.environ.get("CI") else 3_000))
PARTS = 2  # one for each of two processors


@pytest.mark.parametrize("part", range(PARTS))
def test_inputs_of_every_door_are_read_or_refused(part: int, tmp_path: Path) -> None:
    inputs = DoorMutations(part, COUNT // PARTS)
    findings = examine(inputs)
    assert_none_broken(findings, inputs, tmp_path)
    assert findings.count == len(inputs)
    share = findings.accepted.total() / findings.count
    assert 0.1 < share < 0.5, "mutations that are all refused, or all accepted, test little"
    for outcomes in (findings.accepted, findings.refused):
        assert {name.partition("/")[0] for name in +outcomes} == set(DOORS)


@pytest.fixture(scope="module")
def witness() -> Judge:
    return DoorMutations(0).judge()


def test_what_once_broke_the_promise_does_so_no_more(witness: Judge) -> None:
    found = [path.relative_to(FOUND) for door in DOORS for path in sorted((FOUND / door).glob("*"))]
    verdicts = {str(path): verdict(witness, path.as_posix(), (FOUND / path).read_bytes()) for path in found}
    assert not {name: why for name, why in verdicts.items() if isinstance(why, str)}


def test_every_seed_is_read(witness: Judge) -> None:
    verdicts = {name: verdict(witness, name, data) for name, data in seeds().items()}
    assert not {name: said for name, said in verdicts.items() if said is not True and name not in REFUSED}


def test_a_mutation_is_a_function_of_seed_and_number() -> None:
    assert [DoorMutations(3)[number] for number in range(300)] == [DoorMutations(3, 7)[number] for number in range(300)]
    assert [DoorMutations(3)[number] for number in range(50)] != [DoorMutations(4)[number] for number in range(50)]


def test_one_input_is_replayed_by_the_command_that_the_harness_names(tmp_path: Path) -> None:
    """Outside pytest, which finds the helpers of other tests by itself."""
    command = [
        sys.executable,
        str(Path(harness.__file__)),
        "--doors",
        "--seed",
        "3",
        "--case",
        "41",
        "--into",
        str(tmp_path),
    ]
    environment = {**os.environ, "PYTHONPATH": str(Path(shviewer.__file__).parents[1])}
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True)
    name, data = DoorMutations(3)[41]
    kept = tmp_path / Path(name).with_name(f"3-41-{Path(name).name}")
    assert (done.returncode, kept.read_bytes()) == (0, data), done.stderr


def test_an_input_is_made_small() -> None:
    assert minimised(b"x" * 500 + b"ab" + b"y" * 300 + b"c", lambda data: b"ab" in data and b"c" in data) == b"abc"


# ------------------------------------------------------------------------------ the witness sees what it is there for


Door = Callable[[Path, bytes], object]


def judged(door: Door, monkeypatch: pytest.MonkeyPatch) -> bool | str:
    """What is said of a door that does this with a file."""

    def passed(path: Path, data: bytes) -> Iterator[object]:
        found = door(path, data)
        yield found if isinstance(found, str | list) else 0.0

    monkeypatch.setitem(doors.DOORS, "against", passed)
    return verdict(DoorWitness(), "against/report.json", b"{}")


def refuse(message: str) -> None:
    error = LightError("")
    error.args = (message,)  # past what makes every message safe
    raise error


def write(path: Path, data: bytes) -> None:
    path.with_name("beside").write_bytes(data)


def test_an_honest_door_is_cleared(monkeypatch: pytest.MonkeyPatch) -> None:
    assert judged(lambda path, data: path.read_bytes() and "read", monkeypatch) is True
    assert judged(lambda path, data: refuse(f"{path}: damaged"), monkeypatch) is False


@pytest.mark.parametrize(
    ("door", "why"),
    [
        (lambda path, data: 1 // 0, "ZeroDivisionError"),
        (lambda path, data: sys.exit(3), "SystemExit"),
        (lambda path, data: refuse("damaged"), "refused with 'damaged'"),
        (lambda path, data: refuse(f"{path}: \x1b[2J"), "refused with"),
        (lambda path, data: refuse(f"{path}: {'damaged ' * 200}"), "refused with"),
        (lambda path, data: "a light \x1b[2J", "says 'a light"),
        (lambda path, data: [1.0, np.nan], "not finite"),
        (lambda path, data: warnings.warn("careful", stacklevel=1), "warned UserWarning: careful"),
        (lambda path, data: print("hello"), "printed 'hello"),
        (lambda path, data: os.write(2, b"hello"), "printed b'hello'"),
        (write, "opens"),
        (lambda path, data: path.rename("other"), "os.rename"),
        (lambda path, data: subprocess.run(["true"]), "subprocess.Popen"),
        (lambda path, data: exec(compile("1", path.absolute(), "exec")), "runs code of"),
    ],
)
def test_a_door_that_misbehaves_is_reported(door: Door, why: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert why in str(judged(door, monkeypatch))


def test_a_slow_door_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    def slow(path: Path, data: bytes) -> float:
        until = time.process_time() + 0.1
        while time.process_time() < until:
            pass
        return 0.0

    assert judged(slow, monkeypatch) is True
    monkeypatch.setattr(promise, "MOST_SECONDS", 0.05)
    assert "took 0.1 s" in str(judged(slow, monkeypatch))
