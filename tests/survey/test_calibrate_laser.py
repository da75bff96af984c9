"""The laser's line photographed under water, through a port."""

import shutil
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate import sheet_of
from murkscan.calibrate.adjust.observations import index_of
from murkscan.errors import InputError, MissingResult, NotEnoughData
from murkscan.io.images import read_colour, write_image
from murkscan.io.rig_toml import load_rig, save_rig
from murkscan.optics import distance_to_sheet, equivalent_plane
from murkscan.survey.calibrate_laser import FanKnowledge, calibrate_laser_from_photos
from murkscan.types.laser import Fan, Laser
from murkscan.types.plane import Plane
from murkscan.types.port import FlatPort
from murkscan.types.pose import Pose
from murkscan.types.rig_covariance import RigCovariance

from .test_calibrate_port import BOARD, LENS, PORT, RIG, hold, rays_through_port, render

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
    rays = rays_through_port(1)
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


def calibrate(photos, path, sheet):
    fan = FanKnowledge() if isinstance(sheet, Fan) else None
    return calibrate_laser_from_photos(photos, BOARD, path, fan=fan)


@pytest.fixture(scope="module")
def calibrated(photos, sheet, tmp_path_factory):
    """Give a rig file whose laser has been calibrated, and what that found."""
    path = save(tmp_path_factory.mktemp("calibrated") / "rig.toml", sheet)
    return path, calibrate(photos, path, sheet)


def test_the_sheet_is_found_through_the_port(calibrated, sheet):
    path, result = calibrated
    assert result.num_photos == len(TILTS)
    assert len(result.calibration.sightings) >= 4
    found = load_rig(path)
    points = np.concatenate(sheet_of(result.calibration, 0).points)
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


def test_done_again_it_says_the_same(photos, calibrated, sheet, tmp_path):
    path = shutil.copytree(calibrated[0].parent, tmp_path / "again") / "rig.toml"
    first = load_rig(path)
    calibrate(photos, path, sheet)
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
    calibrate(photos, path, sheet)
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


SECOND = Plane.through(np.array([0.02, 0.0, 0.0]), np.array([1.0, 0.04, -0.1]))
"""A second sheet, which crosses the boards to the right of the first one's line."""


@pytest.fixture(scope="module")
def two_lines(tmp_path_factory):
    """Photograph both lines on the same boards."""
    folder, rigs = tmp_path_factory.mktemp("two"), []
    for sheet in (SHEET, SECOND):
        rigs.append(replace(RIG, lasers=(Laser.from_sheet(sheet),)))
    for number, tilt in enumerate(TILTS):
        pose = hold(tilt, number, DEPTHS)
        photo = np.maximum(light(pose, rigs[0]), light(pose, rigs[1]))
        write_image(folder / f"line{number}.png", photo)
    return folder


def off_the_sheet(found, number, sheet):
    """Measure how far a laser's points are from a true sheet, in the RMS [m]."""
    points = np.concatenate(sheet_of(found, number).points)
    off = distance_to_sheet(points, Laser.from_sheet(sheet), index_of(RIG))
    return np.sqrt(np.nanmean(off**2))


def test_two_lasers_are_calibrated_on_the_same_photos(two_lines, tmp_path):
    path = save(tmp_path / "rig.toml", SHEET)
    found = calibrate_laser_from_photos(two_lines, BOARD, path, laser=(0, 1)).calibration
    assert len(load_rig(path).lasers) == 2
    # As for one laser: a fifth of a pixel at half a metre, and a camera known to a thousandth.
    assert off_the_sheet(found, 0, SHEET) < 1e-3
    assert off_the_sheet(found, 1, SECOND) < 1e-3
    assert {name[:8] for name in found.wanted} == {"laser[0]", "laser[1]"}


def test_a_second_laser_is_told_from_the_first_by_its_sheet(two_lines, tmp_path):
    path = save(tmp_path / "rig.toml", SHEET)
    save_rig(path, replace(load_rig(path), lasers=(Laser.from_sheet(SHEET),)))
    found = calibrate_laser_from_photos(two_lines, BOARD, path, laser=1).calibration
    assert off_the_sheet(found, 1, SECOND) < 1e-3
    np.testing.assert_allclose(load_rig(path).lasers[0].sheet.normal, SHEET.normal, atol=1e-9)


def test_a_line_of_another_colour_than_the_rig_says_is_told(photos, tmp_path):
    folder = tmp_path / "red"
    for file in photos.iterdir():
        write_image(folder / file.name, read_colour(file)[:, :, [1, 0, 2]])
    path = save(tmp_path / "rig.toml", SHEET)
    with pytest.raises(NotEnoughData, match="line looks red, the rig says 532 nm"):
        calibrate_laser_from_photos(folder, BOARD, path)
