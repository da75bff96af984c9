"""The scan lines of one laser in one camera, and where their rays meet the sheet."""

from dataclasses import dataclass

import numpy as np

from ..types.arrays import Indices, Pixels, Points, Scalars
from ..types.camera import Camera
from ..types.laser import Laser
from ..types.rays import Rays
from .sheet import intersect_rays_with_sheet
from .view import back_project, project

_TOUCH = 5e-5
"""Half the side of a patch whose picture is taken [m]."""


@dataclass(frozen=True, eq=False)
class SheetScanLines:
    """Image columns where the laser's axis is y, rows where it is x."""

    camera: Camera
    laser: Laser
    index: float
    """Refractive index of the water."""

    @property
    def count(self) -> int:
        """Number of scan lines."""
        return self.camera.size["yx".index(self.laser.axis)]

    def as_pixels(self, lines: Scalars | Indices, positions: Scalars) -> Pixels:
        """Give u and v [px] of a coordinate along each of these scan lines."""
        pair = (lines, positions) if self.laser.axis == "y" else (positions, lines)
        return np.stack(pair, axis=1).astype(float)

    def split(self, pixels: Pixels) -> tuple[Scalars, Scalars]:
        """Give the scan line, not rounded, and the coordinate along it of pixels [px]."""
        u, v = pixels.T
        return (u, v) if self.laser.axis == "y" else (v, u)

    def rays(self, lines: Scalars | Indices, positions: Scalars) -> Rays:
        """Give the rays of the camera, in its frame, along which these places are seen."""
        return back_project(self.camera, self.as_pixels(lines, positions), self.index)

    def meet_sheet(self, rays: Rays) -> Points:
        """Give where rays meet the sheet's middle [m]; NaN where they do not."""
        return intersect_rays_with_sheet(rays, self.laser, self.index)

    def project(self, points: Points) -> tuple[Scalars, Scalars]:
        """Give scan line and coordinate of points in the camera frame [m]."""
        return self.split(project(self.camera, points, self.index))

    def pixels_per_area(self, points: Points) -> Scalars:
        """Give the pixels that a square metre takes up which faces the camera [px²/m²].

        Args:
            points: Where it is, in the camera frame [m].
        """
        away = points - self.rays(*self.project(points)).origins
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        side = np.cross(away, [0.0, 1.0, 0.0])
        side /= np.linalg.norm(side, axis=1, keepdims=True)
        sides = side * _TOUCH, np.cross(away, side) * _TOUCH
        (ax, ay), (bx, by) = (
            [b - a for a, b in zip(self.project(points - s), self.project(points + s), strict=True)]
            for s in sides
        )
        return np.abs(ax * by - ay * bx) / (2 * _TOUCH) ** 2

    def pixels_per_tangent(self) -> float:
        """Give the pixels that something a metre away and a metre wide takes up, in the middle."""
        across, along = self.project(np.array([[-5e-4, 0.0, 1.0], [5e-4, 0.0, 1.0]]))
        return float(np.hypot(np.diff(across), np.diff(along))[0] / 1e-3)
