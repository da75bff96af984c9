"""Triangulation for any sheet: where the ray of a pixel meets it."""

from dataclasses import dataclass
from typing import final

from ..optics import back_project, intersect_rays_with_sheet, refractive_index
from ..types.arrays import Pixels, Points
from ..types.rig import Rig
from .base import AbstractTriangulation


@final
@dataclass(frozen=True)
class RaySheet(AbstractTriangulation):
    """Intersect the ray of each pixel, lens and windows traced, with the laser's sheet.

    References:
        Hartley and Zisserman, Multiple View Geometry, 2nd edition, section 3.2, for a flat sheet;
        `murkscan.optics` for what windows do.
    """

    def locate(self, pixels: Pixels, rig: Rig, laser: int) -> Points:
        """Give the point that each pixel sees; see `AbstractTriangulation.locate`."""
        index = refractive_index(rig.water, rig.wavelength)
        rays = back_project(rig.camera, pixels, index)
        return intersect_rays_with_sheet(rays, rig.lasers[laser], index)
