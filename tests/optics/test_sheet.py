"""Where camera rays meet the laser's sheet, flat or bent by a window."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from murkscan.errors import InputError
from murkscan.optics import (
    back_project,
    distance_to_sheet,
    equivalent_plane,
    intersect_rays_with_sheet,
    locate_on_fan,
    project,
    trace_fan,
)
from murkscan.types.laser import Fan, Laser
from murkscan.types.plane import Plane
from murkscan.types.port import DomePort, FlatPort, Layer
from murkscan.types.rays import Rays

from .ports import AHEAD, GLASS, PORTS, TILTED, WATER, camera_behind, unit

HALF_ANGLE = np.radians(30)
LASER_PORTS = {
    "flat": FlatPort(AHEAD, 0.03, (GLASS,)),
    "tilted flat": FlatPort(TILTED, 0.03, (GLASS,)),
    "dome": DomePort(np.array([0.003, 0.002, 0.004]), 0.04, 0.005, 1.49),
}


def fan_behind(port):
    """Make a fan 0.25 m above the camera that crosses its axis at one metre."""
    lean = np.radians(14)
    direction = np.array([0.0, np.sin(lean), np.cos(lean)])
    return Fan(np.array([0.0, -0.25, 0.0]), direction, unit(1, 0, 0), HALF_ANGLE, port)


@settings(deadline=None)  # the first call may have to compile
@given(
    st.sampled_from(sorted(LASER_PORTS)),
    st.sampled_from(sorted(PORTS)),
    st.floats(-HALF_ANGLE, HALF_ANGLE),
    st.floats(0.3, 2.0),
)
def test_what_the_laser_lights_the_camera_measures(laser_port, camera_port, angle, distance):
    fan, camera = fan_behind(LASER_PORTS[laser_port]), camera_behind(PORTS[camera_port])
    beam = trace_fan(fan, np.array([angle]), WATER)
    lit = beam.origins + distance * beam.directions
    rays = back_project(camera, project(camera, lit, WATER), WATER)
    if np.isfinite(rays.directions).all():
        met = intersect_rays_with_sheet(rays, Laser.from_sheet(fan), WATER)
        # The iteration ends at 1e-10 in the tangent of the fan's angle; a slant makes it ten times.
        np.testing.assert_allclose(met, lit, atol=1e-8)


@pytest.mark.parametrize("name", LASER_PORTS)
def test_every_lit_point_in_the_picture_is_measured(name):
    fan, camera = fan_behind(LASER_PORTS[name]), camera_behind(PORTS["flat"])
    random = np.random.default_rng(0)
    angles = random.uniform(-HALF_ANGLE, HALF_ANGLE, 20_000)
    beams = trace_fan(fan, angles, WATER)
    lit = beams.origins + random.uniform(0.3, 1.5, (20_000, 1)) * beams.directions
    pixels = project(camera, lit, WATER)
    in_picture = ((pixels > -0.5) & (pixels < np.array(camera.size) - 0.5)).all(axis=1)
    assert in_picture.sum() > 10_000
    rays = back_project(camera, pixels[in_picture], WATER)
    met = intersect_rays_with_sheet(rays, Laser.from_sheet(fan), WATER)
    # The iteration ends at 1e-10 in the tangent of the fan's angle, times the range.
    np.testing.assert_allclose(met, lit[in_picture], atol=1e-9)


def test_a_fan_in_air_is_its_plane_as_far_as_it_spreads():
    fan, camera = fan_behind(None), camera_behind(None)
    u, v = np.meshgrid(np.arange(0.0, 720, 7), np.arange(0.0, 576, 7))
    rays = back_project(camera, np.stack([u.ravel(), v.ravel()], axis=1))
    met = intersect_rays_with_sheet(rays, Laser.from_sheet(fan))
    on_plane = intersect_rays_with_sheet(rays, Laser.from_sheet(fan.plane))
    away = on_plane - fan.origin
    angle = np.arctan2(away @ fan.tangent, away @ fan.direction)
    is_lit = np.abs(angle) <= HALF_ANGLE
    np.testing.assert_array_equal(met[is_lit], on_plane[is_lit])
    assert np.isnan(met[~is_lit]).all()
    assert 0 < is_lit.sum() < len(is_lit)


def test_a_window_of_index_1_leaves_the_sheet_alone():
    nothing = FlatPort(TILTED, 0.03, (Layer(0.008, 1.0),))
    camera = camera_behind(None)
    u, v = np.meshgrid(np.arange(3.0, 720, 7), np.arange(3.0, 576, 7))
    rays = back_project(camera, np.stack([u.ravel(), v.ravel()], axis=1))
    bare = Laser.from_sheet(fan_behind(None))
    behind = Laser.from_sheet(fan_behind(nothing))
    expected = intersect_rays_with_sheet(rays, bare)
    met = intersect_rays_with_sheet(rays, behind, 1.0)
    near = np.linalg.norm(expected, axis=1) < 5
    np.testing.assert_allclose(met[near], expected[near], atol=1e-9)
    np.testing.assert_array_equal(np.isnan(met[:, 0]), np.isnan(expected[:, 0]))
    points = expected[near] + [0.0, 0.004, 0.001]
    np.testing.assert_allclose(
        distance_to_sheet(points, behind, 1.0), distance_to_sheet(points, bare), atol=1e-12
    )


def test_a_sheet_that_holds_the_windows_normal_stays_a_plane():
    port = FlatPort(unit(0.0, np.sin(np.radians(14)), np.cos(np.radians(14))), 0.03, (GLASS,))
    fan = fan_behind(port)
    beams = trace_fan(fan, np.linspace(-HALF_ANGLE, HALF_ANGLE, 31), WATER)
    far = beams.origins + 2.0 * beams.directions
    np.testing.assert_allclose(fan.plane.distance_to(far), 0, atol=1e-14)


def test_the_best_plane_is_off_by_8_4_mm_at_1_m_and_16_7_mm_at_2_m():
    """The figures of a 60 degree fan at 14 degrees to the normal of a flat window of 8 mm glass.

    Depth is counted from the outer face of the window, in fresh water; the plane is the best for
    0.3 to 2 m.
    """
    fan = replace(fan_behind(LASER_PORTS["flat"]), origin=np.array([0.0, -0.25, -0.038]))
    plane = equivalent_plane(Laser.from_sheet(fan), 1.333, near=0.3, far=2.0)
    beams = trace_fan(fan, np.linspace(-HALF_ANGLE, HALF_ANGLE, 601), 1.333)
    off = []
    for depth in (1.0, 2.0):
        reach = (depth - beams.origins[:, 2:]) / beams.directions[:, 2:]
        off.append(np.abs(plane.distance_to(beams.origins + reach * beams.directions)).max())
    # Given to a tenth of a millimetre.
    np.testing.assert_allclose(off, [8.4e-3, 16.7e-3], atol=0.05e-3)


def test_the_equivalent_plane_of_a_flat_sheet_is_the_sheet():
    laser = Laser.from_baseline_angle(0.25, 1.3, "y")
    assert equivalent_plane(laser) is laser.sheet
    again = Laser.from_sheet(equivalent_plane(Laser.from_sheet(fan_behind(None))))
    baseline, angle = again.as_baseline_angle()
    assert baseline == pytest.approx(0.25, rel=1e-12)
    assert np.degrees(angle) == pytest.approx(90 - 14, rel=1e-12)


def test_no_point_of_the_sheet_is_nearer_than_the_distance_says():
    fan = fan_behind(LASER_PORTS["tilted flat"])
    random = np.random.default_rng(1)
    beams = trace_fan(fan, random.uniform(-0.4, 0.4, 6), WATER)
    near = beams.origins + random.uniform(0.4, 1.5, (6, 1)) * beams.directions
    points = near + random.normal(0, 0.01, (6, 3))
    distances = distance_to_sheet(points, Laser.from_sheet(fan), WATER)
    many = trace_fan(fan, np.linspace(-0.5, 0.5, 20_001), WATER)
    for point, distance in zip(points, distances, strict=True):
        away = point - many.origins
        along = np.sum(away * many.directions, axis=1, keepdims=True)
        to_rays = np.linalg.norm(away - along * many.directions, axis=1)
        # Rays lie up to 0.08 mm apart, which lengthens a distance of millimetres by a micrometre.
        assert to_rays.min() == pytest.approx(abs(distance), abs=2e-6)
        assert to_rays.min() >= abs(distance) - 1e-9


@pytest.mark.parametrize("name", LASER_PORTS)
def test_points_are_located_on_their_own_ray(name):
    fan = fan_behind(LASER_PORTS[name])
    angles, ranges = np.linspace(-0.5, 0.5, 11), np.linspace(0.0, 3.0, 11)
    beams = trace_fan(fan, angles, WATER)
    found = locate_on_fan(beams.origins + ranges[:, None] * beams.directions, fan, WATER)
    np.testing.assert_allclose(found.angle, angles, atol=1e-9)
    np.testing.assert_allclose(found.range, ranges, atol=1e-9)
    np.testing.assert_allclose(found.distance, 0, atol=1e-12)


def test_distance_is_positive_on_the_side_of_the_normal():
    fan = fan_behind(LASER_PORTS["flat"])
    beams = trace_fan(fan, np.array([0.1]), WATER)
    above = beams.origins + beams.directions + 0.01 * fan.plane.normal
    assert distance_to_sheet(above, Laser.from_sheet(fan), WATER)[0] > 0
    assert distance_to_sheet(above, Laser.from_sheet(fan_behind(None)))[0] == pytest.approx(
        fan.plane.distance_to(above)[0]
    )


def test_rays_that_look_away_from_the_sheet_meet_nothing():
    laser = Laser.from_sheet(fan_behind(LASER_PORTS["flat"]))
    back = np.array([[0.0, 0.3, -1.0], [0.0, 1.0, 0.0]])
    back /= np.linalg.norm(back, axis=1, keepdims=True)
    met = intersect_rays_with_sheet(Rays(np.zeros((2, 3)), back), laser, WATER)
    assert np.isnan(met).all()


def test_rays_that_are_lost_in_a_port_meet_nothing():
    laser = Laser.from_sheet(fan_behind(LASER_PORTS["flat"]))
    lost = Rays(np.full((1, 3), np.nan), np.full((1, 3), np.nan))
    assert np.isnan(intersect_rays_with_sheet(lost, laser, WATER)).all()


def test_a_fan_behind_a_window_must_know_the_water():
    laser = Laser.from_sheet(fan_behind(LASER_PORTS["flat"]))
    with pytest.raises(InputError, match="index"):
        intersect_rays_with_sheet(Rays(np.zeros((1, 3)), unit(0, 0, 1)[None]), laser)
    with pytest.raises(InputError, match="equivalent_plane"):
        laser.as_baseline_angle()


def test_a_flat_sheet_takes_no_notice_of_the_water():
    laser = Laser.from_sheet(Plane(unit(0.0, 0.9, 0.4), -0.016))
    rays = back_project(camera_behind(None), np.array([[300.0, 400.0]]))
    np.testing.assert_array_equal(
        intersect_rays_with_sheet(rays, laser, WATER), intersect_rays_with_sheet(rays, laser)
    )
