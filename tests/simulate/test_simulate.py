"""What the simulated recording says is true, is true."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.optics import back_project, intersect_rays_with_sheet, project
from murkscan.simulate import (
    FlatWall,
    Light,
    Scene,
    WigleyHull,
    distance_to_surface,
    hull_rig,
    hull_scene,
    sample_mesh,
    simulate_frames,
    surface_normals,
)
from murkscan.types.laser import Laser
from murkscan.types.port import FlatPort
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

OVER_THE_HULL = (30, 95, 120, 200, 225)
"""Frames of the demo at the stern, over the bilge keels and at the bulb."""


def _frame(scene, index):
    return next(simulate_frames(scene, index))


def _standing(surface, rig, light=None):
    """A camera that stands still at the origin of the world."""
    trajectory = Trajectory(np.zeros(1), np.zeros((1, 3)), np.array([[1.0, 0, 0, 0]]))
    return Scene(surface, rig, trajectory, np.zeros(1), light or Light())


def _centroids(frame, ambient):
    """Centre of mass of each column, in a window around its peak; columns that show a stripe."""
    image = frame.image.astype(float) - ambient
    columns = np.flatnonzero(image.max(axis=0) > 12)
    rows = image.argmax(axis=0)[columns][:, None] + np.arange(-14, 15)
    weight = np.maximum(image[np.clip(rows, 0, len(image) - 1), columns[:, None]], 0)
    return np.stack([columns.astype(float), (weight * rows).sum(1) / weight.sum(1)], axis=1)


@pytest.mark.parametrize("index", OVER_THE_HULL)
def test_true_centres_lie_on_the_surface_the_sheet_and_their_pixel(index):
    scene = hull_scene()
    simulated = _frame(scene, index)
    points = simulated.stripe.points
    assert len(points) > 20
    away = points[:, 2] - scene.surface.depth(points[:, 0], points[:, 1])
    np.testing.assert_allclose(away, 0, atol=1e-9)
    in_camera = points - [0, 0.1 * simulated.frame.time, 0]
    sheet = scene.rig.lasers[0].as_plane()
    np.testing.assert_allclose(sheet.distance_to(in_camera), 0, atol=1e-9)
    seen = project(scene.rig.camera, in_camera)
    np.testing.assert_allclose(seen, simulated.stripe.pixels, atol=1e-9)


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("side", [1, -1])
def test_a_wall_shows_a_straight_line_where_equation_4_puts_it(axis, side):
    angle = math.atan2(0.5, 0.25)
    laser = Laser.from_baseline_angle(side * 0.25, angle if side > 0 else math.pi - angle, axis)
    rig = Rig(hull_rig().camera, (laser,))
    stripe = _frame(_standing(FlatWall(distance=0.6), rig), 0).stripe
    # Equation (4) solved for the image: x = f cot θ - f b / Z.
    expected = side * (554 * 0.5 - 554 * 0.25 / 0.6)
    along = "xy".index(axis)
    centre = rig.camera.principal_point[along] + expected
    np.testing.assert_allclose(stripe.pixels[:, along], centre, atol=1e-9)
    assert len(stripe.pixels) == rig.camera.size[1 - along]


def test_two_lasers_give_two_stripes():
    (first,) = hull_rig().lasers
    second = Laser.from_baseline_angle(-0.25, math.pi - math.atan2(0.5, 0.25), "y")
    rig = Rig(hull_rig().camera, (first, second))
    stripe = _frame(_standing(FlatWall(distance=0.6), rig), 0).stripe
    assert np.bincount(stripe.laser).tolist() == [720, 720]


def test_without_noise_the_hull_is_measured_to_a_tenth_of_a_millimetre():
    scene = hull_scene()
    scene = replace(scene, times=scene.times[5::12])
    distances = []
    for simulated in simulate_frames(scene):
        pixels = _centroids(simulated.frame, scene.light.ambient)
        points = intersect_rays_with_sheet(
            back_project(scene.rig.camera, pixels), scene.rig.lasers[0]
        )
        moved = points + np.array([0, 0.1 * simulated.frame.time, 0])
        distances.append(distance_to_surface(scene.surface, moved))
    distances = np.concatenate(distances)
    assert len(distances) > 3000
    # Only rounding to 8 bit is left: 0.02 px, of 2 mm each. The issue asks for 0.1 mm.
    assert np.sqrt(np.mean(distances**2)) < 0.02e-3


def test_the_stripe_has_its_width_across_itself():
    slope = 0.8
    rig = hull_rig()
    scene = _standing(FlatWall(0.5, slope=(slope, 0.0)), rig, Light(brightness=240.0, ambient=0.0))
    simulated = _frame(scene, 0)
    u, v = simulated.stripe.pixels.T
    tilt = np.gradient(v, u)[360]
    column = simulated.frame.image[:, 360].astype(float)
    rows = np.arange(len(column))
    spread = np.sqrt(np.average((rows - v[360]) ** 2, weights=column))
    # Rounding the tails to 8 bit takes 1 % off the standard deviation.
    assert spread == pytest.approx(2.0 * np.hypot(1, tilt), rel=0.02)


def test_brightness_follows_the_cosine_towards_the_laser():
    stripe = _frame(_standing(FlatWall(distance=0.5), hull_rig()), 0).stripe
    # On the axis the light comes in 0.25 m to the side over 0.5 m.
    cosine = 0.5 / np.linalg.norm([*stripe.points[360][:1], 0.25 + stripe.points[360][1], 0.5])
    assert stripe.signal[360] == pytest.approx(215 * cosine, rel=1e-6)


def test_the_hull_hides_what_lies_behind_its_edge_from_the_laser():
    """A wall so steep along y that the light cannot reach it, though the camera looks at it."""
    away = FlatWall(distance=0.5, slope=(0.0, 2.5))
    towards = FlatWall(distance=0.5, slope=(0.0, 1.5))
    assert len(_frame(_standing(away, hull_rig()), 0).stripe.pixels) == 0
    assert len(_frame(_standing(towards, hull_rig()), 0).stripe.pixels) > 0


def test_the_same_seed_gives_the_same_bytes_wherever_one_starts():
    first = [s.frame for s in itertools.islice(simulate_frames(hull_scene(noise=3.0, seed=7)), 5)]
    again = _frame(hull_scene(noise=3.0, seed=7), 4).frame
    other = _frame(hull_scene(noise=3.0, seed=8), 4).frame
    assert again.image.tobytes() == first[4].image.tobytes()
    assert other.image.tobytes() != first[4].image.tobytes()
    assert first[3].image.tobytes() != first[4].image.tobytes()


def test_noise_has_the_size_asked_for():
    image = _frame(replace(hull_scene(), light=Light(ambient=60.0, noise=3.0)), 0).frame.image
    # Rounding adds 1/12; 400 000 pixels tell the deviation to 0.1 %.
    assert image.std() == pytest.approx(math.sqrt(9 + 1 / 12), rel=0.01)
    assert image.mean() == pytest.approx(60, abs=0.05)


def test_frames_are_drawn_when_they_are_asked_for():
    scene = hull_scene()
    long = replace(scene, times=np.linspace(0, 10, 1_000_000))
    assert next(simulate_frames(long)).frame.index == 0


def test_before_and_after_the_hull_no_stripe_is_seen():
    scene = hull_scene()
    for index in (0, 249):
        simulated = _frame(scene, index)
        assert len(simulated.stripe.pixels) == 0
        assert simulated.stripe.points.shape == (0, 3)
        assert np.all(simulated.frame.image == scene.light.ambient)


def test_distance_is_that_along_the_normal_and_positive_towards_the_camera():
    hull = WigleyHull()
    rng = np.random.default_rng(1)
    x, y = rng.uniform(-0.1, 0.1, 500), rng.uniform(0.25, 0.7, 500)
    feet = np.stack([x, y, hull.depth(x, y)], axis=1)
    offset = rng.uniform(-3e-4, 3e-4, 500)
    points = feet + offset[:, None] * surface_normals(hull, x, y)
    # Normals come from difference quotients, true to 1e-8 of these 0.3 mm.
    np.testing.assert_allclose(distance_to_surface(hull, points), offset, atol=1e-9)


def test_the_mesh_lies_on_the_hull_and_faces_the_camera():
    hull = WigleyHull()
    mesh = sample_mesh(hull, spacing=0.004)
    x, y, z = mesh.vertices.T
    np.testing.assert_allclose(z, hull.depth(x, y), atol=0)
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    assert (np.cross(b - a, c - a)[:, 2] < 0).all()
    low, high = hull.box()
    assert (mesh.vertices >= low).all()
    assert (mesh.vertices <= high).all()


def test_what_cannot_be_simulated_is_refused():
    rig = hull_rig()
    behind_glass = replace(rig.camera, port=FlatPort(np.array([0, 0, 1.0]), 0.03, ()))
    with pytest.raises(InputError, match="in air"):
        _frame(_standing(FlatWall(), replace(rig, camera=behind_glass)), 0)
    with pytest.raises(InputError, match="at least 2 frames"):
        hull_scene(num_frames=1)
    with pytest.raises(InputError, match="width above 0"):
        Light(width=0.0)
    with pytest.raises(InputError, match="waterline"):
        WigleyHull(waterline=0.1)
