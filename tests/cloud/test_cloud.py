"""Normals against the true surface, outliers against the spikes that were put in."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.cloud import merge_profiles, remove_outliers
from murkscan.errors import InputError
from murkscan.types.trajectory import Trajectory

from ..scans import as_profile, cylinder, holed, plane, scan, scan_cloud, sphere, step

SURFACES = [plane, sphere, cylinder, step, holed]


def true_normals(surface, points):
    h = 1e-6
    x, y = points[:, 0], points[:, 1]
    dx = (surface(x + h, y) - surface(x - h, y)) / (2 * h)
    dy = (surface(x, y + h) - surface(x, y - h)) / (2 * h)
    normals = np.stack([dx, dy, -np.ones_like(dx)], axis=1)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def degrees_off(surface, cloud, *, steepest=70):
    """Angle to the true normal, where the surface is not steeper than the grid can follow."""
    truth = true_normals(surface, cloud.points)
    judged = -truth[:, 2] > np.cos(np.radians(steepest))
    cosine = np.einsum("ij,ij->i", truth, cloud.normals)[judged]
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def test_points_are_carried_to_the_world_in_their_order():
    profile, trajectory = scan(plane)
    cloud = merge_profiles(profile, trajectory, axes=("x",))
    np.testing.assert_allclose(cloud.points, trajectory.transform(profile.points, profile.time))
    np.testing.assert_array_equal(cloud.frame, profile.frame)
    np.testing.assert_array_equal(cloud.scan_line, profile.pixels[:, 1])


@pytest.mark.parametrize("interlaced", [False, True])
@pytest.mark.parametrize(("surface", "tolerance"), [(plane, 0.02), (sphere, 1.1), (cylinder, 1.0)])
def test_normals_of_a_clean_scan_are_the_surfaces(surface, tolerance, interlaced):
    # Where a surface of radius R is slanted by t, steps s = p / cos t to the two neighbours differ
    # and tilt the secant by s² tan t / 2 R²: at 50 degrees and p = 1.2 mm (two image rows) by 0.08
    # degrees; seen from the sheet, which leans by 22 degrees, a slope is up to 72 and that 0.9. In
    # fields the neighbours across lie half a scan line aside, 0.6 mm / cos t on a radius of 50 mm:
    # 1.07 degrees. A plane has rounding only (2e-7 of single precision, through arccos). Profiles
    # at either end have one neighbour.
    cloud = scan_cloud(surface, interlaced=interlaced)
    inner = cloud[(cloud.frame > cloud.frame.min()) & (cloud.frame < cloud.frame.max())]
    assert np.percentile(degrees_off(surface, inner, steepest=50), 99) < tolerance


@pytest.mark.parametrize("spacing", [1e-3, 1e-2])
def test_noise_tilts_normals_no_more_than_the_fit_allows(spacing):
    # Each tangent is fitted over enough points for 0.05 rad = 2.9 degrees, so the two of them give
    # a median of 1.18 · 2.9 = 3.4 degrees; neighbours of one profile alone would give junk.
    cloud = scan_cloud(plane, noise=2e-4, spacing=spacing)
    assert np.median(degrees_off(plane, cloud)) < 3.4


def test_normals_of_interlaced_rows_are_no_worse_for_alternating():
    cloud = scan_cloud(plane, noise=2e-4, interlaced=True)
    assert np.median(degrees_off(plane, cloud)) < 3.5


def test_normals_do_not_lean_over_a_depth_jump():
    assert degrees_off(step, scan_cloud(step)).max() < 0.1


def test_normals_face_a_camera_on_either_side():
    profile, trajectory = scan(plane)
    turned = Trajectory(
        trajectory.times, trajectory.positions, np.tile([0.0, 0.0, 1.0, 0.0], (2, 1))
    )
    cloud = merge_profiles(profile, turned, axes=("x",))
    cameras = turned.transform(np.zeros_like(profile.points), profile.time)
    towards = np.einsum("ij,ij->i", cloud.normals, cameras - cloud.points)
    assert (towards > 0).all()


def test_a_stripe_along_rows_has_image_columns_for_scan_lines():
    profile, trajectory = scan(plane)
    turned = replace(profile, pixels=profile.pixels[:, ::-1].copy())
    np.testing.assert_array_equal(
        merge_profiles(turned, trajectory, axes=("y",)).normals,
        merge_profiles(profile, trajectory, axes=("x",)).normals,
    )


def test_a_profile_alone_has_no_normals_but_stays():
    profile, trajectory = scan(plane)
    cloud = merge_profiles(profile[profile.frame == 3], trajectory, axes=("x",))
    assert len(cloud) == 200
    assert not cloud.normals.any()
    assert len(remove_outliers(cloud)) == 200


def test_nothing_merges_to_nothing():
    profile, trajectory = scan(plane)
    cloud = merge_profiles(profile[:0], trajectory, axes=("x",))
    assert len(remove_outliers(cloud)) == 0


def test_points_that_are_not_finite_are_refused():
    profile, trajectory = scan(plane)
    profile.points[5] = np.nan
    with pytest.raises(InputError, match="1 of 24000 points are not finite"):
        merge_profiles(profile, trajectory, axes=("x",))


def test_two_lasers_do_not_mix():
    profile, trajectory = scan(plane)
    behind = replace(profile, points=profile.points * 1.1, laser=profile.laser + np.uint8(1))
    parts = [merge_profiles(p, trajectory, axes=("x", "x")) for p in (profile, behind)]
    both = type(profile).concatenate([profile, behind])
    merged = merge_profiles(both, trajectory, axes=("x", "x"))
    np.testing.assert_array_equal(merged.normals[: len(profile)], parts[0].normals, strict=True)


@pytest.mark.parametrize("noise", [0.0, 2e-4])
@pytest.mark.parametrize("interlaced", [False, True])
@pytest.mark.parametrize("surface", SURFACES)
def test_outliers_leave_a_clean_scan_alone(surface, interlaced, noise):
    cloud = scan_cloud(surface, interlaced=interlaced, noise=noise)
    assert len(remove_outliers(cloud)) > 0.999 * len(cloud)


@pytest.mark.parametrize("noise", [0.0, 2e-4])
@pytest.mark.parametrize("surface", SURFACES)
def test_outliers_are_found_and_true_points_kept(surface, noise):
    # 200 scans' worth of spikes in one: 1 % of the points, 10 to 100 mm off along the ray, in front
    # and behind. Below that a spike of the wall's rim can lie on the slope it would have there.
    profile, trajectory = scan(surface, noise=noise)
    random = np.random.default_rng(1)
    spikes = random.random(len(profile)) < 0.01
    shift = random.uniform(0.01, 0.1, len(profile)) * random.choice([-1, 1], len(profile))
    ranges = np.linalg.norm(profile.points, axis=1)
    profile.points[spikes] *= (1 + shift / ranges)[spikes, None]
    cloud = merge_profiles(profile, trajectory, axes=("x",))
    kept = np.isin(cloud.points[:, 2], remove_outliers(cloud).points[:, 2])
    assert np.mean(kept[spikes]) < 0.1
    assert np.mean(kept[~spikes]) > 0.999


def test_points_far_from_all_others_are_outliers():
    points = np.array([[0.0, y, 0.5] for y in np.arange(100) * 3e-4])
    points[50] = [0.0, 0.015, 0.3]
    profile = as_profile(points, np.zeros(100, int), np.arange(100))
    still = Trajectory(np.zeros(1), np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0, 0.0]]))
    kept = remove_outliers(merge_profiles(profile, still, axes=("x",)))
    assert len(kept) == 99
    assert 50 not in kept.scan_line
