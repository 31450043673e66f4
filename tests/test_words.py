"""How numbers, shares, angles, times and counts read. Percent and radiance beside figures: tests/viewer/overlay."""

from __future__ import annotations

import pytest

from shviewer.words import (
    all_of,
    brief_percent,
    counted,
    grouped,
    grouped_number,
    meant,
    shortened,
    theta_phi_degrees,
)


@pytest.mark.parametrize(
    ("said", "reads"),
    [
        (counted(1, "band"), "1 band"),
        (counted(0, "band"), "0 bands"),
        (counted(25, "coefficient"), "25 coefficients"),
        (brief_percent(1.04), "104 %"),
        (brief_percent(0.0144), "1.4 %"),
        (brief_percent(1e-6), "0.0001 %"),
        (grouped(1_000_000), "1 000 000"),
        (grouped_number(3.14159), "3.14"),
        (grouped_number(31415.9), "31 416"),
        (shortened("environment-of-noon", 12), "envir...noon"),
        (shortened("noon", 12), "noon"),
    ],
)
def test_a_number_reads_as_it_should(said: str, reads: str) -> None:
    assert said == reads


@pytest.mark.parametrize(
    ("direction", "theta", "phi"),
    [((0, 0, 2), 0, 0), ((0, 0, -1), 180, 0), ((3, 0, 0), 90, 0), ((0, 1, 0), 90, 90), ((-1, -1, 0), 90, -135)],
)
def test_theta_is_from_z_and_phi_from_x_towards_y(direction: tuple[int, int, int], theta: float, phi: float) -> None:
    assert theta_phi_degrees(direction) == pytest.approx((theta, phi))


def test_an_azimuth_is_no_negative_zero() -> None:
    assert str(theta_phi_degrees((1.0, -0.0, 0.0))[1]) == "0.0"


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        *(
            ("Three", "three?"),
            ("threejs", "three?"),
            ("three.js", "three?"),
            ("Unity 3D", "unity?"),
            ("tree", "three?"),
        ),
        *(("mirrorball", "mirror-ball?"), ("ARKit", "arkit-phase or arkit-no-phase?"), ("sined", "signed?")),
    ],
)
def test_a_word_that_is_nearly_a_choice_is_asked_for(text: str, advice: str) -> None:
    choices = ("three", "unity", "unreal", "mirror-ball", "arkit-phase", "arkit-no-phase", "signed")
    assert meant(text, choices) == f"did you mean {advice}"
    for other in ("", "xyz", "12", "blender"):
        assert meant(other, choices) == f"it must be one of {', '.join(choices)}"
        assert meant(other, choices, "none") == "none"


def test_words_in_a_row_end_on_an_and() -> None:
    said = [all_of(list("abc")[:count]) for count in range(4)]
    assert said == ["", "a", "a and b", "a, b and c"]
