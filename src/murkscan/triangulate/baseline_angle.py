"""The paper's triangulation: equation (4)."""

import math
from dataclasses import dataclass
from typing import final

from .._kernels.equation4 import locate_points
from ..errors import InputError
from ..types.arrays import Pixels, Points
from ..types.rig import Rig
from .base import AbstractTriangulation

_TURNED = 1e-6
"""Sine of a sheet's turn about the optical axis from which equation (4) no longer holds."""


@final
@dataclass(frozen=True)
class BaselineAngle(AbstractTriangulation):
    """Equation (4): [X Y Z] = b / (f · cot θ − x) · [x y f].

    For a sheet that contains one of the camera's two image axes. Lens distortion is removed first.

    References:
        The paper's equation (4), with the minus sign that its print has lost.
    """

    def locate(self, pixels: Pixels, rig: Rig, laser: int) -> Points:
        """Give the point that each pixel sees; see `AbstractTriangulation.locate`.

        Raises:
            InputError: The sheet is turned about the optical axis, so that no b and θ describe it,
                or there is a window before the camera or the laser.
        """
        source = rig.lasers[laser]
        along = "xy".index(source.axis)
        if rig.camera.port is not None:
            raise InputError(
                "Equation (4) knows no window before the camera; use --method ray-sheet."
            )
        if abs(source.as_plane().normal[1 - along]) > _TURNED:
            raise InputError(
                f"Laser {laser} is turned about the optical axis, so equation (4) does not hold "
                "for it; use --method ray-sheet."
            )
        baseline, angle = source.as_baseline_angle()
        return locate_points(
            pixels,
            rig.camera.focal_length,
            rig.camera.principal_point,
            rig.camera.distortion,
            along,
            baseline,
            1 / math.tan(angle),
        )
