"""Where the laser should sit, and how it should lean."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InputError, NotEnoughData
from ..optics import as_fan, equivalent_plane, refractive_index
from ..types.laser import Fan, Laser
from ..types.rig import Rig
from .conditions import Conditions
from .forecast import Forecast, forecast

_BASELINES = 9
_SHORTEST = 0.05
"""Shortest baseline that is tried [m]."""
_CROSSINGS = 5
"""Distances, spread over the working range, at which the sheet is let cross the camera's axis."""
_NUM_LINES, _NUM_DEPTHS = 3, 9
COVERED = 0.95
"""Share of points found from which more is not asked for: then σ decides."""


@dataclass(frozen=True, eq=False)
class Placement:
    """A place for the laser, and what it would show."""

    baseline: float
    """b: the laser sits at -b on the camera's axis [m]."""
    angle: float
    """θ from the baseline to the sheet [rad]."""
    share_found: float
    """Share of the points found between the nearest and the farthest distance."""
    sigma: float
    """Largest median σ along the camera's ray between them, noise and speckle [m]."""
    rig: Rig
    """The rig with its laser there."""


def place_laser(
    rig: Rig,
    conditions: Conditions,
    *,
    near: float,
    far: float,
    longest: float,
    laser: int = 0,
) -> Placement:
    """Find the baseline and angle that show most of a working range, and that best.

    Of places that show 95 % of the points, or as much as any does, the one whose largest σ is
    smallest; the present one is among them. Baselines up to the longest one are tried on the
    laser's side, with sheets that cross the optical axis at several distances of the range.

    Args:
        rig: The rig; its laser keeps its opening.
        conditions: Water, light, sensor and surface.
        near: Nearest distance of the surface [m].
        far: Farthest distance [m].
        longest: Longest baseline that the vehicle can carry [m].
        laser: Number of the laser.

    Raises:
        InputError: The range is none, or the longest baseline is below 50 mm.
        NotEnoughData: Nothing would be seen from any place.
    """
    if not 0 < near < far:
        raise InputError(f"A working range must grow, got {near:g} to {far:g} m.")
    if not longest >= _SHORTEST:
        raise InputError(f"The longest baseline must be 50 mm or more, got {longest * 1e3:g} mm.")
    depths = np.linspace(near, far, _NUM_DEPTHS)
    tried = [
        judge_present(rig, conditions, near=near, far=far, laser=laser),
        *(
            _judge(candidate, conditions, depths, laser, place)
            for candidate, place in _candidates(rig, near, far, longest, laser)
        ),
    ]
    seen = [one for one in tried if one.share_found > 0]
    if not seen:
        raise NotEnoughData(
            f"From no place would this rig see a surface {near:g} to {far:g} m away in this water: "
            "go nearer, or give the laser more power."
        )
    enough = min(COVERED, max(one.share_found for one in seen))
    return min((one for one in seen if one.share_found >= enough), key=lambda one: one.sigma)


def judge_present(
    rig: Rig, conditions: Conditions, *, near: float, far: float, laser: int = 0
) -> Placement:
    """Say what a laser shows from where it is, as `place_laser` judges it; the same arguments."""
    depths = np.linspace(near, far, _NUM_DEPTHS)
    return _judge(rig, conditions, depths, laser, present_place(rig, laser))


def present_place(rig: Rig, laser: int = 0) -> tuple[float, float]:
    """Give baseline [m], without its sign, and angle [rad] of a rig's laser as it is."""
    plane = equivalent_plane(rig.laser(laser), refractive_index(rig.water, rig.wavelength))
    along, forward = plane.normal["xy".index(rig.laser(laser).axis)], plane.normal[2]
    return abs(float(plane.distance / along)), math.atan2(abs(along), abs(forward))


def as_if(rig: Rig, baseline: float | None, angle: float | None, laser: int = 0) -> Rig:
    """Put a laser where it is asked about, what is not said as it is; the rig itself without both.

    Args:
        rig: The rig.
        baseline: Distance of the laser from the camera [m].
        angle: From the baseline to its sheet [rad].
        laser: Number of the laser.

    Raises:
        InputError: The baseline is not positive, or the sheet does not look ahead.
    """
    if baseline is None and angle is None:
        return rig
    now = present_place(rig, laser)
    far, lean = baseline or now[0], angle or now[1]
    if not (far > 0 and 0 < lean < math.pi):
        raise InputError(
            f"A laser has a baseline above 0 and an angle between 0 and 180 degrees, not "
            f"{far * 1e3:g} mm and {math.degrees(lean):g} degrees."
        )
    return _move(rig, far, lean, laser)


def _candidates(
    rig: Rig, near: float, far: float, longest: float, laser: int
) -> Iterator[tuple[Rig, tuple[float, float]]]:
    """Move the laser about."""
    for baseline in np.geomspace(_SHORTEST, longest, _BASELINES):
        for crossing in np.linspace(near, far, _CROSSINGS):
            angle = math.atan2(crossing, float(baseline))
            yield _move(rig, float(baseline), angle, laser), (float(baseline), angle)


def _move(rig: Rig, baseline: float, angle: float, laser: int) -> Rig:
    """Put a laser at a place, without a window: it is taken to look straight through one."""
    old = as_fan(rig.laser(laser))
    axis = rig.laser(laser).axis
    at = "xy".index(axis)
    axes = np.eye(3)
    side = -math.copysign(1.0, old.origin[at] or -1.0)
    ahead = side * math.cos(angle) * axes[at] + math.sin(angle) * axes[2]
    fan = Fan.spread(-side * baseline * axes[at], ahead, axes[1 - at], old.half_angle)
    lasers = list(rig.lasers)
    lasers[laser] = Laser(fan, axis)
    return replace(rig, lasers=tuple(lasers))


def _judge(
    rig: Rig, conditions: Conditions, depths: np.ndarray, laser: int, place: tuple[float, float]
) -> Placement:
    seen: Forecast = forecast(rig, conditions, depths=depths, laser=laser, num_lines=_NUM_LINES)
    share = float((seen.share_found * seen.share_in_view).mean())
    sigma = seen.median(np.hypot(seen.sigma_along, seen.sigma_speckle))
    return Placement(*place, share, float(np.nanmax(sigma, initial=0.0)), rig)
