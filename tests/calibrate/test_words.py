from dataclasses import replace

import numpy as np
import pytest

from murkscan.calibrate.adjust.log import CLOCK, STAND
from murkscan.calibrate.words import describe
from murkscan.errors import InputError
from murkscan.optics.rig_parameters import parameters_of, tilt_directions
from murkscan.types.laser import Laser
from murkscan.types.plane import Plane
from murkscan.types.pose import Pose

from .underwater import DOME, FAN, FLAT, SHEET, rig_behind

MOUNTED = replace(rig_behind(FLAT, FAN), vehicle_from_camera=Pose.identity())


@pytest.mark.parametrize("rig", [rig_behind(DOME), MOUNTED], ids=["dome", "fan on a vehicle"])
def test_every_parameter_has_a_name_of_its_own_in_words(rig):
    names = (*parameters_of(rig), *STAND, CLOCK)
    words = [describe(rig, name) for name in names]
    assert len(set(words)) == len(names)
    assert not any("[" in word or "." in word for word in words)


def test_a_name_that_no_rig_has_is_refused():
    with pytest.raises(InputError, match=r"no parameter camera\.colour"):
        describe(rig_behind(None), "camera.colour")


@pytest.mark.parametrize("normal", [(1.0, 0.1, 0.3), (0.7, 0.0, 0.7), (0.05, 0.9, 0.4)])
def test_the_lean_of_a_sheet_is_the_tilt_that_moves_its_line_with_range(normal):
    sheet = Plane.through(np.array([-0.2, 0.0, 0.0]), np.array(normal))
    rig = replace(rig_behind(None, SHEET), lasers=(Laser.from_sheet(sheet),))
    words = [describe(rig, f"laser[0].normal[{i}]") for i in range(2)]
    assert sorted(words) == ["lean of laser 0's sheet", "roll of laser 0's sheet"]
    along_z = np.abs([way[2] for way in tilt_directions(sheet.normal)])
    assert words[int(np.argmax(along_z))].startswith("lean")
