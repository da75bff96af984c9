"""Where the camera sits on the vehicle, from photos of a board that stands still and logged poses.

The log is one more block of residuals in the adjustment that finds cameras, ports and lasers: each
photo's board has a pose of its own, seen by its corners and by the log, and vehicle poses are never
as exact as corners, so each photo counts as one measurement of six numbers.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ..errors import InputError, NotConverged, NotEnoughData
from ..optics import project
from ..types.arrays import Scalars, Vector
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from ..types.trajectory import Trajectory
from .adjust.log import CLOCK, MAX_CLOCK_SIGMA, STAND, LoggedPoses, LogSampler, Stand
from .adjust.observations import Sighting, index_of
from .adjust.parameters import MOUNT
from .adjust.priors import join
from .adjust.solve import Adjustment, adjust, rms_of
from .board.chessboard import Chessboard
from .board.pose import locate_seen_board
from .board.view import BoardView
from .calibration import MIN_VIEWS, Calibration, find_outlier
from .clock import ANGLES_AGREE, ClockCheck, check_clock
from .hand_eye import mean_pose, solve_hand_eye
from .turns import refuse_no_turns, refuse_undetermined

_OUTLIER = 4.0
"""A photo whose RMS is so many times the median is left out."""
_CLOCK_OFF = 0.3
"""Offset of the clock from which it is refused, not estimated [s]: nobody's clock is off by that
without a mistake that the user should know of."""
_MAX_CLOSURE = 0.05
"""Closure over the distance of the board above which log and photos do not belong together."""
_MAX_INTERVAL = 0.5
"""Time between the log's poses above which it does not say how the vehicle moved in between [s]."""
_VAGUE = 10.0
"""Standard deviation of what nothing is known of [m], [rad], [s]: what no photo tells is then found
to be open, rather than singular."""


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
class Circles:
    """How well the circle of each photo closes: world, vehicle, camera, board, world."""

    closures: Float[np.ndarray, "..."]
    """How far from its place each photo sees the middle of the board [m]."""
    turns: Float[np.ndarray, "..."]
    """How far from its attitude each photo sees the board [rad]."""
    residuals: tuple[Float[np.ndarray, "_ 2"], ...]
    """Corner as found minus corner where the log has it, of each photo [px]."""
    distance: float
    """Median distance of the board from the camera [m]."""

    @property
    def closure(self) -> float:
        """Root mean square of the closures [m]."""
        return float(np.sqrt(np.mean(self.closures**2)))

    @property
    def turn(self) -> float:
        """Root mean square of the turns [rad]."""
        return float(np.sqrt(np.mean(self.turns**2)))


def calibrate_mount(
    views: Sequence[BoardView],
    times: Scalars,
    log: Trajectory,
    board: Chessboard,
    rig: Rig,
    *,
    measured: MeasuredPlace | None = None,
) -> Calibration:
    """Calibrate vehicle_from_camera on photos of one board that stands still.

    The camera is taken as it is; its errors go into the mount's covariance.

    Args:
        views: The views; those without the board are passed over, and those cut off by the
            picture: which of its corners they show is not known.
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
    sightings, taken = _gather(views, times, log, board, rig)
    logged = LoggedPoses(LogSampler(log), taken)
    clock = check_clock(taken, logged.log, [s.camera_from_board for s in sightings])
    _refuse_clock(clock)
    refuse_no_turns(logged.log.poses_at(taken))
    left_out = list[str]()
    while True:
        found = _adjust(rig, sightings, logged, measured)
        calibration = Calibration.of("mount", found, MOUNT, sightings)
        calibration = replace(calibration, left_out=tuple(left_out), logged=logged)
        circles = circles_of(calibration)
        view_rms = [rms_of(residuals) for residuals in circles.residuals]
        worst = find_outlier(view_rms, len(left_out), outlier=_OUTLIER)
        if worst is None:
            break
        left_out.append(sightings.pop(worst).name)
        logged = replace(logged, times=np.delete(logged.times, worst))
    _refuse_foreign_log(circles, clock)
    refuse_undetermined(
        found.worth.covariance.select(MOUNT),
        logged.log.poses_at(logged.times),
        distance=circles.distance,
        is_place_measured=measured is not None,
    )
    return calibration


def circles_of(calibration: Calibration) -> Circles:
    """Follow the circle of each photo of a mount's calibration."""
    rig, stand, logged = calibration.rig, calibration.adjustment.stand, calibration.logged
    mount = rig.vehicle_from_camera
    assert mount is not None
    assert stand is not None
    assert logged is not None
    shifts, turns, residuals, distances = [], [], [], []
    for seen, by_log in zip(calibration.sightings, logged.boards(mount, stand), strict=True):
        off = by_log.inverse() @ seen.camera_from_board
        middle = seen.points.mean(axis=0)
        shifts.append(np.linalg.norm(off @ middle[None] - middle))
        turns.append(np.linalg.norm(Rotation.from_matrix(off.rotation).as_rotvec()))
        projected = project(rig.camera, by_log @ seen.points, index_of(rig))
        residuals.append(seen.corners - np.nan_to_num(projected, nan=1e3))
        distances.append(np.linalg.norm(seen.camera_from_board @ middle[None]))
    return Circles(np.array(shifts), np.array(turns), tuple(residuals), float(np.median(distances)))


def _adjust(
    rig: Rig,
    sightings: Sequence[Sighting],
    logged: LoggedPoses,
    measured: MeasuredPlace | None,
) -> Adjustment:
    """Adjust mount, board and, where the log is dense enough and tells it, its clock."""
    camera_from_boards = [s.camera_from_board for s in sightings]
    vehicles = logged.log.poses_at(logged.times)
    mount = solve_hand_eye(vehicles, camera_from_boards)
    sigmas = dict.fromkeys((*MOUNT, *STAND, CLOCK), _VAGUE)
    if measured is not None:
        mount = Pose(mount.rotation, measured.translation)
        sigmas |= dict.fromkeys(MOUNT[:3], measured.sigma)
    places = [v @ mount @ board for v, board in zip(vehicles, camera_from_boards, strict=True)]
    others = rig.covariance.without("mount.")
    start = replace(rig, vehicle_from_camera=mount, covariance=others)

    def solve(names: Sequence[str]) -> Adjustment:
        own = RigCovariance(tuple(names), np.diag([sigmas[name] ** 2 for name in names]))
        found = adjust(
            start, sightings, names, prior=join(others, own), considered=others.names,
            logged=logged, stand=Stand(mean_pose(places)),
        )  # fmt: skip
        covariance = found.rig.covariance.select((*others.names, *MOUNT))
        return replace(found, rig=replace(found.rig, covariance=covariance))

    if logged.log.interval <= _MAX_INTERVAL:
        timed = solve((*MOUNT, *STAND, CLOCK))
        if timed.sigma[-1] <= MAX_CLOCK_SIGMA:
            return timed
    return solve((*MOUNT, *STAND))


def _gather(
    views: Sequence[BoardView], times: Scalars, log: Trajectory, board: Chessboard, rig: Rig
) -> tuple[list[Sighting], Float[np.ndarray, "..."]]:
    """Locate the board in each photo; refuse too few, and a log of another time."""
    found = [i for i, view in enumerate(views) if view.is_found and view.is_placed]
    if len(found) < MIN_VIEWS:
        raise NotEnoughData(
            f"The mount needs the {board} board in at least {MIN_VIEWS} photos, better 15, found "
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
    sightings = []
    for view in (views[i] for i in found):
        points = view.places(board.points())
        pose = locate_seen_board(view.corners, points, rig.camera, index_of(rig))
        sightings.append(Sighting(view.name, view.corners, points, pose))
    return sightings, times[found]


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


def _refuse_foreign_log(circles: Circles, clock: ClockCheck) -> None:
    closure, turn = float(np.median(circles.closures)), float(np.median(circles.turns))
    distance = circles.distance
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
