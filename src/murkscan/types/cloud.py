"""All points of a scan in one frame."""

from dataclasses import dataclass, field, replace

import numpy as np

from .arrays import (
    Mask,
    Normals,
    Points,
    Ratios,
    ScanLineNumbers,
    SignedFrameNumbers,
    SmallNumbers,
)
from .pose import Pose
from .table import Table

FARTHEST = 1e11
"""Coordinates beyond which nothing lies, in whatever unit: the Earth's girth is 4e10 mm."""


@dataclass(frozen=True, eq=False, repr=False)
class PointCloud(Table):
    """Surface points in the world frame; one a row."""

    points: Points
    """Positions [m]."""
    normals: Normals
    """Unit normals, turned to the camera that saw the point; zero where there is none."""
    signal: Ratios
    """Height of the stripe above its surroundings [grey levels]."""
    posterior: Ratios
    """Probability that this is the surface."""
    sigma: Ratios
    """Standard deviation along the ray, the part independent between points [m]."""
    sigma_common: Ratios
    """Standard deviation of the part common to the scan, in the direction in which it is largest
    [m]; 0 where the rig states none."""
    frame: SignedFrameNumbers
    """Index of the frame that saw the point."""
    scan_line: ScanLineNumbers
    """Image column (stripe along rows) or row (stripe along columns) that saw the point [px]."""
    laser: SmallNumbers
    """Number of the laser in the rig."""
    branch: SmallNumbers
    """Number of the point among those of its scan line, from 0; with laser, frame and scan line it
    says which centre of which stripe the point is."""
    reflectance: Ratios = field(
        default_factory=lambda: np.zeros(0, np.float32), metadata={"may_be_left_out": True}
    )
    """Brightness of the stripe as it would be on the same paint a metre from the laser, facing it,
    without water between, in proportion to the paint's albedo [grey levels]; 0 where not known."""
    blur_shift: Ratios = field(
        default_factory=lambda: np.zeros(0, np.float32), metadata={"may_be_left_out": True}
    )
    """How much farther along its ray the lens's blur had moved each point before the finder put it
    back [m]; 0 where the finder puts nothing back. Exported clouds do not have it."""
    width: Ratios = field(
        default_factory=lambda: np.zeros(0, np.float32), metadata={"may_be_left_out": True}
    )
    """1σ of the stripe in the picture, where the finder has learnt it [px]; else 0. Exported clouds
    do not have it."""

    def is_sound(self) -> Mask:
        """Tell which points can be: at a place, with a normal, and with deviations not below 0.

        Files of others hold points that are not finite, or lie where nothing is.
        """
        placed = np.abs(self.points).max(axis=1, initial=0) < FARTHEST  # not true of NaN
        measured = (self.sigma >= 0) & (self.sigma_common >= 0)
        return placed & measured & np.isfinite(self.normals).all(axis=1)

    def scaled(self, unit: float) -> "PointCloud":
        """Give in metres what is in a unit of this length [m]: places and their deviations."""
        if unit == 1.0:
            return self
        return replace(
            self,
            points=unit * self.points,
            sigma=np.float32(unit) * self.sigma,
            sigma_common=np.float32(unit) * self.sigma_common,
            blur_shift=np.float32(unit) * self.blur_shift,
        )

    def carry(self, target_from_world: Pose) -> "PointCloud":
        """Lay the points elsewhere."""
        normals = (self.normals @ target_from_world.rotation.T).astype(np.float32)
        return replace(self, points=target_from_world @ self.points, normals=normals)
