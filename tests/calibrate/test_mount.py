import functools
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.calibrate import BoardView, Chessboard
from murkscan.calibrate.adjust.parameters import MOUNT as MOUNT_NAMES
from murkscan.calibrate.mount import MeasuredPlace, calibrate_mount, circles_of
from murkscan.calibrate.verdict import judge
from murkscan.errors import Degenerate, InputError, NotConverged, NotEnoughData
from murkscan.optics import project, refractive_index
from murkscan.types.camera import Camera
from murkscan.types.port import FlatPort, Layer
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.trajectory import Trajectory
from murkscan.types.water import Water

pytestmark = pytest.mark.without_types

BOARD = Chessboard(9, 6, 0.03)
CAMERA = Camera((1280, 960), (1100.0, 1102.0), (640.0, 478.0), np.array([-0.1, 0.02, 0, 0, 0]))
RIG = Rig(CAMERA)
MOUNT = Pose(Rotation.from_euler("xyz", [95, 4, -80], degrees=True).as_matrix(),
             np.array([0.31, -0.12, 0.07]))  # fmt: skip
WORLD_FROM_BOARD = Pose(
    Rotation.from_euler("xyz", [20, -15, 130], degrees=True).as_matrix(), np.array([4.0, -2.0, 1.5])
)


def vehicles_at(times, turns):
    """Give world_from_vehicle: a slow dance before the board, turning by `turns` [rad]."""
    rates, phases = [0.31, 0.23, 0.17], [0.3, 1.1, 2.0]
    tilts = Rotation.from_euler("xyz", np.array(turns) * np.sin(np.outer(times, rates) + phases))
    away = np.stack(
        [0.1 * np.sin(0.4 * times), 0.08 * np.cos(0.29 * times), np.full(len(times), -0.9)], axis=1
    )
    cameras = Rotation.from_matrix(WORLD_FROM_BOARD.rotation) * tilts
    places = WORLD_FROM_BOARD @ (BOARD.points().mean(axis=0) + tilts.apply(away))
    camera_from_vehicle = MOUNT.inverse()
    return Trajectory(
        times,
        places + cameras.apply(camera_from_vehicle.translation),
        (cameras * Rotation.from_matrix(camera_from_vehicle.rotation)).as_quat(scalar_first=True),
    )


@functools.cache
def dance(turns):
    """Log every twentieth of a second of the dance, by the clock of the photos."""
    return vehicles_at(np.arange(-70.0, 170.0, 0.05), turns)


@functools.cache
def record(turns=(0.5, 0.5, 0.5), *, noise=0.0, clock=0.0, rig=RIG, num=20):
    """Log a dance, and photograph the board in it; the log's clock may be late by `clock` [s]."""
    random = np.random.default_rng(4)
    log = replace(dance(turns), times=dance(turns).times + clock)
    times = np.linspace(0, 100, num)
    index = refractive_index(rig.water, rig.wavelength)
    views, vehicles = [], vehicles_at(times, turns)
    for number, place in enumerate(vehicles.positions):
        vehicle = Pose.from_quaternion(vehicles.quaternions[number : number + 1], place)
        camera_from_board = MOUNT.inverse() @ vehicle.inverse() @ WORLD_FROM_BOARD
        corners = project(rig.camera, camera_from_board @ BOARD.points(), index)
        views.append(BoardView(f"{number}", corners + random.normal(0, noise, corners.shape)))
    return views, times, log


def assert_is_mount(found, shift, turn):
    off = MOUNT.inverse() @ found.rig.vehicle_from_camera
    assert np.linalg.norm(off.translation) < shift
    assert np.linalg.norm(Rotation.from_matrix(off.rotation).as_rotvec()) < turn


def test_exact_corners_and_poses_give_the_mount_exactly():
    found = calibrate_mount(*record(), BOARD, RIG)
    # The log is interpolated over 0.05 s, in which the dance bends by some micrometres.
    assert_is_mount(found, 2e-5, 2e-5)
    assert circles_of(found).closure < 2e-5
    assert judge(found).is_good


def test_a_camera_behind_a_port_under_water_has_the_same_mount():
    port = FlatPort(np.array([0.0, 0, 1]), 0.03, (Layer(0.008, 1.49),))
    rig = Rig(replace(CAMERA, port=port), water=Water())
    assert_is_mount(calibrate_mount(*record(rig=rig), BOARD, rig), 2e-5, 2e-5)


def test_a_few_wrong_poses_are_left_out_and_named():
    views, times, log = record(noise=0.1)
    views = [*views]
    views[3], views[11] = views[11], replace(views[3], name="wrong")
    found = calibrate_mount(views, times, log, BOARD, RIG)
    assert set(found.left_out) == {"wrong", "11"}
    # 0.1 px at 1100 px and 0.9 m is 0.08 mm a corner; turns of 30 degrees tell the rest.
    assert_is_mount(found, 5e-4, 5e-4)


def test_a_clock_that_is_a_little_late_is_measured():
    found = calibrate_mount(*record(noise=0.1, clock=0.12), BOARD, RIG)
    assert found.adjustment.stand.clock_offset == pytest.approx(0.12, abs=4 * found.clock_sigma)
    assert found.clock_sigma < 0.005
    assert_is_mount(found, 5e-4, 5e-4)


@pytest.mark.parametrize("clock", [-7.4, 3.0, 41.0])
def test_a_clock_that_is_off_by_seconds_is_refused_with_the_cure(clock):
    with pytest.raises(InputError, match=rf"clock is off.*--time-offset-s {clock:.1f}"):
        calibrate_mount(*record(noise=0.1, clock=clock), BOARD, RIG)


def test_a_vehicle_that_stands_still_in_each_photo_does_not_tell_its_clock():
    views, times, log = record(noise=0.1)
    still = log.at(times)
    halts = Trajectory(
        np.repeat(times, 2) + np.tile([-1.0, 1.0], len(times)),
        np.repeat(still.positions, 2, axis=0),
        np.repeat(still.quaternions, 2, axis=0),
    )
    found = calibrate_mount(views, times, halts, BOARD, RIG)
    assert found.clock_sigma is None
    assert_is_mount(found, 5e-4, 5e-4)


def test_the_stated_deviations_are_those_that_happen():
    offs, sigmas = [], []
    views, times, log = record()
    random = np.random.default_rng(5)
    at_photos = log.at(times)
    for _ in range(12):
        noisy = [replace(v, corners=v.corners + random.normal(0, 0.2, v.corners.shape))
                 for v in views]  # fmt: skip
        places = at_photos.positions + random.normal(0, 1e-3, at_photos.positions.shape)
        turned = Rotation.from_quat(at_photos.quaternions, scalar_first=True) * (
            Rotation.from_rotvec(random.normal(0, 1e-3, (len(times), 3)))
        )
        found = calibrate_mount(
            noisy, times, Trajectory(times, places, turned.as_quat(scalar_first=True)), BOARD, RIG
        )
        off = found.rig.vehicle_from_camera.translation - MOUNT.translation
        turn = Rotation.from_matrix(MOUNT.rotation.T @ found.rig.vehicle_from_camera.rotation)
        offs.append([*off, *turn.as_rotvec()])
        sigmas.append(found.sigma)
    ratio = np.std(offs, axis=0) / np.sqrt(np.mean(np.square(sigmas), axis=0))
    # 12 trials tell a deviation to 20 %, all six together to 10 %; three times that. Deviations
    # told from 20 photos may be 20 % too careful.
    assert 0.5 < np.sqrt(np.mean(ratio**2)) < 1.4, ratio


def test_turns_about_one_axis_are_refused_with_the_axis():
    with pytest.raises(Degenerate, match=r"where along .* one axis only.*--measured-mm"):
        calibrate_mount(*record((0.0, 0.0, 0.6), noise=0.1), BOARD, RIG)


def test_a_measured_place_tells_what_one_axis_cannot():
    views, times, log = record((0.0, 0.0, 0.6), noise=0.1)
    measured = MeasuredPlace(MOUNT.translation + np.array([0.002, -0.001, 0.001]), 0.003)
    found = calibrate_mount(views, times, log, BOARD, RIG, measured=measured)
    off = found.rig.vehicle_from_camera.translation - MOUNT.translation
    covariance = found.rig.covariance.matrix[-6:-3, -6:-3]
    axis = MOUNT.rotation[:, 2]
    along, across = axis @ off, off - (axis @ off) * axis
    # Along the axis the ruler counts; across it the photos do, by how the board is tilted.
    assert abs(along) < 0.003
    assert 0.002 < np.sqrt(axis @ covariance @ axis) < 0.0031
    sigma_across = np.sqrt(np.trace(covariance) - axis @ covariance @ axis)
    assert np.linalg.norm(across) < 4 * sigma_across
    assert sigma_across < 0.005


def test_a_vehicle_that_never_turned_is_refused():
    with pytest.raises(Degenerate, match="never turned"):
        calibrate_mount(*record((0.0, 0.0, 0.0), noise=0.1), BOARD, RIG)


def test_three_photos_are_too_few():
    views, times, log = record()
    with pytest.raises(NotEnoughData, match=r"at least 4 photos.*found it in 3 of 3"):
        calibrate_mount(views[:3], times[:3], log, BOARD, RIG)


def test_photos_outside_the_log_are_refused_with_both_intervals():
    views, times, log = record()
    with pytest.raises(InputError, match=r"from 1000\.000 to 1100\.000 s.*-70\.000 to 169\.950 s"):
        calibrate_mount(views, times + 1000, log, BOARD, RIG)


def test_a_log_of_the_inverse_poses_is_refused_with_that_guess():
    views, times, log = record(noise=0.1)
    rotations = Rotation.from_quat(log.quaternions, scalar_first=True).inv()
    inverse = Trajectory(
        log.times, -rotations.apply(log.positions), rotations.as_quat(scalar_first=True)
    )
    with pytest.raises(NotConverged, match=r"do not belong together.*vehicle_from_world"):
        calibrate_mount(views, times, inverse, BOARD, RIG)


def test_what_the_camera_does_not_know_the_mount_does_not():
    views, times, log = record(noise=0.1)
    plain = calibrate_mount(views, times, log, BOARD, RIG)
    names = ("camera.focal_length[0]", "camera.focal_length[1]")
    # Both focal lengths wrong by 1 % together: the board seems 9 mm nearer or farther.
    vague = replace(RIG, covariance=RigCovariance(names, np.full((2, 2), 11.0**2)))
    found = calibrate_mount(views, times, log, BOARD, vague)
    assert found.rig.covariance.names == names + MOUNT_NAMES
    assert found.sigma[:3].max() > 3 * plain.sigma[:3].max()
    longer = replace(CAMERA, focal_length=(1100 + 11.0, 1102 + 11.0))
    moved = calibrate_mount(views, times, log, BOARD, replace(RIG, camera=longer))
    shift = moved.rig.vehicle_from_camera.translation - plain.rig.vehicle_from_camera.translation
    shared = found.rig.covariance.matrix[0, 2:5] / 11.0
    # The same change by the derivatives: to 10 % of the 9 mm, the curve of a change of 1 %.
    np.testing.assert_allclose(shared, shift, atol=0.0009)
