"""The colour maps are the library's, and mean what they seem to mean."""

from __future__ import annotations

import numpy as np
import pytest

from shviewer.viewer.colour.colour_maps import DIVERGING, SEQUENTIAL, linear, map_of, table
from shviewer.viewer.view import ERRORS

matplotlib = pytest.importorskip("matplotlib")


def luminance(name: str) -> np.ndarray:
    return linear(table(name)) @ [0.2126, 0.7152, 0.0722]


def test_the_sequential_table_is_that_of_matplotlib_and_the_diverging_one_has_its_ends() -> None:
    sequential, diverging = (255 * np.array(matplotlib.colormaps[name].colors) for name in (SEQUENTIAL, DIVERGING))
    np.testing.assert_array_equal(table(SEQUENTIAL), np.round(sequential))
    np.testing.assert_allclose(table(DIVERGING)[[0, -1]], diverging[[0, -1]], atol=1)


def test_no_error_is_nearly_black_and_more_error_is_brighter() -> None:
    sequential, diverging = luminance(SEQUENTIAL), luminance(DIVERGING)
    assert sequential[0] < 0.001
    assert (np.diff(sequential) > -1e-3).all()
    middle = diverging[127:129].mean()
    assert middle < 0.01
    assert (np.diff(diverging[135:]) > -1e-3).all()
    assert (np.diff(diverging[:120]) < 1e-3).all()
    np.testing.assert_allclose(diverging[0], diverging[-1], rtol=0.2)  # equal errors of either sign are equally bright


def test_only_a_signed_error_has_the_diverging_map() -> None:
    assert [map_of(error) for error in ERRORS[1:]] == [DIVERGING, SEQUENTIAL, SEQUENTIAL]


def test_linear_light_is_the_standards() -> None:
    """IEC 61966-2-1: 188 is half of white, and the darkest values are proportional."""
    np.testing.assert_allclose(
        linear(np.array([0, 10, 188, 255], np.uint8)), [0, 10 / 255 / 12.92, 0.5029, 1], rtol=1e-3
    )
