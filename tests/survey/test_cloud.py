"""Clouds of a project: in blocks, and exported."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.io.cloud_files import load_cloud_file
from murkscan.project import (
    Project,
)
from murkscan.project.blocks import cut_blocks, trim_beside
from murkscan.survey.cloud import build_cloud
from murkscan.survey.export import export_cloud
from murkscan.survey.mesh import export_mesh

from ..projects import as_project, scanned
from ..scans import plane, scan, scan_cloud, waves
from ..scenes import air_rig


@pytest.mark.parametrize("block", [2000, 5000, 23_000])
def test_a_scan_worked_on_in_blocks_is_what_the_whole_is(tmp_path, block):
    profile, trajectory = scan(plane)
    spikes = np.random.default_rng(0).random(len(profile)) < 0.01
    profile.points[spikes] *= 1.1
    rig = air_rig(axis="x")
    whole = scanned(tmp_path / "whole", profile, trajectory, parts=12)
    cut = scanned(tmp_path / "cut", profile, trajectory, parts=12)
    counts = build_cloud(whole, rig)
    assert build_cloud(cut, rig, block=block) == counts
    one, other = whole.load_cloud(), cut.load_cloud()
    np.testing.assert_array_equal(one.points, other.points)
    # Without noise tangents reach as far as the usual spacing says, which is the same everywhere.
    np.testing.assert_allclose(one.normals, other.normals, atol=1e-6)
    for number in (0, 57, 119):
        name = f"cloud/frames/frame_{number:06d}.ply"
        assert (whole.root / name).read_bytes() == (cut.root / name).read_bytes()


def test_outliers_are_counted_for_each_cause(tmp_path):
    profile, trajectory = scan(plane)
    random = np.random.default_rng(0)
    spikes, unsure = random.random((2, len(profile))) < 0.01
    profile.points[spikes] *= 1.1
    profile = replace(profile, posterior=np.where(unsure, 0.2, 0.9).astype(np.float32))
    result = build_cloud(scanned(tmp_path, profile, trajectory, parts=2), air_rig(axis="x"))
    assert result.outliers_by["posterior"] == unsure.sum()
    assert result.outliers_by["density"] == pytest.approx((spikes & ~unsure).sum(), rel=0.1)
    assert sum(result.outliers_by.values()) == result.outliers == len(profile) - result.points


def test_a_scan_without_a_point_is_an_empty_cloud(tmp_path):
    profile, trajectory = scan(plane)
    result = build_cloud(scanned(tmp_path, profile[:0], trajectory, parts=1), air_rig(axis="x"))
    assert (result.points, len(Project(tmp_path).load_cloud())) == (0, 0)


def test_blocks_hold_every_part_once_and_see_what_lies_beside_them():
    sizes = {number: 900 + 10 * number for number in range(0, 240, 2)}
    for size in (1, 5000, 10**6, 10**9):
        blocks = cut_blocks(sizes, block=size)
        assert [number for block in blocks for number in block.parts] == list(sizes)
        for block in blocks:
            joined = [*block.before, *block.parts, *block.after]
            first = list(sizes).index(joined[0])
            assert joined == list(sizes)[first : first + len(joined)]
            assert block.before or block.parts[0] == 0
            assert block.after or block.parts[-1] == 238
    assert len(blocks) == 1
    assert cut_blocks({}) == []


def test_beside_a_block_lie_whole_profiles_and_two_dozen_of_wide_ones():
    for width, profiles in ((500, 39), (2000, 24)):
        cloud = scan_cloud(plane, spacing=0.12 / 40, num_rows=5)[:1]
        wide = cloud[np.zeros(40_000 if width == 500 else 100_000, int)]
        wide = replace(wide, frame=np.arange(len(wide), dtype=np.int32) // width)
        before, after = trim_beside(wide, wide)
        for part, edge in ((before, wide.frame[-1]), (after, 0)):
            frames, sizes = np.unique(part.frame, return_counts=True)
            assert (set(sizes), abs(len(frames) - profiles) <= 1) == ({width}, True)
            assert edge in frames


def test_an_export_holds_the_cloud(project, tmp_path, cloud):
    assert export_cloud(project, tmp_path / "dive.laz") == len(cloud)
    np.testing.assert_allclose(
        load_cloud_file(tmp_path / "dive.laz").points, cloud.points, atol=6e-6
    )


def test_a_thinned_export_is_smaller_and_lies_on_the_same_surface(project, tmp_path, cloud):
    count = export_cloud(project, tmp_path / "dive.ply", voxel=3e-3)
    thin = load_cloud_file(tmp_path / "dive.ply")
    assert count == len(thin) < 0.5 * len(cloud)
    # Waves of 8 mm and 60 rad/m bend by 29 /m: over half of 3 mm's diagonal 0.1 mm at most.
    off = thin.points[:, 2] - waves(thin.points[:, 0], thin.points[:, 1])
    assert np.sqrt(np.mean(off**2)) < 1e-4


def test_exports_without_sense_are_refused_and_write_nothing(project, tmp_path, cloud):
    with pytest.raises(InputError, match="among the files of the cloud stage"):
        export_cloud(project, project.root / "cloud/other.ply")
    with pytest.raises(InputError, match="no suffix of a cloud"):
        export_cloud(project, tmp_path / "dive.txt")
    empty = as_project(tmp_path / "empty", cloud[:0])
    with pytest.raises(InputError, match="no points; there is nothing to export"):
        export_cloud(empty, tmp_path / "dive.ply")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["empty", "scan"]


@pytest.mark.parametrize("stage", ["cloud", "mesh", "measure", "view/deeper"])
def test_no_export_lands_among_what_the_stages_of_any_scan_have_made(
    project, tmp_path, cloud, stage
):
    other = as_project(tmp_path / "other", cloud)
    for root in (project.root, other.root):
        (root / stage).mkdir(parents=True, exist_ok=True)
        for export in (export_cloud, export_mesh):
            with pytest.raises(InputError, match="lies among the files of the"):
                export(project, root / stage / "mesh.ply")
        assert not (root / stage / "mesh.ply").exists()
    assert export_cloud(project, project.root / "dive.ply") == len(cloud)


@pytest.mark.skipif(sys.platform != "linux", reason="resident memory is counted in kB on Linux")
def test_an_export_does_not_hold_the_cloud_in_memory(tmp_path):
    """Three times the points take no more: only what one block takes, half a million points."""
    code = (
        "import sys; from pathlib import Path\n"
        "sys.path.insert(0, sys.argv[2])\n"
        "from murkscan.types.cloud_part import CloudPart\n"
        "from tests.memory import peak_kib\n"
        "from tests.projects import as_project, finish\n"
        "from tests.scans import plane, scan_cloud\n"
        "from murkscan.project import CLOUD, CloudResult\n"
        "from murkscan.survey.export import export_cloud\n"
        "root, cloud = Path(sys.argv[1]), scan_cloud(plane)\n"
        "project = as_project(root / 'scan', cloud)\n"
        "for copies in (22, 66):\n"
        "    def make():\n"
        "        for part in range(copies):\n"
        "            project.save_cloud_part(part, CloudPart.whole(cloud))\n"
        "    finish(project, CLOUD, CloudResult(copies * len(cloud), 0), make=make)\n"
        "    export_cloud(project, root / 'dive.laz')\n"
        "    export_cloud(project, root / 'thin.laz', voxel=0.005)\n"
        "    print(peak_kib())\n"
    )
    command = [sys.executable, "-c", code, str(tmp_path), str(Path(__file__).parents[2])]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    one, three = map(int, said.split())
    # The million points more are 61 MB as rows, 65 MB as a cloud, 140 MB as sums of voxels.
    assert three - one < 50_000
