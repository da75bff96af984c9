"""The phase function that Petzold measured in San Diego Harbor."""

from dataclasses import dataclass
from functools import cache
from typing import final

import numpy as np

from ..types.arrays import Scalars
from .phase import FINEST, AbstractPhase, Values, integrate_rings, ring_angles

_SLOPE = -1.346
"""Power of the angle by which the report goes on below its first angle."""

# fmt: off
_TABLE = np.array([  # angle [deg], volume scattering function at 530 nm [1/(m sr)]
    (0.1, 3262), (0.1259, 2397.4), (0.1585, 1756.6), (0.1995, 1274.5),
    (0.2512, 926.03), (0.3162, 676.37), (0.3981, 502.67), (0.5012, 370.48),
    (0.631, 267.62), (0.7943, 189.74), (1, 132.88), (1.2589, 91.912),
    (1.5849, 62.795), (1.9953, 41.708), (2.5119, 27.365), (3.1623, 17.926),
    (3.9811, 11.723), (5.0119, 7.6549), (6.3096, 5.0388), (7.9433, 3.3017),
    (10, 2.1107), (15, 0.90405), (20, 0.44523), (25, 0.27335),
    (30, 0.16128), (35, 0.11087), (40, 0.079133), (45, 0.058575),
    (50, 0.043884), (55, 0.032882), (60, 0.025483), (65, 0.020408),
    (70, 0.01655), (75, 0.013446), (80, 0.011239), (85, 0.0096372),
    (90, 0.008411), (95, 0.0073961), (100, 0.006694), (105, 0.0062195),
    (110, 0.0058912), (115, 0.0057291), (120, 0.0055491), (125, 0.0053427),
    (130, 0.0051541), (135, 0.004967), (140, 0.0048223), (145, 0.0046347),
    (150, 0.0046344), (155, 0.0048998), (160, 0.0051417), (165, 0.0053587),
    (170, 0.0055497), (175, 0.0056177), (180, 0.0056857),
])
# fmt: on


@final
@dataclass(frozen=True)
class PetzoldHarbour(AbstractPhase):
    """Turbid harbour water, San Diego, station NUC 2040: the usual choice for murky water.

    Total scattering, of water and particles together, at 530 nm: c = 2.19 /m, b = 1.824 /m.
    Between the measured angles the logarithms are interpolated; below the first, 0.1 degrees,
    stand 5 percent of all scattered light, by the report's own power law.

    References:
        Petzold, Volume scattering functions for selected ocean waters, SIO Ref. 72-78, Scripps
        Institution of Oceanography, 1972, table for NUC 2040, with its constants below 0.1 degrees.
    """

    def at_angle(self, angle: Values) -> Values:
        """Give the density [1/sr] at each angle from straight on [rad], 0 to π."""
        nodes, density = _interpolant()
        return np.exp(np.interp(np.log(np.maximum(angle, FINEST)), nodes, density))


@cache
def _interpolant() -> tuple[Scalars, Scalars]:
    """Give the logarithms of angle [rad] and of density [1/sr], normalised."""
    angle, measured = np.radians(_TABLE[:, 0]), _TABLE[:, 1]
    peak = measured[0] * (FINEST / angle[0]) ** _SLOPE
    nodes = np.log(np.concatenate([[FINEST], angle]))
    density = np.log(np.concatenate([[peak], measured]))
    fine = ring_angles()
    total = integrate_rings(np.exp(np.interp(np.log(fine), nodes, density)), fine)
    return nodes, density - np.log(total)
