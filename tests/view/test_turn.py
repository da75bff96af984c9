"""The model turned once round, and its film."""

import av
import numpy as np
import pytest

from murkscan.io.video import writing_video
from murkscan.simulate.shapes import Sphere
from murkscan.types.mesh import Mesh
from murkscan.view import draw_turn, standard_views
from murkscan.view.turn import _turn

SIZE = (160, 96)


def shown(picture):
    return picture.max(axis=2) < 245


def test_a_ball_looks_the_same_from_all_around_and_stays_in_the_middle():
    ball = Sphere(0.3).mesh()
    moved = Mesh(ball.vertices + np.array([5.0, -2.0, 1.0]), ball.faces)
    masks = [shown(picture) for picture in draw_turn(moved, pictures=4, size=SIZE)]
    # Samples on its rim may fall on either side.
    assert max(np.mean(mask != masks[0]) for mask in masks) < 0.02
    rows, columns = np.nonzero(masks[0])
    assert abs(columns.mean() - (SIZE[0] - 1) / 2) < 1
    assert rows.size > 1000


def test_half_a_turn_shows_the_other_side():
    front = next(view for view in standard_views() if view.name == "front")
    first, half = _turn(front, 0.0), _turn(front, np.pi)
    assert first.view_from_world[2] @ half.view_from_world[2] < -0.8
    assert first.view_from_world[1] @ half.view_from_world[1] > 0.8


def test_no_picture_of_a_turn_cuts_the_object_off():
    corner = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = np.array([[a, b, c] for a, b, c, _ in sides] + [[a, c, d] for a, _, c, d in sides])
    box = Mesh(corner * [0.4, 0.2, 0.3], faces)
    for picture in draw_turn(box, pictures=8, size=SIZE):
        mask = shown(picture)
        assert mask.any()
        assert not mask[[0, -1]].any()
        assert not mask[:, [0, -1]].any()


def test_a_film_is_an_mp4_that_plays(tmp_path):
    path = tmp_path / "turn.mp4"
    pictures = [np.full((96, 160, 3), grey, np.uint8) for grey in (40, 120, 200)]
    with writing_video(path, SIZE, rate=24.0, codec="h264", is_colour=True) as write:
        for number, picture in enumerate(pictures):
            write(picture, number / 24)
    with av.open(str(path)) as film:
        assert "mp4" in film.format.name
        grey = [frame.to_ndarray(format="rgb24").mean() for frame in film.decode(video=0)]
    assert grey == pytest.approx([40, 120, 200], abs=6)
