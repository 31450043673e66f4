"""Work that takes a while is spoken of on a terminal, and nowhere else."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from shviewer.cli import status_line
from shviewer.progress import tell


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(status_line, "QUIET", 0.01)
    monkeypatch.setattr(status_line, "BETWEEN", 0.01)


def work(capsys: pytest.CaptureFixture[str]) -> str:
    with status_line.speaking():
        tell("reading sky.exr", 0.4)
        time.sleep(0.2)
    return capsys.readouterr().err


def test_a_terminal_says_what_is_done_and_is_wiped(
    quick: None, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    said = work(capsys)
    assert "reading sky.exr 40 %" in said
    assert said.endswith("\r\033[K")


def test_a_log_says_nothing(quick: None, capsys: pytest.CaptureFixture[str]) -> None:
    assert work(capsys) == ""


def test_quick_work_is_not_spoken_of(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(status_line, "QUIET", 60)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert "reading" not in work(capsys)


WRITTEN = {
    "screenshot p.png green": "wrote p.png: 160 x 80, 5 bands",
    "screenshot p.exr green --for irradiance --encode l1": "wrote p.exr: 160 x 80, encoding l1",
}


@pytest.mark.skipif(os.name == "nt", reason="Windows has no pseudo-terminals of this kind")
@pytest.mark.parametrize("command", WRITTEN)
def test_what_was_written_is_said_on_a_terminal_and_stdout_stays_empty(tmp_path: Path, command: str) -> None:
    ours, theirs = os.openpty()
    run = [sys.executable, "-m", "shviewer", *command.split(), "--size", "160", "80"]
    done = subprocess.run(run, cwd=tmp_path, stderr=theirs, stdout=subprocess.PIPE, check=True, timeout=60)
    os.close(theirs)
    said = os.read(ours, 2**16).decode()
    os.close(ours)
    assert said.rstrip().endswith(f"shviewer: {WRITTEN[command]}")
    assert done.stdout == b""
