"""What shviewer.lights.analytic.lobes promises: a sum of lobes whose coefficients, norm and radiance belong together."""

import numpy as np
import pytest
from harmonics.independent import HARD_CASES, random_directions, scipy_basis, sphere_rule
from numpy.testing import assert_allclose, assert_array_equal

from shviewer.harmonics.synthesis import Synthesis
from shviewer.harmonics.zonal import ClampedLinear, Constant, Disc, Gaussian
from shviewer.lights.analytic.lobe import Lobe
from shviewer.lights.analytic.lobes import MAX_LOBES, LobeLight

Z = np.array([0, 0, 1.0])
SMOOTH = LobeLight(
    (
        Lobe(Gaussian(6), np.array([1.0, 2.0, -1.0]), np.array([1.0, 0.5, 0.0])),
        Lobe(Gaussian(4), np.array([1.0, 2.0, 0.0]), np.array([-0.7, 0.5, 2.0])),
        Lobe(ClampedLinear(0.5, -2), Z, np.array([0.1, 0.2, 0.3])),
        Lobe(Constant(), Z, np.array([0.3, -0.2, 0.1])),
    )
)


def test_radiance_is_the_sum_of_the_lobes():
    light = LobeLight(
        (
            Lobe(ClampedLinear(5, 4), Z, np.array([1.0, 2.0, 3.0])),
            Lobe(Disc(0.5), np.array([0, 1.0, 0]), np.array([10.0, 0, 0])),
            Lobe(Gaussian(3), np.array([1.0, 0, 0]), np.array([0, 0, -1.0])),
        )
    )
    d = random_directions(500)
    x, y, z = d.T[:, :, None]
    expected = np.maximum(0, 5 * z - 4) * [1, 2, 3]
    expected = expected + (y >= np.cos(0.5)) * [10, 0, 0] + np.exp(3 * (x - 1)) * [0, 0, -1]
    assert_allclose(light.radiance(d), expected, rtol=0, atol=1e-14)


def test_a_smooth_light_is_the_synthesis_of_its_coefficients():
    d = random_directions(300, seed=1)
    found = Synthesis(SMOOTH.coefficients(40)).at(np.arccos(d[:, 2]), np.arctan2(d[:, 1], d[:, 0]))
    assert_allclose(found, SMOOTH.radiance(d), rtol=0, atol=1e-13)


def test_coefficients_are_the_integrals_of_the_radiance():
    directions, weights = sphere_rule(40)
    expected = scipy_basis(directions, 8).T @ (SMOOTH.radiance(directions) * weights[:, None])
    assert_allclose(SMOOTH.coefficients(8), expected, rtol=0, atol=1e-13)


def test_the_norm_is_the_integral_of_the_squared_radiance_overlaps_included():
    directions, weights = sphere_rule(40)
    assert_allclose(SMOOTH.products().diagonal(), weights @ SMOOTH.radiance(directions) ** 2, rtol=1e-13, atol=0)


def test_the_norm_is_the_limit_of_the_sum_of_squared_coefficients():
    assert_allclose((SMOOTH.coefficients(40) ** 2).sum(axis=0), SMOOTH.products().diagonal(), rtol=1e-13, atol=0)
    kinked = LobeLight(
        (
            Lobe(ClampedLinear(), Z, np.ones(3)),
            Lobe(ClampedLinear(3, 1), np.array([1.0, 1, 1]), np.array([1.0, -2, 0.5])),
        )
    )
    share = (kinked.coefficients(200) ** 2).sum(axis=0) / kinked.products().diagonal()
    assert (share < 1).all()
    assert (share > 1 - 1e-6).all()  # l**-4 is left out per degree: l**-3 in all


def test_greens_light_has_its_published_norm_and_coefficients():
    green = HARD_CASES["lights"]["green"]
    light = LobeLight(
        (
            Lobe(ClampedLinear(5, 4), Z, np.ones(3)),
            Lobe(ClampedLinear(4, 3), np.array([np.cos(2.5), np.sin(2.5), 0]), np.ones(3)),
        )
    )
    assert_allclose(light.products().diagonal(), np.full(3, 0.3 * np.pi), rtol=1e-14, atol=0)
    expected = np.array([float(value) for value in green["coefficients_n4"]])
    assert_allclose(light.coefficients(4), np.repeat(expected[:, None], 3, axis=1), rtol=0, atol=1e-15)


def test_the_sun_in_its_sky_has_its_published_norm_and_flux():
    sun = HARD_CASES["lights"]["sun+sky"]
    light = LobeLight(
        (
            Lobe(Constant(), Z, np.full(3, 1e3)),
            Lobe(Disc(np.radians(0.265)), np.array([0.48, -0.6, 0.64]), np.full(3, 1.599999e9)),
        )
    )
    assert_allclose(light.products().diagonal(), np.full(3, float(sun["norm2"])), rtol=1e-14, atol=0)
    assert_allclose(light.coefficients(1)[0], np.full(3, float(sun["c00"])), rtol=1e-14, atol=0)


def test_a_lobe_and_its_negative_cancel_to_black():
    for profile in (Gaussian(9), ClampedLinear(3, 1), Disc(0.4)):
        light = LobeLight((Lobe(profile, Z, np.ones(3)), Lobe(profile, Z, -np.ones(3))))
        assert_allclose(light.products().diagonal(), np.zeros(3), rtol=0, atol=1e-15)
        assert (light.products().diagonal() >= 0).all()
        assert_array_equal(light.coefficients(9), np.zeros((81, 3)))


def test_three_channels_are_three_lights():
    grey = LobeLight((Lobe(Gaussian(5), Z, np.ones(3)), Lobe(Disc(1.0), np.array([1.0, 0, 0]), np.full(3, 2.0))))
    red = LobeLight(tuple(Lobe(lobe.profile, lobe.axis, lobe.radiance * [1, 0, 0]) for lobe in grey.lobes))
    assert_array_equal(red.coefficients(6), grey.coefficients(6) * [1, 0, 0])
    assert_allclose(red.products().diagonal(), grey.products().diagonal() * [1, 0, 0], rtol=1e-15, atol=0)


@pytest.mark.parametrize("length", [1e-300, 1e-3, 5.0, 1e300])
def test_an_axis_of_any_length_is_made_unit(length):
    assert_allclose(Lobe(Constant(), np.array([0, -length, 0]), np.ones(3)).axis, [0, -1, 0], rtol=0, atol=1e-15)


def test_a_lobe_without_direction_is_refused():
    with pytest.raises(ValueError, match="must be finite and not zero"):
        Lobe(Gaussian(3), np.zeros(3), np.ones(3))


def test_one_radiance_is_grey():
    assert Lobe(Constant(), Z, 2.5).radiance.tolist() == [2.5, 2.5, 2.5]


@pytest.mark.parametrize("count", [0, MAX_LOBES + 1])
def test_no_lobe_or_more_than_the_shader_holds_are_refused(count):
    with pytest.raises(ValueError, match=f"^{count} lobes: there must be 1 to 64$"):
        LobeLight((Lobe(Constant(), Z, np.ones(3)),) * count)


def test_sixty_four_equal_lobes_are_one_of_their_sum():
    lobe = Lobe(ClampedLinear(2, 1), np.array([1.0, 2, 3]), np.array([1.0, 2, 3]))
    many = LobeLight(tuple(Lobe(lobe.profile, lobe.axis, lobe.radiance) for _ in range(64)))
    one = LobeLight((Lobe(lobe.profile, lobe.axis, lobe.radiance * 64),))
    assert_allclose(many.coefficients(5), one.coefficients(5), rtol=0, atol=1e-12)
    assert_allclose(many.products().diagonal(), one.products().diagonal(), rtol=1e-13, atol=0)


def test_landmarks_are_the_axes_and_there_is_no_map():
    expected = np.array([[1, 2, -1], [1, 2, 0], [0, 0, 1], [0, 0, 1]]) / np.sqrt([[6], [5], [1], [1]])
    assert_allclose(SMOOTH.landmarks(), expected, rtol=0, atol=1e-15)
    assert SMOOTH.map is None


def test_a_light_is_its_own_key():
    assert len({SMOOTH: 1, LobeLight(SMOOTH.lobes): 2}) == 2
