"""A scan from the recording to the report: what it makes, skips, and takes up again."""

import os
import shutil
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

import murkscan as ms
from murkscan.capture import Skip
from murkscan.capture.chunks import cut_chunks
from murkscan.geometry.mesh_distance import distance_to_mesh
from murkscan.io.mesh_files import load_mesh
from murkscan.project import EXTRACT, TRIANGULATE
from murkscan.survey.cloud import build_cloud
from murkscan.survey.extract import extract_recording
from murkscan.survey.motion import follow_motion
from murkscan.survey.scan import begin_scan
from murkscan.survey.triangulate import triangulate_stripes

from ..scenes import HULL_SPEED

MOTION = ms.ConstantSpeed(HULL_SPEED, "y")
MADE = [
    "scan.json",
    "extract/stripes/000000.parquet",
    "extract/stripes/000002.parquet",
    "triangulate/profiles/000001.parquet",
    "motion/trajectory.csv",
    "cloud/cloud.ply",
    "cloud/frames.mlp",
    "mesh/mesh.ply",
    "mesh/mesh.stl",
    "mesh/mesh.glb",
    "view/isometric.png",
    "view/front.png",
    "view/index.html",
    "report/index.html",
    "report/report.json",
]


def _open(hull):
    rig = ms.load_rig(hull / "rig.toml")
    return ms.open_recording(hull / "frames", wavelength=rig.wavelength), rig


def _make_cloud(recording, rig, out, motion=MOTION, extractor=None):
    """Run a scan's stages up to the cloud, as far as most tests look."""
    project = ms.Project(out)
    begin_scan(project, recording, rig, settings={})
    extract_recording(project, recording, rig, extractor or ms.Murk())
    triangulate_stripes(project, rig, ms.RaySheet())
    follow_motion(project, motion)
    build_cloud(project, rig)
    return project


@pytest.fixture(scope="module")
def scanned(hull, tmp_path_factory):
    recording, rig = _open(hull)
    return ms.scan(recording, rig, MOTION, out=tmp_path_factory.mktemp("scans") / "out")


@pytest.mark.parametrize("name", MADE)
def test_a_scan_makes_what_the_contract_says(scanned, name):
    assert (scanned.root / name).stat().st_size > 0


def test_about_twelve_overlays_are_kept(scanned):
    assert 8 <= len(list((scanned.root / "extract/overlay").glob("*.png"))) <= 12


def test_every_frame_has_a_pose_and_every_point_a_profile(scanned):
    assert len(scanned.load_trajectory().times) == 130
    dropped = scanned.finished(TRIANGULATE).result.dropped
    assert len(scanned.load_profile()) == len(scanned.load_stripe()) - dropped


def test_a_repeated_scan_skips_what_is_done(scanned, hull):
    before = {file: file.stat().st_mtime_ns for file in scanned.root.rglob("*.p*")}
    recording, rig = _open(hull)
    ms.scan(recording, rig, MOTION, out=scanned.root)
    assert {file: file.stat().st_mtime_ns for file in scanned.root.rglob("*.p*")} == before


def test_a_file_that_others_put_beside_a_result_is_no_reason_to_begin_again(
    hull, tmp_path, scanned
):
    shutil.copytree(scanned.root, tmp_path / "out")
    (tmp_path / "out/view/.DS_Store").write_bytes(b"a file browser's notes")
    picture = tmp_path / "out/view/isometric.png"
    before = picture.stat().st_mtime_ns
    recording, rig = _open(hull)
    ms.scan(recording, rig, MOTION, out=tmp_path / "out")
    assert picture.stat().st_mtime_ns == before


def test_another_motion_redoes_only_what_depends_on_it(scanned, hull, tmp_path):
    shutil.copytree(scanned.root, tmp_path / "out")
    stripes = tmp_path / "out/extract/stripes/000000.parquet"
    before = stripes.stat().st_mtime_ns
    recording, rig = _open(hull)
    half = ms.ConstantSpeed(HULL_SPEED / 2, "y")
    project = ms.scan(recording, rig, half, out=tmp_path / "out")
    assert stripes.stat().st_mtime_ns == before
    length = np.ptp(project.load_cloud().points[:, 1])
    assert length < 0.6 * np.ptp(scanned.load_cloud().points[:, 1])
    assert project.load_measured().navigation.speed == HULL_SPEED / 2


def test_a_stopped_scan_goes_on_at_its_first_missing_part(scanned, hull, tmp_path):
    recording, rig = _open(hull)

    def stop(stage, done, total):
        if stage == "extract" and done >= 64:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ms.scan(recording, rig, MOTION, out=tmp_path / "out", progress=stop)
    first = tmp_path / "out/extract/stripes/000000.parquet"
    written = first.stat().st_mtime_ns
    project = _make_cloud(recording, rig, tmp_path / "out")
    assert first.stat().st_mtime_ns == written
    again = (project.root / "cloud/cloud.ply").read_bytes()
    assert again == (scanned.root / "cloud/cloud.ply").read_bytes()


def _command(hull, out):
    return [
        sys.executable, "-m", "murkscan", "scan", str(hull / "frames"), "--rig",
        str(hull / "rig.toml"), "--speed-mm-s", "100", "--out", str(out),
    ]  # fmt: skip


def test_a_killed_scan_goes_on_and_gives_the_same(scanned, hull, tmp_path):
    """Killed without warning as soon as the first part is there."""
    out = tmp_path / "out"
    child = subprocess.Popen(_command(hull, out), stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 60
    while not (out / "extract/frames/000000.json").exists() and time.monotonic() < deadline:
        assert child.poll() is None
        time.sleep(0.005)
    child.kill()
    assert child.wait() != 0, "the scan was done before it could be killed"
    written = (out / "extract/frames/000000.json").stat().st_mtime_ns
    _make_cloud(*_open(hull), out)
    assert (out / "extract/frames/000000.json").stat().st_mtime_ns == written
    again = (out / "cloud/cloud.ply").read_bytes()
    assert again == (scanned.root / "cloud/cloud.ply").read_bytes()


@pytest.mark.skipif(os.name != "posix", reason="file-size limits are POSIX")
def test_a_full_disk_is_one_sentence_and_nothing_finished_is_lost(scanned, hull, tmp_path):
    """A limit on the size of files stands for the disk: the cloud does not fit, stripes do."""
    import resource

    out = tmp_path / "out"
    size = (scanned.root / "cloud/cloud.ply").stat().st_size - 1000
    limited = subprocess.run(
        _command(hull, out),
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)),
    )
    assert limited.returncode == 2
    assert "Traceback" not in limited.stderr
    assert "cloud.ply" in limited.stderr
    assert not list((out / "cloud").glob(".*part*"))
    written = (out / "extract/stripes/000000.parquet").stat().st_mtime_ns
    _make_cloud(*_open(hull), out)
    assert (out / "extract/stripes/000000.parquet").stat().st_mtime_ns == written
    again = (out / "cloud/cloud.ply").read_bytes()
    assert again == (scanned.root / "cloud/cloud.ply").read_bytes()


def test_a_recording_without_a_stripe_gives_an_empty_cloud_and_says_so(hull, tmp_path):
    from murkscan.io.images import write_image

    for i in range(5):
        write_image(tmp_path / "dark" / f"{i}.png", np.zeros((288, 360), np.uint8))
    rig = ms.load_rig(hull / "rig.toml")
    recording = ms.open_recording(tmp_path / "dark", wavelength=rig.wavelength)
    project = ms.scan(recording, rig, ms.ConstantStep(0.001, "y"), out=tmp_path / "out")
    assert len(project.load_cloud()) == 0
    assert "no stripe" in (project.root / "report/index.html").read_text().lower()


def test_a_recording_of_another_camera_is_refused(hull, tmp_path):
    recording, rig = _open(hull)
    other = replace(rig, camera=replace(rig.camera, size=(640, 480)))
    with pytest.raises(ms.InputError, match="360 × 288"):
        ms.scan(recording, other, MOTION, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_folder_with_other_things_is_left_alone(hull, tmp_path):
    (tmp_path / "holiday.jpg").write_bytes(b"a picture")
    recording, rig = _open(hull)
    with pytest.raises(ms.InputError, match="other files"):
        ms.scan(recording, rig, MOTION, out=tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["holiday.jpg"]


def test_a_corrupt_picture_in_the_middle_is_skipped_and_counted(hull, tmp_path):
    shutil.copytree(hull / "frames", tmp_path / "frames")
    (tmp_path / "frames/000070.png").write_bytes(b"not a picture")
    rig = ms.load_rig(hull / "rig.toml")
    recording = ms.open_recording(tmp_path / "frames", wavelength=rig.wavelength)
    project = _make_cloud(recording, rig, tmp_path / "out")
    counts = project.finished(EXTRACT).result
    assert (counts.frames, counts.skipped) == (129, 1)
    assert "000070.png" in counts.skips[0][2]
    assert 70 not in project.load_cloud().frame


def test_a_lost_part_is_made_again(scanned, hull, tmp_path):
    shutil.copytree(scanned.root, tmp_path / "out")
    (tmp_path / "out/extract/stripes/000001.parquet").unlink()
    recording, rig = _open(hull)
    project = ms.scan(recording, rig, MOTION, out=tmp_path / "out")
    again = (project.root / "extract/stripes/000001.parquet").read_bytes()
    assert again == (scanned.root / "extract/stripes/000001.parquet").read_bytes()


def test_a_stage_that_is_older_than_its_input_is_not_taken(scanned, hull, tmp_path):
    shutil.copytree(scanned.root, tmp_path / "out")
    recording, rig = _open(hull)
    project = ms.Project(tmp_path / "out")
    extract_recording(project, recording, rig, ms.Steger())
    with pytest.raises(ms.MissingResult, match=r"triangulate stage .* older than its extract"):
        build_cloud(project, rig)


def test_another_rate_gives_other_times(hull, tmp_path):
    """The same pictures, first without times, then with a rate: a quarter of a second each."""
    (tmp_path / "frames").mkdir()
    for i in range(40, 60):
        shutil.copy(hull / "frames" / f"{i:06d}.png", tmp_path / "frames")
    rig = ms.load_rig(hull / "rig.toml")
    untimed = ms.open_recording(tmp_path / "frames", fps=None)
    finder = ms.GrayGravity()
    _make_cloud(untimed, rig, tmp_path / "out", ms.ConstantStep(0.01, "y"), finder)
    timed = ms.open_recording(tmp_path / "frames", fps=4.0)
    project = _make_cloud(timed, rig, tmp_path / "out", ms.ConstantSpeed(0.1, "y"), finder)
    assert np.ptp(project.load_trajectory().times) == pytest.approx(19 / 4)
    assert np.ptp(project.load_trajectory().positions[:, 1]) == pytest.approx(0.1 * 19 / 4)


def test_a_mesher_that_is_not_there_is_told_before_the_work(hull, tmp_path):
    recording, rig = _open(hull)
    try:
        ms.Poisson().check_available()
    except ms.MissingDependency:
        with pytest.raises(ms.MissingDependency, match="mesh"):
            ms.scan(recording, rig, MOTION, out=tmp_path / "out", mesher=ms.Poisson())
        assert not (tmp_path / "out").exists()
    else:
        pytest.skip("Open3D is installed here")


def test_a_motion_that_needs_times_is_refused_before_the_work(hull, tmp_path):
    (tmp_path / "frames").mkdir()
    shutil.copy(hull / "frames/000050.png", tmp_path / "frames")
    rig = ms.load_rig(hull / "rig.toml")
    with pytest.raises(ms.InputError, match="--fps"):
        ms.scan(ms.open_recording(tmp_path / "frames"), rig, MOTION, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("halo", [0, 3])
def test_a_loss_across_parts_is_counted_once(halo):
    """Frames 60 to 69 and 130 to 139 are lost; parts end at 64 and 128."""
    lost = {*range(60, 70), *range(130, 140)}
    skips = [Skip(60, "a", 10)]

    def frames():
        for index in range(150):
            if index == 140:
                skips.append(Skip(130, "b", 10))
            if index not in lost:
                yield ms.Frame(np.zeros((2, 2), np.uint8), index, float(index))

    chunks = list(cut_chunks(frames(), skips, first=0, halo=halo))
    assert [[(s.index, s.count) for s in chunk.skips] for chunk in chunks] == [
        [(60, 4)],
        [(64, 6)],
        [(130, 10)],
    ]
    owned = [f.index for chunk in chunks for f in chunk.frames if chunk.owns(f.index)]
    assert owned == [index for index in range(150) if index not in lost]


def test_in_clear_air_a_scan_is_within_a_tenth_of_a_millimetre_of_the_truth(scanned, hull):
    truth = load_mesh(hull / "truth/mesh.ply")
    away = distance_to_mesh(scanned.load_cloud().points[::5], truth, within=0.01)
    assert np.isfinite(away).mean() > 0.99
    # Edges, where a pixel sees two surfaces, are left to the tail.
    assert np.median(away) < 1e-4
