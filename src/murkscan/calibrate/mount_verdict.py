"""What a mount is worth, in plain words."""

import numpy as np

from .hand_eye import MountCalibration
from .verdict import CalibrationVerdict, advise_on_left_out

_PHOTOS = 15
"""Photos asked for."""
_CLOSURE = 0.01
"""Closure up to which a mount is good, over the distance of the board."""
_TURN_SIGMA = np.radians(0.2)
"""Standard deviation of the turn up to which it is good [rad]: 3.5 mm per metre of range."""
_SHIFT_SIGMA = 0.005
"""Standard deviation of the translation up to which it is good, over the distance of the board."""


def judge_mount(calibration: MountCalibration) -> CalibrationVerdict:
    """Judge a mount's calibration."""
    advice = []
    count, distance = len(calibration.views), calibration.distance
    if count < _PHOTOS:
        advice.append(f"{count} photos are few; take {_PHOTOS} or more.")
    if calibration.closure > _CLOSURE * distance:
        advice.append(
            f"The board moves by {calibration.closure * 1e3:.2f} mm from photo to photo at "
            f"{distance * 1e3:.0f} mm; check that it stands still, and what the log is worth."
        )
    turn_sigma, shift_sigma = float(calibration.sigma[3:].max()), float(calibration.sigma[:3].max())
    if turn_sigma > _TURN_SIGMA:
        advice.append(
            f"The camera's direction is known to {np.degrees(turn_sigma):.2f} degrees only, which "
            f"is {turn_sigma * 1e3:.1f} mm per metre of range; add photos."
        )
    if shift_sigma > _SHIFT_SIGMA * distance:
        advice.append(
            f"The camera's place is known to {shift_sigma * 1e3:.2f} mm only; add photos with the "
            "vehicle turned more, about two different axes."
        )
    advice += advise_on_left_out([view.name for view in calibration.left_out])
    return CalibrationVerdict(
        tuple(advice),
        f"Good: the circles close to {calibration.closure * 1e3:.2f} mm at "
        f"{distance * 1e3:.0f} mm, and the camera's direction is known to "
        f"{np.degrees(turn_sigma):.3f} degrees.",
    )
