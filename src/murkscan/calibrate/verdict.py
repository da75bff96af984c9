"""What a calibration is worth, in plain words, and what to photograph next."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .camera import PARAMETERS, CameraCalibration
from .coverage import coverage_of
from .sheet import SheetFit

_VIEWS = 15
"""Views asked for, as in the paper."""
_COVERAGE = 0.5
"""Share of the picture that the corners shall have been in."""
_RMS = 0.5
"""RMS above which corners were not found well [px]."""
_FOCAL_SIGMA = 0.01
"""Standard deviation of the focal length, over itself, up to which it is good: 1 % of scale."""
_ANGLE_SIGMA = np.radians(0.2)
"""Standard deviation of the sheet's direction up to which it is good: 2 mm at half a metre from
the boards [rad]."""
_WIDTH = 0.1
"""Spread of the boards' distances over their mean that is asked for."""
_INLIERS = 0.9
"""Share of the stripe points that shall agree with one sheet."""


@dataclass(frozen=True)
class CalibrationVerdict:
    """A judgement."""

    advice: tuple[str, ...]
    """What is wrong and what to do, one sentence or two each; none if all is well."""
    praise: str
    """What to say if all is well."""

    @property
    def is_good(self) -> bool:
        """Tell whether nothing is left to be wished for."""
        return not self.advice

    def __str__(self) -> str:
        """Say it."""
        return self.praise if self.is_good else "Usable, but: " + " ".join(self.advice)


def judge_camera(calibration: CameraCalibration) -> CalibrationVerdict:
    """Judge a camera's calibration."""
    advice = []
    count = len(calibration.views)
    if count < _VIEWS:
        advice.append(f"{count} views are few; take {_VIEWS} or more.")
    coverage = coverage_of(calibration)
    if coverage.share < _COVERAGE:
        advice.append(
            f"The corners cover only {coverage.share:.0%} of the picture; take photos with the "
            f"board {coverage.emptiest_place}."
        )
    focal_sigma = calibration.sigma[0] / calibration.camera.focal_length[0]
    if focal_sigma > _FOCAL_SIGMA:
        advice.append(
            f"The focal length is known to {focal_sigma:.1%} only; take photos with the board "
            "tilted more, 20 to 40 degrees to every side."
        )
    if calibration.rms > _RMS:
        advice.append(
            f"The corners are off by {calibration.rms:.2f} px; check that the board is flat and "
            "the photos are sharp."
        )
    advice += advise_on_left_out([view.name for view in calibration.left_out])
    return CalibrationVerdict(
        tuple(advice),
        f"Good: the focal length is known to {focal_sigma:.2%}, and corners cover "
        f"{coverage.share:.0%} of the picture.",
    )


def advise_on_left_out(names: Sequence[str]) -> list[str]:
    """Say which photos fitted too badly to count, if there are any."""
    if not names:
        return []
    return [f"{', '.join(names)} fitted far worse than the others and was left out; look at it."]


def judge_sheet(calibration: SheetFit) -> CalibrationVerdict:
    """Judge a sheet from stripes on boards."""
    advice = []
    count = len(calibration.stripes)
    if count < _VIEWS:
        advice.append(f"{count} photos with a stripe are few; take {_VIEWS} or more.")
    nearest, farthest = distances_of(calibration)
    if farthest - nearest < _WIDTH * (farthest + nearest) / 2:
        advice.append(
            f"The boards stood only {nearest * 1e3:.0f} to {farthest * 1e3:.0f} mm away; add "
            "photos nearer and farther, over all of the distances that you will scan at."
        )
    if calibration.angle_sigma > _ANGLE_SIGMA:
        advice.append(
            f"The sheet's direction is known to {np.degrees(calibration.angle_sigma):.2f} degrees "
            "only; add photos nearer and farther."
        )
    share = calibration.num_inliers / calibration.num_points
    if share < _INLIERS:
        advice.append(
            f"Only {share:.0%} of the stripe points agree with one sheet; look for photos in which "
            "something else than the laser's line was taken for it."
        )
    return CalibrationVerdict(
        tuple(advice),
        f"Good from {nearest * 1e3:.0f} to {farthest * 1e3:.0f} mm, where the boards were: the "
        f"sheet's direction is known to {np.degrees(calibration.angle_sigma):.2f} degrees.",
    )


def distances_of(calibration: SheetFit) -> tuple[float, float]:
    """Give the nearest and the farthest depth z at which the stripe was seen on a board [m]."""
    depths = [
        points[mask, 2].mean()
        for points, mask in zip(calibration.points, calibration.inliers, strict=True)
        if mask.any()
    ]
    return float(min(depths)), float(max(depths))


def name_sigma(calibration: CameraCalibration) -> dict[str, float]:
    """Give the standard deviation of each parameter by its name."""
    return {name: float(sigma) for name, sigma in zip(PARAMETERS, calibration.sigma, strict=True)}
