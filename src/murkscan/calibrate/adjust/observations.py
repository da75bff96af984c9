"""What the photos show, as an adjustment takes it: corners, stripe points, where boards are."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial.transform import Rotation

from ...optics import back_project, distance_to_sheet, project, refractive_index
from ...types.arrays import Directions, Indices, Pixels, Points, Scalars
from ...types.camera import Camera
from ...types.pose import Pose
from ...types.rig import Rig

_PIXEL_STEP = 1e-3
"""Change of a pixel over which derivatives by it are taken [px]; errors go with its square."""
_POINT_STEP = 1e-6
"""The same for a point, as a share of its distance."""

Rotations = Float[np.ndarray, "p 3 3"]
"""Rotation matrix of each board."""


def _no_pixels() -> Float[np.ndarray, "m 2"]:
    return np.zeros((0, 2))


@dataclass(frozen=True, eq=False)
class Sighting:
    """Points of a board whose places on the board are known, and the laser's stripe across it."""

    name: str
    """Name of the photo."""
    corners: Pixels
    """Where the photo shows the board's points [px]."""
    points: Points
    """The same points in the board's frame [m]."""
    camera_from_board: Pose
    """Where the board is, at least roughly."""
    stripe: Float[np.ndarray, "m 2"] = field(default_factory=_no_pixels)
    """Stripe centres on the board's plane [px]; none where the photo is for the camera only."""
    laser: int | Int[np.ndarray, "..."] = 0
    """Number of the laser that makes the stripe, or that of each of its points."""


@dataclass(frozen=True, eq=False)
class Boards:
    """Where each board is: camera_from_board, as arrays."""

    rotations: Rotations
    translations: Points
    centres: Points
    """Middle of each board's points, in the camera frame [m], about which a board is turned."""

    @classmethod
    def of(cls, sightings: Sequence[Sighting]) -> "Boards":
        """Take the boards from where the sightings have them."""
        poses = [sighting.camera_from_board for sighting in sightings]
        middles = [pose @ s.points.mean(axis=0) for pose, s in zip(poses, sightings, strict=True)]
        return cls(
            np.stack([pose.rotation for pose in poses]),
            np.stack([pose.translation for pose in poses]),
            np.stack(middles),
        )

    def move(self, steps: Float[np.ndarray, "p 6"]) -> "Boards":
        """Turn each board about its middle [rad], then shift it [m]."""
        turns = Rotation.from_rotvec(steps[:, :3]).as_matrix()
        arms = np.einsum("pij,pj->pi", turns, self.translations - self.centres)
        return Boards(
            turns @ self.rotations,
            arms + self.centres + steps[:, 3:],
            self.centres + steps[:, 3:],
        )

    def as_poses(self) -> tuple[Pose, ...]:
        """Give camera_from_board of each."""
        return tuple(Pose(r, t) for r, t in zip(self.rotations, self.translations, strict=True))


@dataclass(frozen=True, eq=False)
class Observed:
    """The corners of all sightings one after another, and their stripe points."""

    corners: Pixels
    points: Points
    corner_photo: Indices
    """Number of the photo of each corner."""
    stripe: Float[np.ndarray, "m 2"]
    stripe_photo: Int[np.ndarray, "..."]
    stripe_laser: Int[np.ndarray, "..."]

    @classmethod
    def of(cls, sightings: Sequence[Sighting]) -> "Observed":
        """Join sightings."""
        num_corners = [len(s.corners) for s in sightings]
        num_stripe = [len(s.stripe) for s in sightings]
        numbers = np.arange(len(sightings))
        lasers = [np.broadcast_to(s.laser, len(s.stripe)).astype(np.int64) for s in sightings]
        return cls(
            np.concatenate([s.corners for s in sightings]),
            np.concatenate([s.points for s in sightings]),
            np.repeat(numbers, num_corners),
            np.concatenate([s.stripe for s in sightings]),
            np.repeat(numbers, num_stripe),
            np.concatenate(lasers),
        )

    def place_corners(self, boards: Boards) -> Points:
        """Give the boards' points in the camera frame [m]."""
        turned = np.einsum("nij,nj->ni", boards.rotations[self.corner_photo], self.points)
        return turned + boards.translations[self.corner_photo]

    def place_stripes(self, rig: Rig, boards: Boards, pixels: Pixels) -> tuple[Points, Directions]:
        """Give where the rays of stripe pixels meet their boards [m], and the rays' directions."""
        rays = back_project(rig.camera, pixels, index_of(rig))
        normals = boards.rotations[self.stripe_photo, :, 2]
        offset = boards.translations[self.stripe_photo] - rays.origins
        along = np.sum(normals * rays.directions, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = np.sum(normals * offset, axis=1) / along
        return rays.origins + reach[:, None] * rays.directions, rays.directions

    def stripe_distances(self, rig: Rig, boards: Boards, pixels: Pixels) -> Scalars:
        """Give how far from its laser's sheet each stripe pixel's point on the board is [m]."""
        return self.sheet_distances(rig, self.place_stripes(rig, boards, pixels)[0])

    def sheet_distances(self, rig: Rig, points: Points) -> Scalars:
        """Give the signed distance of each stripe's point from its laser's sheet [m]."""
        distances = np.zeros(len(points))
        for number in np.unique(self.stripe_laser):
            mine = self.stripe_laser == number
            laser = rig.laser(int(number))
            distances[mine] = distance_to_sheet(points[mine], laser, index_of(rig))
        return distances

    def corner_residuals(self, camera: Camera, points: Points, index: float) -> Pixels:
        """Give corner as projected minus corner as found [px]."""
        return project(camera, points, index) - self.corners

    def pixels_to_sheet(self, rig: Rig, boards: Boards) -> Scalars:
        """Give how fast a stripe pixel's point leaves the sheet across the stripe [m/px].

        A stripe is off by pixels, not by metres: its distance over this is what it is off in the
        picture, to first order.

        References:
            Sampson, Fitting conic sections to very scattered data, 1982.
        """
        slopes = []
        for step in np.eye(2) * _PIXEL_STEP:
            ahead = self.stripe_distances(rig, boards, self.stripe + step)
            behind = self.stripe_distances(rig, boards, self.stripe - step)
            slopes.append((ahead - behind) / (2 * _PIXEL_STEP))
        return np.hypot(*slopes)


def index_of(rig: Rig) -> float:
    """Give the refractive index of what the rig is in."""
    return refractive_index(rig.water, rig.wavelength)


def pixels_by_points(camera: Camera, points: Points, index: float) -> Float[np.ndarray, "n 2 3"]:
    """Differentiate the projection of points by their places [px/m]."""
    slopes = []
    steps = _POINT_STEP * np.linalg.norm(points, axis=1, keepdims=True)
    for axis in np.eye(3):
        ahead = project(camera, points + steps * axis, index)
        slopes.append((ahead - project(camera, points - steps * axis, index)) / (2 * steps))
    return np.stack(slopes, axis=2)


def distances_along_rays(
    observed: Observed, rig: Rig, points: Points, directions: Directions
) -> Scalars:
    """Differentiate the distance from the sheet by the way along the camera's ray."""
    steps = _POINT_STEP * np.linalg.norm(points, axis=1)
    ahead = observed.sheet_distances(rig, points + steps[:, None] * directions)
    behind = observed.sheet_distances(rig, points - steps[:, None] * directions)
    return (ahead - behind) / (2 * steps)
