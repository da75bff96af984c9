"""How murky the water is, from how the sheet's own glow fades with the way of its light."""

import math
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from ..optics import (
    as_fan,
    back_project,
    intersect_rays_with_sheet,
    locate_on_fan,
    refractive_index,
    trace_fan,
)
from ..optics.glow import sheet_glow
from ..optics.medium import Medium
from ..optics.phase import AbstractPhase
from ..optics.phase_fournier_forand import FournierForand
from ..optics.phase_henyey_greenstein import HenyeyGreenstein
from ..optics.phase_petzold import PetzoldHarbour
from ..optics.spread import Spread
from ..types.arrays import Indices, Pixels, Scalars
from ..types.background import Attenuation
from ..types.rig import Rig
from .glow import Glow

_LARGEST = 20.0
"""Beam attenuation beyond which a camera sees nothing [1/m]."""
_GROUPS = 8
"""Groups of scan lines, each left out in turn."""
_FEWEST = 400
"""Places below which the glow tells nothing."""
_MODEL = 0.03
"""Share of the glow that no model explains."""
_PHASES: tuple[AbstractPhase, ...] = (FournierForand(), HenyeyGreenstein(0.924))
"""Other phase functions that natural water has."""
_ALBEDOS = (0.83, 0.95)
"""Shares of scattering in the attenuation that murky water has."""
_BROAD = (0.15, 0.4, 1.5)
"""Widths up to which spread light comes back to the glow, as the tangent of an angle."""


@dataclass(frozen=True, eq=False)
class _Seen:
    """Where each place of the glow is, and what light it would send through clear water."""

    glow: Glow
    bright: Scalars
    """Radiance without attenuation, in any unit."""
    laser_range: Scalars
    camera_range: Scalars


def estimate_attenuation(glow: Glow, rig: Rig, *, laser: int = 0) -> Attenuation | None:
    """Estimate the water's effective attenuation from the glow, and bounds of its beam attenuation.

    The glow of light scattered once fades as exp(-c R) over the way R from the laser to a place
    and on to the camera, beside what geometry takes. The effective attenuation is the c of that
    law. Light scattered forward on its way is not lost to a glow so broad, which makes the true
    beam attenuation larger: how much, depends on the share of scattering, and on how far the
    glow's own width goes. The interval holds both ends of it, of the phase functions of natural
    water and of lenses with and without their natural vignetting.

    Args:
        glow: Where the camera looks through lit water only.
        rig: The rig.
        laser: Number of its laser.

    Returns:
        The estimate; None where too little glow is seen to tell.

    References:
        Mobley, Light and Water, 1994, section 5.1, the path function for one scattering.
    """
    if len(glow) < _FEWEST:
        return None
    seen = _look(glow, rig, laser, PetzoldHarbour())
    if len(seen.glow) < _FEWEST:
        return None
    effective = _fit(seen)
    groups = [_fit(seen, skip=group) for group in range(_GROUPS)]
    spread = math.sqrt((_GROUPS - 1) / _GROUPS * float(np.sum((np.array(groups) - effective) ** 2)))
    looks = [seen, _without_vignetting(seen, rig)]
    looks += [_look(glow, rig, laser, phase) for phase in _PHASES]
    # What looks dark may be light that was scattered too often to fade.
    once = [effective, _fit(seen, is_dark=False)]
    once += [_fit(look, is_dark=dark) for look in looks[1:] for dark in (True, False)]
    often = [
        _fit(seen, albedo=albedo, broad=broad, is_dark=dark)
        for albedo in _ALBEDOS
        for broad in _BROAD
        for dark in (True, False)
    ]
    low, high = min(once) - 2 * spread, max(*once, *often) + 2 * spread
    return Attenuation(effective, max(low, 0.0), min(high, _LARGEST))


def nearer_side(rig: Rig, *, laser: int = 0) -> int:
    """Tell which way along scan lines nearer places of the sheet are seen.

    Returns:
        -1 towards smaller pixels, 1 towards larger ones, 0 where the camera does not see the sheet.
    """
    at = "xy".index(rig.laser(laser).axis)
    length = rig.camera.size[at]
    pixels = np.empty((length, 2))
    pixels[:, 1 - at] = rig.camera.size[1 - at] / 2
    pixels[:, at] = np.arange(length)
    index = refractive_index(rig.water, rig.wavelength)
    rays = back_project(rig.camera, pixels, index)
    ranges = np.linalg.norm(
        intersect_rays_with_sheet(rays, rig.lasers[laser], index) - rays.origins, axis=1
    )
    return -int(np.sign(np.sum(np.sign(np.nan_to_num(np.diff(ranges))))))


def _look(glow: Glow, rig: Rig, laser: int, phase: AbstractPhase) -> _Seen:
    """Follow the rays of the glow's places to the sheet, and keep those that meet it."""
    index = refractive_index(rig.water, rig.wavelength)
    fan = as_fan(rig.laser(laser))
    rays = back_project(rig.camera, glow.pixels, index)
    points = intersect_rays_with_sheet(rays, rig.laser(laser), index)
    where = locate_on_fan(points, fan, index)
    away = np.linalg.norm(points - fan.origin, axis=1)
    camera_range = np.linalg.norm(points - rays.origins, axis=1)
    bright = sheet_glow(
        trace_fan(fan, where.angle, index).directions,
        rays.directions,
        np.broadcast_to(np.cross(fan.direction, fan.tangent), points.shape),
        laser_range=np.zeros(len(points)),
        camera_range=np.zeros(len(points)),
        line_power=1.0 / away,
        medium=Medium(1.0, 1.0, phase),
    )
    bright = bright * (1 + _off_axis(glow.pixels, rig)) ** -2
    met = np.isfinite(bright + camera_range + where.range)
    return _Seen(glow[met], bright[met], where.range[met], camera_range[met])


def _off_axis(pixels: Pixels, rig: Rig) -> Scalars:
    """Give the square of the tangent of the angle off the axis; cos⁴ of it is what lenses keep."""
    centre, focal = np.array(rig.camera.principal_point), np.array(rig.camera.focal_length)
    return np.sum(((pixels - centre) / focal) ** 2, axis=1)


def _without_vignetting(seen: _Seen, rig: Rig) -> _Seen:
    return replace(seen, bright=seen.bright * (1 + _off_axis(seen.glow.pixels, rig)) ** 2)


def _fit(
    seen: _Seen,
    *,
    skip: int = -1,
    albedo: float = 0.0,
    broad: float = 0.0,
    is_dark: bool = True,
) -> float:
    """Fit the attenuation [1/m], with a brightness for each block and a common dark level.

    Args:
        seen: The glow.
        skip: Group of blocks that is left out.
        albedo: Share of scattering in the attenuation whose forward part comes back.
        broad: Width up to which it comes back, as the tangent of an angle.
        is_dark: Whether there is a dark level at all.
    """
    from scipy.optimize import minimize_scalar

    use = seen.glow.block % _GROUPS != skip
    level, block = seen.glow.level[use], seen.glow.block[use]
    weight = 1.0 / (seen.glow.variance[use] + (_MODEL * level) ** 2)
    way = seen.laser_range + seen.camera_range
    spread = Spread.of_glow(Medium(1.0, albedo)) if albedo else None

    def misfit(attenuation: float) -> float:
        light = seen.bright * np.exp(-attenuation * way)
        if spread is not None:
            now = replace(spread, scattering=attenuation * albedo)
            back = 1.0 / (1.0 + (spread.widths / broad) ** 2)
            light = light * (1.0 + now.weights(seen.laser_range, seen.camera_range) @ back)
        return _misfit(light[use], level, weight, block, is_dark)

    found = minimize_scalar(misfit, bounds=(0.0, _LARGEST), method="bounded")
    return float(found.x)


def _misfit(
    light: Scalars, level: Scalars, weight: Scalars, block: Indices, is_dark: bool
) -> float:
    """Give the least weighted sum of squares of level - K(block) · light - dark, with dark ≥ 0."""

    def total(values: Scalars) -> Float[np.ndarray, " blocks"]:
        return np.bincount(block, weight * values)

    own = np.maximum(total(light**2), 1e-30)
    share, rest = total(light) / own, total(light * level) / own
    bend = np.sum(total(np.ones_like(light)) - share * total(light))
    lift = np.sum(total(level) - share * total(light * level))
    least = np.sum(total(level**2) - rest * total(light * level))
    dark = max(float(lift / max(bend, 1e-30)), 0.0) if is_dark else 0.0
    return float(least - 2 * dark * lift + dark**2 * bend)
