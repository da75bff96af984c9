"""A flat sheet of laser light from stripes on boards: where its adjustment starts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from ..errors import Degenerate, NotEnoughData
from ..geometry.plane_fit import PlaneFit, fit_plane
from ..types.arrays import Points, Vector
from ..types.camera import Camera
from ..types.laser import Laser
from ..types.plane import Plane
from .board.stripe import StripeOnBoard

MIN_PHOTOS = 2
"""Photos with a stripe below which there is no sheet: one shows a line only."""
_PER_PHOTO = 20
"""Points of a photo that decide where the sheet is looked for, or as many as the shortest stripe
has, if that is more."""
_REACH = 4.0
"""Standard deviations within which a point belongs to the sheet."""
_MIN_WIDTH = 0.02
"""Width of the stripes' points across the line, over their distance, below which boards are in one
place: 8 mm at 0.4 m, where a stripe is off by some 0.2 mm already."""
_MAX_ANGLE_SIGMA = np.radians(1.0)
"""Standard deviation of the sheet's direction above which it is not determined [rad]: 9 mm at half
a metre from the boards."""


@dataclass(frozen=True, eq=False)
class SheetFit:
    """A flat sheet, and the stripes on boards that it passes through."""

    sheet: Plane
    """The sheet, in the camera frame; its normal points to + of the laser's axis. Of a sheet bent
    by a port, the plane nearest to it."""
    stripes: tuple[StripeOnBoard, ...]
    """The stripes that it was calibrated on."""
    points: tuple[Float[np.ndarray, "_ 3"], ...]
    """Their points in the camera frame [m]."""
    residuals: tuple[Float[np.ndarray, "..."], ...]
    """Distance of each point from the sheet [m], signed; from the bent one where it is bent."""
    inliers: tuple[Bool[np.ndarray, "..."], ...]
    """Which points the sheet was fitted to."""
    angle_sigma: float
    """Standard deviation of the sheet's direction [rad]."""

    @property
    def laser(self) -> Laser:
        """The laser of this sheet."""
        return Laser.from_sheet(self.sheet)

    @property
    def rms(self) -> float:
        """Root mean square distance of the inliers from the sheet [m]."""
        distances = np.concatenate(self.residuals)[np.concatenate(self.inliers)]
        return float(np.sqrt(np.mean(distances**2)))

    @property
    def num_points(self) -> int:
        """Count the points."""
        return sum(len(points) for points in self.points)

    @property
    def num_inliers(self) -> int:
        """Count the points that the sheet was fitted to."""
        return sum(int(mask.sum()) for mask in self.inliers)

    @property
    def reach(self) -> tuple[float, float]:
        """Nearest and farthest depth z at which the stripe was seen on a board [m]."""
        depths = [
            points[mask, 2].mean()
            for points, mask in zip(self.points, self.inliers, strict=True)
            if mask.any()
        ]
        return float(min(depths)), float(max(depths))

    @property
    def view_rms(self) -> tuple[float, ...]:
        """Root mean square distance of all points of each photo from the sheet [m]."""
        return tuple(float(np.sqrt(np.mean(d**2))) for d in self.residuals)


def fit_sheet(
    stripes: Sequence[StripeOnBoard], camera: Camera, index: float | None = None
) -> SheetFit:
    """Fit a flat sheet to stripes on boards, with camera and boards as they are.

    Args:
        stripes: Stripes, one a photo; those of length 0 are passed over.
        camera: The camera that took the photos.
        index: Refractive index of what lies outside the camera's port; of no effect without one.

    Raises:
        NotEnoughData: Fewer than two photos show a stripe.
        Degenerate: The boards stood nearly in one place, so that the sheet can turn about the
            stripe.

    References:
        Zhou and Zhang, Complete calibration of a structured light stripe vision sensor through
        planar target of unknown orientations, Image and Vision Computing 23(1), 2005, for the use
        of a board; Efron 1982 for the jackknife.
    """
    used = tuple(stripe for stripe in stripes if len(stripe.pixels) > 0)
    if len(used) < MIN_PHOTOS:
        raise NotEnoughData(
            f"The sheet needs a stripe on the board's paper in {MIN_PHOTOS} photos or more, better "
            f"15, found it in {len(used)} of {len(stripes)}; a single one shows a line, through "
            "which any sheet fits. Take photos with the line across the board, near and far, and "
            "say how far its paper runs on beyond the squares."
        )
    points = tuple(stripe.points(camera, index) for stripe in used)
    fit = _fit_photos_alike(points)
    ends = np.cumsum([len(p) for p in points])[:-1]
    inliers = tuple(np.split(fit.inliers, ends))
    angle_sigma = _angle_sigma(fit, [p[m] for p, m in zip(points, inliers, strict=True)])
    _refuse_one_place(fit, np.concatenate(points), angle_sigma, len(used))
    sheet = _turn_to_axis(fit.plane)
    residuals = tuple(sheet.distance_to(p) for p in points)
    return SheetFit(sheet, used, points, residuals, inliers, angle_sigma)


def _fit_photos_alike(points: Sequence[Float[np.ndarray, "_ 3"]]) -> PlaneFit:
    """Fit a plane to photos that count alike, however long the stripe is in each.

    Boards near the camera show most of the points, on nearly one line; any plane through that
    would have half of all points.
    """
    count = max(min(map(len, points)), _PER_PHOTO)
    few = [p[np.linspace(0, len(p) - 1, min(len(p), count)).astype(int)] for p in points]
    fit = fit_plane(np.concatenate(few))
    distances = fit.plane.distance_to(np.concatenate(points))
    return PlaneFit(fit.plane, distances, np.abs(distances) <= max(_REACH * fit.rms, 1e-9))


def _turn_to_axis(sheet: Plane) -> Plane:
    """Turn the normal to + of the laser's axis, as that of a sheet made from b and θ is."""
    if sheet.normal["xy".index(Laser.from_sheet(sheet).axis)] >= 0:
        return sheet
    return Plane(-sheet.normal, -sheet.distance)


def _widths(points: Points) -> Vector:
    """Give the standard deviation of points along their three main directions [m]."""
    around = points - points.mean(axis=0)
    return np.linalg.svd(around, compute_uv=False) / np.sqrt(len(points))


def _angle_sigma(fit: PlaneFit, points: Sequence[Float[np.ndarray, "... 3"]]) -> float:
    """Give the standard deviation of the sheet's direction [rad].

    The larger of two: as if each photo told the sheet's place once, with the RMS of all, and the
    jackknife over photos. The points of one photo share the error of its board's pose.
    """
    points = [p for p in points if len(p) > 0]
    formal = fit.rms / (_widths(np.concatenate(points))[1] * np.sqrt(len(points)))
    if len(points) < 4:
        return float(formal)
    turns = []
    for left_out in range(len(points)):
        rest = np.concatenate([p for i, p in enumerate(points) if i != left_out])
        normal = np.linalg.svd(rest - rest.mean(axis=0), full_matrices=False)[2][2]
        turns.append(np.arccos(min(1.0, abs(float(normal @ fit.plane.normal)))))
    jackknife = np.sqrt((len(points) - 1) / len(points) * np.sum(np.square(turns)))
    return float(max(formal, jackknife))


def _refuse_one_place(fit: PlaneFit, points: Points, angle_sigma: float, num_photos: int) -> None:
    inside = points[fit.inliers]
    width = _widths(inside)[1]
    distance = float(np.mean(np.linalg.norm(inside, axis=1)))
    if width >= _MIN_WIDTH * distance and angle_sigma <= _MAX_ANGLE_SIGMA:
        return
    raise Degenerate(
        f"The stripes of the {num_photos} photos lie nearly on one line ({width * 1e3:.1f} mm wide "
        f"at {distance * 1e3:.0f} mm), so the sheet can turn about it by "
        f"{np.degrees(angle_sigma):.1f} degrees. Take photos with the board nearer and farther, "
        "over all of the distances that you will scan at."
    )
