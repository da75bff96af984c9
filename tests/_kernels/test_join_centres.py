"""Centres of a ball that are exact stay where they are when they are joined."""

import numpy as np
import pytest

from murkscan._kernels.join_centres import join_centres

RADIUS = 40.0
"""[mm], and about as many scan lines."""
PX_PER_MM = 0.4
"""By which a centre moves where the surface is nearer: the PAL rig of the scenes, 0.9 m away."""
FRAMES, SIGMA, ROUGH = range(-2, 3), 0.05, 0.04


def join_ball(at: np.ndarray, middle: float, travel: float) -> np.ndarray:
    """Join exact centres of the frame in which the ball lies so far off; gives their errors."""
    lines, centres, starts = [], [], [0]
    for frame in FRAMES:
        inside = np.hypot(at, middle + travel * frame) < 0.95 * RADIUS
        lines.append(at[inside])
        off = RADIUS**2 - at[inside] ** 2 - (middle + travel * frame) ** 2
        centres.append(PX_PER_MM * np.sqrt(off))
        starts.append(starts[-1] + int(inside.sum()))
    times = np.repeat(np.array(FRAMES, float), np.diff(starts))
    zero, first, last = np.zeros(starts[-1]), starts[2], starts[3]
    joined = join_centres(
        np.concatenate(lines), times, np.concatenate(centres), zero + SIGMA, zero, zero,
        zero + ROUGH, np.array(starts), first, last, 8.0, 1.0, 1.0, 0.0, 0.0,
    )  # fmt: skip
    errors = joined[:, 0] - centres[2]
    leaning = np.hypot(lines[2], middle) / RADIUS
    return errors[leaning < np.sin(np.deg2rad(45))]


@pytest.mark.parametrize("travel", [1.0, 2.0])
def test_a_ball_is_not_drawn_inwards_nor_to_one_side(travel):
    for middle in (-24.0, -12.0, 0.0, 12.0, 24.0):
        errors = join_ball(np.arange(-38.0, 39.0), middle, travel)
        # A tenth of the noise: 12 µm. What is of fourth order is left at 45 degrees.
        assert abs(errors.mean()) < 0.002
        assert np.abs(errors).max() < 0.1 * SIGMA
