"""Lights and projections in a notebook are their pictures."""

from __future__ import annotations

import io
import json
import pickle
from contextlib import nullcontext
from typing import Any

import numpy as np
import pytest
from PIL import Image

import shviewer
from shviewer import notebook, pictures
from shviewer.errors import GraphicsError
from shviewer.viewer.gl.renderer import Renderer


@pytest.fixture(autouse=True)
def one_context(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two live contexts in a thread silently mix."""
    monkeypatch.setattr("shviewer.viewer.screenshot.headless_renderer", lambda: nullcontext(renderer))


def drawn(shown: Any) -> tuple[np.ndarray[Any, Any], dict[str, Any]]:
    data = shown._repr_png_()
    assert data is not None
    with Image.open(io.BytesIO(data)) as image:
        return np.asarray(image), json.loads(image.text["shviewer"])


def test_a_light_is_drawn_as_screenshot_draws_it() -> None:
    pixels, stamp = drawn(shviewer.find_light("green"))
    np.testing.assert_array_equal(pixels, shviewer.screenshot("green"))
    assert stamp["bands"] == 5


def test_a_projection_is_drawn_as_it_was_made() -> None:
    found = shviewer.project("studio", 8, window="hann", muted=[1])
    pixels, stamp = drawn(found)
    np.testing.assert_array_equal(pixels, shviewer.screenshot("studio", 8, window="hann", muted=[1]))
    assert (stamp["light"], stamp["bands"]) == ("studio", 8)


def test_a_projection_that_comes_from_elsewhere_is_drawn_by_its_coefficients() -> None:
    found = pickle.loads(pickle.dumps(shviewer.project(np.ones((32, 64, 3)), 3)))
    assert found.recipe is None
    _, stamp = drawn(found)
    assert stamp["bands"] == 3


def test_where_nothing_can_be_drawn_a_warning_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(shown: object) -> bytes:
        raise GraphicsError("no EGL")

    light = shviewer.find_light("green")
    monkeypatch.setattr(pictures, "picture_bytes", fails)
    with pytest.warns(UserWarning, match="no EGL"):
        assert light._repr_png_() is None
    monkeypatch.setattr(notebook, "drawing", None)
    assert light._repr_png_() is None
