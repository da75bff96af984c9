"""A laser and a camera made ready: everything that stays the same from frame to frame."""

from dataclasses import dataclass

import numpy as np

from ..optics.beam import Beam
from ..optics.scan_lines import SheetScanLines
from ..optics.sensor import Picture
from ..optics.sheet_view import SheetView, glow_of, view_sheet
from ..optics.spread import Spread
from ..types.arrays import Pixels, Scalars
from .scene import Scene
from .stripe_image import Rendering
from .water_blur import GlowAt, WaterBlur, Weights

_BEYOND = 0.7
"""How far beyond the picture light counts, as the tangent of an angle: with 0.46 the glow is up to
8 % too dark."""
DARK = 20.0
"""Attenuation lengths beyond which no light is worth spreading, or drawing."""


@dataclass(frozen=True, eq=False)
class LaserView:
    """One laser as the camera sees it, apart from what stands in its light."""

    beam: Beam
    scan_lines: SheetScanLines
    view: SheetView
    """What each pixel sees of the sheet, row by row."""
    glow: Picture
    """Radiance of the sheet's own glow [W/m²/sr], as if nothing stood in its way."""
    stripe_blur: WaterBlur | None
    """How the water spreads light from the surface; None: not at all."""
    glow_blur: WaterBlur | None
    """How it spreads its own glow."""

    def rendering(self, scene: Scene, number: int) -> Rendering:
        """Give all that light on a surface depends on in one frame."""
        pose = scene.pose(number)
        return Rendering(self.beam, self.scan_lines, scene.surroundings, scene.attenuation, pose)


def view_laser(scene: Scene, number: int) -> LaserView:
    """Make one laser ready."""
    laser = scene.rig.lasers[number]
    scan_lines = SheetScanLines(scene.rig.camera, laser, scene.index)
    beam = Beam.of(laser, scene.light, scene.index)
    width, height = scene.rig.camera.size
    v, u = np.mgrid[:height, :width].reshape(2, -1).astype(float)
    view = view_sheet(beam, scan_lines, np.stack([u, v], axis=1))
    glow = _glow_at(scene, beam, view).reshape(height, width).astype(np.float32)
    stripe_blur = glow_blur = None
    if scene.medium is not None and scene.forward_scattering and scene.medium.scattering > 0:
        spread = Spread.of_glow(scene.medium)

        def glow_at(pixels: Pixels) -> Weights:
            there = view_sheet(beam, scan_lines, pixels)
            return _glow_at(scene, beam, there)[:, None] * _weigh(spread, there, scene.attenuation)

        stripe_blur = _blur_of(scene, Spread.of(scene.medium), scan_lines, view, None)
        glow_blur = _blur_of(scene, spread, scan_lines, view, glow_at)
    return LaserView(beam, scan_lines, view, glow, stripe_blur, glow_blur)


def _glow_at(scene: Scene, beam: Beam, view: SheetView) -> Scalars:
    if scene.medium is None or not scene.glow:
        return np.zeros(len(view.angle))
    return glow_of(view, beam, scene.medium)


def _blur_of(
    scene: Scene,
    spread: Spread,
    scan_lines: SheetScanLines,
    view: SheetView,
    glow_at: GlowAt | None,
) -> WaterBlur:
    scale = scan_lines.pixels_per_tangent()
    return WaterBlur.of(
        scene.rig.camera.size,
        scan_lines.laser.axis,
        sigmas=tuple(float(width * scale) for width in spread.widths),
        weights=_weigh(spread, view, scene.attenuation),
        reach=_BEYOND * scale,
        glow_at=glow_at,
    )


def _weigh(spread: Spread, view: SheetView, attenuation: float) -> Weights:
    """Give the weights of the Gaussians; none where the sheet is not seen, or too far away."""
    weights = np.zeros((len(view.angle), len(spread.widths)))
    ways = view.camera_range + view.laser_range
    with np.errstate(invalid="ignore"):
        seen = np.flatnonzero(ways * attenuation < DARK)
    weights[seen] = spread.weights(view.laser_range[seen], view.camera_range[seen])
    return weights
