"""What a calibration is worth, in plain words, and what to photograph next."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .adjust.parameters import MOUNT
from .board.coverage import cover
from .calibration import Calibration
from .laser import sheet_of
from .mount import circles_of
from .region import LocalError, errors_where_seen
from .words import contradicts_prior, describe, silent_parameters

_VIEWS = 15
"""Views asked for, as in the paper."""
_COVERAGE = 0.5
"""Share of the picture that the corners shall have been in."""
_RMS = 0.5
"""RMS above which corners were not found well [px]."""
_FOCAL_SIGMA = 0.01
"""Standard deviation of the focal length, over itself, up to which it is good: 1 % of scale."""
_RATIO = 1.5
"""Farthest over nearest board that a port is asked for: at one distance it looks like a lens."""
_SHAPE = 5e-4
"""Error of shape over the range up to which a port is good."""
_EXPLAINED = 4.0
"""Dispersion from which the model does not explain the photos: errors twice those of the noise."""
_ANGLE_SIGMA = np.radians(0.2)
"""Standard deviation of a sheet's direction, or of a mount's turn, up to which it is good [rad]:
2 mm at half a metre from the boards."""
_WIDTH = 0.1
"""Spread of the boards' distances over their mean that a laser is asked for."""
_INLIERS = 0.9
"""Share of the stripe points that shall agree with one sheet."""
_CLOSURE = 0.01
"""Closure up to which a mount is good, over the distance of the board."""
_SHIFT_SIGMA = 0.005
"""Standard deviation of a mount's translation up to which it is good, over that distance."""


@dataclass(frozen=True)
class CalibrationVerdict:
    """A judgement."""

    advice: tuple[str, ...]
    """What is wrong and what to do, one sentence or two each; none if all is well."""
    praise: str
    """What to say if all is well."""
    errors: tuple[LocalError, ...] = ()
    """The error that is left, where boards were."""

    @property
    def is_good(self) -> bool:
        """Tell whether nothing is left to be wished for."""
        return not self.advice

    def __str__(self) -> str:
        """Say it."""
        return self.praise if self.is_good else "Usable, but: " + " ".join(self.advice)


def judge(calibration: Calibration) -> CalibrationVerdict:
    """Judge any step of a calibration: first what it is good for, then what to do better."""
    errors = errors_where_seen(calibration)
    own = {"camera": _on_camera, "port": _on_port, "laser": _on_laser, "mount": _on_mount}
    advice = (
        *_on_photos(calibration),
        *own[calibration.step](calibration, errors),
        *_on_fit(calibration),
    )
    return CalibrationVerdict(advice, f"Good: {say_errors(errors)}.", errors)


def say_errors(errors: Sequence[LocalError]) -> str:
    """Say what error is left, of each thing nearest to farthest, where boards were seen."""
    parts = []
    for what in dict.fromkeys(error.what for error in errors):
        mine = [e for e in errors if e.what == what and np.isfinite(e.sigma)]
        places = ", ".join(f"{e.sigma * 1e3:.2g} mm at {e.depth * 1e3:.0f} mm" for e in mine)
        parts.append(f"{what} is known to ± {places}")
    return "; ".join(parts) + " (1σ), in the part of the picture where boards were"


def _on_photos(calibration: Calibration) -> Iterator[str]:
    """Say what to photograph next."""
    count = len(calibration.sightings)
    if count < _VIEWS:
        yield f"{count} photos are few; take {_VIEWS} or more."
    coverage = cover(calibration.corners, calibration.rig.camera.size)
    if calibration.step in ("camera", "port") and coverage.share < _COVERAGE:
        yield (
            f"The corners cover only {coverage.share:.0%} of the picture, and outside of it "
            f"nothing is known; take photos with the board {coverage.emptiest_place}."
        )


def _on_camera(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[str]:
    focal_sigma = calibration.sigma[0] / calibration.rig.camera.focal_length[0]
    if focal_sigma > _FOCAL_SIGMA:
        yield (
            f"The focal length is known to {focal_sigma:.1%} only; take photos with the board "
            "tilted more, 20 to 40 degrees to every side."
        )


def _on_port(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[str]:
    near, middle, far = errors
    if far.depth < _RATIO * near.depth:
        yield (
            f"All boards stood {near.depth * 1e3:.0f} to {far.depth * 1e3:.0f} mm away; add photos "
            "nearer and farther: at one distance a port looks like a lens."
        )
    if contradicts_prior(calibration.adjustment):
        yield (
            "The photos contradict what was known before, the camera as calibrated in air or what "
            "was measured, by more than the deviations allow; check the kind, thickness and glass "
            "of the port, the [water], the board's squares, and that focus and zoom are the same."
        )
    if middle.sigma > _SHAPE * middle.depth:
        yield (
            f"At {middle.depth * 1e3:.0f} mm shapes are known to {middle.sigma * 1e3:.2g} mm only; "
            "add photos with the board tilted, near, and out to the corners of the picture."
        )


def _on_laser(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[str]:
    for number in calibration.lasers:
        fit = sheet_of(calibration, number)
        near, far = fit.reach
        if far - near < _WIDTH * (far + near) / 2:
            yield (
                f"The boards stood only {near * 1e3:.0f} to {far * 1e3:.0f} mm away; add "
                "photos nearer and farther, over all of the distances that you will scan at."
            )
        if fit.angle_sigma > _ANGLE_SIGMA:
            yield (
                f"The sheet's direction is known to {np.degrees(fit.angle_sigma):.2f} degrees "
                "only; add photos nearer and farther."
            )
        share = fit.num_inliers / fit.num_points
        if share < _INLIERS:
            yield (
                f"Only {share:.0%} of the stripe points agree with one sheet; look for photos in "
                "which something else than the laser's line was taken for it."
            )
    if calibration.is_camera_kept:
        yield (
            "The boards in these photos contradict the camera as it was calibrated, by more than "
            "its deviations allow; it was left as it is. Check that focus and zoom are the same "
            "and the board is flat, or calibrate the camera on these photos too."
        )


def _on_mount(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[str]:
    circles = circles_of(calibration)
    if circles.closure > _CLOSURE * circles.distance:
        yield (
            f"The board moves by {circles.closure * 1e3:.2f} mm from photo to photo at "
            f"{circles.distance * 1e3:.0f} mm; check that it stands still, and what the log is "
            "worth."
        )
    sigma = calibration.rig.covariance.select(MOUNT).sigma
    turn_sigma, shift_sigma = float(sigma[3:].max()), float(sigma[:3].max())
    if turn_sigma > _ANGLE_SIGMA:
        yield (
            f"The camera's direction is known to {np.degrees(turn_sigma):.2f} degrees only, which "
            f"is {turn_sigma * 1e3:.1f} mm per metre of range; add photos."
        )
    if shift_sigma > _SHIFT_SIGMA * circles.distance:
        yield (
            f"The camera's place is known to {shift_sigma * 1e3:.2f} mm only; add photos with the "
            "vehicle turned more, about two different axes."
        )


def _on_fit(calibration: Calibration) -> Iterator[str]:
    """Say where the photos disagree with the model, with one another, or with what was known."""
    found = calibration.adjustment
    silent = silent_parameters(found, calibration.wanted)
    if silent and calibration.step != "mount":
        yield (
            f"The photos tell nothing of the {', '.join(describe(found.rig, n) for n in silent)}: "
            "it is as it was given, and its error is in the covariance."
        )
    if calibration.step != "mount" and calibration.rms > _RMS:
        yield (
            f"The corners are off by {calibration.rms:.2f} px; check that the board is flat and "
            "the photos are sharp."
        )
    if calibration.step in ("port", "laser") and found.worth.dispersion > _EXPLAINED:
        yield (
            "Whole photos disagree by more than their points' noise; check that the board is flat, "
            "and that nothing moved between the photos."
        )
    names = found.rig.covariance.names
    if calibration.step != "mount" and not any(n.startswith("camera.focal") for n in names):
        yield (
            "The camera states no covariance and was taken as exact; calibrate it again with "
            "`murkscan calibrate camera`."
        )
    if calibration.left_out:
        left_out = ", ".join(calibration.left_out)
        yield f"{left_out} fitted far worse than the others and was left out; look at it."
