"""How bright a scan's stripe would have been without distance, water and slope."""

from collections.abc import Mapping, Sequence

import numpy as np

from ..optics.reflectance import StripeBrightness
from ..optics.water import refractive_index
from ..project import Project
from ..types.arrays import Normals, Ratios
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.trajectory import Trajectory


def find_brightness(
    project: Project, rig: Rig, lasers: Sequence[int], attenuation: float | None
) -> dict[int, StripeBrightness]:
    """Tell how bright each laser of a scan makes a stripe.

    Args:
        project: A scan with a finished extract stage.
        rig: Its rig.
        lasers: Numbers of the lasers whose stripes were looked for.
        attenuation: Beam attenuation of the water [1/m]; None: not known, and not corrected for.
    """
    index = refractive_index(rig.water, rig.wavelength)
    return {
        number: StripeBrightness(
            rig.camera,
            rig.lasers[number],
            index,
            attenuation or 0.0,
            _find_width(project, number, rig),
        )
        for number in lasers
    }


def _find_width(project: Project, laser: int, rig: Rig) -> float | None:
    """Give the stripe's commonest width [px of the full frame]; None where nobody has learnt it."""
    known, recording = project.load_background(laser), project.load_scan().recording
    if known is None or not known.shapes:
        return None
    shape = known.shapes[0]
    is_woven = recording is not None and recording.fields_per_picture == 2
    stretch = 2 if is_woven and rig.lasers[laser].axis == "y" else 1
    return shape.width * shape.binning * stretch


def tell_reflectance(
    profile: Profile,
    normals: Normals,
    trajectory: Trajectory,
    brightness: Mapping[int, StripeBrightness],
) -> Ratios:
    """Correct the brightness of the stripe for distance, water and slope.

    Args:
        profile: The points, in the camera frame.
        normals: The surface's normals there, in the world.
        trajectory: world_from_camera.
        brightness: How bright each laser makes a stripe.

    Returns:
        See `PointCloud.reflectance`.
    """
    world = trajectory.transform(profile.points, profile.time)
    ahead = trajectory.to_camera(world + normals, profile.time) - profile.points
    told = np.zeros(len(profile), np.float32)
    for number, bright in brightness.items():
        mine = profile.laser == number
        shares = bright.of(profile.points[mine], ahead[mine])
        told[mine] = np.nan_to_num(profile.signal[mine] / shares)
    return told
