"""How bright paint alone makes the stripe: without distance, water and slope."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..types.arrays import Directions, Points, Scalars
from ..types.camera import Camera
from ..types.laser import Laser
from .beam import Beam, Light
from .medium import Medium
from .scan_lines import SheetScanLines
from .sensor import vignetting
from .spread import Spread

_STEP = 1e-4
"""Half the way on the surface over which the picture is differentiated [m]."""
_GRAZING = 0.1
"""Cosine of the light's or the camera's angle to the surface's normal, below which nothing is told:
the normal's own error then doubles the brightness."""
_SHARP = 0.7
"""Blur of a sharp lens and of a pixel's own size, 1σ [px], where the recording does not tell it."""


@dataclass(frozen=True, eq=False)
class StripeBrightness:
    r"""How bright a white, dull surface makes the stripe of a laser, up to a constant factor.

    The line's power a metre L spreads with the fan. On a surface that the light meets at the angle
    i, it leaves the radiance E·cos i / π, E being the power a square metre; and where a pixel's
    step along the scan line is a step d across the sheet, light of 1σ thickness t is t/d pixels
    wide. The picture blurs it to w = √((t/d)² + b²), which lowers its height::

        height ∝ L · cos i / (d · w) · cos⁴ j · exp(−c · path) · (1 + Σ scattered forward)

    j being the ray's angle to the optical axis and path the water from the laser to the surface and
    on to the camera. The sheet's thickness, and that its power is even along a straight line across
    the fan, are those of `Light`.

    References:
        Lambert's law; Duntley, Light in the sea, JOSA 53, 1963 (what is left of a beam).
    """

    camera: Camera
    laser: Laser
    index: float
    """Refractive index of the water."""
    attenuation: float = 0.0
    """Beam attenuation of the water [1/m]."""
    width: float | None = None
    """Width that the finder fits to the stripe in the pictures, 1σ [px]; None: it fits each."""

    def of(self, points: Points, normals: Directions) -> Scalars:
        """Compute the brightness, as a share of that of a surface a metre ahead that faces it.

        Args:
            points: Places on the surface, in the camera frame [m].
            normals: Its unit normals there.

        Returns:
            The shares; NaN where a normal is zero, or the surface lies nearly along a ray.
        """
        shares = np.full(len(points), np.nan)
        known = np.linalg.norm(normals, axis=1) > 0.5
        if known.any():
            shares[known] = self._brightness(points[known], normals[known]) / self._ahead
        return shares

    def _brightness(self, points: Points, normals: Directions) -> Scalars:
        beam = self._beam
        where = beam.locate(points)
        path = np.linalg.norm(points, axis=1)
        falls = np.abs(np.einsum("ij,ij->i", normals, beam.directions(where.angle)))
        leaves = np.abs(np.einsum("ij,ij->i", normals, points / path[:, None]))
        step = self._step_across(points, normals, beam.normals(where.angle, where.range))
        width = self._width_of(beam.thickness(where.range) / step)
        pixels = self._lines.as_pixels(*self._lines.project(points))
        bright = beam.line_power(where.angle, where.range) * falls / (step * width)
        bright *= self._left(where.range, path, width)
        bright *= vignetting(self.camera, pixels)
        is_told = (falls > _GRAZING) & (leaves > _GRAZING) & (bright > 0)
        return np.where(is_told, bright, np.nan)

    def _step_across(self, points: Points, normals: Directions, sheet: Directions) -> Scalars:
        """Give the way across the sheet that is a pixel along the scan line, on the surface [m]."""
        side = np.cross(
            normals, np.where(np.abs(normals[:, :1]) < 0.7, [[1.0, 0, 0]], [[0, 1.0, 0]])
        )
        side /= np.linalg.norm(side, axis=1, keepdims=True)
        ways = side, np.cross(normals, side)
        (ax, ay), (bx, by) = (
            [
                (after - before) / (2 * _STEP)
                for before, after in zip(
                    self._lines.project(points - _STEP * way),
                    self._lines.project(points + _STEP * way),
                    strict=True,
                )
            ]
            for way in ways
        )
        # The way that leaves the scan line's number as it is, and changes the place by one.
        scale = ax * by - bx * ay
        scale = np.where(scale == 0, np.nan, scale)  # a surface that is seen from its edge
        way = (-bx / scale)[:, None] * ways[0] + (ax / scale)[:, None] * ways[1]
        return np.abs(np.einsum("ij,ij->i", way, sheet))

    def _left(self, laser_range: Scalars, camera_range: Scalars, width: Scalars) -> Scalars:
        """Give the share of the height that water leaves.

        Light that is scattered forward spreads in the picture, of a line along it, too: of a
        Gaussian s wide, w / √(w² + s²) of what is scattered into it comes back to the peak.
        """
        left = np.exp(-self.attenuation * (laser_range + camera_range))
        if not self.attenuation:
            return left
        spread = Spread.of(Medium(self.attenuation))
        widths = spread.widths * self._lines.pixels_per_tangent()
        back = width[:, None] / np.hypot(width[:, None], widths)
        scattered = spread.weights(laser_range, camera_range)
        return left * (1 + (scattered * back).sum(axis=1))

    def _width_of(self, bare: Scalars) -> Scalars:
        """Give the width by which a stripe's height is lowered [px]; `bare` is that of its light.

        A finder that fits one width w to all stripes finds of one that is v wide the height of one
        that is √((v² + w²) / 2) wide, as the product of two Gaussians integrates.
        """
        if self.width is None:
            return np.hypot(bare, _SHARP)
        blur = max(self.width**2 - self._bare_ahead**2, _SHARP**2)
        return np.sqrt((bare**2 + blur + self.width**2) / 2)

    @cached_property
    def _ahead(self) -> float:
        """The brightness of a surface a metre ahead of the laser that faces it."""
        return float(replace(self, attenuation=0.0)._brightness(*self._place_ahead)[0])

    @cached_property
    def _bare_ahead(self) -> float:
        """The stripe's width there without any blur [px]."""
        points, normals = self._place_ahead
        where = self._beam.locate(points)
        sheet = self._beam.normals(where.angle, where.range)
        step = self._step_across(points, normals, sheet)
        return float((self._beam.thickness(where.range) / step)[0])

    @property
    def _place_ahead(self) -> tuple[Points, Directions]:
        ray = self._beam.rays(np.zeros(1))
        return ray.origins + ray.directions, -ray.directions

    @cached_property
    def _beam(self) -> Beam:
        return Beam.of(self.laser, Light(), self.index)

    @cached_property
    def _lines(self) -> SheetScanLines:
        return SheetScanLines(self.camera, self.laser, self.index)
