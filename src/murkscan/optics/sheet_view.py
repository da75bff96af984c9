"""What each pixel sees of the sheet: fixed to the rig, and so made once for all frames."""

from dataclasses import dataclass, fields

import numpy as np

from ..types.arrays import Directions, Indices, Mask, Pixels, Points, Scalars
from .beam import Beam
from .glow import sheet_glow
from .medium import Medium
from .scan_lines import SheetScanLines


@dataclass(frozen=True, eq=False)
class SheetView:
    """Where pixels see the sheet's middle; one a row, NaN where they do not see it."""

    camera_range: Scalars
    """Way of the light from the sheet to the camera, through water [m]."""
    laser_range: Scalars
    """Way of the light from the laser to there, through water [m]."""
    angle: Scalars
    """Angle of the fan's ray that goes there [rad]."""
    origins: Points
    """Where the camera's rays enter the water, in the camera frame [m]."""
    directions: Directions
    """Where they point."""

    def __getitem__(self, which: Mask | Indices) -> "SheetView":
        """Pick some of the pixels."""
        return SheetView(*(getattr(self, column.name)[which] for column in fields(self)))

    @property
    def points(self) -> Points:
        """Where the sheet is seen, in the camera frame [m]."""
        return self.origins + self.camera_range[:, None] * self.directions

    @property
    def is_seen(self) -> Mask:
        """Tell which pixels see the sheet."""
        return np.isfinite(self.camera_range + self.laser_range)


def view_sheet(beam: Beam, scan_lines: SheetScanLines, pixels: Pixels) -> SheetView:
    """Follow the rays of pixels [px] to the sheet."""
    rays = scan_lines.rays(*scan_lines.split(pixels))
    points = scan_lines.meet_sheet(rays)
    where = beam.locate(points)
    camera_range = np.linalg.norm(points - rays.origins, axis=1)
    return SheetView(camera_range, where.range, where.angle, rays.origins, rays.directions)


def glow_of(view: SheetView, beam: Beam, medium: Medium) -> Scalars:
    """Give the radiance of the sheet's own glow [W/m²/sr], as if nothing stood in its way."""
    glow = np.zeros(len(view.angle))
    seen = np.flatnonzero(view.is_seen)
    if len(seen):
        some = view[seen]
        glow[seen] = sheet_glow(
            beam.directions(some.angle),
            some.directions,
            beam.normals(some.angle, some.laser_range),
            laser_range=some.laser_range,
            camera_range=some.camera_range,
            line_power=beam.line_power(some.angle, some.laser_range),
            medium=medium,
        )
    return glow
