"""The phase function of many sizes of particles, common in ocean optics."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..errors import InputError
from .phase import FINEST, AbstractPhase, Values


@final
@dataclass(frozen=True)
class FournierForand(AbstractPhase):
    """Spheres of one index, whose number falls as a power of their size.

    The default comes close to the mean of Petzold's three harbour stations: bb / b = 0.0183.

    References:
        Fournier and Jonasz, Computer-based underwater imaging analysis, Proc. SPIE 3761, 1999,
        equation for β(θ); Mobley, Sundman and Boss, Phase function effects on oceanic light
        fields, Applied Optics 41(6), 2002, for the default.
    """

    index: float = 1.10
    """Refractive index of the particles relative to water."""
    slope: float = 3.5835
    """Power by which their number falls with their size, the Junge slope."""

    def __post_init__(self) -> None:
        """Refuse particles for which the formula does not hold."""
        if not 1 < self.index <= 1.35:
            raise InputError(
                f"The index of particles in water must lie between 1 and 1.35, got {self.index:g}."
            )
        if not 3 < self.slope < 5:
            raise InputError(
                f"The slope of the particles' sizes must lie between 3 and 5, got {self.slope:g}."
            )

    def at_angle(self, angle: Values) -> Values:
        """Give the density [1/sr] at each angle from straight on [rad], 0 to π."""
        sine2 = np.sin(np.maximum(angle, FINEST) / 2) ** 2
        delta = self._delta(sine2)
        # 0/0 where delta is 1; so near it the limit is not told from its neighbour.
        delta = np.where(abs(delta - 1) < 1e-4, 1 + 1e-4, delta)
        nu, rest, power = self._nu, 1 - delta, delta**self._nu
        near = nu * rest - (1 - power) + (delta * (1 - power) - nu * rest) / sine2
        whole = near / (4 * np.pi * rest**2 * power)
        back = self._delta(1.0)
        tail = (1 - back**nu) / (16 * np.pi * (back - 1) * back**nu)
        return whole + tail * (3 * np.cos(angle) ** 2 - 1)

    @property
    def _nu(self) -> float:
        return (3 - self.slope) / 2

    def _delta(self, sine2: Values | float) -> Values:
        """Give δ at the squared sine of half the angle."""
        return np.asarray(4 / (3 * (self.index - 1) ** 2) * sine2)
