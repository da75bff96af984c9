"""The judge of finders on real recordings has to be fair, and able to fail."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).resolve().parents[1] / "benchmarks"))

from harness import Figure
from real_judge import failures, judge, pool
from real_truth import by_line, load_drawing, tell_truth

LENGTH, NUM_LINES = 486, 648
"""Of the picture of the steps under water."""
NAMES = ("threshold-skeleton", "gray-gravity", "gaussian", "steger", "murk")


@pytest.fixture(scope="module")
def drawing():
    return load_drawing("steps", NUM_LINES)


@pytest.fixture(scope="module")
def drawn(drawing):
    """What a finder gives that follows the drawing: frame, scan line, position."""
    cells = sorted(drawing.lines.items())
    return np.array([(*cell, position) for cell, places in cells for position in places])


def moved(rows, by):
    """Shift all centres along their scan lines [px]."""
    return rows + np.array([0.0, 0.0, by])


def judged(rows, drawing, *, name="murk", **others):
    found = {one: by_line(rows) for one in NAMES} | {k: by_line(v) for k, v in others.items()}
    return judge(rows, tell_truth(drawing, name, found), length=LENGTH)


@pytest.mark.parametrize("name", NAMES)
def test_a_finder_that_follows_the_drawing_is_right_throughout(drawing, drawn, name):
    figures = pool([judged(drawn, drawing, name=name)])
    assert (figures["R"], figures["P"], figures["edge"]) == (100.0, 100.0, 0.0)


def test_a_shifted_finder_finds_nothing(drawing, drawn):
    """2 px are more than the 1.5 by which the agreed centres are judged."""
    shifted = moved(drawn, 2.0)
    witnesses = {"gray-gravity": by_line(drawn), "gaussian": {}, "steger": by_line(drawn)}
    figures = pool([judge(shifted, tell_truth(drawing, "murk", witnesses), length=LENGTH)])
    assert figures["R"] == 0.0
    assert figures["P"] == 0.0


def test_a_finder_that_shifts_its_witnesses_too_gains_nothing(drawing, drawn):
    """Beyond 4 px of the drawing even what all agree on is not the line."""
    figures = pool([judged(moved(drawn, 6.0), drawing)])
    assert figures["R"] == 0.0
    assert figures["P"] == 0.0


def test_points_along_the_edge_are_false_and_told(drawing, drawn):
    edge = np.stack([np.zeros(NUM_LINES), np.arange(NUM_LINES), np.full(NUM_LINES, 1.0)], axis=1)
    figures = pool([judged(np.concatenate([drawn, edge]), drawing)])
    assert figures["R"] == 100.0
    assert figures["P"] < 50.0
    assert figures["edge"] > 50.0


def test_a_second_point_beside_the_first_is_false(drawing, drawn):
    verdict = judged(np.concatenate([drawn, moved(drawn, 0.5)]), drawing)
    assert verdict.is_hit.all()
    assert verdict.is_right.sum() == len(verdict.true)
    assert len(list(failures("steps", verdict))) == (~verdict.is_right).sum()


def test_half_of_the_line_is_half_the_recall(drawing, drawn):
    figures = pool([judged(drawn[::2], drawing)])
    assert figures["R"] == pytest.approx(50.0, abs=1.0)
    assert figures["P"] == 100.0


def test_who_is_judged_has_no_say_in_what_is_true(drawing, drawn):
    """Murk's own points, wherever they lie, leave the truth that it is judged by as it is."""
    lines = {name: by_line(moved(drawn, 0.3)) for name in NAMES}
    truth = tell_truth(drawing, "murk", lines)
    again = tell_truth(drawing, "murk", lines | {"murk": by_line(moved(drawn, -3.0))})
    np.testing.assert_array_equal(truth.rows, again.rows)


def test_a_finder_without_points_meets_no_bar(drawing):
    figures = pool([judged(np.zeros((0, 3)), drawing)])
    assert figures["R"] == 0.0
    assert Figure("precision", figures["P"], at_least=0.0).is_missed
