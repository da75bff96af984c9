"""A simulated recording on the disk: what is written, and what a scan makes of it."""

import numpy as np
import pyarrow.parquet as pq
import pytest

import murkscan as ms
from murkscan.io.images import read_image
from murkscan.io.mesh_files import load_mesh
from murkscan.io.parquet import load_true_stripe
from murkscan.io.poses import load_poses
from murkscan.io.rig_toml import load_rig
from murkscan.project import Project
from murkscan.simulate import parse_scene, read_scene, simulate_frames
from murkscan.survey.check import check_project
from murkscan.survey.simulate import simulate_recording

from ..scenes import smaller

COLUMNS = [
    "frame", "laser", "branch", "kind", "u", "v", "x_m", "y_m", "z_m", "signal", "snr", "crlb_px",
]  # fmt: skip


def _scene(changes=(), factor=2):
    text, name, folder = read_scene("sphere-c1.5")
    text = text.replace("frames = 100", "frames = 6").replace("0.0, 200.0,", "0.0, 0.0,")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return smaller(parse_scene(text, name, folder), factor), text


def _tiny(frames, *changes):
    """Give the scene in pictures of 120 × 96: enough for what is asked of files alone."""
    return _scene([*changes, ("frames = 6", f"frames = {frames}")], 6)[0]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    out = tmp_path_factory.mktemp("simulated") / "out"
    scene, text = _scene()
    return scene, simulate_recording(scene, out, text=text), out


def test_a_recording_has_what_the_contract_says(written):
    scene, made, out = written
    assert made.num_frames == 12  # fields are counted
    assert len(list((out / "frames").glob("*.png"))) == 6
    assert load_rig(out / "rig.toml").camera.size == (360, 288)
    table = pq.read_table(out / "truth/stripes.parquet")
    assert table.column_names == COLUMNS
    assert set(table["kind"].to_pylist()) == {"direct"}
    truth = load_true_stripe(out / "truth/stripes.parquet")
    assert len(truth) == made.num_centres > 3000
    np.testing.assert_array_equal(np.unique(truth.frame), np.arange(12))
    assert len(load_mesh(out / "truth/mesh.ply").faces) == len(scene.surroundings.mesh.faces)
    np.testing.assert_allclose(load_poses(out / "poses.csv").times, scene.times, atol=1e-12)
    assert "sphere" in (out / "truth/scene.toml").read_text()


def test_fields_are_woven_row_by_row(written):
    scene, _, out = written
    picture = read_image(out / "frames/000002.png")
    upper, lower = simulate_frames(scene, 4, 6)
    np.testing.assert_array_equal(picture[0::2], upper.frame.image)
    np.testing.assert_array_equal(picture[1::2], lower.frame.image)
    assert (upper.frame.first_row, lower.frame.first_row, upper.frame.row_step) == (0, 1, 2)


def test_capture_gives_the_simulator_s_frames_back(written):
    scene, _, out = written
    recording = ms.open_recording(out / "frames", fields="top-first")
    for read, made in zip(recording.frames(), simulate_frames(scene), strict=True):
        np.testing.assert_array_equal(read.image, made.frame.image)
        assert (read.index, read.first_row, read.row_step) == (
            made.frame.index, made.frame.first_row, 2,
        )  # fmt: skip
        assert read.time == pytest.approx(made.frame.time, abs=1e-9)


def test_the_same_scene_and_seed_give_the_same_bytes(written, tmp_path):
    scene, _, out = written
    simulate_recording(scene, tmp_path / "again")
    for path in ("frames/000003.png", "truth/stripes.parquet", "truth/mesh.ply", "poses.csv"):
        assert (tmp_path / "again" / path).read_bytes() == (out / path).read_bytes()
    other, _ = _scene([("format = 1", "format = 1\nseed = 5"), ("frames = 6", "frames = 1")])
    simulate_recording(other, tmp_path / "other")
    first = "frames/000000.png"
    assert (tmp_path / "other" / first).read_bytes() != (out / first).read_bytes()


@pytest.mark.parametrize("codec", ["ffv1", "h264", "h265"])
def test_a_video_keeps_the_grey_levels(codec, tmp_path):
    given = ("peak_grey = 200", f'peak_grey = 200\ncodec = "{codec}"\ncrf = 12')
    scene = _tiny(2, given)
    made = simulate_recording(scene, tmp_path)
    assert made.recording.name == "recording.mkv"
    recording = ms.open_recording(made.recording, fields="top-first")
    frames = list(recording.frames())
    assert len(frames) == 4
    first = next(simulate_frames(scene))
    away = np.abs(frames[0].image.astype(int) - first.frame.image)
    assert away.max() == 0 if codec == "ffv1" else away.mean() < 2


def test_the_log_is_late_noisy_and_of_the_vehicle(tmp_path):
    motion = (
        "speed_mm_s = 100.0",
        "speed_mm_s = 100.0\n[motion.vehicle]\nsway_mm = 20.0\n[motion.navigation]\n"
        "rate_hz = 20.0\nposition_noise_mm = 1.0\nlatency_ms = 100.0",
    )
    mount = (
        'file = "rigs/pal.toml"',
        "format = 1\n[rig.camera]\nsize = [720, 576]\nfocal_length = [554, 554]\n"
        'principal_point = [360, 288]\n[[rig.laser]]\nkind = "baseline_angle"\nbaseline_mm = 300\n'
        'angle_deg = 71\naxis = "y"\n[rig.mount]\ntranslation_mm = [100.0, 0.0, 0.0]\n',
    )
    scene, _ = _scene([motion, mount], 6)
    simulate_recording(scene, tmp_path)
    log, poses = load_poses(tmp_path / "navigation.csv"), load_poses(tmp_path / "poses.csv")
    assert np.diff(log.times) == pytest.approx(0.05)
    # The camera sits 100 mm to the right of the vehicle: the vehicle is to the camera's left.
    there = scene.trajectory.at(scene.times).positions
    np.testing.assert_allclose(there - poses.positions, [[0.1, 0, 0]] * len(there), atol=1e-6)
    late = scene.trajectory.at(log.times - 0.1).positions - [0.1, 0, 0]
    errors = (log.positions - late)[5:-5]
    assert errors.std() == pytest.approx(1e-3, rel=0.3)
    assert np.ptp(there[:, 0]) > 0


def test_a_scan_of_the_recording_lies_on_the_truth(written, tmp_path):
    from murkscan.geometry.mesh_distance import distance_to_mesh

    scene, _, out = written
    rig = load_rig(out / "rig.toml")
    recording = ms.open_recording(out / "frames", fields="top-first")
    project = ms.scan(recording, rig, ms.ConstantSpeed(0.1, "y"), out=tmp_path / "scan")
    points = project.load_cloud().points
    assert len(points) > 3000
    # One pixel is 2.5 mm of depth here, and gray gravity is good to about a tenth.
    assert np.median(distance_to_mesh(points[::5], scene.surroundings.mesh, within=0.05)) < 5e-4


def test_a_scene_written_with_the_truth_can_be_run_again(tmp_path):
    from murkscan.simulate import Simulator, as_standalone, load_scene

    text, name, folder = read_scene("chessboard")
    scene = parse_scene(text, name, folder)
    (tmp_path / "again.toml").write_text(as_standalone(text, scene.rig, folder))
    again = load_scene(tmp_path / "again.toml")
    images = [Simulator.of(one).draw_frame(2).frame.image for one in (scene, again)]
    np.testing.assert_array_equal(*images)


def test_a_folder_is_used_again_but_no_photos_are_lost(tmp_path):
    out = tmp_path / "out"
    simulate_recording(_tiny(2), out)
    shorter = _tiny(1)
    simulate_recording(shorter, out)
    assert len(list((out / "frames").glob("*.png"))) == 1
    assert ms.open_recording(out / "frames", fields="top-first").num_frames == 2
    (tmp_path / "mine/frames").mkdir(parents=True)
    (tmp_path / "mine/frames/a.png").write_bytes(b"a photo")
    with pytest.raises(ms.InputError, match="not of a simulation"):
        simulate_recording(shorter, tmp_path / "mine")
    assert (tmp_path / "mine/frames/a.png").read_bytes() == b"a photo"


@pytest.mark.parametrize(
    "name", ["rig.toml", "poses.csv", "scan.json", "cloud/cloud.ply", "truth/gps.csv"]
)
def test_a_folder_that_no_simulation_has_made_stays_as_it_is(tmp_path, name):
    mine = tmp_path / name
    mine.parent.mkdir(exist_ok=True)
    mine.write_text("mine")
    with pytest.raises(ms.InputError, match="not of a simulation; give a new folder"):
        simulate_recording(_tiny(1), tmp_path)
    assert mine.read_text() == "mine"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_simulation_that_was_stopped_is_made_anew_in_its_folder(tmp_path):
    scene = _tiny(2)

    def stop(word, done, total):
        if done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate_recording(scene, tmp_path, progress=stop)
    assert (tmp_path / "rig.toml").exists()
    assert [one.state for one in check_project(Project(tmp_path))] == ["not finished"]
    assert simulate_recording(scene, tmp_path).num_pictures == 2
    (checked,) = check_project(Project(tmp_path))
    # Two pictures and their times, the rig, the poses, and of the truth stripes and a mesh.
    assert (checked.num_whole, checked.foreign, checked.state) == (7, (), "")
    made = (tmp_path / "rig.toml").stat().st_mtime_ns
    simulate_recording(scene, tmp_path)
    assert (tmp_path / "rig.toml").stat().st_mtime_ns == made
