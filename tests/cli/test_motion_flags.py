"""How well a motion is known: by a flag, by the rig file, else as the docs say."""

from dataclasses import replace

import pytest

from murkscan.cli.options import MotionFlags
from murkscan.errors import InputError
from murkscan.types.navigation import NavigationAccuracy

from ..scenes import air_rig

KNOWN = replace(air_rig(), navigation=NavigationAccuracy(speed=0.05, attitude_noise=0.01))


@pytest.mark.parametrize(
    ("flags", "rig", "sigma"),
    [
        (MotionFlags(speed_mm_s=100.0), air_rig(), 0.1),
        (MotionFlags(step_mm=1.0), air_rig(), 0.01),
        (MotionFlags(speed_mm_s=100.0), KNOWN, 0.05),
        (MotionFlags(step_mm=1.0, speed_sigma_percent=0.2), KNOWN, 0.002),
        (MotionFlags(speed_mm_s=100.0, speed_sigma_percent=0.0), KNOWN, 0.0),
    ],
)
def test_the_flag_goes_before_the_rig_file_and_that_before_the_usual(flags, rig, sigma):
    assert flags.make(rig, 0).sigma == pytest.approx(sigma)


def test_a_log_has_the_accuracy_of_the_rig_file_and_no_other(tmp_path, capsys):
    log = tmp_path / "log.csv"
    log.write_text("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,1,0,0,1,0,0,0\n")
    assert MotionFlags(poses=log).make(KNOWN, 0).stated is KNOWN.navigation
    assert MotionFlags(poses=log).make(air_rig(), 0).accuracy == ""
    with pytest.raises(InputError, match="--speed-sigma-percent goes with --speed-mm-s"):
        MotionFlags(poses=log, speed_sigma_percent=5.0).check()


def test_a_dive_of_which_a_speed_is_given_is_as_good_as_that_speed(tmp_path, capsys):
    log = tmp_path / "dive.csv"
    rows = [f"{k / 10},0,0,{10 * k / 100},5" for k in range(100)]
    log.write_text("\n".join(["time_s,roll_deg,pitch_deg,heading_deg,depth_m", *rows]) + "\n")
    stated = MotionFlags(navigation=log, speed_mm_s=100.0).make(KNOWN, 0).stated
    assert (stated.speed, stated.attitude_noise, stated.position_noise) == (0.05, 0.01, None)
    assert MotionFlags(navigation=log, speed_mm_s=100.0).make(air_rig(), 0).stated.speed == 0.1
