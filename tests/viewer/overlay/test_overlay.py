"""What is written over the spheres: it fits, nothing overlaps, it can be read, and it says what is so."""

from __future__ import annotations

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest
from helpers import Lazily, frame_of, from_srgb, overlap, picture_of
from numpy.typing import NDArray
from viewer.overlay.collisions import faults, shrunk
from viewer.overlay.written import image_of, pieces_of, texts_of

from shviewer.lights.environment import EnvironmentLight
from shviewer.lights.function import FunctionLight
from shviewer.viewer import message
from shviewer.viewer.composing.composition import Composition, compose, frame_for
from shviewer.viewer.composing.panes import Box
from shviewer.viewer.overlay.figures import _fitting
from shviewer.viewer.overlay.foot import foot_pieces
from shviewer.viewer.overlay.help_sheet import pages_of
from shviewer.viewer.overlay.inks import ACCENT, ERROR, FAINT, GREY, GROUND, INK, WARNING, Ink
from shviewer.viewer.overlay.letters.lettering import REGULAR, width_of
from shviewer.viewer.overlay.letters.numerals import value
from shviewer.viewer.overlay.overlay import Overlay, draw_overlay
from shviewer.viewer.overlay.pieces import Disc, Fill, Swatch
from shviewer.viewer.overlay.working import hairline_pieces
from shviewer.viewer.picture import Picture
from shviewer.viewer.work import Work
from shviewer.words import percent, radiance

SIZES = [
    *[(400, 300), (640, 320), (640, 480), (700, 400), (800, 480), (900, 640), (1000, 400), (1280, 640), (1280, 720)],
    *[(1920, 1080), (2560, 1440), (500, 1000), (500, 1600), (900, 1200), (1000, 1000), (3000, 500)],
]
LONG = "a_light_whose_name_is_much_longer_than_anybody_would_ever_want_it_to_be_in_a_caption"

LOW_RANGE = EnvironmentLight(
    np.random.default_rng(1).random((8, 16, 3), np.float32),
    name="photo",
    notes=("a",),
    encoding="PNG, 8 bit sRGB (LDR)",
)
BLACK = EnvironmentLight(np.zeros((8, 16, 3), np.float32), name="black")
PICTURES = Lazily(
    {
        "green": lambda: picture_of(),
        "muted": lambda: picture_of(n_bands=12, muted=frozenset({0, 2, 4, 6, 8, 10}), cursor=3, cursor_visible=True),
        "windowed": lambda: picture_of("studio", n_bands=9, window="hann"),
        "sampled": lambda: picture_of("sun-sky", n_bands=32, method="jittered", samples=20_000),
        "low range": lambda: picture_of(LOW_RANGE, n_bands=9),
        "split": lambda: picture_of("sun-sky", split_sun=True),
        "long name": lambda: picture_of(light=FunctionLight(lambda d: 1 + d[:, 2], LONG), n_bands=40),
        "other scripts": lambda: picture_of(replace(LOW_RANGE, name="日の出 شروق 🌅 зоря"), n_bands=2),
        "irradiance": lambda: picture_of("venice_sunset", quantity="irradiance", n_bands=3),
        "black": lambda: picture_of(BLACK),
        "constant": lambda: picture_of("constant", n_bands=1),
        "message": lambda: picture_of(
            message=message.Message(
                "a-rather-long-path/" * 12 + "bad.hdr: an empty file (0 bytes); export it again", message.ERROR
            )
        ),
        "signed error": lambda: picture_of(error="signed"),
        "relative error": lambda: picture_of("venice_sunset", n_bands=9, error="relative", tone="log"),
        "tiny error": lambda: picture_of(n_bands=60, error="absolute", muted=frozenset({1, 2})),
        "surfaces": lambda: picture_of("studio", lobe_view=True, error="signed"),
        "basis": lambda: picture_of(basis=(3, -2), lobe_view=True),
        "help": lambda: picture_of(help_visible=True),
        "small sphere": lambda: picture_of(error="signed", zoom=0.5),
    }
)
MAPS = ("green", "signed error", "low range", "message", "long name")


def frame(shown: Picture, size: tuple[int, int], maps: bool = False, content_scale: float = 1.0) -> Composition:
    view = shown.state.view
    return compose(*size, view.zoom, content_scale, view.n_spheres, whole_sphere=maps)


def text_of(drawn: Overlay) -> str:
    """Everything that is written, with plain spaces."""
    return " | ".join(piece.text for piece in texts_of(drawn)).replace("\u202f", " ")


# --- rules that hold at every size


@pytest.mark.parametrize(("name", "maps"), [*((name, False) for name in PICTURES), *((name, True) for name in MAPS)])
def test_nothing_overlaps_nothing_is_cut_and_every_text_can_be_read(name: str, maps: bool) -> None:
    for size in SIZES:
        look_at(PICTURES[name], frame(PICTURES[name], size, maps))


def look_at(shown: Picture, at: Composition) -> None:
    """Only the labels of the curve's axes are held apart: lines cross bars, and rings have their numbers on both."""
    for work in (None, Work("projecting 40 960 000 jittered samples", 0.43, 3.0)):
        look_at_all(shown, at, draw_overlay(shown, at, timing=True, work=work))


def look_at_all(shown: Picture, at: Composition, drawn: Overlay) -> None:
    assert texts_of(drawn)
    alone = not shown.state.view.help_visible
    for piece in texts_of(drawn):
        assert piece.size >= (11 if at.compact else 12) * at.scale * 0.61, piece  # the least: the unit of an answer
        assert piece.size >= 11, piece
        assert contrast(piece.ink, GROUND) >= 4.5, piece
        assert piece.box.left >= at.margin - 8 * at.scale, piece
        assert piece.right <= at.width - at.margin + 8 * at.scale, piece
        assert piece.box.top >= 4, piece
        assert piece.baseline <= at.height - 3, piece
        assert not (alone and any(pane.touches(piece.box) for pane in at.panes)), piece
    apart = [piece for piece in texts_of(drawn) if not piece.name.startswith("ring_")]
    for one, two in itertools.combinations(apart, 2):
        assert not overlap(shrunk(one.box), two.box), (one.name, two.name)


def contrast(ink: Ink, ground: Ink) -> float:
    """[WCAG 2.2, relative luminance and contrast ratio]."""
    light, dark = sorted((luminance(ink), luminance(ground)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def luminance(ink: Ink) -> float:
    return float(from_srgb(np.array(ink[:3]) / 255) @ [0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize(
    ("ink", "least"), [(INK, 12.6), (GREY, 7.0), (FAINT, 4.7), (WARNING, 9.3), (ERROR, 6.0), (ACCENT, 5.6)]
)
def test_every_ink_stands_out_from_the_ground(ink: Ink, least: float) -> None:
    assert contrast(ink, GROUND) >= least


@pytest.mark.parametrize("width", [64, 100, 320, 900])
@pytest.mark.parametrize("height", [64, 100, 160, 640])
@pytest.mark.parametrize("content_scale", [1.0, 2.0])
def test_every_frame_that_is_allowed_can_be_drawn(width: int, height: int, content_scale: float) -> None:
    for shown in (PICTURES["green"], PICTURES["signed error"], PICTURES["help"]):
        for maps in (False, True):
            at = frame(shown, (width, height), maps, content_scale)
            assert image_of(draw_overlay(shown, at, opengl="OpenGL 3.3"), (width, height)).shape == (height, width, 4)


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("maps", [False, True])
def test_five_questions_are_answered_at_every_size(size: tuple[int, int], maps: bool) -> None:
    """What is this, how many bands, how many would be enough to look at and for shading, how wrong, how much is negative."""
    said = text_of(draw_overlay(PICTURES["green"], frame(PICTURES["green"], size, maps)))
    for answer in (
        "green",
        "5 bands",
        "radiance within 5 %",
        "shading within 5 %",
        "28.3 %",
        "0.266",
        "−0.137",
        "42 %",
    ):
        assert answer in said
    assert "| 15 | bands" in said
    assert "| 3 | bands" in said


@pytest.mark.parametrize("size", [(1280, 640), (2560, 1280)])
def test_at_full_size_everything_is_there(size: tuple[int, int]) -> None:
    boxes = set(draw_overlay(PICTURES["green"], compose(*size)).boxes)
    assert {"original", "original_about", "reconstruction", "reconstruction_about", "exposure", "method"} <= boxes
    for name in ("relative_l2", "max_error", "minimum", "negative_area", "energy"):
        assert {name, f"{name}_label"} <= boxes
    assert {"minimum_swatch", "negative_area_swatch", "tolerance", "band", "key_H", "key_D"} <= boxes
    assert {"legend_radiance", "legend_shading", "legend_with this band alone left out"} <= boxes


def test_figures_keep_their_place_whatever_they_say() -> None:
    names = ("relative_l2", "max_error", "minimum", "negative_area", "energy")
    places = set()
    for name in ("green", "muted", "sampled", "split", "black", "constant", "irradiance"):
        boxes = draw_overlay(PICTURES[name], compose(1280, 640)).boxes
        places.add(tuple(round(boxes[f"{name}_label"].left) for name in names))
    assert len(places) == 1


def test_only_what_changed_is_drawn_again() -> None:
    """Equal blocks are the same layer, so that they are neither drawn nor uploaded: of a band key, about half of them."""
    at = compose(1280, 640)
    first, again, other = (draw_overlay(picture_of(n_bands=n), at).layers for n in (7, 7, 8))
    assert all(one is two for one, two in zip(first, again, strict=True))
    kept = {id(layer.image) for layer in first} & {id(layer.image) for layer in other}
    assert len(kept) >= len(first) / 2
    assert len(kept) < len(first)


def test_the_time_is_said_only_when_asked_for() -> None:
    at = compose(1280, 640)
    assert " ms" not in text_of(draw_overlay(PICTURES["green"], at))
    assert " ms" in text_of(draw_overlay(PICTURES["green"], at, timing=True))


# --- captions


def test_heads_stand_at_the_left_edges_of_their_panes() -> None:
    at = compose(1280, 640)
    boxes = draw_overlay(PICTURES["green"], at).boxes
    assert boxes["original"].left == at.margin
    assert boxes["reconstruction"].left == 652


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("split", "sun apart"),
        ("windowed", "Hann window"),
        ("muted", "6 bands muted"),
        ("irradiance", "irradiance, 256 × 128"),
        ("sampled", "19 881 jittered samples"),
        ("basis", "Y(3,−2)"),
        ("signed error", "reconstruction − original"),
        ("relative error", "relative to the original"),
        ("relative error", "log curve"),
    ],
)
def test_a_caption_says_what_is_special(name: str, said: str) -> None:
    assert said in text_of(draw_overlay(PICTURES[name], frame(PICTURES[name], (1920, 1080))))


@pytest.mark.parametrize("timing", [False, True])
def test_what_may_be_missed_of_a_function_is_said_at_every_size(timing: bool) -> None:
    shown = PICTURES["long name"]
    for size in SIZES[1:]:
        assert "may" in text_of(draw_overlay(shown, frame(shown, size), timing=timing)), size


@pytest.mark.parametrize("name", ["p", LONG])
def test_low_range_is_said_at_every_size(name: str) -> None:
    shown = picture_of(light=replace(LOW_RANGE, name=name))
    for size in SIZES:
        assert "LDR" in text_of(draw_overlay(shown, frame(shown, size))), size


@pytest.mark.parametrize(
    ("encoding", "notes", "end"),
    [
        ("OpenEXR", (), "8 × 4"),
        ("PNG, 8 bit sRGB (LDR)", (), "8 × 4, LDR"),
        ("OpenEXR", ("a",), "8 × 4, 1 note"),
        ("JPEG, 8 bit sRGB (LDR)", ("a", "b"), "8 × 4, LDR, 2 notes"),
    ],
)
def test_the_description_ends_in_what_must_not_be_missed(encoding: str, notes: tuple[str, ...], end: str) -> None:
    light = EnvironmentLight(np.ones((4, 8, 3), np.float32), name="mine", notes=notes, encoding=encoding)
    drawn = draw_overlay(picture_of(light), compose(1920, 1080))
    words = [piece.text for piece in texts_of(drawn) if piece.name.startswith("original_about")]
    assert ", ".join(words) == f"original, {end}"


def test_captions_of_enlarged_spheres_stand_on_them_with_a_rim() -> None:
    shown = picture_of(zoom=3.0)
    drawn = draw_overlay(shown, frame(shown, (1280, 640)))
    heads = [piece for piece in texts_of(drawn) if piece.name in ("original", "reconstruction_about", "exposure")]
    assert len(heads) == 3
    assert all(piece.casing > 0 and piece.ink == INK for piece in heads)


def test_beyond_white_is_explained_only_where_something_is_and_no_curve_bends_it() -> None:
    at = compose(1280, 640)
    shown = {tone: picture_of("venice_sunset", tone=tone) for tone in ("none", "aces")}
    zebras = {tone: "zebra" in draw_overlay(picture, at).boxes for tone, picture in shown.items()}
    assert zebras == {"none": True, "aces": False}
    assert "zebra" not in draw_overlay(PICTURES["green"], at).boxes


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", ["green", "signed error", "relative error"])
def test_the_exposure_stands_in_one_place(name: str, size: tuple[int, int]) -> None:
    for maps in (False, True):
        said = text_of(draw_overlay(PICTURES[name], frame(PICTURES[name], size, maps)))
        compact = frame(PICTURES[name], size, maps).compact
        assert said.count(" stops") == 1 or (compact and said.count(" stops") == 0), maps


@pytest.mark.parametrize(("minimum", "bound"), [(-0.104, -0.110), (0.0, -2.7e-5), (-1.09e7, -1.2e7)])
def test_the_sample_of_negative_channels_is_there_whatever_the_numbers(minimum: float, bound: float) -> None:
    shown = PICTURES["green"]
    extremes = replace(shown.figures.extremes, minimum=minimum or -2.6e-5, minimum_bound=bound)
    boxes = draw_overlay(replace(shown, figures=replace(shown.figures, extremes=extremes)), compose(1280, 640)).boxes
    assert "minimum_swatch" in boxes
    last = max(box.right for name, box in boxes.items() if name.startswith("minimum"))
    assert boxes["negative_area"].left - last >= 8


def test_what_may_be_missed_is_no_fact_in_few_words_either() -> None:
    shown = PICTURES["long name"]
    for size in SIZES[1:]:
        said = text_of(draw_overlay(shown, frame(shown, size)))
        assert "may miss < " in said or "may be missed" in said, size


def test_a_fixed_exposure_says_so() -> None:
    assert "exposure +1.0 stops, fixed" in text_of(draw_overlay(picture_of(exposure_stops=1.0), compose(1280, 640)))


# --- answers and figures


def test_surfaces_have_no_exposure() -> None:
    size = (1280, 640)
    for lobes, said in ((False, True), (True, False)):
        shown = picture_of("green", lobe_view=lobes)
        assert ("exposure" in text_of(draw_overlay(shown, frame(shown, size)))) is said


def test_an_answer_that_was_not_found_says_how_far_was_searched() -> None:
    assert "> 128 | bands" in text_of(draw_overlay(PICTURES["relative error"], compose(1280, 640)))
    assert "> 32 | bands" in text_of(draw_overlay(PICTURES["sampled"], compose(1280, 640)))


def test_one_band_is_one_band() -> None:
    said = text_of(draw_overlay(PICTURES["constant"], compose(1280, 640)))
    assert "1 | band |" in said
    assert "1 coefficient |" in said


def test_with_a_sun_apart_answers_and_errors_are_of_the_rest() -> None:
    said = text_of(draw_overlay(PICTURES["split"], compose(1280, 640)))
    assert "radiance within 5 %, of the rest" in said
    assert "of rest" in said


def test_the_energy_in_use_is_the_share_of_all_energy() -> None:
    """The five bands of Green hold 92 %; without band 1, which holds 22 %, about 70 %."""
    shares = PICTURES["green"].figures.energy_share
    for muted in (frozenset(), frozenset({1})):
        drawn = draw_overlay(picture_of(muted=muted), compose(1280, 640))
        found = next(piece.text for piece in texts_of(drawn) if piece.name == "energy").replace("\u202f", " ")
        assert found == percent(sum(shares[band] for band in range(5) if band not in muted), 2)


@pytest.mark.parametrize(("factor", "said"), [(1.005, False), (1.2, True)])
def test_a_bound_far_beyond_what_was_found_is_said(factor: float, said: bool) -> None:
    shown = PICTURES["green"]
    extremes = replace(
        shown.figures.extremes,
        max_error_bound=0.266 * factor,
        minimum_bound=-0.137 * factor,
        max_error=0.266,
        minimum=-0.137,
    )
    drawn = draw_overlay(replace(shown, figures=replace(shown.figures, extremes=extremes)), compose(1280, 640))
    assert ("– 0.319" in text_of(drawn)) == said
    assert ("to −0.17" in text_of(drawn)) == said  # two digits, away from zero: three have no room


def test_the_words_under_a_figure_do_not_read_on_in_the_next() -> None:
    """The longest are those of a function, whose largest error is only found."""
    boxes = draw_overlay(picture_of(FunctionLight(lambda d: 1 + d[:, 2], "f")), compose(1280, 640)).boxes
    for one, next_ in itertools.pairwise(("relative_l2", "max_error", "minimum", "negative_area", "energy")):
        assert boxes[f"{next_}_label"].left - boxes[f"{one}_label"].right >= 10


@pytest.mark.parametrize("said", ["9.49 × 10⁻⁴", "−1.08 × 10⁻¹²", "−0.0958", "99.9999 %"])
def test_a_figure_that_is_set_smaller_fits_its_column(said: str) -> None:
    for room in np.arange(60.0, 200.0, 0.25):
        _, size, _ = _fitting([(said, "")], room, (22.5, 13.0, 11.0), REGULAR)
        assert width_of(said, size, REGULAR) <= room or size == 13.0, (room, size)


def test_swatches_are_the_legend_of_what_is_negative_and_of_nothing_else() -> None:
    drawn = draw_overlay(PICTURES["green"], compose(1280, 640))
    assert sorted(piece.kind for piece in pieces_of(drawn) if isinstance(piece, Swatch)) == ["lines", "negative"]
    bare = draw_overlay(PICTURES["constant"], compose(1280, 640))
    assert not [piece for piece in pieces_of(bare) if isinstance(piece, Swatch)]


# --- messages and work


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_a_message_is_shortened_to_fit_and_keys_give_way(size: tuple[int, int]) -> None:
    drawn = draw_overlay(PICTURES["message"], compose(*size))
    assert "message" in drawn.boxes
    assert "key_H" not in drawn.boxes
    assert drawn.boxes["message"].right <= size[0] - 8


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_no_time_stands_without_what_took_it(size: tuple[int, int]) -> None:
    """In narrow windows "3.23 ms" stood alone under the sphere."""
    for name in ("green", "irradiance", "sampled"):
        drawn = draw_overlay(PICTURES[name], frame(PICTURES[name], size), timing=True)
        for said in (text.text for text in texts_of(drawn) if text.name == "method"):
            assert re.search("closed form|exact|samples", said), said


def test_a_long_message_takes_the_place_of_the_legend_before_it_is_cut() -> None:
    short, long = (
        "2 texels repaired",
        "a-file-with-a-longer-name.json is 257 % off, but not in the convention of three: name --convention three, or another",
    )
    for words, kept in ((short, True), (long, False)):
        drawn = draw_overlay(picture_of(message=message.warning(words)), compose(1280, 640))
        assert words in text_of(drawn)
        assert ("legend_radiance" in drawn.boxes) == kept


def test_a_long_path_leaves_the_reason_whole() -> None:
    words = "an empty file (0 bytes); fetch or export it again"
    drawn = draw_overlay(
        picture_of(message=message.Message(f"/{'folder/' * 20}sky.hdr: {words}", message.ERROR)), compose(500, 900)
    )
    path, reason = (text.text for text in texts_of(drawn) if text.name.startswith("message"))
    assert reason == words
    assert path.startswith("/folder/")
    assert path.endswith("sky.hdr:")


@pytest.mark.parametrize("size", [(500, 900), (720, 720), (900, 900)], ids=str)
def test_a_curve_among_the_panes_says_what_its_lines_are_and_sentences_stand_in_the_foot(size: tuple[int, int]) -> None:
    shown, steps = PICTURES["signed error"], picture_of(error="signed", by_roughness=True)
    at = frame(shown, size)
    assert {"legend_radiance", "legend_shading"} <= draw_overlay(shown, at).boxes.keys()
    sentence = draw_overlay(steps, at).boxes["steps_sentence"]
    assert at.numbers.foot is not None
    assert abs(sentence.bottom - at.numbers.foot.baseline) < 6


@pytest.mark.parametrize("size", [(500, 300), (640, 360), (500, 900), (400, 1200), (720, 720)], ids=str)
@pytest.mark.parametrize("error", ["off", "signed"])
def test_what_went_wrong_is_said_in_full_in_small_windows_too(size: tuple[int, int], error: str) -> None:
    """It was cut in its middle, which is where the reason stands."""
    words = "sky.hdr: 256 x 128 is not square, as angular must be: crop it to the disc or press L for another layout"
    shown = picture_of(message=message.Message(words, message.ERROR), error=error)
    drawn = draw_overlay(shown, frame(shown, size))
    assert " ".join(text.text for text in texts_of(drawn) if text.name.startswith("message")) == words
    beside = {
        name
        for name in draw_overlay(picture_of(error=error), frame(shown, size)).boxes
        if name.startswith(("share_", "tolerance"))
    }
    assert beside <= drawn.boxes.keys()  # the axis of errors stays


@pytest.mark.parametrize(
    ("said", "ink", "marks"),
    [
        (message.Message("saved a.png", message.DONE), INK, 1),
        (message.warning("2 texels repaired"), WARNING, 1),
        ("a note", INK, 0),
    ],
)
def test_the_kind_of_a_message_has_a_shape_and_a_colour(said: str, ink: Ink, marks: int) -> None:
    pieces = foot_pieces(compose(1280, 640), said)
    (text,) = (piece for piece in pieces if piece.name == "message")
    assert text.ink == ink
    assert text.text == said
    assert len([piece for piece in pieces if piece.name.startswith("mark")]) == marks


def test_an_error_has_a_cross() -> None:
    pieces = foot_pieces(compose(1280, 640), message.Message("cannot read a.exr", message.ERROR))
    assert len([piece for piece in pieces if piece.name.startswith("mark")]) == 2
    assert {piece.ink for piece in pieces} == {ERROR}


def test_where_there_are_several_lights_the_keys_that_go_through_them_are_named_if_there_is_room() -> None:
    several = picture_of(lights=("green", "studio"))
    for size, shown, named in (
        ((1280, 640), several, True),
        ((1280, 640), picture_of(), False),
        ((900, 900), several, False),
    ):
        boxes = draw_overlay(shown, frame(shown, size), timing=True).boxes
        assert ("key_← →" in boxes) == named
        assert "key_← →" not in draw_overlay(shown, frame(shown, size)).boxes  # which a saved picture is made of
        assert {"key_↑ ↓", "key_D", "key_H"} <= boxes.keys()


@pytest.mark.parametrize("size", [(1280, 640), (1280, 720), (2560, 1440)])
def test_where_a_sun_is_to_blame_u_is_among_the_keys_and_stands_out(size: tuple[int, int]) -> None:
    """Beside three panes there is no room for all keys."""
    shown = picture_of("venice_sunset", n_bands=9, error="signed")
    inks = {piece.name: piece.ink for piece in texts_of(draw_overlay(shown, frame(shown, size)))}
    assert (inks["key_U"], inks["key_D"], inks["key_H"]) == (INK, GREY, GREY)
    found = texts_of(draw_overlay(PICTURES["green"], compose(1280, 640)))
    assert next(piece.ink for piece in found if piece.name == "key_U") == GREY


@pytest.mark.parametrize("kind", ["noise", "function"])
def test_a_sun_is_not_proposed_to_be_taken_apart_where_there_is_none(kind: str) -> None:
    """No band count is enough for either: every texel is another, and a function is never split."""
    noise = EnvironmentLight(np.random.default_rng(0).random((256, 512, 3), dtype=np.float32) ** 4)
    light = noise if kind == "noise" else FunctionLight(lambda d: np.sin(400 * d[:, 0]) * d[:, 1])
    picture = picture_of(light)
    assert picture.needs.radiance is None
    found = texts_of(draw_overlay(picture, compose(1280, 640)))
    assert next(piece.ink for piece in found if piece.name == "key_U") == GREY


def lit(at: Composition, work: Work) -> tuple[float, float]:
    """The part of the hairline in the accent, as shares of its length."""
    (bar,) = (piece.box for piece in hairline_pieces(at, work) if isinstance(piece, Fill) and piece.ink == ACCENT)
    return (bar.left - at.hairline.left) / at.hairline.width, (bar.right - at.hairline.left) / at.hairline.width


def test_the_hairline_fills_with_the_work_that_is_done() -> None:
    at = compose(1280, 640)
    assert lit(at, Work("reading sky.exr", 0.43)) == pytest.approx((0.0, 0.43), abs=0.001)
    start, end = lit(at, Work("looking for suns", seconds=1.2))
    assert end - start == pytest.approx(0.2, abs=0.001)
    assert not [piece for piece in hairline_pieces(at) if isinstance(piece, Fill) and piece.ink == ACCENT]
    said = text_of(draw_overlay(PICTURES["green"], at, work=Work("reading sky.exr", 0.43, 3.0)))
    assert "reading sky.exr" in said
    assert all(words in said for words in ("43 %", "3 s left", "Esc stops"))


# --- the help


def help_of(size: tuple[int, int], page: int = 0) -> Overlay:
    state = picture_of(n_bands=5, help_visible=True, help_page=page)
    return draw_overlay(state, frame_for(state.state.view, *size), opengl="OpenGL 4.5, llvmpipe")


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_the_help_is_whole_on_its_pages_and_nothing_is_cut(size: tuple[int, int]) -> None:
    from shviewer.viewer.control.keys import BINDINGS

    pages = [help_of(size, page) for page in range(12)]
    said = {piece.name for page in pages for piece in texts_of(page)}
    for rows in BINDINGS.values():
        assert all(f"key_{row.label}" in said for row in rows)
    words = {piece.text for page in pages for piece in texts_of(page) if piece.name.startswith("does_")}
    assert not any("…" in text for text in words)
    for page in pages:
        for one, two in itertools.combinations(texts_of(page), 2):
            assert not overlap(shrunk(one.box), two.box), (one.text, two.text)
        for piece in texts_of(page):
            assert 0 <= piece.box.left < piece.right <= size[0]
            assert piece.baseline < size[1]


@pytest.mark.parametrize("size", [(480, 260), (540, 220)], ids=str)
def test_a_title_that_is_said_again_counts_in_its_column(size: tuple[int, int]) -> None:
    frame = frame_for(PICTURES["help"].state.view, *size)
    row = pages_of(frame)[2].row
    for page in range(12):
        lowest = max(piece.baseline for piece in texts_of(help_of(size, page)) if piece.name != "help_foot")
        assert lowest <= frame.height - frame.px(8) - row + 1, page  # rounded to a pixel


def test_the_help_covers_everything() -> None:
    assert (image_of(help_of((1280, 640)))[..., 3] == 255).all()
    assert "PageDown" not in text_of(help_of((1280, 640)))
    assert "PageDown: page 2 of" in text_of(help_of((400, 300), 1))


def test_the_help_says_what_is_at_work() -> None:
    shown = PICTURES["help"]
    at = compose(1280, 640)
    said = text_of(draw_overlay(shown, at, opengl="OpenGL 4.5", work=Work("reading sky.exr")))
    assert "reading sky.exr; Esc stops" in said
    assert "OpenGL 4.5" in text_of(draw_overlay(shown, at, opengl="OpenGL 4.5"))


def test_settings_stand_at_the_right_end_of_their_column_and_sentences_begin_in_line() -> None:
    """Where a column has the room, no sentence is broken."""
    drawn = help_of((1280, 640))
    columns: dict[int, list[float]] = {}
    for piece in texts_of(drawn):
        if piece.name.startswith("value_"):
            columns.setdefault(round(piece.right) // 420, []).append(piece.right)
        assert not piece.name.startswith("does_") or piece.name.endswith("_0"), piece
    assert len(columns) == 3
    for ends in columns.values():
        assert max(ends) - min(ends) <= 1


@pytest.mark.parametrize("size", [(1280, 640), (400, 300)])
def test_what_is_said_while_the_help_is_shown_is_seen(size: tuple[int, int]) -> None:
    """It was gone before the help was closed."""
    shown = picture_of(help_visible=True, message=message.warning("no path of a file is copied"))
    drawn = draw_overlay(shown, compose(*size), opengl="OpenGL 4.5")
    assert "no path of a file is copied" in text_of(drawn)
    assert faults(shown, compose(*size), drawn) == []


def test_turning_under_the_help_draws_anew_only_the_values_that_changed() -> None:
    at = compose(1280, 640)
    one, other = (draw_overlay(picture_of(camera=(azimuth, 20.0), help_visible=True), at) for azimuth in (10.0, 55.0))
    changed = [one for one, other in zip(one.layers, other.layers, strict=True) if one.image is not other.image]
    assert 0 < sum(layer.image.size for layer in changed) < image_of(one).size / 100


def test_the_help_shows_present_values() -> None:
    five, six = (text_of(draw_overlay(picture_of(n_bands=n, help_visible=True), compose(1280, 640))) for n in (5, 6))
    assert five != six


# --- the cursor and the bars


def bars_of(n_bands: int, size: tuple[int, int] = (1280, 640), **changes: object) -> Overlay:
    return draw_overlay(picture_of(n_bands=n_bands, **changes), compose(*size))


@pytest.mark.parametrize("page", [(1, 14), (15, 20), (21, 32)])
def test_a_band_keeps_its_slot_for_every_number_of_bands_on_a_page(page: tuple[int, int]) -> None:
    first, last = (bars_of(n) for n in page)
    assert first.bars == last.bars
    assert len(first.bars) >= page[1] + 4


@pytest.mark.parametrize("size", [(1280, 640), (640, 320)])
@pytest.mark.parametrize("to", [9, 16, 32])
def test_through_a_sweep_every_slot_stays_where_it_is(size: tuple[int, int], to: int) -> None:
    end = bars_of(to, size)
    for n_bands in range(1, to, max(to // 8, 1)):
        assert bars_of(n_bands, size, sweep_to=to).bars == end.bars


def test_slots_stand_side_by_side_and_a_click_finds_one() -> None:
    bars = bars_of(9).bars
    for band, box in bars.items():
        x, y = (box.left + box.right) / 2, (box.top + box.bottom) / 2
        assert [other for other, place in bars.items() if place.contains(x, y)] == [band]
    assert all(bars[band].right == pytest.approx(bars[band + 1].left) for band in range(len(bars) - 1))


def test_the_cursor_is_shown_under_its_band_once_it_is_used() -> None:
    without, at_2 = bars_of(5), bars_of(5, cursor=2, cursor_visible=True)
    changed = np.flatnonzero((image_of(without) != image_of(at_2)).any(axis=(0, 2)))
    assert without.bars[2].left <= changed.min()
    assert changed.max() <= without.bars[2].right
    np.testing.assert_array_equal(image_of(bars_of(5, cursor=2)), image_of(without))


def test_the_band_under_the_mouse_tells_its_values_in_place_of_the_legend() -> None:
    drawn = draw_overlay(PICTURES["green"], compose(1280, 640), hovered=4)
    assert "legend_radiance" not in drawn.boxes
    said = next(piece.text for piece in texts_of(drawn) if piece.name == "hovered").replace("\u202f", " ")
    assert said.startswith("band 4:")
    assert "28.3 %" in said


@pytest.mark.parametrize(
    "view", [{"by_roughness": True}, {"quantity": "irradiance", "encode": "zh3", "n_bands": 3}, {}]
)
def test_what_explains_the_curve_stands_at_the_foot_where_it_has_no_line_and_is_whole(view: dict[str, object]) -> None:
    shown = picture_of("film_studio", **view)
    for size in ((500, 1000), (720, 720), (1280, 640)):
        drawn = draw_overlay(shown, frame_of(shown, *size), hovered=None if view else 3)
        (said,) = [piece for piece in texts_of(drawn) if piece.name in ("steps_sentence", "stored_legend", "hovered")]
        assert "…" not in said.text, size
    working = draw_overlay(shown, frame_of(shown, 500, 1000), work=Work("projecting"))
    assert [piece.text for piece in texts_of(working) if piece.name in ("message", said.name)] == ["projecting"]


@pytest.mark.parametrize("size", [(500, 1000), (640, 360), (720, 720), (1280, 720)])
@pytest.mark.parametrize("error", ["off", "signed"])
def test_what_the_radius_of_surfaces_is_is_said_once(size: tuple[int, int], error: str) -> None:
    shown = picture_of(lobe_view=True, error=error, n_bands=6)
    said = [piece.text for piece in texts_of(draw_overlay(shown, frame_of(shown, *size))) if "radius" in piece.text]
    assert len(said) == 1, size


def test_a_zoomed_frame_has_the_same_numbers() -> None:
    plain, zoomed = PICTURES["green"], picture_of(zoom=2.0)
    one, two = (draw_overlay(shown, frame_of(shown)) for shown in (plain, zoomed))
    assert one.bars == two.bars
    assert [p for p in pieces_of(one) if isinstance(p, Disc)] == [p for p in pieces_of(two) if isinstance(p, Disc)]


# --- numbers


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.0, "0 %"),
        (1e-9, "< 0.0001 %"),
        (1.1e-6, "0.0001 %"),
        (0.0123456, "1.23 %"),
        (0.283, "28.3 %"),
        (0.9998, "99.98 %"),
        (0.999999, "99.9999 %"),
        (1.0, "100 %"),
        (1.234, "123 %"),
        (16.0, "1600 %"),
        (float("inf"), "infinite"),
        (float("nan"), "infinite"),
    ],
)
def test_a_share_has_three_digits_and_never_rounds_up_to_100(share: float, text: str) -> None:
    assert percent(share) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (1e-13, "0"),
        (-1e-13, "0"),
        (1e-9, "1.00e-9"),
        (-0.137, "-0.137"),
        (0.0012345, "0.00123"),
        (0.26512, "0.265"),
        (0.99999, "1.00"),
        (9.9999, "10.0"),
        (5.0, "5.00"),
        (-42.42, "-42.4"),
        (99999.0, "99999"),
        (1.6e9, "1.60e9"),
        (-3.21e-7, "-3.21e-7"),
    ],
)
def test_a_radiance_has_three_digits_or_a_power_of_ten(value: float, text: str) -> None:
    assert radiance(value, 1e-6) == text


def pixels(drawn: Overlay, box: Box) -> NDArray[np.uint8]:
    return image_of(drawn)[round(box.top) : round(box.bottom), round(box.left) : round(box.right)]


def test_thousands_stand_apart_where_there_are_more_than_four_digits() -> None:
    said = [value(radiance, 1.0) for radiance in (1234.0, -94515.0, 99985.0, 123456.0, 0.12345)]
    assert said == ["1234", "−94\u202f515", "99\u202f985", "1.23 × 10⁵", "0.123"]


def test_what_is_written_is_drawn_where_it_says() -> None:
    drawn = draw_overlay(PICTURES["green"], compose(1280, 640))
    for piece in texts_of(drawn):
        assert (pixels(drawn, piece.box)[..., 3] > 128).any(), piece
    outside = image_of(drawn)[..., 3] > 60
    for piece in pieces_of(drawn):
        box = piece.box
        outside[int(box.top) - 2 : int(box.bottom) + 3, max(int(box.left) - 2, 0) : int(box.right) + 3] = False
    assert not outside.any()


@pytest.mark.parametrize(("error", "left"), [("signed", True), ("absolute", False), ("relative", False)])
def test_a_tip_stands_only_where_colours_go_on_and_the_bar_fills_the_rest(error: str, left: bool) -> None:
    shown = picture_of("venice_sunset", n_bands=9, error=error)
    at = frame_of(shown, 1280, 720)
    bar, place = draw_overlay(shown, at).boxes["colour_bar"], at.colour_bar
    assert shown.error_scale is not None
    assert place is not None
    assert shown.error_scale.beyond
    assert (bar.left - place.left, place.right - bar.right) == (7 if left else 0, 7)
