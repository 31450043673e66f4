"""`shviewer help`, and what shells and man are told: the pages of the guide, modes, options and their words."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from io import BytesIO, TextIOWrapper
from pathlib import Path

import pytest
from documents import PAGES, read
from shell_files import shell_files

from shviewer.cli.help import guide_pages
from shviewer.cli.main import main
from shviewer.cli.options.completion import completion
from shviewer.cli.options.modes import MODES, PARSERS
from shviewer.lights.find import built_in_lights


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_every_page_of_the_guide_is_a_topic(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    topic = "guide" if path.stem == "README" else path.stem
    assert main(["help", topic]) == 0
    assert capsys.readouterr().out == read(path)


@pytest.mark.parametrize("mode", [mode for mode in MODES if mode not in guide_pages()])
def test_help_on_a_mode_is_its_help(mode: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help", mode]) == 0
    assert capsys.readouterr().out == PARSERS[mode]().format_help()


def test_help_alone_shows_the_options_and_the_topics(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["help"]) == 0
    text = capsys.readouterr().out
    assert text.startswith(PARSERS["view"]().format_help())
    assert text.splitlines()[-1].startswith("topics of shviewer help: guide, bands,")


def test_a_page_is_paged_on_a_terminal(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    paged: list[str] = []
    monkeypatch.setattr("pydoc.pager", paged.append)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True, raising=False)
    assert main(["help", "bands"]) == 0
    assert paged == [read(next(path for path in PAGES if path.stem == "bands"))]
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("topics", "hint"),
    [
        (["qqq"], ""),
        (["bands", "lights"], "did you mean shviewer help bands?; "),
        (["band"], "did you mean shviewer help bands?; "),
        (["Godot"], "it is spoken of in command-line, programs; "),
    ],
)
def test_a_topic_that_is_none_is_answered_by_those_there_are(
    topics: list[str], hint: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["help", *topics]) == 2
    told = capsys.readouterr().err
    assert told.startswith(f"shviewer: no help on {' '.join(topics)!r}; {hint}topics of shviewer help: guide, ")
    assert told.count("\n") == 1


@pytest.mark.parametrize("path", shell_files(), ids=lambda path: path.name)
def test_what_the_wheel_gives_to_shells_and_man_is_that_of_the_options_of_today(path: Path) -> None:
    assert read(path) == shell_files()[path], "python tests/guide.py writes them"


def completed(*words: str) -> list[str]:
    """What bash offers for the last of the words."""
    bash = shutil.which("bash")
    if bash is None:
        pytest.skip("no bash")
    line = " ".join(f"'{word}'" for word in ("shviewer", *words))
    asked = f'COMP_WORDS=({line}); COMP_CWORD={len(words)}; _shviewer; printf "%s\\n" "${{COMPREPLY[@]}}"'
    script = completion("bash") + asked
    return subprocess.run([bash, "-c", script], capture_output=True, text=True, check=True).stdout.split()


def test_bash_completes_modes_lights_files_options_and_their_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "venice.exr").touch()
    assert set(completed("")) >= {*MODES, "help", *built_in_lights(), "venice.exr"}
    assert completed("screenshot", "a.png", "ven") == ["venice_sunset", "venice.exr"]
    assert completed("sweep", "--turnt") == ["--turntable"]
    assert completed("info", "--turnt") == []
    assert completed("--tone", "a") == ["aces"]
    assert "three" in completed("project", "--convention", "")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_shell_reads_its_completion(shell: str, tmp_path: Path) -> None:
    program = shutil.which(shell)
    if program is None:
        pytest.skip(f"no {shell}")
    script = tmp_path / "script"
    script.write_text(completion(shell), encoding="utf-8")
    environment = {"HOME": str(tmp_path), "PATH": os.environ["PATH"]}
    done = subprocess.run([program, "-n", script], env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def options_of(mode: str) -> set[str]:
    return {name for action in PARSERS[mode]()._actions for name in action.option_strings}


@pytest.mark.parametrize("mode", PARSERS)
def test_bash_and_zsh_have_the_options_of_a_mode_and_no_others(mode: str) -> None:
    assert set(completed(*([] if mode == "view" else [mode]), "-")) == options_of(mode)
    block = re.search(rf"^    {mode}\) options=\(\n(.*?)^    \) ;;", completion("zsh"), re.MULTILINE | re.DOTALL)
    assert block is not None
    names = [re.match(r"\s+\{?'?([^'\[}]+)", line) for line in block[1].splitlines()]
    assert {name for found in names if found for name in found[1].split(",")} == options_of(mode)


def test_fish_offers_what_belongs_to_a_mode(tmp_path: Path) -> None:
    fish = shutil.which("fish")
    if fish is None:
        pytest.skip("no fish")
    (tmp_path / "script").write_text(completion("fish"), encoding="utf-8")
    environment = {"HOME": str(tmp_path), "PATH": os.environ["PATH"]}

    def offered(line: str) -> list[str]:
        asked = f"source {tmp_path / 'script'}; complete -C '{line}'"
        done = subprocess.run([fish, "-c", asked], env=environment, capture_output=True, text=True, check=True)
        return [row.split("\t")[0] for row in done.stdout.splitlines()]

    for mode in PARSERS:
        assert set(offered(f"shviewer {'' if mode == 'view' else mode} -")) == options_of(mode)
    assert offered("shviewer sweep a.gif --turn") == ["--turntable", "--turn-light"]
    assert offered("shviewer info --turn") == []
    assert offered("shviewer --tone a") == ["aces"]


def test_the_manual_page_is_read_without_a_complaint() -> None:
    man = shutil.which("groff")
    if man is None:
        pytest.skip("no groff")
    page = next(path for path in shell_files() if path.suffix == ".1")
    done = subprocess.run([man, "-man", "-Tascii", "-ww", "-z", page], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_page_is_told_in_the_characters_that_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """A terminal in the C locale, or a pipe on Windows, has not all of them."""
    told = TextIOWrapper(BytesIO(), encoding="ascii", newline="")
    monkeypatch.setattr(sys, "stdout", told)
    assert main(["help", "zh"]) == 0
    told.flush()
    assert told.buffer.getvalue().decode("unicode_escape") == read(next(path for path in PAGES if path.stem == "zh"))


@pytest.mark.parametrize("mode", PARSERS)
def test_help_fits_a_terminal_of_80_columns(mode: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert [line for line in PARSERS[mode]().format_help().splitlines() if len(line) > 80] == []
