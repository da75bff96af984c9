"""Which centre of which stripe a point of the cloud is, told part by part."""

from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

from murkscan.io.ply import load_cloud
from murkscan.project import Project
from murkscan.survey.cloud import build_cloud
from murkscan.types.profile import Profile

from ..projects import scanned
from ..scans import plane, scan
from ..scenes import air_rig

KEY = ("laser", "frame", "scan_line", "branch")


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """A wall with unsure points and two branches on its scan lines, in three parts."""
    profile, trajectory = scan(plane, spacing=2e-3, num_rows=60)
    below = replace(profile, branch=profile.branch + np.uint8(1), points=profile.points * 1.04)
    both = Profile.concatenate([profile, below])
    both = both[np.argsort(both.frame, kind="stable")]
    unsure = np.random.default_rng(0).random(len(both)) < 0.05
    unsure |= both.frame == 31  # of one frame nothing is left
    both = replace(both, posterior=np.where(unsure, 0.2, 0.9).astype(np.float32))
    project = scanned(tmp_path_factory.mktemp("built"), both, trajectory, parts=3)
    return project, both, unsure, build_cloud(project, air_rig(axis="x"))


def test_a_point_keeps_its_laser_frame_scan_line_and_branch(built):
    project = built[0]
    cloud, kept = project.load_cloud(), Profile.concatenate(list(project.load_kept_parts()))
    np.testing.assert_array_equal(cloud.frame, kept.frame)
    np.testing.assert_array_equal(cloud.branch, kept.branch)
    np.testing.assert_array_equal(cloud.scan_line, kept.pixels[:, 1])
    there = project.load_trajectory().transform(kept.points, kept.time)
    np.testing.assert_allclose(cloud.points, there, atol=1e-12)
    keys = np.stack([getattr(cloud, name) for name in KEY], axis=1)
    assert len(np.unique(keys, axis=0)) == len(cloud)


def test_what_was_taken_out_and_why_stands_in_the_parts(built):
    project, profile, unsure, result = built
    parts = [project.load_cloud_part(number) for number in project.find_cloud_parts()]
    assert sum(len(part.cloud) for part in parts) == len(profile)
    for cause, count in result.outliers_by.items():
        assert sum(part.count(cause) for part in parts) == count
    assert result.outliers_by["posterior"] == unsure.sum()
    table = pq.read_table(project.root / "cloud/points/000000.parquet")
    assert table.column_names[:4] == ["laser", "frame", "line", "branch"]
    words = set(table["taken_out"].to_pylist())
    assert {"", "posterior"} <= words <= {"", "posterior", "density", "visibility"}


def test_the_ply_file_is_written_from_the_parts(built):
    ply, cloud = load_cloud(built[0].root / "cloud/cloud.ply"), built[0].load_cloud()
    for name in cloud.__dataclass_fields__:
        np.testing.assert_array_equal(getattr(ply, name), getattr(cloud, name), strict=True)


def test_a_lost_part_of_the_cloud_is_made_again(built):
    folder = built[0].root / "cloud/points"
    before = (folder / "000001.parquet").read_bytes()
    (folder / "000001.parquet").unlink()
    build_cloud(Project(built[0].root), air_rig(axis="x"))
    assert (folder / "000001.parquet").read_bytes() == before
