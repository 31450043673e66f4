"""Several lights at once: files in their order, and of folders what is a light."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shviewer.analysis.projected import project_recipe
from shviewer.analysis.recipe import Recipe
from shviewer.coefficients.programs import OURS
from shviewer.coefficients.writing import FORMATS
from shviewer.lights.several import matching, several


def test_a_folder_is_its_images_scenes_and_stamped_coefficients_in_the_order_of_their_numbers(tmp_path: Path) -> None:
    for name in ("sky-10.hdr", "Sky-2.EXR", "a.png", ".hidden.hdr", "notes.md", "movie.mp4"):
        (tmp_path / name).write_bytes(b"any")
    (tmp_path / "scene.toml").write_text("[[lobe]]\n")
    (tmp_path / "pyproject.toml").write_text("[project]\n")
    (tmp_path / "package.json").write_text("{}")
    np.savetxt(tmp_path / "bare.txt", np.ones((4, 3)))
    projected = project_recipe(Recipe(n_bands=2))
    for kind in FORMATS:
        (tmp_path / f"z.{kind}").write_bytes(projected.encode(OURS, kind))
    (tmp_path / "within.hdr").mkdir()
    (tmp_path / "within.hdr" / "x.hdr").write_bytes(b"any")
    found = several([str(tmp_path)])
    assert [Path(light).name for light in found.lights] == [
        "a.png",
        "scene.toml",
        "Sky-2.EXR",
        "sky-10.hdr",
        *sorted(f"z.{kind}" for kind in FORMATS),
    ]
    assert found.said == (f"{tmp_path / 'within.hdr'} has lights, too: name such a folder to have them",)


def test_bare_lists_in_a_folder_are_lights_once_their_convention_is_named(tmp_path: Path) -> None:
    np.savetxt(tmp_path / "bare.txt", np.ones((4, 3)))
    assert several([str(tmp_path)]).lights == ()
    assert several([str(tmp_path)], bare=True) == ((str(tmp_path / "bare.txt"),), ())


def test_patterns_are_what_they_match_where_the_shell_left_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on Windows, or in quotation marks."""
    monkeypatch.chdir(tmp_path)
    for name in ("sky-10.hdr", "sky-2.hdr", "b [1].exr", "c.exr"):
        (tmp_path / name).touch()
    assert matching(["green", "*.hdr", "?.exr"]) == ["green", "sky-2.hdr", "sky-10.hdr", "c.exr"]
    assert matching(["b [1].exr", "*.nothing"]) == ["b [1].exr", "*.nothing"]


def test_files_keep_their_order_and_come_once_whether_they_exist_or_not() -> None:
    assert several(["green", "b.hdr", "a.hdr", "b.hdr", "x.exr:layer"]).lights == (
        "green",
        "b.hdr",
        "a.hdr",
        "x.exr:layer",
    )


def test_code_is_taken_only_where_it_is_allowed_and_an_empty_folder_is_said(tmp_path: Path) -> None:
    found = several(["code.py:f", str(tmp_path), "green"])
    assert found.lights == ("green",)
    assert found.said == (
        "code.py:f: code runs only when the command line names it",
        f"{tmp_path}: a folder without a light",
    )
    assert several(["code.py:f"], code=True).lights == ("code.py:f",)


def test_no_more_are_taken_than_were_asked_for() -> None:
    texts = [f"{number}.hdr" for number in range(7)]
    assert several(texts, most=3) == (tuple(texts[:3]), ("the first 3 of 7 files are opened",))
    assert several(texts, most=7).said == ()
