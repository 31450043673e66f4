"""README, --help, the key table and .ci/run say the same."""

from __future__ import annotations

import re
from contextlib import nullcontext
from pathlib import Path

import pytest

from shviewer.cli.options import (
    EXIT_CODES,
    info_parser,
    project_parser,
    report_parser,
    screenshot_parser,
    sweep_parser,
    view_parser,
)
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.lights.scene import PROFILES, read_scene
from shviewer.limits import MAX_BANDS
from shviewer.viewer.keys import key_table
from shviewer.viewer.state import METHODS, ViewState

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def code_blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)


def test_the_key_list_is_the_key_table() -> None:
    assert key_table() + "\n" in code_blocks("text")


def test_the_exit_codes_are_those_of_the_help() -> None:
    indented = "\n".join(f"  {line}".rstrip() for line in code_blocks("text")[-1].splitlines())
    assert indented in EXIT_CODES


@pytest.mark.parametrize(
    "parser",
    [view_parser(), screenshot_parser(), sweep_parser(), info_parser(), project_parser(), report_parser()],
    ids=["view", "screenshot", "sweep", "info", "project", "report"],
)
def test_every_option_is_explained(parser: object) -> None:
    options = [text for action in parser._actions for text in action.option_strings if text.startswith("--")]  # type: ignore[attr-defined]
    assert options
    for option in options:
        assert re.search(rf"`[^`\n]*{option}\b", README), option


def test_the_help_names_the_methods_the_default_bands_and_their_limit() -> None:
    text = "".join(view_parser().format_help().split())  # argparse breaks lines at hyphens, too
    assert all(method in text for method in METHODS)
    assert f"1to{MAX_BANDS}(default{ViewState().n_bands})" in text


def test_the_two_commands_are_single_lines_and_ci_runs_the_second() -> None:
    commands = [block.strip() for block in code_blocks("sh") if "venv" in block]
    assert len(commands) == 2
    assert not any("\n" in command for command in commands)
    assert commands[0].endswith("shviewer")
    assert commands[1].endswith("pytest")
    script = (ROOT / ".ci" / "run").read_text()
    wanted = re.search(r"grep -F -- \"(.*)\" README.md", script)
    assert wanted is not None
    assert [line for line in README.splitlines() if wanted[1] in line] == [commands[1]]


def test_the_scene_in_the_readme_can_be_read_and_shows_every_profile(tmp_path: Path) -> None:
    (text,) = code_blocks("toml")
    path = tmp_path / "scene.toml"
    path.write_text(text)
    assert len(read_scene(path).lobes) == len(PROFILES)
    assert all(f'"{profile}"' in text for profile in PROFILES)


def test_the_python_example_prints_what_it_says(capsys: pytest.CaptureFixture[str]) -> None:
    example = next(block for block in code_blocks("python") if "find_light" in block)
    exec(compile(example, "README.md", "exec"), {})
    printed = capsys.readouterr().out.strip()
    promised = re.search(r"# (0\.\d+)\.\.\.", example)
    assert promised is not None
    assert printed.startswith(promised[1])


def test_the_tutorial_prints_what_it_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], session_renderer: object
) -> None:
    """Every print of "From Python", in one session, in an empty folder; the picture is drawn as the tests draw."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(session_renderer))
    section = README[README.index("## From Python") : README.index("## Conventions")]
    blocks = re.findall(r"^```python\n(.*?)^```$", section, flags=re.MULTILINE | re.DOTALL)
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, "README.md", "exec"), names)
    promised = re.findall(r"^ *print\(.*\)  # (.*)$", section, flags=re.MULTILINE)
    assert len(promised) > 10
    assert capsys.readouterr().out.splitlines() == promised


def test_the_table_of_conventions_is_that_of_the_code() -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \| (?:kept|none) \| .* \| (.*) \|$", README, flags=re.MULTILINE))
    bands = {
        name: ("1 to 3" if not convention.filled_up else "3") if convention.most_bands else "1 to 128"
        for name, convention in CONVENTIONS.items()
    }
    assert rows == bands
    for name, convention in CONVENTIONS.items():
        (row,) = re.findall(rf"^\| `{name}` \| (kept|none) \| ([-xyz, ]+).*$", README, flags=re.MULTILINE)
        assert row[0] == ("kept" if convention.phase else "none")
        assert row[1].strip(" ").rstrip(";") == ", ".join(re.findall("-?[xyz]", convention.axes.text.replace("+", "")))
