"""Correct a scan's trajectory from what it saw of the same places, or say why that cannot be."""

import math

from ..motion import AbstractMotion
from ..motion.corrected import correct_motion
from ..motion.correction_words import tell_correction, tell_doubt, tell_sheets
from ..motion.sheets_apart import compare_sheets
from ..project import Project, load_scan_rig
from ..types.trajectory import Trajectory
from .corrected import Corrected


def correct(project: Project, motion: AbstractMotion, logged: Trajectory) -> Corrected:
    """Correct what is logged, as far as its accuracy is stated and the scan saw places twice.

    Args:
        project: A scan with a finished triangulate stage.
        motion: How the camera moved.
        logged: world_from_camera, by the motion alone.
    """
    rig, measured = load_scan_rig(project), motion.measure()
    if measured is None:
        apart = compare_sheets(project.load_profile_parts(), logged)
        return Corrected(logged, () if apart is None else (tell_sheets(apart),))
    found = correct_motion(measured, project.load_profile_parts(), logged, rig.axes)
    if found is None:
        return Corrected(logged, (_ALONE,))
    if not found.is_sound:
        return Corrected(logged, (tell_doubt(found),))
    moved = math.sqrt(float((found.moved**2).mean()))
    return Corrected(found.trajectory, tell_correction(found), _ACCURACY, moved)


_ALONE = (
    "the trajectory is the log's alone: one laser on one pass sees no place twice. A second laser, "
    "a way back over it, or a crossing pass laid on by `murkscan merge` would tell how it drifts"
)
_ACCURACY = "the log is as good as stated, and the scan itself has corrected it"
