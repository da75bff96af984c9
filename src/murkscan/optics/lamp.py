"""A lamp on the vehicle: it lights the object, and the water before it."""

import math
from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..types.arrays import Directions, Points, Scalars
from ..types.rays import Rays
from .medium import Medium

_STEPS = 24
"""Places along a line of sight at which the water's light is added up."""
_NEAREST, _FARTHEST = 0.05, 6.0
"""From where to where along it [m]: nearer, nothing is in the lamp's beam."""


@dataclass(frozen=True)
class Lamp:
    """A lamp beside the camera that shines along its axis.

    Its intensity falls by a power of the cosine, so that it is half as bright at the half angle.
    """

    power: float = 0.0
    """In the laser's colour [W]; 0: there is none."""
    position: tuple[float, float, float] = (0.25, -0.1, 0.0)
    """In the camera frame [m]."""
    half_angle: float = math.radians(35)
    """Angle from its axis at which it is half as bright [rad]."""

    def __post_init__(self) -> None:
        """Refuse a lamp that cannot be."""
        if not 0 <= self.power <= 1e6:
            raise InputError(f"light.lamp.power_w must lie between 0 and 1e6, got {self.power:g}.")
        if not 0 < self.half_angle < math.pi / 2:
            raise InputError(
                "light.lamp.half_angle_deg must lie between 0 and 90, got "
                f"{math.degrees(self.half_angle):g}."
            )

    def irradiance(self, points: Points, normals: Directions, attenuation: float) -> Scalars:
        """Give what the lamp brings to surfaces in the camera frame, on either side [W/m²].

        Args:
            points: Where they are [m].
            normals: Of length 1.
            attenuation: Of the water [1/m].
        """
        away, way = self._to(points)
        facing = np.abs(np.einsum("ij,ij->i", normals, away))
        return self._intensity(away) * facing * np.exp(-attenuation * way) / way**2

    def veil(self, rays: Rays, ranges: Scalars, medium: Medium) -> Scalars:
        """Give the light that water throws back along rays of the camera [W/m²/sr].

        Light that is scattered once; the ranges [m] are those of what the rays meet.

        References:
            McGlamery, A computer model for underwater camera systems, SPIE Ocean Optics VI, 1980
            (backscatter integrated along the line of sight).
        """
        total, before, step = np.zeros(len(ranges)), np.zeros(len(ranges)), 0.0
        ends = np.clip(ranges, _NEAREST, _FARTHEST)
        for number, share in enumerate(np.linspace(0, 1, _STEPS)):
            at = _NEAREST * (ends / _NEAREST) ** share
            now = self._thrown_back(rays, at, medium)
            if number:
                total += 0.5 * (now + before) * (at - step)
            before, step = now, at
        return total

    def _thrown_back(self, rays: Rays, at: Scalars, medium: Medium) -> Scalars:
        """Give what a metre of water at these ranges adds to rays [W/m³/sr]."""
        away, way = self._to(rays.origins + at[:, None] * rays.directions)
        cosine = -np.einsum("ij,ij->i", away, rays.directions)
        light = self._intensity(away) * np.exp(-medium.attenuation * (way + at)) / way**2
        return light * medium.scattering * medium.phase.at_cosine(cosine)

    def _to(self, points: Points) -> tuple[Directions, Scalars]:
        away = points - np.array(self.position)
        way = np.linalg.norm(away, axis=1)
        return away / np.maximum(way, 1e-6)[:, None], np.maximum(way, 1e-3)

    def _intensity(self, away: Directions) -> Scalars:
        """Give the power a solid angle in these directions [W/sr]."""
        order = math.log(0.5) / math.log(math.cos(self.half_angle))
        return self.power * (order + 1) / (2 * math.pi) * np.maximum(away[:, 2], 0.0) ** order
