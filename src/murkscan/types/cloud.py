"""All points of a scan in one frame."""

from dataclasses import dataclass, fields

from .arrays import (
    Indices,
    Mask,
    Normals,
    Points,
    Ratios,
    ScanLines,
    SignedFrameNumbers,
    SmallNumbers,
)


@dataclass(frozen=True, eq=False)
class PointCloud:
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
    scan_line: ScanLines
    """Image column (stripe along rows) or row (stripe along columns) that saw the point [px]."""
    laser: SmallNumbers
    """Number of the laser in the rig."""

    def __len__(self) -> int:
        """Count the points."""
        return len(self.points)

    def __getitem__(self, which: Mask | Indices | slice) -> "PointCloud":
        """Pick some of the points."""
        return PointCloud(*(getattr(self, column.name)[which] for column in fields(self)))
