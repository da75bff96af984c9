"""Between which depths a rig is made to measure."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from ..errors import InputError
from ..optics import back_project, intersect_rays_with_sheet, refractive_index
from ..types.rig import Rig

FARTHEST = 20.0
"""What lies farther was never seen in water [m]."""


def find_working_range(rig: Rig, laser: int) -> tuple[float, float]:
    """Compute between which depths the sheet crosses the picture [m], along its middle scan line.

    Args:
        rig: The rig.
        laser: Number of the laser.

    Raises:
        InputError: It does not.
    """
    at = "xy".index(rig.laser(laser).axis)
    length = rig.camera.size[at]
    pixels = np.empty((length, 2))
    pixels[:, 1 - at] = (rig.camera.size[1 - at] - 1) / 2
    pixels[:, at] = np.arange(length)
    index = refractive_index(rig.water, rig.wavelength)
    rays = back_project(rig.camera, pixels, index)
    depths = intersect_rays_with_sheet(rays, rig.lasers[laser], index)[:, 2]
    depths = depths[np.isfinite(depths) & (depths > 0)]
    if len(depths) == 0:
        raise InputError(
            f"The sheet of laser {laser} does not cross the picture in front of the camera: check "
            "the signs and the angle in the rig file."
        )
    return float(depths.min()), float(min(depths.max(), FARTHEST))


def find_calibrated_range(record: Mapping[str, Any], laser: int) -> tuple[float, float] | None:
    """Find the nearest and the farthest depth at which a laser's line on a board was seen [m].

    Args:
        record: [calibration] of the rig file, as plain values.
        laser: Number of the laser.

    Returns:
        Both; None where the file does not say, or tells of one depth only.
    """
    depths = sorted(_depths(record, f"a point of laser {laser}"))
    if len(depths) < 2 or not depths[0] < depths[-1]:
        return None
    return depths[0] / 1e3, depths[-1] / 1e3


def _depths(record: Mapping[str, Any], what: str) -> Iterator[float]:
    """Give the depths of all errors of a kind, in whichever step they stand [mm]."""
    for value in record.values():
        if isinstance(value, Mapping):
            yield from _depths(value, what)
    for error in record.get("errors", ()):
        if isinstance(error, Mapping) and error.get("what") == what:
            yield float(error["distance_mm"])
