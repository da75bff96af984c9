"""Windows, water and fans in rig files."""

import numpy as np
import pytest

from murkscan.errors import FormatError
from murkscan.io.rig_toml import as_tables, load_rig, save_calibration, save_rig
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan
from murkscan.types.port import DomePort, FlatPort, Layer
from murkscan.types.rig import Rig

RIG = """format = 1

[camera]
size = [720, 576]
focal_length = [554.0, 554.8]
principal_point = [359.5, 287.5]

[camera.port]                   # acrylic
kind = "flat"
normal = [0.0, 0.0, 2.0]
distance_mm = 30.0
thickness_mm = 8.0
glass_index = 1.49

[[laser]]
kind = "fan"
origin_mm = [0.0, -250.0, 10.0]
direction = [0.0, 0.24, 0.97]
tangent = [1.0, 0.0, 0.0]
half_angle_deg = 30.0

[laser.port]
kind = "dome"
radius_mm = 40.0
thickness_mm = 5.0
glass_index = 1.52
centre_mm = [0.0, -250.0, 12.0]

[water]
temperature_c = 12.0
salinity_psu = 35.0
depth_m = 4.0
"""
LAYERS = """kind = "layers"
normal = [0.0, 0.1, 1.0]
distance_mm = 30.0
[[camera.port.layer]]
thickness_mm = 6.0
index = 1.49
[[camera.port.layer]]
thickness_mm = 2.5
index = 1.0
"""
FLAT = RIG[RIG.index('kind = "flat"') : RIG.index("[[laser]]")]


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(RIG)
    return path


def test_ports_fan_and_water_of_the_contract_are_read(file):
    rig = load_rig(file)
    port, fan = rig.camera.port, rig.lasers[0].sheet
    assert isinstance(port, FlatPort)
    assert (port.distance, port.layers) == (0.03, (Layer(0.008, 1.49),))
    np.testing.assert_array_equal(port.normal, [0, 0, 1])
    assert isinstance(fan, Fan)
    assert isinstance(fan.port, DomePort)
    # The file gives the dome's centre in the camera frame, the value from the fan's origin.
    np.testing.assert_allclose(fan.port.centre, [0, 0, 0.002], atol=1e-15)
    assert np.linalg.norm(fan.direction) == pytest.approx(1)
    assert rig.lasers[0].axis == "y"
    assert (rig.water.temperature_c, rig.water.salinity_psu, rig.water.depth) == (12, 35, 4)


def test_layers_are_read_from_inside_out(file):
    file.write_text(RIG.replace(FLAT, LAYERS))
    assert load_rig(file).camera.port.layers == (Layer(0.006, 1.49), Layer(0.0025, 1.0))


@pytest.mark.parametrize("port", [FLAT, LAYERS])
def test_a_rig_with_windows_there_and_back_is_the_same(file, tmp_path, port):
    file.write_text(RIG.replace(FLAT, port))
    rig = load_rig(file)
    save_rig(tmp_path / "copy.toml", rig)
    copy = load_rig(tmp_path / "copy.toml")
    assert as_tables(copy) == as_tables(rig)
    assert set(as_tables(rig)) >= {"camera", "laser", "water"}


def test_a_new_camera_keeps_its_port(file):
    camera = Camera((720, 576), (600.0, 600.0), (360.0, 288.0))
    save_calibration(file, Rig(camera), ["camera"], record={})
    assert "# acrylic" in file.read_text()
    assert load_rig(file).camera.focal_length == (600.0, 600.0)
    assert load_rig(file).camera.port.distance == 0.03


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("distance_mm = 30.0", "distance_mm = -30.0", "camera.port.distance_mm.*inside the lens"),
        ("glass_index = 1.49", "glass_index = 0.9", "camera.port.glass_index"),
        ("thickness_mm = 8.0", "thickness_mm = -8.0", "camera.port.thickness_mm"),
        ("[0.0, 0.0, 2.0]", "[0.0, 0.0, 0.0]", "camera.port.normal has length 0"),
        ("[0.0, 0.0, 2.0]", "[0.0, 0.0, -1.0]", "camera.port.normal.*forwards"),
        ('"flat"', '"bent"', "camera.port.kind"),
        ("glass_index = 1.49", "index = 1.49", "camera.port.index is unknown"),
        ("[0.0, -250.0, 12.0]", "[0.0, -200.0, 12.0]", "laser.0.port.centre_mm.*inside the lens"),
        ("[1.0, 0.0, 0.0]", "[0.0, 0.24, 0.97]", "laser.0.*across its direction"),
        ("half_angle_deg = 30.0", "half_angle_deg = 95.0", "laser.0.*half angle"),
        ("salinity_psu = 35.0", "salinity_psu = 350", "water.salinity_psu"),
        ("temperature_c = 12.0", "temperature_c = 68", "water.temperature_c"),
        ("depth_m = 4.0", "index = 1.34", "water.index is given together with"),
        ("salinity_psu = 35.0\n", "", "water.salinity_psu is missing"),
        ("depth_m = 4.0", "depth_m = nan", "water.depth_m"),
    ],
)
def test_what_cannot_be_names_the_key(file, old, new, says):
    file.write_text(RIG.replace(old, new, 1))
    with pytest.raises(FormatError, match=says) as error:
        load_rig(file)
    assert str(file) in str(error.value)


def test_water_is_its_index_where_that_was_measured(file):
    file.write_text(RIG[: RIG.index("temperature_c")] + "index = 1.3371\n")
    assert load_rig(file).water.index == 1.3371
