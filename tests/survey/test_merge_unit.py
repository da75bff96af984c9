"""Clouds of other programs in their own unit."""

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.project import Project

from ..scans import plane, scan_cloud


@pytest.fixture
def theirs(tmp_path):
    """Give the points of a plane [m], as files in millimetres."""
    points = scan_cloud(plane, spacing=8e-3).points
    for number in (0, 1):
        np.savetxt(tmp_path / f"{number}.xyz", 1e3 * points, "%.6f")
    return points, [str(tmp_path / f"{number}.xyz") for number in (0, 1)]


def test_a_cloud_in_millimetres_becomes_metres(theirs, tmp_path):
    points, (first, _) = theirs
    assert run(["merge", first, "--unit", "mm", "--out", str(tmp_path / "one")]) == 0
    np.testing.assert_allclose(Project(tmp_path / "one").load_cloud().points, points, atol=1e-8)


def test_a_merged_folder_knows_the_unit_of_its_passes(theirs, tmp_path):
    points, files = theirs
    both, again = str(tmp_path / "both"), str(tmp_path / "again")
    assert run(["merge", *files, "--unit", "mm", "--as-logged", "--out", both]) == 0
    assert [one.scale for one in Project(tmp_path / "both").load_scan().passes] == [1e-3, 1e-3]
    assert run(["merge", both, "--as-logged", "--out", again]) == 0
    cloud = Project(tmp_path / "again").load_cloud()
    np.testing.assert_allclose(np.ptp(cloud.points, axis=0), np.ptp(points, axis=0), atol=1e-8)


def test_another_unit_is_another_merge(theirs, tmp_path):
    points, (first, _) = theirs
    out = str(tmp_path / "out")
    assert run(["merge", first, "--unit", "mm", "--out", out]) == 0
    assert run(["merge", first, "--unit", "cm", "--out", out]) == 0
    found = Project(tmp_path / "out").load_cloud().points
    np.testing.assert_allclose(found, 10 * points, atol=1e-7)
