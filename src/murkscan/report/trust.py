"""How far to trust the points, as a surveyor reads it: at 68 and at 95 %."""

from dataclasses import dataclass

import numpy as np

from ..types.arrays import Scalars
from .quantiles import Quantiles

AT_95 = 1.96
"""Standard deviations within which a Gaussian error stays in 95 % of the cases."""


@dataclass(frozen=True)
class Trust:
    """Standard deviations of a cloud's points, spread over the points [m]."""

    independent: Quantiles
    """What differs from point to point, along the ray: an average of many has less of it."""
    common: Quantiles | None
    """What all points share, since one rig on one trajectory saw them: no average helps. None where
    nothing is stated of either."""
    total: Quantiles
    """Both together."""


def judge_trust(sigma: Scalars, common: Scalars, *, is_stated: bool) -> Trust:
    """Give the standard deviations of a cloud's points.

    Args:
        sigma: The independent part of each point [m].
        common: The part that the points share [m].
        is_stated: Whether anything is known of that part: of a rig without a covariance nothing is.
    """
    total = np.hypot(sigma, common)
    stated = Quantiles.from_values(common) if is_stated else None
    return Trust(Quantiles.from_values(sigma), stated, Quantiles.from_values(total))
