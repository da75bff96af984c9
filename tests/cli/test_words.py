"""What commands say at their end: in words that hold, as wide as the terminal."""

import pytest

from murkscan.cli.words import fit_columns, wrap
from murkscan.cloud import OUTLIER_RULES, Outside
from murkscan.project.results import CloudResult, ExtractResult, MeshResult, ReportResult
from murkscan.report import CAUSES
from murkscan.ui.results import tell_made, tell_quality

PATH = "/a/very/long/folder/that-has-hyphens/and is/longer/than/the/terminal.csv"


def test_lines_fit_the_terminal_and_go_on_under_their_first_word():
    lines = wrap("quality    " + "some words of a sentence " * 8, 40, indent=11).splitlines()
    assert all(len(line) <= 40 for line in lines)
    assert all(line.startswith(" " * 11) and line[11] != " " for line in lines[1:])


def test_a_path_is_never_broken():
    path = PATH.replace(" ", "_")
    assert path in wrap(f"made       a file: {path}", 30, indent=11)


def test_frames_without_a_stripe_are_told_and_many_come_with_advice():
    few = ExtractResult((0,), frames=100, skipped=0, frames_without_stripe=5, points=900)
    many = ExtractResult((0,), frames=100, skipped=0, frames_without_stripe=60, points=300)
    assert tell_quality(few) == ("5 frames (5%) show no stripe",)
    assert "extract/overlay" in tell_quality(many)[0]
    assert "100 frames read, 0 skipped" in tell_made(few)


@pytest.mark.parametrize(
    "cause", [*(r.cause for r in OUTLIER_RULES), Outside((0.0,) * 3, (1.0,) * 3).cause]
)
def test_every_reason_to_take_a_point_out_has_words(cause):
    said = tell_quality(CloudResult(1000, 7, {cause: 7}))
    assert len(said) == 1
    assert "taken out: 7 points" in said[0]
    assert "by the rule" not in said[0]


def test_what_was_left_out_on_request_is_no_reason_to_doubt():
    asked = CloudResult(100, 407, {"volume": 400, "density": 7})
    assert tell_made(asked) == "100 points, 7 outliers taken out, 400 left out with the volume"
    assert len(tell_quality(CloudResult(100, 400, {"volume": 400}))) == 1
    assert "that is much" in tell_quality(CloudResult(100, 400, {"density": 400}))[-1]


@pytest.mark.parametrize("cause", CAUSES)
def test_every_gap_of_the_report_has_words(cause):
    said = tell_quality(ReportResult(10, 0, 0, 99, covered=0.9, largest_gap=cause))
    assert said[0].startswith("90 % of the surface")
    assert " since " in said[0]


def test_an_interval_says_whether_it_heeds_the_calibration():
    own = ReportResult(10, 0, 0, 99, half_width=3e-4, own_half_width=3e-4)
    both = ReportResult(10, 0, 0, 99, half_width=5e-4, own_half_width=3e-4)
    assert tell_quality(own)[0].endswith("± 0.3 mm (95 %) by its noise")
    assert "to ± 0.5 mm with what calibration" in tell_quality(both)[0]


def test_an_empty_surface_says_where_to_look():
    assert "extract/overlay" in tell_quality(MeshResult(0, 0))[0]


TABLE = [("plane", "value", "1σ common"), ("normal x", "-0.000123", "unknown")]


def test_a_narrow_table_breaks_between_words_and_cuts_none():
    assert fit_columns(TABLE, 80) == [8, 9, 9]
    assert fit_columns(TABLE, 34) == [8, 9, 7]


def test_a_table_whose_words_have_no_room_is_told_as_a_list():
    least = sum((6, 9, 7)) + 3 * 3 + 1
    assert fit_columns(TABLE, least) == [6, 9, 7]
    assert fit_columns(TABLE, least - 1) is None
