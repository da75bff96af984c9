"""What a simulated recording says is true, is true."""

import math

import numpy as np
import pytest

from murkscan.extract import GrayGravity
from murkscan.optics import back_project, intersect_rays_with_sheet
from murkscan.simulate import Light, Particles, Sensor, Simulator, load_scene
from murkscan.simulate.shapes import Plane, Sphere
from murkscan.simulate.textures import Plain

from ..scenes import air_rig, body, smaller, standing, wall


def _on_plane(points):
    """Distance from z = 0.6 + 0.1 x, which `_leaning` is [m]."""
    return (points[:, 2] - 0.6 - 0.1 * points[:, 0]) / math.hypot(1, 0.1)


def _leaning():
    from scipy.spatial.transform import Rotation

    from murkscan.simulate import Body
    from murkscan.types.pose import Pose

    turn = Rotation.from_rotvec([0, -math.atan(0.1), 0]).as_matrix()
    return Body(Plane(8.0, 8.0).mesh(), Pose(turn, np.array([0, 0, 0.6])), Plain(0.2))


def _triangulate(scene, stripe):
    rays = back_project(scene.rig.camera, stripe.pixels, scene.index)
    return intersect_rays_with_sheet(rays, scene.rig.lasers[0], scene.index)


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("side", [1, -1])
def test_true_centres_on_a_plane_triangulate_onto_it(axis, side):
    scene = standing(_leaning(), rig=air_rig(side * 0.25, axis=axis))
    stripe = Simulator.of(scene).draw_frame(0).stripe
    assert len(stripe) == scene.rig.camera.size["yx".index(axis)]
    points = _triangulate(scene, stripe)
    # The issue asks for 1 µm; rounding leaves a thousandth of that.
    np.testing.assert_allclose(points, stripe.points, atol=1e-9)
    np.testing.assert_allclose(_on_plane(points), 0, atol=1e-8)


@pytest.mark.parametrize("name", ["plane", "plane-hd"])
def test_true_centres_on_a_plane_triangulate_onto_it_through_ports(name):
    scene = smaller(load_scene(name), 3 if name.endswith("-hd") else 1)
    frame = Simulator.of(scene).draw_frame(40)
    assert len(frame.stripe) > 600
    points = scene.pose(40) @ _triangulate(scene, frame.stripe)
    mesh = scene.surroundings.mesh
    normal = np.cross(*(mesh.vertices[mesh.faces[0, 1:]] - mesh.vertices[mesh.faces[0, 0]]))
    away = (points - mesh.vertices[0]) @ (normal / np.linalg.norm(normal))
    np.testing.assert_allclose(away, 0, atol=1e-6)


@pytest.mark.parametrize("name", ["sphere", "sphere-hd"])
def test_true_centres_on_a_sphere_lie_on_its_mesh_through_ports(name):
    from murkscan.geometry.mesh_distance import distance_to_mesh

    scene = smaller(load_scene(name), 3 if name.endswith("-hd") else 2)
    number = len(scene) // 2
    stripe = Simulator.of(scene).draw_frame(number).stripe
    on_sphere = stripe.points[:, 2] < 1.1
    assert np.count_nonzero(on_sphere) > 50
    points = scene.pose(number) @ _triangulate(scene, stripe)
    assert distance_to_mesh(points[::5], scene.surroundings.mesh).max() < 1e-6


def test_a_sphere_hides_the_wall_behind_it_from_laser_and_camera():
    ball = body(Sphere(0.1), (0.0, 0.0, 0.55), texture=Plain(0.2))
    stripe = Simulator.of(standing(ball, wall(0.9))).draw_frame(0).stripe
    on_wall = stripe.points[:, 2] > 0.8
    # Light comes from y = -0.25: where the ball stands in its way, the wall is dark.
    dark = np.setdiff1d(np.arange(720), stripe.pixels[on_wall, 0].astype(int))
    assert len(dark) > 100
    reached = 0.25 + stripe.points[~on_wall, 1]
    assert (reached < 0.25 + 0.1).all()


def test_gray_gravity_finds_the_true_centres_of_a_clean_plane():
    # A beam of 6 mm makes a stripe of 2 px on top of the lens's 1 px.
    scene = standing(
        _leaning(), light=Light(waist=6e-3), sensor=Sensor(psf=1.0, peak_grey=4e4, read_noise=0.0,
        shot_noise=False, vignetting=False, black_level=0.0, full_well=1e6, bits=16),
    )  # fmt: skip
    frame = Simulator.of(scene).draw_frame(0)
    extractor = GrayGravity()
    background = extractor.learn([frame.frame], scene.rig)
    found = next(extractor.extract([frame.frame], scene.rig, background))
    assert len(found) == len(frame.stripe)
    errors = found.pixels[:, 1] - frame.stripe.pixels[:, 1]
    assert np.sqrt(np.mean(errors**2)) < 0.02


def test_the_bound_is_that_of_a_gaussian_in_white_noise():
    noise, well = 50.0, 1e6
    sensor = Sensor(
        full_well=well, read_noise=noise, shot_noise=False, bits=16, vignetting=False, psf=2.0,
        peak_grey=4e4, black_level=0.0,
    )  # fmt: skip
    scene = standing(wall(0.5), sensor=sensor, light=Light(waist=1e-5, divergence=0.0))
    simulator = Simulator.of(scene)
    frame = simulator.draw_frame(0)
    width = math.sqrt(4.0 + 1 / 12)
    light = (frame.light.lasers[0].stripe * simulator.camera.electrons)[:, 360].sum()
    peak = light / (math.sqrt(2 * math.pi) * width)
    # field.md and Kay: 1.062 · √w · s / A for a stripe sampled well.
    assert frame.stripe.crlb[360] == pytest.approx(
        1.062 * math.sqrt(width) * noise / peak, rel=0.01
    )
    power = np.sqrt(math.sqrt(math.pi) * width) * peak / noise
    assert frame.stripe.snr[360] == pytest.approx(power, rel=0.01)


def test_the_bound_is_reached_by_least_squares():
    """Fit position alone, with all else known, to many noisy frames of one line."""
    sensor = Sensor(bits=16, full_well=3000.0, read_noise=20.0, psf=1.2, peak_grey=2e4)
    scene = standing(wall(0.5), sensor=sensor)
    simulator = Simulator.of(scene)
    light = simulator.draw_light(0)
    stripe, slope = (
        p * simulator.camera.electrons for p in (light.lasers[0].stripe, light.lasers[0].slope)
    )
    weight = 1 / sensor.variance(light.total * simulator.camera.electrons)
    known = (weight * slope**2).sum(axis=0)
    rng = np.random.default_rng(0)
    errors = []
    for _ in range(40):
        noise = rng.standard_normal(stripe.shape) / np.sqrt(weight)
        errors.append((weight * slope * noise).sum(axis=0) / known)
    spread = np.std(errors, axis=0)
    stated = simulator.draw_frame(0).stripe.crlb
    # 40 frames of 720 columns tell the deviation to 1 %.
    assert np.median(spread / stated) == pytest.approx(1.0, abs=0.03)


def test_a_saturated_stripe_tells_less():
    plain = Simulator.of(standing(wall(0.5), sensor=Sensor(peak_grey=200.0))).draw_frame(0)
    full = Simulator.of(standing(wall(0.5), sensor=Sensor(peak_grey=3000.0))).draw_frame(0)
    assert (full.frame.image.max(axis=0) == 255).all()
    assert np.median(full.stripe.snr) < np.median(plain.stripe.snr)


def test_snow_is_as_dense_as_asked_and_the_same_wherever_one_starts():
    scene = standing(wall(0.6), particles=Particles(per_frame=400.0, diameter=1e-3))
    simulator = Simulator.of(scene)
    light = simulator.draw_light(0).lasers[0]
    bright = light.glow > 0.02 * light.glow.max()
    assert simulator.snow_density[0] > 0
    import cv2

    count, _ = cv2.connectedComponents(bright.astype(np.uint8))
    # Those far from the sheet's middle, and those that touch, are not counted.
    assert 100 < count < 400


def test_dark_water_has_no_snow_behind_the_wall():
    scene = standing(wall(0.6), particles=Particles(per_frame=400.0, diameter=1e-3))
    light = Simulator.of(scene).draw_light(0).lasers[0]
    v = int(light.line.positions[360])
    assert light.glow[: v - 8].max() > 0
    assert light.glow[v + 8 :].max() < 1e-4 * light.glow.max()
