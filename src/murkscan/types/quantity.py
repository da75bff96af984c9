"""A measured number, and how far to trust it."""

import math
from dataclasses import dataclass

from scipy.special import stdtrit

_COVERED = 0.95


@dataclass(frozen=True)
class Quantity:
    """A number with both parts of its uncertainty."""

    name: str
    """What was measured, such as `radius`."""
    value: float
    """The number, in its unit."""
    unit: str
    """m, m2, m3, rad, or nothing for a ratio."""
    sigma_independent: float
    """Standard deviation from what differs between points, in the same unit."""
    sigma_common: float | None
    """Standard deviation from what the whole scan shares; None where the rig states nothing."""
    degrees: float = math.inf
    """Degrees of freedom behind `sigma_independent`: few where few independent errors were seen."""

    @property
    def sigma(self) -> float:
        """Standard deviation of both parts together; of the first alone where the other is unknown.

        References:
            JCGM 100:2008, section 5.1.2.
        """
        return math.hypot(self.sigma_independent, self.sigma_common or 0.0)

    @property
    def half_width(self) -> float:
        """Half the width of the 95 % interval.

        References:
            JCGM 100:2008, annex G.4, equation (G.2b), the Welch-Satterthwaite formula.
        """
        if self.sigma == 0:
            return 0.0
        share = (self.sigma_independent / self.sigma) ** 4
        degrees = self.degrees / share if share else math.inf
        return float(stdtrit(min(degrees, 1e9), (1 + _COVERED) / 2)) * self.sigma

    @property
    def interval(self) -> tuple[float, float]:
        """Within which the truth lies in 95 of 100 cases, in the same unit."""
        return self.value - self.half_width, self.value + self.half_width
