"""When a file counts as changed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from shviewer.files import FileVersion
from shviewer.lights.find import file_version
from shviewer.viewer.desktop.watching import Watch


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "light.toml"
    path.write_text("first")
    return path


def write(path: Path, text: str, seconds: int) -> None:
    """With a time of its own, since two writes may fall into one tick of the file system's clock."""
    path.write_text(text)
    os.utime(path, (seconds, seconds))


def looks(watch: Watch, path: Path, read: FileVersion | None, count: int) -> list[bool]:
    return [watch.changed(str(path), read) for _ in range(count)]


def test_a_file_that_stays_as_it_was_read_has_not_changed(file: Path) -> None:
    assert looks(Watch(), file, file_version(str(file)), 4) == [False] * 4


def test_a_change_is_reported_once_at_the_second_of_two_equal_looks(file: Path) -> None:
    watch, read = Watch(), file_version(str(file))
    looks(watch, file, read, 2)
    write(file, "second", 1)
    assert looks(watch, file, read, 4) == [False, True, False, False]
    write(file, "third", 2)
    assert looks(watch, file, read, 3) == [False, True, False]


def test_nothing_is_reported_while_the_file_is_being_written(file: Path) -> None:
    watch, read = Watch(), file_version(str(file))
    for second in range(5):
        write(file, "x" * second, second)
        assert looks(watch, file, read, 1) == [False]
    assert looks(watch, file, read, 2) == [True, False]


def test_equal_size_and_equal_time_are_told_apart_by_the_other_two(file: Path) -> None:
    write(file, "one", 1)
    read = file_version(str(file))
    write(file, "two", 2)
    assert looks(Watch(), file, read, 2) == [False, True]
    write(file, "three", 1)
    assert looks(Watch(), file, read, 2) == [False, True]
    other = file.with_name("other")
    write(other, "two", 1)
    other.replace(file)
    assert looks(Watch(), file, read, 2) == [False, True]


def test_a_file_that_is_gone_is_waited_for(file: Path) -> None:
    watch, read = Watch(), file_version(str(file))
    file.rename(file.with_name("away"))
    assert looks(watch, file, read, 3) == [False] * 3
    file.with_name("away").rename(file)
    assert looks(watch, file, read, 3) == [False] * 3  # it is the one that was read
    assert not watch.gone
    file.unlink()
    assert looks(watch, file, read, 1) == [False]
    assert not watch.gone  # perhaps it is being replaced
    assert looks(watch, file, read, 2) == [False] * 2
    assert watch.gone
    write(file, "another", 3)
    assert looks(watch, file, read, 3) == [False, True, False]
    assert not watch.gone


def test_what_was_reported_of_one_light_says_nothing_of_another(file: Path, tmp_path: Path) -> None:
    watch, other = Watch(), tmp_path / "other.toml"
    os.link(file, other)  # even with the same file_version
    assert looks(watch, file, None, 3) == [False, True, False]
    assert looks(watch, other, None, 3) == [False, True, False]


def test_the_file_of_a_function_a_layer_or_a_built_in_light_is_looked_at(tmp_path: Path) -> None:
    for name in ("light.py", "light.exr"):
        (tmp_path / name).write_text("12345")
        found = file_version(f"{tmp_path / name}:part")
        assert found is not None
        assert found.size == 5
    assert file_version("green") is not None
    assert file_version("no such light") is None
    assert file_version("zero\0byte") is None
