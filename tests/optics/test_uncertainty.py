import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import Degenerate, InputError
from murkscan.optics import parameters_of, perturb_rig
from murkscan.optics.length import measure_length
from murkscan.optics.uncertainty import (
    common_covariances,
    common_shifts,
    common_sigma,
    error_modes,
)
from murkscan.triangulate import RaySheet
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan, Laser
from murkscan.types.port import FlatPort, Layer
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.water import Water

pytestmark = pytest.mark.without_types

PORT = FlatPort(np.array([0.0, 0.0, 1.0]), 0.02, (Layer(0.01, 1.49),))
CAMERA = Camera((1920, 1200), (1400.0, 1402.0), (959.5, 600.0), port=PORT)
FAN = Fan.spread(
    np.array([-0.25, 0.0, 0.0]),
    np.array([0.25, 0.0, 1.0]),
    np.array([0.0, 1.0, 0.0]),
    0.5,
    replace(PORT, normal=np.array([0.0, 0.0, 1.0])),
)
SIGMAS = {
    "camera.focal_length": 0.5, "camera.principal_point": 0.4, "camera.distortion": 1e-4,
    "camera.port.normal": 1e-3, "camera.port.distance": 2e-4, "laser[0].shift": 1e-4,
    "laser[0].turn": 2e-4, "water.index": 1e-4, "mount.translation": 1e-3, "mount.turn": 1e-3,
}  # fmt: skip


def make_rig(*, mount=None):
    bare = Rig(CAMERA, (Laser.from_sheet(FAN),), water=Water(), vehicle_from_camera=mount)
    sigma, names = [], []
    for name in parameters_of(bare):
        if name.split("[")[0] in SIGMAS or name.rsplit("[", 1)[0] in SIGMAS:
            names.append(name)
            sigma.append(SIGMAS.get(name) or SIGMAS.get(name.rsplit("[", 1)[0]))
    random = np.random.default_rng(2)
    mixed = random.normal(size=(len(names), 2 * len(names)))
    correlation = np.corrcoef(mixed)
    return replace(
        bare, covariance=RigCovariance(tuple(names), correlation * np.outer(sigma, sigma))
    )


def pixels_of(count):
    random = np.random.default_rng(3)
    return np.stack([random.uniform(900, 1300, count), random.uniform(300, 900, count)], axis=1)


MOUNT = Pose(Rotation.from_euler("xyz", [10, 80, -30], degrees=True).as_matrix(),
             np.array([0.4, -0.1, 0.2]))  # fmt: skip


@pytest.mark.parametrize("mount", [None, MOUNT])
def test_the_covariances_are_those_of_rigs_drawn_at_random(mount):
    rig, pixels = make_rig(mount=mount), pixels_of(5)
    random = np.random.default_rng(1)
    modes = error_modes(rig.covariance)
    drawn = []
    for _ in range(1000):
        changed = perturb_rig(rig, rig.covariance.names, modes @ random.normal(size=modes.shape[1]))
        points = RaySheet().locate(pixels, changed, 0)
        drawn.append(points if mount is None else changed.vehicle_from_camera @ points)
    sampled = np.stack([np.cov(np.array(drawn)[:, i].T) for i in range(5)])
    stated = common_covariances(pixels, rig)
    # 1000 draws tell a variance to 4.5 %; four times that.
    scale = np.sqrt(np.einsum("nii,njj->nij", stated, stated))
    np.testing.assert_array_less(np.abs(sampled - stated) / scale, 0.18)


def test_the_modes_multiply_to_the_covariance():
    covariance = make_rig().covariance
    modes = error_modes(covariance)
    np.testing.assert_allclose(modes @ modes.T, covariance.matrix, atol=1e-12)


def test_a_singular_covariance_has_fewer_modes():
    together = RigCovariance(("camera.focal_length[0]", "camera.focal_length[1]"), np.ones((2, 2)))
    assert error_modes(together).shape == (2, 1)


def test_a_rig_without_covariance_has_no_common_part():
    rig = replace(make_rig(), covariance=RigCovariance())
    pixels = pixels_of(7)
    assert common_shifts(pixels, rig).shape == (7, 3, 0)
    np.testing.assert_array_equal(common_sigma(pixels, rig), 0.0)


def test_the_index_alone_moves_points_as_another_water_does():
    bare = replace(make_rig(), covariance=RigCovariance(("water.index",), np.array([[1e-8]])))
    pixels = pixels_of(20)
    salty = replace(bare, water=Water(index=1.3415104 + 1e-4))
    fresh = replace(bare, water=Water(index=1.3415104))
    moved = RaySheet().locate(pixels, salty, 0) - RaySheet().locate(pixels, fresh, 0)
    # The derivative is that of the index at 20 °C and 35 PSU, the same to 1e-6.
    np.testing.assert_allclose(common_shifts(pixels, bare)[:, :, 0], moved, rtol=2e-3, atol=1e-9)


def test_a_boresight_error_moves_points_across_their_ray():
    names = ("mount.turn[0]", "mount.turn[1]", "mount.turn[2]")
    rig = make_rig(mount=MOUNT)
    rig = replace(rig, covariance=RigCovariance(names, np.diag([1e-3, 1e-3, 0.0]) ** 2))
    pixels = pixels_of(30)
    points = RaySheet().locate(pixels, rig, 0)
    # 0.001 rad about an axis across the ray is 1 mm per metre of range.
    lever = np.abs(points[:, 2])
    np.testing.assert_allclose(common_sigma(pixels, rig), 1e-3 * lever, rtol=0.1)


def test_a_pixel_that_sees_no_point_has_no_deviation():
    rig = make_rig()
    pixels = np.array([[10.0, 600.0], [1100.0, 600.0]])
    is_seen = np.isfinite(RaySheet().locate(pixels, rig, 0)).all(axis=1)
    np.testing.assert_array_equal(np.isfinite(common_sigma(pixels, rig)), is_seen)


def test_memory_does_not_grow_with_the_number_of_points():
    rig, pixels = make_rig(), pixels_of(90_000)
    common_sigma(pixels[:10], rig)
    tracemalloc.start()
    common_sigma(pixels, rig)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # All shifts of all points at once would be 41 MB.
    assert peak < 30e6


def test_a_covariance_of_something_else_is_refused_by_name():
    rig = replace(make_rig(), covariance=RigCovariance(("laser[3].distance",), np.eye(1)))
    with pytest.raises(InputError, match=r"no parameter laser\[3\]\.distance"):
        common_sigma(pixels_of(3), rig)


def test_what_two_points_share_hardly_changes_their_distance():
    rig = make_rig()
    ends = np.array([[1100.0, 500.0], [1100.0, 520.0]])
    points, shifts = RaySheet().locate(ends, rig, 0), common_shifts(ends, rig)
    near = measure_length(points, np.zeros((2, 3)), shifts)
    alone = common_sigma(ends, rig)
    assert near.sigma_common < 0.05 * alone.min()
    assert near.sigma == near.sigma_common


def test_the_deviation_of_a_length_is_that_of_rigs_drawn_at_random():
    rig, random = make_rig(mount=MOUNT), np.random.default_rng(7)
    ends = np.array([[1000.0, 350.0], [1150.0, 800.0]])
    modes = error_modes(rig.covariance)
    lengths = []
    for _ in range(1000):
        changed = perturb_rig(rig, rig.covariance.names, modes @ random.normal(size=modes.shape[1]))
        first, second = changed.vehicle_from_camera @ RaySheet().locate(ends, changed, 0)
        lengths.append(np.linalg.norm(second - first))
    points = MOUNT @ RaySheet().locate(ends, rig, 0)
    found = measure_length(points, np.zeros((2, 3)), common_shifts(ends, rig))
    # 1000 draws tell a deviation to 2.2 %; four times that.
    assert found.sigma_common == pytest.approx(np.std(lengths), rel=0.09)


def test_a_length_adds_the_noise_of_its_ends_along_itself():
    ends = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 2.0]])
    noise = np.array([[0.0, 5.0, 3e-3], [7.0, 0.0, 4e-3]])
    found = measure_length(ends, noise, np.zeros((2, 3, 0)))
    assert (found.value, found.sigma_common) == (2.0, 0.0)
    assert found.sigma_independent == pytest.approx(5e-3)


def test_a_length_between_a_point_and_itself_is_refused():
    with pytest.raises(Degenerate, match="coincide"):
        measure_length(np.zeros((2, 3)), np.zeros((2, 3)), np.zeros((2, 3, 0)))
