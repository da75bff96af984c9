"""What a rig will see of a wall that faces it, against the distance."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..errors import NotEnoughData
from ..optics import refractive_index
from ..optics.uncertainty import common_sigma
from ..types.arrays import Pixels, Scalars
from ..types.rig import Rig
from .conditions import Conditions
from .scan_line import LineForecast, LineOfSight

VISIBLE = 0.5
"""Bound of a scan line [px] up to which its stripe is found; the ladder's own limit, below which
`Murk` finds more than 95 of 100 (docs/benchmarks/murk.md)."""
_HALF = 0.5
"""Share of points that must be found within the range limit."""
_NUM_LINES = 15
"""Scan lines, spread over the picture, that are looked at."""
_NUM_DEPTHS = 64
_NEAREST, _FARTHEST = 0.05, 20.0
"""Distances that are looked at [m]."""
_DARK = 8.0
"""Attenuation lengths one way beyond which nothing is looked for: the best reach 7.5 (Optics
Express 31:16690, single photons)."""

Grid = Float[np.ndarray, "depths lines"]


@dataclass(frozen=True, eq=False)
class Forecast:
    """What will be seen of a wall at right angles to the optical axis; one depth a row."""

    depths: Scalars
    """Distance of the wall from the camera's centre, along z [m]."""
    bound: Grid
    """The lowest standard deviation of the stripe's centre in each scan line [px]; NaN where the
    stripe lies outside the picture."""
    sigma_along: Grid
    """That of the point along the camera's ray, by the picture's noise [m]."""
    sigma_speckle: Grid
    """What speckle adds along the ray on rough paint, independent of the light [m]; averaging over
    motion lowers it."""
    sigma_across: Grid
    """That across it, by the width of a scan line [m]."""
    sigma_common: Grid
    """That which the calibration's errors give all points alike [m]; 0 where it states none."""
    spacing: Grid
    """Distance from one point to the next along the stripe [m]."""
    peak: Grid
    """Stripe in its brightest pixel [electrons]."""
    background: Grid
    """Light of the water and of the day at the stripe [electrons]."""

    @property
    def share_in_view(self) -> Scalars:
        """Share of the scan lines in which the wall's stripe lies in the picture."""
        return np.isfinite(self.bound).mean(axis=1)

    @property
    def share_found(self) -> Scalars:
        """Share of those in which it is found; 0 where the picture holds no stripe."""
        seen = np.isfinite(self.bound)
        found = (np.nan_to_num(self.bound, nan=np.inf) <= VISIBLE).sum(axis=1)
        return found / np.maximum(seen.sum(axis=1), 1)

    @property
    def reach(self) -> tuple[float, float]:
        """Nearest and farthest depth at which half of the points are found [m].

        Raises:
            NotEnoughData: There is none.
        """
        is_good = self.share_found >= _HALF
        if not is_good.any():
            raise NotEnoughData(
                "This rig will see nothing in this water: give the laser more power, expose "
                "longer, or let its sheet meet the camera's axis nearer."
            )
        good = np.flatnonzero(is_good)
        return float(self.depths[good[0]]), self._cross(int(good[-1]))

    def median(self, values: Grid) -> Scalars:
        """Give the median of values over the scan lines in which the stripe is found.

        NaN where it is found in none.
        """
        found = np.nan_to_num(self.bound, nan=np.inf) <= VISIBLE
        some = np.where(found, values, np.nan)
        result = np.full(len(self.depths), np.nan)
        rows = found.any(axis=1)
        result[rows] = np.nanmedian(some[rows], axis=1)
        return result

    def at(self, values: Scalars, depth: float) -> float:
        """Give a value of another depth by interpolation [m]."""
        return float(np.interp(depth, self.depths, values))

    def _cross(self, last: int) -> float:
        """Interpolate the depth at which the median bound passes what is visible."""
        if last + 1 == len(self.depths):
            return float(self.depths[last])
        if not np.isfinite(self.bound[last + 1]).any():
            return float(self.depths[last])
        with np.errstate(divide="ignore"):
            here, there = (float(np.log(np.nanmedian(self.bound[row]))) for row in (last, last + 1))
        if not np.isfinite(there) or there <= here:
            return float(self.depths[last])
        share = float(np.clip((np.log(VISIBLE) - here) / (there - here), 0, 1))
        return float(self.depths[last] + share * (self.depths[last + 1] - self.depths[last]))


def forecast(
    rig: Rig,
    conditions: Conditions,
    *,
    depths: Scalars | None = None,
    laser: int = 0,
    num_lines: int = _NUM_LINES,
) -> Forecast:
    """Say what a rig will see of a wall that faces it, as simulated pictures would show it.

    The stripe, the glow before it and the light that the water spreads are those of the simulator,
    and σ is the Cramér-Rao bound of single scan lines: neighbouring lines and frames, from which
    finders learn, may do better, and speckle, which is stated beside it, does worse.

    Args:
        rig: Camera, laser, windows and the water's index.
        conditions: Water, light, sensor and surface.
        depths: Distances of the wall [m]; from 5 cm to 8 attenuation lengths, at most 20 m,
            unless given.
        laser: Number of the laser.
        num_lines: Scan lines that are looked at, spread over the picture.

    Raises:
        InputError: The rig has no such laser.

    References:
        `murkscan.optics` for each part of the light; docs/plan.md for what is left out.
    """
    if depths is None:
        far = min(_DARK / max(conditions.medium.attenuation, 1e-3), _FARTHEST)
        depths = np.geomspace(_NEAREST, far, _NUM_DEPTHS)
    index = refractive_index(rig.water, rig.wavelength)
    count = rig.camera.size["yx".index(rig.laser(laser).axis)]
    numbers = ((np.arange(num_lines) + 0.5) * count / num_lines).astype(int)
    lines = [
        LineOfSight.of(rig, conditions, int(number), index=index, laser=laser).forecast(depths)
        for number in numbers
    ]
    return _gather(rig, depths, lines, laser)


def _gather(rig: Rig, depths: Scalars, lines: list[LineForecast], laser: int) -> Forecast:
    bound = np.stack([line.bound for line in lines], axis=1)
    focal = rig.camera.focal_length["yx".index(rig.laser(laser).axis)]
    across = np.stack([line.camera_range for line in lines], axis=1)
    index = refractive_index(rig.water, rig.wavelength) if rig.camera.port else 1.0
    spacing = across / (focal * index)
    return Forecast(
        depths,
        bound,
        bound * np.stack([line.range_per_pixel for line in lines], axis=1),
        np.stack([line.speckle for line in lines], axis=1),
        spacing / np.sqrt(12.0),
        np.stack([_common(line.pixels, rig, laser) for line in lines], axis=1),
        spacing,
        np.stack([line.peak for line in lines], axis=1),
        np.stack([line.background for line in lines], axis=1),
    )


def _common(pixels: Pixels, rig: Rig, laser: int) -> Scalars:
    """Give what the calibration's errors do to each point [m]."""
    if not rig.covariance.names:
        return np.zeros(len(pixels))
    return common_sigma(pixels, rig, laser)
