"""What is known of a rig without a calibration goes into its file, and takes nothing away."""

import math

import pytest

from murkscan import load_rig
from murkscan.errors import FormatError, InputError
from murkscan.optics import equivalent_plane
from murkscan.survey.describe import Described, describe_rig

CAMERA = {"size": (720, 576), "view_deg": 66.0}


def test_a_described_rig_sees_as_wide_as_was_said(tmp_path):
    describe_rig(tmp_path / "rig.toml", Described(**CAMERA, baseline_mm=300.0, angle_deg=65.0))
    rig = load_rig(tmp_path / "rig.toml")
    half = math.degrees(math.atan(rig.camera.size[0] / 2 / rig.camera.focal_length[0]))
    # The focal length is written to a thousandth of a pixel.
    assert 2 * half == pytest.approx(66.0, abs=1e-3)
    plane = equivalent_plane(rig.laser(0), 1.0)
    assert abs(plane.distance / plane.normal[1]) == pytest.approx(0.3)


def test_a_window_and_a_water_are_added_and_comments_stay(tmp_path):
    path = tmp_path / "rig.toml"
    describe_rig(path, Described(**CAMERA))
    path.write_text("# my boat\n" + path.read_text())
    describe_rig(path, Described(window_mm=30.0, glass_mm=8.0))
    describe_rig(path, Described(temperature_c=15.0, salinity_psu=35.0))
    rig = load_rig(path)
    assert rig.camera.port.distance == pytest.approx(0.03)
    assert rig.water.temperature_c == 15.0
    assert path.read_text().startswith("# my boat")
    describe_rig(path, Described(dome_radius_mm=60.0, glass_mm=5.0))
    assert load_rig(path).camera.port.radius == pytest.approx(0.06)


@pytest.mark.parametrize(
    ("table", "given"),
    [
        ("camera", Described(**CAMERA)),
        ("laser.0", Described(baseline_mm=300.0, angle_deg=65.0)),
        ("port", Described(window_mm=30.0, glass_mm=8.0)),
    ],
)
def test_what_was_calibrated_is_not_replaced(tmp_path, table, given):
    path = tmp_path / "rig.toml"
    describe_rig(path, Described(**CAMERA, baseline_mm=200.0, angle_deg=70.0))
    path.write_text(path.read_text() + f'\n[calibration.{table}]\nverdict = "Good."\n')
    before = path.read_text()
    with pytest.raises(InputError, match="was calibrated"):
        describe_rig(path, given)
    assert path.read_text() == before


def test_nothing_and_a_file_without_a_camera_are_refused(tmp_path):
    with pytest.raises(InputError, match="Say something"):
        describe_rig(tmp_path / "rig.toml", Described())
    with pytest.raises(InputError, match="has no camera yet"):
        describe_rig(tmp_path / "rig.toml", Described(window_mm=30.0, glass_mm=8.0))
    with pytest.raises(FormatError):
        describe_rig(tmp_path / "rig.toml", Described(**CAMERA, baseline_mm=0.0, angle_deg=65.0))
    assert not (tmp_path / "rig.toml").exists()
