r"""How scattering on the way spreads the light of a point over the picture.

The light of a point S reaches the camera C straight, and by way of places X on which it is
scattered by ψ = θ + α::

                     X
                 . '   ' .
             . '           ' .
      C  . '  θ         α    ' .  S
        ─────────────────────────
                    R

On its way from the laser to S light is spread in the same manner, read from right to left.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from jaxtyping import Float

from ..types.arrays import Scalars
from .phase import FINEST, AbstractPhase, Values

RADII = np.geomspace(1e-6, 1e3, 1024)
"""Distance in the picture from where the light belongs, as the tangent of an angle."""

Emission = Callable[[Values], Values]
"""Light sent off the direct way by each angle [rad], relative to that on it."""

_BIAS = -0.6
"""Power of the radius by which both ends become small, as the transform likes it."""
_LOWEST = 0.5
"""Frequency below which the spectrum is drawn straight to its value at 0, which is known."""
_BLUR, _SHARPEST = 0.125, 5e-4
"""A density is looked at through a round Gaussian of this share of the radius, and no finer."""
_PHASES = np.concatenate([np.geomspace(1e-6, 0.5, 400), np.linspace(0.5, 40.0, 800)[1:]])
"""Products of radius and frequency over which a density is summed up; there its blur ends it."""


@dataclass(frozen=True, eq=False)
class OneScattering:
    """Light scattered once on its way, by radius and by the angle α at which it sets out."""

    light: Float[np.ndarray, "n m"]
    """Per area of the tangent plane, relative to the direct light, for a scattering depth of 1."""
    detour: Float[np.ndarray, "n m"]
    """By how much the way is longer than the direct one, relative to that."""

    @classmethod
    def of(cls, phase: AbstractPhase, emission: Emission) -> "OneScattering":
        """Follow light that sets out by up to a right angle off the direct way.

        References:
            Wells, Loss of resolution in water as a result of multiple small-angle scattering,
            J. Opt. Soc. Am. 59, 1969, equation (11), here without its small angles: the law of
            sines turns the integral of p(ψ) e(α) / XS² over CX into that of p(ψ) e(α) over α.
        """
        theta = np.arctan(RADII)[:, None]
        nodes = np.pi / 2 * np.concatenate([[0.0], np.geomspace(1e-8, 1.0, 400)])
        psi = theta + nodes
        detour = (np.sin(nodes) + np.sin(theta)) / np.maximum(np.sin(psi), FINEST) - 1
        light = phase.at_angle(psi) * emission(nodes) * _shares(nodes)
        # A picture's plane shows a solid angle on an area of 1 / cos³ θ of it.
        return cls(light * np.cos(theta) ** 3 / np.sin(theta), np.maximum(detour, 0.0))

    def repeat(self, depth: float, radii: Scalars, *, absorption: float) -> Scalars:
        """Give the density at some radii of light that is scattered once or more often.

        It is looked at through a Gaussian of the variance `blur_of(radii)`, which leaves so smooth
        a curve what it is, but for the peak itself.

        Args:
            depth: Scattering depth b·R of the whole way.
            radii: Where to look, as tangents.
            absorption: e-foldings that absorption takes from one direct leg, a·R.

        References:
            Mertens and Replogle, Use of point spread and beam spread functions for analysis of
            imaging systems in water, J. Opt. Soc. Am. 67, 1977: each scattering is a power in the
            Hankel domain, the sum of all an exponential.
        """
        frequency, spectrum = _transform(self._add_up(absorption))
        at = _PHASES / radii[:, None]
        many = np.expm1(depth * np.interp(np.log(at), np.log(frequency), spectrum))
        seen = many * np.exp(-0.5 * at**2 * blur_of(radii)[:, None])
        return (
            seen @ (_PHASES * scipy.special.j0(_PHASES) * _shares(_PHASES)) / (2 * np.pi * radii**2)
        )

    def _add_up(self, absorption: float) -> Scalars:
        """Give the density at each of `RADII` of light scattered once."""
        return np.sum(self.light * np.exp(-absorption * self.detour), axis=1)


def blur_of(radii: Scalars) -> Scalars:
    """Give the variance of the Gaussian through which a density is looked at, at some radii."""
    return np.maximum(_BLUR * radii, _SHARPEST) ** 2


def _transform(density: Scalars) -> tuple[Scalars, Scalars]:
    """Give the frequencies and the Hankel transform of a density at `RADII`."""
    step = np.log(RADII[1] / RADII[0])
    fft = scipy.fft  # loaded when due
    offset = fft.fhtoffset(step, mu=0, bias=_BIAS)
    frequency = np.exp(offset) / RADII[::-1]
    spectrum = (
        2 * np.pi * fft.fht(RADII * density, step, mu=0, offset=offset, bias=_BIAS) / frequency
    )
    total = np.trapezoid(2 * np.pi * density * RADII**2, np.log(RADII))
    slope = (np.interp(_LOWEST, frequency, spectrum) - total) / _LOWEST
    return frequency, np.where(frequency < _LOWEST, total + slope * frequency, spectrum)


def _shares(nodes: Scalars) -> Scalars:
    """Give the share of each node in an integral by trapezia."""
    steps = np.diff(nodes, prepend=nodes[0], append=nodes[-1])
    return (steps[1:] + steps[:-1]) / 2
