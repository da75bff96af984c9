"""The laser's light on its way through the water: where it goes, how thick and how strong it is."""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from jaxtyping import Float

from ..errors import InputError
from ..geometry.plane_fit import fit_plane
from ..types.arrays import Directions, Mask, Points, Scalars
from ..types.laser import Fan, FanCoordinates, Laser
from ..types.plane import Plane
from ..types.rays import Rays
from .lamp import Lamp
from .sheet import as_fan, locate_on_fan, trace_fan

_NUM_ANGLES = 4001
"""Rays by which the fan's spreading is tabled."""
_EDGE = 0.02
"""Share of a Powell fan's half width over which it fades at its ends."""
_SLAB = 3.0
"""Distance from the laser within which its sheet is known to keep to a slab [m]; farther out light
is lost in any water with particles."""
_STREAK = math.radians(0.25)
"""Angle from one streak of a fan to the next."""
_STREAKS = np.random.default_rng(532).standard_normal(1024) * math.sqrt(1.5)
"""Strength of each; a line between neighbours has two thirds of their variance."""


@dataclass(frozen=True)
class Light:
    """The laser's light, and what else is lit.

    References:
        Powell, Design of a laser beam line expander, Applied Optics 26(17), 1987 (light spread
        evenly along a line); ISO 11146-1 (beam width and divergence, full, at 1/e²).
    """

    power: float = 0.03
    """Power of each laser's fan [W]."""
    divergence: float = 1.4e-3
    """Full angle by which the sheet thickens in air [rad]."""
    waist: float = 1e-3
    """Thickness of the sheet at its source, full width at 1/e² [m]."""
    ambient: float = 0.0
    """Irradiance by daylight or lamps, in the laser's colour, on every surface [W/m²]."""
    lamp: Lamp = field(default_factory=Lamp)
    """On the vehicle."""
    streaks: float = 0.0
    """How uneven the fan is along its angle, 1σ, as a share: dust and grooves on its optics."""
    speckle: float = 0.0
    """Contrast of the stripe's speckle: its standard deviation as a share of its mean."""
    is_on: bool = True
    """Whether the lasers shine; exposure is set as if they did."""
    colour: tuple[float, float, float] | None = None
    """Red, green and blue of white paper in daylight or lamplight, as a colour camera sees it,
    green being as strong as stated; None: all light is of the laser's colour."""

    @property
    def shows_objects(self) -> bool:
        """Whether anything but the lasers lights the scene."""
        return self.ambient > 0 or self.lamp.power > 0

    def __post_init__(self) -> None:
        """Refuse light that cannot be."""
        if not 0 < self.power <= 1e3:
            raise InputError(
                f"light.power_mw must lie above 0 and not above 1e6, got {self.power * 1e3:g}."
            )
        if not (self.waist >= 0 and self.divergence >= 0 and self.waist + self.divergence > 0):
            raise InputError(
                f"light.waist_mm and light.divergence_mrad must not be below 0, nor both 0, got "
                f"{self.waist * 1e3:g} and {self.divergence * 1e3:g}."
            )
        if not 0 <= self.ambient <= 1e6:
            raise InputError(
                f"light.ambient_w_m2 must lie between 0 and 1e6, got {self.ambient:g}."
            )
        if self.colour is not None and not all(0 < part <= 100 for part in self.colour):
            raise InputError(
                f"light.colour needs red, green and blue above 0, got {list(self.colour)}."
            )
        if not 0 <= self.speckle <= 1:
            raise InputError(f"light.speckle must lie between 0 and 1, got {self.speckle:g}.")
        if not 0 <= self.streaks <= 1:
            raise InputError(
                f"light.streaks_percent must lie between 0 and 100, got {100 * self.streaks:g}."
            )


@dataclass(frozen=True, eq=False)
class Beam:
    """One laser's light in the camera frame, outside its port."""

    fan: Fan
    light: Light
    index: float
    """Refractive index of the water."""

    @classmethod
    def of(cls, laser: Laser, light: Light, index: float) -> "Beam":
        """Give a laser its light."""
        return cls(as_fan(laser), light, index)

    def thickness(self, ranges: Scalars) -> Scalars:
        """Give the sheet's thickness [m], one standard deviation of its Gaussian profile."""
        # A window bends light towards its normal: what spreads in air spreads less in water.
        spread = self.light.divergence / (self.index if self.fan.port else 1.0)
        return np.hypot(self.light.waist, spread * ranges) / 4

    def rays(self, angles: Scalars) -> Rays:
        """Follow the fan's rays at these angles [rad]."""
        return trace_fan(self.fan, angles, self.index)

    def locate(self, points: Points) -> FanCoordinates:
        """Find angle, range and distance from the sheet of points in the camera frame [m]."""
        return locate_on_fan(points, self.fan, self.index)

    def may_light(self, points: Points, times: float) -> Mask:
        """Tell which points may lie within so many standard deviations of the sheet's middle.

        Quick, and never wrong about a point in the light: a window bends the sheet by millimetres,
        so that what lies far from its plane need not be located.
        """
        plane, bend = self._slab
        is_far = np.linalg.norm(points - self.fan.origin, axis=1) > _SLAB
        away = np.abs(plane.distance_to(points))
        return is_far | (away < bend + times * self.thickness(np.array([_SLAB])))

    def directions(self, angles: Scalars) -> Directions:
        """Give the direction in which light travels at these angles [rad], by the table."""
        return self._read(self._rays.directions, angles)

    def normals(self, angles: Scalars, ranges: Scalars) -> Directions:
        """Give the unit normal of the sheet at these places."""
        normals = np.cross(self.directions(angles), self._across(angles, ranges))
        return normals / np.linalg.norm(normals, axis=1, keepdims=True)

    def line_power(self, angles: Scalars, ranges: Scalars) -> Scalars:
        """Give the power that crosses a metre of the sheet's width, in clear water [W/m]."""
        width = np.linalg.norm(self._across(angles, ranges), axis=1)
        return self.power_per_angle(angles) / np.maximum(width, 1e-6)

    def irradiance(self, where: FanCoordinates, spread: Scalars | float = 0.0) -> Scalars:
        """Give the power through a square metre across the beam, in clear water [W/m²].

        Args:
            where: The places.
            spread: How far light goes on under the surface there, across the sheet [m], 1σ.
        """
        thickness = np.hypot(self.thickness(where.range), spread)
        profile = np.exp(-0.5 * (where.distance / thickness) ** 2)
        line = self.line_power(where.angle, where.range)
        return line * profile / (thickness * math.sqrt(2 * math.pi))

    def power_per_angle(self, angles: Scalars) -> Scalars:
        """Give the power a radian [W], even along a straight line across the fan."""
        edge = math.tan(self.fan.half_angle)
        share = np.abs(np.tan(angles)) / edge
        fade = np.clip((1 - share) / _EDGE, 0, 1)
        even = self.light.power / ((2 - _EDGE) * edge) / np.cos(angles) ** 2
        return np.where(share <= 1, even * fade * self._unevenness(angles), 0.0)

    def _unevenness(self, angles: Scalars) -> Scalars:
        """Give the power at these angles as a share of an even fan's."""
        middle = len(_STREAKS) // 2
        strength = np.interp(angles / _STREAK + middle, np.arange(len(_STREAKS)), _STREAKS)
        return np.exp(self.light.streaks * strength - self.light.streaks**2 / 2)

    def _across(self, angles: Scalars, ranges: Scalars) -> Directions:
        """How far a point of the sheet moves with the angle of its ray, across the ray [m/rad]."""
        start, turn = self._spreading
        moved = self._read(start, angles) + ranges[:, None] * self._read(turn, angles)
        away = self.directions(angles)
        return moved - np.einsum("ij,ij->i", moved, away)[:, None] * away

    def _read(self, table: Float[np.ndarray, "m 3"], angles: Scalars) -> Directions:
        return np.stack([np.interp(angles, self._angles, column) for column in table.T], axis=1)

    @cached_property
    def _angles(self) -> Scalars:
        return np.linspace(-self.fan.half_angle, self.fan.half_angle, _NUM_ANGLES)

    @cached_property
    def _slab(self) -> tuple[Plane, float]:
        """The plane nearest the sheet, and how far the sheet bends away from it within `_SLAB`."""
        rays = self.rays(np.linspace(-self.fan.half_angle, self.fan.half_angle, _NUM_ANGLES // 10))
        sheet = np.concatenate([rays.origins, rays.origins + _SLAB * rays.directions])
        fit = fit_plane(sheet, tolerance=np.inf)
        return fit.plane, float(np.abs(fit.residuals).max())

    @cached_property
    def _rays(self) -> Rays:
        return self.rays(self._angles)

    @cached_property
    def _spreading(self) -> tuple[Directions, Directions]:
        rays = self._rays
        start, turn = (
            np.gradient(table, self._angles, axis=0) for table in (rays.origins, rays.directions)
        )
        return start, turn
