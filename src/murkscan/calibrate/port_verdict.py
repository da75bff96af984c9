"""What the calibration of a port is worth, in plain words, and what to photograph next."""

from collections.abc import Iterator

import numpy as np

from ..types.arrays import Pixels
from .coverage import cover
from .limits import as_read, contradicts_prior, silent_parameters
from .port import PortCalibration
from .reach import reach_of, shape_sigma
from .verdict import CalibrationVerdict, advise_on_left_out

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
    rig, found = calibration.rig, calibration.adjustment
    near, middle, far = reach_of(found.camera_from_boards, calibration.sightings)
    share = shape_sigma(rig, middle) / middle
    sigma = found.rig.covariance.select([calibration.wanted[2]]).sigma[0]
    return CalibrationVerdict(
        (
            *_on_the_photos(calibration, near, far),
            *_on_the_fit(calibration),
            *_on_the_worth(calibration, middle, share),
        ),
        f"Good: the port's place is known to {as_read('camera.port.distance', float(sigma))}, and "
        f"shapes {near * 1e3:.0f} to {far * 1e3:.0f} mm away to {share:.3%} of the range.",
    )


def _on_the_photos(calibration: PortCalibration, near: float, far: float) -> Iterator[str]:
    """Say what to photograph next; near and far are the boards' distances [m]."""
    coverage = cover(_corners(calibration), calibration.rig.camera.size)
    if len(calibration.sightings) < _VIEWS:
        yield f"{len(calibration.sightings)} views are few; take {_VIEWS} or more."
    if coverage.share < _COVERAGE:
        yield (
            f"The corners cover only {coverage.share:.0%} of the picture; take photos with the "
            f"board {coverage.emptiest_place}."
        )
    if far < _RATIO * near:
        yield (
            f"All boards stood {near * 1e3:.0f} to {far * 1e3:.0f} mm away; add photos nearer and "
            "farther: at one distance a port looks like a lens."
        )


def _on_the_fit(calibration: PortCalibration) -> Iterator[str]:
    """Say where the photos disagree with the model, with one another, or with what was known."""
    found = calibration.adjustment
    for name in silent_parameters(found, calibration.wanted):
        yield f"The photos tell nothing of {name}: it is as it was given."
    if calibration.rms > _RMS:
        yield (
            f"The corners are off by {calibration.rms:.2f} px; check that the board is flat, the "
            "photos are sharp, and the kind and the glass of the port are right."
        )
    if found.worth.dispersion > _EXPLAINED:
        yield (
            "Whole photos disagree by more than their corners' noise; check that the board is "
            "flat, and that nothing moved between the photos."
        )
    if contradicts_prior(found):
        yield (
            "The photos contradict what was known before, the camera as calibrated in air or what "
            "was measured, by more than the deviations allow; check the kind, thickness and glass "
            "of the port, the [water], the board's squares, and that focus and zoom are the same."
        )


def _on_the_worth(calibration: PortCalibration, middle: float, share: float) -> Iterator[str]:
    """Say what limits the answer: `share` is the error of shape over the range `middle` [m]."""
    if share > _SHAPE:
        yield (
            f"At {middle * 1e3:.0f} mm shapes are known to {share * middle * 1e3:.2g} mm only; add "
            "photos with the board tilted, near, and out to the corners of the picture."
        )
    yield from advise_on_left_out(calibration.left_out)
    if not any(name.startswith("camera.focal") for name in calibration.adjustment.names):
        yield (
            "The camera states no covariance and was taken as exact; calibrate it with `murkscan "
            "calibrate camera` first."
        )


def _corners(calibration: PortCalibration) -> Pixels:
    return np.concatenate([sighting.corners for sighting in calibration.sightings])
