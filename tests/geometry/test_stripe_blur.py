"""What a stripe on a curved surface is trusted with."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from murkscan.geometry.stripe_blur import Sight, blur_moves, is_readable, sheet_moves
from murkscan.optics import light_across
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane
from murkscan.types.sphere import Sphere

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


RADIUS, AWAY, LEAN = 0.05, 0.9, np.radians(20)


def see_ball(aside, above, *, blur=0.0, thickness=1e-5):
    """Draw the stripe on a ball by its light, find its centres, and cut their rays with the sheet.

    The sheet leans by 20 degrees and lies above the ball's middle; through the sheet, light is
    summed over its thickness, and along u by a Gaussian. Gives the ball, the points and their
    sight; `blur` is 1σ of u, `thickness` that of the sheet [m].
    """
    u = np.linspace(aside / AWAY - 0.06, aside / AWAY + 0.06, 6001)
    rise, centre = np.tan(LEAN), np.array([aside, 0.0, AWAY])
    start = -above - rise * (AWAY - RADIUS)
    offsets = np.linspace(-4, 4, 41) * thickness
    places, lights = [], []
    for off in offsets:
        # X = (u z, start + off / cos + rise z, z) lies on the ball: a quadratic in z.
        y = start + off / np.cos(LEAN)
        a = u**2 + rise**2 + 1
        b = -u * aside + rise * y - AWAY
        z = (-b - np.sqrt(np.maximum(b**2 - a * (aside**2 + y**2 + AWAY**2 - RADIUS**2), 0))) / a
        point = np.stack([u * z, y + rise * z, z], axis=1)
        # The fan comes from beside the camera, as far away.
        facing = -np.einsum("ij,ij->i", point - centre, np.stack([u, 0 * u + rise, 0 * u + 1], 1))
        lights.append(np.maximum(facing, 0) / z * np.exp(-3.0 * z))
        places.append(point[:, 1] / z)
    v, light = np.array(places), np.array(lights)
    light *= np.exp(-0.5 * (offsets / thickness) ** 2)[:, None]
    light *= np.abs(np.gradient(v, offsets, axis=0))
    seen = [(light * v).sum(axis=0), light.sum(axis=0)]
    if blur:
        seen = [gaussian_filter1d(one, blur / (u[1] - u[0])) for one in seen]
    # Beyond the ball there is no light, and no centre.
    z = start / (seen[0] / np.maximum(seen[1], 1e-300) - rise)
    points = np.stack([u * z, start + rise * z, z], axis=1)
    ranges = np.linalg.norm(points, axis=1)
    ways = np.ones((len(u), 1))
    sight = Sight(
        points / ranges[:, None],
        ways * [1.0, 0.0, 0.0],
        ways * [0.0, np.sin(LEAN), np.cos(LEAN)],
        ranges,
    )
    # Those before the very rim, beyond which there is no ball.
    good = is_readable(Sphere(centre, RADIUS), points, sight) & (np.abs(u * AWAY - aside) < 0.043)
    return Sphere(centre, RADIUS), points[good], sight[good]


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
