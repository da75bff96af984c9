"""An alignment in words, and the other way round."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..types.arrays import Vector
from ..types.pose import Pose
from .alignment import Alignment, Pairs


def describe_alignment(alignment: Alignment | None, *, whose: str = "it") -> str:
    """Say how a pass was moved, how well that is known, and what stays open.

    Args:
        alignment: How; None: it stays.
        whose: What its overlap is a share of.
    """
    if alignment is None:
        return "stays where it is"
    shift, turn = motion_of_overlap(alignment)
    sigma = np.sqrt(np.diag(alignment.covariance))
    words = (
        f"moved {_with_sigma(shift * 1e3, sigma[3:] * 1e3)} mm along x, y, z and turned "
        f"{_with_sigma(np.degrees(turn), np.degrees(sigma[:3]))} deg about them; "
        f"{alignment.overlap:.0%} of {whose} overlaps, {alignment.rms * 1e3:.2f} mm RMS apart"
    )
    if alignment.open_directions:
        words += f"; open, so as logged: {', '.join(map(str, alignment.open_directions))}"
    return words


def turn_round(alignment: Alignment) -> Alignment:
    """Give the alignment that lays the target on the source instead; overlap and matches stay."""
    back = alignment.correction.inverse()
    both = np.kron(np.eye(2), back.rotation)
    return replace(
        alignment,
        target_from_source=back,
        centre=(back @ alignment.centre[None])[0],
        covariance=both @ alignment.covariance @ both.T,
        open_directions=tuple(
            replace(one, axis=back.rotation @ one.axis, through=(back @ one.through[None])[0])
            for one in alignment.open_directions
        ),
        start=Pose.identity(),
        pairs=Pairs.none(),
    )


def motion_of_overlap(alignment: Alignment) -> tuple[Vector, Vector]:
    """Compute how far the middle of the overlap moves [m], and the turn about it [rad]."""
    correction = alignment.correction
    before = correction.inverse() @ alignment.centre[None]
    turn = Rotation.from_matrix(correction.rotation).as_rotvec()
    return alignment.centre - before[0], turn


def _with_sigma(numbers: np.ndarray, sigma: np.ndarray) -> str:
    """Write numbers with the digits that show the smallest sigma."""
    least = float(min(sigma[sigma > 0], default=0.01))
    digits = int(np.clip(-np.floor(np.log10(least)), 2, 7))
    return f"{_three(numbers, digits)} ± {_three(sigma, digits)}"


def _three(numbers: np.ndarray, digits: int) -> str:
    return "(" + ", ".join(f"{number:.{digits}f}" for number in numbers + 0.0) + ")"
