"""What holds for every test, whichever machine, shell or worker process runs it."""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import NoReturn

import pytest
from helpers import hear_signals, unavailable

# Before NumPy comes: the processors are for tests beside each other. shviewer itself asks for one thread, too.
os.environ["OPENBLAS_NUM_THREADS"] = os.environ["MKL_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

from shviewer.analysis.cache import MEMORY
from shviewer.benchmark.measuring.measured_lights import MeasuredLight, measured_light
from shviewer.errors import GraphicsError
from shviewer.lights.find import find_light
from shviewer.viewer import screenshot
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.screenshot import headless_renderer

MOST_WORKERS = 4
"""Each of them imports, collects and makes an OpenGL context; more gain little."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """Folders are spread over the processors; files and tests that are named run in the one process, at once."""
    named = [argument for argument in config.args if not Path(argument).is_dir()]
    affinity = getattr(os, "sched_getaffinity", None)
    processors = len(affinity(0)) if affinity else os.cpu_count() or 1
    return 0 if named or processors == 1 else min(processors, MOST_WORKERS)


def pytest_configure() -> None:
    hear_signals()


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(
    collector: pytest.Collector,
) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Modules are collected in every process, and for a single test, too: they prepare no picture on the way."""
    report = yield
    if isinstance(collector, pytest.Module) and MEMORY._known:
        MEMORY.clear()
        report.outcome = "failed"
        report.longrepr = "a picture is prepared while the module is imported; helpers.Lazily makes it later"
    return report


@pytest.fixture(scope="session")
def session_renderer() -> Iterator[Renderer]:
    """One OpenGL context for all tests that draw in this process: two live ones in a thread silently mix.

    Skips with the reason where there is no EGL; on CI that is a failure.
    """
    renderers = headless_renderer()
    try:
        renderer = renderers.__enter__()
    except GraphicsError as error:
        unavailable(f"tests that draw cannot run: {error}")
    made, screenshot._headless_context = screenshot._headless_context, _second_context
    try:
        yield renderer
    finally:
        screenshot._headless_context = made
        renderers.__exit__(None, None, None)


def _second_context() -> NoReturn:
    """Stand in for what makes a context, so that the test is named that would spoil all others of its process."""
    raise AssertionError("a second OpenGL context in this process: take `renderer`, or draw in a process of its own")


@pytest.fixture
def renderer(session_renderer: Renderer) -> Iterator[Renderer]:
    """The session's renderer; a test must neither find nor leave an OpenGL error."""
    assert session_renderer.context.error == "GL_NO_ERROR"
    yield session_renderer
    assert session_renderer.context.error == "GL_NO_ERROR"


@pytest.fixture(scope="session")
def green() -> MeasuredLight:
    """The light of the paper as a report sees it."""
    return measured_light(find_light("green"))


@pytest.fixture
def fresh_memory() -> Iterator[None]:
    """Nothing is remembered of any light, neither before the test nor after it."""
    MEMORY.clear()
    yield
    MEMORY.clear()
