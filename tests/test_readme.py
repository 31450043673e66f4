"""README is a front door that leads on: its commands, its keys, its figure, and the same as --help and .ci/run say."""

from __future__ import annotations

import re

import pytest
from documents import GUIDE, README, ROOT, code_blocks, read

from shviewer.analysis.recipe import METHODS, Recipe
from shviewer.cli.options.modes import PARSERS
from shviewer.limits import MAX_BANDS
from shviewer.viewer.control.keys import key_table

TEXT = read(README)


def rows(text: str) -> list[str]:
    return re.findall(r"^\| \[.*$", text, re.MULTILINE)


def test_the_keys_to_begin_with_are_rows_of_the_key_table() -> None:
    (keys,) = code_blocks(TEXT, "text")
    assert len(keys.splitlines()) > 10
    assert {f"  {line}" for line in keys.splitlines()} <= set(key_table().splitlines())


def test_the_table_of_pages_is_that_of_the_guide() -> None:
    assert rows(TEXT) == [row.replace("](", "](assets/guide/") for row in rows(read(GUIDE / "README.md"))]
    assert rows(TEXT)


def test_the_help_names_the_methods_the_default_bands_and_their_limit() -> None:
    text = "".join(PARSERS["view"]().format_help().split())  # argparse breaks lines at hyphens, too
    assert all(method in text for method in METHODS)
    assert f"1to{MAX_BANDS}(default{Recipe.n_bands})" in text


def test_the_two_commands_are_single_lines_and_ci_runs_the_second() -> None:
    commands = [block.strip() for block in code_blocks(TEXT, "sh") if "venv" in block]
    assert len(commands) == 2
    assert not any("\n" in command for command in commands)
    assert commands[0].endswith("shviewer")
    assert commands[1].endswith("pytest")
    script = read(ROOT / ".ci" / "run")
    wanted = re.search(r"grep -F -- \"(.*)\" README.md", script)
    assert wanted is not None
    assert [line for line in TEXT.splitlines() if wanted[1] in line] == [commands[1]]


def test_the_python_example_prints_what_it_says(capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = code_blocks(TEXT, "python")
    exec(compile(example, "README.md", "exec"), {})
    assert capsys.readouterr().out.split() == re.findall(r"# (0\.\d+)$", example, re.MULTILINE)
