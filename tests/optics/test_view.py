"""Rays out through a port and points back in."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from murkscan.errors import InputError
from murkscan.optics import back_project, project
from murkscan.types.camera import Camera
from murkscan.types.port import DomePort, FlatPort, Layer

from .ports import AHEAD, GLASS, PORTS, WATER, camera_behind

ports = st.sampled_from(sorted(PORTS))
pixels_seen = st.tuples(st.floats(-0.5, 719.5), st.floats(-0.5, 575.5))


def see(port, x, y, index=WATER):
    """Start [mm] and direction of the ray of the pixel at normalised x, y."""
    camera = Camera((2000, 2000), (1000.0, 1000.0), (0.0, 0.0), port=port)
    pixel = np.array([[1000.0 * x, 1000.0 * y]])
    rays = back_project(camera, pixel, index)
    seen = rays.origins + 0.7 * rays.directions
    np.testing.assert_allclose(project(camera, seen, index), pixel, atol=1e-9)
    return 1e3 * rays.origins[0], rays.directions[0]


# Five rays by hand, with angles and sines in a plane only; rounded in the eighth digit.


def test_by_hand_a_flat_port():
    start, direction = see(FlatPort(AHEAD, 0.03, (GLASS,)), 0.5, 0.0)
    # In air tan 0.5, sin 0.44721360; glass sin 0.44721360 / 1.49 = 0.30014335, tan 0.31465060;
    # water sin 0.44721360 / 1.34 = 0.33374149. Aside 30 · 0.5 + 8 · 0.31465060 mm.
    np.testing.assert_allclose(start, [17.5172048, 0, 38], atol=1e-7)
    np.testing.assert_allclose(direction, [0.33374149, 0, 0.94266464], atol=1e-8)


def test_by_hand_a_flat_port_turned_by_30_degrees():
    normal = np.array([0.5, 0.0, np.sqrt(0.75)])
    start, direction = see(FlatPort(normal, 0.03, (GLASS,)), 0.0, 0.0)
    # Along the axis, 30° off the normal: inner face after 30 / cos 30° = 34.6410162 mm. In glass
    # asin(0.5 / 1.49) = 19.6072316°, so 10.3927684° off the axis, for 8 / cos 19.6072316° =
    # 8.4924328 mm. In water asin(0.5 / 1.34) = 21.9090498°, so 8.0909502° off the axis.
    np.testing.assert_allclose(start, [1.5319924, 0, 42.9941242], atol=1e-7)
    np.testing.assert_allclose(direction, [0.14074486, 0, 0.99004590], atol=1e-8)


def test_by_hand_a_dome_around_the_lens():
    start, direction = see(DomePort(np.zeros(3), 0.05, 0.005, 1.49), 0.3, 0.4)
    # Straight through: (0.3, 0.4, 1) / √1.25, out at 55 mm.
    np.testing.assert_allclose(direction, [0.26832816, 0.35777088, 0.89442719], atol=1e-8)
    np.testing.assert_allclose(start, [14.7580487, 19.6773982, 49.1934955], atol=1e-7)


def test_by_hand_a_dome_10_mm_too_far_out():
    start, direction = see(DomePort(np.array([0, 0, 0.01]), 0.05, 0.005, 1.49), 0.5, 0.0)
    # Angles to the radius by the law of sines, angles about the dome's centre by adding them:
    # 10 · sin 26.5650512° / 50 = sin 5.1315479°, at 31.6965991° about the centre. In glass
    # 3.4414584° to the radius, so 28.2551407° to the axis. Outer face: 50 · sin 3.4414584° / 55
    # = sin 3.1282717°, at 31.3834124°. In water 3.4788606°, so 27.9045518° to the axis.
    np.testing.assert_allclose(start, [28.6419375, 0, 56.9535879], atol=1e-7)
    np.testing.assert_allclose(direction, [0.46800002, 0, 0.88372845], atol=1e-8)


def test_by_hand_a_slab_of_water_in_air():
    start, direction = see(FlatPort(AHEAD, 0.05, (Layer(0.1, 1.33),)), 0.0, 0.75, index=1.0)
    # tan 0.75, sin 0.6: water sin 0.6 / 1.33 = 0.45112782, tan 0.50548837; parallel again behind.
    # Aside 50 · 0.75 + 100 · 0.50548837 mm.
    np.testing.assert_allclose(start, [0, 88.0488367, 150], atol=1e-7)
    np.testing.assert_allclose(direction, [0, 0.6, 0.8], atol=1e-12)


@settings(deadline=None)  # the first call may have to compile
@given(ports, pixels_seen, st.floats(0.2, 5.0), st.floats(1.0, 1.36))
def test_projection_undoes_back_projection(name, pixel, distance, index):
    camera, pixels = camera_behind(PORTS[name]), np.array([pixel])
    rays = back_project(camera, pixels, index)
    seen = rays.origins + distance * rays.directions
    np.testing.assert_allclose(project(camera, seen, index), pixels, atol=1e-6)


@pytest.mark.parametrize("name", PORTS)
def test_projection_undoes_back_projection_all_over_the_image(name):
    camera = camera_behind(PORTS[name])
    u, v = np.meshgrid(np.linspace(-0.5, 719.5, 73), np.linspace(-0.5, 575.5, 59))
    pixels = np.stack([u.ravel(), v.ravel()], axis=1)
    rays = back_project(camera, pixels, WATER)
    for distance in (0.2, 1.0, 5.0):
        seen = rays.origins + distance * rays.directions
        assert np.abs(project(camera, seen, WATER) - pixels).max() < 1e-6


@settings(deadline=None)  # the first call may have to compile
@given(
    st.tuples(st.floats(-0.04, 0.04), st.floats(-0.04, 0.04), st.floats(-0.02, 0.02)),
    pixels_seen,
    st.floats(0.2, 5.0),
)
def test_even_a_dome_far_off_centre_is_inverted(centre, pixel, distance):
    dome = DomePort(np.array(centre), 0.0625, 0.006, 1.52)
    camera, pixels = camera_behind(dome), np.array([pixel])
    rays = back_project(camera, pixels, WATER)
    seen = rays.origins + distance * rays.directions
    np.testing.assert_allclose(project(camera, seen, WATER), pixels, atol=1e-6)


@settings(deadline=None)  # the first call may have to compile
@given(ports, pixels_seen)
def test_a_port_of_index_1_is_the_pinhole(name, pixel):
    port = PORTS[name]
    if isinstance(port, FlatPort):
        layers = tuple(Layer(layer.thickness, 1.0) for layer in port.layers)
        nothing = FlatPort(port.normal, port.distance, layers)
    else:
        nothing = DomePort(port.centre, port.radius, port.thickness, 1.0)
    pixels = np.array([pixel])
    pinhole = back_project(camera_behind(None), pixels)
    rays = back_project(camera_behind(nothing), pixels, 1.0)
    # Rounding of a few steps of arithmetic.
    np.testing.assert_allclose(rays.directions, pinhole.directions, atol=1e-14)
    np.testing.assert_allclose(np.cross(rays.origins, pinhole.directions), 0, atol=1e-15)
    points = rays.origins + 1.3 * rays.directions
    np.testing.assert_allclose(
        project(camera_behind(nothing), points, 1.0),
        project(camera_behind(None), points),
        atol=1e-10,
    )


def test_without_a_port_water_changes_nothing():
    camera, pixels = camera_behind(None), np.array([[100.0, 50.0]])
    dry, wet = back_project(camera, pixels), back_project(camera, pixels, WATER)
    np.testing.assert_array_equal(dry.directions, wet.directions)
    np.testing.assert_array_equal(wet.origins, 0)


@pytest.mark.parametrize("name", PORTS)
def test_rays_start_on_the_outer_face(name):
    port, pixels = PORTS[name], np.array([[10.0, 20.0], [700.0, 300.0]])
    starts = back_project(camera_behind(port), pixels, WATER).origins
    if isinstance(port, FlatPort):
        outer = port.distance + sum(layer.thickness for layer in port.layers)
        np.testing.assert_allclose(starts @ port.normal, outer, rtol=1e-12)
    else:
        away = np.linalg.norm(starts - port.centre, axis=1)
        np.testing.assert_allclose(away, port.radius + port.thickness, rtol=1e-12)


@pytest.mark.parametrize("name", PORTS)
def test_points_behind_the_camera_or_inside_the_port_are_not_seen(name):
    points = np.array([[0.0, 0.0, -1.0], [0.001, 0.0, 0.035], [0.0, 0.0, 0.0]])
    assert np.isnan(project(camera_behind(PORTS[name]), points, WATER)).all()


def test_a_ray_that_misses_a_flat_port_sees_nothing():
    steep = FlatPort(np.array([np.sin(1.3), 0.0, np.cos(1.3)]), 0.03, (GLASS,))
    rays = back_project(camera_behind(steep), np.array([[0.0, 288.0], [700.0, 288.0]]), WATER)
    assert np.isnan(rays.directions[0]).all()
    assert np.isfinite(rays.directions[1]).all()


@pytest.mark.parametrize("index", [None, 0.9, float("nan")])
def test_a_port_must_know_what_lies_outside(index):
    camera = camera_behind(PORTS["flat"])
    with pytest.raises(InputError, match="index"):
        back_project(camera, np.zeros((1, 2)), index)
    with pytest.raises(InputError, match="index"):
        project(camera, np.ones((1, 3)), index)


def test_no_pixels_give_no_rays():
    camera = camera_behind(PORTS["dome"])
    assert back_project(camera, np.zeros((0, 2)), WATER).origins.shape == (0, 3)
    assert project(camera, np.zeros((0, 3)), WATER).shape == (0, 2)
