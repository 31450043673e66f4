"""What the tests rely on: their processes, their signals, and what is made when."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from helpers import Lazily, hear_signals, unavailable

HEARS = "import signal; print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"


def test_a_program_started_by_a_background_job_hears_ctrl_c_and_the_job_does_not() -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        hear_signals()
        signal.raise_signal(signal.SIGINT)
        said = subprocess.run([sys.executable, "-c", HEARS], capture_output=True, text=True, check=True).stdout
    finally:
        signal.signal(signal.SIGINT, before)
    assert said == "True\n"


def test_in_the_foreground_ctrl_c_ends_the_tests() -> None:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        hear_signals()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize(
    ("named", "processors", "workers"),
    [((".",), 1, 0), ((".",), 2, 2), ((".",), 64, 4), ((__file__,), 64, 0), ((f"{__file__}::test",), 64, 0)],
)
def test_folders_are_spread_over_processors_and_what_is_named_runs_at_once(
    pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch, named: tuple[str, ...], processors: int, workers: int
) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: set(range(processors)), raising=False)
    chosen = pytestconfig.hook.pytest_xdist_auto_num_workers(config=SimpleNamespace(args=list(named)))
    assert chosen == workers


def test_what_is_not_here_is_skipped_and_fails_on_ci(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CI", raising=False)
    with pytest.raises(pytest.skip.Exception, match="no such thing"):
        unavailable("no such thing")
    monkeypatch.setenv("CI", "true")
    with pytest.raises(pytest.fail.Exception, match="no such thing"):
        unavailable("no such thing")


def test_lazily_made_values_are_made_once_and_only_those_asked_for() -> None:
    made: list[str] = []
    values = Lazily({name: lambda name=name: made.append(name) or len(made) for name in "abc"})
    assert (list(values), len(values), made) == (["a", "b", "c"], 3, [])
    assert (values["b"], values["b"], made) == (1, 1, ["b"])


def test_a_module_that_prepares_a_picture_while_it_is_imported_is_refused(tmp_path: Path) -> None:
    folder = Path(__file__).parent
    (tmp_path / "conftest.py").write_text((folder / "conftest.py").read_text())
    (tmp_path / "test_early.py").write_text("from helpers import picture_of\npicture_of()\n")
    path = os.pathsep.join(filter(None, [str(folder), os.environ.get("PYTHONPATH")]))
    command = [sys.executable, "-m", "pytest", "-q", "-n0", "-p", "no:cacheprovider", "test_early.py"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "a picture is prepared while the module is imported" in done.stdout
