"""A line laser: the sheet of light that it throws, flat or bent by a window."""

import math
from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from ..errors import InputError
from .arrays import Indices, Mask, Scalars, Vector
from .plane import Plane
from .port import FlatPort, Port
from .short_repr import ShortRepr

Axis = Literal["x", "y"]
"""A camera axis."""


@final
@dataclass(frozen=True, eq=False, repr=False)
class Fan(ShortRepr):
    r"""Rays from one point that spread in a plane, and perhaps leave through a window.

    Seen with the tangent, which runs along the line, upwards::

                    / + half angle
                  /
        origin  ●────────▶ direction
                  \
                    \ - half angle

    Behind a port the rays bend one by one, and their surface is no longer a plane unless that
    plane contains the port's normal.
    """

    origin: Vector
    """Where the rays start, in the camera frame [m]."""
    direction: Vector
    """Unit direction of the middle ray, in the camera frame."""
    tangent: Vector
    """Unit direction in which the fan spreads, at right angles to the middle ray."""
    half_angle: float
    """Largest angle from the middle ray, inside the housing [rad]."""
    port: Port | None = None
    """The window, measured from the fan's origin along the camera's axes."""

    def __post_init__(self) -> None:
        """Refuse a fan that cannot be."""
        axes = np.stack([self.direction, self.tangent])
        if not np.allclose(axes @ axes.T, np.eye(2), atol=1e-6):
            raise InputError(
                "A fan needs a direction and a tangent of length 1 at right angles, got "
                f"{self.direction} and {self.tangent}."
            )
        if not 0 < self.half_angle < math.pi / 2:
            raise InputError(
                "The half angle of a fan must lie between 0 and 90 degrees, got "
                f"{math.degrees(self.half_angle):g}."
            )
        if isinstance(self.port, FlatPort):
            edge = math.cos(self.half_angle) * (self.direction @ self.port.normal)
            if not edge > math.sin(self.half_angle) * abs(self.tangent @ self.port.normal):
                raise InputError(
                    "The fan does not pass its port: turn the port's normal, "
                    f"{self.port.normal}, towards the fan's direction, {self.direction}."
                )

    @classmethod
    def spread(
        cls,
        origin: Vector,
        direction: Vector,
        tangent: Vector,
        half_angle: float,
        port: Port | None = None,
    ) -> "Fan":
        """Make a fan of a direction and a tangent that need not be unit or at right angles.

        Raises:
            InputError: Direction and tangent are parallel, or zero; or as for the class.
        """
        normal = np.cross(direction, tangent)
        sizes = np.linalg.norm(direction) * np.linalg.norm(tangent)
        if not np.linalg.norm(normal) > 1e-3 * sizes:
            raise InputError(
                f"The tangent of a fan, {tangent}, must run across its direction, {direction}."
            )
        ahead = direction / np.linalg.norm(direction)
        along = tangent - (tangent @ ahead) * ahead
        return cls(origin, ahead, along / np.linalg.norm(along), half_angle, port)

    @property
    def plane(self) -> Plane:
        """The plane in which the rays start out, before any window; normal direction × tangent."""
        return Plane.through(self.origin, np.cross(self.direction, self.tangent))


@dataclass(frozen=True, eq=False, repr=False)
class FanCoordinates(ShortRepr):
    """Where points lie with respect to a fan; one a row, NaN behind the start of their ray."""

    angle: Scalars
    """Angle, inside the housing, of the fan's ray that passes nearest [rad]."""
    range: Scalars
    """How far along that ray from its start, outside the port [m]."""
    distance: Scalars
    """Signed distance from the sheet [m], positive on the side of the fan's plane's normal."""

    def __getitem__(self, which: Mask | Indices) -> "FanCoordinates":
        """Pick some of the points."""
        return FanCoordinates(self.angle[which], self.range[which], self.distance[which])


@dataclass(frozen=True, eq=False, repr=False)
class Laser(ShortRepr):
    """A sheet of laser light, in the camera frame.

    The paper describes it by a baseline b and an angle θ::

              laser            camera
        ───────●──────────────────●──────▶ x
              -b ╲ θ              │ 0
                  ╲               │
                   ╲  sheet       ▼ z
    """

    sheet: Plane | Fan
    """The sheet, in the camera frame."""
    axis: Axis
    """The camera axis along which the laser sits: y where the stripe runs along image rows."""

    @classmethod
    def from_sheet(cls, sheet: Plane | Fan) -> "Laser":
        """Make a laser from its sheet; the axis is the larger of the normal's x and y."""
        plane = sheet.plane if isinstance(sheet, Fan) else sheet
        x, y, _ = np.abs(plane.normal)
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

    def as_plane(self) -> Plane:
        """Give the sheet as the plane that it is.

        Raises:
            InputError: The sheet is bent by a port.
        """
        if isinstance(self.sheet, Plane):
            return self.sheet
        if self.sheet.port is None:
            return self.sheet.plane
        raise InputError(
            "A laser's sheet behind a port is no plane and has no b and θ of its own; "
            "take those of murkscan.optics.equivalent_plane."
        )

    def as_baseline_angle(self) -> tuple[float, float]:
        """Give the equivalent b [m] and θ [rad]: where the sheet cuts the axis, and how steeply.

        A sheet that is also turned about the optical axis has these in the plane of that axis and
        the optical axis.

        Raises:
            InputError: The sheet is bent by a port; only its equivalent plane has b and θ.
        """
        plane = self.as_plane()
        along, forward = plane.normal["xy".index(self.axis)], plane.normal[2]
        baseline = plane.distance / along if along else math.copysign(math.inf, plane.distance)
        return float(baseline), math.atan2(abs(along), -forward * math.copysign(1.0, along))
