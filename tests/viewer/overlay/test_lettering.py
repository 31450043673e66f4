"""Letters: every text is drawn by a face that has it, or escaped; never as boxes."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTFont  # of matplotlib, which the tests need anyway
from places import ROOT

from shviewer.viewer.overlay.drawing import layer_of
from shviewer.viewer.overlay.inks import INK
from shviewer.viewer.overlay.letters import glyphs, lettering
from shviewer.viewer.overlay.letters.glyphs import Face, coverage, has, system_face
from shviewer.viewer.overlay.letters.lettering import (
    FINE,
    MEDIUM,
    REGULAR,
    SEMIBOLD,
    escaped,
    mask,
    shortened_to,
    width_of,
)
from shviewer.viewer.overlay.letters.numerals import bound_text, share, typeset
from shviewer.viewer.overlay.pieces import Text

FONTS = ROOT / "assets" / "fonts"
WEIGHTS = (REGULAR, MEDIUM, SEMIBOLD)


@pytest.mark.parametrize("weight", WEIGHTS)
def test_the_coverage_of_a_face_is_what_fonttools_reads(weight: str) -> None:
    path = FONTS / f"Inter-{weight}.otf"
    ours = {code for first, last in coverage(Face(str(path))) for code in range(first, last + 1)}
    assert ours == set(TTFont(path).getBestCmap())
    assert len(ours) > 500


def test_the_licence_of_the_face_is_beside_it() -> None:
    said = (FONTS / "OFL.txt").read_text(encoding="utf-8")
    assert "SIL OPEN FONT LICENSE Version 1.1" in said
    assert "Inter Project Authors" in said


@pytest.mark.parametrize("weight", WEIGHTS)
def test_digits_and_signs_have_one_width_so_that_numbers_do_not_dance(weight: str) -> None:
    widths = [width_of(sign, 18, weight) for sign in "0123456789−+"]
    assert max(widths) - min(widths) < 0.3  # of a pixel


def test_every_character_that_the_picture_sets_is_in_the_face() -> None:
    assert all(has(Face(str(FONTS / "Inter-Regular.otf")), c) for c in "−×…\u202f↑↓←→≤≥°–%>")
    assert typeset("-1.08e-5") == typeset("-1.08e-05") == "−1.08 × 10⁻⁵"
    assert typeset("3e+08") == "3 × 10⁸"
    assert mask("10⁻⁵", 18).coverage.any()


def test_a_power_of_ten_stands_raised_and_smaller() -> None:
    plain, raised = mask("105", 20), mask("10⁵", 20)
    assert width_of("10⁵", 20) < width_of("105", 20)
    rows = np.flatnonzero(raised.coverage[:, -12:].any(axis=1))  # of the exponent alone
    assert rows.max() < plain.ascent - 3


def test_a_text_has_the_same_baseline_and_place_at_every_size() -> None:
    for size in (11.0, 12.0, 13.5, 28.0):
        found = mask("H", size)
        rows = np.flatnonzero((found.coverage > 100).any(axis=1))
        assert rows.max() + 1 == found.ascent
        assert rows.max() - rows.min() + 1 == pytest.approx(0.727 * size, abs=1)  # the height of capitals


def test_letters_are_averaged_from_four_times_the_size() -> None:
    assert FINE == 4
    assert len(np.unique(mask("a", 12).coverage)) > 8


@pytest.mark.parametrize(
    "name", ["日の出", "شروق", "שלום", "🌅 dawn", "a\u0000b", "зоря Ω é", "क्षितिज", "a\ufeff\u202eb"]
)
def test_any_name_is_letters_or_escapes(name: str) -> None:
    """Whatever faces this machine has: each character is drawn by a face that has it, or escaped in ASCII."""
    shown = escaped(name)
    for character in shown:
        face = lettering._face_of(character)
        assert face is not None
        assert face in (lettering.OURS, lettering.RAISE) or has(face, character)
    assert mask(shown, 15).coverage.any()
    assert escaped(shown) == shown


@pytest.mark.skipif(shutil.which("fc-match") is None or sys.platform != "linux", reason="no fontconfig here")
def test_a_face_of_the_system_draws_what_ours_lacks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One made here, so that it does not matter which faces the machine has."""
    square = TTGlyphPen(None)
    square.moveTo((100, 0))
    for corner in ((100, 800), (900, 800), (900, 0)):
        square.lineTo(corner)
    square.closePath()
    builder = FontBuilder(1000)
    builder.setupGlyphOrder([".notdef", "sun"])
    builder.setupCharacterMap({0x65E5: "sun"})
    builder.setupGlyf({".notdef": TTGlyphPen(None).glyph(), "sun": square.glyph()})
    builder.setupHorizontalMetrics({".notdef": (1000, 0), "sun": (1000, 100)})
    builder.setupHorizontalHeader(ascent=900, descent=-100)
    builder.setupNameTable({"familyName": "Suns", "styleName": "Regular"})
    builder.setupOS2()
    builder.setupPost()
    builder.save(tmp_path / "suns.ttf")
    where = f"<dir>{tmp_path}</dir><cachedir>{tmp_path}/cache</cachedir>"
    (tmp_path / "fonts.conf").write_text(f"<fontconfig>{where}</fontconfig>", encoding="utf-8")
    monkeypatch.setenv("FONTCONFIG_FILE", str(tmp_path / "fonts.conf"))
    caches = (system_face, lettering._face_of, escaped, mask, width_of)
    for cache in caches:
        cache.cache_clear()
    assert escaped("\u65e5.hdr \u672c") == "\u65e5.hdr \\u672c"
    assert width_of("\u65e5", 20.0) == 20.0
    drawn = mask("\u65e5", 20.0).coverage
    assert (drawn > 200).sum() == pytest.approx(16 * 16, abs=40)
    for cache in caches:
        cache.cache_clear()


def test_what_no_face_has_is_escaped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(lettering, "system_face", lambda character: None)
    lettering._face_of.cache_clear()
    escaped.cache_clear()
    assert escaped("日 a é 🌅") == "\\u65e5 a é \\U0001f305"
    lettering._face_of.cache_clear()
    escaped.cache_clear()


def test_a_machine_without_any_way_to_find_faces_has_none(monkeypatch: pytest.MonkeyPatch) -> None:
    for system in ("linux", "win32", "darwin"):
        monkeypatch.setattr(glyphs.sys, "platform", system)
        monkeypatch.setattr(glyphs.shutil, "which", lambda program: None)
        monkeypatch.setenv("WINDIR", "/nowhere")
        system_face.cache_clear()
        assert system_face("\u65e5") is None
    system_face.cache_clear()


@pytest.mark.parametrize("data", [b"", b"ttcf", b"OTTO\0\1" + bytes(20), b"\0\1\0\0\xff\xff" + bytes(4000)])
def test_a_damaged_font_file_has_no_characters(data: bytes, tmp_path: object) -> None:
    from pathlib import Path

    path = Path(str(tmp_path)) / "a.ttf"
    path.write_bytes(data)
    assert coverage(Face(str(path))) == ()


def test_a_long_name_loses_its_middle_and_keeps_its_ends() -> None:
    name = "a_light_whose_name_is_much_longer_than_anybody_would_want.hdr"
    for room in (60.0, 120.0, 240.0):
        shown = shortened_to(name, room, 15.0, SEMIBOLD)
        assert width_of(shown, 15.0, SEMIBOLD) <= room
        head, _, tail = shown.partition("…")
        assert name.startswith(head)
        assert name.endswith(tail)
        assert abs(len(head) - len(tail)) <= 1
    assert shortened_to(name, 10.0, 15.0) == ""
    assert shortened_to("green", 100.0, 15.0) == "green"


def test_equal_pieces_are_the_same_layer() -> None:
    pieces = (Text("a", 10, 20, "28.3 %", 18, INK),)
    assert layer_of(pieces) is layer_of((Text("a", 10, 20, "28.3 %", 18, INK),))
    assert layer_of(pieces) is not layer_of((Text("a", 10, 20, "28.4 %", 18, INK),))


@pytest.mark.parametrize(
    ("said", "text"),
    [
        ("-0.137", "−0.137"),
        ("1.60e9", "1.60 × 10⁹"),
        ("28.3 %", "28.3\u202f%"),
        ("40 960 000 samples", "40\u202f960\u202f000 samples"),
        ("a-name-2.hdr", "a-name-2.hdr"),
        ("Y(3,-2)", "Y(3,−2)"),
        ("muted 3-5", "muted 3-5"),
        ("1024 x 512", "1024 x 512"),
    ],
)
def test_numbers_are_set_with_a_minus_thin_spaces_and_powers(said: str, text: str) -> None:
    assert typeset(said) == text


@pytest.mark.parametrize(
    ("value", "floor", "text"),
    [
        (0.283, 1e-7, "28.3 %"),
        (1e-6, 1e-7, "< 0.001 %"),
        (1e-9, 1e-7, "< 0.001 %"),
        (1e-4, 1e-3, "< 0.1 %"),
        (0.0, 0.0, "0 %"),
    ],
)
def test_a_share_says_no_more_than_can_be_known(value: float, floor: float, text: str) -> None:
    assert share(value, floor=floor) == typeset(text)


@pytest.mark.parametrize(
    ("found", "bound", "text"),
    [
        (0.266, 0.281, " – 0.281"),
        (0.266, 0.2665, ""),
        (-0.137, -0.15, " to −0.150"),
        (0.266, None, ""),
        (0.0, 1e-9, ""),
    ],
)
def test_only_a_bound_that_is_not_reached_is_said(found: float, bound: float | None, text: str) -> None:
    assert bound_text(found, bound, 1.0) == text


@pytest.mark.parametrize(
    ("bound", "digits", "text"),
    [
        (-0.1101, 2, " to −0.12"),
        (-0.11, 2, " to −0.11"),
        (-2.71e-5, 2, " to −2.8 × 10⁻⁵"),
        (99.1, 2, " – 100"),
        (99910.0, 2, " – 1.0 × 10⁵"),
    ],
)
def test_a_bound_in_fewer_digits_is_still_a_bound(bound: float, digits: int, text: str) -> None:
    assert bound_text(0.0, bound, 1.0, digits) == text
