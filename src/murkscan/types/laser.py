"""A line laser: the sheet of light that it throws."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..errors import InputError
from .plane import Plane

Axis = Literal["x", "y"]
"""A camera axis."""


@dataclass(frozen=True, eq=False)
class Laser:
    """A flat sheet of laser light, in the camera frame.

    The paper describes it by a baseline b and an angle θ::

              laser            camera
        ───────●──────────────────●──────▶ x
              -b ╲ θ              │ 0
                  ╲               │
                   ╲  sheet       ▼ z
    """

    sheet: Plane
    """The sheet, in the camera frame."""
    axis: Axis
    """The camera axis along which the laser sits: y where the stripe runs along image rows."""

    @classmethod
    def from_sheet(cls, sheet: Plane) -> "Laser":
        """Make a laser from its sheet; the axis is the larger of the normal's x and y."""
        x, y, _ = np.abs(sheet.normal)
        return cls(sheet, "x" if x >= y else "y")

    @classmethod
    def from_baseline_angle(cls, baseline: float, angle: float, axis: Axis) -> "Laser":
        """Make a laser from the paper's b and θ.

        Args:
            baseline: b: the laser sits at -b on the camera's axis [m]; negative on its other side.
            angle: θ from the baseline to the sheet [rad]; the sheet is X = -b + Z · cot θ.
            axis: The camera axis along which the laser sits.

        Raises:
            InputError: The baseline is zero, or the angle is not between 0 and π.

        References:
            The paper's equation (4) and figure 3.
        """
        if baseline == 0 or not 0 < angle < math.pi:
            raise InputError(
                f"A laser needs a baseline other than 0 and an angle between 0 and 180 degrees, "
                f"got {baseline * 1e3:g} mm and {math.degrees(angle):g} degrees."
            )
        normal = np.zeros(3)
        normal["xy".index(axis)], normal[2] = math.sin(angle), -math.cos(angle)
        return cls(Plane(normal, baseline * math.sin(angle)), axis)

    def as_baseline_angle(self) -> tuple[float, float]:
        """Give the equivalent b [m] and θ [rad]: where the sheet cuts the axis, and how steeply.

        A sheet that is also turned about the optical axis has these in the plane of that axis and
        the optical axis.
        """
        along, forward = self.sheet.normal["xy".index(self.axis)], self.sheet.normal[2]
        baseline = self.sheet.distance / along
        return float(baseline), math.atan2(abs(along), -forward * math.copysign(1.0, along))
