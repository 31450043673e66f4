"""What is written is whole, and destroys neither what is read nor what somebody else made."""

from __future__ import annotations

import io
import os
import stat
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from places import ENVIRONMENT

import shviewer
from shviewer.benchmark import run as run_of_report
from shviewer.benchmark.options import Options
from shviewer.benchmark.page import plots
from shviewer.benchmark.page.writing import FILES
from shviewer.benchmark.run import write_report
from shviewer.cli.main import main
from shviewer.errors import LightError, OutputError
from shviewer.outputs import Replacing, write_atomically

POSIX = pytest.mark.skipif(os.name != "posix", reason="modes, links and pipes as POSIX has them")


def run(command: list[str]) -> int:
    """The exit code of a command in a process of its own, which leaves the OpenGL context of other tests alone."""
    return subprocess.run([sys.executable, "-m", "shviewer", *command], env=ENVIRONMENT, capture_output=True).returncode


# --- what is read is not written


@pytest.fixture
def nine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "nine.json"
    shviewer.project("green", 3).save(path)
    return path


@pytest.mark.parametrize("through", ["nine.json", "link.json", "."])
def test_project_does_not_write_into_the_file_that_it_reads(nine: Path, through: str) -> None:
    before = nine.read_bytes()
    (nine.parent / "link.json").symlink_to(nine)
    assert main(["project", "nine.json", "--bands", "1", "-o", through, "--format", "json"]) == OutputError.exit_code
    assert nine.read_bytes() == before


def test_a_batch_does_not_write_into_a_light_that_comes_later(nine: Path) -> None:
    """hemisphere.json, read as the second light, is where the first one would be written."""
    (nine.parent / "hemisphere.json").write_bytes(before := nine.read_bytes())
    assert main(["project", "hemisphere", "hemisphere.json", "--bands", "1", "-o", "."]) == 1
    assert (nine.parent / "hemisphere.json").read_bytes() == before


def test_the_inputs_of_a_batch_are_looked_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A thousand lights took half as long again when each output was compared with every input."""
    looks, look = 0, os.stat

    def counted(*arguments: Any, **options: Any) -> os.stat_result:
        nonlocal looks
        looks += 1
        return look(*arguments, **options)

    replacing = Replacing(tuple(tmp_path / f"{number}.toml" for number in range(200)))
    monkeypatch.setattr(os, "stat", counted)
    for number in range(200):
        replacing.check(tmp_path / f"{number}.json")
    assert looks < 200 * 5


@pytest.mark.parametrize("force", [[], ["--force"]])
def test_a_picture_is_not_written_over_what_it_is_made_of(nine: Path, force: list[str]) -> None:
    before = nine.read_bytes()
    (nine.parent / "link.png").symlink_to(nine)
    assert main(["screenshot", "link.png", "--compare", "nine.json", *force]) == OutputError.exit_code
    assert nine.read_bytes() == before
    (nine.parent / "sky.png").write_bytes(b"anything")
    (nine.parent / "r-difference.png").write_bytes(b"anything")
    assert main(["screenshot", "sky.png", "sky.png", *force]) == OutputError.exit_code
    assert main(["screenshot", "r.png", "--reference", "r-difference.png", *force]) == OutputError.exit_code
    assert (nine.parent / "sky.png").read_bytes() == (nine.parent / "r-difference.png").read_bytes() == b"anything"


@pytest.mark.parametrize(
    "name", ["a.png", "a.exr", "a.json", "a.csv", "a.npz", "a.h", "a.glsl", "a.hlsl", "a.js", "a.cs", "a.gif", "a.webp"]
)
def test_a_file_of_somebody_else_is_replaced_only_by_force_and_one_of_ours_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    kind = Path(name).suffix
    small = ["--size", "320", "240"]
    command = {
        ".png": ["screenshot", name, *small],
        ".exr": ["screenshot", name, *small],
        ".gif": ["sweep", name, "--to", "2", *small],
        ".webp": ["sweep", name, "--to", "2", *small],
    }.get(kind, ["project", "green", "-o", name])
    Path(name).write_bytes(b"somebody else's work")
    assert run(command) == OutputError.exit_code
    assert Path(name).read_bytes() == b"somebody else's work"
    assert run([*command, "--force"]) == 0
    assert run(command) == 0


# --- links, modes and special files


@POSIX
def test_a_link_is_followed_and_its_target_keeps_its_mode(tmp_path: Path) -> None:
    target, link = tmp_path / "private.json", tmp_path / "link.json"
    target.write_bytes(b"old")
    target.chmod(0o640)
    link.symlink_to(target)
    write_atomically(link, b"new")
    assert link.is_symlink()
    assert target.read_bytes() == b"new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


@POSIX
def test_the_owner_stays_and_nobody_else_reads_what_is_not_yet_in_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "shared.json"
    path.write_bytes(b"old")
    owner = path.stat().st_uid, path.stat().st_gid
    modes: list[int] = []
    owners: list[tuple[int, int]] = []
    monkeypatch.setattr(os, "fsync", lambda number: modes.append(stat.S_IMODE(os.fstat(number).st_mode)))
    monkeypatch.setattr(os, "chown", lambda path, *ids: owners.append(ids))
    write_atomically(path, b"new")
    assert modes == [0o600]
    assert owners == [owner]


@POSIX
def test_a_read_only_file_is_kept_even_from_root(tmp_path: Path) -> None:
    path = tmp_path / "kept.json"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(OutputError, match="read-only"):
        write_atomically(path, b"new")
    assert path.read_bytes() == b"old"


@POSIX
def test_a_pipe_is_written_through_and_stays_a_pipe(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.json"
    os.mkfifo(pipe)
    with ThreadPoolExecutor(1) as pool:
        read = pool.submit(pipe.read_bytes)
        write_atomically(pipe, b"through")
        assert read.result(timeout=10) == b"through"
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert list(tmp_path.iterdir()) == [pipe]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_full_device_is_one_line(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(OutputError, match="No space left"):
        write_atomically(Path("/dev/full"), b"anything")
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode)
    with open("/dev/full", "wb") as full:
        command = [sys.executable, "-m", "shviewer", "--list-lights"]
        done = subprocess.run(command, env=ENVIRONMENT, stdout=full, stderr=subprocess.PIPE)
    assert done.returncode == OutputError.exit_code
    assert done.stderr.decode().startswith("shviewer: stdout cannot be written: No space left")
    assert done.stderr.count(b"\n") == 1


@POSIX
def test_stdout_can_be_named_as_a_file(tmp_path: Path) -> None:
    """Its path leads to a pipe, for which there is no folder."""
    command = [sys.executable, "-m", "shviewer", "project", "-o", "/dev/stdout", "--format", "npz"]
    done = subprocess.run(command, cwd=tmp_path, env=ENVIRONMENT, stdout=subprocess.PIPE, check=True)
    assert np.load(io.BytesIO(done.stdout.partition(b"wrote ")[0]))["coefficients"].shape == (25, 3)
    assert not list(tmp_path.iterdir())


@POSIX
def test_the_stamp_of_a_pipe_is_neither_waited_for_nor_taken_out_of_it(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.json"
    os.mkfifo(pipe)
    Replacing().check(pipe)
    held = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
    os.write(held, b"for somebody else")
    Replacing().check(pipe)
    assert os.read(held, 100) == b"for somebody else"
    os.close(held)


def test_a_new_file_is_whole_where_there_are_no_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def link(*paths: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "link", link)
    path = tmp_path / "new.png"
    write_atomically(path, b"whole", exclusive=True)
    with pytest.raises(FileExistsError):
        write_atomically(path, b"other", exclusive=True)
    monkeypatch.setattr(os, "replace", link)
    with pytest.raises(OutputError):
        write_atomically(tmp_path / "other.png", b"other", exclusive=True)
    assert path.read_bytes() == b"whole"
    assert list(tmp_path.iterdir()) == [path]


@POSIX
def test_a_new_file_has_the_mode_that_the_user_asks_for(tmp_path: Path) -> None:
    """And no other thread loses its own on the way, as when the mask is asked for by setting it."""
    before = os.umask(0o027)
    try:
        write_atomically(tmp_path / "new.json", b"new")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "new.json").stat().st_mode) == 0o640


# --- from Python, and a report


def test_saving_never_replaces_an_input_and_a_file_of_somebody_else_only_by_force(nine: Path) -> None:
    before = nine.read_bytes()
    (nine.parent / "link.json").symlink_to(nine)
    asked = [
        shviewer.project("nine.json", 1),
        shviewer.project(shviewer.find_light(nine), 1),
        shviewer.project(shviewer.find_light(nine), 1, quantity="irradiance"),
        shviewer.project("green", 1, compare="nine.json"),
    ]
    for projected in asked:
        for name in ("nine.json", "link.json"):
            with pytest.raises(OutputError, match="read from this file"):
                projected.save(name, force=True)
    assert nine.read_bytes() == before
    Path("a.json").write_text("[somebody else's work]")
    with pytest.raises(OutputError, match="force=True"):
        asked[0].save("a.json")
    assert Path("a.json").read_text() == "[somebody else's work]"
    asked[0].save("a.json", force=True)
    asked[0].save("a.json")


LITTLE = Options(quick=True, sections=(), shader=False, command="shviewer report")


@pytest.mark.parametrize("name", [*FILES, "time-error-green.svg", "frame-time.png"])
def test_a_report_replaces_a_file_of_somebody_else_only_by_force_and_its_own_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    """Before anything is measured: what is replaced is known then."""
    monkeypatch.setattr(
        plots, "plots_of", lambda report: dict.fromkeys(("time-error-green", "frame-time"), lambda _: None)
    )
    monkeypatch.setattr(plots, "INCHES", (1, 1))
    path = tmp_path / name
    path.write_bytes(b"somebody else's work")
    with monkeypatch.context() as patch:
        patch.setattr(run_of_report, "_measure_sections", lambda run: 1 // 0)
        with pytest.raises(OutputError, match=f"{name}: exists, and shviewer did not"):
            write_report(["green"], tmp_path, LITTLE)
    assert path.read_bytes() == b"somebody else's work"
    write_report(["green"], tmp_path, replace(LITTLE, force=True))
    assert path.stat().st_size > 100
    write_report(["green"], tmp_path, LITTLE)


def test_a_report_never_replaces_the_one_that_it_is_compared_with_or_its_light(tmp_path: Path) -> None:
    write_report(["green"], tmp_path, LITTLE)
    before = (tmp_path / "report.json").read_bytes()
    with pytest.raises(OutputError, match="is read from this file"):
        write_report(["green"], tmp_path, replace(LITTLE, against=tmp_path / "report.json", force=True))
    with pytest.raises(LightError):
        write_report([str(tmp_path / "report.json")], tmp_path, replace(LITTLE, force=True))
    assert (tmp_path / "report.json").read_bytes() == before


# --- names that count on


def test_without_a_display_a_second_picture_takes_the_next_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for variable in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delitem(ENVIRONMENT, variable, raising=False)
    assert run(["green"]) == run(["green"]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["shviewer-green-001.png", "shviewer-green.png"]
