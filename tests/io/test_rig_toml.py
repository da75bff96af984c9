"""Rig files: what users write comes in, what calibrate writes leaves the rest alone."""

import numpy as np
import pytest

from murkscan.errors import FormatError, InputError
from murkscan.io.rig_toml import as_tables, load_rig, parse_rig, save_calibration, save_rig
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane
from murkscan.types.rig import Rig

RIG = """# our first rig
format = 1
wavelength_nm = 650

[camera]                        # the cheap one
size = [640, 480]
focal_length = [850.4, 850.4]   # px
principal_point = [328, 239.5]

[[laser]]
kind = "baseline_angle"
baseline_mm = 37.3
angle_deg = 65.0
axis = "x"

[mount]                         # screwed on the frame
translation_mm = [100.0, 0.0, -50.0]
quaternion_wxyz = [1.0, 0.0, 0.0, 0.0]
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(RIG)
    return path


def test_a_rig_of_the_contract_is_read(file):
    rig = load_rig(file)
    assert rig.camera.size == (640, 480)
    assert rig.wavelength == pytest.approx(650e-9)
    assert rig.lasers[0].as_baseline_angle() == pytest.approx((0.0373, np.radians(65)))
    np.testing.assert_allclose(rig.vehicle_from_camera.translation, [0.1, 0, -0.05])


def test_a_rig_there_and_back_is_the_same(file, tmp_path):
    rig = load_rig(file)
    save_rig(tmp_path / "copy.toml", rig)
    copy = load_rig(tmp_path / "copy.toml")
    assert as_tables(copy) == as_tables(rig)
    assert as_tables(parse_rig(as_tables(rig), name="tables")) == as_tables(rig)


def test_a_new_camera_leaves_the_rest_and_its_comments_alone(file):
    camera = Camera((640, 480), (600.0, 601.0), (320.0, 240.0), np.array([0.1, 0, 0, 0, 0]))
    save_calibration(file, Rig(camera), ["camera"], record={"views": 20})
    text = file.read_text()
    for comment in ("# our first rig", "# the cheap one", "# screwed on the frame"):
        assert comment in text
    rig = load_rig(file)
    assert rig.camera.focal_length == (600.0, 601.0)
    assert rig.wavelength == pytest.approx(650e-9)
    assert len(rig.lasers) == 1


def test_a_camera_makes_a_rig_file_where_there_is_none(tmp_path):
    path = tmp_path / "new" / "rig.toml"
    camera = Camera((720, 576), (554.0, 554.8), (359.5, 287.5))
    save_calibration(path, Rig(camera), ["camera"], record={})
    assert load_rig(path).lasers == ()
    assert load_rig(path).wavelength == pytest.approx(532e-9)


def test_a_laser_is_replaced_or_added_but_leaves_no_gap(file):
    laser = Laser.from_sheet(Plane(np.array([0.0, 0.6, -0.8]), 0.1))
    save_calibration(file, load_rig(file), ["laser", "1"], record={}, lasers={1: laser})
    save_calibration(file, load_rig(file), ["laser", "0"], record={"views": 30}, lasers={0: laser})
    assert [laser.axis for laser in load_rig(file).lasers] == ["y", "y"]
    with pytest.raises(InputError, match="--laser 2"):
        save_calibration(file, load_rig(file), ["laser", "3"], record={}, lasers={3: laser})


INLINE = "laser = [{kind = 'plane', normal = [0, 0, 1], distance_mm = 5}]"


@pytest.mark.parametrize("written", ["", "laser = []", INLINE])
def test_a_laser_is_written_however_the_others_are(tmp_path, written):
    path = tmp_path / "rig.toml"
    camera = "[camera]\nsize = [6, 4]\nfocal_length = [5, 5]\nprincipal_point = [3, 2]\n"
    path.write_text(f"format = 1\n{written}\n{camera}")
    laser = Laser.from_sheet(Plane(np.array([0.0, 0.6, -0.8]), 0.1))
    rig = load_rig(path)
    count = len(rig.lasers)
    save_calibration(path, rig, ["laser", str(count)], record={}, lasers={count: laser})
    assert len(load_rig(path).lasers) == count + 1
    np.testing.assert_array_equal(load_rig(path).lasers[-1].sheet.normal, laser.sheet.normal)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("850.4,", "nan,", "camera.focal_length.0"),
        ("850.4,", "-850.4,", "camera.focal_length.0"),
        ("[640, 480]", "[640]", "camera.size"),
        ("axis =", "axes =", "laser.0.axes is unknown"),
        ('"baseline_angle"', '"beam"', "laser.0.kind"),
        ("format = 1", "format = 2", "format"),
        ("format = 1", "", "format is missing"),
        ("37.3", "0", "baseline"),
        ("[mount]", "[mont]", "mont is unknown"),
        ("[1.0, 0.0, 0.0, 0.0]", "[0, 0, 0, 0]", "quaternion"),
        ("[camera]", "[camera", "not a TOML file"),
    ],
)
def test_a_wrong_rig_names_the_file_and_the_key(file, old, new, says):
    file.write_text(RIG.replace(old, new))
    with pytest.raises(FormatError, match=says) as error:
        load_rig(file)
    assert str(file) in str(error.value)


def test_a_missing_rig_is_named(tmp_path):
    with pytest.raises(FormatError, match=r"no rig file .*nowhere\.toml"):
        load_rig(tmp_path / "nowhere.toml")


def test_a_camera_is_not_written_into_a_file_that_is_no_rig(tmp_path):
    path = tmp_path / "notes.toml"
    path.write_text('title = "not a rig"\n')
    camera = Camera((720, 576), (554.0, 554.8), (359.5, 287.5))
    with pytest.raises(FormatError, match="title"):
        save_calibration(path, Rig(camera), ["camera"], record={})
    assert path.read_text() == 'title = "not a rig"\n'


def test_the_accuracy_of_a_log_is_read_in_its_units_and_written_back(tmp_path):
    text = RIG + "\n[navigation]\nvelocity_noise_mm_s = 3.0\nheading_drift_deg_min = 0.5\n"
    (tmp_path / "rig.toml").write_text(text)
    rig = load_rig(tmp_path / "rig.toml")
    assert rig.navigation.velocity_noise == pytest.approx(3e-3)
    assert rig.navigation.heading_drift == pytest.approx(np.deg2rad(0.5) / 60)
    assert rig.navigation.depth_noise is None
    save_rig(tmp_path / "copy.toml", rig)
    assert load_rig(tmp_path / "copy.toml").navigation == rig.navigation


@pytest.mark.parametrize("line", ["velocity_noise_mm_s = 0", "speed_mm = 3"])
def test_an_accuracy_that_cannot_be_is_refused_by_its_key(tmp_path, line):
    (tmp_path / "rig.toml").write_text(RIG + f"\n[navigation]\n{line}\n")
    with pytest.raises(FormatError, match=f"navigation.{line.split()[0]}"):
        load_rig(tmp_path / "rig.toml")
