"""Correct a scan's trajectory from what it saw of the same places, or say why that cannot be."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ..motion import AbstractMotion
from ..motion.corrected import correct_motion
from ..motion.correction_words import tell_correction, tell_doubt, tell_sheets
from ..motion.sheets_apart import compare_sheets
from ..project import Project, load_scan_rig
from ..types.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Corrected:
    """The poses of a scan, and what is to be said of them."""

    trajectory: Trajectory
    words: tuple[str, ...] = ()
    accuracy: str = ""
    """How well the poses are known, in words, where the scan has corrected them."""
    moved: float | None = None
    """How far they were moved, RMS [m]."""


def is_correctable(motion: AbstractMotion, lasers: Sequence[int]) -> bool:
    """Tell whether a scan may know better than its motion: of a straight pass two lasers do."""
    measured = motion.measure()
    return len(lasers) > 1 or (measured is not None and measured.is_placed)


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
