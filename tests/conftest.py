"""One OpenGL context for all tests that draw in this process: two live ones in a thread silently mix."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from shviewer.errors import GraphicsError
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.screenshot import headless_renderer


@pytest.fixture(scope="session")
def session_renderer() -> Iterator[Renderer]:
    """Skips with the reason where there is no EGL; on CI that is a failure."""
    renderers = headless_renderer()
    try:
        renderer = renderers.__enter__()
    except GraphicsError as error:
        if os.environ.get("CI"):
            pytest.fail(f"tests that draw cannot run: {error}")
        pytest.skip(str(error))
    try:
        yield renderer
    finally:
        renderers.__exit__(None, None, None)


@pytest.fixture
def renderer(session_renderer: Renderer) -> Iterator[Renderer]:
    """The session's renderer; a test must neither find nor leave an OpenGL error."""
    assert session_renderer.context.error == "GL_NO_ERROR"
    yield session_renderer
    assert session_renderer.context.error == "GL_NO_ERROR"
