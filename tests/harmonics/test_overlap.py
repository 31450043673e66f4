"""What shviewer.harmonics.overlap promises: the integral of the product of any two profiles about any two axes."""

from itertools import combinations_with_replacement

import numpy as np
import pytest
from harmonics.independent import cap_rule
from scipy.special import eval_legendre

from shviewer.harmonics.overlap import inner_product
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian

PROFILES = [
    Constant(),
    ClampedLinear(),
    ClampedLinear(5, 4),
    ClampedLinear(2, -1.2),
    ClampedLinear(0.5, -3),
    Disc(0.3),
    Disc(np.pi / 2),
    Disc(2.4),
    Gaussian(0.5),
    Gaussian(30),
    Gaussian(900),
]
PAIRS = list(combinations_with_replacement(PROFILES, 2))
ANGLES = [0.0, 0.05, 0.7, 1.5, 2.0, 2.9, np.pi]


def size(profile):
    """The L2 norm: a scale for absolute tolerances."""
    return np.sqrt(inner_product(profile, profile, 0.0))


def legendre_series(first, second, angle, n_bands=1400):
    """Funk-Hecke: the sum over degrees of (2l+1)/4pi lambda lambda' P(l)(cos angle)."""
    l = np.arange(n_bands)
    terms = (2 * l + 1) / (4 * np.pi) * first.zonal(n_bands) * second.zonal(n_bands)
    return float((terms * eval_legendre(l, np.cos(angle))).sum())


def lens_area(a, b, g):
    """Solid angle common to two caps of half angles a and b whose axes lie g apart [Tovchigrechko, Vakser 2001]."""
    if g >= a + b:
        return 0.0
    if g <= abs(a - b) + 1e-12:  # touching from inside, where the formula below keeps eight digits
        return 2 * np.pi * (1 - np.cos(min(a, b)))
    if a + b + g >= 2 * np.pi:  # together they cover the sphere
        return 2 * np.pi * (2 - np.cos(a) - np.cos(b)) - 4 * np.pi
    ca, cb, cg = np.cos([a, b, g])
    sa, sb, sg = np.sin([a, b, g])
    return 2 * (
        np.pi
        - np.arccos((cg - ca * cb) / (sa * sb))
        - np.arccos((cb - cg * ca) / (sg * sa)) * ca
        - np.arccos((ca - cg * cb) / (sg * sb)) * cb
    )


@pytest.mark.parametrize(
    ("first", "second", "tolerance"),
    [
        # the tail beyond 1400 bands: none for a Gaussian, l**-3.5 for two linear profiles, l**-2.5 with one disc
        (Gaussian(0.5), Gaussian(30), 1e-14),
        (Gaussian(30), Gaussian(30), 1e-14),
        (Gaussian(30), ClampedLinear(5, 4), 1e-14),
        (Gaussian(900), ClampedLinear(2, -1.2), 1e-14),
        (Gaussian(900), Disc(0.3), 1e-14),
        (Gaussian(0.5), Disc(2.4), 1e-14),
        (ClampedLinear(2, -1.2), ClampedLinear(), 1e-9),
        (ClampedLinear(), ClampedLinear(), 1e-9),
        (ClampedLinear(5, 4), ClampedLinear(2, -1.2), 1e-9),
        (ClampedLinear(0.5, -3), ClampedLinear(), 1e-13),
        (ClampedLinear(0.5, -3), Disc(0.3), 1e-13),
        (ClampedLinear(2, -1.2), Disc(0.3), 1e-7),
        (ClampedLinear(), Disc(2.4), 1e-7),
    ],
    ids=repr,
)
def test_overlap_is_the_sum_of_the_products_of_the_coefficients(first, second, tolerance):
    for angle in ANGLES:
        expected = legendre_series(first, second, angle)
        scale = size(first) * size(second)
        assert inner_product(first, second, angle) == pytest.approx(expected, rel=0, abs=tolerance * max(scale, 1))


@pytest.mark.parametrize("second", [Gaussian(3), Gaussian(30), ClampedLinear(0.5, -3)], ids=repr)
@pytest.mark.parametrize("first", [Disc(0.3), Disc(2.4), ClampedLinear(5, 4), ClampedLinear(2, -1.2)], ids=repr)
def test_overlap_with_a_smooth_profile_is_the_integral_over_the_cap(first, second):
    axis = np.array([0.0, 0.0, 1.0])
    directions, weights = cap_rule(axis, first.half_angle, 60)
    chord = ((directions - axis) ** 2).sum(axis=1).clip(max=4 * np.sin(first.half_angle / 2) ** 2)
    for angle in ANGLES:
        other = np.array([np.sin(angle), 0, np.cos(angle)])
        expected = weights @ (first.value(chord) * second.value(((directions - other) ** 2).sum(axis=1)))
        assert inner_product(first, second, angle) == pytest.approx(expected, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("a", [0.02, 0.3, 1.0, np.pi / 2, 2.2, 3.0])
@pytest.mark.parametrize("b", [0.05, 0.3, 1.3, 2.4])
def test_two_discs_share_the_area_of_a_spherical_lens(a, b):
    for g in (0.0, 0.01, 0.06, 0.2, 0.7, 1.4, 2.0, 2.8, 3.1, np.pi):
        expected = lens_area(a, b, g)
        # arc cosines near +-1 amplify a rounding to its square root over sin a: 1e-13 measured at 0.02 rad
        assert inner_product(Disc(a), Disc(b), g) == pytest.approx(expected, rel=0, abs=1e-12)


@pytest.mark.parametrize(("first", "second"), PAIRS, ids=repr)
def test_overlap_does_not_depend_on_the_order(first, second):
    for angle in ANGLES:
        there, back = inner_product(first, second, angle), inner_product(second, first, angle)
        assert there == pytest.approx(back, rel=1e-12, abs=1e-14)


@pytest.mark.parametrize(("first", "second"), PAIRS, ids=repr)
def test_no_overlap_exceeds_the_product_of_the_norms(first, second):
    for angle in ANGLES:
        assert 0 <= inner_product(first, second, angle) <= size(first) * size(second) * (1 + 1e-13)


@pytest.mark.parametrize(
    ("first", "second", "angle"),
    [
        (Disc(0.3), Disc(0.4), 0.7001),
        (ClampedLinear(5, 4), ClampedLinear(4, 3), np.pi / 2),
        (ClampedLinear(), Disc(0.3), 1.9),
        (ClampedLinear(), ClampedLinear(), np.pi),
    ],
    ids=repr,
)
def test_lobes_that_do_not_meet_share_nothing(first, second, angle):
    assert inner_product(first, second, angle) == 0


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        (Constant(), Constant(), 4 * np.pi),
        (Constant(), Disc(0.3), 4 * np.pi * np.sin(0.15) ** 2),
        (Constant(), ClampedLinear(1, 0), np.pi),
        (Disc(0.3), Disc(0.9), 4 * np.pi * np.sin(0.15) ** 2),
        (Disc(1e-8), Disc(1e-8), np.pi * 1e-16),
        (ClampedLinear(1, 0), ClampedLinear(1, 0), 2 * np.pi / 3),
        (ClampedLinear(5, 4), ClampedLinear(5, 4), 2 * np.pi / 15),
        (ClampedLinear(4, 3), ClampedLinear(4, 3), 2 * np.pi / 12),
        (ClampedLinear(2, -1.2), ClampedLinear(2, -1.2), 2 * np.pi * 3.2**3 / 6),
        (ClampedLinear(0.5, -3), ClampedLinear(0.5, -3), 4 * np.pi * (9 + 0.25 / 3)),
        (ClampedLinear(1, 0), Disc(0.4), np.pi * np.sin(0.4) ** 2),
        (Gaussian(7), Gaussian(7), np.pi / 7 * -np.expm1(-28)),
        (Gaussian(1e9), Gaussian(1e9), np.pi / 1e9),
        (Gaussian(2), Gaussian(5), 2 * np.pi / 7 * -np.expm1(-14)),
        (Gaussian(6), Disc(0.5), 2 * np.pi / 6 * -np.expm1(-6 * (1 - np.cos(0.5)))),
        (Gaussian(1e6), Disc(0.5), 2 * np.pi / 1e6),
        (Gaussian(1e6), ClampedLinear(1, 0), 2 * np.pi / 1e6 * (1 - 1e-6)),
    ],
    ids=repr,
)
def test_lobes_about_one_axis_have_closed_forms(first, second, expected):
    assert inner_product(first, second, 0.0) == pytest.approx(expected, rel=1e-13, abs=0)


@pytest.mark.parametrize("sharpness", [1e-5, 2.0, 100.0])
def test_opposite_gaussians_of_one_sharpness_have_a_constant_product(sharpness):
    expected = 4 * np.pi * np.exp(-2 * sharpness)
    found = inner_product(Gaussian(sharpness), Gaussian(sharpness), np.pi)
    assert found == pytest.approx(expected, rel=1e-12, abs=0)


@pytest.mark.parametrize("a", [1e-2, 1e-4, pytest.param(1e-6)])
def test_two_tiny_discs_share_the_area_of_a_flat_lens(a):
    for g in (0.5 * a, a, 1.5 * a):
        flat = 2 * a * a * np.arccos(g / (2 * a)) - g / 2 * np.sqrt(4 * a * a - g * g)
        # the sphere bends by a**2; what is left are roundings
        assert inner_product(Disc(a), Disc(a), g) == pytest.approx(flat, rel=a * a + 1e-10, abs=0)


@pytest.mark.parametrize("height", [1e-2, 1e-4, pytest.param(1e-8)])
def test_a_narrow_linear_lobe_keeps_the_digits_of_its_norm(height):
    lobe = ClampedLinear(1, 1 - height)
    expected = 2 * np.pi / 3 * (1 - lobe.offset) ** 3
    assert inner_product(lobe, lobe, 0.0) == pytest.approx(expected, rel=1e-12, abs=0)
