from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.io.rig_toml import load_rig, save_rig
from murkscan.optics import parameters_of, perturb_rig, refractive_index
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan, Laser
from murkscan.types.plane import Plane
from murkscan.types.port import DomePort, FlatPort, Layer
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance
from murkscan.types.water import Water

FLAT = FlatPort(np.array([0.0, 0.0, 1.0]), 0.03, (Layer(0.008, 1.49),))
DOME = DomePort(np.array([0.001, 0.0, 0.002]), 0.05, 0.006, 1.49)
X, Z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
RIG = Rig(
    camera=Camera((720, 576), (554.0, 555.0), (359.5, 287.5), port=FLAT),
    lasers=(
        Laser.from_sheet(Plane.through(np.array([0.2, 0.0, 0.0]), np.array([0.9, 0.1, 0.4]))),
        Laser.from_sheet(Fan(-0.25 * X, Z, np.array([0.0, 1.0, 0.0]), 0.5, DOME)),
    ),
    water=Water(),
    vehicle_from_camera=Pose.identity(),
)


def test_every_parameter_of_a_rig_can_be_changed_and_changed_back():
    names = parameters_of(RIG)
    # Camera 9, flat port 5, plane 3, fan 6 with a dome of 6, mount 6, water 1.
    assert len(names) == len(set(names)) == 36
    changes = np.random.default_rng(0).uniform(-1e-4, 1e-4, len(names))
    back = perturb_rig(perturb_rig(RIG, names, changes), names, -changes)
    assert back.camera.focal_length == pytest.approx(RIG.camera.focal_length, abs=1e-12)
    # Turning there and back about axes that turned along leaves the square of the change.
    for found, truth in zip(back.lasers, RIG.lasers, strict=True):
        np.testing.assert_allclose(
            found.as_plane().normal if isinstance(found.sheet, Plane) else found.sheet.direction,
            truth.as_plane().normal if isinstance(truth.sheet, Plane) else truth.sheet.direction,
            atol=1e-7,
        )
    assert refractive_index(back.water, RIG.wavelength) == pytest.approx(
        refractive_index(RIG.water, RIG.wavelength), abs=1e-15
    )


def test_a_tilt_turns_a_port_that_faces_the_camera_towards_x_and_y():
    tilted = perturb_rig(
        RIG, ["camera.port.normal[0]", "camera.port.normal[1]"], np.array([0.03, 0])
    )
    np.testing.assert_allclose(tilted.camera.port.normal, [np.sin(0.03), 0, np.cos(0.03)])
    tilted = perturb_rig(RIG, ["camera.port.normal[1]"], np.array([0.03]))
    np.testing.assert_allclose(tilted.camera.port.normal, [0, np.sin(0.03), np.cos(0.03)])


def test_a_parameter_that_the_rig_has_not_is_refused_with_those_it_has():
    with pytest.raises(
        InputError, match=r"no parameter laser\[2\]\.distance; it has camera\.focal"
    ):
        perturb_rig(RIG, ["laser[2].distance"], np.array([1e-3]))


def test_the_rig_file_keeps_the_covariance_to_the_last_digit(tmp_path):
    random = np.random.default_rng(1)
    names = parameters_of(RIG)
    root = random.normal(size=(len(names), len(names))) * 10.0 ** random.uniform(-6, 0, len(names))
    save_rig(tmp_path / "rig.toml", replace(RIG, covariance=RigCovariance(names, root.T @ root)))
    found = load_rig(tmp_path / "rig.toml").covariance
    assert found.names == names
    np.testing.assert_array_equal(found.matrix, root.T @ root)


def test_what_is_no_covariance_is_refused():
    with pytest.raises(InputError, match="needs 2 different names"):
        RigCovariance(("a", "b"), np.eye(3))
    with pytest.raises(InputError, match="symmetric"):
        RigCovariance(("a", "b"), np.array([[1.0, 0.5], [0.1, 1.0]]))


def test_selecting_takes_what_is_not_known_as_exact():
    covariance = RigCovariance(("a", "b"), np.array([[4.0, 1.0], [1.0, 9.0]]))
    picked = covariance.select(["b", "c"])
    np.testing.assert_array_equal(picked.matrix, [[9.0, 0.0], [0.0, 0.0]])
    assert covariance.without("a").names == ("b",)
    assert covariance.correlation[0, 1] == pytest.approx(1 / 6)
