"""What shviewer.lights.images.chromaticities promises: published matrices, whites that stay white, refusals."""

import numpy as np
import pytest
from helpers import refusal

from shviewer.lights.images.chromaticities import REC709, are_same, rec709_from

E = (1 / 3, 1 / 3)
D65 = (0.3127, 0.3290)
ACES_WHITE = (0.32168, 0.33767)
XYZ = ((1, 0), (0, 1), (0, 0), E)
REC2020 = ((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), D65)
AP0 = ((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.0770), ACES_WHITE)
AP1 = ((0.713, 0.293), (0.165, 0.830), (0.128, 0.044), ACES_WHITE)
RADIANCE = ((0.640, 0.330), (0.290, 0.600), (0.150, 0.060), (0.3333, 0.3333))
RED_WIDE_GAMUT = ((0.780308, 0.304253), (0.121595, 1.493994), (0.095612, -0.084589), D65)

PUBLISHED = {
    # ITU-R BT.2087-0 annex, inverted direction: Rec. 2020 to Rec. 709, as printed to four digits.
    "Rec. 2020": (REC2020, [[1.6605, -0.5876, -0.0728], [-0.1246, 1.1329, -0.0083], [-0.0182, -0.1006, 1.1187]], 1e-4),
    # The ACES output transform, AP1 to XYZ, Bradford from its white to D65, XYZ to Rec. 709.
    "AP1": (
        AP1,
        [
            [1.70505099, -0.62179212, -0.08325887],
            [-0.13025642, 1.14080474, -0.01054832],
            [-0.02400336, -0.12896898, 1.15297233],
        ],
        1e-5,
    ),
    "AP0": (
        AP0,
        [
            [2.52168619, -1.13413099, -0.38755520],
            [-0.27647991, 1.37271909, -0.09623917],
            [-0.01537806, -0.15297533, 1.16835340],
        ],
        1e-5,
    ),
}


@pytest.mark.parametrize(("chromaticities", "matrix", "tolerance"), PUBLISHED.values(), ids=PUBLISHED)
def test_the_published_matrix_comes_out(chromaticities, matrix, tolerance):
    """The tolerances are the digits printed."""
    np.testing.assert_allclose(rec709_from(chromaticities), matrix, rtol=0, atol=tolerance)


def test_the_luminances_of_the_rec_709_primaries_are_those_of_the_standard():
    """XYZ with the white D65 needs no adaptation, so the inverse is the matrix of IEC 61966-2-1, in four digits."""
    whites = np.array([D65[0], D65[1], 1 - sum(D65)]) / D65[1]
    published = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    xyz_scaled_to_white = np.linalg.inv(rec709_from((*XYZ[:3], D65)))
    np.testing.assert_allclose(whites[:, None] * xyz_scaled_to_white, published, rtol=0, atol=6e-5)


@pytest.mark.parametrize(
    "chromaticities", [REC709, REC2020, AP0, AP1, XYZ, RADIANCE, RED_WIDE_GAMUT], ids=lambda c: str(c[0])
)
def test_white_stays_white(chromaticities):
    np.testing.assert_allclose(rec709_from(chromaticities) @ np.ones(3), 1.0, rtol=0, atol=1e-13)


def test_rec_709_itself_is_left_alone():
    np.testing.assert_allclose(rec709_from(REC709), np.eye(3), rtol=0, atol=1e-14)


@pytest.mark.parametrize("white", [D65, ACES_WHITE, (0.3457, 0.3585)])
def test_moving_only_the_white_keeps_grey_grey_and_turns_back_when_applied_backwards(white):
    """Bradford from A to B and back is the identity; 1e-13 is rounding."""
    there = rec709_from((*XYZ[:3], white))
    back = np.linalg.inv(rec709_from((*XYZ[:3], white)))
    np.testing.assert_allclose(there @ back, np.eye(3), rtol=0, atol=1e-13)
    np.testing.assert_allclose(there @ np.full(3, 0.18), 0.18, rtol=0, atol=1e-13)


def test_rec_709_is_recognised_within_a_thousandth():
    assert are_same(REC709, REC709)
    assert are_same(REC709 + 0.0009, REC709)
    assert not are_same(np.vstack([REC709[:3], REC709[3] + (0.0, 0.0011)]), REC709)
    for other in (REC2020, RADIANCE, AP0, XYZ):
        assert not are_same(other, REC709)
    assert not are_same(np.full((4, 2), np.nan), REC709)


def changed(index, xy):
    values = np.array(REC709)
    values[index] = xy
    return values


@pytest.mark.parametrize(
    ("chromaticities", "rule"),
    [
        (np.zeros((4, 2)), "triangle"),
        (changed(1, (0.395, 0.195)), "triangle"),
        (changed(0, REC709[1]), "triangle"),
        (changed(2, (np.nan, 0.06)), "a number within"),
        (changed(3, (np.inf, 0.3)), "a number within"),
        (changed(0, (1e200, 1e200)), "a number within"),
        (changed(3, (0.3127, 0.0)), "y above 0"),
        (changed(3, (0.3127, -0.3)), "y above 0"),
        (changed(3, (-0.9, 0.1)), "an eye can see"),
        (changed(3, (0.6, 0.38)), "within the triangle"),
    ],
)
def test_chromaticities_that_make_no_rgb_space_are_refused_with_the_rule(chromaticities, rule):
    said = refusal(rec709_from, chromaticities)
    assert "of red, green, blue, white" in said
    assert rule in said
