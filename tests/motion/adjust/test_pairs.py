"""Facets of two legs, paired where the true ways put them: noise and cells show nothing false."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.motion.adjust import AdjustSettings, Pass
from murkscan.motion.adjust.checks import compare_passes
from murkscan.motion.adjust.first_path import first_path, fit_path
from murkscan.motion.adjust.legs import cut_legs, make_facets
from murkscan.motion.adjust.normals import steady_normals
from murkscan.motion.adjust.pairs import make_side, pair_facets
from murkscan.motion.adjust.solve import State
from murkscan.motion.adjust.strays import compare_legs, drop_strays
from murkscan.motion.adjust.ties import Ties, as_seen, linearise
from murkscan.types.navigation import Navigation, NavigationAccuracy
from murkscan.types.pose import Pose
from murkscan.types.trajectory import Trajectory

RATE, SPEED, STAND_OFF, LINES, ASIDE = 20.0, 0.1, 0.6, 160, 0.15
STILL = Navigation(NavigationAccuracy())


def waves(x, y):
    """Give heights of 1 mm, and of some centimetres' width: a cell is an eighth of it [m]."""
    return 1e-3 * (np.sin(x / 0.0064 + 1.7 * np.sin(y / 0.03)) + np.sin(y / 0.0066))


def way_of(number):
    """Give where a pass was: the second keeps 3 mm ahead of the first's beat for a while."""
    times = np.arange(int(6 * RATE)) / RATE
    swing = number * 6e-3 * np.sin(2 * np.pi * times / 3)
    places = np.stack([SPEED * times + swing, np.full_like(times, number * ASIDE), 0 * times], 1)
    return Trajectory(times, places, np.tile([1.0, 0, 0, 0], (len(times), 1)))


def sheet(depth):
    return depth / 3 - 0.2


def see(number, *, noise):
    """Give what one sheet saw from there, with noise of its distance [m]."""
    way = way_of(number)
    across = np.linspace(-0.15, 0.15, LINES)
    profile, line = np.divmod(np.arange(len(way.times) * LINES), LINES)
    x, y = way.positions[profile, 0], across[line]
    depth = np.full(len(x), STAND_OFF)
    for _ in range(4):
        depth = STAND_OFF - waves(x + sheet(depth), y + number * ASIDE)
    depth = depth + noise * np.random.default_rng(number).normal(size=len(x))
    points = np.stack([sheet(depth), y, depth], axis=1)
    laser = np.zeros(len(x), np.uint8)
    return Pass(way.times, profile, line, laser, points, np.zeros(len(x)), STILL, way)


def facets_of(one, number):
    settings = AdjustSettings()
    way = one.start
    first = first_path(STILL, way.times[0], way.times[-1], settings.knot_step, way)
    path = fit_path(first, way)
    (leg,) = cut_legs(number, one, path, settings.cell)
    return make_facets(leg, path), path


@pytest.fixture(scope="module")
def true_ties():
    """Tie two passes where they truly were: give the ties, and the paths."""
    found = [facets_of(see(number, noise=1e-4), number) for number in (0, 1)]
    sides = [make_side(facets, path) for facets, path in found]
    rows = np.ones(len(sides[0].facets.leg.row_times), bool)
    return pair_facets(*sides, 1e-3, 10**9, bumps_match=rows), [path for _, path in found]


def pull(true_ties, axis):
    """Tell how a slope of both ways along x would change the ties, and how much they ask for it.

    Returns:
        The standard deviation of the slope, if ties could tell it, and their force in units of it.
    """
    ties, paths = true_ties
    linear = linearise(ties, paths)
    steps = np.zeros((sum(len(path.positions) for path in paths), 6))
    steps[:, axis] = np.concatenate([path.positions[:, 0] for path in paths])
    change = np.zeros(len(ties))
    for slopes, weights, first, sign in (
        (linear.slopes_a, linear.weights_a, linear.first_a, 1),
        (linear.slopes_b, linear.weights_b, linear.first_b, -1),
    ):
        near = steps[first[:, None] + np.arange(4)]
        change += sign * np.einsum("nd,nj,njd->n", slopes, weights, near)
    known = float(np.sqrt((change**2 / ties.variance).sum()))
    return 1 / known, float((linear.residuals * change / ties.variance).sum()) / known


@pytest.mark.parametrize("axis", [0, 2])
def test_what_both_passes_have_wrong_alike_is_not_seen(true_ties, axis):
    """Noise of heights is one of the moment in step: taken as such, it seemed known to 4 %."""
    sigma, force = pull(true_ties, axis)
    assert sigma > 0.5
    assert abs(force) < 3


@pytest.mark.parametrize("axis", [0, 1])
def test_noise_does_not_turn_all_that_was_seen(true_ties, axis):
    """A point that is off along its sheet is less off along a normal that its sheet grazes."""
    ties, paths = true_ties
    angle, knots = 1e-3, paths[0].knots
    times = np.linspace(knots.start, knots.end, 20 * knots.num_pieces)
    turn = Pose(Rotation.from_rotvec(angle * np.eye(3)[axis]).as_matrix(), np.zeros(3))
    turned = [fit_path(path, path.as_trajectory(times).carry(turn)) for path in paths]
    residuals = linearise(ties, paths).residuals
    change = (linearise(ties, turned).residuals - residuals) / angle
    # Nothing tells how all of it lies: ties ask for less than an attitude does that is known to 3°.
    assert abs((residuals * change / ties.variance).sum()) < 1 / np.deg2rad(3)


def test_a_lateral_shift_is_seen_without_bias(true_ties):
    ties, paths = true_ties
    residuals = linearise(ties, paths).residuals
    for axis in (0, 1):
        along = ties.direction[:, axis]
        square = (along**2 / ties.variance).sum()
        shift = -(residuals * along / ties.variance).sum() / square
        # Nearest cells lie up to 2.5 mm aside; slopes too flat by a tenth would show 0.1 mm.
        assert abs(shift) < max(4 / np.sqrt(square), 0.06e-3)


def test_slopes_are_as_steep_as_the_surface():
    facets, _ = facets_of(see(0, noise=1e-6), 0)
    normals, _ = steady_normals(facets)
    x, y = facets.points[:, 0], facets.points[:, 1]
    step = 1e-5
    for axis, (dx, dy) in enumerate(((step, 0), (0, step))):
        true = (waves(x - dx, y - dy) - waves(x + dx, y + dy)) / (2 * step)
        raw, found = (-n[:, axis] / n[:, 2] for n in (facets.normals, normals))
        flat, left = ((n @ true) / (n @ n) - 1 for n in (raw, found))
        # The factor is that of the whole leg, by heights of cells some millimetres apart.
        assert flat > 0.1
        assert abs(left) < flat / 3


def test_a_plain_surface_shows_no_slopes():
    one = see(0, noise=1e-4)
    noise = np.random.default_rng(5).normal(0, 1e-4, len(one.points))
    depth = STAND_OFF + noise
    plain = replace(one, points=np.stack([sheet(depth), one.points[:, 1], depth], axis=1))
    facets, _ = facets_of(plain, 0)
    normals, _ = steady_normals(facets)
    assert np.sqrt(np.mean(normals[:, :2] ** 2)) < 0.2 * np.sqrt(
        np.mean(facets.normals[:, :2] ** 2)
    )


def test_what_a_heaving_vehicle_makes_of_a_plain_surface_shows_no_slopes():
    one = see(0, noise=1e-4)
    depth = STAND_OFF + 1e-4 * np.random.default_rng(5).normal(size=len(one.points))
    # The way does not know of these heaves, whose slopes are these.
    depth += 0.3e-3 * np.sin(2 * np.pi * one.times[one.profile] / 2.5)
    slopes = 0.3e-3 * 2 * np.pi / (2.5 * SPEED) / np.sqrt(2)
    heaving = replace(one, points=np.stack([sheet(depth), one.points[:, 1], depth], axis=1))
    _, smooth = steady_normals(facets_of(heaving, 0)[0])
    # Two heaves and a half bend the surface evenly by as much as a tenth of them.
    assert np.std(smooth[:, 0] / smooth[:, 2]) < 0.2 * slopes


def test_a_stretch_that_lies_beside_its_like_is_counted_in_time():
    found = [see(number, noise=1e-4) for number in (0, 1)]
    facets, paths = zip(*map(facets_of, found, (0, 1)), strict=True)
    legs = [one.leg for one in facets]
    true = compare_passes(State(paths, np.zeros(0)), legs)
    assert true.astray == (0.0, 0.0)
    assert true.apart < 0.1e-3
    # Half of the second one's way lies 15 mm aside.
    way = found[1].start
    late = np.where(way.times > 3, 15e-3, 0.0)
    torn = fit_path(paths[1], replace(way, positions=way.positions + np.outer(late, [1.0, 1.0, 0])))
    false = compare_passes(State((paths[0], torn), np.zeros(0)), legs)
    assert min(false.astray) == pytest.approx(2.8, abs=0.5)
    assert false.apart > 3 * true.apart


def test_a_tile_that_lies_on_other_bumps_is_left_out():
    found = [see(number, noise=1e-4) for number in (0, 1)]
    facets, paths = zip(*map(facets_of, found, (0, 1)), strict=True)
    legs, way = [one.leg for one in facets], found[1].start
    late = np.where(way.times > 3, 15e-3, 0.0)
    torn = fit_path(paths[1], replace(way, positions=way.positions + np.outer(late, [1.0, 1.0, 0])))
    state = State((paths[0], torn), np.zeros(0))
    tiles = {(0, 1): tile_where_they_lie(facets[0], state, [1.5, 2.5, 4.5, 5.0])}
    assert list(drop_strays(tiles, state, legs)[0, 1].time_a[::3]) == [1.5, 2.5]
    true = State(paths, np.zeros(0))
    tiles = {(0, 1): tile_where_they_lie(facets[0], true, [1.5, 2.5, 4.5, 5.0])}
    assert len(drop_strays(tiles, true, legs)[0, 1]) == 12


@pytest.mark.parametrize(("noise", "tells"), [(1e-4, True), (2e-3, False)])
def test_rows_tell_on_what_they_lie_where_bumps_are_higher_than_their_noise(noise, tells):
    sides = [make_side(*facets_of(see(number, noise=noise), number)) for number in (0, 1)]
    lies = compare_legs(*sides)
    assert bool(len(lies.times)) is tells
    assert not lies.is_stray.any()


def tile_where_they_lie(facets, state, times):
    """Tie places that the first pass saw at some times to where the second one has them."""
    rows = [np.abs(facets.leg.row_times[facets.row] - time).argmin() for time in times]
    points = np.repeat(facets.points[rows], 3, axis=0)
    times, passes = np.repeat(times, 3), np.zeros(3 * len(times), np.int64)
    return Ties(
        passes, times, as_seen(passes, times, points, state.paths),
        passes + 1, times, as_seen(passes + 1, times, points, state.paths),
        np.tile(np.eye(3), (len(rows), 1)), np.zeros(len(times)), np.ones(len(times)),
    )  # fmt: skip
