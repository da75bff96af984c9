"""A laser's sheet, and the paper's b and θ for it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from murkscan.errors import InputError
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane

sides = st.sampled_from([-1.0, 1.0])


@given(st.floats(0.01, 2), st.floats(0.1, 3.0), sides, st.sampled_from(["x", "y"]))
def test_baseline_and_angle_come_back(length, angle, side, axis):
    laser = Laser.from_baseline_angle(side * length, angle, axis)
    baseline, again = laser.as_baseline_angle()
    assert baseline == pytest.approx(side * length, rel=1e-12)
    assert again == pytest.approx(angle, rel=1e-12)


@given(st.floats(0.1, 3.0), sides)
def test_the_opposite_normal_is_the_same_laser(angle, side):
    sheet = Laser.from_baseline_angle(side * 0.2, angle, "y").sheet
    flipped = Laser.from_sheet(Plane(-sheet.normal, -sheet.distance))
    assert flipped.as_baseline_angle() == pytest.approx((side * 0.2, angle), rel=1e-12)


def test_the_laser_sits_at_minus_b_and_leans_towards_the_axis():
    """X = -b + Z cot θ, by hand: b = 0.3, θ = 60°, Z = 0.3 gives X = -0.3 + 0.3 · 0.57735."""
    sheet = Laser.from_baseline_angle(0.3, math.radians(60), "x").sheet
    on_it = np.array([[-0.3, 0.0, 0.0], [-0.126795, 5.0, 0.3]])
    np.testing.assert_allclose(sheet.distance_to(on_it), 0, atol=1e-6)


@pytest.mark.parametrize(("baseline", "angle"), [(0.0, 1.0), (0.1, 0.0), (0.1, math.pi)])
def test_a_laser_that_is_no_laser_is_refused(baseline, angle):
    with pytest.raises(InputError, match="baseline other than 0"):
        Laser.from_baseline_angle(baseline, angle, "x")


def test_the_axis_follows_from_the_larger_part_of_the_normal():
    assert Laser.from_sheet(Plane(np.array([0.1, 0.9, 0.4]), 0.1)).axis == "y"
    assert Laser.from_sheet(Plane(np.array([-0.9, 0.1, 0.4]), 0.1)).axis == "x"
