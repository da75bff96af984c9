"""Merged scans are adjusted together, each along its whole way, where their logs state how good."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.io.rig_toml import as_tables
from murkscan.optics.view import project as to_pixels
from murkscan.project import (
    CLOUD,
    EXTRACT,
    MOTION,
    TRIANGULATE,
    ExtractResult,
    MotionResult,
    PartNote,
    Project,
    TriangulateResult,
)
from murkscan.survey.cloud import build_cloud
from murkscan.survey.merge import merge_passes
from murkscan.survey.sample import load_sample
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.stripe import Stripe

from ..motion.adjust.test_adjust import SPEED, swing
from ..motion.test_together import RATE, passes, sheet
from ..projects import SCAN, finish

# Scan lines lie 1.9 and 2.1 mm apart at 0.6 m: about a pixel.
RIG = Rig(
    Camera((240, 180), (318.0, 318.0), (119.5, 89.5)),
    (Laser.from_baseline_angle(0.2, np.arctan(3.0), "x"),),
    covariance=RigCovariance(
        ("laser[0].normal[0]", "camera.focal_length[1]"), np.diag([1e-6, 1.0])
    ),
)


def as_scan(root, one, *, is_stated=True):
    """Make the folder of a scan of what a pass saw."""
    (profile,), way = one.profiles, one.trajectory
    profile = replace(profile, pixels=to_pixels(RIG.camera, profile.points))
    frames = tuple(np.unique(profile.frame).tolist())
    project, note = Project(root), PartNote(frames, tuple(way.times.tolist()), (), ())
    project.save_scan(replace(SCAN, rig=as_tables(RIG)))
    extract = finish(
        project, EXTRACT, ExtractResult((0,), len(frames), 0, 0, len(profile)),
        make=lambda: project.save_stripe_part(0, Stripe.empty(), note),
    )  # fmt: skip
    inputs, result = {"extract": extract.digest}, TriangulateResult(len(profile), dropped=0)
    finish(
        project, TRIANGULATE, result, inputs=inputs,
        make=lambda: project.save_profile_part(0, profile),
    )  # fmt: skip

    def follow():
        project.save_trajectory(way)
        if is_stated:
            project.save_measured(one.measured)

    finish(project, MOTION, MotionResult(len(frames)), inputs=inputs, make=follow)
    build_cloud(project, RIG, rules=(), frames=False)
    return root


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    folder = tmp_path_factory.mktemp("scans")
    return [
        as_scan(folder / name, one) for name, one in zip(("first", "second"), passes(), strict=True)
    ]


@pytest.fixture(scope="module")
def merged(scans):
    out = scans[0].parent / "hull"
    return Project(out), merge_passes(scans, out)


def ahead_of_truth(cloud, told):
    """Give how far points of the second pass lie ahead of where they are [m], but at its ends."""
    second = cloud.frame >= told.frames[0]
    times = (cloud.frame[second] - told.frames[0] + told.first_frame) / RATE
    off = cloud.points[second, 0] - sheet(cloud.points[second, 2]) - SPEED * times - swing(times)
    inner = (times > 0.4) & (times < times.max() - 0.4)
    return off[inner]


def test_points_follow_the_corrected_way(merged):
    project, result = merged
    assert result.is_joint
    assert result.passes[1].corrected > 2e-3
    cloud = project.load_cloud()
    assert np.std(ahead_of_truth(cloud, result.passes[1])) < 0.3e-3
    # Each point lies where the written poses have what its camera saw.
    way = project.load_trajectory()
    seen = way.to_camera(cloud.points, cloud.frame.astype(float))
    assert np.abs(seen[:, 0] - sheet(seen[:, 2])).max() < 1e-9
    np.testing.assert_allclose(np.linalg.norm(cloud.normals, axis=1), 1, atol=1e-5)


def test_each_point_states_the_errors_of_all_ways(merged):
    project, _ = merged
    sample = load_sample(project)
    some = np.arange(0, len(sample), 97)
    shifts = sample.shifts(some)
    largest = np.linalg.eigvalsh(shifts @ shifts.transpose(0, 2, 1))[:, -1]
    np.testing.assert_allclose(sample.cloud.sigma_common[some], np.sqrt(largest), rtol=1e-3)
    # Behind the two errors of the rig come those of all ways, each of which moves both passes; how
    # they were laid on one another is in them.
    way, times = project.load_trajectory(), sample.cloud.frame[some].astype(float)
    by_ways = way.shifts(sample.cloud.points[some], times)
    assert by_ways.shape[2] == 64
    np.testing.assert_allclose(shifts[:, :, 2:66], by_ways, atol=1e-12)
    np.testing.assert_array_equal(shifts[:, :, 66:], 0)
    assert np.median(np.linalg.norm(shifts[:, 2, :2], axis=1)) > 1e-4


def test_a_repeated_merge_is_skipped_and_one_that_was_killed_goes_on(merged, scans):
    project, result = merged
    made = (project.root / "cloud" / "cloud.ply").stat().st_mtime_ns
    way = (project.root / "motion" / "trajectory.csv").read_bytes()
    for file in (project.root / "motion").iterdir():
        file.unlink()
    assert merge_passes(scans, project.root).passes == result.passes
    assert (project.root / "cloud" / "cloud.ply").stat().st_mtime_ns == made
    assert (project.root / "motion" / "trajectory.csv").read_bytes() == way


def test_rigid_bodies_are_not_bent(scans, tmp_path, capsys):
    assert run(["merge", *map(str, scans), "--out", str(tmp_path / "out"), "--rigid"]) == 0
    said = capsys.readouterr().out
    assert "corrected along its way" not in said
    result = Project(tmp_path / "out").finished(CLOUD).result
    assert not result.is_joint
    assert not result.remarks
    assert np.std(ahead_of_truth(Project(tmp_path / "out").load_cloud(), result.passes[1])) > 2e-3


def test_the_command_says_how_far_and_how_sure(scans, merged, capsys):
    project, _ = merged
    assert run(["merge", *map(str, scans), "--out", str(project.root)]) == 0
    said = capsys.readouterr().out
    assert "corrected along its way from what the passes saw of the same places, by" in said
    assert "length of the way" in said


def test_a_log_that_states_nothing_is_never_bent(scans, tmp_path):
    bare = as_scan(tmp_path / "bare", passes()[1], is_stated=False)
    result = merge_passes([scans[0], bare], tmp_path / "out")
    assert not result.is_joint
    assert result.remarks == (
        "the passes were moved as rigid bodies, not along their ways: nothing is stated of how "
        f"good the log of {bare} is, and such a log is never bent. Say in [navigation] of its rig "
        "file how good the instruments are, and run `murkscan scan` again",
    )
    rigid = merge_passes([scans[0], bare], tmp_path / "rigid", adjust=False)
    clouds = [Project(tmp_path / name).load_cloud().points for name in ("out", "rigid")]
    np.testing.assert_array_equal(*clouds)
    assert rigid.passes == result.passes
