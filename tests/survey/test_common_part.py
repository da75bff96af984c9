from dataclasses import replace

import numpy as np
import pytest

from murkscan.io.rig_toml import as_tables
from murkscan.motion import ConstantSpeed
from murkscan.optics.seen_points import spread_common
from murkscan.optics.uncertainty import common_sigma
from murkscan.survey.cloud import build_cloud
from murkscan.survey.sample import load_sample
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.profile import Profile
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.trajectory import Trajectory

from ..projects import SCAN, scanned
from ..scans import plane, scan
from ..scenes import air_rig

LASERS = tuple(Laser.from_baseline_angle(b, 1.2, "x") for b in (0.2, 0.4))
NAMES = ("camera.focal_length[0]", "laser[0].distance", "laser[1].distance")
RIG = Rig(
    Camera((640, 480), (800.0, 800.0), (320.0, 240.0)),
    LASERS,
    covariance=RigCovariance(NAMES, np.diag([0.5, 1e-4, 3e-4]) ** 2),
)

STILL = Trajectory(np.zeros(1), np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0, 0.0]]))


def make_profile(count):
    laser = (np.arange(count) % 2).astype(np.uint8)
    pixels = np.stack([np.full(count, 100.0), np.linspace(0, 479, count)], axis=1)
    ratio = np.ones(count, np.float32)
    return Profile(
        laser.astype(np.uint32), np.zeros(count), laser, pixels, np.zeros((count, 3)),
        ratio, ratio, ratio, np.zeros(count, np.uint8),
    )  # fmt: skip


def test_each_point_has_the_deviation_of_its_own_laser():
    profile = make_profile(101)
    sigma = spread_common(profile, STILL, RIG)
    for number in (0, 1):
        mine = profile.laser == number
        expected = common_sigma(profile.pixels[mine], RIG, number)
        # As files keep it, in single precision.
        np.testing.assert_allclose(sigma[mine], expected, rtol=1e-6)
        assert (sigma[mine] > 0).all()


def test_a_rig_without_covariance_gives_zero():
    sigma = spread_common(make_profile(10), STILL, replace(RIG, covariance=RigCovariance()))
    np.testing.assert_array_equal(sigma, 0.0)


def test_the_motion_adds_what_it_is_off_by(tmp_path):
    """At a speed known to 10 %, a point that was seen after 0.1 m is off by 10 mm, and so is the
    length to it; the rig has no covariance here."""
    profile, _ = scan(plane)
    times = np.unique(profile.time)
    poses = ConstantSpeed(0.025, "x", sigma=0.1).follow(times, times)
    project = scanned(tmp_path, profile, poses, parts=3)
    rig = air_rig(axis="x")
    project.save_scan(replace(SCAN, rig=as_tables(rig)))
    build_cloud(project, rig)
    cloud = project.load_cloud()
    far = cloud.frame == 100
    np.testing.assert_allclose(cloud.sigma_common[far], 0.01, rtol=1e-3)
    shifts = load_sample(project).shifts(np.flatnonzero(far)[:1])
    assert np.linalg.norm(shifts) == pytest.approx(0.01, rel=1e-3)
    both = load_sample(project).shifts(np.array([np.flatnonzero(far)[0], 0]))
    assert np.linalg.norm(both[0] - both[1]) == pytest.approx(0.01, rel=1e-3)
