"""A length between two points of a scan, and how far to trust it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..errors import Degenerate
from ..types.arrays import Points


@dataclass(frozen=True)
class Length:
    """A length and its standard deviations."""

    value: float
    """The length [m]."""
    sigma_independent: float
    """Standard deviation from what differs between the two points [m]."""
    sigma_common: float
    """Standard deviation from what they share [m]: how their common errors stretch the length."""

    @property
    def sigma(self) -> float:
        """Standard deviation of the length [m]."""
        return float(np.hypot(self.sigma_independent, self.sigma_common))


def measure_length(
    ends: Points,
    independent: Float[np.ndarray, "2 3"],
    common: Float[np.ndarray, "2 3 modes"],
) -> Length:
    """Give the distance of two points.

    What both points share moves them together and hardly changes their distance: a sheet that
    lies 1 mm off moves two neighbours by the same millimetre.

    Args:
        ends: The two points [m].
        independent: How far each may be off by itself, at one standard deviation [m], such as
            `sigma` along its ray.
        common: How far each moves with each error that both share [m], in the same frame: what
            `common_shifts` gives, turned to the world.

    Raises:
        Degenerate: The points coincide, so that their distance has no direction.

    References:
        JCGM 100:2008, section 5.2.2, equation (13).
    """
    apart = ends[1] - ends[0]
    value = float(np.linalg.norm(apart))
    if value == 0:
        raise Degenerate("The two points of a length coincide; pick two different ones.")
    along = apart / value
    stretches = along @ (common[1] - common[0])
    return Length(
        value,
        sigma_independent=float(np.linalg.norm(independent @ along)),
        sigma_common=float(np.linalg.norm(stretches)),
    )
