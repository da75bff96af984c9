"""acceptance.toml: what is read, and what is refused with which words."""

import pytest

from murkscan.errors import FormatError
from murkscan.io.acceptance_toml import load_acceptance, parse_acceptance
from murkscan.types.acceptance import CalibratedBall, CalibratedBar, Limits

TEXT = """
format = 1
name = "bar"
[[ball]]
name = "A"
near_m = [0.0, 0.1, 0.8]
diameter_mm = 80.0
diameter_sigma_mm = 0.002
form_mm = 0.001
[[ball]]
name = "B"
near_m = [0.4, 0.1, 0.8]
diameter_mm = 80.0
[[bar]]
balls = ["A", "B"]
length_mm = 400.0
length_sigma_mm = 0.003
[[plate]]
name = "P"
near_m = [0.0, 0.5, 0.8]
within_mm = 60.0
[limits]
sphere_spacing_mm = 0.3
"""


def test_lengths_are_read_in_metres():
    test = parse_acceptance(TEXT, "bar.toml")
    assert test.balls[0] == CalibratedBall("A", (0.0, 0.1, 0.8), 0.08, 2e-6, 1e-6)
    assert test.bars == (CalibratedBar("A", "B", 0.4, 3e-6),)
    assert (test.plates[0].within, test.plates[0].flatness) == (0.06, 0.0)
    assert test.limits == Limits(sphere_spacing=0.3e-3)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("diameter_mm = 80.0", "diameter_mm = -80.0", "ball.0.diameter_mm"),
        ("diameter_mm = 80.0", "diametre_mm = 80.0", "ball.0.diametre_mm is unknown"),
        ('["A", "B"]', '["A", "C"]', "names 'C', but there is no"),
        ('["A", "B"]', '["A", "A"]', "twice; a bar has two balls"),
        ('name = "P"', 'name = "B"', "'B' stands twice"),
        ("sphere_spacing_mm = 0.3", "sphere_spacing_mm = nan", "limits.sphere_spacing_mm"),
        ("format = 1", "format = 2", "format"),
        ("length_mm = 400.0", "length_mm = inf", "bar.0.length_mm"),
    ],
)
def test_a_wrong_file_is_one_sentence_that_names_it(old, new, words):
    assert old in TEXT
    with pytest.raises(FormatError, match=r"^bar\.toml: [^\n]*") as refused:
        parse_acceptance(TEXT.replace(old, new), "bar.toml")
    assert words in str(refused.value)


def test_a_file_that_is_missing_or_names_nothing_is_refused(tmp_path):
    with pytest.raises(FormatError, match="no file"):
        load_acceptance(tmp_path / "none.toml")
    with pytest.raises(FormatError, match="names no artefact"):
        parse_acceptance('format = 1\nname = "nothing"', "empty.toml")
