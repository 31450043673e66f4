"""The rooms of the house and their rule: a room imports only rooms below it, and no two files import each other."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache

import pytest
from places import ROOT

ROOMS = (
    ("__main__", "cli"),
    ("__init__", "api", "pictures"),
    ("benchmark",),
    ("viewer",),
    ("analysis",),
    ("lights",),
    ("coefficients",),
    ("harmonics",),
    (
        "children",
        "ending",
        "errors",
        "files",
        "limits",
        "memory",
        "notebook",
        "outputs",
        "progress",
        "resources",
        "version",
        "words",
    ),
)
"""From top to bottom. Files of one line may import each other, as long as they do not go round."""

OWNERS = {
    "pyrr": {"viewer/camera.py"},
    "glfw": {f"viewer/desktop/{file}.py" for file in ("frames", "glfw_window", "window")},
    "OpenEXR": {"lights/images/openexr_library.py", "viewer/saving/picture_files.py"},
}
"""Delicate libraries, and where they are tamed."""

PACKAGE = ROOT / "shviewer"
Import = tuple[str, str]
"""A file and one that it imports, as paths under shviewer/."""


def test_every_file_stands_in_a_room_that_the_house_has() -> None:
    rooms = {room for line in ROOMS for room in line}
    assert {_room(file) for file in _files()} == rooms


def test_a_room_imports_only_rooms_below_it() -> None:
    assert {pair for pair in _imports() if _height(pair[0]) > _height(pair[1])} == set()


def test_no_files_import_each_other_in_a_circle() -> None:
    assert not _circles(_imports())


@pytest.mark.parametrize("library", OWNERS)
def test_a_delicate_library_is_imported_where_it_is_tamed(library: str) -> None:
    assert {file for file in _files() if library in (name.split(".")[0] for name, _ in _names(file))} == OWNERS[library]


def test_openexr_is_imported_only_when_a_file_needs_it() -> None:
    assert not [file for file in _files() for name, begins in _names(file) if begins and name.startswith("OpenEXR")]


@pytest.mark.parametrize("library", ["moderngl", "PIL", "pyrr", "glfw", "matplotlib"])
def test_nothing_below_the_viewer_draws(library: str) -> None:
    """Pillow reads pictures, too: that is what the readers of images may use it for."""
    above = {"cli", "api", "benchmark", "viewer"}
    users = [file for file in _files() if library in (name.split(".")[0] for name, _ in _names(file))]
    assert [file for file in users if _room(file) not in above and not file.startswith("lights/images/")] == []


def test_the_rule_sees_subfolders_functions_and_circles() -> None:
    """The one before it saw none of them."""
    tree = ast.parse("def late():\n    from shviewer.viewer.gl.renderer import Renderer\n")
    assert list(_names_in(tree)) == [("shviewer.viewer.gl.renderer.Renderer", False)]
    assert _target("shviewer.viewer.gl.renderer.Renderer") == "viewer/gl/renderer.py"
    assert _height("harmonics/basis.py") > _height("viewer/gl/renderer.py")
    assert _circles({("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")}) == {"a", "b", "c"}


def test_what_tests_and_benchmarks_import_is_there() -> None:
    """No type checker reads them, and benchmarks are run by hand alone: one imported what had moved."""
    missing = [
        f"{path.name}: {name}"
        for path in sorted((ROOT / "tests").rglob("*.py"))
        for name, _ in _names_in(ast.parse(path.read_text(encoding="utf-8")))
        if name.startswith("shviewer.") and not _is_there(name)
    ]
    assert missing == []


@cache
def _is_there(name: str) -> bool:
    """Whether a dotted name of ours is a module, or something that one holds where it begins."""
    path = name.partition(".")[2].replace(".", "/")
    if {f"{path}.py", f"{path}/__init__.py"} & set(_files()):
        return True
    file = _target(name)
    return file is not None and (file == "__init__.py" or name.rpartition(".")[2] in _held_by(file))


@cache
def _held_by(file: str) -> frozenset[str]:
    """Every name that a file of ours gives something, or imports."""
    nodes = list(ast.walk(ast.parse((PACKAGE / file).read_text(encoding="utf-8"))))
    names = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    names |= {node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    return frozenset(
        names
        | {
            alias.asname or alias.name
            for node in nodes
            for alias in getattr(node, "names", [])
            if isinstance(alias, ast.alias)
        }
    )


@cache
def _files() -> tuple[str, ...]:
    return tuple(sorted(path.relative_to(PACKAGE).as_posix() for path in PACKAGE.rglob("*.py")))


def _room(file: str) -> str:
    return file.partition("/")[0].removesuffix(".py")


def _height(file: str) -> int:
    """The line of ROOMS, counted from the top."""
    return next(number for number, line in enumerate(ROOMS) if _room(file) in line)


@cache
def _names(file: str) -> tuple[tuple[str, bool], ...]:
    """Everything a file imports, as dotted names, and whether it does so where it begins."""
    return tuple(_names_in(ast.parse((PACKAGE / file).read_text(encoding="utf-8"))))


def _names_in(tree: ast.Module) -> Iterator[tuple[str, bool]]:
    begins = {id(node) for node in tree.body}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((alias.name, id(node) in begins) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"line {node.lineno}: imports are absolute"
            yield from ((f"{node.module}.{alias.name}", id(node) in begins) for alias in node.names)


def _imports() -> set[Import]:
    pairs = ((file, _target(name)) for file in _files() for name, _ in _names(file))
    return {(file, target) for file, target in pairs if target is not None and target != file}


def _target(name: str) -> str | None:
    """The file that a dotted name of ours is in; None for what is not ours."""
    first, *parts = name.split(".")
    if first != "shviewer":
        return None
    for count in range(len(parts), -1, -1):
        for path in ("/".join(parts[:count]) + ".py", "/".join([*parts[:count], "__init__.py"])):
            if path in _files():
                return path
    raise AssertionError(f"{name} is nowhere")


def _circles(imports: set[Import]) -> set[str]:
    """The files that are left when all that import nothing of the rest are taken away, again and again."""
    left = {file for pair in imports for file in pair}
    while True:
        free = {file for file in left if not any(user == file and used in left for user, used in imports)}
        if not free:
            return left
        left -= free
