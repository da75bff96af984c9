"""What the rig's sheets say of where a stripe runs, before any picture is looked at."""

from ..optics import equivalent_plane, refractive_index
from ..types.rig import Rig


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
