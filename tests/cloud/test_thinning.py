"""One point a voxel: weights, deviations, and the same result however the cloud comes in."""

import dataclasses

import numpy as np
import pytest

from murkscan.cloud import thin_cloud, thin_clouds, thinning
from murkscan.errors import InputError
from murkscan.types.cloud import PointCloud


def some_cloud(count=20_000, seed=0, *, sigma=(1e-4, 4e-4)):
    """A wall of 0.4 m at z = 0.5 with the noise that its sigma states."""
    random = np.random.default_rng(seed)
    each = random.uniform(*sigma, count)
    x, y = random.uniform(-0.2, 0.2, (2, count))
    ones = np.ones(count, np.float32)
    return PointCloud(
        np.stack([x, y, 0.5 + random.normal(0, 1, count) * each], axis=1),
        np.tile(np.array([0, 0, -1], np.float32), (count, 1)),
        ones * 50,
        ones,
        each.astype(np.float32),
        ones * np.float32(3e-4),
        np.arange(count, dtype=np.int32),
        np.arange(count, dtype=np.int32),
        *np.zeros((2, count), np.uint8),
    )


def same(one, other):
    order, others = (np.lexsort(cloud.points.T) for cloud in (one, other))
    np.testing.assert_allclose(one.points[order], other.points[others], rtol=0, atol=1e-12)
    np.testing.assert_array_equal(one.frame[order], other.frame[others])


def test_the_means_are_as_good_as_their_sigma_says():
    thin = thin_cloud(some_cloud(), 0.01)
    # Of a cube that the wall cuts at a corner, noise decides which points are in it: such a mean
    # is off by more than its sigma. They are those of few points.
    whole = thin[thin.sigma < 1.4 * np.median(thin.sigma)]
    assert len(whole) > 0.6 * len(thin)
    normalised = (whole.points[:, 2] - 0.5) / whole.sigma
    # The mean square of 2,000 standard normals is 1 to 0.03; corners remain.
    assert np.mean(normalised**2) == pytest.approx(1, abs=0.1)


def test_the_part_that_all_points_share_is_not_averaged_down():
    thin = thin_cloud(some_cloud(), 0.02)
    np.testing.assert_allclose(thin.sigma_common, 3e-4, rtol=1e-6)
    assert thin.sigma.max() < 4e-4


def test_a_well_known_point_counts_more():
    cloud = some_cloud(2, sigma=(1e-4, 1e-4))
    points = np.array([[0.3, 0.4, 0.201], [0.3, 0.4, 0.202]])
    two = PointCloud(points, cloud.normals, *(np.float32([a, b]) for a, b in (
        (10, 40), (1, 0.6), (1e-4, 2e-4), (1e-4, 4e-4))),
        np.int32([7, 9]), np.int32([1, 2]), np.uint8([0, 1]), np.uint8([1, 0]))  # fmt: skip
    thin = thin_cloud(two, 1.0)
    # Weights are 4 to 1.
    np.testing.assert_allclose(thin.points, [[0.3, 0.4, 0.2012]], rtol=1e-9)
    np.testing.assert_allclose(thin.sigma, 1e-4 / np.sqrt(1.25), rtol=1e-6)
    np.testing.assert_allclose(
        [thin.signal[0], thin.posterior[0], thin.sigma_common[0]], [16, 0.92, 1.6e-4], rtol=1e-6
    )
    best = (thin.frame[0], thin.scan_line[0], thin.laser[0], thin.branch[0])
    assert best == (7, 1, 0, 1)


def test_points_without_sigma_have_plain_means_and_none_after():
    cloud = some_cloud(1000, sigma=(0, 0))
    thin = thin_cloud(cloud, 1.0)
    assert not thin.sigma.any()
    total = np.zeros(3)
    # The wall of 0.4 m falls into at most eight cubes around the origin.
    assert len(thin) <= 8
    for one in thin.points:
        assert np.isfinite(one).all()
        total += one
    assert total[2] / len(thin) == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize("block", [40, 999, 5000])
@pytest.mark.parametrize("voxel", [0.003, 0.05])
def test_it_does_not_matter_in_what_blocks_a_cloud_comes(block, voxel):
    cloud = some_cloud(3000)
    blocks = [cloud[start : start + block] for start in range(0, len(cloud), block)]
    joined = PointCloud.concatenate(list(thin_clouds(blocks, voxel)))
    same(joined, thin_cloud(cloud, voxel))


def test_more_voxels_than_fit_are_thinned_in_shares():
    cloud = some_cloud(20_000)
    voxels = len(thin_cloud(cloud, 0.005))
    sums = [thinning.VoxelSums(number, 4) for number in range(4)]
    for one in sums:
        one.add(cloud, 0.005)
    assert sum(len(one.merged()) for one in sums) == voxels
    # A limit far below that makes halves of halves.
    blocks = [cloud[start : start + 1000] for start in range(0, 20_000, 1000)]
    same(
        PointCloud.concatenate(list(thin_clouds(blocks, 0.005, most=500))), thin_cloud(cloud, 0.005)
    )


def test_a_cloud_on_a_map_is_thinned_as_at_the_origin():
    """Eastings and northings are millions of metres: cubes are counted from the first point."""
    cloud = some_cloud(3000)
    away = np.array([500_000.0, 4_000_000.0, 0.0])
    there = thin_cloud(dataclasses.replace(cloud, points=cloud.points + away), 0.002)
    here = thin_cloud(cloud, 0.002)
    # At 4e6 m double precision has steps of 5e-10 m; sums of weights of 1e8 keep as many digits.
    np.testing.assert_allclose(there.points - away, here.points, rtol=0, atol=5e-9)


def test_an_empty_cloud_stays_empty():
    assert len(thin_cloud(some_cloud()[:0], 0.01)) == 0


@pytest.mark.parametrize("voxel", [0.0, -1.0, float("nan"), 1e-9])
def test_a_voxel_without_sense_is_refused(voxel):
    with pytest.raises(InputError, match="voxel"):
        thin_cloud(some_cloud(10), voxel)
