"""What [calibration] in the rig file says of a calibration: when, in what, on what, how good."""

import datetime
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..calibrate.adjust import Adjustment
from ..calibrate.board import Chessboard
from ..calibrate.camera import PARAMETERS, CameraCalibration
from ..calibrate.sheet import SheetFit
from ..calibrate.verdict import CalibrationVerdict, name_sigma


def record_setting(board: Chessboard, num_photos: int, tables: dict[str, Any]) -> dict[str, Any]:
    """Record the date, the water, the board and the photos.

    Args:
        board: The board.
        num_photos: Photos that could be read.
        tables: The rig file as it was; its [water] is what the photos were taken in.
    """
    return {
        "date": datetime.date.today(),
        "water": tables.get("water", "air"),
        "board": str(board),
        "square_mm": round(board.square * 1e3, 6),
        "photos": num_photos,
    }


def record_camera(calibration: CameraCalibration, verdict: CalibrationVerdict) -> dict[str, Any]:
    """Record the views of a camera, their residuals, and the covariance of its parameters."""
    return {
        "verdict": str(verdict),
        "views": len(calibration.views),
        "left_out": [view.name for view in calibration.left_out],
        "rms_px": round(calibration.rms, 4),
        "view_rms_px": [round(rms, 4) for rms in calibration.view_rms],
        "sigma": {name: _round(s, 4) for name, s in name_sigma(calibration).items()},
        "parameters": list(PARAMETERS),
        # Of parameters that nearly vary as one, little is left but the last digits.
        "covariance": [[_round(c, 9) for c in row] for row in calibration.covariance.tolist()],
    }


def record_adjustment(
    found: Adjustment, left_out: Sequence[str], verdict: CalibrationVerdict
) -> dict[str, Any]:
    """Record the photos of a joint adjustment, their residuals, and the deviations."""
    rms = [float(np.sqrt(np.mean(np.sum(r**2, axis=1)))) for r in found.corner_residuals]
    covariance = found.rig.covariance
    return {
        "verdict": str(verdict),
        "views": len(rms),
        "left_out": list(left_out),
        "corner_sigma_px": _round(found.corner_sigma, 4),
        "view_rms_px": [_round(value, 4) for value in rms],
        "dispersion": _round(found.worth.dispersion, 4),
        "sigma": {
            name: _round(float(sigma), 4)
            for name, sigma in zip(covariance.names, covariance.sigma, strict=True)
        },
    }


def record_laser(fit: SheetFit) -> dict[str, Any]:
    """Record the stripes of a laser, their residuals, and how well its direction is known."""
    return {
        "points": fit.num_points,
        "inliers": fit.num_inliers,
        "rms_mm": round(fit.rms * 1e3, 4),
        "view_rms_mm": [round(rms * 1e3, 4) for rms in fit.view_rms],
        "angle_sigma_deg": _round(float(np.degrees(fit.angle_sigma)), 4),
    }


def _round(value: float, digits: int) -> float:
    return float(f"{value:.{digits}g}")
