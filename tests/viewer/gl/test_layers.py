"""Layers: an image of one colour is one pixel wherever it is kept, and all pixels wherever it is drawn."""

from __future__ import annotations

import numpy as np
from viewer.gl.frames import square_frame

from shviewer.viewer.composing.panes import Box
from shviewer.viewer.gl.renderer import Renderer
from shviewer.viewer.overlay.drawing import draw
from shviewer.viewer.overlay.layers import Layer
from shviewer.viewer.overlay.pieces import Fill
from shviewer.viewer.screenshot import offscreen


def test_an_image_that_is_one_pixel_broadcast_is_drawn_as_one_of_all_its_pixels(renderer: Renderer) -> None:
    frame = square_frame()
    one = draw([Fill(Box(3.4, 5.6, 77.7, 60.2), (40, 90, 200, 130))])
    assert one.image.strides[:2] == (0, 0)
    assert one.image.shape == (54, 75, 4)
    all_of_them = Layer(np.ascontiguousarray(one.image), one.left, one.top)
    with offscreen(renderer, frame) as target:
        drawn = []
        for layer in (one, all_of_them):
            target.use()
            target.clear(0.2, 0.3, 0.4)
            renderer.layers.draw(target, frame, (layer,))
            drawn.append(np.frombuffer(target.read(), np.uint8).reshape(-1, 3))
    assert len(np.unique(drawn[0], axis=0)) == 2
    assert np.array_equal(*drawn)
