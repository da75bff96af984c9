"""How far the points of a scan move with the errors of its rig, for the page to measure with."""

import numpy as np

from ..optics.seen_points import shifts_in_camera
from ..project import Project, load_moving_rig
from ..view import ShiftField, choose_fairly, fit_shift_field

_TRACED = 3000
"""Points that stand for all: the shifts vary slowly."""
_FEWEST = 100


def trace_shift_field(project: Project) -> ShiftField | None:
    """Give the field of a scan's shifts; None where the rig states no covariance, or few points.

    Raises:
        MissingResult: The motion stage has not been finished.
    """
    rig = load_moving_rig(project)
    if not rig.covariance.names:
        return None
    profile = project.load_profile()
    some = profile[choose_fairly(len(profile), _TRACED)]
    shifts = shifts_in_camera(some.pixels, some.laser, rig)
    seen = np.isfinite(shifts).all(axis=(1, 2))
    if np.count_nonzero(seen) < _FEWEST or not shifts[seen].any():
        return None
    return fit_shift_field(some.points[seen], shifts[seen])
