"""What the lens's blur along a stripe does: brighter scan lines pull at their neighbours."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from .._kernels.slants import measure_slants
from ..types.arrays import Indices, Scalars
from .scan_lines import ScanLines

_STEP = 3.0
"""Pixels a line, from an even wall's slope, by which a surface's stripe may go on."""
_DARKEST = 0.1
"""Least light whose logarithm means anything [grey levels]."""
UNSURE = 0.25
"""Share of the pull that stays unknown: skirt, a lens that is no Gaussian, a bend of the stripe."""

Pull = Float[np.ndarray, "n 2"]
"""By how much a blur of 1 px² draws each centre, and the standard deviation of that [px]."""


@dataclass(frozen=True, eq=False)
class Slants:
    """How a stripe slants, and how its light changes, at each centre."""

    slope: Scalars
    """Full-frame pixels along its scan line for each one across scan lines."""
    change: Scalars
    """Change of the logarithm of its light [1/px of the full frame]."""
    unsure: Scalars
    """Standard deviation of that."""
    dark: Scalars
    """By how much the last centre before a gap is darker than those further in [e-folds]."""

    @classmethod
    def of(
        cls,
        lines: ScanLines,
        scan_lines: Indices,
        positions: Scalars,
        *,
        light: Scalars,
        spread: Scalars,
    ) -> "Slants":
        """Measure them from the centres around.

        Args:
            lines: The frame.
            scan_lines: Scan line of each centre; they do not decrease.
            positions: Where it lies in it [full-frame px].
            light: Height of the stripe [grey levels].
            spread: Standard deviation of the light, as a share of it.
        """
        straight = positions - lines.even_wall(scan_lines.astype(float))
        logs, step = np.log(np.maximum(light, _DARKEST)), _STEP
        found = measure_slants(scan_lines, straight, logs, np.minimum(spread, 1.0), step)
        slope, change, unsure = (found[:, :3] / lines.line_step).T
        return cls(slope + lines.slope, change, unsure, found[:, 3])

    def pull(self) -> Pull:
        """Compute how far each centre is drawn along its scan line towards brighter neighbours.

        A scan line shows light of its neighbours as well, blurred along the stripe by a variance b.
        The mean place that it comes from is off by b times the derivative of the logarithm of the
        light that is seen (Tweedie's formula), and a stripe that slants by s lies s times as far
        off.

        References:
            Efron, Tweedie's formula and selection bias, JASA 106(496), 2011, equation 1.4.
        """
        return np.stack([self.slope * self.change, np.abs(self.slope) * self.unsure], axis=1)


def undo_pull(pull: Pull, blur: float) -> Float[np.ndarray, "n 3"]:
    """Compute what a blur adds to each centre, what noise that has, and what is unknown of it [px].

    What is no more than its own noise is left, and what is more is shrunk by it. What is unknown is
    a share of the blur: all centres of a frame err by it together, each with the sign of its pull.

    Args:
        pull: Of each centre.
        blur: Variance of the blur along the stripe [px²].

    References:
        Breiman, Better subset regression using the nonnegative garrote, Technometrics 37(4), 1995.
    """
    size, noise = np.abs(pull[:, 0]), pull[:, 1]
    share = np.maximum(1.0 - (noise / np.maximum(size, 1e-12)) ** 2, 0.0)
    added = blur * share * pull[:, 0]
    return np.stack([added, blur * np.minimum(noise, size), UNSURE * added], axis=1)
