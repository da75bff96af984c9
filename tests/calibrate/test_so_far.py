"""What photos that are still being taken are told to be worth, and which are missing."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate import (
    BoardView,
    StripeOnBoard,
    calibrate_camera,
    calibrate_lasers,
    calibrate_port,
)
from murkscan.calibrate.adjust.observations import index_of
from murkscan.calibrate.adjust.parameters import INTRINSICS
from murkscan.calibrate.adjust.solve import adjust
from murkscan.calibrate.board.pose import locate_seen_board
from murkscan.calibrate.region import errors_where_seen
from murkscan.calibrate.so_far import judge_so_far, untilted

from .boards import BOARD, CAMERA, rotation, views
from .underwater import FLAT, LENS, POOL, rig_behind, see_boards, see_stripes


def judge_camera(seen):
    return judge_so_far(
        "camera", seen, BOARD, CAMERA.size, lambda: calibrate_camera(seen, BOARD, CAMERA.size)
    )


EDGES = {"left": (-1, 0), "right": (1, 0), "upper": (0, -1), "lower": (0, 1)}


@pytest.mark.parametrize("tilt", [(25, 0), (-25, 0), (0, 25), (0, -25)])
def test_the_edge_that_is_nearer_is_the_one_not_asked_for(tilt):
    turned = rotation(*tilt, 10)
    corners = np.array([[x, y, 0.0] for x, y in EDGES.values()])
    nearest = list(EDGES)[int((turned @ corners.T)[2].argmin())]
    missing = untilted(turned[:, 2][None])
    assert nearest not in missing
    assert len(missing) == 3


def test_what_is_judged_is_the_calibration_and_the_rest_is_asked_for():
    random = np.random.default_rng(1)
    tilts = [(x, y) for x in (-30, 0, 30) for y in (25, 30, 35)]
    told = judge_camera(views(random, tilts))
    assert told.num_found == 9
    assert "9 photos are few" in told.verdict
    assert not told.is_good
    # All boards are turned about y to one side.
    assert sum(text.startswith("with its") for text in told.missing) == 1
    # Corners of 0.1 px in nine views; jackknife figures of such sets lie near 0.2 %.
    (focal,) = told.precisions
    assert 2e-4 < focal.sigma < 1e-2
    assert told.coverage.cells.mean() == pytest.approx(told.coverage.share)


def test_too_few_photos_are_told_in_the_calibration_s_own_words():
    random = np.random.default_rng(2)
    told = judge_camera(views(random, [(0, 20), (20, 0)]))
    assert told.precisions == ()
    assert "Need at least 4 views" in told.verdict


def test_a_port_names_distances_and_edges_before_it_has_an_answer_and_lengths_then():
    rig, random = rig_behind(FLAT), np.random.default_rng(3)
    known = adjust(rig_behind(None), see_boards(random, rig_behind(None), 12), INTRINSICS).rig
    start = replace(known, camera=replace(known.camera, port=FLAT), lasers=(), water=POOL)
    seen = see_boards(random, rig, 14)
    few = [s for s in seen if s.camera_from_board.rotation[0, 2] > 0.26][:2]

    def judged(sightings):
        views = [BoardView(s.name, s.corners) for s in sightings]
        return judge_so_far(
            "port", views, BOARD, LENS.size, lambda: calibrate_port(views, BOARD, start),
            locate=lambda view: locate_seen_board(
                view.corners, BOARD.points(), start.camera, index_of(start)
            ),
        )  # fmt: skip

    begun, done = judged(few), judged(seen)
    assert begun.precisions == ()
    assert "with its left edge nearer" in begun.missing
    assert not any("right edge" in text for text in begun.missing)
    # What is judged is what the verdict states, in the same numbers.
    shapes, *others = done.precisions
    middle = errors_where_seen(calibrate_port(
        [BoardView(s.name, s.corners) for s in seen], BOARD, start))[1]  # fmt: skip
    assert shapes.sigma == pytest.approx(middle.sigma)
    assert [one.what for one in others] == [
        "port's tilt towards x", "port's tilt towards y", "port's distance",
    ]  # fmt: skip


def test_a_laser_asks_for_distances_and_its_direction_falls_as_photographs_come():
    rig, random = rig_behind(None), np.random.default_rng(4)
    start = replace(rig, lasers=())
    seen = see_stripes(random, rig, 16)
    near = see_stripes(random, rig, 4, near=0.55, far=0.57)

    def judged(sightings):
        stripes = [StripeOnBoard(s.name, s.stripe, s.camera_from_board) for s in sightings]
        views = [BoardView(s.name, s.corners) for s in sightings]
        return judge_so_far(
            "laser", views, BOARD, LENS.size,
            lambda: calibrate_lasers(stripes, views, BOARD, start),
            locate=lambda view: locate_seen_board(view.corners, BOARD.points(), LENS),
        )  # fmt: skip

    assert "nearer than" in judged(near).missing[0]
    few, many = judged(seen[:5]), judged(seen)
    assert many.missing == ()
    assert many.precisions[0].what == "direction of laser 0's sheet"
    assert many.precisions[0].sigma < few.precisions[0].sigma
