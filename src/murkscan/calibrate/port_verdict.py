"""What the calibration of a port is worth, in plain words, and what to photograph next."""

import numpy as np

from ..types.arrays import Pixels
from .coverage import cover
from .limits import as_read, contradicts_prior, silent_parameters
from .port import PortCalibration
from .reach import reach_of, shape_sigma
from .verdict import CalibrationVerdict

_VIEWS, _COVERAGE, _RMS = 15, 0.5, 0.5
"""Views, share of the picture, and RMS [px] that are asked for, as for a camera."""
_RATIO = 1.5
"""Farthest over nearest board that is asked for: at one distance a port looks like a lens."""
_SHAPE = 5e-4
"""Error of shape over the range up to which a port is good."""
_EXPLAINED = 4.0
"""Dispersion from which the model does not explain the photos: errors twice those of the noise."""


def judge_port(calibration: PortCalibration) -> CalibrationVerdict:
    """Judge a port's calibration."""
    found, rig = calibration.adjustment, calibration.rig
    near, middle, far = reach_of(found.camera_from_boards, calibration.sightings)
    coverage = cover(_corners(calibration), rig.camera.size)
    advice = []
    if len(calibration.sightings) < _VIEWS:
        advice.append(f"{len(calibration.sightings)} views are few; take {_VIEWS} or more.")
    if coverage.share < _COVERAGE:
        advice.append(
            f"The corners cover only {coverage.share:.0%} of the picture; take photos with the "
            f"board {coverage.emptiest_place}."
        )
    if far < _RATIO * near:
        advice.append(
            f"All boards stood {near * 1e3:.0f} to {far * 1e3:.0f} mm away; add photos nearer and "
            "farther: at one distance a port looks like a lens."
        )
    advice += [
        f"The photos tell nothing of {name}: it is as it was given."
        for name in silent_parameters(found, calibration.wanted)
    ]
    if calibration.rms > _RMS:
        advice.append(
            f"The corners are off by {calibration.rms:.2f} px; check that the board is flat, the "
            "photos are sharp, and the kind and the glass of the port are right."
        )
    if found.worth.dispersion > _EXPLAINED:
        advice.append(
            "Whole photos disagree by more than their corners' noise; check that the board is "
            "flat, and that nothing moved between the photos."
        )
    if contradicts_prior(found):
        advice.append(
            "The photos contradict what was known before, the camera as calibrated in air or what "
            "was measured, by more than the deviations allow; check the kind, thickness and glass "
            "of the port, the [water], the board's squares, and that focus and zoom are the same."
        )
    share = shape_sigma(rig, middle) / middle
    if share > _SHAPE:
        advice.append(
            f"At {middle * 1e3:.0f} mm shapes are known to {share * middle * 1e3:.2g} mm only; add "
            "photos with the board tilted, near, and out to the corners of the picture."
        )
    if calibration.left_out:
        advice.append(
            f"{', '.join(calibration.left_out)} fitted far worse than the others and was left out; "
            "look at it."
        )
    if not any(name.startswith("camera.focal") for name in found.names):
        advice.append(
            "The camera states no covariance and was taken as exact; calibrate it with `murkscan "
            "calibrate camera` first."
        )
    sigma = found.rig.covariance.select([calibration.wanted[2]]).sigma[0]
    return CalibrationVerdict(
        tuple(advice),
        f"Good: the port's place is known to {as_read('camera.port.distance', float(sigma))}, and "
        f"shapes {near * 1e3:.0f} to {far * 1e3:.0f} mm away to {share:.3%} of the range.",
    )


def _corners(calibration: PortCalibration) -> Pixels:
    return np.concatenate([sighting.corners for sighting in calibration.sightings])
