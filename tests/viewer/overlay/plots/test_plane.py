"""Time against error: points stand where the axes say, the present choice is marked, and it is there where the curve is."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from helpers import centre, frame_of
from viewer.overlay.collisions import faults
from viewer.overlay.written import image_of, pieces_of, texts_of

from shviewer import api
from shviewer.analysis import projections
from shviewer.analysis.cache import MEMORY, MOST_LIGHTS
from shviewer.analysis.projections import BEST, Measurement, Way, measurements, project
from shviewer.analysis.recipe import Recipe
from shviewer.analysis.subjects import load_light
from shviewer.harmonics.metrics import errors_by_band_count
from shviewer.lights.coefficient_light import CoefficientLight
from shviewer.lights.find import find_light
from shviewer.lights.function import FunctionLight
from shviewer.lights.light import Light
from shviewer.limits import MAX_BANDS, MAX_DIRECT_BANDS
from shviewer.viewer.composing.composition import compose
from shviewer.viewer.overlay.inks import ACCENT
from shviewer.viewer.overlay.overlay import Overlay, draw_overlay
from shviewer.viewer.overlay.pieces import Disc
from shviewer.viewer.overlay.plots import plane
from shviewer.viewer.overlay.plots.log_axis import Axis
from shviewer.viewer.overlay.plots.plane import LEAST, LOOKS, Plane, measured, plane_of
from shviewer.viewer.picture import Picture, prepare, stages
from shviewer.viewer.state import changed, state_of
from shviewer.words import grouped_number, percent

SIZES = [
    (400, 300), (640, 320), (700, 400), (800, 800), (1280, 640), (1920, 1080), (2560, 1280), (900, 1200),
    (3000, 500),
]  # fmt: skip
COUNTS = (625, 2_500, 10_000, 40_000, 160_000)


pytestmark = pytest.mark.usefixtures("fresh_memory")


@pytest.fixture
def steady(monkeypatch: pytest.MonkeyPatch) -> None:
    """What was measured, but with times that no machine and no load changes: a start and so much per sample."""

    def timed(light: Light, n_bands: int) -> tuple[Measurement, ...]:
        slowness = {"best": (0.5, 0.0), "jittered": (0.3, 6e-4), "gauss-legendre": (0.2, 3e-4)}
        return tuple(
            replace(
                found, milliseconds=slowness[found.way.method][0] + slowness[found.way.method][1] * found.way.samples
            )
            for found in measurements(light, n_bands)
        )

    monkeypatch.setattr(plane, "measurements", timed)


def shown(**changes: object) -> Picture:
    return prepare(state_of(**{"n_bands": 15, "sheet": "plane", **changes}))


def session(counts: tuple[int, ...] = COUNTS, **changes: object) -> Picture:
    """The last of these projections, all of which were made."""
    for method in ("gauss-legendre", "jittered"):
        for samples in counts:
            last = shown(method=method, samples=samples, **changes)
    return last


def drawn_of(picture: Picture, size: tuple[int, int] = (1280, 640)) -> tuple[Overlay, Plane]:
    at = compose(*size)
    found = plane_of(picture, at)
    assert found is not None
    return draw_overlay(picture, at), found


def made_up(errors: dict[Way, tuple[float, float]]) -> tuple[Measurement, ...]:
    """Measurements of (milliseconds, error), the same for every number of bands."""
    return tuple(
        Measurement(key, key.method, time, 1, np.full(MAX_DIRECT_BANDS, error)) for key, (time, error) in errors.items()
    )


# --- what is measured


def test_every_way_to_project_the_light_is_remembered_with_its_time_and_error() -> None:
    picture = session()
    known = {found.way: found for found in measured(picture)}
    assert set(known) == {BEST, *(Way(method, count) for method in ("jittered", "gauss-legendre") for count in COUNTS)}
    for (method, samples, *_), found in known.items():
        again = shown(method=method, samples=samples if samples else 10_000)
        assert found.milliseconds == again.projection.milliseconds
        assert found.errors[14] == pytest.approx(again.figures.relative_l2, rel=1e-12)
        assert found.words == again.projection.method


def test_a_measurement_outlives_its_projection_and_a_repetition_keeps_the_fastest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The clock says 3, 1 and 2 ms; in between enough is projected for the first to be forgotten."""
    light = find_light("green")
    seen = []
    for milliseconds in (3, 1, 2):
        ticks = iter((0.0, milliseconds / 1000))
        with monkeypatch.context() as patched:
            project(light, BEST, 8)
            patched.setattr(projections, "perf_counter", lambda ticks=ticks: next(ticks))
            project(light, Way("jittered", 100, 0), 8)
        found = next(found for found in measurements(light, 8) if found.way.samples == 100)
        seen.append((found.milliseconds, found.repetitions))
        for samples in range(200, 240):
            project(light, Way("jittered", samples, 0), 8)
        assert found in measurements(light, 8)
    assert seen == [(3, 1), (1, 2), (1, 3)]


def test_what_was_only_looked_up_is_no_repetition() -> None:
    light = find_light("green")
    for _ in range(3):
        project(light, Way("jittered", 100, 0), 8)
    assert [found.repetitions for found in measurements(light, 8)] == [1, 1]


def test_the_measurements_used_longest_ago_are_forgotten_and_never_the_best_or_the_present(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(projections, "MOST_MEASUREMENTS", 20)
    light = find_light("green")
    for samples in range(100, 140):
        project(light, Way("jittered", samples, 0), 4)
        known = [found.way for found in measurements(light, 4)]
        assert len(known) <= 20
        assert {BEST, Way("jittered", samples, 0)} <= set(known)
    assert Way("jittered", 119, 0) not in known


def test_the_irradiance_takes_the_time_of_the_lights_own_samples_and_has_errors_of_its_own() -> None:
    light = find_light("green")
    for _ in range(2):
        projections._measured_projection.cache_clear()
        project(light, Way("jittered", 500, 0), 8)
    project(light.irradiance(), Way("jittered", 500, 0), 8)
    (_, radiance), (_, irradiance) = (measurements(of, 8) for of in (light, light.irradiance()))
    assert (irradiance.milliseconds, irradiance.repetitions) == (radiance.milliseconds, 2)
    assert irradiance.errors[4] < radiance.errors[4] / 5


@pytest.mark.parametrize("method", ["best", "jittered"])
def test_an_irradiance_has_the_time_that_its_light_took(method: str) -> None:
    """What the cache takes to multiply coefficients by factors is no time to project them."""
    for name in ("green", "venice_sunset", "film_studio"):
        radiance, irradiance = (shown(light=name, method=method, quantity=of) for of in ("radiance", "irradiance"))
        assert irradiance.projection.milliseconds == radiance.projection.milliseconds
        assert [(found.way, found.milliseconds) for found in measured(irradiance)] == [
            (found.way, found.milliseconds) for found in measured(radiance)
        ]


@pytest.mark.parametrize("make", [lambda: find_light("film_studio"), lambda: FunctionLight(lambda d: 1 + d[:, 2])])
def test_coefficients_that_a_light_has_kept_have_the_time_that_was_measured_or_none(make: Callable[[], Light]) -> None:
    light = make()
    many = project(light, BEST, 128)
    assert project(light, BEST, 32).milliseconds is None  # the first rows of what is there
    assert measurements(light, 32) == ()
    for _ in range(2):
        projections._measured_projection.cache_clear()
        assert project(light, BEST, 128).milliseconds == many.milliseconds
    assert [found.repetitions for found in measurements(light, 128)] == [1]


def test_what_a_light_leaves_without_its_sun_has_measurements_of_its_own() -> None:
    """One of 96 % and 20 % of error stood for the other."""
    for split_sun in (False, True, False):
        picture = shown(light="venice_sunset", n_bands=9, method="jittered", split_sun=split_sun)
        found = next(found for found in measured(picture) if found.way.method == "jittered")
        assert found.errors[8] == pytest.approx(picture.figures.relative_l2, rel=1e-12)


def test_what_was_not_projected_has_no_time(tmp_path: Path) -> None:
    written = tmp_path / "green.json"
    api.project("green", 4).save(written)
    picture = shown(light=str(written))
    assert picture.projection.milliseconds is None
    drawn = draw_overlay(picture, compose(1280, 640), timing=True)
    assert plane_of(picture, compose(1280, 640)) is None
    assert {"method", "message", "legend_radiance"} <= set(drawn.boxes)
    compared = shown(light="green", compare=CoefficientLight.read(written), n_bands=4)
    assert compared.projection.milliseconds is None
    assert {found.way for found in measured(compared)} == {BEST}


def test_times_of_32_and_of_128_bands_are_never_compared() -> None:
    few, many = shown(method="jittered", samples=500), shown(method="jittered", samples=500, n_bands=33)
    assert {len(found.errors) for found in measured(few)} == {MAX_DIRECT_BANDS}
    assert {len(found.errors) for found in measured(many)} == {MAX_BANDS}


def test_measurements_go_with_their_light() -> None:
    first = shown(method="jittered", samples=500)
    assert measured(first)
    for number in range(MOST_LIGHTS):
        load_light(Recipe(FunctionLight(lambda d: d[:, 2], str(number))))
        MEMORY.results(FunctionLight(lambda d: d[:, 2], str(number)), "anything")
    assert measured(first) == ()
    assert first.light not in MEMORY  # looking it up brings nothing back
    assert plane_of(first, compose(1280, 640)) is None


# --- axes


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.03, 300, [0.1, 1, 10, 100]),
        (0.6, 30, [1, 10]),
        (0.6, 9, [1, 2, 5]),
        (0.27, 0.6, [0.3, 0.4, 0.5, 0.6]),
        (1e-8, 20, [1e-8, 1e-6, 1e-4, 1e-2, 1]),
    ],
)
def test_ticks_are_round_and_few(low: float, high: float, ticks: list[float]) -> None:
    assert Axis(low, high, 0, 200).ticks(35) == pytest.approx(ticks, rel=1e-12)


@pytest.mark.parametrize("factor", [2.0, 2.5, 7.0, 30.0, 1e3, 1e9])
@pytest.mark.parametrize("low", np.geomspace(1e-4, 1e3, 29))
def test_every_axis_has_two_ticks_that_do_not_touch(low: float, factor: float) -> None:
    axis = Axis(low, low * factor, 300, 100)
    ticks = axis.ticks(16)
    assert len(ticks) >= 2
    assert all(abs(axis.at(one) - axis.at(two)) >= 16 for one, two in itertools.pairwise(ticks))


def test_points_stand_where_the_labels_of_the_axes_say_on_log_scales(monkeypatch: pytest.MonkeyPatch) -> None:
    """Read off as a person would: between the labels of 1 and 100 ms, and of 10 and 100 %; a label is centred to a pixel."""
    points = {BEST: (1.0, 0.05), Way("jittered", 625, 0): (3.0, 0.9), Way("jittered", 10_000, 0): (150.0, 0.07)}
    monkeypatch.setattr(plane, "measurements", lambda light, n_bands: made_up(points))
    drawn, found = drawn_of(shown(method="jittered"))
    times, shares = found.milliseconds.ticks(48), found.error.ticks(19.2)
    assert times == [1, 10, 100]
    assert shares == [0.1, 1]
    x = [centre(drawn.boxes[f"plane_time_{number}"])[0] for number in (0, 2)]
    y = [centre(drawn.boxes[f"plane_share_{number}"])[1] for number in (0, 1)]
    for key, (time, error) in points.items():
        place = found.places[key]
        assert place[0] == pytest.approx(x[0] + (x[1] - x[0]) * np.log10(time) / 2, abs=2)
        assert place[1] == pytest.approx(y[0] + (y[1] - y[0]) * np.log10(error / 0.1), abs=2)


@pytest.mark.usefixtures("steady")
def test_a_point_is_drawn_in_the_colour_of_its_method() -> None:
    drawn, found = drawn_of(session())
    others = [key for key in found.places if key != found.present]
    hidden = 0
    for key in others:
        x, y = found.places[key]
        hidden += tuple(image_of(drawn)[round(y), round(x)]) != LOOKS[key[0]][1]
    assert hidden <= 3  # behind a point in front
    assert len({shape for shape, _ in LOOKS.values()}) == len(LOOKS)


def test_errors_and_times_that_a_log_axis_cannot_show_are_kept_at_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    points = {BEST: (0.0, 0.0), Way("jittered", 10_000, 0): (1.0, 1e-12), Way("jittered", 16, 0): (1.0, np.inf)}
    monkeypatch.setattr(plane, "measurements", lambda light, n_bands: made_up(points))
    picture = shown(method="jittered")
    _, found = drawn_of(picture)
    assert set(found.places) == {BEST, Way("jittered", 10_000, 0)}
    assert found.floor == LEAST > picture.figures.floor
    assert found.places[BEST][1] == found.places[Way("jittered", 10_000, 0)][1]


# --- the floor, the front, the present choice


@pytest.mark.parametrize("n_bands", [1, 5, 15, 32])
def test_the_floor_is_the_error_that_the_metrics_give_for_the_best_way(n_bands: int) -> None:
    picture = session(n_bands=n_bands)
    _, found = drawn_of(picture)
    light = picture.light
    exact = light.coefficients(MAX_DIRECT_BANDS)
    assert found.floor == pytest.approx(errors_by_band_count(light.products(), exact, exact)[n_bands - 1], rel=1e-12)
    at_floor = found.error.at(found.floor)
    assert found.places[BEST][1] == at_floor
    assert all(y <= at_floor for _, y in found.places.values())


def test_the_front_is_drawn_as_steps_to_the_best_way(monkeypatch: pytest.MonkeyPatch) -> None:
    fast = Way("gauss-legendre", 625, 0)
    points = {BEST: (10.0, 0.05), fast: (1.0, 0.5), Way("jittered", 10_000, 0): (150.0, 0.07)}
    monkeypatch.setattr(plane, "measurements", lambda light, n_bands: made_up(points))
    drawn, found = drawn_of(shown(method="jittered"))
    assert found.front == [fast, BEST]
    (left, high), (right, low) = found.places[fast], found.places[BEST]
    lighter = image_of(drawn)[..., 0].astype(int) > 100
    assert lighter[round(high), round(left) + 30 : round(right) - 8].all()
    assert lighter[round(high) + 1 : round(low) - 10, round(right)].all()


@pytest.mark.usefixtures("steady")
@pytest.mark.parametrize("sampling", [("best", 10_000), ("jittered", 2_500), ("gauss-legendre", 40_000)])
def test_the_present_choice_has_a_ring_and_its_name_time_and_error(sampling: tuple[str, int]) -> None:
    session()
    picture = shown(method=sampling[0], samples=sampling[1])
    drawn, found = drawn_of(picture)
    assert found.present == (BEST if sampling[0] == "best" else Way(*sampling))
    assert centre(drawn.boxes["plane_present"]) == pytest.approx(found.places[found.present])
    ring = next(piece for piece in pieces_of(drawn) if isinstance(piece, Disc) and piece.name == "plane_present")
    assert ring.ink == ACCENT
    (said,) = (text.text.replace("\u202f", " ") for text in texts_of(drawn) if text.name == "plane_sentence")
    time = grouped_number(found.known[found.present].milliseconds)
    assert f"{time} ms for 32 bands" in said
    assert said.endswith(f"{percent(found.errors[found.present])} in 15")


def test_one_point_says_how_to_get_more() -> None:
    def said(picture: Picture) -> tuple[str, set[str]]:
        drawn, _ = drawn_of(picture)
        names = {text.name.removeprefix("plane_") for text in texts_of(drawn)}
        return next(text.text for text in texts_of(drawn) if text.name == "plane_sentence"), names & set(LOOKS)

    assert said(shown())[0].endswith("M changes the method, S the samples")
    assert said(shown())[1] == set()
    more, names = said(shown(method="jittered"))
    assert "M changes" not in more
    assert names == {"best", "jittered"}


# --- its place


@pytest.mark.usefixtures("steady")
@pytest.mark.parametrize("size", SIZES, ids=str)
def test_no_text_in_it_is_cut_or_covered(size: tuple[int, int]) -> None:
    session()
    states = {
        "green": {"method": "jittered"},
        "best": {},
        "irradiance": {"quantity": "irradiance", "n_bands": 3},
        "image": {"lights": ("venice_sunset",), "method": "gauss-legendre", "muted": frozenset({1}), "window": "hann"},
        "zoomed": {"zoom": 3.0, "message": "saved"},
        "map": {"whole_sphere": True, "error": "signed"},
    }
    for content_scale, (name, changes) in zip(itertools.cycle((1.0, 2.0, 1.0)), states.items(), strict=False):
        picture = shown(**changes)
        at = frame_of(picture, *size, content_scale)
        drawn = draw_overlay(picture, at, timing=True)
        assert faults(picture, at, drawn) == [], (name, content_scale)
        found = plane_of(picture, at)
        assert (found is None) == (at.numbers.curve is None)
        if found is None or at.numbers.curve is None:
            continue
        assert all(at.numbers.curve.contains(*place) for place in found.places.values())
        assert ("plane_sentence" in drawn.boxes) == bool(at.numbers.legend or (at.numbers.foot and name != "zoomed"))


@pytest.mark.usefixtures("steady")
@pytest.mark.parametrize("size", [(800, 400), (1280, 640), (2560, 1280)])
def test_at_the_usual_sizes_axes_floor_and_most_points_are_labelled(size: tuple[int, int]) -> None:
    drawn, found = drawn_of(session(), size)
    assert {"plane_floor", "plane_milliseconds"} <= set(drawn.boxes)
    labelled = [key for key in found.places if f"plane_{'_'.join(map(str, key[:3]))}" in drawn.boxes]
    assert len(labelled) >= 4


def test_it_takes_the_place_of_the_curve_and_covers_nothing_of_the_spheres() -> None:
    at = compose(1280, 640)
    drawn, _ = drawn_of(shown(method="jittered"))
    assert drawn.bars == {}
    assert not any(name.startswith(("band_", "legend_")) for name in drawn.boxes)
    assert all(box.top >= at.hairline.bottom for name, box in drawn.boxes.items() if name.startswith("plane_"))


def test_a_window_without_room_says_so() -> None:
    for size, room in (((400, 300), False), ((800, 400), True)):
        drawn = draw_overlay(shown(), compose(*size))
        assert ("plane_floor" in drawn.boxes) == room
        assert ("message" in drawn.boxes) == (not room)


def test_the_help_hides_it() -> None:
    assert "plane_floor" not in draw_overlay(shown(help_visible=True), compose(1280, 640)).boxes


@pytest.mark.parametrize("light", ["image", "function"])
def test_what_was_at_hand_for_irradiance_is_timed_anew_once_b_is_pressed(light: str) -> None:
    """Irradiance takes 128 bands first, and the map of a function its samples: the bands shown took no time of their own."""
    shown = find_light("venice_sunset") if light == "image" else FunctionLight(lambda d: np.exp(d))
    state = state_of(shown, quantity="irradiance", n_bands=3)
    *_, picture = stages(state)
    assert measured(picture) == ()
    *_, picture = stages(changed(state, sheet="plane"))
    (found,) = measured(picture)
    assert (found.way, found.milliseconds > 0.02) == (BEST, True)
    assert found.errors[2] == pytest.approx(picture.figures.relative_l2, rel=1e-6)
