"""Two noisy samples of one analytic surface, one of them moved: the motion is the truth."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import Degenerate, InputError, NotEnoughData
from murkscan.geometry.alignment import align_clouds, align_surfaces
from murkscan.geometry.surface_points import SurfacePoints
from murkscan.simulate.shapes import Sphere
from murkscan.types.cloud import PointCloud
from murkscan.types.mesh import Mesh
from murkscan.types.pose import Pose

pytestmark = pytest.mark.without_types

NOISE = 3e-4


def plane(u, v):
    return 0 * u, 0 * u, 0 * u


def cylinder(u, v):
    z = np.sqrt(0.4**2 - v**2)
    return 0.4 - z, 0 * u, v / z


def sphere(u, v):
    z = np.sqrt(0.5**2 - u**2 - v**2)
    return 0.5 - z, u / z, v / z


def waves(u, v):
    z = 0.03 * np.sin(12 * u) * np.cos(9 * v) + 0.5 * v**2
    du = 0.36 * np.cos(12 * u) * np.cos(9 * v)
    return z, du, v - 0.27 * np.sin(12 * u) * np.sin(9 * v)


def height_above(surface, points):
    """Signed distance to the surface [m], exact for a small one."""
    z, du, dv = surface(points[:, 0], points[:, 1])
    return (z - points[:, 2]) / np.sqrt(1 + du**2 + dv**2)


def sample(surface, random, *, aside=0.0, noise=NOISE, count=20_000, has_normals=True):
    u, v = random.uniform(-0.3, 0.3, count) + aside, random.uniform(-0.2, 0.2, count)
    z, du, dv = surface(u, v)
    normals = np.stack([du, dv, -np.ones(count)], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    points = np.stack([u, v, z], axis=1) + normals * random.normal(0, noise, (count, 1))
    normals += random.normal(0, 0.02, (count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return as_cloud(points, normals * has_normals)


def as_cloud(points, normals):
    ones, numbers = np.ones(len(points), np.float32), np.arange(len(points), dtype=np.int32)
    laser = branch = np.zeros(len(points), np.uint8)
    columns = (*[ones] * 4, numbers, numbers, laser, branch)
    return PointCloud(points, normals.astype(np.float32), *columns)


def moved(cloud, pose):
    return as_cloud(pose @ cloud.points, cloud.normals @ pose.rotation.T)


def some_motion(random):
    turn = Rotation.from_rotvec(random.normal(0, 0.005, 3)).as_matrix()
    return Pose(turn, random.normal(0, 0.004, 3))


def corner_distance(one, other):
    """How far apart two motions carry the corners of the sampled box [m]."""
    corners = np.array([[u, v, 0.0] for u in (-0.3, 0.3) for v in (-0.2, 0.2)])
    return np.linalg.norm(one @ corners - other @ corners, axis=1).max()


@pytest.mark.parametrize("has_normals", [True, False])
def test_a_surface_with_shape_is_laid_where_it_was(has_normals):
    random = np.random.default_rng(0)
    source, target = (sample(waves, random, aside=s, has_normals=has_normals) for s in (0.15, 0))
    target_from_source = some_motion(random)
    found = align_clouds(moved(source, target_from_source.inverse()), target)
    # The slopes of these waves are 0.25 (RMS), so 10,000 points of 0.3 mm noise fix each direction
    # to 0.3 / 0.25 / 100 = 0.012 mm; both clouds err, and at a corner two turns add: within 0.1.
    assert corner_distance(found.target_from_source, target_from_source) < 1e-4
    assert found.open_directions == ()
    # The strip that both see is 0.45 m of 0.6 m; at its rim a match may lie 1.5 spacings aside.
    assert found.overlap == pytest.approx(0.75, abs=0.03)


@pytest.mark.parametrize(
    ("surface", "words"),
    [
        (plane, {"sliding along x", "sliding along y", "turning about z"}),
        (cylinder, {"sliding along x", "turning about x"}),
        (sphere, {"turning about x", "turning about y", "turning about z"}),
        (waves, set()),
    ],
)
def test_what_a_surface_leaves_open_is_named_and_not_moved(surface, words):
    random = np.random.default_rng(1)
    source, target = sample(surface, random, aside=0.15), sample(surface, random)
    found = align_clouds(source, target)
    assert {str(direction) for direction in found.open_directions} == words
    # Source and target are in place: what moves is noise, 0.3 mm / √10,000 times a few.
    assert corner_distance(found.correction, Pose.identity()) < 1e-4


def test_the_axis_of_an_open_turn_goes_through_the_middle_of_the_cylinder():
    random = np.random.default_rng(1)
    found = align_clouds(sample(cylinder, random), sample(cylinder, random))
    turn = next(direction for direction in found.open_directions if direction.is_turn)
    # The axis is y = 0, z = 0.4; 0.1 rad of arc on both sides fix its depth to about a percent.
    np.testing.assert_allclose(turn.through[1:], [0, 0.4], atol=0.01)


def test_an_open_direction_askew_to_the_axes_is_given_in_numbers():
    random = np.random.default_rng(1)
    turn = Pose(Rotation.from_euler("z", 45, degrees=True).as_matrix(), np.zeros(3))
    source, target = (moved(sample(cylinder, random), turn) for _ in range(2))
    words = {str(direction) for direction in align_clouds(source, target).open_directions}
    assert words == {"sliding along (0.71, 0.71, 0.00)", "turning about (0.71, 0.71, 0.00)"}


@pytest.mark.parametrize("surface", [plane, waves])
def test_the_stated_deviation_holds_the_errors(surface):
    covered = []
    for seed in range(8):
        random = np.random.default_rng(seed)
        source, target = (sample(surface, random, aside=s, count=6000) for s in (0.15, 0))
        found = align_clouds(source, target)
        ideal = sample(surface, random, aside=0.15, noise=0.0, count=500)
        there = moved(ideal, found.target_from_source)
        error = height_above(surface, there.points)
        sigma = found.sigma_along(there.points, there.normals.astype(float))
        covered.append(np.abs(error) < 1.96 * sigma)
    # 8 alignments of three to six numbers each: a share of 95 % is met to about 8 % (1σ).
    assert np.mean(covered) > 0.8
    # A bound a third too wide would hold 99 % of the errors of every one.
    assert np.mean(covered) < 1.0


@pytest.mark.parametrize("surface", [plane, waves])
@pytest.mark.parametrize("axis", [0, 1], ids=["profiles", "scan lines"])
def test_the_stated_deviation_holds_errors_that_whole_profiles_share(axis, surface):
    """Strips of 5 mm, across all of the surface, are off by 0.3 mm, each by its own."""
    covered = []
    for seed in range(20):
        random = np.random.default_rng(seed)
        source, target = (
            shaken(sample(surface, random, aside=aside, noise=1e-4, count=6000), axis, random)
            for aside in (0.15, 0)
        )
        found = align_clouds(source, target)
        ideal = sample(surface, random, aside=0.15, noise=0.0, count=500)
        there = moved(ideal, found.target_from_source)
        sigma = found.sigma_along(there.points, there.normals.astype(float))
        covered.append(np.abs(height_above(surface, there.points)) < 1.96 * sigma)
    # 20 alignments: a share of 95 % is met to about 5 % (1σ).
    assert np.mean(covered) > 0.85


def shaken(cloud, axis, random):
    """Move strips of a cloud along its normals."""
    strip = np.floor((cloud.points[:, axis] + 1) / 0.005).astype(int)
    off = random.normal(0, NOISE, 400)[strip]
    return as_cloud(cloud.points + cloud.normals * off[:, None], cloud.normals)


def test_a_rough_start_is_taken_into_account():
    random = np.random.default_rng(0)
    source, target = sample(waves, random), sample(waves, random)
    far = Pose(Rotation.from_euler("y", 90, degrees=True).as_matrix(), np.array([3.0, 1.0, 0.0]))
    away, start = moved(source, far.inverse()), some_motion(random) @ far
    found = align_clouds(away, target, start=start)
    assert corner_distance(found.target_from_source @ far.inverse(), Pose.identity()) < 1e-4
    assert corner_distance(found.correction @ start, found.target_from_source) < 1e-12


def test_clouds_on_a_map_are_laid_on_one_another():
    random = np.random.default_rng(0)
    away = Pose(np.eye(3), np.array([500_000.0, 4_000_000.0, 0.0]))
    source, target = (moved(sample(waves, random), away) for _ in range(2))
    found = align_clouds(source, target)
    here = away.inverse() @ found.target_from_source @ away
    assert corner_distance(here, Pose.identity()) < 1e-4


def test_a_cloud_is_laid_on_a_mesh():
    sphere_mesh = Sphere(radius=0.5).mesh()
    mesh = Mesh(sphere_mesh.vertices - sphere_mesh.vertices.mean(axis=0) + [0, 0, 0.5],
                sphere_mesh.faces)  # fmt: skip
    shift = Pose(np.eye(3), np.array([0.0, 0.0, 0.004]))
    cloud = moved(sample(sphere, np.random.default_rng(0)), shift)
    spacing = 0.01
    found = align_surfaces(
        SurfacePoints.from_cloud(cloud, spacing=spacing),
        SurfacePoints.from_mesh(mesh, spacing=spacing),
    )
    assert len(found.open_directions) == 3
    assert found.target_from_source.translation[2] == pytest.approx(-0.004, abs=5e-5)


def test_surfaces_that_do_not_meet_are_refused():
    random = np.random.default_rng(0)
    target = sample(waves, random)
    for away in ([2.0, 0.0, 0.0], [0.0, 0.0, 0.2]):
        source = moved(sample(waves, random), Pose(np.eye(3), np.array(away)))
        with pytest.raises(Degenerate, match="do not overlap"):
            align_clouds(source, target)


def test_a_few_points_and_points_without_place_are_refused():
    cloud = sample(plane, np.random.default_rng(0))
    with pytest.raises(NotEnoughData, match="at least 30 points to align a surface, got 0"):
        align_clouds(cloud[:0], cloud)
    with pytest.raises(InputError, match="reach must be above 0"):
        align_clouds(cloud, cloud, reach=-1.0)
    cloud.points[3] = np.nan
    with pytest.raises(InputError, match="1 of 20000 points are not finite"):
        align_clouds(cloud, cloud)
