import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from murkscan.errors import Degenerate
from murkscan.geometry.intersect import intersect_rays_with_plane
from murkscan.types.plane import Plane
from murkscan.types.rays import Rays

slopes = st.floats(-3, 3)
places = st.floats(-1, 1)


@given(st.tuples(slopes, slopes), st.tuples(places, places, places), st.floats(2, 5))
def test_meeting_points_lie_on_the_plane_and_on_their_ray(slope, origin, depth):
    plane = Plane.through(np.array([0.0, 0.0, depth]), np.array([0.1, -0.2, 1.0]))
    direction = np.array([[*slope, 1.0]]) / np.linalg.norm([*slope, 1.0])
    along = float((direction @ plane.normal)[0])
    start = float(plane.distance_to(np.array([origin]))[0])
    assume(abs(along) > 1e-3)
    met = intersect_rays_with_plane(Rays(np.array([origin]), direction), plane)
    assert np.isfinite(met).all() == (start * along <= 0)
    if np.isfinite(met).all():
        # A ray at 1e-3 to the plane runs some 5 km: 1e-9 m is 1e-13 of that.
        np.testing.assert_allclose(plane.distance_to(met), 0, atol=1e-9)
        np.testing.assert_allclose(np.cross(met - origin, direction), 0, atol=1e-9)


def test_a_ray_that_points_away_meets_nothing():
    plane = Plane.through(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0]))
    rays = Rays(np.zeros((2, 3)), np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]))
    met = intersect_rays_with_plane(rays, plane)
    np.testing.assert_allclose(met[0], [0, 0, 1])
    assert np.isnan(met[1]).all()


def test_one_parallel_ray_is_not_a_number_and_all_parallel_rays_are_refused():
    plane = Plane.through(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0]))
    met = intersect_rays_with_plane(Rays(np.zeros((3, 3)), np.eye(3)), plane)
    assert np.isnan(met[:2]).all()
    np.testing.assert_allclose(met[2], [0, 0, 1])
    with pytest.raises(Degenerate, match="All 2 rays are parallel"):
        intersect_rays_with_plane(Rays(np.zeros((2, 3)), np.eye(3)[:2]), plane)


def test_no_rays_meet_nothing():
    plane = Plane.through(np.array([0.0, 0.0, 1.0]), np.array([0.0, 0.0, 1.0]))
    met = intersect_rays_with_plane(Rays(np.zeros((0, 3)), np.zeros((0, 3))), plane)
    assert met.shape == (0, 3)
