"""The phase function of one number, common in computer graphics."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..errors import InputError
from .phase import AbstractPhase, Values


@final
@dataclass(frozen=True)
class HenyeyGreenstein(AbstractPhase):
    """A smooth curve with a chosen mean cosine.

    It is too flat ahead and too weak behind for the sea: with Petzold's mean cosine it gives about
    half of the light that harbour water scatters back.

    References:
        Henyey and Greenstein, Diffuse radiation in the galaxy, Astrophysical Journal 93, 1941,
        equation (2).
    """

    g: float = 0.9
    """The mean cosine."""

    def __post_init__(self) -> None:
        """Refuse a mean cosine that no phase function has."""
        if not -1 < self.g < 1:
            raise InputError(f"The mean cosine g must lie between -1 and 1, got {self.g:g}.")

    def at_angle(self, angle: Values) -> Values:
        """Give the density [1/sr] at each angle from straight on [rad], 0 to π."""
        # 1 + g² - 2 g cos ψ, without its cancellation near straight on.
        square = (1 - self.g) ** 2 + 4 * self.g * np.sin(angle / 2) ** 2
        return (1 - self.g**2) / (4 * np.pi * square**1.5)
