import tomllib

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.calibrate import Chessboard, circles_of
from murkscan.calibrate.board.stripe import locate_on_board
from murkscan.errors import InputError, MissingResult, NotEnoughData
from murkscan.io.images import write_image
from murkscan.io.rig_toml import load_rig, save_rig
from murkscan.io.times_csv import write_times
from murkscan.survey.calibrate_mount import PhotoClock, calibrate_mount_from_photos
from murkscan.types.camera import Camera
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory

BOARD = Chessboard(9, 6, 0.03)
CAMERA = Camera((320, 240), (350.0, 350.0), (159.5, 119.5))
MOUNT = Pose(
    Rotation.from_euler("xyz", [90, 0, -90], degrees=True).as_matrix(), np.array([0.3, 0.0, 0.1])
)
TILTS = [(25, 0, 0), (-25, 5, 20), (0, 25, -20), (5, -25, 10), (18, 18, 0), (-18, -18, 15)]


def render(camera_from_board):
    """Photograph the board: the level of each pixel's square, of three by three rays."""
    v, u = np.mgrid[:720, :960]
    pixels = (np.stack([u.ravel(), v.ravel()], axis=1) + 0.5) / 3 - 0.5
    in_camera = locate_on_board(CAMERA, pixels, camera_from_board)
    x, y, _ = (camera_from_board.inverse() @ in_camera).T / BOARD.square
    inside = (x > -1) & (x < BOARD.columns) & (y > -1) & (y < BOARD.rows)
    dark = inside & ((np.floor(x) + np.floor(y)) % 2 == 0)
    level = np.where(dark, 30.0, 200.0).reshape(240, 3, 320, 3).mean(axis=(1, 3))
    return np.repeat(level[:, :, None], 3, axis=2).astype(np.uint8)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Photograph a board that stands at the world's origin; give the photos and the log."""
    folder, poses = tmp_path_factory.mktemp("photos"), []
    for number, tilt in enumerate(TILTS):
        turned = Rotation.from_euler("xyz", tilt, degrees=True).as_matrix()
        place = np.array([0.0, 0.0, 0.45]) - turned @ BOARD.points().mean(axis=0)
        camera_from_board = Pose(turned, place)
        write_image(folder / f"photo{number}.png", render(camera_from_board))
        poses.append(camera_from_board.inverse() @ MOUNT.inverse())
    times = 10.0 * np.arange(len(poses))
    log = Trajectory(
        np.repeat(times, 2) + np.tile([-1.0, 1.0], len(times)),
        np.repeat([pose.translation for pose in poses], 2, axis=0),
        np.repeat(np.concatenate([pose.as_quaternion() for pose in poses]), 2, axis=0),
    )
    write_times(folder / "times.csv", {f"photo{i}.png": t for i, t in enumerate(times.tolist())})
    return folder, log


@pytest.fixture
def rig_path(tmp_path):
    save_rig(tmp_path / "rig.toml", Rig(CAMERA))
    return tmp_path / "rig.toml"


def test_the_mount_and_what_it_is_worth_are_written(recorded, rig_path):
    rig_path.write_text("# my rig\n" + rig_path.read_text("utf-8"), "utf-8")
    result = calibrate_mount_from_photos(recorded[0], BOARD, rig_path, recorded[1])
    assert "# my rig" in rig_path.read_text("utf-8")
    rig = load_rig(rig_path)
    # Corners to 0.03 px of 350 at 0.45 m are 0.04 mm each; six views tell a tilt to 0.1 degrees.
    off = MOUNT.inverse() @ rig.vehicle_from_camera
    assert np.linalg.norm(off.translation) < 2e-3
    assert circles_of(result.calibration).closure < 1e-3
    np.testing.assert_allclose(rig.covariance.sigma, result.calibration.sigma, rtol=1e-6)
    assert "Mount" in result.page.read_text("utf-8")
    record = tomllib.loads(rig_path.read_text("utf-8"))["calibration"]["mount"]
    assert record["views"] == len(TILTS)
    assert "clock_offset_s" not in record
    assert "photos are few" in record["verdict"]
    drawn = {file.name for file in result.pictures.glob("*.found.jpg")}
    assert drawn == {f"photo{number}.png.found.jpg" for number in range(len(TILTS))}


def test_photos_without_times_are_refused_with_the_cure(recorded, rig_path, tmp_path):
    for file in recorded[0].glob("*.png"):
        (tmp_path / "bare").mkdir(exist_ok=True)
        (tmp_path / "bare" / file.name).write_bytes(file.read_bytes())
    with pytest.raises(InputError, match=r"have no times.*times\.csv.*or give --fps"):
        calibrate_mount_from_photos(tmp_path / "bare", BOARD, rig_path, recorded[1])


def test_the_start_time_says_where_in_the_log_the_photos_are(recorded, rig_path):
    folder, log = recorded
    late = Trajectory(log.times + 1000.0, log.positions, log.quaternions)
    with pytest.raises(InputError, match="--start-time"):
        calibrate_mount_from_photos(folder, BOARD, rig_path, late)
    before = rig_path.read_bytes()
    clock = PhotoClock(start_time=990.0, time_offset=10.0)
    assert calibrate_mount_from_photos(folder, BOARD, rig_path, late, clock=clock).num_photos == 6
    assert rig_path.read_bytes() != before


def test_a_rig_without_a_camera_is_told_what_to_run(recorded, tmp_path):
    (tmp_path / "rig.toml").write_text("format = 1\n", "utf-8")
    with pytest.raises(MissingResult, match="run `murkscan calibrate camera` first"):
        calibrate_mount_from_photos(recorded[0], BOARD, tmp_path / "rig.toml", recorded[1])


def test_too_few_photos_write_nothing(recorded, rig_path, tmp_path):
    (tmp_path / "few").mkdir()
    for number in range(3):
        name = f"photo{number}.png"
        (tmp_path / "few" / name).write_bytes((recorded[0] / name).read_bytes())
    write_times(tmp_path / "few" / "times.csv", {f"photo{i}.png": 10.0 * i for i in range(3)})
    before = rig_path.read_bytes()
    with pytest.raises(NotEnoughData, match="at least 4 photos"):
        calibrate_mount_from_photos(tmp_path / "few", BOARD, rig_path, recorded[1])
    assert rig_path.read_bytes() == before
