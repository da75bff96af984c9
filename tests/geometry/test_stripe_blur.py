"""What a stripe on a curved surface is trusted with."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from murkscan.geometry.stripe_blur import Sight, blur_slopes, is_readable
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


@pytest.mark.parametrize("aside", [-0.25, 0.0, 0.25])
def test_the_blur_moves_a_ball_s_stripe_as_the_formula_says_in_and_beside_the_middle(aside):
    """Through a blur along u, of the inverse depths of a ball's stripe weighted by its light."""
    radius, away, blur = 0.05, 0.9, 4e-4
    u = np.linspace(aside / away - 0.06, aside / away + 0.06, 24001)
    rays = np.stack([u, 0 * u, np.ones_like(u)], axis=1)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    centre = np.array([aside, 0.0, away])
    # Where each ray meets the ball first.
    along, short = rays @ centre, centre @ centre - radius**2
    hit = along**2 > short
    u, rays, along = u[hit], rays[hit], along[hit]
    points = rays * (along - np.sqrt(along**2 - short))[:, None]
    ball = Sphere(centre, radius)
    light = -np.einsum("ij,ij->i", rays, ball.normals(points))
    steps = blur / (u[1] - u[0])
    seen = gaussian_filter1d(light / points[:, 2], steps) / gaussian_filter1d(light, steps)
    sight = Sight(rays, np.tile([1.0, 0.0, 0.0], (len(u), 1)))
    good = is_readable(ball, points, sight)
    shift = ball.distance_to(points * (1 / seen / points[:, 2])[:, None])
    # The blur lies across the line of sight, at the ball's distance.
    across = (blur * away * np.cos(np.arctan2(aside, away))) ** 2
    told = across * blur_slopes(ball, points, sight)
    # The formula is the second order of the blur over the radius, and the depth over the ball.
    np.testing.assert_allclose(shift[good], told[good], atol=0.07 * np.abs(told[good]).max())
