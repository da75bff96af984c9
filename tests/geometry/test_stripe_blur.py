"""What a stripe on a curved surface is trusted with."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.geometry.sphere_fit import fit_sphere
from murkscan.geometry.stripe_blur import (
    Sight,
    blur_moves,
    is_readable,
    loss_moves,
    sheet_moves,
)
from murkscan.optics import light_across
from murkscan.types.arrays import Points, Scalars
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane
from murkscan.types.sphere import Sphere

from ..balls import AWAY, LEAN, RADIUS, RISE, on_sheet, put_back, scan_ball, see_ball

TURNS = np.radians([-70.0, -50.0, 0.0, 25.0, 40.0, 70.0])
"""From the line of sight to the normals on a ball, away from the laser where positive."""


def sight_of(light):
    across = np.stack([0 * TURNS, np.sin(TURNS), -np.cos(TURNS)], axis=1)
    rows = np.ones((len(TURNS), 1))
    return across, Sight(
        rows * [0, 0, 1], rows * [1, 0, 0], None if light is None else rows * light
    )


def test_places_that_the_laser_grazes_are_not_read():
    light = light_across(Laser.from_baseline_angle(0.25, np.radians(60), "y"))
    # The sheet leans by 30 degrees: from there its light comes, and it grazes 60 degrees away.
    np.testing.assert_allclose(light, [0, 0.5, np.sqrt(0.75)], atol=1e-12)
    ball, (points, seen) = Sphere(np.zeros(3), 1.0), sight_of(light)
    assert is_readable(ball, points, seen).tolist() == [False, True, True, True, False, False]
    points, seen = sight_of(None)
    assert is_readable(ball, points, seen).tolist() == [False, True, True, True, True, False]


def test_a_plane_is_read_from_any_side():
    points, seen = sight_of([0.0, 0.5, np.sqrt(0.75)])
    assert is_readable(Plane(np.array([0.0, 1.0, 0.0]), 0.0), points, seen).all()


@pytest.mark.parametrize("above", [-0.02, 0.0, 0.02])
@pytest.mark.parametrize("aside", [-0.25, 0.0, 0.25])
def test_the_blur_moves_a_ball_s_stripe_as_the_formula_says_in_and_beside_the_middle(aside, above):
    blur = 1.5e-3 / AWAY
    ball, points, sight = see_ball(aside, above, blur=blur)
    shift = ball.distance_to(points)
    # The blur lies across the depth, which is that of the points.
    variance = float(np.mean((blur * points[:, 2]) ** 2))
    told, slope = blur_moves(ball, points, sight, variance)
    # The next order but one, and the depth over the ball; beside the middle, the lean of e.
    np.testing.assert_allclose(shift, told, atol=1.6e-6, rtol=0.04)
    more, _ = blur_moves(ball, points, sight, 1.001 * variance)
    np.testing.assert_allclose((more - told) / (0.001 * variance), slope, rtol=0.02, atol=0.01)


@pytest.mark.parametrize("above", [-0.02, 0.0, 0.02])
def test_the_sheet_s_thickness_moves_a_ball_s_stripe_as_the_formula_says(above):
    ball, points, sight = see_ball(0.0, above, thickness=4e-4)
    shift = ball.distance_to(points)
    told = sheet_moves(ball, points, sight)
    # What is told is that of a sheet between none and twice its variance.
    told = told * 4e-4**2 / 6e-8
    # A tenth of the largest.
    np.testing.assert_allclose(shift, told, atol=6e-7)


def scan_without_pull() -> tuple[Sphere, Points, Sight]:
    """Scan a ball by a sheet of usual thickness, and take the pull of its shade back."""
    parts, variance, step = [], 6e-8, 1e-4
    for above in np.arange(-0.02, 0.021, 0.002):
        ball, points, _ = see_ball(0.0, above, thickness=np.sqrt(variance), count=241)
        near, far = (see_ball(0.0, above + s, count=241)[1] for s in (-step, step))
        kept = [np.round(some[:, 0] / some[:, 2], 9) for some in (points, near, far)]
        same = set(kept[0]).intersection(*kept[1:])
        points, near, far = (
            some[np.isin(u, list(same))] for some, u in zip((points, near, far), kept, strict=True)
        )
        change = light_on(ball, near) - light_on(ball, far)
        moved = near[:, 1] / near[:, 2] - far[:, 1] / far[:, 2]
        across = 2 * step * np.cos(LEAN)
        pull = variance * change * moved / across**2
        start = points[0, 1] - RISE * points[0, 2]
        depth = start / (points[:, 1] / points[:, 2] - pull - RISE)
        parts.append(on_sheet(points[:, 0] / points[:, 2], depth, start))
    columns = zip(*((s.rays, s.along, s.light, s.ranges) for _, s in parts), strict=True)
    return (
        ball,
        np.concatenate([points for points, _ in parts]),
        Sight(*map(np.concatenate, columns)),
    )


def light_on(ball: Sphere, points: Points) -> Scalars:
    """Give the logarithm of the light that `see_ball` draws."""
    way = np.stack([points[:, 0] / points[:, 2], RISE + 0 * points[:, 0], 1 + 0 * points[:, 0]], 1)
    facing = -np.einsum("ij,ij->i", points - ball.centre, way)
    return np.log(facing / points[:, 2]) - 3.0 * points[:, 2]


def test_a_ball_whose_pull_was_taken_back_is_not_corrected_for_its_shade_again():
    ball, points, sight = scan_without_pull()
    told = replace(sight, pulled_back=np.ones(len(points), bool))
    once, twice = (
        np.append(fit.shape.centre - ball.centre, fit.shape.radius - RADIUS)
        for fit in (fit_sphere(points, sight=one) for one in (told, sight))
    )
    # Of the shade's 8 µm a tenth is left: the formula's next order, and steps between profiles.
    assert np.abs(once).max() < 8e-7
    assert np.abs(twice).max() > 5e-6


@pytest.mark.parametrize("loss", [0.0, 6.0])
def test_light_that_the_water_takes_moves_a_ball_s_stripe_by_what_is_stated_at_one_sigma(loss):
    blur = 1.5e-3 / AWAY
    ball, points, sight = see_ball(0.0, 0.0, blur=blur)
    _, other, _ = see_ball(0.0, 0.0, blur=blur, loss=loss)
    u, same = (np.round(p[:, 0] / p[:, 2], 9) for p in (points, other))
    _, here, there = np.intersect1d(u, same, return_indices=True)
    change = ball.distance_to(other)[there] - ball.distance_to(points)[here]
    variance = float(np.mean((blur * points[:, 2]) ** 2))
    told = loss_moves(ball, points, sight, variance)[here]
    # It is largest at the flanks, where the next order is a tenth of it; less light there moves
    # the stripe the other way.
    np.testing.assert_allclose(change, np.sign(loss - 3) * -told, atol=1e-6, rtol=0.1)


def test_what_a_finder_has_put_back_changes_no_fit():
    ball, points, sight = scan_ball(blur=1.5e-3 / AWAY)
    plain = fit_sphere(points, sight=sight)
    # As far as a finder moves a stripe, outwards on both flanks: 0.04 mm where it leans most.
    moved, told = put_back(points, sight, 4e-5 * (points[:, 0] / 0.04) ** 2)
    found = fit_sphere(moved, sight=told)
    assert found.shape.radius == pytest.approx(plain.shape.radius, abs=3e-7)
    assert found.shape.centre == pytest.approx(plain.shape.centre, abs=3e-7)
    assert found.blur == pytest.approx(plain.blur, rel=0.02)
    # The blur of 1.5 mm, and the ball, by the formula's next order but one.
    assert plain.blur == pytest.approx(2.25e-6, rel=0.2)
    assert plain.shape.radius == pytest.approx(RADIUS, abs=3e-6)
    assert plain.shape.centre == pytest.approx(ball.centre, abs=1e-5)
