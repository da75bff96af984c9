from dataclasses import replace

import numpy as np
import pytest

from murkscan.report.trust import judge_trust
from murkscan.types.camera import Camera
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance

BARE = Rig(Camera((640, 480), (800.0, 800.0), (320.0, 240.0)))
STATED = replace(BARE, covariance=RigCovariance(("camera.focal_length[0]",), np.eye(1)))


def test_both_parts_add_as_squares():
    trust = judge_trust(np.full(2, 3e-3), np.full(2, 4e-3), STATED)
    assert trust.total.median == pytest.approx(5e-3)
    assert trust.common.median == pytest.approx(4e-3)


def test_a_rig_without_covariance_has_an_unknown_common_part_not_a_zero_one():
    assert judge_trust(np.array([1e-3]), np.zeros(1), BARE).common is None
