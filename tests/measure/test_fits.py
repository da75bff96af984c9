"""Fitted shapes, and how far to trust them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import Degenerate, InputError, NotEnoughData
from murkscan.geometry.correlated_errors import covariance_of_fit
from murkscan.geometry.cylinder_fit import fit_cylinder
from murkscan.geometry.sphere_fit import fit_sphere
from murkscan.measure import (
    Sample,
    measure_cylinder,
    measure_plane,
    measure_sphere,
    measure_step,
)
from murkscan.types.cloud import PointCloud
from murkscan.types.plane import span_plane

from .. import scans

pytestmark = pytest.mark.without_types


def sample_of(surface, *, within: float | None = None, **settings) -> Sample:
    cloud = scans.scan_cloud(surface, **settings)
    sample = Sample.from_cloud(cloud)
    if within is None:
        return sample
    return sample[np.abs(cloud.points[:, 2] - 0.47) < within]


def scatter_sphere(random, *, sigma: float, count: int = 500) -> np.ndarray:
    """Give points of a cap of a sphere of 0.1 m, with noise."""
    towards = random.normal(size=(count, 3)) + np.array([0.0, 0.0, -3.0])
    towards /= np.linalg.norm(towards, axis=1)[:, None]
    return towards * (0.1 + sigma * random.standard_normal(count))[:, None] + [1.0, 2.0, 3.0]


def test_a_sphere_without_noise_is_found_to_rounding():
    fit = fit_sphere(scatter_sphere(np.random.default_rng(0), sigma=0.0))
    assert fit.shape.radius == pytest.approx(0.1, abs=1e-9)
    assert fit.shape.centre == pytest.approx([1.0, 2.0, 3.0], abs=1e-9)


def test_a_third_of_wrong_points_does_not_move_a_sphere():
    random = np.random.default_rng(1)
    points = scatter_sphere(random, sigma=1e-4)
    points[:150, 2] -= random.uniform(0.03, 0.1, 150)  # out of the cap, towards the viewer
    fit = fit_sphere(points)
    # 350 points of 0.1 mm on a cap tell the radius to about 0.02 mm.
    assert fit.shape.radius == pytest.approx(0.1, abs=1e-4)
    assert not fit.inliers[:150].any()


def test_a_cylinder_without_noise_is_found_to_rounding():
    random = np.random.default_rng(2)
    angle, along = random.uniform(-1, 1, 300), random.uniform(-0.1, 0.1, 300)
    out = np.stack([np.sin(angle), np.zeros(300), -np.cos(angle)], axis=1)
    points = 0.04 * out + along[:, None] * [0.0, 1.0, 0.0] + [0.5, 0.2, 0.9]
    fit = fit_cylinder(points, out)
    assert fit.shape.radius == pytest.approx(0.04, abs=1e-9)
    assert abs(fit.shape.axis[1]) == pytest.approx(1.0, abs=1e-12)
    assert fit.shape.distance_to(points) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("kind", ["plane", "sphere", "cylinder"])
def test_slopes_are_the_derivatives_of_the_distance(kind):
    from murkscan.types.cylinder import Cylinder
    from murkscan.types.plane import Plane
    from murkscan.types.sphere import Sphere

    axis = np.array([0.6, 0.0, 0.8])
    shape = {
        "plane": Plane(axis, 0.1),
        "sphere": Sphere(np.array([0.1, 0.2, 0.3]), 0.2),
        "cylinder": Cylinder(np.array([0.1, 0.2, 0.3]), axis, 0.2),
    }[kind]
    points = np.random.default_rng(3).normal(size=(20, 3))
    slopes = shape.slopes(points)
    for number in range(slopes.shape[1]):
        step = np.zeros(slopes.shape[1])
        step[number] = 1e-6
        change = shape.moved(step).distance_to(points) - shape.moved(-step).distance_to(points)
        # Central differences at 1e-6 are exact to about 1e-9 here.
        assert change / 2e-6 == pytest.approx(slopes[:, number], abs=1e-7)


def test_the_interval_of_independent_errors_is_that_of_least_squares():
    random = np.random.default_rng(4)
    profile, line = np.divmod(np.arange(1600), 40)
    slopes = np.stack([np.ones(1600), profile - 19.5, line - 19.5], axis=1)
    sigma = np.array(
        [
            np.sqrt(np.diag(covariance_of_fit(slopes, noise, profile, line).matrix))
            for noise in random.standard_normal((30, 1600))
        ]
    )
    expected = np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)))
    # The mean of 30 estimates, each uncertain by some 15 %, and the window's known bias downwards.
    assert sigma.mean(axis=0) == pytest.approx(expected, rel=0.12)


def test_errors_that_go_together_widen_the_interval_as_they_should():
    """Errors equal in patches of 5 by 4 points leave 100 independent ones of 2000."""
    random = np.random.default_rng(5)
    profile, line = np.divmod(np.arange(2000), 50)
    patch = (profile // 4) * 10 + line // 5
    slopes = np.ones((2000, 1))
    ratios = []
    for _ in range(40):
        errors = random.standard_normal(100)[patch]
        errors -= errors.mean()
        found = covariance_of_fit(slopes, errors, profile, line)
        ratios.append(math.sqrt(found.matrix[0, 0]) * math.sqrt(100))
    # Weights that fall with distance lose some of the sum; what stands in for Student's t of few
    # patches widens it again. Without heed of neighbours it would be 0.22.
    assert 0.9 < np.mean(ratios) < 1.6


def test_a_scanned_plane_is_measured_within_its_interval():
    found = measure_plane(sample_of(scans.plane, noise=2e-4))
    normal = np.array([0.3, -0.2, -1.0]) / math.sqrt(1.13)
    for name, truth in zip("xyz", normal, strict=True):
        low, high = found[f"normal_{name}"].interval
        slack = 0.5 * (high - low)  # 95 % intervals: three of three may miss by as much again
        assert low - slack < truth < high + slack
    assert found["rms_residual"].value == pytest.approx(2e-4 / math.sqrt(1.13), rel=0.1)


def test_a_scanned_sphere_and_cylinder_are_measured_within_twice_their_interval():
    # The clouds hold nothing but the shape; noise is independent, so that the interval is honest.
    sphere = measure_sphere(sample_of(scans.sphere, noise=1e-4))["radius"]
    cylinder = measure_cylinder(sample_of(scans.cylinder, noise=1e-4))["radius"]
    assert abs(sphere.value - 0.05) < 2 * sphere.half_width
    assert abs(cylinder.value - 0.04) < 2 * cylinder.half_width
    assert sphere.half_width < 1e-4


def test_a_diameter_is_twice_its_radius_with_twice_its_uncertainty():
    found = measure_sphere(sample_of(scans.sphere, noise=1e-4))
    assert found["diameter"].value == 2 * found["radius"].value
    assert found["diameter"].half_width == pytest.approx(2 * found["radius"].half_width)


def test_a_rig_that_is_a_percent_too_long_stretches_the_radius_by_it():
    sample = sample_of(scans.sphere)
    points = sample.cloud.points
    stretched = Sample.from_cloud(sample.cloud, shifts=lambda some: 0.01 * points[some][:, :, None])
    found = measure_sphere(stretched)["radius"]
    assert found.sigma_common == pytest.approx(0.01 * found.value, rel=1e-6)
    assert measure_sphere(sample)["radius"].sigma_common is None


def test_a_plane_asked_for_its_radius_is_refused():
    sample = sample_of(scans.plane)
    with pytest.raises(Degenerate, match="plane"):
        measure_sphere(sample)
    with pytest.raises(Degenerate, match="parallel"):
        measure_cylinder(sample)


def test_too_few_points_and_points_without_a_place_are_refused():
    with pytest.raises(NotEnoughData, match="at least 5 points, got 4"):
        fit_sphere(np.eye(4, 3))
    with pytest.raises(InputError, match="1 of 6 points are not finite"):
        fit_sphere(np.array([[np.nan, 0, 0], *np.random.default_rng(0).normal(size=(5, 3))]))
    with pytest.raises(NotEnoughData, match="no points"):
        Sample.from_cloud(scans.scan_cloud(scans.plane)[:0])


def test_points_of_other_programs_are_numbered_by_place_and_get_normals():
    cloud = scans.scan_cloud(scans.plane, spacing=2e-3, noise=1e-4)
    zero = np.zeros_like(cloud.frame)
    bare = replace(cloud, frame=zero, scan_line=zero, normals=np.zeros_like(cloud.normals))
    known, found = (measure_plane(Sample.from_cloud(c))["distance"] for c in (cloud, bare))
    assert found.value == pytest.approx(known.value)
    # Independent noise: both tell its effect to a part that depends on how they are numbered.
    assert 0.5 < found.half_width / known.half_width < 2


def test_of_a_scan_and_points_of_another_program_only_these_are_numbered_by_place():
    scan = scans.scan_cloud(scans.plane, spacing=2e-3, noise=1e-4)
    other = scans.scan_cloud(scans.plane, spacing=2e-3, noise=1e-4)
    other = replace(
        other,
        frame=np.full_like(other.frame, 2000),
        scan_line=np.zeros_like(other.scan_line),
        normals=np.zeros_like(other.normals),
    )
    both = Sample.from_cloud(PointCloud.concatenate([scan, other]))
    alone, count = Sample.from_cloud(scan), len(scan)
    np.testing.assert_array_equal(both.profile[:count], alone.profile)
    np.testing.assert_array_equal(both.line[:count], alone.line)
    np.testing.assert_array_equal(both.cloud.normals[:count], scan.normals)
    # A square holds about one point, and no square a neighbour of the scan's profiles.
    cells = np.unique(np.stack([both.profile[count:], both.line[count:]]), axis=1)
    assert cells.shape[1] > 0.3 * count
    assert both.profile[count:].min() >= alone.profile.max() + 1000
    # The wall is flat, and the camera before it: a plane through 30 points good to 0.05 rad.
    truth = np.array([0.3, -0.2, -1.0]) / np.linalg.norm([0.3, -0.2, -1.0])
    assert np.median(both.cloud.normals[count:] @ truth) > np.cos(0.05)
    assert (both.cloud.normals[count:] @ truth).min() > 0.5


@pytest.mark.parametrize("profiles", [1, 2])
@pytest.mark.parametrize("measure", [measure_plane, measure_sphere, measure_cylinder])
def test_the_laser_s_own_sheet_is_no_shape(measure, profiles):
    whole = sample_of(scans.sphere, noise=1e-4)
    middle = int(np.median(whole.profile))
    part = whole[(whole.profile >= middle) & (whole.profile < middle + profiles)]
    with pytest.raises(NotEnoughData, match=f"in {profiles} profile"):
        measure(part)


def test_a_step_to_a_single_profile_is_none():
    whole = sample_of(scans.step, noise=1e-4)
    y = whole.cloud.points[:, 1]
    low, high = whole[y > 5e-3], whole[y < -5e-3]
    with pytest.raises(NotEnoughData, match="1 profile,"):
        measure_step(low, high[high.profile == int(np.median(high.profile))])


def _crossing(cylinder: dict, name: str, y: float) -> float:
    slope = cylinder[f"axis_{name}"].value / cylinder["axis_y"].value
    return cylinder[name].value + slope * (y - cylinder["y"].value)


def test_where_a_leaning_axis_passes_scatters_as_stated_and_one_coordinate_is_set():
    random = np.random.default_rng(5)
    axis = np.array([0.5, 0.8, 0.1])
    axis /= np.linalg.norm(axis)
    sides = span_plane(axis)
    angle, height = random.uniform(0, np.pi, 600), random.uniform(-0.1, 0.1, 600)
    out = np.cos(angle)[:, None] * sides[0] + np.sin(angle)[:, None] * sides[1]
    clean = 0.05 * out + height[:, None] * axis + [0.2, 0.3, 0.9]
    found = []
    for _ in range(24):
        points = clean + 1e-4 * random.standard_normal((600, 1)) * out
        cloud = scans.scan_cloud(scans.plane)[:600]
        cloud = replace(
            cloud,
            points=points,
            normals=out.astype(np.float32),
            frame=np.arange(600, dtype=np.int32) * 9,
        )
        found.append(
            {one.name: one for one in measure_cylinder(Sample.from_cloud(cloud)).quantities}
        )
    # Each fit sets y to its own points' middle: along the axis from there to y = 0.3.
    crossing = np.array([[_crossing(one, name, 0.3) for name in "xz"] for one in found])
    stated = np.array([[one[name].sigma_independent for name in "xz"] for one in found])
    assert {one["y"].half_width for one in found} == {0.0}
    # 24 trials know a deviation to a seventh.
    np.testing.assert_allclose(crossing.std(axis=0), stated.mean(axis=0), rtol=0.45)
