"""Where a flat marker lies: its corners in pictures, and the surface that the laser found there."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from ..errors import NotEnoughData
from ..geometry.intersect import intersect_rays_with_plane
from ..geometry.plane_fit import fit_plane
from ..optics import back_project, project, refractive_index
from ..types.arrays import Indices, Mask, Pixels, Points, Vector
from ..types.cloud import PointCloud
from ..types.plane import Plane
from ..types.rays import Rays
from ..types.rig import Rig
from ..types.trajectory import Trajectory

_ON_EITHER_SIDE = 12
"""Views before and after the line has crossed the marker, at most: what the poses drift by between
a view and the crossing is in the place."""
_STRAYS = 4.0
"""Distance from the middle of all over the usual one from which a view counts not: of Gaussian
errors in two directions, one view in 65 000."""
_FEWEST_VIEWS, _FEWEST_POINTS = 3, 20
_WIDE = 2.0
"""Angle from a marker's middle, over that to its corners, to which points are projected."""
_NEAR = 0.1
"""The same at least [rad]: a port stands aside of where rays leave the lens."""


@dataclass(frozen=True, eq=False)
class MarkerView:
    """A marker in one frame."""

    frame: int
    time: float
    """Recording time [s]."""
    corners: Float[np.ndarray, "4 2"]
    """Its corners in the order of going round it [px of the full frame]."""


@dataclass(frozen=True, eq=False)
class MarkerPlace:
    """Where a marker's middle lies on the model."""

    place: Vector
    """In the scan's world [m]."""
    sigma: float
    """Standard deviation along each axis [m]."""
    views: int
    """Pictures that it is the mean of."""
    points: int
    """Points of the scan on the marker."""


@dataclass(frozen=True, eq=False)
class MarkerSight:
    """All views of one marker, and the points that one of them shows on it."""

    views: tuple[MarkerView, ...]
    trajectory: Trajectory
    """world_from_camera."""
    rig: Rig

    @property
    def middle(self) -> MarkerView:
        """The view in the middle of all."""
        return self.views[len(self.views) // 2]

    def find_points(self, cloud: PointCloud) -> Mask:
        """Tell which points the middle view shows within the marker's outline."""
        view = self.middle
        seen = self.trajectory.to_camera(cloud.points, np.full(len(cloud), view.time))
        rays = self._rays_of(view)
        axis = rays.directions.mean(axis=0)
        axis /= np.linalg.norm(axis)
        wide = np.arccos(np.clip(rays.directions @ axis, -1, 1).min())
        ahead = seen @ axis
        found = ahead > np.cos(min(max(_WIDE * wide, _NEAR), 1.5)) * np.linalg.norm(seen, axis=1)
        pixels = project(self.rig.camera, seen[found], self._index)
        found[found] = _is_inside(pixels, view.corners)
        return found

    def corners_on(self, plane: Plane) -> Float[np.ndarray, "n 4 3"]:
        """Give where the corners that each view shows lie on a plane of the world [m]."""
        rays = self._rays_of(*self.views)
        times = np.repeat([view.time for view in self.views], 4)
        starts = self.trajectory.transform(rays.origins, times)
        ends = self.trajectory.transform(rays.origins + rays.directions, times)
        met = intersect_rays_with_plane(Rays(starts, ends - starts), plane)
        return met.reshape(-1, 4, 3)

    def _rays_of(self, *views: MarkerView) -> Rays:
        pixels = np.concatenate([view.corners for view in views])
        return back_project(self.rig.camera, pixels, self._index)

    @property
    def _index(self) -> float:
        return refractive_index(self.rig.water, self.rig.wavelength)


def _is_inside(pixels: Pixels, corners: Float[np.ndarray, "4 2"]) -> Mask:
    """Tell which pixels lie within a convex outline; NaN does not."""
    edges = np.roll(corners, -1, axis=0) - corners
    away = pixels[:, None] - corners
    side = edges[:, 0] * away[:, :, 1] - edges[:, 1] * away[:, :, 0]
    return np.all(side > 0, axis=1) | np.all(side < 0, axis=1)


def place_marker(sight: MarkerSight, points: Points, frames: Indices) -> MarkerPlace:
    """Place a marker's middle on the surface that the scan has there.

    The points on it give its plane; the corners of each picture, carried along their rays to that
    plane, give its middle. Pictures with the line on the marker are left out, since the line may
    lie on a corner; of the others those count that were taken next to the crossing. Its deviation
    is that of their scatter, of the profiles about the plane, and of what the corners lack of a
    square.

    Args:
        sight: The views.
        points: The points on the marker, as `find_points` tells them [m].
        frames: The frame of each.

    Raises:
        NotEnoughData: The line has hardly crossed it, or it stands in too few pictures.
    """
    if len(points) < _FEWEST_POINTS:
        raise NotEnoughData(f"the laser's line left {len(points)} points on it, and 20 are needed")
    fit = fit_plane(points)
    on_it = frames[fit.inliers]
    sight = replace(sight, views=_choose(sight.views, on_it))
    if len(sight.views) < _FEWEST_VIEWS:
        raise NotEnoughData(
            f"{len(sight.views)} pictures show it without the laser's line on it, and 3 are needed"
        )
    corners = sight.corners_on(fit.plane)
    corners = corners[_agree(corners.mean(axis=1))]
    middles = corners.mean(axis=1)
    if not np.isfinite(middles).all():
        raise NotEnoughData("the points on it lie on no plane that the camera could have seen")
    scatter = middles.var(axis=0, ddof=1).sum() / len(middles)
    # What a profile errs by is common to its points.
    depth = fit.rms**2 / len(np.unique(on_it))
    sigma = float(np.sqrt((scatter + depth + _unevenness(corners.mean(axis=0)) / 2) / 3))
    return MarkerPlace(middles.mean(axis=0), sigma, len(middles), int(fit.inliers.sum()))


def _agree(middles: Points) -> Mask:
    """Tell which views put the middle where most do: the line beside an edge pulls that."""
    away = np.linalg.norm(middles - np.median(middles, axis=0), axis=1)
    return ~(away > _STRAYS * np.median(away))


def _unevenness(corners: Float[np.ndarray, "4 3"]) -> float:
    """Give the variance of a corner along one direction, as their square tells it [m²].

    However many views there are, a corner finder errs by the same at the same edge: by where that
    lies in its pixel, by blur and by shade. Of the eight numbers of four corners a square's place,
    size and turn take four.
    """
    away = corners - corners.mean(axis=0)
    ahead = np.array([1, 1j, -1, -1j])
    along = (away[0] - away[2]) / np.linalg.norm(away[0] - away[2])
    normal = np.cross(away[0], away[1])
    across = np.cross(normal / np.linalg.norm(normal), along)
    flat = away @ along + 1j * (away @ across)
    left = flat - ahead * np.mean(flat * ahead.conj())
    return float((np.abs(left) ** 2).sum()) / 4


def _choose(views: Sequence[MarkerView], crossed: Indices) -> tuple[MarkerView, ...]:
    """Keep the views without the line that are next to those with it."""
    free = sorted((v for v in views if v.frame not in {*crossed.tolist()}), key=lambda v: v.frame)
    middle = float(np.median(crossed))
    before = [view for view in free if view.frame < middle]
    after = [view for view in free if view.frame >= middle]
    return (*before[-_ON_EITHER_SIDE:], *after[:_ON_EITHER_SIDE])
