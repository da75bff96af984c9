"""Paint: an albedo for every place, the same each time."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.errors import InputError
from murkscan.simulate.shapes import Chessboard
from murkscan.simulate.textures import Bands, Checkered, Growth, Plain

TEXTURES = [
    Plain(0.3),
    Bands((0.05, 0.4, 0.9), (0.02, 0.01, 0.05), "z"),
    Checkered(9, 6, 0.03),
    Growth(),
    Growth(dark=0.0, light=1.0, size=0.01, cover=0.1, octaves=8, seed=5),
]
POINTS = np.random.default_rng(1).uniform(-3, 3, (20_000, 3))


@pytest.mark.parametrize("texture", TEXTURES, ids=repr)
def test_an_albedo_is_a_share_and_belongs_to_the_place_alone(texture):
    albedo = texture.albedo(POINTS)
    assert albedo.shape == (len(POINTS),)
    assert albedo.min() >= 0
    assert albedo.max() <= 1
    assert np.array_equal(texture.albedo(POINTS[::-1]), albedo[::-1])


@pytest.mark.parametrize("texture", TEXTURES, ids=repr)
def test_no_points_have_no_albedo(texture):
    assert len(texture.albedo(np.zeros((0, 3)))) == 0


@given(place=st.floats(-10, 10), turns=st.integers(-20, 20))
def test_bands_begin_again_after_the_last(place, turns):
    bands = Bands((0.1, 0.5, 0.9), (0.25, 0.5, 0.25), "x")
    # A power of two of metres, so that going round is exact.
    there = np.array([[np.round(place * 64) / 64, 0.3, 0.4]])
    assert bands.albedo(there) == bands.albedo(there + np.array([turns, 7.0, 9.0]))


def test_bands_have_their_widths_and_sharp_edges():
    y = np.array([0.0, 0.0299, 0.0301, 0.0999, 0.1001, -1e-18, -0.0699, -0.0701])
    points = np.stack([y * 3, y, y * 5], axis=1)
    expected = [0.1, 0.1, 0.6, 0.6, 0.1, 0.6, 0.6, 0.1]
    assert Bands((0.1, 0.6), (0.03, 0.07)).albedo(points).tolist() == expected


@pytest.mark.parametrize(("columns", "rows"), [(9, 6), (5, 7)])
def test_black_squares_touch_at_every_inner_corner_and_nowhere_else(columns, rows):
    square = 0.025
    board = Checkered(columns, rows, square, black=0.1, white=0.7)
    column, row = (
        g.ravel() for g in np.meshgrid(np.arange(-2, columns + 2), np.arange(-2, rows + 2))
    )
    corner = np.stack([column, row, 0 * row], axis=1) * square
    quarters = 0.3 * square * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    dark = np.stack([board.albedo(corner + quarter) == 0.1 for quarter in quarters], axis=1)
    touches = (dark == [True, False, True, False]).all(axis=1)
    touches |= (dark == [False, True, False, True]).all(axis=1)
    inner = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
    assert np.array_equal(touches, inner)
    assert dark[(column == 0) & (row == 0), 0].all(), "the square before the first corner is black"


def test_the_margin_of_a_chessboard_is_white():
    vertices = Chessboard(9, 6, 0.03).mesh().vertices
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    points = low + np.random.default_rng(3).uniform(0, 1, (20_000, 3)) * (high - low)
    to_edge = np.minimum(points - low, high - points)[:, :2].min(axis=1)
    is_white = Checkered(9, 6, 0.03).albedo(points) == 0.85
    assert np.all(is_white[to_edge < 0.03])
    # Just within the margin, every other square is black.
    assert np.mean(is_white[(to_edge > 0.03) & (to_edge < 0.06)]) == pytest.approx(0.5, abs=0.05)


@pytest.mark.parametrize("cover", [0.2, 0.5, 0.8])
@pytest.mark.parametrize("octaves", [1, 4])
def test_growth_covers_its_share(cover, octaves):
    growth = Growth(dark=0.0, light=1.0, size=0.05, cover=cover, octaves=octaves)
    points = np.random.default_rng(2).uniform(-20, 20, (60_000, 3))
    # The field is only close to normal: up to 0.022 of the share at one octave; chance adds 0.002.
    assert np.mean(growth.albedo(points) < 0.5) == pytest.approx(cover, abs=0.03)


def test_growth_has_no_steps_and_no_finer_detail_than_its_last_octave():
    growth = Growth(dark=0.0, light=1.0, size=0.08, octaves=3)
    line = np.zeros((40_001, 3))
    line[:, 0] = np.linspace(0, 4, len(line))
    albedo = growth.albedo(line)
    # Steepest possible: each octave 15/8 of its weight a cell (8/7, the same for all three weights
    # times their cells: 3 x 15/8 x 4/7 / 0.08 m, along each of three axes); the cut is 1.5 times as
    # steep over its width of two standard deviations, 2 x 0.2 x 0.65.
    steepest = math.sqrt(3) * 3 * 15 / 8 * 4 / 7 / 0.08 * 1.5 / 0.26
    assert np.abs(np.diff(albedo)).max() / 1e-4 < steepest
    # And it does go from bare to grown and back, about once a patch.
    crossings = np.count_nonzero(np.diff(albedo > 0.5))
    assert 4 / 0.08 / 3 < crossings < 4 / 0.08 * 3


def test_another_seed_grows_elsewhere():
    first, second = (Growth(seed=seed).albedo(POINTS) for seed in (0, 1))
    # Two independent fields: the correlation of 20 000 places is below five standard errors.
    assert abs(np.corrcoef(first, second)[0, 1]) < 5 / math.sqrt(len(POINTS))


def test_growth_is_the_same_on_every_machine():
    points = np.array([[0.0, 0.0, 0.0], [0.1, -0.2, 0.3], [-5.0, 4.0, 3.0]])
    expected = [0.09346763232322504, 0.03, 0.10986138962805703]
    np.testing.assert_allclose(Growth().albedo(points), expected, atol=1e-12)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: Plain(1.2), "share"),
        (lambda: Plain(math.nan), "share"),
        (lambda: Bands((0.1,), (0.1,)), "two albedos"),
        (lambda: Bands((0.1, 0.2), (0.1,)), "width for each"),
        (lambda: Bands((0.1, 0.2), (0.1, 0.0)), "widths"),
        (lambda: Bands((0.1, -0.2), (0.1, 0.1)), "albedos"),
        (lambda: Bands(axis="w"), "axis"),
        (lambda: Checkered(1, 6, 0.03), "columns"),
        (lambda: Checkered(9, 6, -0.03), "square"),
        (lambda: Checkered(white=2.0), "white"),
        (lambda: Growth(dark=0.5, light=0.2), "darker"),
        (lambda: Growth(dark=-0.1), "dark"),
        (lambda: Growth(size=0.0), "size"),
        (lambda: Growth(cover=1.0), "cover"),
        (lambda: Growth(octaves=0), "octaves"),
        (lambda: Growth(seed=-1), "seed"),
    ],
)
def test_paint_that_cannot_be_is_refused(make, word):
    with pytest.raises(InputError, match=word):
        make()
