"""The glow of the laser's sheet: what the water scatters towards the camera at once."""

import numpy as np

from ..types.arrays import Directions, Scalars
from .medium import Medium


def sheet_glow(
    laser_directions: Directions,
    camera_directions: Directions,
    sheet_normals: Directions,
    *,
    laser_range: Scalars,
    camera_range: Scalars,
    line_power: Scalars,
    medium: Medium,
) -> Scalars:
    """Give the radiance that reaches the camera by one scattering in a thin sheet.

    Each item is a camera's ray and the one point in which it crosses the sheet. All three
    directions are unit vectors in one frame.

    Args:
        laser_directions: The way the light travels along the sheet at the point.
        camera_directions: The way the camera looks, towards the point.
        sheet_normals: Normal of the sheet at the point, on either side.
        laser_range: Way of the light in the water from the laser to the point [m].
        camera_range: Way of the light in the water from the point to the camera [m].
        line_power: Power per width of the sheet at the point, before attenuation [W/m]; for a fan
            from one point it is its power per angle [W/rad] over the distance from that point.
        medium: The water.

    Returns:
        Radiance [W/m²/sr], whatever the sheet's thickness; infinite where the ray runs along it.

    References:
        Mobley, Light and Water, 1994, section 5.1, the path function for one scattering,
        integrated over the thickness of the sheet.
    """
    cosine = -np.sum(laser_directions * camera_directions, axis=1)
    slant = abs(np.sum(sheet_normals * camera_directions, axis=1))
    left = np.exp(-medium.attenuation * (laser_range + camera_range))
    with np.errstate(divide="ignore"):
        return medium.scattering * medium.phase.at_cosine(cosine) * line_power * left / slant
