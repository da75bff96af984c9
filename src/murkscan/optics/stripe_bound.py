"""The lowest standard deviation that a stripe's centre can be found with."""

import numpy as np
from jaxtyping import Float

from ..types.arrays import Scalars

Windows = Float[np.ndarray, "n pixels"]
"""The pixels around one centre a row."""


def bound_of_position(slope: Windows, weight: Windows) -> Scalars:
    """Add up the Fisher information of the pixels around each centre.

    Args:
        slope: Derivative of each pixel's noise-free light by the centre's position
            [electrons/px].
        weight: One over the variance of each pixel [1/electrons²]; 0 where it tells nothing.

    Returns:
        The lowest standard deviation that an unbiased estimate from these pixels alone can have
        [px]; infinite where they tell nothing.

    References:
        Kay, Fundamentals of Statistical Signal Processing: Estimation Theory, 1993, section 3.5.
    """
    known = (weight * slope.astype(float) ** 2).sum(axis=1)
    with np.errstate(divide="ignore"):
        return 1 / np.sqrt(known)
