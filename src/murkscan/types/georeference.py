"""Where a model lies on the Earth, or on a ship."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from .arrays import Points, Scalars, Vector
from .cloud import PointCloud
from .hull import Cell, HullFrame
from .pose import Pose
from .short_repr import ShortRepr

Matrix6 = Float[np.ndarray, "6 6"]
_GRID_HEADS = ("easting_m", "northing_m", "height_in_grid_m")


@dataclass(frozen=True, eq=False, repr=False)
class Georeference(ShortRepr):
    """The way from the model's world to a grid of eastings, northings and heights.

    Of a ship, which lies in no grid, the three are aft, to starboard and up; see `HullFrame`.
    The model is turned and shifted in metres on the ground, and the plane of the ground is scaled
    to the grid, whose metre is a little longer or shorter.
    """

    crs: str
    """The coordinate system, as EPSG:N and by its name."""
    wkt: str
    """The same as well-known text, for the files that keep it."""
    origin: Vector
    """Easting, northing and height near the control points [m], from which the ground counts."""
    scale: float
    """Length in the grid of a metre on the ground."""
    ground_from_model: Pose
    """The model in metres east, north and up of the origin."""
    covariance: Matrix6
    """Of the turn about the origin [rad] and the shift [m], along east, north and up."""
    hull: HullFrame | None = None
    """How places on a ship are told; None: it is a grid on the Earth."""

    @property
    def heads(self) -> tuple[str, ...]:
        """Names of the numbers of a place, as tables have them."""
        return _GRID_HEADS if self.hull is None else self.hull.heads

    def tell(self, points: Points) -> list[list[Cell]]:
        """Give the numbers of points of the model's world [m], in the order of `heads`."""
        places = self.place(points).tolist()
        if self.hull is None:
            return [[round(number, 4) for number in place] for place in places]
        return [list(self.hull.tell((aft, side, up))) for aft, side, up in places]

    def describe(self, point: Vector) -> str:
        """Say where a point of the model's world [m] is, for people."""
        first, second, up = self.place(point[None])[0].tolist()
        if self.hull is not None:
            return self.hull.describe((first, second, up))
        return f"easting {first:.3f}, northing {second:.3f}, height {up:.3f} m"

    def place(self, points: Points) -> Points:
        """Give easting, northing and height [m] of points of the model's world [m]."""
        return self.origin + (self.ground_from_model @ points) * self._metre

    def place_back(self, places: Points) -> Points:
        """Give points of the model's world [m] of eastings, northings and heights [m]."""
        return self.ground_from_model.inverse() @ ((places - self.origin) / self._metre)

    def sigma(self, points: Points) -> Scalars:
        """Compute how well places are known by the control points alone.

        Args:
            points: In the model's world [m].

        Returns:
            Standard deviation in the direction in which it is largest [m].
        """
        x, y, z = (self.ground_from_model @ points).T
        none = np.zeros_like(x)
        turns = np.stack(
            [
                np.stack([none, z, -y], axis=1),
                np.stack([-z, none, x], axis=1),
                np.stack([y, -x, none], axis=1),
            ],
            axis=1,
        )
        moves = np.concatenate([turns, np.broadcast_to(np.eye(3), (len(points), 3, 3))], axis=2)
        variance = np.linalg.eigvalsh(moves @ self.covariance @ moves.transpose(0, 2, 1))
        return np.sqrt(np.maximum(variance[:, -1], 0.0))

    def carry(self, cloud: PointCloud) -> PointCloud:
        """Lay a cloud in the grid; the common part of its deviations gets the control's share.

        Each of the two is taken in the direction in which it is largest, so that their sum is no
        less than either has in any.
        """
        normals = cloud.normals @ self.ground_from_model.rotation.T.astype(np.float32)
        common = np.hypot(cloud.sigma_common, self.sigma(cloud.points)).astype(np.float32)
        return replace(cloud, points=self.place(cloud.points), normals=normals, sigma_common=common)

    @property
    def _metre(self) -> Vector:
        return np.array([self.scale, self.scale, 1.0])
