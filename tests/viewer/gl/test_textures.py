"""Textures that follow arrays: a large one goes up in bands, beside the one that is shown."""

from __future__ import annotations

import numpy as np
import pytest

from shviewer.errors import GraphicsError
from shviewer.viewer.gl import textures
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.gl.textures import ArrayTexture

NO_TIME = 0.0
LARGE = np.random.default_rng(1).random((50, 9, 3), dtype=np.float32)


@pytest.fixture
def texture(renderer: Renderer, monkeypatch: pytest.MonkeyPatch) -> ArrayTexture:
    monkeypatch.setattr(textures, "BAND_BYTES", LARGE[:8].nbytes)
    return ArrayTexture(renderer.context)


def held(texture: ArrayTexture) -> np.ndarray:
    """What OpenGL holds, (height, width, components)."""
    assert texture._held is not None
    shown = texture._held.texture
    width, height = shown.size
    dtype = np.float16 if shown.dtype == "f2" else np.float32
    return np.frombuffer(shown.read(alignment=1), dtype).reshape(height, width, -1)


def test_a_large_array_goes_up_in_bands_while_the_last_one_stays(texture: ArrayTexture) -> None:
    before = np.ones((2, 3, 4), np.float32)
    texture.follow(before)
    steps = 1
    while not texture.bring(LARGE, NO_TIME):
        np.testing.assert_array_equal(held(texture), before)
        steps += 1
    assert steps == 7  # bands of 8 rows in 50
    texture.follow(LARGE)
    np.testing.assert_array_equal(held(texture), LARGE)
    texture.release()


def test_values_that_half_floats_hold_take_half_the_memory_and_lose_nothing(texture: ArrayTexture) -> None:
    values = LARGE.astype(np.float16).astype(np.float32)
    texture.follow(values, halves=True)
    assert texture._held is not None
    assert texture._held.texture.dtype == "f2"
    np.testing.assert_array_equal(held(texture), values)
    texture.release()


def test_a_large_array_of_the_same_size_does_not_overwrite_the_one_shown(texture: ArrayTexture) -> None:
    texture.follow(LARGE)
    assert not texture.bring(LARGE + 1, NO_TIME)
    np.testing.assert_array_equal(held(texture), LARGE)
    texture.release()


def test_an_array_that_is_given_up_half_way_leaves_nothing_behind(texture: ArrayTexture) -> None:
    before = np.ones((2, 3, 4), np.float32)
    texture.follow(before)
    assert not texture.bring(LARGE, NO_TIME)
    assert texture.bring(before, NO_TIME)
    assert texture._next is None
    texture.follow(before)
    np.testing.assert_array_equal(held(texture), before)
    texture.release()


def test_a_texture_of_the_same_size_is_written_over_where_that_is_quick(texture: ArrayTexture) -> None:
    texture.follow(np.zeros((4, 4, 3), np.float32))
    assert texture._held is not None
    first = texture._held.texture
    texture.follow(np.ones((4, 4, 3), np.float32))
    assert texture._held.texture is first
    assert (held(texture) == 1).all()
    texture.release()


def test_an_array_larger_than_opengl_takes_is_refused_before_it_is_copied(texture: ArrayTexture) -> None:
    with pytest.raises(GraphicsError, match="this OpenGL takes at most"):
        texture.bring(np.broadcast_to(np.float32(0), (1, 2**20, 3)))
