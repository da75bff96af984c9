"""What a calibration is worth, in plain words, and what to photograph next."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .board.coverage import cover
from .calibration import Calibration
from .laser import sheet_of
from .mount import circles_of
from .precision import ANGLE_SIGMA, SHAPE, precisions_of
from .region import LocalError, errors_where_seen
from .words import contradicts_prior, describe, silent_parameters

_VIEWS = 15
"""Views asked for, as in the paper."""
_COVERAGE = 0.5
"""Share of the picture that the corners shall have been in."""
_RMS = 0.5
"""RMS above which corners were not found well [px]."""
RATIO = 1.5
"""Farthest over nearest board that a port is asked for: at one distance it looks like a lens."""
_EXPLAINED = 4.0
"""Dispersion from which the model does not explain the photos: errors twice those of the noise."""
WIDTH = 0.1
"""Spread of the boards' distances over their mean that a laser is asked for."""
_INLIERS = 0.9
"""Share of the stripe points that shall agree with one sheet."""
_CLOSURE = 0.01
"""Closure up to which a mount is good, over the distance of the board."""


@dataclass(frozen=True)
class CalibrationVerdict:
    """A judgement."""

    advice: tuple[str, ...]
    """What is wrong and what to do, one sentence or two each; none if all is well."""
    praise: str
    """What to say if all is well."""
    errors: tuple[LocalError, ...] = ()
    """The error that is left, where boards were."""
    is_usable: bool = True
    """Whether what was found may be scanned with."""

    @property
    def is_good(self) -> bool:
        """Tell whether nothing is left to be wished for."""
        return self.is_usable and not self.advice

    def __str__(self) -> str:
        """Say it."""
        if self.is_good:
            return self.praise
        return ("Usable, but: " if self.is_usable else "Not usable: ") + " ".join(self.advice)


def judge(calibration: Calibration) -> CalibrationVerdict:
    """Judge any step of a calibration: first what it is good for, then what to do better."""
    errors = errors_where_seen(calibration)
    own = {"camera": _on_camera, "port": _on_port, "laser": _on_laser, "mount": _on_mount}
    misfit = tuple(_on_misfit(calibration))
    advice = (
        *misfit,
        *_on_photos(calibration),
        *own[calibration.step](calibration, errors),
        *_on_fit(calibration),
    )
    return CalibrationVerdict(advice, f"Good: {say_errors(errors)}.", errors, not misfit)


def corners_misfit(rms: float, focal_length: float) -> bool:
    """Tell whether corners are off by more than a sheet's direction may be.

    Rays of a camera that is off by so much do not measure what was asked of the sheet, whatever
    the deviations say: those hold for a model that explains the photos.

    Args:
        rms: Root mean square distance of corners from their projections [px].
        focal_length: The camera's [px].
    """
    return rms > ANGLE_SIGMA * focal_length


def say_errors(errors: Sequence[LocalError]) -> str:
    """Say what error is left, of each thing nearest to farthest, where boards were seen."""
    parts = []
    for what in dict.fromkeys(error.what for error in errors):
        mine = [e for e in errors if e.what == what and np.isfinite(e.sigma)]
        places = ", ".join(f"{e.sigma * 1e3:.2g} mm at {e.depth * 1e3:.0f} mm" for e in mine)
        parts.append(f"{what} is known to ± {places}")
    return "; ".join(parts) + " (1σ), in the part of the picture where boards were"


def _on_misfit(calibration: Calibration) -> Iterator[str]:
    """Say where the boards' corners do not fit at all, so that nothing else of it holds."""
    focal_length, depth = calibration.rig.camera.focal_length[0], float(np.mean(calibration.depths))
    if corners_misfit(calibration.rms, focal_length):
        yield (
            f"The corners are off by {calibration.rms:.2f} px, which is "
            f"{calibration.rms / focal_length * depth * 1e3:.2g} mm at {depth * 1e3:.0f} mm: this "
            "camera did not see these boards so, and what is stated below does not hold. Check "
            "that focus, zoom and picture size are those of the camera's calibration, that window "
            "and [water] are as the rig file says, and that the board is flat and its corners are "
            "counted right."
        )


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
    (focal,) = precisions_of(calibration, errors)
    if not focal.is_good:
        yield (
            f"The focal length is known to {focal.sigma:.1%} only; take photos with the board "
            "tilted more, 20 to 40 degrees to every side."
        )


def _on_port(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[str]:
    near, middle, far = errors
    if far.depth < RATIO * near.depth:
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
    if middle.sigma > SHAPE * middle.depth:
        yield (
            f"At {middle.depth * 1e3:.0f} mm shapes are known to {middle.sigma * 1e3:.2g} mm only; "
            "add photos with the board tilted, near, and out to the corners of the picture."
        )


def _on_laser(calibration: Calibration, errors: Sequence[LocalError]) -> Iterator[str]:
    for number in calibration.lasers:
        fit = sheet_of(calibration, number)
        near, far = fit.reach
        if far - near < WIDTH * (far + near) / 2:
            yield (
                f"The boards stood only {near * 1e3:.0f} to {far * 1e3:.0f} mm away; add "
                "photos nearer and farther, over all of the distances that you will scan at."
            )
        if fit.angle_sigma > ANGLE_SIGMA:
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
    turn, shift = precisions_of(calibration, errors)
    if not turn.is_good:
        yield (
            f"The camera's direction is known to {np.degrees(turn.sigma):.2f} degrees only, which "
            f"is {turn.sigma * 1e3:.1f} mm per metre of range; add photos."
        )
    if not shift.is_good:
        yield (
            f"The camera's place is known to {shift.sigma * 1e3:.2f} mm only; add photos with the "
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
    focal_length = calibration.rig.camera.focal_length[0]
    if calibration.rms > _RMS and not corners_misfit(calibration.rms, focal_length):
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
