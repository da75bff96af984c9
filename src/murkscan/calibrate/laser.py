"""A laser's sheet from stripes on boards, adjusted together with the camera that saw them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError
from ..optics import distance_to_sheet, equivalent_plane
from ..types.laser import Fan, Laser
from ..types.plane import Plane
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .adjust import Adjustment, adjust
from .board import Chessboard
from .limits import contradicts_prior, refuse_open_parameters
from .observed import index_of
from .parameters import sheet_parameters, window_parameters, window_prior
from .port import indices_apart, join
from .sheet import SheetFit, StripeOnBoard, fit_sheet
from .sighting import Sighting
from .view import BoardView


@dataclass(frozen=True, eq=False)
class LaserCalibration:
    """A laser, and what it is worth."""

    fit: SheetFit
    """The stripes, and how far they are from the sheet."""
    adjustment: Adjustment
    """The rig with the laser, its covariance, and the residuals in pixels."""
    number: int
    """Number of the laser."""
    wanted: tuple[str, ...]
    """The parameters that the photos were taken for."""
    sightings: tuple[Sighting, ...]
    """The photos used, with the board where it was found to be."""
    is_camera_kept: bool
    """Whether the camera was left as it was, because these photos contradict it; its errors are
    in the covariance all the same."""

    @property
    def rig(self) -> Rig:
        """The rig with its new laser and its covariance."""
        return self.adjustment.rig

    @property
    def laser(self) -> Laser:
        """The laser."""
        return self.rig.lasers[self.number]


def calibrate_laser(
    stripes: Sequence[StripeOnBoard],
    views: Sequence[BoardView],
    board: Chessboard,
    rig: Rig,
    *,
    number: int = 0,
    fan: Fan | None = None,
    prior: RigCovariance | None = None,
    considered: RigCovariance | None = None,
) -> LaserCalibration:
    """Find a laser's sheet from its stripes on boards, in air or through the camera's port.

    The camera and its port are adjusted along, within their covariance; where they have none they
    are taken as exact. Where the boards contradict the camera they are not let near it: photos of
    a laser's line are often dark, or out of its focus.

    Args:
        stripes: Stripes, one a photo; those of length 0 are passed over.
        views: The boards in the same photos.
        board: The board.
        rig: The rig with its camera, and what it is in.
        number: Number of the laser that is new or replaced.
        fan: The fan as it was measured, to be turned until it fits; None for a flat sheet.
        prior: What is known beforehand of the fan's origin and port; as `window_prior` unless
            given.
        considered: What is neither found nor exact, such as the water's index.

    Raises:
        NotEnoughData: Fewer than two photos show a stripe.
        Degenerate: The boards stood nearly in one place, or a parameter is not determined.
        NotConverged: The adjustment came to no end.
    """
    index = index_of(rig)
    start = fit_sheet(stripes, rig.camera, index)
    laser = start.laser if fan is None else Laser.from_sheet(lay_fan(fan, start.sheet))
    rig = with_laser(rig, laser, number)
    prior = window_prior(laser, number) if prior is None else prior
    wanted = (*sheet_parameters(laser, number), *window_parameters(laser, number))
    known = join(join(rig.covariance, prior), considered)
    apart = indices_apart(known, wanted)
    names = (*wanted, *(n for n in known.names if n not in wanted and n not in apart))
    sightings = _sightings(start.stripes, views, board, number)
    found = adjust(rig, sightings, names, prior=known, considered=apart)
    is_camera_kept = contradicts_prior(found)
    if is_camera_kept:
        others = tuple(name for name in known.names if name not in wanted)
        found = adjust(rig, sightings, wanted, prior=known, considered=others)
    refuse_open_parameters(found)
    seen = tuple(
        replace(sighting, camera_from_board=pose)
        for sighting, pose in zip(sightings, found.camera_from_boards, strict=True)
    )
    return LaserCalibration(
        _measure(found, seen, number), found, number, wanted, seen, is_camera_kept
    )


def lay_fan(fan: Fan, plane: Plane) -> Fan:
    """Turn and shift a fan as little as possible, until its rays start out in a plane."""
    side = np.sign(fan.plane.normal @ plane.normal) or 1.0
    normal = side * plane.normal
    origin = fan.origin - (fan.origin @ normal + side * plane.distance) * normal
    direction = fan.direction - (fan.direction @ normal) * normal
    tangent = np.cross(normal, direction)
    if not np.linalg.norm(direction) > 0.5:
        raise InputError(
            "The fan in the rig file points across the sheet that the photos show; give its "
            "direction roughly, as it is built."
        )
    return Fan.spread(origin, direction, tangent, fan.half_angle, fan.port)


def with_laser(rig: Rig, laser: Laser, number: int) -> Rig:
    """Give the rig with this laser in place of its own, of which nothing is known any more."""
    lasers = (*rig.lasers[:number], laser, *rig.lasers[number + 1 :])
    return replace(rig, lasers=lasers, covariance=rig.covariance.without(f"laser[{number}]"))


def _sightings(
    stripes: Sequence[StripeOnBoard], views: Sequence[BoardView], board: Chessboard, number: int
) -> list[Sighting]:
    corners = {view.name: view.corners for view in views}
    flat = board.points()
    return [
        Sighting(s.name, corners[s.name], flat, s.camera_from_board, s.pixels, number)
        for s in stripes
    ]


def _measure(found: Adjustment, sightings: Sequence[Sighting], number: int) -> SheetFit:
    """Measure how far the stripes are from the adjusted sheet."""
    rig, index = found.rig, index_of(found.rig)
    laser = rig.lasers[number]
    stripes = tuple(StripeOnBoard(s.name, s.stripe, s.camera_from_board) for s in sightings)
    points = tuple(stripe.points(rig.camera, index) for stripe in stripes)
    turns = rig.covariance.select(_turns(laser, number)).matrix
    return SheetFit(
        sheet=equivalent_plane(laser, index),
        stripes=stripes,
        points=points,
        residuals=tuple(distance_to_sheet(p, laser, index) for p in points),
        inliers=tuple(shares == 1 for shares in found.stripe_shares),
        angle_sigma=float(np.sqrt(np.linalg.eigvalsh(turns)[-1])),
    )


def _turns(laser: Laser, number: int) -> list[str]:
    return [
        name for name in sheet_parameters(laser, number) if ".normal[" in name or ".turn[" in name
    ]
