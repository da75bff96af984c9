"""Which points of the profiles a cloud has kept, told part by part."""

import numpy as np
import pytest

from murkscan.cloud import merge_profiles
from murkscan.project import CLOUD, TRIANGULATE, CloudResult, Project, TriangulateResult
from murkscan.survey.kept import kept_profiles
from murkscan.types.profile import Profile

from ..projects import finish
from ..scans import plane, scan

PARTS, FRAMES = 3, 20


@pytest.mark.parametrize("block", [70, 10**6])
def test_points_that_the_cloud_left_out_are_gone_and_all_others_are_there(tmp_path, block):
    profile, trajectory = scan(plane, spacing=2e-3, num_rows=40)
    # A second branch on every scan line, of another signal.
    below = Profile(**{**vars(profile), "signal": profile.signal + 7})
    both = Profile.concatenate([profile, below])
    both = both[np.argsort(both.frame, kind="stable")]
    kept = np.random.default_rng(0).random(len(both)) < 0.7
    kept[both.frame == 31] = False  # of one frame nothing is left
    project = Project(tmp_path)

    def save_parts():
        for part in range(PARTS):
            project.save_profile_part(part, both[both.frame // FRAMES == part])

    finish(project, TRIANGULATE, TriangulateResult(len(both), dropped=0), make=save_parts)
    cloud = merge_profiles(both, trajectory, axis="x")[kept]

    def save_blocks():
        with project.writing_cloud() as write:
            for start in range(0, len(cloud), block):
                write(cloud[start : start + block])

    finish(project, CLOUD, CloudResult(len(cloud), outliers=0), make=save_blocks)
    found = Profile.concatenate(list(kept_profiles(project, "x")))
    np.testing.assert_array_equal(found.points, both.points[kept])
    np.testing.assert_array_equal(found.signal, both.signal[kept])
