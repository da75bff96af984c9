"""Clouds of several passes become one."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.errors import Degenerate, FormatError, InputError, MissingResult, NotEnoughData
from murkscan.io.cloud_files import writing_cloud_file
from murkscan.project import (
    CLOUD,
    EXTRACT,
    MOTION,
    ExtractResult,
    MotionResult,
    PartNote,
    Project,
    find_frame_times,
    find_trajectory,
)
from murkscan.project.merged import load_merged_errors
from murkscan.survey.merge import merge_passes
from murkscan.types.pose import Pose
from murkscan.types.stripe import Stripe
from murkscan.types.trajectory import Trajectory

from ..projects import as_project, finish
from ..scans import plane, scan_cloud, waves


def drifted(cloud, *, seed=0):
    """The same wall once more, with a log that is millimetres off."""
    random = np.random.default_rng(seed)
    turn = Rotation.from_rotvec(random.normal(0, 0.003, 3)).as_matrix()
    pose = Pose(turn, random.normal(0, 0.001, 3))
    again = pose @ cloud.points
    return replace(cloud, points=again, normals=(cloud.normals @ turn.T).astype(np.float32)), pose


def test_two_passes_become_one_in_the_frame_of_the_first(project, tmp_path, cloud):
    second, pose = drifted(scan_cloud(waves, noise=1e-4, spacing=1.1e-3))
    as_project(tmp_path / "second", second)
    out = tmp_path / "merged"
    result = merge_passes([project.root, tmp_path / "second"], out)
    merged = Project(out).load_cloud()
    assert len(merged) == result.points == len(cloud) + len(second)
    moved = merged[len(cloud) :]
    # 0.1 mm of noise along the ray; the correction is known to hundredths of a millimetre.
    off = moved.points[:, 2] - waves(moved.points[:, 0], moved.points[:, 1])
    assert np.sqrt(np.mean(off**2)) < 1.2e-4
    found = result.passes[1].alignment
    np.testing.assert_allclose(np.array(found.rotation) @ pose.rotation, np.eye(3), atol=1e-3)
    assert found.open == ()
    # What stage.json says is what was returned, and the frames of the passes do not mix.
    note = json.loads((out / "cloud/stage.json").read_text())
    told = note["result"]["passes"][1]["alignment"]
    assert told["rotation"] == [list(row) for row in found.rotation]
    first, other = (one.frames for one in result.passes)
    assert first[1] + 2 < other[0]
    assert other == (int(moved.frame.min()), int(moved.frame.max()))
    # A point keeps its name: its pass, and in that its frame, scan line and branch.
    told = Project(out).finished(CLOUD).result
    np.testing.assert_array_equal(told.number_passes(moved.frame), 1)
    np.testing.assert_array_equal(moved.frame - other[0] + told.passes[1].first_frame, second.frame)
    np.testing.assert_array_equal(moved.scan_line, second.scan_line)


def test_a_merged_folder_stands_for_its_passes(project, tmp_path, cloud):
    for name, spacing in (("second", 1.1e-3), ("third", 1.2e-3)):
        again = drifted(scan_cloud(waves, noise=1e-4, spacing=spacing))[0]
        as_project(tmp_path / name, again)
    paths = [project.root, tmp_path / "second", tmp_path / "third"]
    merge_passes(paths[:2], tmp_path / "two")
    grown = merge_passes([tmp_path / "two", paths[2]], tmp_path / "grown")
    assert [one.path for one in grown.passes] == [str(path) for path in paths]
    at_once = merge_passes(paths, tmp_path / "three")
    assert grown.passes == at_once.passes


def test_a_merge_is_made_anew_when_a_pass_has_changed_and_not_before(project, tmp_path, cloud):
    as_project(tmp_path / "second", drifted(cloud)[0])
    paths, out = [project.root, tmp_path / "second"], tmp_path / "out"
    merge_passes(paths, out)
    made = (out / "cloud/cloud.ply").stat().st_mtime_ns
    merge_passes(paths, out)
    assert (out / "cloud/cloud.ply").stat().st_mtime_ns == made
    as_project(tmp_path / "second", drifted(cloud, seed=1)[0])
    merge_passes(paths, out)
    assert (out / "cloud/cloud.ply").stat().st_mtime_ns > made
    # Stopped between the record of the passes and their cloud, it is no cloud of theirs.
    record = Project(out).load_scan()
    Project(out).save_scan(replace(record, passes=record.passes[:1]))
    with pytest.raises(MissingResult, match="and not finished"):
        load_merged_errors(Project(out))
    merge_passes(paths, out)
    assert len(load_merged_errors(Project(out)).passes) == 2
    file = out / "cloud/stage.json"
    told = json.loads(file.read_text("utf-8"))
    for damage in (lambda passes: passes.pop(), lambda passes: passes[1]["answers"].pop()):
        spoilt = json.loads(json.dumps(told))
        damage(spoilt["result"]["passes"])
        file.write_text(json.dumps(spoilt), "utf-8")
        with pytest.raises(FormatError, match="what it says of the passes"):
            load_merged_errors(Project(out))


def followed(project, attitude):
    """Add the poses of a camera that looks along an attitude, a frame a millimetre."""
    cloud = project.load_cloud()
    frames = np.unique(cloud.frame)
    note = PartNote(tuple(frames.tolist()), tuple((frames / 25).tolist()), (), ())
    extract = finish(
        project,
        EXTRACT,
        ExtractResult((0,), len(frames), 0, 0, len(cloud)),
        make=lambda: project.save_stripe_part(0, Stripe.empty(), note),
    )
    count = len(frames)
    positions = np.stack([frames * 1e-3, np.zeros(count), np.zeros(count)], axis=1)
    quaternions = np.tile(attitude.as_quat(scalar_first=True), (count, 1))
    way = Trajectory(frames / 25, positions, quaternions)
    finish(
        project,
        MOTION,
        MotionResult(count),
        inputs={"extract": extract.digest},
        make=lambda: project.save_trajectory(way),
    )
    return project


def test_merged_passes_keep_the_way_of_their_cameras(tmp_path, cloud):
    """In the frame of the first, a pose a frame: by it pictures are turned upright."""
    second, pose = drifted(scan_cloud(waves, noise=1e-4, spacing=1.1e-3))
    attitude = Rotation.from_euler("z", 20, degrees=True)
    followed(as_project(tmp_path / "a", cloud), attitude)
    followed(as_project(tmp_path / "b", second), attitude)
    merge_passes([tmp_path / "a", tmp_path / "b"], tmp_path / "out")
    merged = Project(tmp_path / "out")
    way, moments = find_trajectory(merged), find_frame_times(merged)
    assert set(np.unique(merged.load_cloud().frame)) == set(moments.frame)
    other = way.at(way.times[np.isin(moments.frame, np.unique(cloud.frame), invert=True)])
    turned = Rotation.from_quat(other.quaternions[0], scalar_first=True) * attitude.inv()
    np.testing.assert_allclose(turned.as_matrix() @ pose.rotation, np.eye(3), atol=1e-3)
    # With a cloud of which no poses are known, the whole has none.
    as_project(tmp_path / "c", cloud)
    merge_passes([tmp_path / "a", tmp_path / "c"], tmp_path / "out")
    assert find_trajectory(merged) is None


def test_a_plain_wall_says_what_it_leaves_open(tmp_path):
    for name, spacing in (("a", 1e-3), ("b", 1.1e-3)):
        as_project(tmp_path / name, scan_cloud(plane, noise=1e-4, spacing=spacing))
    result = merge_passes([tmp_path / "a", tmp_path / "b"], tmp_path / "out")
    assert "open, so as logged: sliding along" in result.passes[1].words
    assert len(result.passes[1].alignment.open) == 3


def test_a_pass_that_meets_only_the_third_waits_for_it(tmp_path, cloud):
    """The first and the second share nothing; the third lies between them."""
    x = cloud.points[:, 0]
    for name, which in (("a", x < -0.02), ("b", x > 0.02), ("c", (x > -0.06) & (x < 0.06))):
        as_project(tmp_path / name, cloud[which])
    paths = [tmp_path / name for name in "abc"]
    result = merge_passes(paths, tmp_path / "out", reach=0.005)
    assert [one.path for one in result.passes] == [str(path) for path in paths]
    assert result.passes[1].alignment.overlap > 0.5


def test_passes_without_overlap_are_refused_unless_the_log_is_trusted(project, tmp_path, cloud):
    far = replace(cloud, points=cloud.points + np.array([0, 0, 1.0]))
    as_project(tmp_path / "far", far)
    paths = [project.root, tmp_path / "far"]
    with pytest.raises(Degenerate, match="far: The two clouds do not overlap"):
        merge_passes(paths, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    assert merge_passes(paths, tmp_path / "out", align=False).points == 2 * len(cloud)


def test_what_cannot_be_merged_is_one_sentence_and_writes_nothing(project, tmp_path, cloud):
    out = tmp_path / "out"
    (tmp_path / "empty.xyz").write_text("")
    (tmp_path / "lies.ply").write_bytes(
        b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
        b"property float y\nproperty float z\nend_header\n"
    )
    as_project(tmp_path / "profile", cloud[cloud.frame == 3][:20])
    np.savetxt(tmp_path / "mm.xyz", 1e3 * cloud.points)
    np.savetxt(tmp_path / "feet.xyz", cloud.points / 0.3048)
    np.savetxt(tmp_path / "line.xyz", np.linspace([0, 0, 0], [1, 0, 0], 5000))
    wild = np.where(cloud.frame % 2, np.int32(2**31 - 1), np.int32(-(2**31)))
    with writing_cloud_file(tmp_path / "frames.ply") as write:
        write(replace(cloud, frame=wild))
    for other, error, says in (
        ("empty.xyz", InputError, "no points; leave it out"),
        ("lies.ply", FormatError, "declares 4000000000 points"),
        ("nowhere", MissingResult, "does not exist"),
        ("profile", NotEnoughData, "profile cannot be laid .*Need at least 30 points"),
        ("line.xyz", NotEnoughData, "line.xyz cannot be laid .* Give clouds of surfaces"),
        ("mm.xyz", NotEnoughData, r"mm.xyz .* measures \d+ m, and those .* 0\.\d+ m. .* in metres"),
        ("feet.xyz", Degenerate, r"feet.xyz: .* not overlap.* measures 0.579 m, .*its --unit"),
        ("frames.ply", InputError, "frames from -2147483648 to 2147483647"),
    ):
        with pytest.raises(error, match=says):
            merge_passes([project.root, tmp_path / other], out)
        assert not out.exists()
    for voxel in (np.inf, 1e-9):
        with pytest.raises(InputError, match="voxel"):
            merge_passes([project.root], out, voxel=voxel)
        assert not out.exists()
    with pytest.raises(InputError, match="holds a scan"):
        merge_passes([project.root, project.root], project.root)


def test_points_of_others_that_are_not_finite_are_left_out_and_counted(project, tmp_path, cloud):
    broken = replace(cloud, points=cloud.points.copy())
    broken.points[::2] = np.nan
    with writing_cloud_file(tmp_path / "other.ply") as write:
        write(broken)
    result = merge_passes([project.root, tmp_path / "other.ply"], tmp_path / "out")
    assert result.points == len(cloud) + len(cloud) // 2
    broken = len(cloud) - len(cloud) // 2
    assert [one.left_out for one in result.passes] == [0, broken]
    assert f"{broken:,} points without a place" in result.passes[1].words


def test_the_commands_merge_export_and_go_on(project, tmp_path, capsys, cloud):
    with writing_cloud_file(tmp_path / "other.laz") as write:
        write(cloud)
    out = str(tmp_path / "hull")
    passes = [str(project.root), str(tmp_path / "other.laz")]
    assert run(["merge", *passes, "--out", out, "--voxel-mm", "2"]) == 0
    said = capsys.readouterr().out
    assert "stays where it is" in said
    assert "mm RMS apart" in said
    assert run(["cloud", out, "--export", str(tmp_path / "hull.e57")]) == 0
    assert f"{len(Project(tmp_path / 'hull').load_cloud()):,}" in capsys.readouterr().out
    assert (tmp_path / "hull.e57").stat().st_size > 0
    for wrong, says in (
        (["merge", "--out", out], "two scans or more"),
        (["merge", *passes, "--out", out, "--voxel-mm", "0"], "--voxel-mm must be above 0"),
        (["cloud", out, "--voxel-mm", "3"], "--export FILE"),
        (["cloud", out, "--export", "a.docx"], "no suffix of a cloud"),
        (["triangulate", out], "was merged from other scans and has no recording"),
        (["report", out, "--spacing-mm", "2"], "whose own reports judge gaps and speed"),
    ):
        assert run(wrong) == 2
        assert says in capsys.readouterr().err
