"""The stripe on a wall that faces the camera, in one scan line, at many distances."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import ndtr

from ..optics.beam import Beam
from ..optics.scan_lines import SheetScanLines
from ..optics.sensor import vignetting
from ..optics.sheet_view import SheetView, glow_of, view_sheet
from ..optics.spread import Spread
from ..optics.stripe_bound import bound_of_position
from ..types.arrays import Pixels, Scalars
from ..types.rig import Rig
from .conditions import Conditions

_REACH = 4.0
"""Standard deviations of the stripe's core that tell of its centre, as in simulated truth."""
_WIDEST = 64
"""Pixels to one side that are looked at, at most."""
_PIXEL = 1.0 / 12.0
"""Variance of a pixel's own width [px²]."""
_BEYOND = 0.7
"""How far beyond the picture glow counts, as the tangent of an angle, as in simulated pictures."""
_STEP = 0.25
"""Pixels to each side over which derivatives are taken."""

PerPixel = Float[np.ndarray, "depths pixels"]
"""Pixels around the centre at each distance."""
Along = Float[np.ndarray, " along"]
"""Pixels of the whole scan line, and some beyond."""
PerWidth = Float[np.ndarray, "depths widths"]


@dataclass(frozen=True, eq=False)
class LineForecast:
    """One scan line; one distance an item, NaN where the stripe would lie outside the picture."""

    position: Scalars
    """Where the stripe lies along the scan line [px]."""
    bound: Scalars
    """The lowest standard deviation with which it can be found there [px]."""
    range_per_pixel: Scalars
    """How far the point moves along the camera's ray with a pixel of the stripe [m/px]."""
    camera_range: Scalars
    """Way from the camera's window to the point [m]."""
    speckle: Scalars
    """Standard deviation along the camera's ray that speckle leaves, whatever the light [m]."""
    peak: Scalars
    """Light of the stripe in the brightest pixel [electrons]."""
    background: Scalars
    """Light of the water there [electrons]."""
    pixels: Pixels
    """Where the stripe lies in the picture, u and v [px]."""


@dataclass(frozen=True, eq=False)
class LineOfSight:
    """A scan line made ready: what of it is the same at all distances."""

    conditions: Conditions
    beam: Beam
    scan_lines: SheetScanLines
    line: int
    electrons: float
    """Electrons that 1 W/m²/sr on the optical axis makes in a pixel."""
    wavelength: float
    """Of the light in the water [m]."""
    spread: Spread | None
    glow_spread: Spread | None

    @classmethod
    def of(
        cls, rig: Rig, conditions: Conditions, line: int, *, index: float, laser: int
    ) -> "LineOfSight":
        """Make a scan line ready."""
        medium, sensor = conditions.medium, conditions.sensor
        is_murky = medium.scattering > 0
        return cls(
            conditions,
            Beam.of(rig.laser(laser), conditions.light, index),
            SheetScanLines(rig.camera, rig.laser(laser), index),
            line,
            # Radiance falls by the square of the index where light leaves the water for the lens.
            sensor.electrons_per_radiance(rig.wavelength) / index**2,
            rig.wavelength / index,
            Spread.of(medium) if is_murky else None,
            Spread.of_glow(medium) if is_murky else None,
        )

    def forecast(self, depths: Scalars) -> LineForecast:
        """Say what a wall shows that faces the camera at these depths [m]."""
        positions, view, glow = self._follow()
        position = self._find_centres(depths, positions, view)
        centre = self._view(position)
        core, amount = self._shape(depths, position, centre)
        gain = self.electrons * self._kept(position)
        at, slope, light = self._stripe(position, core, amount, centre)
        near = np.sign(np.interp(position, positions, np.gradient(_filled(view.points[:, 2]))))
        sharp = np.interp(at, positions, glow)
        sharp *= ndtr(near[:, None] * (position[:, None] - at) / core[:, None])
        murk = self._spread_glow(depths, position, positions, view, glow)
        behind = (sharp + murk[:, None] + self._daylight(centre)[:, None]) * gain[:, None]
        total = light * gain[:, None] + behind
        weight = self._weigh(total, at, position, core)
        bound = bound_of_position(slope * gain[:, None], weight)
        return LineForecast(
            position,
            np.where(np.isfinite(position), bound, np.nan),
            self._range_per_pixel(position),
            centre.camera_range,
            self._speckle(centre),
            gain * light.max(axis=1),
            behind[:, light.shape[1] // 2],
            self.scan_lines.as_pixels(np.full(len(depths), self.line), position),
        )

    @property
    def _length(self) -> int:
        """Pixels of a scan line."""
        return self.scan_lines.camera.size["xy".index(self.scan_lines.laser.axis)]

    def _range_per_pixel(self, position: Scalars) -> Scalars:
        before, after = (self._view(position + side) for side in (-_STEP, _STEP))
        return np.abs(after.camera_range - before.camera_range) / (2 * _STEP)

    def _speckle(self, centre: SheetView) -> Scalars:
        """Give what speckle leaves of a rough surface's place along the camera's ray [m].

        References:
            Dorsch, Häusler and Herrmann, Laser triangulation: fundamental uncertainty in distance
            measurement, Applied Optics 33(7), 1994, for a contrast of 1: one laser, no averaging.
        """
        sensor, camera = self.conditions.sensor, self.scan_lines.camera
        aperture = camera.focal_length[0] * sensor.pixel_size / sensor.f_number / 2
        # The cone of light that the lens takes in, and the angle at which it looks at the beam.
        opening = aperture / np.hypot(aperture, centre.camera_range)
        light = self.beam.directions(np.nan_to_num(centre.angle))
        cosine = np.einsum("ij,ij->i", light, centre.directions)
        between = np.sqrt(np.maximum(1 - cosine**2, 1e-12))
        return self.wavelength / (2 * math.pi * opening * between)

    def _follow(self) -> tuple[Along, SheetView, Along]:
        """Follow the whole scan line along the sheet, and some way beyond the picture."""
        more = math.ceil(_BEYOND * self.scan_lines.pixels_per_tangent())
        positions = np.arange(-more, self._length + more, dtype=float)
        view = self._view(positions)
        return positions, view, glow_of(view, self.beam, self.conditions.medium)

    def _view(self, positions: Scalars) -> SheetView:
        lines = np.full(len(positions), self.line)
        return view_sheet(self.beam, self.scan_lines, self.scan_lines.as_pixels(lines, positions))

    def _find_centres(self, depths: Scalars, positions: Along, view: SheetView) -> Scalars:
        """Find where along the scan line the sheet lies at each depth; NaN outside the picture."""
        depth = view.points[:, 2]
        inside = view.is_seen & (positions >= 0) & (positions <= self._length - 1) & (depth > 0)
        if inside.sum() < 2:
            return np.full(len(depths), np.nan)
        order = np.argsort(depth[inside])
        return np.interp(
            depths, depth[inside][order], positions[inside][order], left=np.nan, right=np.nan
        )

    def _shape(
        self, depths: Scalars, position: Scalars, centre: SheetView
    ) -> tuple[Scalars, Scalars]:
        """Give the stripe's core [px, 1σ] and its sharp light [W/m²/sr·px]."""
        thickness = self.beam.thickness(centre.laser_range)
        distances = []
        for side in (-_STEP, _STEP):
            view = self._view(position + side)
            way = (depths - view.origins[:, 2]) / view.directions[:, 2]
            wall = view.origins + way[:, None] * view.directions
            distances.append(self.beam.locate(np.nan_to_num(wall)).distance)
        own = thickness * 2 * _STEP / np.abs(distances[1] - distances[0])
        facing = np.abs(self.beam.directions(np.nan_to_num(centre.angle))[:, 2])
        line = self.beam.line_power(np.nan_to_num(centre.angle), centre.laser_range)
        irradiance = line / (thickness * math.sqrt(2 * math.pi))
        ways = centre.laser_range + centre.camera_range
        left = np.exp(-self.conditions.medium.attenuation * ways)
        radiance = irradiance * facing * self.conditions.albedo / math.pi * left
        sensor = self.conditions.sensor
        turned = self.scan_lines.laser.axis == "y"
        blur = math.hypot(sensor.psf, sensor.field_blur if turned else sensor.composite)
        return np.sqrt(own**2 + blur**2 + _PIXEL), radiance * own * math.sqrt(2 * math.pi)

    def _stripe(
        self, position: Scalars, core: Scalars, amount: Scalars, centre: SheetView
    ) -> tuple[PerPixel, PerPixel, PerPixel]:
        """Give the pixels around each centre, and the stripe's slope and light in them."""
        widest = np.nanmax(core, initial=1.0)
        half = int(min(math.ceil(_REACH * widest), _WIDEST))
        at = np.rint(np.nan_to_num(position))[:, None] + np.arange(-half, half + 1)
        off = at - position[:, None]
        widths, weights = self._bells(self.spread, core, centre)
        light, slope = np.zeros_like(off), np.zeros_like(off)
        for width, weight in zip(widths.T, weights.T, strict=True):
            height = (amount * weight / (width * math.sqrt(2 * math.pi)))[:, None]
            bell = height * np.exp(-0.5 * (off / width[:, None]) ** 2)
            light += bell
            slope += bell * off / width[:, None] ** 2
        return at, slope, light

    def _bells(
        self, spread: Spread | None, core: Scalars, centre: SheetView
    ) -> tuple[PerWidth, PerWidth]:
        """Give width [px] and weight of the core and of each part of the skirt around it."""
        ones = np.ones((len(core), 1))
        if spread is None:
            return core[:, None], ones
        skirt = spread.widths * self.scan_lines.pixels_per_tangent()
        weights = spread.weights(
            np.nan_to_num(centre.laser_range), np.nan_to_num(centre.camera_range)
        )
        widths = np.hypot(core[:, None], skirt)
        return np.concatenate([core[:, None], widths], 1), np.concatenate([ones, weights], 1)

    def _spread_glow(
        self,
        depths: Scalars,
        position: Scalars,
        positions: Along,
        view: SheetView,
        glow: Along,
    ) -> Scalars:
        """Give the glow that the water spreads to each centre, of what lies before the wall."""
        if self.glow_spread is None:
            return np.zeros(len(depths))
        some = np.flatnonzero(glow > 0)
        near, at = view[some], positions[some]
        weights = self.glow_spread.weights(near.laser_range, near.camera_range)
        light = np.where(near.points[:, 2] < depths[:, None], glow[some], 0.0)
        total = np.zeros(len(depths))
        off = position[:, None] - at
        for width, weight in zip(self.glow_spread.widths, weights.T, strict=True):
            sigma = math.hypot(width * self.scan_lines.pixels_per_tangent(), math.sqrt(_PIXEL))
            bell = np.exp(-0.5 * (off / sigma) ** 2) / (sigma * math.sqrt(2 * math.pi))
            total += (light * bell) @ weight
        return total

    def _daylight(self, centre: SheetView) -> Scalars:
        """Give what the surface throws back of daylight [W/m²/sr]."""
        left = np.exp(-self.conditions.medium.attenuation * centre.camera_range)
        return self.conditions.light.ambient * self.conditions.albedo / math.pi * left

    def _kept(self, position: Scalars) -> Scalars:
        pixels = self.scan_lines.as_pixels(np.full(len(position), self.line), position)
        if not self.conditions.sensor.vignetting:
            return np.ones(len(position))
        return vignetting(self.scan_lines.camera, pixels)

    def _weigh(
        self, electrons: PerPixel, at: PerPixel, position: Scalars, core: Scalars
    ) -> PerPixel:
        """Give one over the variance of each pixel; 0 for white ones and those too far away."""
        sensor = self.conditions.sensor
        filled = np.nan_to_num(electrons).astype(np.float32)
        weight = 1.0 / sensor.variance(filled).astype(float)
        told = (
            (at >= 0)
            & (at < self._length)
            & (np.abs(at - position[:, None]) <= _REACH * core[:, None])
        )
        if sensor.interlaced and self.scan_lines.laser.axis == "y":
            told &= at % 2 == self.line % 2  # a field has half of the rows
        return np.where(told & ~sensor.is_full(filled), weight, 0.0)


def _filled(values: Scalars) -> Scalars:
    """Carry the last known value on where there is none."""
    known = np.flatnonzero(np.isfinite(values))
    if len(known) == 0:
        return np.zeros(len(values))
    return np.interp(np.arange(len(values)), known, values[known])
