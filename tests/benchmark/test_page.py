"""The page is made of the report alone: its first answer, its sections, and the same page in HTML."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from places import ROOT

from shviewer.analysis.figures import needs
from shviewer.analysis.recipe import Recipe
from shviewer.benchmark.measuring.bands import BANDS_KEY, bands_extra
from shviewer.benchmark.measuring.measured_lights import find_measured_lights
from shviewer.benchmark.page.bands_page import needed_lines
from shviewer.benchmark.page.html import as_html
from shviewer.benchmark.page.section import Page
from shviewer.benchmark.page.writing import SECTIONS, as_markdown
from shviewer.benchmark.rows.report import Report, read_report
from shviewer.benchmark.rows.row import Row
from shviewer.cli.options.modes import PARSERS

COMMITTED = ROOT / "assets" / "report"


@pytest.fixture(scope="module")
def committed() -> Page:
    plots = [path.name for path in sorted(COMMITTED.glob("*.svg"))]
    return Page(read_report(COMMITTED / "report.json"), plots)


def test_the_page_of_the_guide_is_what_its_rows_make(committed: Page) -> None:
    """So a sentence on the page is never older than the code that writes it."""
    assert as_markdown(committed) == (COMMITTED / "report.md").read_text(encoding="utf-8")


def test_the_page_first_says_how_many_bands_each_light_needs() -> None:
    lights = find_measured_lights(["green", "venice_sunset"])
    page = "\n".join(needed_lines(Page(Report(0, "", {}, {}, extra={BANDS_KEY: bands_extra(lights)}))))
    said = " ".join(page.split())
    assert (
        "Within 5 %: 3 bands shade with all of these lights; to be seen it takes 15 for green and more than 128 for"
        " venice_sunset." in said
    )
    rows = {line.split("|")[1].strip(): line.split("|")[2:-1] for line in page.splitlines() if line.startswith("| ")}
    for name in ("green", "venice_sunset"):
        for sun_apart in (False, True):
            row = rows.get(f"{name}, sun apart" if sun_apart else name)
            if row is None:
                assert (name, sun_apart) == ("green", True)  # it has none
                continue
            for column, tolerance in enumerate((0.1, 0.05, 0.01)):
                found = needs(Recipe(name, tolerance=tolerance, split_sun=sun_apart))
                for place, count in ((column, found.radiance), (column + 3, found.irradiance)):
                    assert row[place].strip() == ("> 128" if count is None else str(count))
    assert rows["venice_sunset, sun apart"][0].strip() == "29"


def test_every_section_says_the_command_that_makes_it(committed: Page) -> None:
    page = as_markdown(committed)
    flags = {
        flag for mode in ("report", "info") for action in PARSERS[mode]()._actions for flag in action.option_strings
    }
    for title, command, _ in SECTIONS:
        assert command.startswith(("shviewer report", "shviewer info"))
        assert set(re.findall(r"--[\w-]+", command)) <= flags
        if f"## {title}\n" in page:
            assert f"## {title}\n\n`{command}`\n" in page
    assert page.count("\n## ") > 9


def test_every_plot_stands_in_the_section_that_it_belongs_to(committed: Page) -> None:
    page = as_markdown(committed)
    assert sorted(re.findall(r"!\[[^\]]+\]\(([^)]+)\)", page)) == sorted(committed.plots)
    sections = dict(re.findall(r"\n## ([^\n]+)\n(.*?)(?=\n## |\Z)", page, re.DOTALL))
    assert "(error-bands.svg)" in sections["How many bands"]
    assert "(time-error-green.svg)" in sections["What to use"].partition("### hemisphere")[0]
    assert "(moving-bands.svg)" in sections["Lights that move"]


def test_a_front_tells_its_points_apart(committed: Page) -> None:
    """Seven of eleven lines of a photograph's front ended on 6.8e-01 or 7.0e-01."""
    use = as_markdown(committed).partition("## What to use")[2].partition("\n## ")[0]
    fronts = re.findall(r"\| on the front(?:.*\|\n?)+", use)
    assert len(fronts) == 5
    for front in fronts:
        cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in front.strip().splitlines()[2:]]
        points = [(float(row[3]), float(row[-1].removesuffix(" %"))) for row in cells]
        assert len({ms for ms, _ in points}) == len({total for _, total in points}) == len(points)
        assert [ms for ms, _ in points] == sorted(ms for ms, _ in points)
        assert [total for _, total in points] == sorted((total for _, total in points), reverse=True)


def test_a_peer_is_compared_with_us_in_a_sentence() -> None:
    def row(method: str, ms: float) -> Row:
        return Row(
            section="peers", method=method, light="room", n_bands=9, milliseconds=ms,
            low_quartile=0.99 * ms, high_quartile=1.01 * ms, note="image",
        )  # fmt: skip

    report = Report(0, "", {}, {}, rows=[row("shviewer", 2.0), row("ducc0 f32", 5.0), row("pyshtools", 7.0)])
    report.note("peers", ["shtns: shtns is not installed"])
    page = as_markdown(Page(report))
    assert (
        "- room, image, 9 bands: the fastest peer, ducc0 f32, takes 5.00 ms, 2.5 times as long as shviewer (2.00 ms)."
        in page
    )
    assert "- without shtns: shtns is not installed" in page


class _Reader(HTMLParser):
    """Checks that tags close as they open, and keeps texts and pictures."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.words: list[str] = []
        self.pictures: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.pictures.append(str(dict(attrs)["src"]))
        elif tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if "style" not in self.open:
            self.words += data.split()


def test_the_page_in_html_has_every_word_number_and_picture(committed: Page) -> None:
    text = as_markdown(committed)
    reader = _Reader()
    reader.feed(as_html(text))
    assert reader.open == []
    assert reader.pictures == re.findall(r"\]\(([^)]+)\)", text)
    plain = re.sub(r"!\[[^\]]*\]\([^)]*\)|^\|[-:|]+\|$|^#+ |^- |```|[|*`]", " ", text, flags=re.MULTILINE).split()
    assert "".join(reader.words).replace("|", "").endswith("".join(plain).replace("\\", ""))


def test_html_escapes_what_a_light_is_called_and_leaves_stars_in_code_and_words_alone() -> None:
    page = as_html(
        '# T\n\n- <b>&"x": a*b*c, `*p*`, *once*, **two\n  words**\n\n| a | b |\n|---|--:|\n| x \\| y | 1 000 |\n'
    )
    assert "&lt;b&gt;&amp;&quot;x&quot;: a*b*c, <code>*p*</code>, <em>once</em>, <strong>two\n  words</strong>" in page
    assert "<img" not in as_html("# T\n\n![a light](http://elsewhere/x.svg) ![b](../x.svg) ![c](x.png)\n")
    assert '<td>x | y</td><td class="n">1\u00a0000</td>' in page


def test_the_page_needs_nothing_from_elsewhere_and_is_white_on_paper(committed: Page, tmp_path: Path) -> None:
    page = as_html(as_markdown(committed))
    assert not re.search(r"https?:|<script|<link|@import", page)
    assert "@media print" in page
    assert 'name="viewport"' in page
