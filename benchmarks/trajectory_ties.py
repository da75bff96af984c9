"""How ties of facets err where the true way puts them, beside what they state."""

import numpy as np

from murkscan.motion.adjust.first_path import first_path, fit_path
from murkscan.motion.adjust.legs import cut_legs
from murkscan.motion.adjust.pairs import make_sides, pair_facets
from murkscan.motion.adjust.settings import AdjustSettings
from murkscan.motion.adjust.ties import linearise
from murkscan.types.trajectory import Trajectory

REACH = 1e-3
"""How far facets may lie apart: that of the last rounds [m]."""
STRETCH = 0.5
"""Time over which errors are added up: some facets along the way [s]."""
STEP = 0.02
"""At which a true way is read [s]."""


def judge_ties(dive):
    """Compare the errors of a single pass's ties between two sheets with what is stated.

    Returns:
        Mean square error over the stated variance; and the variance of sums of errors, each over
        its stated deviation, of a stretch of the way, over that of as many that err by themselves.
    """
    one, way = dive.passes[0], dive.truths[0].way
    settings = AdjustSettings()
    times = np.arange(one.times[0], one.times[-1] + STEP, STEP)
    positions, rotations = way.at(times)
    true = Trajectory(times, positions, rotations.as_quat(scalar_first=True))
    first = first_path(one.navigation, one.times[0], one.times[-1], settings.knot_step, true)
    path = fit_path(first, true)
    sides = make_sides(cut_legs(0, one, path, settings.cell), [path])
    rows = np.ones(len(sides[0].facets.leg.row_times), bool)
    ties = pair_facets(*sides, REACH, len(sides[0].facets), bumps_match=rows)
    off = linearise(ties, [path]).residuals / np.sqrt(ties.variance)
    stretch = (ties.time_a / STRETCH).astype(int)
    sums, squares = np.bincount(stretch, off), np.bincount(stretch, off**2)
    return float(np.mean(off**2)), float((sums**2).sum() / squares.sum())
