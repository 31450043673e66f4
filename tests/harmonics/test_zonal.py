"""What shviewer.harmonics.zonal promises: closed forms that are the integrals they stand for, to rounding."""

import re

import mpmath
import numpy as np
import pytest
from harmonics.independent import HARD_CASES, cap_rule, scipy_basis
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import quad
from scipy.special import eval_gegenbauer, eval_legendre

from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian, gegenbauer_ratios, orient

LIGHTS = HARD_CASES["lights"]
PROFILES = [
    Constant(),
    ClampedLinear(),
    ClampedLinear(5, 4),
    ClampedLinear(2, -1.2),
    ClampedLinear(0.5, -3),
    Disc(0.3),
    Disc(2.4),
    Disc(np.pi),
    Gaussian(1e-3),
    Gaussian(3),
    Gaussian(500),
]


def lambdas(listed):
    """The JSON's coefficients c(l, 0) of a lobe about z as lambda(l)."""
    zonal = np.array([float(value) for value in listed])
    return zonal / np.sqrt((2 * np.arange(len(zonal)) + 1) / (4 * np.pi))


@pytest.mark.parametrize(
    ("profile", "listed"),
    [
        (ClampedLinear(5, 4), LIGHTS["green"]["zonal_lobe_z"]),
        (ClampedLinear(4, 3), LIGHTS["green"]["zonal_lobe_a"]),
        (Disc(np.pi / 2), LIGHTS["hemisphere"]["zonal"]),
    ],
)
def test_wide_lobes_agree_with_eighty_digits(profile, listed):
    expected = lambdas(listed)
    # a rounding or two per degree of the recurrence, of the largest
    assert_allclose(profile.zonal(17), expected, rtol=0, atol=17 * 2.0**-52 * expected[0])


def test_the_clamped_cosine_has_the_irradiance_factors():
    expected = [float(value) for value in HARD_CASES["irradiance"]["A_l"]]
    assert_allclose(ClampedLinear(1, 0).zonal(17), expected, rtol=0, atol=4 * 2.0**-52)
    assert_array_equal(ClampedLinear(1, 0).zonal(64)[3::2], np.zeros(31))


@pytest.mark.parametrize("profile", PROFILES, ids=repr)
def test_zonal_coefficients_are_the_integral_over_the_profile(profile):
    def integrand(t, l):
        return 2 * np.pi * profile.value(4 * np.sin(t / 2) ** 2) * eval_legendre(l, np.cos(t)) * np.sin(t)

    found = profile.zonal(21)
    reach = min(profile.half_angle, 12 / np.sqrt(profile.sharpness) if isinstance(profile, Gaussian) else np.pi, np.pi)
    for l in range(21):
        # exp(-72) lies beyond the reach of a Gaussian; the integral itself is asked for to 1e-13
        expected, _ = quad(integrand, 0, reach, args=(l,), epsabs=1e-13 * found[0], epsrel=0, limit=200)
        assert found[l] == pytest.approx(expected, rel=0, abs=2e-13 * found[0])


@pytest.mark.parametrize("sharpness", [1e-6, 1e-3, 0.1, 3.0, 500.0, 1e5, 1e7, 1e8, 1e9])
def test_gaussians_agree_with_mpmath_from_almost_constant_to_almost_a_delta(sharpness):
    with mpmath.workdps(60):
        k = mpmath.mpf(sharpness)
        expected = [
            4 * mpmath.pi * mpmath.exp(-k) * mpmath.sqrt(mpmath.pi / (2 * k)) * mpmath.besseli(l + mpmath.mpf(1) / 2, k)
            for l in (0, 1, 2, 3, 10, 60)
        ]
        found = Gaussian(sharpness).zonal(61)[[0, 1, 2, 3, 10, 60]]
        # a ratio per degree, each good to a rounding or two
        assert_allclose(found, np.array(expected, dtype=float), rtol=3e-14, atol=0)


def test_a_gaussian_sharper_than_any_other_is_a_delta_times_its_weight():
    for sharpness in (1e12, 1e15):
        assert_allclose(Gaussian(sharpness).zonal(8), np.full(8, 2 * np.pi / sharpness), rtol=1e-10, atol=0)


def test_a_disc_of_180_degrees_is_constant():
    assert_allclose(Disc(np.pi).zonal(30), Constant().zonal(30), rtol=0, atol=1e-14)
    assert_array_equal(Constant().zonal(5), [4 * np.pi, 0, 0, 0, 0])


def test_a_linear_profile_that_is_nowhere_clamped_has_two_bands():
    expected = [4 * np.pi * 3, 4 * np.pi / 3 * 2, 0, 0]
    assert_allclose(ClampedLinear(2, -3).zonal(4), expected, rtol=1e-15, atol=0)
    almost = ClampedLinear(2, np.nextafter(-2.0, 0)).zonal(6)
    assert_allclose(almost, ClampedLinear(2, -2).zonal(6), rtol=0, atol=1e-14)


@pytest.mark.parametrize("profile", PROFILES, ids=repr)
def test_fewer_bands_are_the_first_of_more(profile):
    for n_bands in (1, 2, 3, 7):
        assert_allclose(profile.zonal(n_bands), profile.zonal(20)[:n_bands], rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("profile", PROFILES, ids=repr)
def test_more_than_1400_bands_of_a_lobe_are_refused(profile):
    for n_bands in (0, 1401):
        with pytest.raises(ValueError, match=f"{n_bands} bands: there must be 1 to 1400"):
            profile.zonal(n_bands)


@pytest.mark.parametrize(
    ("profile", "function"),
    [
        (Constant(), lambda x: np.ones_like(x)),
        (ClampedLinear(5, 4), lambda x: np.maximum(0, 5 * x - 4)),
        (ClampedLinear(2, -1.2), lambda x: np.maximum(0, 2 * x + 1.2)),
        (Disc(0.7), lambda x: (x >= np.cos(0.7)).astype(float)),
        (Disc(2.0), lambda x: (x >= np.cos(2.0)).astype(float)),
        (Gaussian(7), lambda x: np.exp(7 * (x - 1))),
    ],
    ids=lambda value: None if callable(value) else repr(value),  # an address would differ between processes
)
def test_values_are_those_of_the_formula_in_the_cosine(profile, function):
    x = np.linspace(-1, 1, 401).reshape(1, 401)
    values = profile.value(2 * (1 - x))
    assert values.shape == (1, 401)
    assert values.dtype == np.float64
    assert_allclose(values, function(x), rtol=0, atol=1e-14)
    beyond = x < np.cos(profile.half_angle) - 1e-12
    assert_array_equal(values[beyond], np.zeros(beyond.sum()))
    inside = (x > np.cos(profile.half_angle) + 1e-12) & (x <= 1)
    assert (values[inside] > 0).all()


def test_half_angles_are_where_the_profile_ends():
    assert ClampedLinear().half_angle == pytest.approx(np.pi / 2, rel=1e-15, abs=0)
    assert ClampedLinear(4, 2).half_angle == pytest.approx(np.pi / 3, rel=1e-15, abs=0)
    assert ClampedLinear(1, -5).half_angle == np.pi
    assert Disc(0.3).half_angle == 0.3
    assert Gaussian(9).half_angle == Constant().half_angle == np.pi


@pytest.mark.parametrize("half_angle", [1e-9, 1e-3, 0.5])
def test_a_disc_ends_at_its_half_angle_however_small(half_angle):
    chord = (2 * np.sin(half_angle * np.array([0.999, 1.001]) / 2)) ** 2
    assert Disc(half_angle).value(chord).tolist() == [1, 0]


@pytest.mark.parametrize(
    ("slope", "offset"),
    [(0, -1), (-1, -2), (1, 1), (1, 2), (np.inf, 0), (np.nan, 0), (1, np.nan), (1, -np.inf), (1, np.inf)],
)
def test_a_linear_profile_that_is_nowhere_positive_is_refused(slope, offset):
    rule = f"slope {slope:g}, offset {offset:g}: the slope must be positive, above the offset, and neither beyond 1e+15"
    with pytest.raises(ValueError, match=f"^{re.escape(rule)}$"):
        ClampedLinear(slope, offset)


@pytest.mark.parametrize("degrees", [0, -5, 180.5, np.nan, np.inf])
def test_a_disc_outside_0_to_180_degrees_is_refused(degrees):
    rule = f"half angle {degrees:g} degrees: it must be above 0 and at most 180"
    with pytest.raises(ValueError, match=f"^{re.escape(rule)}$"):
        Disc(float(np.radians(degrees)))


@pytest.mark.parametrize("sharpness", [0, -2, np.nan, np.inf])
def test_a_gaussian_that_is_not_sharp_is_refused(sharpness):
    with pytest.raises(ValueError, match=f"^sharpness {sharpness:g}: it must be 1e-15 to 1e\\+15$"):
        Gaussian(sharpness)


@pytest.mark.parametrize("profile", [ClampedLinear(5, 4), ClampedLinear(2, -1.2), Disc(0.3), Disc(2.4), Gaussian(3)])
def test_a_lobe_about_any_axis_has_the_coefficients_of_its_integral(profile):
    axis = np.array([0.48, -0.6, 0.64])
    directions, weights = cap_rule(axis, profile.half_angle, 40)
    values = profile.value(((directions - axis) ** 2).sum(axis=1).clip(max=4 * np.sin(profile.half_angle / 2) ** 2))
    expected = scipy_basis(directions, 10).T @ (values * weights)
    assert_allclose(orient(profile.zonal(10), axis), expected, rtol=0, atol=1e-13)


def test_a_lobe_along_z_has_order_zero_only():
    zonal = np.array([1.0, 2.0, 3.0])
    expected = np.zeros(9)
    expected[[0, 2, 6]] = zonal * np.sqrt(np.array([1, 3, 5]) / (4 * np.pi))
    assert_allclose(orient(zonal, np.array([0, 0, 2.5])), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize("m", [0, 1, 2, 5])
@pytest.mark.parametrize("z", [-1.0, -0.9, -0.2, 0.0, 0.3, 0.99, 1.0])
def test_gegenbauer_ratios_are_gegenbauer_polynomials_over_their_value_at_one(m, z):
    l = np.arange(m, 30)
    expected = eval_gegenbauer(l - m, m + 0.5, z) / eval_gegenbauer(l - m, m + 0.5, 1.0)
    found = gegenbauer_ratios(z, 1 - z, m, 30)
    assert_allclose(found[m:], expected, rtol=0, atol=2e-14)  # SciPy's recurrence, some ten roundings
    assert_array_equal(found[:m], np.zeros(m))
