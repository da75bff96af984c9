"""All light of one laser in one frame: stripe, glow and particles, after all blur."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..optics.sensor import Picture
from ..types.arrays import Scalars
from .glow_image import mask_glow
from .laser_view import LaserView
from .lit_line import LitLine, cast_fan, find_lit_line
from .particles import strew
from .reflected import draw_mirrored, mirror
from .scene import Scene
from .sensor import blur_lens
from .snow_image import draw_snow, places_in_light
from .speckle import draw_speckle
from .stripe_image import Rendering, draw_line, widths_of

_PIXEL = 1 / 12
"""Variance of a pixel's own width [px²]."""


@dataclass(frozen=True, eq=False)
class LineImage:
    """One laser's light in one frame, noise-free, after all blur; rows are v of the full frame."""

    stripe: Picture
    """Light of the surface that the laser lights [W/m²/sr]."""
    slope: Picture
    """Its derivative by the stripe's position along the scan line [W/m²/sr/px]."""
    glow: Picture
    """Light of the water that the laser lights, and of its particles [W/m²/sr]."""
    speckle: Picture
    """What interference adds to the stripe or takes from it [W/m²/sr]."""
    mask: Picture
    """Share of each pixel's sheet that is lit and in sight."""
    line: LitLine
    """True centres."""
    second: LitLine
    """True centres of the second line, which gloss throws."""
    widths: Scalars
    """Of the line's core at its true centres, with the lens's blur, 1σ along scan lines [px]."""

    @property
    def total(self) -> Picture:
        """The sum [W/m²/sr]."""
        return self.stripe + self.speckle + self.glow


def draw_laser(
    scene: Scene, laser: LaserView, number: int, *, snow_density: float = 0.0
) -> LineImage:
    """Draw one laser's light in one frame; the particles' density is in 1/m³."""
    view, caster = laser.rendering(scene, number), scene.surroundings.caster
    fall = cast_fan(laser.beam, laser.scan_lines, caster, view.pose)
    line = find_lit_line(laser.beam, laser.scan_lines, caster, view.pose, fall)
    own = widths_of(view, line)
    widths = np.sqrt(own**2 + _blur_along(scene, laser) ** 2 + _PIXEL)
    stripe, slope = _draw_stripe(scene, laser, view, line, own)
    spots = np.zeros_like(stripe)
    second = draw_mirrored(view, mirror(view, fall), scene.sensor.psf, spots)
    mask = mask_glow(view, laser.view, fall, line, widths)
    glow = mask * laser.glow
    if snow_density > 0:
        glow += _draw_snow(scene, laser, view, mask, snow_density, time=scene.times[number])
    light = LineImage(stripe, slope, glow, np.zeros_like(stripe), mask, line, second, widths)
    light = _add_spots(scene, laser, light, spots)
    return _spread(laser, _add_speckle(scene, light, number))


def _draw_stripe(
    scene: Scene, laser: LaserView, view: Rendering, line: LitLine, widths: Scalars
) -> tuple[Picture, Picture]:
    """Draw the line itself, and its derivative by its position."""
    width, height = laser.scan_lines.camera.size
    stripe, slope = np.zeros((2, height, width), np.float32)
    turned = laser.scan_lines.laser.axis == "y"
    as_lines = [picture.T if turned else picture for picture in (stripe, slope)]
    draw_line(view, line, widths, _blur_along(scene, laser), *as_lines)
    across = math.sqrt(_blur_across(scene, laser) ** 2 + _PIXEL)
    blur = (across, 0.0) if turned else (0.0, across)
    return blur_lens(stripe, *blur), blur_lens(slope, *blur)


def _draw_snow(
    scene: Scene, laser: LaserView, view: Rendering, mask: Picture, density: float, *, time: float
) -> Picture:
    image = np.zeros_like(mask)
    near = view.pose @ places_in_light(laser, mask, scene.attenuation)
    snow = strew(scene.particles, density, near, time=float(time), seed=scene.seed)
    draw_snow(view, snow, scene.particles.albedo, scene.sensor.psf, mask, image)
    return blur_lens(image, scene.sensor.composite, scene.sensor.field_blur)


def _add_spots(scene: Scene, laser: LaserView, light: LineImage, spots: Picture) -> LineImage:
    """Add the second line to the first."""
    if not len(light.second):
        return light
    spots = blur_lens(spots, scene.sensor.composite, scene.sensor.field_blur)
    slope = light.slope - _gradient(laser, spots)
    return replace(light, stripe=light.stripe + spots, slope=slope)


def _add_speckle(scene: Scene, light: LineImage, number: int) -> LineImage:
    """Let the light that water has not scattered interfere."""
    if scene.light.speckle == 0:
        return light
    factor = draw_speckle(
        scene.rig.camera.size,
        scene.light.speckle,
        spot=scene.sensor.psf,
        place=scene.pose(number).translation,
        seed=scene.seed,
    )
    return replace(light, speckle=light.stripe * (factor - 1))


def _spread(laser: LaserView, light: LineImage) -> LineImage:
    """Let the water spread what has been drawn sharply."""
    if laser.stripe_blur is None or laser.glow_blur is None:
        return light
    skirt = laser.stripe_blur.spread_stripe(light.stripe)
    glow = light.glow + laser.glow_blur.spread_glow(light.glow, light.mask)
    slope = light.slope - _gradient(laser, skirt)
    return replace(light, stripe=light.stripe + skirt, slope=slope, glow=glow)


def _gradient(laser: LaserView, picture: Picture) -> Picture:
    """Give the change from one pixel of a scan line to the next."""
    return np.gradient(picture, axis="yx".index(laser.scan_lines.laser.axis))


def _blur_along(scene: Scene, laser: LaserView) -> float:
    """Give the lens's blur along scan lines [px], 1σ."""
    return _blurs(scene)["xy".index(laser.scan_lines.laser.axis)]


def _blur_across(scene: Scene, laser: LaserView) -> float:
    """Give the same across them."""
    return _blurs(scene)["yx".index(laser.scan_lines.laser.axis)]


def _blurs(scene: Scene) -> tuple[float, float]:
    """Give the blur along u and v; analogue video blurs along rows."""
    sensor = scene.sensor
    return math.hypot(sensor.psf, sensor.composite), math.hypot(sensor.psf, sensor.field_blur)
