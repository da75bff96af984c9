"""Balls of known size, how much of them is seen, their distance, and errors of form."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter

from murkscan.errors import NotEnoughData
from murkscan.measure import Sample, find_ball, measure_form, measure_spacing
from murkscan.types.cloud import PointCloud

from .. import scans

RADIUS, APART, NOISE = 0.05, 0.3, 1e-4
NEAR = np.array([0.0, 0.0, 0.455])


def bar(*, seed: int = 0, noise: float = NOISE, within: float = 1.0) -> PointCloud:
    """Two balls in the scan, of which points beyond an angle's sine from the top are missing."""
    random = np.random.default_rng(seed)
    clouds = []
    for number in range(2):
        cloud = BALL[np.hypot(*BALL.points[:, :2].T) < within * RADIUS]
        out = (cloud.points - [0.0, 0.0, 0.5]) / RADIUS
        off = noise * random.standard_normal((len(cloud), 1))
        moved = cloud.points + off * out + [number * APART, 0.0, 0.0]
        clouds.append(
            replace(
                cloud,
                points=moved,
                normals=out.astype(np.float32),
                frame=cloud.frame + np.int32(5000 * number),
            )
        )
    return PointCloud.concatenate(clouds)


BALL = scans.scan_cloud(scans.sphere, spacing=4e-3)[::3]


def test_a_ball_is_found_from_any_place_on_it_whatever_stands_around():
    cloud = bar()
    sample = Sample.from_cloud(cloud)
    for near in (NEAR, NEAR + np.array([0.03, -0.02, 0.02]), NEAR + np.array([0.0, 0.0, 0.045])):
        found = find_ball(sample, near, RADIUS)
        assert found.fit.shape.centre == pytest.approx([0.0, 0.0, 0.5], abs=1e-4)
        assert abs(found.diameter.value - 2 * RADIUS) < 2 * found.diameter.half_width


def test_the_share_that_is_seen_is_that_of_the_cap():
    # A cap whose rim lies at the sine s of its angle is (1 - cos) / 2 of the ball.
    found = find_ball(Sample.from_cloud(bar(within=0.75)), NEAR, RADIUS)
    assert found.seen == pytest.approx((1 - np.sqrt(1 - 0.75**2)) / 2, abs=0.03)


def test_a_ball_seen_over_less_than_a_tenth_is_refused():
    with pytest.raises(NotEnoughData, match=r"shows [67]% of its surface"):
        find_ball(Sample.from_cloud(bar(within=0.5)), NEAR, RADIUS)


def test_a_missing_ball_and_one_of_another_size_are_refused_with_what_to_do():
    sample = Sample.from_cloud(bar())
    with pytest.raises(NotEnoughData, match=r"no ball of 100 mm lies near 9,9,9 m.*near_m"):
        find_ball(sample, np.array([9.0, 9.0, 9.0]), RADIUS)
    wall = Sample.from_cloud(scans.scan_cloud(scans.plane, spacing=4e-3))
    with pytest.raises(NotEnoughData, match=r"no ball of 100 mm lies near"):
        find_ball(wall, NEAR, RADIUS)
    with pytest.raises(NotEnoughData, match=r"has a diameter of 100\.0 mm and not of 140 mm"):
        find_ball(sample, NEAR, 0.07)


def test_the_spacing_scatters_as_stated():
    found = []
    for seed in range(20):
        sample = Sample.from_cloud(bar(seed=seed))
        balls = [find_ball(sample, NEAR + np.array([x, 0.0, 0.0]), RADIUS) for x in (0.0, APART)]
        found.append(measure_spacing(*balls))
    scatter = np.std([one.value for one in found])
    stated = np.mean([one.sigma_independent for one in found])
    # 20 trials know a deviation to a sixth.
    assert scatter == pytest.approx(stated, rel=0.45)
    assert np.mean([one.value for one in found]) == pytest.approx(APART, abs=3 * stated / 4)


def test_errors_of_the_rig_that_shift_both_balls_do_not_change_their_spacing():
    cloud = bar()
    stretch = np.array([0.01, 0.0, 0.0])

    def shifts(some):
        both = np.tile([0.0, 1e-3, 1e-3], (len(some), 1))
        return np.stack([both, cloud.points[some] * stretch], axis=2)

    sample = Sample.from_cloud(cloud, shifts=shifts)
    balls = [find_ball(sample, NEAR + np.array([x, 0.0, 0.0]), RADIUS) for x in (0.0, APART)]
    assert measure_spacing(*balls).sigma_common == pytest.approx(0.01 * APART, rel=1e-3)


def errors_of(seed: int, blur: tuple[float, float]) -> np.ndarray:
    """Give noise that neighbours share, and now and then a particle that lifts the stripe."""
    random = np.random.default_rng(seed)
    errors = random.standard_normal((80, 200))
    errors = gaussian_filter(errors, blur) if any(blur) else errors
    errors /= errors.std()
    for row, column in zip(*random.integers(10, 60, (2, random.poisson(1.0))), strict=True):
        errors[row : row + 3, column : column + 9] += random.exponential(3.0)
    return errors[10:-10, 25:-25]


@pytest.mark.parametrize("blur", [(0.0, 0.0), (1.0, 3.0)])
def test_the_form_that_ever_more_points_come_to_lies_within_its_interval(blur):
    fields = [errors_of(seed, blur).ravel() for seed in range(60)]
    low, high = np.quantile(np.concatenate(fields), [0.0015, 0.9985])
    profile, line = np.divmod(np.arange(60 * 150), 150)
    found = [measure_form("form", field, profile, line) for field in fields]
    errors = np.array([one.value for one in found]) - (high - low)
    held = np.mean([abs(e) <= one.half_width for e, one in zip(errors, found, strict=True)])
    assert held >= 0.88
    # Half of what is stated would hold too few, twice as much is too wide.
    ratio = np.median([one.half_width for one in found]) / (1.96 * errors.std())
    assert 0.6 < ratio < 1.7


def test_a_form_of_few_points_is_refused():
    with pytest.raises(NotEnoughData, match="shows 666 points"):
        measure_form("form", np.ones(666), np.arange(666), np.arange(666))
