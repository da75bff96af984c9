"""What [calibration] in the rig file says of a step: when, in what, on what, how good."""

import datetime
from typing import Any

import numpy as np

from .adjust.parameters import INTRINSICS, MOUNT
from .board.chessboard import Chessboard
from .calibration import Calibration
from .laser import sheet_of
from .mount import circles_of
from .verdict import CalibrationVerdict

_SHORT = ("fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3")
"""What a camera's record calls its parameters."""


def record_step(
    calibration: Calibration,
    verdict: CalibrationVerdict,
    board: Chessboard,
    num_photos: int,
    tables: dict[str, Any],
) -> dict[str, Any]:
    """Record a step: the setting, the photos, their residuals, and how sure the answer is.

    Args:
        calibration: What was found.
        verdict: What it is worth.
        board: The board.
        num_photos: Photos that could be read.
        tables: The rig file as it was; its [water] is what the photos were taken in.
    """
    found = calibration.adjustment
    own = {"camera": _of_camera, "port": _of_port, "laser": _of_lasers, "mount": _of_mount}
    return {
        "date": datetime.date.today(),
        "water": tables.get("water", "air"),
        "board": str(board),
        "square_mm": round(board.square * 1e3, 6),
        "photos": num_photos,
        "verdict": str(verdict),
        "errors": [
            {
                "what": e.what,
                "distance_mm": _round(e.depth * 1e3),
                "sigma_mm": _round(e.sigma * 1e3),
            }
            for e in verdict.errors
            if np.isfinite(e.sigma)
        ],
        "views": len(calibration.sightings),
        "left_out": list(calibration.left_out),
        "rms_px": _round(found.rms),
        "view_rms_px": [_round(value) for value in found.view_rms],
        "corner_sigma_px": _round(found.corner_sigma),
        "dispersion": _round(found.worth.dispersion),
        **own[calibration.step](calibration),
    }


def _of_camera(calibration: Calibration) -> dict[str, Any]:
    covariance = calibration.rig.covariance.select(INTRINSICS)
    return {
        "sigma": dict(zip(_SHORT, map(_round, covariance.sigma.tolist()), strict=True)),
        "parameters": list(_SHORT),
        # Of parameters that nearly vary as one, little is left but the last digits.
        "covariance": [[float(f"{c:.9g}") for c in row] for row in covariance.matrix.tolist()],
    }


def _of_port(calibration: Calibration) -> dict[str, Any]:
    covariance = calibration.rig.covariance
    sigma = map(_round, covariance.sigma.tolist())
    return {"sigma": dict(zip(covariance.names, sigma, strict=True))}


def _of_lasers(calibration: Calibration) -> dict[str, Any]:
    """Record the stripes, how far they are off their sheets, and the sheets' directions."""
    fits = [sheet_of(calibration, number) for number in calibration.lasers]
    inside = np.concatenate(
        [d[m] for f in fits for d, m in zip(f.residuals, f.inliers, strict=True)]
    )
    return _of_port(calibration) | {
        "points": sum(fit.num_points for fit in fits),
        "inliers": sum(fit.num_inliers for fit in fits),
        "rms_mm": _round(float(np.sqrt(np.mean(inside**2))) * 1e3),
        "view_rms_mm": [_round(rms * 1e3) for fit in fits for rms in fit.view_rms],
        "angle_sigma_deg": _round(float(np.degrees(max(fit.angle_sigma for fit in fits)))),
    }


def _of_mount(calibration: Calibration) -> dict[str, Any]:
    """Record how the circles close; the covariance stands with that of the whole rig."""
    circles, sigma = circles_of(calibration), calibration.rig.covariance.select(MOUNT).sigma
    record = {
        "closure_mm": _round(circles.closure * 1e3),
        "closure_deg": _round(float(np.degrees(circles.turn))),
        "view_closure_mm": [_round(closure * 1e3) for closure in circles.closures.tolist()],
        "translation_sigma_mm": [_round(s * 1e3) for s in sigma[:3].tolist()],
        "turn_sigma_deg": [_round(float(np.degrees(s))) for s in sigma[3:].tolist()],
    }
    stand = calibration.adjustment.stand
    if calibration.clock_sigma is not None and stand is not None:
        record["clock_offset_s"] = _round(stand.clock_offset)
        record["clock_sigma_s"] = _round(calibration.clock_sigma)
    return record


def _round(value: float) -> float:
    return float(f"{value:.4g}")
