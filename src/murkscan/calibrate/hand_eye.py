"""Where the camera sits on the vehicle, from photos of a board that stands still and logged poses.

The board stands still in the world, so each photo closes a circle::

    world ── world_from_vehicle (the log) ──▶ vehicle ── vehicle_from_camera ──▶ camera
      └───────────────── world_from_board ─────────────────▶ board ◀── seen by ────┘
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..errors import InputError, NotConverged, NotEnoughData
from ..optics import refractive_index
from ..types.arrays import Scalars, Vector
from ..types.camera import Camera
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from ..types.trajectory import Trajectory
from .board import Chessboard
from .hand_eye_clock import ANGLES_AGREE, ClockCheck, check_clock
from .hand_eye_fit import HandEyeFit, HandEyeProblem, Photographed
from .hand_eye_rig import join_covariance, pull_to_measured
from .hand_eye_start import solve_hand_eye
from .hand_eye_weak import refuse_no_turns, refuse_undetermined
from .logged import LogSampler
from .seen_board import locate_seen_board
from .view import BoardView

MIN_PHOTOS = 4
"""Photos below which no mount is calibrated: three determine it, the fourth tells whether well."""
_OUTLIER = 4.0
"""A photo whose RMS is so many times the median is left out."""
_MAX_OUTLIERS = 0.25
"""Share of the photos that may be left out."""
_CLOCK_OFF = 0.3
"""Offset of the clock from which it is refused, not estimated [s]: nobody's clock is off by that
without a mistake that the user should know of."""
_MAX_CLOSURE = 0.05
"""Closure over the distance of the board above which log and photos do not belong together."""


@dataclass(frozen=True, eq=False)
class MeasuredPlace:
    """Where the optical centre sits on the vehicle, as measured with a ruler or a drawing."""

    translation: Vector
    """Optical centre in the vehicle's frame [m]."""
    sigma: float
    """Standard deviation of each of the three [m]."""

    def __post_init__(self) -> None:
        """Refuse what is no measurement."""
        if not (self.sigma > 0 and np.isfinite(self.translation).all()):
            raise InputError(
                "A measured place needs three numbers and a standard deviation above 0, got "
                f"{self.translation * 1e3} and {self.sigma * 1e3:g} mm."
            )


@dataclass(frozen=True, eq=False)
class MountCalibration:
    """A mount, and what it is worth."""

    vehicle_from_camera: Pose
    """The mount."""
    world_from_board: Pose
    """Where the board stood."""
    rig_covariance: RigCovariance
    """Of the rig's parameters and of `MOUNT_PARAMETERS`, the last six."""
    views: tuple[BoardView, ...]
    """The views that it was calibrated on."""
    residuals: tuple[Float[np.ndarray, "_ 2"], ...]
    """Corner as found minus corner as projected, of each view [px]."""
    closures: Float[np.ndarray, "..."]
    """How far from its place each photo sees the middle of the board, in the world [m]."""
    turns: Float[np.ndarray, "..."]
    """How far from its attitude each photo sees the board [rad]."""
    left_out: tuple[BoardView, ...]
    """Views left out, since they fit far worse than the others."""
    clock_offset: float | None
    """What must be added to the photos' times [s]; None where the photos do not tell."""
    clock_sigma: float | None
    """Its standard deviation [s]."""
    distance: float
    """Median distance of the board [m]."""

    @property
    def sigma(self) -> Scalars:
        """Standard deviation of each of `MOUNT_PARAMETERS` [m], [rad]."""
        return self.rig_covariance.sigma[-6:]

    @property
    def closure(self) -> float:
        """Root mean square of the closures [m]."""
        return float(np.sqrt(np.mean(self.closures**2)))

    @property
    def turn(self) -> float:
        """Root mean square of the turns [rad]."""
        return float(np.sqrt(np.mean(self.turns**2)))

    @property
    def view_rms(self) -> tuple[float, ...]:
        """Root mean square distance of a corner from its projection, of each view [px]."""
        return tuple(float(np.sqrt(np.mean(np.sum(r**2, axis=1)))) for r in self.residuals)

    @property
    def rms(self) -> float:
        """Root mean square distance of a corner from its projection [px]."""
        return float(np.sqrt(np.mean(np.sum(np.concatenate(self.residuals) ** 2, axis=1))))


def calibrate_mount(
    views: Sequence[BoardView],
    times: Scalars,
    log: Trajectory,
    board: Chessboard,
    rig: Rig,
    *,
    measured: MeasuredPlace | None = None,
) -> MountCalibration:
    """Calibrate vehicle_from_camera on photos of one board that stands still.

    Vehicle poses are never as exact as corners, so each photo counts as one measurement of six
    numbers, however many corners it shows.

    Args:
        views: The views; those in which the board was not found are passed over.
        times: When each was taken, by the log's clock [s].
        log: Poses world_from_vehicle.
        board: The board.
        rig: The rig with its camera, port and water; an older mount is not looked at.
        measured: Where the camera sits, for what the photos do not tell.

    Raises:
        NotEnoughData: The board was found in fewer than four photos.
        InputError: The log does not cover the photos, or its clock is off by more than 0.3 s.
        NotConverged: Log and photos do not belong together.
        Degenerate: The vehicle turned too little, or about one axis only, so that the photos do
            not tell all of the mount; the message says what.

    References:
        Park and Martin 1994 for the start; Strobl and Hirzinger, Optimal hand-eye calibration,
        IROS 2006, for adjusting what was seen.
    """
    index = refractive_index(rig.water, rig.wavelength)
    photos = _gather(views, times, log, board, rig.camera, index)
    sampler = LogSampler(log)
    poses = [photo.camera_from_board for photo in photos]
    clock = check_clock(np.array([photo.time for photo in photos]), sampler, poses)
    _refuse_clock(clock)
    refuse_no_turns([photo.logged(sampler) for photo in photos])
    problem = HandEyeProblem(photos, sampler, board, rig.camera, index)
    problem, fit, left_out = _fit_without_outliers(problem)
    _refuse_foreign_log(fit, clock)
    refuse_undetermined(fit, measured_sigma=None if measured is None else measured.sigma)
    mount, covariance = fit.poses[0], join_covariance(rig, problem, fit)
    if measured is not None:
        mount, covariance = pull_to_measured(
            mount, covariance, measured.translation, measured.sigma
        )
        fit = fit.with_mount(mount)
    closures, turns = fit.closures()
    return MountCalibration(
        vehicle_from_camera=mount,
        world_from_board=fit.poses[1],
        rig_covariance=covariance,
        views=tuple(photo.view for photo in fit.photos),
        residuals=fit.residuals,
        closures=closures,
        turns=turns,
        left_out=left_out,
        clock_offset=None if fit.clock_sigma is None else fit.clock_offset,
        clock_sigma=fit.clock_sigma,
        distance=fit.distance,
    )


def _gather(
    views: Sequence[BoardView],
    times: Scalars,
    log: Trajectory,
    board: Chessboard,
    camera: Camera,
    index: float | None,
) -> tuple[Photographed, ...]:
    found = [i for i, view in enumerate(views) if view.is_found]
    if len(found) < MIN_PHOTOS:
        raise NotEnoughData(
            f"The mount needs the {board} board in at least {MIN_PHOTOS} photos, better 15, found "
            f"it in {len(found)} of {len(views)}. Take photos of the whole board, standing still, "
            "with the vehicle turned another way in each."
        )
    first, last = times[found].min(), times[found].max()
    if first < log.times[0] or last > log.times[-1]:
        raise InputError(
            f"The photos were taken from {first:.3f} to {last:.3f} s but the log of poses runs "
            f"from {log.times[0]:.3f} to {log.times[-1]:.3f} s. Say with --start-time when the "
            "recording began, or shift its clock with --time-offset-s."
        )
    return tuple(
        Photographed(
            views[i], float(times[i]), locate_seen_board(views[i].corners, board, camera, index)
        )
        for i in found
    )


def _refuse_clock(clock: ClockCheck) -> None:
    is_better = 2 * clock.best_misfit < clock.misfit
    if not (is_better and abs(clock.best_offset) > _CLOCK_OFF):
        return
    raise InputError(
        f"The log's clock is off: from photo to photo the camera turned otherwise than the vehicle "
        f"by {np.degrees(clock.misfit):.1f} degrees in the median, but by "
        f"{np.degrees(clock.best_misfit):.1f} if {clock.best_offset:+.2f} s are added to the "
        f"photos' times. Find out why, or give --time-offset-s {clock.best_offset:.2f} on top of "
        "the offset that you gave."
    )


def _refuse_foreign_log(fit: HandEyeFit, clock: ClockCheck) -> None:
    closures, turns = fit.closures()
    closure, turn = float(np.median(closures)), float(np.median(turns))
    distance = fit.distance
    if closure <= _MAX_CLOSURE * distance and turn <= _MAX_CLOSURE:
        return
    inverse = (
        "The angles from photo to photo agree, so the log may hold vehicle_from_world where "
        "world_from_vehicle is asked for, or its positions another unit than metres."
        if clock.misfit <= ANGLES_AGREE
        else "Is it the log of this recording, the quaternion in the order w x y z, and did the "
        "board stand still?"
    )
    raise NotConverged(
        f"The log and the photos do not belong together: with the best mount the board still moves "
        f"by {closure * 1e3:.1f} mm and {np.degrees(turn):.1f} degrees from photo to photo, at "
        f"{distance * 1e3:.0f} mm. {inverse}"
    )


def _fit_without_outliers(
    problem: HandEyeProblem,
) -> tuple[HandEyeProblem, HandEyeFit, tuple[BoardView, ...]]:
    """Fit, and fit again without the worst photo while that stands out from the others."""
    left_out = list[BoardView]()
    num_photos = len(problem.photos)
    may_leave_out = min(int(_MAX_OUTLIERS * num_photos), num_photos - MIN_PHOTOS)
    start = solve_hand_eye(
        [photo.logged(problem.log) for photo in problem.photos],
        [photo.camera_from_board for photo in problem.photos],
    )
    fit = problem.fit(start)
    while len(left_out) < may_leave_out:
        worst = int(np.argmax(fit.view_rms))
        if fit.view_rms[worst] <= _OUTLIER * np.median(fit.view_rms):
            break
        left_out.append(problem.photos[worst].view)
        problem = problem.without(worst)
        fit = problem.fit(fit.poses)
    return problem, fit, tuple(left_out)
