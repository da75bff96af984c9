"""How uneven light draws a stripe's centres: along it by the lens's blur, and across it."""

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
_TOLD = 2.0
"""Standard deviations by which a stripe is darker than on both sides, to tell of it."""
_EVEN = 0.5
"""How much a change of light draws a centre, beside being darker than both sides: paint has more of
such that lie right across the stripe."""
_MOST = 2.0
"""Widths of a stripe by which it is drawn at most: what is left of it is no farther from its
middle."""

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
    dip: Scalars
    """By how much a centre is darker than on both sides, as far as noise tells [e-folds]."""

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
        dip = _told(found[:, 4], _TOLD * spread)
        return cls(slope + lines.slope, change, unsure, found[:, 3], dip)

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

    def draw(self, width: float) -> Scalars:
        """Estimate how far what darkens a stripe of that width unevenly draws its centres [px].

        A scratch or dirt on the window, or an edge of paint, seldom lies right across the stripe:
        it darkens one side of it more, and all frames in which it stays show a centre beside the
        surface. By how much, the light along the stripe does not tell, but the more it changes, the
        more: for changes of .1 to .5 in a stripe's width, the mean of five frames errs by half of
        their square on a hull, in widths, and by up to five times that on scratches
        (benchmarks/murk.py, c3, c3-still, seed 10, and the demo); where a line is darker than both
        sides, by the square and more on scratches, and by a tenth of it on a hull. How much it is
        in a recording, `Alike` measures.
        """
        change = width * _told(self.change, self.unsure)
        return np.minimum(width * (self.dip**2 + _EVEN * change**2), width * _MOST)


def _told(value: Scalars, noise: Scalars) -> Scalars:
    """Compute what is left of a value without what its noise adds to its square."""
    return np.asarray(np.sqrt(np.maximum(value**2 - noise**2, 0.0)))


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
