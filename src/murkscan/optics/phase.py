"""What every phase function can do: tell how scattered light spreads over directions."""

import abc
from functools import lru_cache

import numpy as np
from jaxtyping import Float

from ..types.arrays import Scalars

Values = Float[np.ndarray, "*shape"]
"""Numbers in an array of any shape."""

FINEST = 1e-7
"""Angle below which a phase function counts as flat [rad]: in the sea they have no bound at 0."""


class AbstractPhase(abc.ABC):
    """The share of scattered light that goes into each direction.

    Subclasses are final and hashable, because what is computed from one is kept.
    """

    @abc.abstractmethod
    def at_angle(self, angle: Values) -> Values:
        """Give the density [1/sr] at each angle from straight on [rad], 0 to π.

        Over the sphere it adds up to 1.
        """

    def at_cosine(self, cosine: Values) -> Values:
        """Give the density [1/sr] at each cosine of the angle from straight on."""
        return self.at_angle(np.arccos(np.clip(cosine, -1.0, 1.0)))

    @property
    def mean_cosine(self) -> float:
        """The mean cosine of the angle: 1 straight on, 0 as much ahead as back."""
        return _moments(self)[0]

    @property
    def backscatter_ratio(self) -> float:
        """The share that is scattered by more than a right angle, bb / b."""
        return _moments(self)[1]


def ring_angles() -> Scalars:
    """Give angles [rad] from the finest to π that resolve every phase function."""
    return np.concatenate([np.geomspace(FINEST, 0.1, 1500), np.linspace(0.1, np.pi, 3000)[1:]])


def integrate_rings(density: Scalars, angle: Scalars) -> float:
    """Integrate a density [1/sr] that is symmetric about straight on over the sphere."""
    # By the logarithm of the angle, in which peak and tail are equally smooth.
    return float(np.trapezoid(2 * np.pi * density * np.sin(angle) * angle, np.log(angle)))


@lru_cache(maxsize=32)
def _moments(phase: AbstractPhase) -> tuple[float, float]:
    """Give the mean cosine, and the share beyond a right angle."""
    angle = ring_angles()
    behind = np.linspace(np.pi / 2, np.pi, 3000)
    mean = integrate_rings(phase.at_angle(angle) * np.cos(angle), angle)
    return mean, integrate_rings(phase.at_angle(behind), behind)
