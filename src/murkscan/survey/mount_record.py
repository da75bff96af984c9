"""What [calibration.mount] in the rig file says of a mount: how good, and by which photos."""

from typing import Any

import numpy as np

from ..calibrate.hand_eye import MountCalibration
from ..calibrate.verdict import CalibrationVerdict


def record_mount(calibration: MountCalibration, verdict: CalibrationVerdict) -> dict[str, Any]:
    """Record the photos of a mount, how they close, and how well it is known.

    The covariance stands with that of the whole rig, in [calibration.covariance].
    """
    shift, turn = calibration.sigma[:3], calibration.sigma[3:]
    record = {
        "verdict": str(verdict),
        "views": len(calibration.views),
        "left_out": [view.name for view in calibration.left_out],
        "closure_mm": _round(calibration.closure * 1e3),
        "closure_deg": _round(float(np.degrees(calibration.turn))),
        "view_closure_mm": [_round(closure * 1e3) for closure in calibration.closures.tolist()],
        "rms_px": _round(calibration.rms),
        "translation_sigma_mm": [_round(sigma * 1e3) for sigma in shift.tolist()],
        "turn_sigma_deg": [_round(float(np.degrees(sigma))) for sigma in turn.tolist()],
    }
    if calibration.clock_offset is not None and calibration.clock_sigma is not None:
        record["clock_offset_s"] = _round(calibration.clock_offset)
        record["clock_sigma_s"] = _round(calibration.clock_sigma)
    return record


def _round(value: float) -> float:
    return float(f"{value:.4g}")
