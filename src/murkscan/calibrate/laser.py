"""Lasers' sheets from stripes on boards, adjusted together with the camera that saw them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..errors import InputError
from ..optics import distance_to_sheet, equivalent_plane
from ..types.laser import Fan, Laser
from ..types.plane import Plane
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from .adjust.observations import Sighting, index_of
from .adjust.parameters import sheet_parameters, window_parameters, window_prior
from .adjust.priors import indices_apart, join
from .adjust.solve import adjust
from .board.chessboard import Chessboard
from .board.stripe import StripeOnBoard
from .board.view import BoardView
from .calibration import Calibration
from .sheet import SheetFit, fit_sheet
from .words import contradicts_prior, refuse_open_parameters


def calibrate_lasers(
    stripes: Sequence[StripeOnBoard],
    views: Sequence[BoardView],
    board: Chessboard,
    rig: Rig,
    *,
    numbers: Sequence[int] = (0,),
    fans: Mapping[int, Fan] | None = None,
    prior: RigCovariance | None = None,
    considered: RigCovariance | None = None,
) -> Calibration:
    """Find lasers' sheets from their stripes on boards, in air or through the camera's port.

    Several lasers on the same photos are one adjustment, so that the photos' boards count once. The
    camera and its port are adjusted along, within their covariance; where they have none they
    are taken as exact. Where the boards contradict the camera they are not let near it: photos of
    a laser's line are often dark, or out of its focus.

    Args:
        stripes: Stripes, at most one a photo and laser; those of length 0 are passed over.
        views: The boards in the same photos.
        board: The board.
        rig: The rig with its camera, and what it is in.
        numbers: Numbers of the lasers that are new or replaced.
        fans: The fans as they were measured, by number, to be turned until they fit; a laser
            without one is a flat sheet.
        prior: What is known beforehand of the fans' origins and ports; as `window_prior` unless
            given.
        considered: What is neither found nor exact, such as the water's index.

    Raises:
        NotEnoughData: Fewer than two photos show a stripe.
        Degenerate: The boards stood nearly in one place, or a parameter is not determined.
        NotConverged: The adjustment came to no end.
    """
    used, wanted, known = list[StripeOnBoard](), list[str](), prior
    for number in numbers:
        start = fit_sheet([s for s in stripes if s.laser == number], rig.camera, index_of(rig))
        fan = (fans or {}).get(number)
        laser = start.laser if fan is None else Laser.from_sheet(lay_fan(fan, start.sheet))
        rig = with_laser(rig, laser, number)
        used += start.stripes
        wanted += [*sheet_parameters(laser, number), *window_parameters(laser, number)]
        if prior is None:
            known = join(known or RigCovariance(), window_prior(laser, number))
    known = join(join(rig.covariance, known), considered)
    apart = indices_apart(known, wanted)
    names = (*wanted, *(n for n in known.names if n not in wanted and n not in apart))
    sightings = _sightings(used, views, board)
    found = adjust(rig, sightings, names, prior=known, considered=apart)
    is_camera_kept = contradicts_prior(found)
    if is_camera_kept:
        others = tuple(name for name in known.names if name not in wanted)
        found = adjust(rig, sightings, wanted, prior=known, considered=others)
    refuse_open_parameters(found)
    calibration = Calibration.of("laser", found, wanted, sightings)
    return replace(calibration, lasers=tuple(numbers), is_camera_kept=is_camera_kept)


def sheet_of(calibration: Calibration, number: int) -> SheetFit:
    """Measure how far a laser's stripes are from its adjusted sheet."""
    found, rig, index = calibration.adjustment, calibration.rig, index_of(calibration.rig)
    laser = rig.lasers[number]
    stripes, inliers = [], []
    for sighting, shares in zip(calibration.sightings, found.stripe_shares, strict=True):
        mine = np.broadcast_to(sighting.laser, len(sighting.stripe)) == number
        if mine.any():
            pixels = sighting.stripe[mine]
            pose = sighting.camera_from_board
            stripes.append(StripeOnBoard(sighting.name, pixels, pose, number))
            inliers.append(shares[mine] == 1)
    points = tuple(stripe.points(rig.camera, index) for stripe in stripes)
    turns = [n for n in sheet_parameters(laser, number) if ".normal[" in n or ".turn[" in n]
    return SheetFit(
        sheet=equivalent_plane(laser, index),
        stripes=tuple(stripes),
        points=points,
        residuals=tuple(distance_to_sheet(p, laser, index) for p in points),
        inliers=tuple(inliers),
        angle_sigma=float(np.sqrt(np.linalg.eigvalsh(rig.covariance.select(turns).matrix)[-1])),
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
    """Put a laser in place of another, or behind the last; nothing is known of it any more."""
    lasers = (*rig.lasers[:number], laser, *rig.lasers[number + 1 :])
    return replace(rig, lasers=lasers, covariance=rig.covariance.without(f"laser[{number}]"))


def _sightings(
    stripes: Sequence[StripeOnBoard], views: Sequence[BoardView], board: Chessboard
) -> list[Sighting]:
    """Join the stripes of each photo, and its corners."""
    by_name = {view.name: view for view in views}
    sightings = []
    for name in dict.fromkeys(stripe.name for stripe in stripes):
        mine = [stripe for stripe in stripes if stripe.name == name]
        sightings.append(
            Sighting(
                name,
                by_name[name].corners,
                by_name[name].places(board.points()),
                mine[0].camera_from_board,
                np.concatenate([stripe.pixels for stripe in mine]),
                np.repeat([s.laser for s in mine], [len(s.pixels) for s in mine]),
            )
        )
    return sightings
