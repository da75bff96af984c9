from dataclasses import replace

import numpy as np

from murkscan.optics.uncertainty import common_sigma
from murkscan.survey.common_part import spread_common
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.profile import Profile
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance

LASERS = tuple(Laser.from_baseline_angle(b, 1.2, "x") for b in (0.2, 0.4))
NAMES = ("camera.focal_length[0]", "laser[0].distance", "laser[1].distance")
RIG = Rig(
    Camera((640, 480), (800.0, 800.0), (320.0, 240.0)),
    LASERS,
    covariance=RigCovariance(NAMES, np.diag([0.5, 1e-4, 3e-4]) ** 2),
)


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
    sigma = spread_common(profile, RIG)
    for number in (0, 1):
        mine = profile.laser == number
        expected = common_sigma(profile.pixels[mine], RIG, number)
        # As files keep it, in single precision.
        np.testing.assert_allclose(sigma[mine], expected, rtol=1e-6)
        assert (sigma[mine] > 0).all()


def test_a_rig_without_covariance_gives_zero():
    sigma = spread_common(make_profile(10), replace(RIG, covariance=RigCovariance()))
    np.testing.assert_array_equal(sigma, 0.0)
