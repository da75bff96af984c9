"""The laser's line photographed under water, through a port."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate.observed import index_of
from murkscan.errors import InputError, MissingResult, NotEnoughData
from murkscan.io.images import write_image
from murkscan.io.rig_toml import load_rig, save_rig
from murkscan.optics import back_project, distance_to_sheet, equivalent_plane
from murkscan.survey.calibrate_laser import FanKnowledge, calibrate_laser_from_photos
from murkscan.types.laser import Fan, Laser
from murkscan.types.plane import Plane
from murkscan.types.port import FlatPort
from murkscan.types.pose import Pose
from murkscan.types.rig_covariance import RigCovariance

from .test_calibrate_port import BOARD, LENS, PORT, RIG, hold, render

AHEAD = np.array([0.2, 0.0, 1.0]) / np.hypot(0.2, 1.0)
SHEET = Plane.through(np.array([-0.12, 0.0, 0.0]), np.cross(AHEAD, [0.0, 1.0, 0.0]))
FAN = Fan(
    np.array([-0.12, 0.0, 0.0]), AHEAD, np.array([0.0, 1.0, 0.0]), np.radians(30),
    FlatPort(np.array([0.0, 0.0, 1.0]), 0.03, PORT.layers),
)  # fmt: skip
TILTS = [(10, 0), (-12, 5), (0, 20), (5, -15), (10, 10), (-15, -10)]
DEPTHS = (0.47, 0.6, 0.8)


def light(camera_from_board, rig):
    """Photograph the board, and the line on it: a green ridge of 1.5 mm."""
    width, height = LENS.size
    v, u = np.mgrid[:height, :width]
    pixels = np.stack([u.ravel(), v.ravel()], axis=1).astype(float)
    rays = back_project(LENS, pixels, index_of(rig))
    normal, middle = camera_from_board.rotation[:, 2], camera_from_board.translation
    reach = ((middle - rays.origins) @ normal) / (rays.directions @ normal)
    off = distance_to_sheet(
        rays.origins + reach[:, None] * rays.directions, rig.lasers[0], index_of(rig)
    )
    photo = 0.6 * render(camera_from_board).astype(float)
    albedo = photo[:, :, 1] / 120
    photo[:, :, 1] += 120 * albedo * np.exp(-0.5 * (off.reshape(height, width) / 1.5e-3) ** 2)
    return np.clip(photo, 0, 255).astype(np.uint8)


def photograph(folder, sheet):
    rig = replace(RIG, lasers=(Laser.from_sheet(sheet),))
    for number, tilt in enumerate(TILTS):
        write_image(folder / f"line{number}.png", light(hold(tilt, number, DEPTHS), rig))
    return folder


@pytest.fixture(scope="module", params=[SHEET, FAN], ids=["plane", "fan"])
def sheet(request):
    return request.param


@pytest.fixture(scope="module")
def photos(tmp_path_factory, sheet):
    return photograph(tmp_path_factory.mktemp("line"), sheet)


def save(path, sheet):
    """Write the rig file: the camera and its port known, a fan as a ruler has it."""
    fan = isinstance(sheet, Fan)
    rough = replace(sheet, origin=sheet.origin + 2e-3) if fan else None
    save_rig(path, replace(RIG, lasers=(Laser.from_sheet(rough),) if fan else ()))
    return path


def test_the_sheet_is_found_through_the_port(photos, sheet, tmp_path):
    path = save(tmp_path / "rig.toml", sheet)
    fan = FanKnowledge() if isinstance(sheet, Fan) else None
    result = calibrate_laser_from_photos(photos, BOARD, path, fan=fan)
    assert result.num_photos == len(TILTS)
    assert len(result.calibration.sightings) >= 4
    found = load_rig(path)
    points = np.concatenate(result.calibration.fit.points)
    truth = replace(RIG, lasers=(Laser.from_sheet(sheet),))
    off = distance_to_sheet(points, truth.lasers[0], index_of(RIG))
    # A fifth of a pixel at half a metre, and a camera known to a thousandth.
    assert np.sqrt(np.nanmean(off**2)) < 1e-3
    names = found.covariance.names
    assert "water.index" in names
    assert any(name.startswith("laser[0]") for name in names)
    record = tomllib.loads(path.read_text("utf-8"))["calibration"]["laser"]["0"]
    assert record["views"] == len(result.calibration.sightings)
    assert "camera" in record["before"]
    assert "Laser 0" in result.page.read_text("utf-8")


def test_done_again_it_says_the_same(photos, sheet, tmp_path):
    path = save(tmp_path / "rig.toml", sheet)
    fan = FanKnowledge() if isinstance(sheet, Fan) else None
    calibrate_laser_from_photos(photos, BOARD, path, fan=fan)
    first = load_rig(path)
    calibrate_laser_from_photos(photos, BOARD, path, fan=fan)
    second = load_rig(path)
    assert second.covariance.names == first.covariance.names
    np.testing.assert_allclose(second.covariance.sigma, first.covariance.sigma, rtol=1e-3)
    np.testing.assert_allclose(
        equivalent_plane(second.lasers[0], index_of(second)).normal,
        equivalent_plane(first.lasers[0], index_of(first)).normal,
        atol=1e-6,
    )


@pytest.mark.parametrize("is_known", [True, False], ids=["calibrated", "by hand"])
def test_a_rig_on_a_vehicle_gets_a_laser_too(photos, sheet, tmp_path, is_known):
    path = save(tmp_path / "rig.toml", sheet)
    rig = replace(load_rig(path), vehicle_from_camera=Pose(np.eye(3), np.array([0.3, 0.0, 0.1])))
    if is_known:
        names = [f"mount.{part}[{i}]" for part in ("translation", "turn") for i in range(3)]
        both = RigCovariance(
            (*rig.covariance.names, *names),
            np.diag([*np.diag(rig.covariance.matrix), *[1e-6] * 3, *[1e-8] * 3]),
        )
        rig = replace(rig, covariance=both)
    save_rig(path, rig)
    fan = FanKnowledge() if isinstance(sheet, Fan) else None
    calibrate_laser_from_photos(photos, BOARD, path, fan=fan)
    found = load_rig(path)
    np.testing.assert_allclose(found.vehicle_from_camera.translation, [0.3, 0.0, 0.1], atol=1e-9)
    # What nothing was photographed of stays as it was known.
    stated = found.covariance.select(["mount.translation[0]", "mount.turn[2]"]).sigma
    np.testing.assert_allclose(stated, [1e-3, 1e-4] if is_known else [0, 0], rtol=1e-6)


def test_a_fan_must_stand_in_the_rig_file_first(photos, tmp_path):
    path = save(tmp_path / "rig.toml", SHEET)
    with pytest.raises(MissingResult, match=r"no fan in .* write its \[\[laser\]\]"):
        calibrate_laser_from_photos(photos, BOARD, path, fan=FanKnowledge())


def test_lines_that_miss_the_board_are_refused_with_counts(tmp_path):
    folder = tmp_path / "dark"
    folder.mkdir()
    for number, tilt in enumerate(TILTS[:3]):
        write_image(folder / f"{number}.png", render(hold(tilt, number, DEPTHS)))
    path = save(tmp_path / "rig.toml", SHEET)
    before = path.read_bytes()
    with pytest.raises(NotEnoughData, match="found it in 0 of 3"):
        calibrate_laser_from_photos(folder, BOARD, path)
    with pytest.raises(InputError, match="has 0 laser"):
        calibrate_laser_from_photos(folder, BOARD, path, laser=1)
    assert path.read_bytes() == before
