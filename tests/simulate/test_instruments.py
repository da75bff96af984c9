"""What a simulated vehicle measures errs as stated, and is read back by `--navigation`."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import FormatError, InputError
from murkscan.io.navigation_log import read_navigation_log
from murkscan.io.navigation_writing import save_navigation
from murkscan.simulate import load_scene
from murkscan.simulate.instruments import Instruments, measure_way
from murkscan.simulate.scene_file import parse_scene, read_scene
from murkscan.simulate.shapes import Grown
from murkscan.types.navigation import NavigationAccuracy
from murkscan.types.trajectory import Trajectory

ACCURACY = NavigationAccuracy(
    velocity_noise=3e-3, velocity_bias=1e-3, attitude_noise=np.radians(0.1),
    attitude_bias=np.radians(0.2), heading_drift=np.radians(0.5) / 60, depth_noise=5e-3,
)  # fmt: skip


def way(seconds=100.0):
    times = np.arange(-1.0, seconds + 1.0, 0.05)
    turn = Rotation.from_rotvec(np.outer(0.3 * np.sin(times / 7), [0, 0, 1]))
    places = np.stack([0.1 * times, 0.02 * np.sin(times), 3 + 0 * times], axis=1)
    return Trajectory(times, places, turn.as_quat(scalar_first=True))


def test_instruments_err_as_they_are_stated_and_are_stamped_late():
    truth = way()
    errors = []
    for seed in range(40):
        found = measure_way(Instruments("dvl", 10.0, 0.3, ACCURACY), truth, seed=seed)
        there = truth.at(found.attitude.times - 0.3)
        turns = Rotation.from_quat(there.quaternions, scalar_first=True)
        off = found.attitude.values - turns.as_euler("ZYX")[:, ::-1]
        steps = np.gradient(there.positions, there.times, axis=0)
        speed = found.velocity.values - turns.inv().apply(steps)
        depth = found.depth.values[:, 0] - there.positions[:, 2]
        drift = np.polyfit(there.times, off[:, 2], 1)[0]
        bias = speed[5:-5].mean(axis=0)
        errors.append([off[:, 0].std(), off[:, 0].mean(), drift, depth.std(), *bias[:2],
                       speed[5:-5, 1].std()])  # fmt: skip
    sizes = np.sqrt(np.mean(np.square(errors), axis=0))
    stated = [ACCURACY.attitude_noise, ACCURACY.attitude_bias, ACCURACY.heading_drift,
              ACCURACY.depth_noise, ACCURACY.velocity_bias, ACCURACY.velocity_bias,
              ACCURACY.velocity_noise]  # fmt: skip
    # Forty draws of a bias know its deviation to 11 %; that of two velocities is one of 80.
    np.testing.assert_allclose(sizes, stated, rtol=0.35)


def test_measurements_are_read_back_as_they_were_written(tmp_path):
    found = measure_way(Instruments("dvl", 10.0, 0.0, ACCURACY), way(5.0), seed=1)
    save_navigation(tmp_path / "nav.csv", found)
    read = read_navigation_log(tmp_path / "nav.csv", accuracy=ACCURACY).navigation
    for name in ("attitude", "depth", "velocity"):
        one, other = getattr(found, name), getattr(read, name)
        np.testing.assert_allclose(other.values, one.values, atol=1e-6)
        np.testing.assert_allclose(other.times, one.times, atol=1e-6)


def test_a_vehicle_without_a_dvl_logs_no_velocity():
    assert measure_way(Instruments("ahrs", 10.0, 0.0, ACCURACY), way(5.0), seed=1).velocity is None
    with pytest.raises(InputError, match="depth_noise_mm must be above 0"):
        Instruments("ahrs", 10.0, 0.0, NavigationAccuracy(attitude_noise=1e-3))


def test_the_scene_of_two_lasers_has_two_and_keys_of_other_logs_are_refused():
    scene = load_scene("two-lasers")
    assert len(scene.rig.lasers) == 2
    text, name, folder = read_scene("two-lasers")
    wrong = text.replace("depth_noise_mm = 5.0", "depth_noise_mm = 5.0\nposition_noise_mm = 1.0")
    with pytest.raises(FormatError, match="position_noise_mm does not go with kind 'ahrs'"):
        parse_scene(wrong, name, folder)


def test_a_grown_plate_has_the_bumps_and_the_bend_that_it_says():
    plate = Grown(width=0.4, height=0.5, bump=2e-3, size=0.01, radius=1.0)
    mesh = plate.mesh()
    x, _, z = mesh.vertices.T
    # The bend of 20 mm at the rim is taken off; the field is scaled to its own deviation.
    assert np.std(z - x**2 / 2) == pytest.approx(2e-3, rel=1e-6)
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    assert (np.cross(b - a, c - a)[:, 2] < 0).all()  # towards the camera
    with pytest.raises(InputError, match="bump above 0 m"):
        Grown(bump=0.0)
