"""What the rig's sheets say of where a stripe runs, and which of two lasers a ridge belongs to."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy
from jaxtyping import Float

from .._kernels.ridges import pool_along
from ..errors import InputError
from ..optics import back_project, equivalent_plane, intersect_rays_with_sheet, refractive_index
from ..types.arrays import Scalars
from ..types.background import Background
from ..types.frame import Frame
from ..types.rig import Rig
from .ridges import Ridges
from .scan_lines import ScanLines

_GRID = 8
"""Full-frame pixels from one to the next of those at which sheets are compared."""
_RELIEF = 12.0
"""Full-frame pixels by which a stripe lies elsewhere than another of the same distance: surfaces
have relief between them."""
_FAINT, _SURE = 3.0, 5.0
"""Score from which a ridge may be a stripe for the other laser to be told by, and how much more it
takes to be one."""
_CLEAR, _TRACK, _STEEP, _GAP = 3.5, 40, 0.7, 2
"""Score from which ridges are followed over scan lines, how many to both sides, the steepest step
[px a line], and the lines that may be missing: what one line does not tell, its neighbours do."""
_ALONE, _MOST = 0.05, 20.0
"""What a ridge without a partner counts for, and the bound of the logarithm of the ratio."""
_NOWHERE = 1e9

Table = Float[np.ndarray, "rows columns"]
Probability = Float[np.ndarray, "lines most"]


def look_along(
    frames: Iterable[Frame], rig: Rig, background: Background, laser: int
) -> Iterator[ScanLines]:
    """Look at frames along a laser's scan lines, without what is fixed to the picture.

    Args:
        frames: The frames.
        rig: The rig that recorded them.
        background: What `Murk` has learnt of the recording.
        laser: Number of the laser.

    Raises:
        InputError: Another extractor has learnt it.
    """
    if background.levels is None or not background.shapes:
        raise InputError("Murk needs what it has learnt itself: give what its `learn` gave.")
    look = partial(
        ScanLines.of,
        axis=rig.laser(laser).axis,
        noise=background.levels,
        fixed=background.fixed,
        slope=expected_slope(rig, laser),
    )
    return map(look, frames)


def expected_slope(rig: Rig, laser: int) -> float:
    """Give the slope that a laser's stripe has on an even wall before the camera.

    A wall at right angles to the optical axis cuts a flat sheet along the same direction at any
    distance. Distortion, and the bending of a sheet by its window, are left out.

    Returns:
        Full-frame pixels along a scan line for each one across scan lines.
    """
    sheet = rig.laser(laser)
    normal = equivalent_plane(sheet, refractive_index(rig.water, rig.wavelength)).normal
    along = "xy".index(sheet.axis)
    focal = rig.camera.focal_length
    return float(-normal[1 - along] * focal[along] / (normal[along] * focal[1 - along]))


@dataclass(frozen=True, eq=False)
class OtherLasers:
    """Where a laser's stripe lies beside those of the rig's other lasers.

    Two sheets meet a surface at places near one another, so both stripes tell the same distance:
    where ridges of a scan line are as far apart as the sheets have it, each is known.
    """

    own: tuple[Table, ...]
    """Position of the own stripe where the surface is that another's shows, by pixel."""
    others: tuple[Table, ...]
    """Position of another's stripe where the surface is that the own shows, by pixel."""

    @classmethod
    def of(cls, rig: Rig, laser: int) -> "OtherLasers":
        """Compare a laser's sheet with those of all others."""
        if len(rig.lasers) == 1:
            return cls((), ())
        depths = [_depths(rig, number) for number in range(len(rig.lasers))]
        rest = [depth for number, depth in enumerate(depths) if number != laser]
        own = tuple(_look_up(depth, depths[laser]) for depth in rest)
        others = tuple(_look_up(depths[laser], depth) for depth in rest)
        return cls(own, others)

    def tell(self, ridges: Ridges) -> Probability:
        """Tell of each ridge how probably it is this laser's, if it is one's at all."""
        told = np.zeros(ridges.positions.shape)
        if not self.own:
            return np.ones(told.shape)
        from scipy.ndimage import map_coordinates  # a fifth of a scan's imports, for two lasers

        lines = ridges.lines
        line, which = np.nonzero(ridges.exist)
        place = np.full(told.shape, _NOWHERE)
        place[line, which] = lines.as_full_frame(ridges.positions[line, which])
        sure = np.where(ridges.exist, np.clip((ridges.heights - _FAINT) / _SURE, 0.0, 1.0), 0.0)
        across = lines.full_frame_lines(line.astype(float)) / _GRID
        for own, other in zip(self.own, self.others, strict=True):
            expected = np.full((2, *told.shape), -_NOWHERE)
            at = np.stack([place[line, which] / _GRID, across])
            for number, table in enumerate((own, other)):
                expected[number, line, which] = map_coordinates(table, at, order=1, mode="nearest")
            support = [
                np.sum(
                    sure[:, None, :] * np.exp(-np.abs(place[:, :, None] - e[:, None, :]) / _RELIEF),
                    axis=2,
                )
                for e in expected
            ]
            ratio = np.log((support[0] + _ALONE) / (support[1] + _ALONE))
            told += np.where(ridges.exist, ratio, 0.0)
        marks = ridges.exist & (ridges.heights > _CLEAR)
        own_track = ridges.positions, ridges.counts, marks
        pooled = pool_along(*own_track, np.where(marks, told, 0.0), _TRACK, _STEEP, _GAP)
        return scipy.special.expit(np.clip(np.where(marks, pooled, told), -_MOST, _MOST))


def _depths(rig: Rig, laser: int) -> Table:
    """Compute the distance along the optical axis at which pixels see a sheet [m], by pixel."""
    sheet = rig.laser(laser)
    along = "xy".index(sheet.axis)
    sizes = [np.arange(0, size + _GRID, _GRID, dtype=float) for size in rig.camera.size]
    position, line = np.meshgrid(sizes[along], sizes[1 - along], indexing="ij")
    pixels = np.stack([position, line] if along == 0 else [line, position], axis=-1)
    index = refractive_index(rig.water, rig.wavelength)
    rays = back_project(rig.camera, pixels.reshape(-1, 2), index)
    with np.errstate(invalid="ignore"):
        depths = intersect_rays_with_sheet(rays, sheet, index)[:, 2]
    return np.where(depths > 0, depths, np.nan).reshape(position.shape)


def _look_up(depths: Table, wanted: Table) -> Table:
    """Give where a sheet is seen at the depths that another one has, by pixel.

    Args:
        depths: Of the sheet that is given, by its own pixels.
        wanted: Of the sheet that is looked for.
    """
    positions = np.full(depths.shape, -_NOWHERE)
    every = np.arange(len(depths)) * float(_GRID)
    for line in range(depths.shape[1]):
        positions[:, line] = _invert(every, wanted[:, line], depths[:, line])
    return positions


def _invert(places: Scalars, depths: Scalars, wanted: Scalars) -> Scalars:
    """Find the places at which depths, which rise or fall with the place, are as wanted."""
    known = np.isfinite(depths)
    if known.sum() < 2:
        return np.full(len(wanted), -_NOWHERE)
    inverse, places = 1.0 / depths[known], places[known]
    order = np.argsort(inverse)
    found = np.interp(1.0 / wanted, inverse[order], places[order], left=-_NOWHERE, right=-_NOWHERE)
    return np.where(np.isfinite(wanted), found, -_NOWHERE)
