"""The guide is true: its tables are the program's, its code runs, its figures come out again, its links lead somewhere."""

from __future__ import annotations

import argparse
import csv
import json
import re
import sys
import tomllib
from contextlib import nullcontext
from inspect import CO_OPTIMIZED
from pathlib import Path
from types import FrameType

import numpy as np
import pytest
from documents import GUIDE, PAGES, README, ROOT, anchors, code_blocks, commands, links, page, read
from guide import PARSERS, written_anew
from places import ASSETS
from test_house import ROOMS

import shviewer
from shviewer.analysis.cache import MEMORY
from shviewer.analysis.figures import needs
from shviewer.analysis.recipe import Recipe
from shviewer.cli.help import guide_pages
from shviewer.cli.main import main
from shviewer.cli.options.states import state_from
from shviewer.coefficients.programs import CONVENTIONS
from shviewer.coefficients.texts import MODIFIERS
from shviewer.lights.analytic.scene import PROFILES, read_scene
from shviewer.lights.find import built_in_lights

DOCUMENTS = [README, ROOT / "assets" / "README.md", ROOT / "assets" / "report" / "report.md", *PAGES]

documents = pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
pages = pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)


# Tables


@pages
def test_a_page_has_the_tables_of_the_program_as_it_is_today(path: Path) -> None:
    assert read(path) == written_anew(read(path)), "python tests/guide.py writes them"


def test_the_keys_the_usage_and_the_exit_codes_stand_in_the_guide() -> None:
    assert "<!-- generated: keys -->" in page("window")
    assert "<!-- generated: usage -->" in page("command-line")
    assert "<!-- generated: exit codes -->" in page("command-line")


@pytest.mark.parametrize("mode", PARSERS)
def test_every_option_of_a_mode_is_explained_in_a_table_that_names_the_mode(mode: str) -> None:
    tables = re.findall(r"<!-- generated: options ([^\n]+) -->\n(.*?)<!-- end -->", page("command-line"), re.DOTALL)
    explained = "".join(table for modes, table in tables if mode in modes.split())
    options = [name for action in PARSERS[mode]()._actions for name in action.option_strings]
    assert len(options) > 5
    for option in options:
        assert re.search(rf"`{option}[ `]", explained), option


def test_the_table_of_conventions_is_that_of_the_code() -> None:
    text = page("coefficients")
    rows = dict(re.findall(r"^\| `([\w-]+)` \| (?:kept|none) \| .* \| (.*) \| .* \|$", text, flags=re.MULTILINE))
    bands = {
        name: f"{convention.fewest_bands} to {convention.most_bands or 128}".replace("3 to 3", "3")
        for name, convention in CONVENTIONS.items()
    }
    assert rows == bands
    modifiers = set(re.findall(r"`([^`]+)`", text.partition("| modifier |")[2].partition("\n\n")[0]))
    assert set(MODIFIERS) <= modifiers | {f"{quantity}-over-pi" for quantity in ("radiance", "irradiance")}
    for name, convention in CONVENTIONS.items():
        (row,) = re.findall(rf"^\| `{name}` \| (kept|none) \| ([-xyz, ]+).*$", text, flags=re.MULTILINE)
        assert row[0] == ("kept" if convention.phase else "none")
        assert row[1].strip(" ").rstrip(";") == ", ".join(re.findall("-?[xyz]", convention.axes.text.replace("+", "")))


# Links


@documents
def test_every_link_and_picture_leads_to_a_file_and_every_anchor_to_a_heading(path: Path) -> None:
    for link in links(read(path)):
        name, _, anchor = link.partition("#")
        target = path.parent / name if name else path
        assert target.exists(), link
        assert not anchor or anchor in anchors(read(target)), link


@pages
def test_a_page_links_only_to_what_is_installed_with_it(path: Path) -> None:
    wheel = tomllib.loads(read(ROOT / "pyproject.toml"))["tool"]["hatch"]["build"]["targets"]["wheel"]["force-include"]
    installed = [ROOT / source for source, place in wheel.items() if place == f"shviewer/{source}"]
    for link in links(read(path)):
        target = (path.parent / link.partition("#")[0]).resolve()
        assert any(target.is_relative_to(place) for place in installed), link


def test_the_index_lists_every_page_once() -> None:
    listed = re.findall(r"^\| \[.*?\]\((.*?)\)", page("README"), re.MULTILINE)
    assert sorted([*listed, "README.md"]) == [path.name for path in PAGES]


def test_a_page_is_called_in_the_index_what_its_heading_says() -> None:
    called = dict(re.findall(r"^\| \[(.*?)\]\((.*?)\)", page("README"), re.MULTILINE))
    assert called == {read(GUIDE / name).partition("\n")[0].removeprefix("# "): name for name in called.values()}


# Commands


@documents
def test_every_command_is_one_that_the_program_understands(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Read, not run: options that exist, values that are allowed, and built-in lights that there are."""
    for arguments in commands(read(path)):
        if arguments[:1] == ["help"]:
            assert set(arguments[1:]) <= {*guide_pages(), "TOPIC"}
            continue
        mode, *rest = arguments if arguments and arguments[0] in PARSERS else ["view", *arguments]
        if arguments == [mode]:
            continue  # a mode that is named in a sentence
        parser = PARSERS[mode]()
        parse = parser.parse_intermixed_args if mode in ("screenshot", "sweep") else parser.parse_args
        try:
            options = parse(rest)
            if mode in ("view", "screenshot", "sweep"):  # the values, without what has to be read or searched for
                green: dict[str, object] = {"light": "green", "lights": ["green"], "like": None}
                green["beside"] = "method" if options.beside == "method" else None
                free = green | {"tolerance": None, "compare": None, "input_convention": ""}
                state_from(argparse.Namespace(**{**vars(options), **free}), all_lights=False)
        except shviewer.ShviewerError as error:
            pytest.fail(f"shviewer {' '.join(arguments)}: {error}")
        except SystemExit as stopped:
            if stopped.code:
                pytest.fail(f"shviewer {' '.join(arguments)}: {capsys.readouterr().err}")
            continue  # --help, --version
        for light in getattr(options, "lights", [getattr(options, "light", None) or "green"]):
            assert light in built_in_lights() or {".", "/"} & set(light) or light.isupper(), (
                f"{light}: no built-in light"
            )


@documents
def test_every_script_that_is_run_exists(path: Path) -> None:
    for script in re.findall(r"python ((?:tests|shviewer)/\S+?\.py)", read(path)):
        assert (ROOT / script).is_file(), script


def test_the_page_on_speed_names_every_benchmark() -> None:
    listed = page("report").partition("The benchmarks behind")[2].partition("\n\n")[0]
    names = re.findall(r"`(?:python tests/benchmarks/)?(\w+\.py)`", listed)
    scripts = [path.name for path in (ROOT / "tests" / "benchmarks").glob("*.py") if "__main__" in read(path)]
    assert sorted(names) == sorted(scripts)


def test_ci_is_set_up_with_the_command_of_the_readme() -> None:
    (start, *_) = code_blocks(read(README), "sh")
    (workflow,) = code_blocks(page("pictures"), "yaml")
    assert f"- run: {start.rpartition(' && ')[0]}\n" in workflow


# Code and figures


@pytest.fixture
def empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, session_renderer: object) -> None:
    """To run a page in. Pictures are drawn as the tests draw."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(session_renderer))


def test_the_scene_can_be_read_and_shows_every_profile(tmp_path: Path) -> None:
    (text,) = code_blocks(page("lights"), "toml")
    path = tmp_path / "scene.toml"
    path.write_text(text)
    assert len(read_scene(path).lobes) == len(PROFILES)
    assert all(f'"{profile}"' in text for profile in PROFILES)


def test_the_function_is_a_light(tmp_path: Path) -> None:
    function, _ = code_blocks(page("lights"), "python")
    path = tmp_path / "lights.py"
    path.write_text(function)
    light = shviewer.find_light(f"{path}:aurora")
    assert light.radiance(np.array([[0.0, 0.0, 1.0]])).shape == (1, 3)
    assert shviewer.project(light, 8).figures.relative_l2 < 0.1


def test_the_pieces_called_from_python_print_what_the_page_says(capsys: pytest.CaptureFixture[str]) -> None:
    _, example = code_blocks(page("lights"), "python")
    exec(compile(example, "lights.md", "exec"), {})
    printed = capsys.readouterr().out.strip()
    promised = re.search(r"# (0\.\d+)\.\.\.", example)
    assert promised is not None
    assert printed.startswith(promised[1])


@pytest.mark.usefixtures("empty_folder")
def test_the_tutorial_prints_what_it_says(capsys: pytest.CaptureFixture[str]) -> None:
    """Every print of the page, in one session."""
    names: dict[str, object] = {}
    for block in code_blocks(page("python"), "python"):
        exec(compile(block, "python.md", "exec"), names)
    promised = re.findall(r"^ *print\(.*\)  # (.*)$", page("python"), flags=re.MULTILINE)
    assert len(promised) > 10
    assert capsys.readouterr().out.splitlines() == promised


@pytest.mark.usefixtures("empty_folder")
def test_a_pixel_is_checked_as_the_page_says(capsys: pytest.CaptureFixture[str]) -> None:
    """It holds the radiance of the reconstruction in the direction that the example prints, in float32."""
    text = page("pictures")
    (command,) = (arguments for arguments in commands(text) if "OUT.exr" in arguments)
    assert main(command) == 0
    (example,) = code_blocks(text, "python")
    names: dict[str, object] = {}
    exec(compile(example, "pictures.md", "exec"), names)
    printed = np.array([float(word) for word in re.findall(r"[-+\d.e]+", capsys.readouterr().out)])
    found = shviewer.project("venice_sunset", 9)
    wanted = shviewer.reconstruct(found.coefficients, np.asarray(names["direction"])[None])[0]
    np.testing.assert_allclose(printed[3:], wanted, rtol=1e-4)


def test_the_band_counts_are_those_that_info_finds(capsys: pytest.CaptureFixture[str]) -> None:
    block, shiny, *_ = code_blocks(page("bands"), "sh")
    ((light, roughness, count),) = re.findall(r"^shviewer (\S+) --for glossy:(\S+) --tolerance 5% +# (\d+)", shiny)
    assert needs(Recipe(light, quantity=f"glossy:{roughness}")).shown == int(count)
    checked = 0
    for light, quantity, said in re.findall(
        r"^shviewer (\S+) --tolerance 5%(?: --for (\w+))? +# (.*)$", block, re.MULTILINE
    ):
        assert main(["info", light, "--json"]) == 0
        (about,) = json.loads(capsys.readouterr().out)
        (need,) = (need for need in about["bands_needed"] if need["tolerance"] == 0.05)
        if need["radiance"] is None:
            assert said == f"none up to {need['searched']}; irradiance {need['irradiance']}"
        else:
            assert said.startswith(f"{need[quantity or 'radiance']} bands")
        checked += 1
    assert checked == 3


def test_deringing_costs_what_the_page_says() -> None:
    """The widest Lanczos window without a negative is looked for in steps of a twentieth of a band."""
    text = " ".join(page("bands").split())
    found = re.search(r"light in (\d+) bands it raises the error from (\d+) % to (\d+) %, .* to (\d+) %", text)
    assert found is not None
    bands, plain, deringed, blurred = map(int, found.groups())

    def error(window: str, width: float | None = None) -> tuple[float, float]:
        figures = shviewer.project("green", bands, window=window, window_width=width).figures
        return 100 * figures.relative_l2, figures.extremes.minimum

    assert round(error("none")[0]) == plain
    assert round(error("dering")[0]) == deringed
    lanczos = (error("lanczos", width) for width in np.arange(bands, 1, -0.05))
    assert round(next(l2 for l2, minimum in lanczos if minimum >= 0)) == blurred


def test_the_example_of_a_file_has_lines_that_project_writes(tmp_path: Path) -> None:
    (example,) = code_blocks(page("coefficients"), "csv")
    shviewer.project("green", 3).save(tmp_path / "green.csv", "three")
    *lines, row = example.splitlines()
    written = read(tmp_path / "green.csv").splitlines()
    assert len(lines) > 3
    assert set(lines) <= set(written)
    assert row.count(",") == written[-1].count(",")


def test_the_excerpt_of_the_report_is_in_the_report() -> None:
    text = page("report")
    with (ROOT / "assets" / "report" / "report.csv").open(encoding="utf-8") as file:
        kept = [row for row in csv.DictReader(file) if (row["section"], row["light"]) == ("projection", "green")]
    table = re.findall(
        r"^\| ([A-Za-z][^|]*?)(?:, ([\d ]+) samples)? \| (\d+) \| ([\d.]+) \| ([\d.]+) % \|$", text, re.MULTILINE
    )
    assert len(table) > 5
    for label, samples, bands, milliseconds, percent in table:
        method = "best" if label == "closed form" else re.split(r"[ (]", label.lower())[0]
        (row,) = (
            row
            for row in kept
            if (row["method"], row["n_bands"], row["samples"]) == (method, bands, samples.replace(" ", ""))
        )
        assert float(milliseconds) == pytest.approx(float(row["milliseconds"]), abs=5.1e-4)
        assert float(percent) == float(f"{100 * float(row['total_error']):.2g}")
    whole = " ".join(read(ROOT / "assets" / "report" / "report.md").split())
    said = re.search(r"For 5 %: (\d+ bands); the paper's (.*?)\. The", " ".join(text.split()))
    assert said is not None
    assert re.search(
        rf"for a total error of 5 %: {said[1]}, .*?; the paper's {re.escape(said[2])}",
        whole.partition("### hemisphere")[0],
    )


# Names of files


@documents
def test_every_source_file_that_is_named_exists(path: Path) -> None:
    for name in re.findall(r"`((?:shviewer|tests)/[\w/]+\.py)`", read(path)):
        assert (ROOT / name).is_file(), name


def test_the_page_for_contributors_names_files_and_rooms_that_there_are() -> None:
    text = page("contributing")
    names = re.findall(r"`([\w/]+\.py)`", text)
    assert len(names) > 30
    for name in names:
        assert (ROOT / "shviewer" / name).is_file() or (ROOT / name).is_file(), name
    rooms = re.findall(r"^\| (`.*?) \|", text, flags=re.MULTILINE)
    listed = [set(re.findall(r"`(\w+)(?:/|\.py)`", row)) for row in rooms]
    assert listed == [set(line) - {"__main__", "__init__"} for line in ROOMS]


def test_a_file_goes_through_the_functions_that_the_journey_names(tmp_path: Path) -> None:
    """The steps of the page, in their order, as a profile of the command sees them for the first time."""
    journey = page("contributing").partition("## From an .exr file")[2].partition("\n## ")[0]
    files = [name for name in re.findall(r"`([\w/]+\.py)`", journey) if name not in ("cli/options/modes.py",)]
    seen: list[str] = []

    def note(frame: FrameType, event: str, argument: object) -> None:
        function = frame.f_code.co_flags & CO_OPTIMIZED  # and no body of a module or a class: those run on import
        if event == "call" and "shviewer/" in frame.f_code.co_filename and function:
            name = frame.f_code.co_filename.rpartition("shviewer/")[2]
            if name in files and name not in seen:
                seen.append(name)

    image = str(ASSETS / "environments" / "film_studio.exr")
    before = sys.getprofile()
    MEMORY.clear()
    sys.setprofile(note)
    try:
        assert main(["project", image, "-o", str(tmp_path / "studio.json")]) == 0
    finally:
        sys.setprofile(before)
    assert set(files) <= set(seen)
    assert [seen.index(name) for name in STAGES] == sorted(seen.index(name) for name in STAGES)


STAGES = (
    "cli/main.py",
    "cli/project.py",
    "cli/options/inputs.py",
    "cli/options/recipes.py",
    "outputs.py",
    "analysis/reconstruction.py",
    "analysis/subjects.py",
    "files.py",
    "lights/images/radiance_files.py",
    "lights/images/openexr.py",
    "lights/layouts/recognise.py",
    "analysis/projections.py",
    "harmonics/projection/rows.py",
    "analysis/figures.py",
    "coefficients/writing.py",
)
