import shutil
import tomllib

import cv2
import numpy as np
import pytest

from murkscan.calibrate import Chessboard, Margin, sheet_of
from murkscan.calibrate.board.stripe import locate_on_board
from murkscan.errors import Degenerate, FormatError, InputError, MissingResult, NotEnoughData
from murkscan.io.images import write_image
from murkscan.io.rig_records import keep_rig_file
from murkscan.io.rig_toml import load_rig
from murkscan.survey.calibrate_camera import calibrate_camera_from_photos
from murkscan.survey.calibrate_laser import calibrate_laser_from_photos
from murkscan.types.camera import Camera
from murkscan.types.pose import Pose

BOARD = Chessboard(9, 6, 0.03)
GREEN_BOARD = Chessboard(8, 6, 0.04)
CUT_OFF = {"board_01.png", "board_05.png", "board_13.png"}
"""Photos of underwater_line/air whose board runs out of the picture."""
GREEN_MARGIN = Margin(left=0.115, right=0.08, top=0.06, bottom=0.065)
"""The white paper of that board beyond its squares, as far as the photos show it."""
CAMERA = Camera((320, 240), (350.0, 350.0), (159.5, 119.5))
TILTS = [(30, 0), (-30, 5), (0, 30), (5, -30), (20, 20), (-20, -20), (20, -20)]


def render(tilt):
    """Photograph the board: the level of each pixel's square, of three by three rays."""
    turns = [
        cv2.Rodrigues(np.radians(a) * axis)[0] for a, axis in zip(tilt, np.eye(3), strict=False)
    ]
    turned = turns[0] @ turns[1]
    place = np.array([0.0, 0.0, 0.45]) - turned @ BOARD.points().mean(axis=0)
    v, u = np.mgrid[:720, :960]
    pixels = (np.stack([u.ravel(), v.ravel()], axis=1) + 0.5) / 3 - 0.5
    pose = Pose(turned, place)
    x, y, _ = (pose.inverse() @ locate_on_board(CAMERA, pixels, pose)).T / BOARD.square
    inside = (x > -1) & (x < BOARD.columns) & (y > -1) & (y < BOARD.rows)
    dark = inside & ((np.floor(x) + np.floor(y)) % 2 == 0)
    level = np.where(dark, 30.0, 200.0).reshape(240, 3, 320, 3).mean(axis=(1, 3))
    return np.repeat(level[:, :, None], 3, axis=2).astype(np.uint8)


@pytest.fixture(scope="module")
def photos(tmp_path_factory):
    folder = tmp_path_factory.mktemp("photos")
    for number, tilt in enumerate(TILTS):
        write_image(folder / f"photo{number}.png", render(tilt))
    return folder


@pytest.fixture(scope="module")
def calibrated(photos, tmp_path_factory):
    folder = tmp_path_factory.mktemp("calibrated")
    calibrate_camera_from_photos(photos, BOARD, folder / "rig.toml")
    return folder


@pytest.fixture
def calibrated_rig(calibrated, tmp_path):
    """Give a rig file whose camera has been calibrated, with what that left beside it."""
    return shutil.copytree(calibrated, tmp_path, dirs_exist_ok=True) / "rig.toml"


@pytest.fixture
def own_photos(photos, tmp_path):
    return shutil.copytree(photos, tmp_path / "own")


def test_the_camera_is_written_and_every_photo_drawn(photos, tmp_path):
    rig = tmp_path / "rig.toml"
    rig.write_text("# my rig\nformat = 1\nwavelength_nm = 450 # blue\n", "utf-8")
    result = calibrate_camera_from_photos(photos, BOARD, rig)
    text = rig.read_text("utf-8")
    assert "# my rig" in text
    assert "450 # blue" in text
    # Corners to 0.03 px in seven views tell the focal length to some 0.3 %.
    assert load_rig(rig).camera.focal_length == pytest.approx((350, 350), rel=0.01)
    record = tomllib.loads(text)["calibration"]["camera"]
    assert record["views"] == len(TILTS)
    assert "7 photos are few" in record["verdict"]
    drawn = sorted(file.name for file in (tmp_path / "calibrate" / "camera").glob("*.jpg"))
    assert drawn == [f"photo{number}.png.found.jpg" for number in range(len(TILTS))]
    assert result.num_photos == len(TILTS)


def test_what_each_step_left_is_kept_and_never_changed(photos, tmp_path):
    rig = tmp_path / "rig.toml"
    rig.write_text("# by hand\nformat = 1\n", "utf-8")
    first = calibrate_camera_from_photos(photos, BOARD, rig)
    left = rig.read_bytes()
    assert first.record.read_bytes() == left
    rig.write_text(rig.read_text("utf-8") + "# a word of mine\n", "utf-8")
    second = calibrate_camera_from_photos(photos, BOARD, rig)
    records = {file: file.read_bytes() for file in (tmp_path / "calibrate/records").iterdir()}
    assert records[first.record] == left
    assert b"# by hand\nformat = 1\n" in records.values()
    assert left + b"# a word of mine\n" in records.values()
    assert records[second.record] == rig.read_bytes()
    assert load_rig(first.record).camera.focal_length == pytest.approx((350, 350), rel=0.01)
    assert keep_rig_file(rig, "again") == second.record
    with pytest.raises(InputError, match="is a record of a calibration"):
        calibrate_camera_from_photos(photos, BOARD, first.record)
    assert first.record.read_bytes() == left


def test_the_record_says_in_what_and_how_well_the_parameters_are_known(photos, tmp_path):
    rig = tmp_path / "rig.toml"
    result = calibrate_camera_from_photos(photos, BOARD, rig)
    record = tomllib.loads(rig.read_text("utf-8"))["calibration"]["camera"]
    assert record["water"] == "air"
    assert record["parameters"] == ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"]
    # Written with nine digits.
    np.testing.assert_allclose(
        record["covariance"], result.calibration.rig.covariance.matrix, rtol=1e-8
    )
    rig.write_text("format = 1\n[water]\nindex = 1.34\n", "utf-8")
    calibrate_camera_from_photos(photos, BOARD, rig)
    tables = tomllib.loads(rig.read_text("utf-8"))
    assert tables["calibration"]["camera"]["water"] == tables["water"] == {"index": 1.34}


def test_a_camera_behind_a_port_is_refused_and_its_file_left_alone(photos, calibrated_rig):
    rig = calibrated_rig
    port = "[camera.port]\nkind = 'dome'\nradius_mm = 50\nthickness_mm = 5\nglass_index = 1.5\n"
    rig.write_text(rig.read_text("utf-8") + port, "utf-8")
    before = rig.read_bytes()
    with pytest.raises(InputError, match=r"has a port.* take \[camera\.port\] and \[water\] out"):
        calibrate_camera_from_photos(photos, BOARD, rig)
    assert rig.read_bytes() == before


@pytest.mark.parametrize("inside", ["", "mine"])
def test_photos_where_the_drawings_go_are_refused_and_stay(calibrated_rig, tmp_path, inside):
    rig = calibrated_rig
    for job, name in [
        (calibrate_camera_from_photos, "camera"),
        (calibrate_laser_from_photos, "laser_0"),
    ]:
        mine = tmp_path / "calibrate" / name / inside
        mine.mkdir(parents=True, exist_ok=True)
        write_image(mine / "mine.jpg", render(TILTS[0]))
        with pytest.raises(InputError, match="where the drawings of this calibration go; move"):
            job(tmp_path / "calibrate" / ".." / "calibrate" / name / inside, BOARD, rig)
        assert (mine / "mine.jpg").exists()


def test_only_drawings_of_an_earlier_calibration_are_cleared(photos, own_photos, tmp_path):
    rig, drawings = tmp_path / "rig.toml", tmp_path / "calibrate" / "camera"
    write_image(drawings / "mine.jpg", render(TILTS[0]))
    (own_photos / "photo6.png").rename(own_photos / "other.png")
    calibrate_camera_from_photos(own_photos, BOARD, rig)
    calibrate_camera_from_photos(photos, BOARD, rig)
    drawn = {file.name for file in drawings.glob("*.jpg")}
    assert drawn == {"mine.jpg", *(f"photo{number}.png.found.jpg" for number in range(7))}


def test_photos_of_one_name_and_two_formats_have_a_drawing_each(own_photos, tmp_path):
    write_image(own_photos / "photo0.jpg", render(TILTS[0]))
    result = calibrate_camera_from_photos(own_photos, BOARD, tmp_path / "rig.toml")
    drawn = {file.name for file in result.pictures.glob("*.jpg")}
    assert {"photo0.png.found.jpg", "photo0.jpg.found.jpg"} < drawn
    assert len(drawn) == len(TILTS) + 1


def test_progress_is_told_for_every_photo(photos, tmp_path):
    told = []
    calibrate_camera_from_photos(
        photos, BOARD, tmp_path / "rig.toml", progress=lambda *step: told.append(step)
    )
    assert ("find boards", len(TILTS), len(TILTS)) in told
    assert ("draw", len(TILTS), len(TILTS)) in told


def test_a_corrupt_photo_is_skipped_and_told(own_photos, tmp_path):
    (own_photos / "photo3.png").write_bytes(b"no picture")
    result = calibrate_camera_from_photos(own_photos, BOARD, tmp_path / "rig.toml")
    assert result.num_photos == len(TILTS) - 1
    assert list(result.unused) == ["photo3.png"]
    assert "photo3.png" in result.unused["photo3.png"]


def test_a_photo_without_the_board_is_named_with_the_reason(own_photos, tmp_path):
    write_image(own_photos / "wall.png", np.full((240, 320, 3), 90, np.uint8))
    result = calibrate_camera_from_photos(own_photos, BOARD, tmp_path / "rig.toml")
    assert result.unused == {"wall.png": "shows no chessboard"}
    assert "shows no chessboard" in result.page.read_text("utf-8")
    record = tomllib.loads((tmp_path / "rig.toml").read_text("utf-8"))["calibration"]["camera"]
    assert record["unused"] == result.unused


def test_pictures_of_another_camera_are_passed_over_by_name(own_photos, tmp_path):
    write_image(own_photos / "zoomed.png", cv2.resize(render(TILTS[0]), (640, 480)))
    result = calibrate_camera_from_photos(own_photos, BOARD, tmp_path / "rig.toml")
    assert result.unused["zoomed.png"].startswith("is 640 x 480 px, not 320 x 240")
    assert load_rig(tmp_path / "rig.toml").camera.size == (320, 240)


def test_squares_counted_for_corners_are_answered_with_the_right_board(photos, tmp_path):
    with pytest.raises(NotEnoughData, match="use --board 9x6; INNER corners count"):
        calibrate_camera_from_photos(photos, Chessboard(10, 7, 0.03), tmp_path / "rig.toml")
    assert not (tmp_path / "rig.toml").exists()


def test_a_board_that_is_never_found_is_told_with_counts_and_cure(tmp_path):
    folder = tmp_path / "walls"
    for number in range(3):
        write_image(folder / f"{number}.png", np.full((240, 320, 3), 90, np.uint8))
    with pytest.raises(
        NotEnoughData, match=r"None of the 3 photos .* shows a 9x6 board"
    ) as refusal:
        calibrate_camera_from_photos(folder, BOARD, tmp_path / "rig.toml")
    assert "INNER corners" in str(refusal.value)


def test_folders_without_photos_are_refused(tmp_path):
    (tmp_path / "empty").mkdir()
    with pytest.raises(FormatError, match="holds no pictures"):
        calibrate_camera_from_photos(tmp_path / "empty", BOARD, tmp_path / "rig.toml")
    with pytest.raises(InputError, match="There is no folder or video"):
        calibrate_camera_from_photos(tmp_path / "nowhere", BOARD, tmp_path / "rig.toml")


def test_a_laser_needs_a_camera_first(photos, tmp_path):
    with pytest.raises(MissingResult, match="calibrate camera` first"):
        calibrate_laser_from_photos(photos, BOARD, tmp_path / "rig.toml")
    (tmp_path / "rig.toml").write_text("format = 1\n", "utf-8")
    with pytest.raises(MissingResult, match="calibrate camera` first"):
        calibrate_laser_from_photos(photos, BOARD, tmp_path / "rig.toml")


def test_photos_without_a_stripe_are_told_with_counts(photos, calibrated_rig):
    rig = calibrated_rig
    before = rig.read_bytes()
    with pytest.raises(NotEnoughData, match="found it in 0 of 7"):
        calibrate_laser_from_photos(photos, BOARD, rig)
    with pytest.raises(InputError, match="has 0 laser"):
        calibrate_laser_from_photos(photos, BOARD, rig, laser=1)
    assert rig.read_bytes() == before


def test_photos_of_another_camera_are_refused_for_the_laser(own_photos, calibrated_rig):
    for photo in own_photos.iterdir():
        write_image(photo, np.zeros((480, 640, 3), np.uint8))
    with pytest.raises(InputError, match=r"are 640 x 480 px but the rig's camera has 320 x 240"):
        calibrate_laser_from_photos(own_photos, BOARD, calibrated_rig)


def test_the_boards_of_the_stage_are_refused_as_degenerate(data, tmp_path):
    with pytest.raises(Degenerate, match="all face the camera straight on") as refusal:
        calibrate_camera_from_photos(
            data("stage_stairs") / "board", Chessboard(5, 5, 0.005), tmp_path / "rig.toml"
        )
    assert "tilted by 20 to 40 degrees" in str(refusal.value)
    assert len(list((tmp_path / "calibrate" / "camera").glob("*.jpg"))) == 11


def test_the_chessboards_calibrate_to_the_known_rms(data, tmp_path):
    result = calibrate_camera_from_photos(data("chessboards"), BOARD, tmp_path / "rig.toml")
    assert len(result.calibration.sightings) == result.num_photos == 13
    assert result.calibration.rms <= 0.22


def test_boards_that_the_picture_cuts_off_calibrate_to_the_authors_camera(data, tmp_path):
    board = Chessboard(8, 7, 0.0338)
    photos = data("underwater_line") / "air"
    result = calibrate_camera_from_photos(photos, board, tmp_path / "rig.toml")
    used = {sighting.name: len(sighting.corners) for sighting in result.calibration.sightings}
    assert len(used) >= 6
    assert {name for name, count in used.items() if count < 56} >= CUT_OFF
    focal_length = np.array(result.calibration.rig.camera.focal_length)
    assert np.abs(focal_length / [702.6, 703.5] - 1).max() < 0.01


def every_second(photos, folder):
    """Refer to every second photo of a folder from another one."""
    folder.mkdir()
    for photo in sorted(photos.iterdir())[::2]:
        (folder / photo.name).symlink_to(photo)
    return folder


def test_the_green_laser_calibrates_to_the_known_sheet(data, tmp_path):
    """Half of the photos stand for all, which `benchmarks/calibration.py` takes."""
    rig = tmp_path / "rig.toml"
    boards = every_second(data("green_laser") / "board", tmp_path / "board")
    lines = every_second(data("green_laser") / "laser_on_board", tmp_path / "lines")
    camera = calibrate_camera_from_photos(boards, GREEN_BOARD, rig)
    assert len(camera.calibration.sightings) == camera.num_photos == 14
    assert camera.calibration.rms <= 0.16
    laser = calibrate_laser_from_photos(lines, GREEN_BOARD, rig, margin=GREEN_MARGIN)
    found = sheet_of(laser.calibration, 0)
    assert found.rms <= 0.45e-3
    # The reference plane of the recording's README, from an independent fit.
    normal, distance = np.array([-0.9057, 0.1395, -0.4004]), 0.1657
    turn = np.linalg.norm(np.cross(found.sheet.normal, normal / np.linalg.norm(normal)))
    assert np.degrees(np.arcsin(turn)) <= 0.5
    points = np.concatenate(found.points)[np.concatenate(found.inliers)]
    assert np.abs(points @ normal + distance).max() <= 2e-3
    assert tomllib.loads(rig.read_text("utf-8"))["calibration"]["laser"]["0"]["water"] == "air"
    saved = load_rig(rig).lasers[0]
    np.testing.assert_allclose(saved.sheet.normal, found.sheet.normal, atol=1e-9)
    # The finder of version 0.1 saw the board in 45 of all 61.
    assert laser.num_photos == 31
    assert len(laser.calibration.sightings) >= 23
