"""False points by cause, and true ones that look a little like them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.cloud import (
    OUTLIER_RULES,
    Doubtful,
    Outside,
    SeenCloud,
    SeenThrough,
    Sparse,
    find_outliers,
    merge_profiles,
)
from murkscan.errors import InputError
from murkscan.types.profile import Profile

from ..scans import BASELINE, COTANGENT, cylinder, holed, plane, scan, sphere, step

RULES = [
    *OUTLIER_RULES,
    Doubtful(0.9),
    Sparse(max_jump=0.01),
    SeenThrough(0.1),
    Outside((-9.0,) * 3, (9.0,) * 3),
]


def rod(x, y):
    """A rod of 6 mm radius across the travel, 60 mm before a wall: a true thin edge."""
    before = np.maximum(0.006**2 - x * x, 0)
    return np.where(before > 0, 0.44 - np.sqrt(before), 0.5) + 0 * y


def plate(x, y):
    """A wall behind the edge of a thin plate, 40 mm before it."""
    return np.where(x < 0.0, 0.46, 0.5) + 0 * y


def seen(surface, *, add=None, **settings):
    """A scan as the rules get it; `add` may put more into its profiles."""
    profile, trajectory = scan(surface, **settings)
    profile = profile if add is None else add(profile)
    cameras = trajectory.transform(np.zeros_like(profile.points), profile.time)
    return SeenCloud(merge_profiles(profile, trajectory, axes=("x",)), cameras), profile


def with_ghost(scale, frames, lines):
    """Put a second branch at `scale` times the depth into some frames and lines, on the sheet."""

    def add(profile):
        row = profile.pixels[:, 1]
        some = (np.isin(profile.frame, frames)) & (row >= lines[0]) & (row < lines[1])
        ghost = profile[some].points * scale
        ghost[:, 0] = ghost[:, 2] * COTANGENT - BASELINE
        return Profile.concatenate([profile, replace(profile[some], points=ghost)])

    return add


@pytest.mark.parametrize("rule", OUTLIER_RULES, ids=repr)
@pytest.mark.parametrize("surface", [plane, sphere, cylinder, step, holed, rod, plate])
def test_a_clean_scan_stays_as_it_is(rule, surface):
    """Of steps, rims and rods, too: one point in a thousand may go, as for `Sparse` alone."""
    there, _ = seen(surface, noise=2e-4, num_rows=100)
    assert rule.find(there).mean() < 1e-3


@pytest.mark.parametrize("rule", RULES, ids=repr)
def test_nothing_has_no_outliers(rule):
    there, _ = seen(plane)
    none = there[np.zeros(0, np.int64)]
    assert len(rule.find(none)) == 0


@pytest.mark.parametrize("rule", RULES, ids=repr)
def test_one_profile_loses_nothing(rule):
    there, profile = seen(plane)
    assert not rule.find(there[profile.frame == 3]).any()


def test_a_reflection_in_front_of_the_surface_is_found_by_what_is_seen_through_it():
    # 20 profiles, 60 lines, at 0.8 of the depth, where the sheet leans 40 mm aside: rays of the
    # frames 40 profiles on go through.
    there, _ = seen(plane, add=with_ghost(0.8, np.arange(50, 70), (60, 120)))
    false = np.arange(len(there.cloud)) >= len(there.cloud) - 20 * 60
    found = SeenThrough().find(there)
    assert found[false].mean() > 0.9
    assert found[~false].mean() < 1e-3
    # Its points hold together, so they are not sparse.
    assert Sparse().find(there)[false].mean() < 0.1


def test_a_mirror_image_behind_the_surface_is_found_and_the_surface_stays():
    there, _ = seen(plane, add=with_ghost(1.25, np.arange(50, 70), (60, 120)))
    false = np.arange(len(there.cloud)) >= len(there.cloud) - 20 * 60
    found = SeenThrough().find(there)
    assert found[false].mean() > 0.9
    assert found[~false].mean() < 1e-3


@pytest.mark.parametrize("axis", "xyz")
@pytest.mark.parametrize("surface", [step, rod, plate])
def test_a_rig_that_is_a_degree_off_loses_nothing(surface, axis):
    """Rays then pierce the edges of true steps by 0.5 m times a degree, 9 mm."""

    def lean(profile):
        turn = Rotation.from_euler(axis, 1, degrees=True).as_matrix()
        return replace(profile, points=profile.points @ turn.T)

    there, _ = seen(surface, add=lean)
    assert not SeenThrough().find(there).any()


def test_a_second_pass_that_drifted_by_less_than_the_clearance_stays():
    """Both passes see the wall; the log puts one of them 10 mm behind the other."""
    there, _ = seen(plane)
    behind = replace(
        there.cloud,
        points=there.cloud.points + np.array([0, 0, 0.01]),
        frame=there.cloud.frame + np.int32(1000),
    )
    both = SeenCloud(
        type(there.cloud).concatenate([there.cloud, behind]), np.tile(there.cameras, (2, 1))
    )
    assert not SeenThrough().find(both).any()


def test_points_that_their_finder_doubts_go_and_the_rest_is_judged_without_them():
    def doubt(profile):
        random = np.random.default_rng(0)
        unsure = random.random(len(profile)) < 0.1
        return replace(profile, posterior=np.where(unsure, 0.3, 0.9).astype(np.float32))

    there, profile = seen(plane, add=doubt)
    found = find_outliers(there)
    assert list(found) == ["posterior", "density", "visibility"]
    np.testing.assert_array_equal(found["posterior"], profile.posterior < 0.5)
    assert found["density"].sum() + found["visibility"].sum() < 10


def test_a_point_has_one_cause_at_most():
    def spoil(profile):
        random = np.random.default_rng(1)
        unsure, spikes = (random.random(len(profile)) < 0.05 for _ in range(2))
        points = np.where(spikes[:, None], profile.points * 0.9, profile.points)
        posterior = np.where(unsure, 0.1, 1.0).astype(np.float32)
        return replace(profile, points=points, posterior=posterior)

    there, _ = seen(plane, add=spoil)
    causes = np.sum(list(find_outliers(there).values()), axis=0)
    assert causes.max() == 1
    assert causes.sum() > 0.05 * len(causes)


def test_settings_without_sense_are_refused():
    with pytest.raises(InputError, match="min_posterior must lie from 0 to 1, got 2"):
        Doubtful(2.0)
    with pytest.raises(InputError, match="clearance must lie between 0 and 1, got 0"):
        SeenThrough(0.0)


def test_what_lies_outside_of_the_volume_goes_before_anything_else_is_judged():
    everything, _ = seen(plane)
    middle = np.median(everything.cloud.points, axis=0)
    low, high = tuple((middle - 0.02).tolist()), tuple((middle + 0.02).tolist())
    inside = np.all(np.abs(everything.cloud.points - middle) <= 0.02, axis=1)
    found = find_outliers(everything, (Outside(low, high), Sparse()))
    assert 0 < inside.sum() < len(inside)
    np.testing.assert_array_equal(found["volume"], ~inside)
    with pytest.raises(InputError, match="must differ"):
        Outside(low, low)
