"""What the calibration of a laser is worth, in plain words, and what to photograph next."""

from .laser import LaserCalibration
from .limits import silent_parameters
from .reach import point_sigma, reach_of
from .verdict import CalibrationVerdict, judge_sheet

_EXPLAINED = 4.0
"""Dispersion from which the model does not explain the photos: errors twice those of the noise."""


def judge_laser(calibration: LaserCalibration) -> CalibrationVerdict:
    """Judge a laser's calibration."""
    found = calibration.adjustment
    sheet = judge_sheet(calibration.fit)
    advice = list(sheet.advice)
    silent = silent_parameters(found, calibration.wanted)
    if silent:
        advice.append(
            f"The photos tell nothing of {', '.join(silent)}: it is as it was given, and its error "
            "is in the covariance."
        )
    if found.worth.dispersion > _EXPLAINED:
        advice.append(
            "Whole photos disagree by more than their points' noise; check that the board is flat, "
            "and that nothing moved between the photos."
        )
    if calibration.is_camera_kept:
        advice.append(
            "The boards in these photos contradict the camera as it was calibrated, by more than "
            "its deviations allow; it was left as it is. Check that focus and zoom are the same "
            "and the board is flat, or calibrate the camera on these photos too."
        )
    if not any(name.startswith("camera.") for name in found.rig.covariance.names):
        advice.append(
            "The camera states no covariance and was taken as exact; calibrate it again with "
            "`murkscan calibrate camera`."
        )
    depth = reach_of(found.camera_from_boards, calibration.sightings)[1]
    sigma = point_sigma(found.rig, calibration.number, depth)
    return CalibrationVerdict(
        tuple(advice),
        f"{sheet.praise} A point {depth * 1e3:.0f} mm away is known to {sigma * 1e3:.2g} mm.",
    )
