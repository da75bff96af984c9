"""What a stripe on a curved surface is trusted with."""

import numpy as np

from murkscan.geometry.stripe_blur import Sight, is_readable
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
