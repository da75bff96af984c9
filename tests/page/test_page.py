"""Pages: whole, self-contained, and safe with whatever names users' files have."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest

from murkscan.page import (
    ACCENT,
    Code,
    Facts,
    Figure,
    Gallery,
    Note,
    Picture,
    Section,
    Table,
    as_svg,
    format_cell,
    new_figure,
    render_page,
)

VOID = {"meta", "img", "br", "link", "hr", "input"}
HOSTILE = "<script>alert('x')</script> & \"quoted\" {{ 7 * 7 }}"


class Structure(HTMLParser):
    """Checks that every tag that is opened is closed, and collects what a reader finds."""

    def __init__(self, page):
        super().__init__()
        self.open, self.tags, self.addresses, self.text, self.ids = [], [], [], [], []
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attrs:
            assert not name.startswith("on")
            if name in ("src", "href"):
                self.addresses.append(value)
            if name == "id":
                self.ids.append(value)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)


def _figure(name):
    figure, axes = new_figure()
    axes.plot(np.arange(5), np.arange(5) ** 2, color=ACCENT)
    axes.set(xlabel="time [s]", ylabel="signal")
    return Figure(as_svg(figure, name=name, title=f"Figure {name}"), f"Figure {name}")


@pytest.fixture(scope="module")
def page():
    pictures = [Picture("../view/isometric.png", "isometric"), Picture("a:b?c#d é.png", "odd")]
    sections = [
        Section("", [Note("Went well.", "good"), Facts([("45", "points")])]),
        Section("Figures", [_figure("one"), _figure("two")]),
        Section("Pictures", [Gallery(pictures, is_first_large=True)]),
        Section("Table", [Table([("a", 1, 2.5, None)], head=("", "n", "x", "nothing"))]),
        Section("Settings", [Table([("speed", "0.1")])]),
    ]
    return render_page("Scan report", sections, subtitle="harbour.mkv")


def test_a_page_is_well_formed_and_has_all_that_it_was_given(page):
    found = Structure(page)
    text = " ".join("".join(found.text).split())
    for words in ("Went well.", "45", "Figure two", "isometric", "speed", "2.5", "time [s]"):
        assert words in text
    assert found.tags.count("svg") == 2
    assert found.tags.count("img") == 2


def test_a_page_needs_nothing_from_elsewhere_and_runs_no_script(page):
    found = Structure(page)
    assert "script" not in found.tags
    assert "link" not in found.tags
    assert "://" not in page
    assert "@import" not in page
    for address in found.addresses:
        assert address.startswith(("./", "../", "#"))


def test_an_odd_file_name_is_still_an_address_of_that_file(page):
    assert "./a%3Ab%3Fc%23d%20%C3%A9.png" in Structure(page).addresses


def test_parts_of_two_figures_do_not_get_mixed_up(page):
    found = Structure(page)
    assert len(found.ids) == len(set(found.ids)) > 0
    references = re.findall(r'url\(#([^)]*)\)|href="#([^"]*)"', page)
    assert references
    assert {a or b for a, b in references} <= set(found.ids)


def test_figures_follow_the_theme_of_the_page(page):
    assert "prefers-color-scheme: dark" in page
    assert "var(--accent)" in page.split("<svg", 1)[1]
    drawn = page[page.index("<svg") : page.rindex("</svg>")]
    colours = set(re.findall(r"(?:stroke|fill): ?(#\w+|\w+\([^)]*\)|\w+)", drawn))
    assert colours <= {"none", "var(--muted)", "var(--line)", "var(--accent)"}


def test_the_same_figure_gives_the_same_text():
    assert _figure("one").svg == _figure("one").svg


def test_hostile_text_stays_text_everywhere():
    figure, axes = new_figure()
    axes.set_xlabel("<script>")
    sections = [
        Section(HOSTILE, [Note(HOSTILE), Facts([(HOSTILE, HOSTILE)])]),
        Section("", [Table([(HOSTILE, HOSTILE)]), Table([(HOSTILE,)], head=(HOSTILE,))]),
        Section("", [Gallery([Picture(HOSTILE, HOSTILE)]), Code([HOSTILE])]),
        Section("", [Figure(as_svg(figure, name="f", title=HOSTILE), HOSTILE)]),
    ]
    found = Structure(render_page(HOSTILE, sections, subtitle=HOSTILE))
    assert "script" not in found.tags
    # Title twice, subtitle twice, heading, note, two of facts, two and two of tables, two captions,
    # and a line to be typed.
    assert "".join(found.text).count(HOSTILE) == 15


@pytest.mark.parametrize(
    ("cell", "text"),
    [
        (1234567, "1\u202f234\u202f567"),
        (0.012346, "0.01235"),
        (None, "–"),
        ("1234", "1234"),
        (0, "0"),
    ],
)
def test_cells_are_written_for_people(cell, text):
    assert format_cell(cell) == text
