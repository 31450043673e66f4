"""Error against bands: the curve stands where the axes say, what it marks is so, and no text is cut or covered."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
from helpers import Lazily, centre, overlap
from numpy.typing import NDArray

from shviewer.analysis.figures import errors_of
from shviewer.analysis.projections import BEST
from shviewer.harmonics.basis import evaluate_basis
from shviewer.lights.function import FunctionLight
from shviewer.viewer.actions import with_bands
from shviewer.viewer.composition import Composition, compose
from shviewer.viewer.overlay.lettering import ACCENT
from shviewer.viewer.overlay.overlay import Overlay, draw_overlay
from shviewer.viewer.overlay.plots import band_series as numbers
from shviewer.viewer.overlay.plots.band_series import band_series, errors_by_count
from shviewer.viewer.overlay.plots.convergence import EXACT, LEAST, LEFT_OUT, MOST, Convergence
from shviewer.viewer.overlay.plots.log_axis import Axis
from shviewer.viewer.overlay.plots.markers import LOOKS
from shviewer.viewer.overlay.plots.sheet import place
from shviewer.viewer.panes import Box, Sphere
from shviewer.viewer.picture import Picture, prepare
from shviewer.viewer.state import changed, state_of
from shviewer.words import percent, round_percent, short_count

SIZES = [
    (320, 160), (400, 300), (640, 320), (700, 400), (800, 800), (1280, 640), (1920, 1080), (2560, 1440), (900, 1200),
    (3000, 500),
]  # fmt: skip

GREEN = {2: 0.783, 3: 0.693, 4: 0.512, 5: 0.283, 6: 0.159, 8: 0.121, 10: 0.083, 16: 0.0408, 20: 0.0306}
"""Relative L2 errors of the paper's light, from its closed form evaluated elsewhere; the last digit is rounded."""


def shown(**changes: object) -> Picture:
    return prepare(state_of(**{"sheet": "convergence", **changes}))  # type: ignore[arg-type]


def smooth(directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of three bands, and with no energy in the middle one."""
    return 2 + evaluate_basis(directions, 3)[:, 8]


PICTURES = Lazily(
    {
        "green": lambda: shown(),
        "one band": lambda: shown(n_bands=1),
        "128 bands": lambda: shown(n_bands=128, tolerance=0.002),
        "samples": lambda: shown(method="jittered", samples=1000, n_bands=8),
        "more bands than are searched": lambda: shown(method="gauss-legendre", samples=1000, n_bands=40),
        "muted": lambda: shown(muted=frozenset({1, 3}), n_bands=7),
        "muted and windowed": lambda: shown(
            muted=frozenset({0, 2, 4, 6, 8}), window="lanczos", window_width=12.0, n_bands=16
        ),
        "irradiance": lambda: shown(quantity="irradiance", n_bands=4),
        "image": lambda: shown(light="venice_sunset", n_bands=9, window="hann"),
        "band-limited": lambda: shown(light=FunctionLight(smooth, "smooth"), n_bands=3),
        "black": lambda: shown(light=FunctionLight(lambda d: 0 * d[:, 0], "black"), n_bands=3),
        "black samples": lambda: shown(
            light=FunctionLight(lambda d: 0 * d[:, 0], "black"), method="jittered", samples=100
        ),
        "loose": lambda: shown(tolerance=0.9, n_bands=10),
        "zoomed": lambda: shown(zoom=3.0, message="saved"),
    }
)


def plot_of(picture: Picture, composition: Composition | None = None) -> tuple[Overlay, Convergence]:
    drawn = draw_overlay(picture, composition or compose(1280, 640))
    assert drawn.convergence is not None
    return drawn, drawn.convergence


def coloured(drawn: Overlay, ink: tuple[int, int, int, int], box: Box, spread: int = 2) -> NDArray[np.int64]:
    """Row and column of the pixels of that ink within a box."""
    left, top, right, bottom = (round(side) for side in box)
    near = np.abs(drawn.image[top:bottom, left:right].astype(int) - ink).max(axis=-1) <= spread
    return np.argwhere(near) + np.array([top, left])


def upper(found: Convergence) -> Box:
    return Box(found.bands.at(0), found.error.end, found.box.right - 1, found.error.start)


def captured(monkeypatch: pytest.MonkeyPatch, picture: Picture) -> dict[str, str]:
    """What is written in the sheet: name -> text."""
    from shviewer.viewer.overlay.plots import sheet

    texts: dict[str, str] = {}
    write, put = sheet.Sheet.write, sheet.Sheet.put

    def writing(self: sheet.Sheet, name: str, x: float, y: float, text: str, *rest: object) -> Box:
        texts[name] = text
        return write(self, name, x, y, text, *rest)  # type: ignore[arg-type]

    def putting(self: sheet.Sheet, name: str, text: str, *rest: object) -> bool:
        done = put(self, name, text, *rest)  # type: ignore[arg-type]
        if done:
            texts[name] = text
        return done

    with monkeypatch.context() as patched:
        patched.setattr(sheet.Sheet, "write", writing)
        patched.setattr(sheet.Sheet, "put", putting)
        plot_of(picture)
    return texts


# --- the curve


def test_the_curve_is_that_of_an_independent_computation() -> None:
    _, found = plot_of(shown(n_bands=20))
    for n, error in GREEN.items():
        place = found.points[n]
        assert place[0] == pytest.approx(found.bands.at(n), abs=1e-9)
        assert abs(place[1] - found.error.at(error)) < abs(found.error.at(error) - found.error.at(error * 1.013)), n


def test_points_stand_where_the_labels_of_the_axes_say() -> None:
    """Read off as a person would, between the labels of 10 and 100 % and of 0 and 10 bands; a label is centred to a pixel."""
    _, found = plot_of(PICTURES["green"])
    ticks = found.error.ticks(1.6 * 12)
    assert ticks == [0.1, 1]
    y = [centre(found.boxes[f"convergence_error_{number}"])[1] for number in (0, 1)]
    x = [centre(found.boxes[f"convergence_bands_{n}"])[0] for n in (0, 10)]
    for n in (2, 5, 10):
        assert found.points[n][0] == pytest.approx(x[0] + (x[1] - x[0]) * n / 10, abs=1)
        assert found.points[n][1] == pytest.approx(y[0] + (y[1] - y[0]) * np.log10(GREEN[n] / 0.1), abs=2)


@pytest.mark.parametrize("composition", [compose(640, 320), compose(1280, 640), compose(2560, 1280, 1.0, 2.0)])
@pytest.mark.parametrize("n", [2, 5, 10])
def test_the_present_n_has_a_ring_at_the_pixel_that_its_error_says(n: int, composition: Composition) -> None:
    drawn, found = plot_of(shown(n_bands=n), composition)
    ringed = coloured(drawn, ACCENT, upper(found), spread=40)
    expected = found.error.at(GREEN[n]), found.bands.at(n)
    np.testing.assert_allclose(ringed.mean(axis=0) + 0.5, expected, rtol=0, atol=1.5)
    reach = np.hypot(*(ringed + 0.5 - ringed.mean(axis=0) - 0.5).T).max()
    assert reach < 12 * max(composition.scale, 10 / 12)


def test_more_bands_move_the_present_point_along_the_same_curve() -> None:
    one, more = PICTURES["green"], prepare(with_bands(PICTURES["green"].state, 6))
    (drawn, before), (_, after) = plot_of(one), plot_of(more)
    assert before.points == after.points
    assert before.bands == after.bands
    assert not len(coloured(drawn, ACCENT, Box(*(side + d for side in after.points[6] for d in (-2, 3)))))
    assert after.points[6][0] - before.points[5][0] == pytest.approx(before.bands.pitch)
    assert after.points[6][1] > before.points[5][1]


def test_the_line_is_drawn_through_its_points_and_has_soft_edges() -> None:
    drawn, found = plot_of(PICTURES["green"])
    for one, two in itertools.pairwise([1, 2, 3, 4]):
        x, y = (np.array(found.points[one]) + found.points[two]) / 2
        column = drawn.image[round(y) - 4 : round(y) + 5, int(x), 0].astype(int)
        assert column.max() > 120
        assert ((column > 20) & (column < 200)).any()
        assert abs(int(column.argmax()) - 4) <= 1


def test_what_the_noise_of_samples_does_is_seen_against_the_exact_curve_behind() -> None:
    picture = PICTURES["samples"]
    drawn, found = plot_of(picture)
    exact, noisy = errors_of(picture.light, *BEST), errors_of(picture.light, "jittered", 1000, 0)
    series = band_series(picture)
    assert [series.exact[n] for n in range(1, 12)] == exact[:11].tolist()
    assert [series.errors[n] for n in range(1, 12)] == noisy[:11].tolist()
    here = Box(found.bands.at(8.4), found.error.end, found.bands.at(9.6), found.error.start)
    own = coloured(drawn, LOOKS["jittered"][1], here, spread=60)
    behind = coloured(drawn, EXACT, here, spread=10)
    assert own[:, 0].mean() == pytest.approx(found.error.at(noisy[8]), abs=2)
    middle = behind[np.abs(behind[:, 1] - found.bands.at(9)) < 3]
    assert np.abs(middle[:, 0] - found.error.at(exact[8])).min() < 2
    assert {"convergence_legend_samples", "convergence_legend_exact"} <= set(found.boxes)
    assert "convergence_legend_exact" not in plot_of(PICTURES["green"])[1].boxes


def test_beyond_the_counts_that_samples_are_searched_for_the_error_is_that_of_the_projection() -> None:
    picture = PICTURES["more bands than are searched"]
    errors = errors_by_count(picture)
    assert errors[39] == pytest.approx(picture.figures.relative_l2, rel=1e-9)
    few = errors_of(picture.light, "gauss-legendre", 1000, 0)
    np.testing.assert_allclose(errors[: len(few)], few, rtol=1e-9)
    assert 40 in plot_of(picture)[1].points


# --- what is marked


@pytest.mark.parametrize("name", PICTURES)
def test_the_written_error_is_that_of_the_figures_unless_bands_are_changed(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    picture = PICTURES[name]
    texts, figures = captured(monkeypatch, picture), picture.figures
    altered = "shown" in texts
    assert altered == bool(picture.state.recipe.muted_shown or picture.state.recipe.window != "none")
    said = percent(figures.relative_l2, floor=figures.floor * (1 + 1e-9))
    assert texts["shown" if altered else "present"].endswith(said)


@pytest.mark.parametrize("name", ["muted", "image", "muted and windowed"])
def test_what_is_shown_with_bands_muted_or_windowed_is_marked_beside_the_curve(name: str) -> None:
    picture = PICTURES[name]
    drawn, found = plot_of(picture)
    n = picture.state.recipe.n_bands
    assert found.shown is not None
    assert found.shown == pytest.approx((found.bands.at(n), found.error.at(picture.figures.relative_l2)))
    assert tuple(drawn.image[int(found.shown[1]), int(found.shown[0])]) == ACCENT
    assert found.points[n][1] > found.shown[1]
    assert plot_of(PICTURES["green"])[1].shown is None


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("green", "5 % needs 15 bands"),
        ("samples", "5 % needs over 32 bands"),
        ("irradiance", "5 % needs 3 bands"),
        ("image", "5 % needs over 128 bands"),
        ("128 bands", "0.2 % needs 122 bands"),
        ("band-limited", "5 % needs 3 bands"),
    ],
)
def test_the_bands_that_the_tolerance_needs_are_those_of_the_figures(
    name: str, text: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    picture = PICTURES[name]
    needs = picture.needs
    needed = needs.irradiance if picture.state.recipe.quantity == "irradiance" else needs.radiance
    assert str(needed or f"over {needs.searched}") in text
    assert captured(monkeypatch, picture)["tolerance"] == text
    drawn, found = plot_of(picture)
    if found.needed is None:
        assert needed is None or needed > found.bands.slots
        return
    assert needed is not None
    assert found.needed == found.points[needed]
    y = round(found.error.at(needs.tolerance))
    assert found.points[needed][1] >= found.error.at(needs.tolerance) > found.points[needed - 1][1]
    row = drawn.image[y, round(upper(found).left) : round(upper(found).right), 0]
    assert 0.2 < (row > 100).mean() < 0.9  # dashes


def test_errors_below_the_floor_are_not_drawn_as_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("band-limited", "black", "black samples"):
        picture = PICTURES[name]
        _, found = plot_of(picture)
        floor = picture.figures.floor
        assert found.points[picture.state.recipe.n_bands][1] == pytest.approx(found.error.at(floor))
        texts = captured(monkeypatch, picture)
        assert texts["present"].endswith(f"< {round_percent(floor)}")
        assert (texts.get("floor") == "less cannot be measured") == (
            name != "black samples"
        )  # no room left in the last


def test_infinite_errors_are_said_and_not_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    picture = PICTURES["muted"]
    figures = picture.figures
    channels = figures.channels | {"all": replace(figures.channels["all"], relative_l2=np.inf)}
    picture = replace(picture, figures=replace(figures, channels=channels))
    monkeypatch.setattr(numbers, "errors_of", lambda *_: np.full(128, np.inf))
    _, found = plot_of(picture)
    assert found.points == {}
    assert found.shown is None
    texts = captured(monkeypatch, picture)
    assert texts["present"] == "7 bands: infinite"
    assert texts["shown"].endswith(": infinite")


# --- the energy


@pytest.mark.parametrize("name", ["green", "muted", "128 bands", "samples", "image"])
def test_each_bar_is_as_high_as_the_power_of_its_band(name: str) -> None:
    picture = PICTURES[name]
    drawn, found = plot_of(picture)
    coefficients = picture.light.coefficients(found.bands.slots)
    norm = np.trace(picture.light.products())
    assert found.energy is not None
    for band, bar in found.bars.items():
        power = (coefficients[band**2 : (band + 1) ** 2] ** 2).sum() / norm
        assert bar.top == round(found.energy.at(power))
        assert (bar.left + bar.right) / 2 == pytest.approx(found.bands.at(band + 0.5), abs=1)
        assert found.bands.at(band) - 0.5 <= bar.left < bar.right <= found.bands.at(band + 1) + 0.5
        if name != "image":  # a window fills only a part
            inside = drawn.image[
                round(bar.bottom) - 1 - (bar.bottom - bar.top > 4) * 2, round(bar.left + bar.right) // 2
            ]
            used, muted = band < picture.state.recipe.n_bands, band in picture.state.recipe.muted
            assert (tuple(inside) == ACCENT) == (used and not muted)
            assert (tuple(inside) == LEFT_OUT) == (not used)


def test_a_window_fills_a_bar_as_far_as_it_leaves_energy() -> None:
    picture = PICTURES["image"]
    drawn, found = plot_of(picture)
    assert found.energy is not None
    for band in (1, 2, 3):
        bar = found.bars[band]
        kept = picture.figures.energy_share[band] * picture.figures.factors[band] ** 2
        filled = coloured(drawn, ACCENT, Box(bar.left + 2, bar.top + 2, bar.right - 2, bar.bottom))
        assert filled[:, 0].min() == max(round(found.energy.at(kept)), bar.top + 2)


def test_a_band_without_energy_has_no_bar() -> None:
    assert set(plot_of(PICTURES["band-limited"])[1].bars) == {0, 2}
    assert plot_of(PICTURES["black"])[1].bars == {}
    assert plot_of(PICTURES["black"])[1].energy is None


def test_the_axis_of_bands_holds_the_present_n_and_does_not_move_with_each_key() -> None:
    for n in (1, 9, 10, 11, 16, 17, 100, 128):
        _, found = plot_of(shown(n_bands=n))
        assert found.bands.slots == next(count for count in (10, 16, 32, 64, 128) if count >= n)
        ringed = found.bands.at(n) + 9
        assert found.box.left < found.bands.at(0) < ringed < found.box.right - 10


# --- the sheet


@pytest.mark.parametrize("name", PICTURES)
def test_ticks_are_round(name: str) -> None:
    _, found = plot_of(PICTURES[name])
    axes: list[tuple[Axis, float]] = [(found.error, 1.6)] + ([(found.energy, 1.25)] if found.energy else [])
    for axis, lines in axes:
        ticks = axis.ticks(lines * 12)
        assert len(ticks) >= 2
        for tick in ticks:
            assert f"{tick:.6e}"[:3] in ("1.0", "1.5", "2.0", "3.0", "4.0", "5.0", "6.0", "8.0")
    ticks = found.bands.ticks(25)
    assert set(np.diff(ticks)) <= {1, 2, 4, 8, 16, 32}
    assert ticks[0] == 0


@pytest.mark.parametrize(
    ("share", "text"),
    [(1.5, "150 %"), (1.0, "100 %"), (0.002, "0.2 %"), (1e-7, "0.00001 %"), (1e-8, "1e-6 %"), (1.5e-12, "1.5e-10 %")],
)
def test_a_round_share_is_short_beside_an_axis(share: float, text: str) -> None:
    assert round_percent(share) == text


def test_a_count_is_short_in_a_legend() -> None:
    assert [short_count(count) for count in (625, 2_500, 160_000, 1_000_000)] == ["625", "2.5k", "160k", "1M"]


def triptych(width: int, height: int, tall: bool = False) -> Composition:
    """Three spheres, across or two above one, each in a cell of its own."""
    two = compose(width, height)
    floor = two.hairline_y
    columns, rows = (2, 2) if tall else (3, 1)
    cells = []
    for number in range(3):
        row, column = divmod(number, columns)
        left, top = width * column / columns, 40 + (floor - 40) * row / rows
        cells.append(Box(left, top, left + width / columns, top + (floor - 40) / rows))
    spheres = [
        Sphere(*centre(cell), 0.45 * min(cell.right - cell.left, cell.bottom - cell.top), cell) for cell in cells
    ]
    return replace(two, spheres=tuple(spheres))  # type: ignore[arg-type]


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("content_scale", [1.0, 2.0])
def test_no_text_in_it_is_cut_or_covered(size: tuple[int, int], content_scale: float) -> None:
    for name, picture in PICTURES.items():
        composition = compose(*size, picture.state.view.zoom, content_scale)
        drawn = draw_overlay(picture, composition, timing=True)
        for (one, box), (two, other) in itertools.combinations(drawn.boxes.items(), 2):
            assert not overlap(box, other), (name, one, two)
        found = drawn.convergence
        if found is None:
            continue
        sheet = found.box
        assert set(found.boxes) <= set(drawn.boxes)
        assert {"convergence_title", "convergence_error", "convergence_bands", "convergence_present"} <= set(
            found.boxes
        )
        for one, box in found.boxes.items():
            assert sheet.left < box.left < box.right < sheet.right, (name, one)
            assert sheet.top < box.top < box.bottom < sheet.bottom, (name, one)
        assert sheet.bottom <= composition.hairline_y
        assert not any(overlap(sheet, box) for one, box in drawn.boxes.items() if one not in found.boxes), name


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("tall", [False, True])
def test_beside_an_error_it_lies_over_the_original_and_within_its_cell(size: tuple[int, int], tall: bool) -> None:
    composition = triptych(*size, tall)
    first, *others = composition.spheres
    caption = Box(first.x - 40, first.clip.top, first.x + 40, first.clip.top + 12)
    below = Box(first.x - 40, first.clip.bottom - 10, first.x + 40, first.clip.bottom)
    for taken in ([], [caption], [caption, below]):
        found = place(composition, taken, MOST, LEAST)
        assert found is not None or min(first.clip.right, first.clip.bottom - first.clip.top) < 260 * composition.scale
        if found is None:
            continue
        assert first.clip.left < found.left < first.x < found.right < first.clip.right
        assert first.clip.top <= found.top < found.bottom < first.clip.bottom
        assert not any(sphere.touches(found) for sphere in others)
        assert not any(overlap(found, box) for box in taken)


def test_at_the_usual_sizes_everything_is_there() -> None:
    for size in ((640, 320), (1280, 640), (2560, 1440), (900, 1200)):
        _, found = plot_of(PICTURES["green"], compose(*size))
        assert {"convergence_tolerance", "convergence_energy", "convergence_energy_0"} <= set(found.boxes), size


def test_a_window_without_room_says_so() -> None:
    for size, room in (((320, 160), False), ((640, 320), True)):
        drawn = draw_overlay(PICTURES["green"], compose(*size))
        assert (drawn.convergence is not None) == room
        assert ("message" in drawn.boxes) == (not room)


def test_one_sheet_is_shown_at_a_time_and_none_over_the_help() -> None:
    drawn = draw_overlay(PICTURES["green"], compose(1280, 640))
    assert drawn.plane is None
    helped = replace(PICTURES["green"], state=changed(PICTURES["green"].state, help_visible=True))
    assert draw_overlay(helped, compose(1280, 640)).convergence is None


def test_what_is_outside_the_sheet_is_as_it_is_without_it() -> None:
    picture = PICTURES["128 bands"]
    drawn, found = plot_of(picture)
    without = draw_overlay(replace(picture, state=changed(picture.state, sheet="")), compose(1280, 640))
    differs = np.argwhere((drawn.image != without.image).any(axis=-1))
    assert found.box.top <= differs[:, 0].min() < differs[:, 0].max() < found.box.bottom
    assert found.box.left <= differs[:, 1].min() < differs[:, 1].max() < found.box.right
