"""The glossy kernel: its factors against 25 digits, against SciPy's integrals, and what the field knows of it."""

import numpy as np
import pytest
from harmonics.independent import HARD_CASES
from numpy.testing import assert_allclose, assert_array_equal
from places import kernels
from scipy.integrate import quad
from scipy.special import eval_legendre

from shviewer.harmonics.filters import irradiance_factors
from shviewer.harmonics.quantities.glossy import Glossy, glossy_factors
from shviewer.harmonics.quantities.kernels import kernel_of
from shviewer.harmonics.quantities.names import in_words, quantity_of, roughness_of

REFERENCE = kernels()["A"]
ROUGHNESS = [0.1, 0.2, 0.3, 0.5, 0.7, 0.9]


@pytest.mark.parametrize("roughness", REFERENCE["factors"])
@pytest.mark.parametrize("n_bands", [33, 129, 512])
def test_factors_agree_with_twenty_five_digits(roughness, n_bands):
    wanted = [float(value) for value in REFERENCE["factors"][roughness]["f"]]
    assert_allclose(glossy_factors(float(roughness), n_bands)[: len(wanted)], wanted, rtol=0, atol=1e-15)


@pytest.mark.parametrize("roughness", [0.15, 0.4, 0.63, 0.97, 0.9999])
def test_factors_are_the_integrals_of_the_kernel(roughness):
    kernel = Glossy(roughness)
    found = glossy_factors(roughness, 512)

    def integrand(t, l):
        return 2 * np.pi * kernel.peak * kernel.value(4 * np.sin(t / 2) ** 2) * eval_legendre(l, np.cos(t)) * np.sin(t)

    for l in (0, 1, 2, 3, 17, 60):
        pieces = [(0, roughness**2), (roughness**2, 4 * roughness**2), (4 * roughness**2, np.pi / 2)]
        pieces = [(min(a, np.pi / 2), min(b, np.pi / 2)) for a, b in pieces]
        wanted = sum(quad(integrand, *piece, args=(l,), epsabs=1e-13, epsrel=0, limit=400)[0] for piece in pieces)
        assert found[l] == pytest.approx(wanted, rel=0, abs=1e-12)


def test_roughness_1_is_irradiance_over_pi():
    assert_allclose(glossy_factors(1.0, 512), irradiance_factors(512) / np.pi, rtol=0, atol=1e-13)


def test_a_smooth_surface_is_a_mirror():
    roughness = np.array([0.02, 0.04])
    lost = np.array([1 - glossy_factors(r, 64)[1] for r in roughness])
    a = roughness**4
    assert_allclose(lost, 2 * a * (np.log(1 / (2 * a)) - 2), rtol=1e-3)  # the next term is a^2 ln(1/a)
    assert glossy_factors(0.02, 64)[63] == pytest.approx(1, abs=0.02)


@pytest.mark.parametrize("roughness", ROUGHNESS)
def test_the_energy_of_the_kernel_is_that_of_its_bands(roughness):
    l = np.arange(1024)
    energy = ((2 * l + 1) / (4 * np.pi) * glossy_factors(roughness, 1024) ** 2).sum()
    wanted = REFERENCE["delta"][str(roughness)]["total_energy"]
    assert Glossy(roughness).energy == pytest.approx(wanted, rel=1e-12)
    assert energy == pytest.approx(wanted, rel=1e-9)  # bands beyond, of the kink at the horizon


@pytest.mark.parametrize("roughness", ROUGHNESS)
def test_bands_that_a_point_light_needs_are_the_published_ones(roughness):
    reference = REFERENCE["delta"][str(roughness)]
    l = np.arange(512)
    bands = (2 * l + 1) / (4 * np.pi) * glossy_factors(roughness, 512) ** 2
    left = np.sqrt(np.maximum(1 - np.cumsum(bands) / Glossy(roughness).energy, 0))
    for tolerance, count in reference["l2"].items():
        assert int((left <= float(tolerance)).argmax()) + 1 == count
    for count, error in reference["rel_at"].items():
        assert left[int(count) - 1] == pytest.approx(error, abs=1e-7)  # of a difference of two energies


def test_the_kernel_is_a_profile_and_its_derivatives_are_those_of_its_values():
    for roughness in (0.2, 0.6, 1.0):
        kernel = Glossy(roughness)
        angle = np.linspace(0, 1.5, 9001)
        value, slope, bend, fourth = kernel.along(angle)
        step = angle[1]
        assert_array_equal(value, kernel.value(4 * np.sin(angle / 2) ** 2))
        assert_allclose(np.gradient(value, step)[1:-1], slope[1:-1], rtol=0, atol=1e-4 * np.abs(slope).max())
        assert_allclose(np.gradient(slope, step)[1:-1], bend[1:-1], rtol=0, atol=1e-4 * np.abs(bend).max())
        seen = np.abs(np.gradient(np.gradient(bend, step), step))[2:-2]
        assert (seen <= 1.001 * fourth[2:-2]).all()
        assert (np.diff(value) <= 0).all()
        assert kernel.zonal(3)[0] * kernel.peak == pytest.approx(1, rel=1e-14)


def test_a_kernel_has_the_bands_that_it_needs():
    assert [kernel_of(f"glossy:{r}").bands for r in (1, 0.25, 0.2, 0.15, 0.1)] == [128, 128, 193, 343, 512]
    assert [kernel_of(name).bands for name in ("radiance", "irradiance")] == [128, 128]
    for r in (0.1, 0.15, 0.2, 0.25, 0.6, 1.0):
        kernel = kernel_of(f"glossy:{r}")
        assert np.abs(kernel.factors(1024)[kernel.bands :]).max() <= kernel.beyond(kernel.bands) * (1 + 1e-9)


def test_quantities_have_one_name_each():
    names = {"glossy:0.40": "glossy:0.4", "glossy:1": "glossy:1", "glossy:1e-1": "glossy:0.1", "glossy:0": "radiance"}
    assert {name: quantity_of(name) for name in names} == names
    assert [roughness_of(name) for name in ("radiance", "irradiance", "glossy:0.4")] == [None, None, 0.4]
    assert [in_words(name) for name in ("irradiance", "glossy:0.4")] == ["irradiance", "roughness 0.4"]
    assert kernel_of("glossy:0.40") == kernel_of("glossy:0.4")


def test_a_roughness_that_was_left_out_is_asked_for():
    with pytest.raises(ValueError, match=r"^'glossy': did you mean glossy:0\.4\?"):
        quantity_of("glossy")


@pytest.mark.parametrize("name", ["glossy:0.05", "glossy:1.01", "glossy:-0.3", "glossy:nan", "glossy:", "matte"])
def test_a_quantity_that_there_is_not_is_refused_with_the_rule(name):
    with pytest.raises(ValueError, match=rf"^'{name}': it must be radiance, .* R of 0.1 to 1"):
        quantity_of(name)


def test_a_roughness_that_is_not_said_is_asked_for():
    with pytest.raises(ValueError, match=r"^'glossy': did you mean glossy:0\.4\?$"):
        quantity_of("glossy")


def test_the_clamped_cosine_of_the_reference_is_ours():
    wanted = [float(value) for value in HARD_CASES["irradiance"]["A_l"]]
    assert_allclose(kernel_of("irradiance").factors(len(wanted)), wanted, rtol=1e-15, atol=1e-16)
