"""Forward scattering as a picture shows it: a sharp peak on a broad skirt."""

from dataclasses import dataclass
from functools import lru_cache
from typing import final

import numpy as np
from jaxtyping import Float

from ..errors import InputError
from ..types.arrays import Scalars
from .medium import Medium
from .phase import AbstractPhase, Values
from .spread_kernel import Emission, OneScattering, blur_of

WIDTHS = np.geomspace(5e-4, 0.9, 11)
"""1σ of the Gaussians, as the tangent of an angle."""
_DEPTHS = np.concatenate([[1e-3], np.geomspace(0.03, 20.0, 20)])
"""Scattering depths of the whole way for which they are fitted."""
_RADII = np.geomspace(2e-4, 1.4, 100)
"""Radii at which the fit is asked to be good, as the tangent of an angle."""
_OPAQUE = 60.0
"""Scattering depth beyond which weights no longer grow: no light is left to be weighted."""
_BACK = np.radians(165.0)
"""Angle by which a rig's sheet is commonly seen to scatter, where the glow is brightest."""


@final
@dataclass(frozen=True, eq=False)
class Spread:
    """A sum of round Gaussians by which water spreads the light of each point of a picture.

    With them the light A that was never scattered forward, or only on the sheet, becomes
    A + Σ G(σ) ⊗ (A · w), where each point's weights w depend on the ways that its light has gone.
    """

    widths: Scalars
    """1σ of each Gaussian, as the tangent of an angle; times the focal length it is in pixels."""
    scattering: float
    """Scattering coefficient b [1/m]."""
    shares: Float[np.ndarray, "t j"]
    """Weights for each depth of `_DEPTHS`, as shares of what is scattered out of the direct way."""

    @classmethod
    def of(cls, medium: Medium) -> "Spread":
        """Make the spread of a lit surface, which sends light off by Lambert's law."""
        return _fit_spread(medium, _lambert)

    @classmethod
    def of_glow(cls, medium: Medium) -> "Spread":
        """Make the spread of the sheet's own glow, which sends light off as the water scatters.

        It is that of a sheet seen to scatter by 165 degrees.
        """
        return _fit_spread(medium, _Backscatter(medium.phase))

    def weights(self, laser_range: Values, camera_range: Values) -> Float[np.ndarray, "*shape j"]:
        """Give the weight of each Gaussian, relative to the light that is not yet spread.

        Args:
            laser_range: Way in the water from the laser to each point [m].
            camera_range: Way in the water from each point to the camera [m].

        Raises:
            InputError: A way is negative.
        """
        depth = self.scattering * (laser_range + camera_range)
        if np.any(depth < 0):
            raise InputError(f"A way in the water must not be negative, got {np.min(depth):g} m.")
        place = np.interp(depth, _DEPTHS, np.arange(len(_DEPTHS)))
        node = np.minimum(place.astype(int), len(_DEPTHS) - 2)
        part = (place - node)[..., None]
        share = self.shares[node] * (1 - part) + self.shares[node + 1] * part
        return share * np.expm1(np.minimum(depth, _OPAQUE))[..., None]


@dataclass(frozen=True)
class _Backscatter:
    """Light that a sheet scatters towards somewhere beside the camera."""

    phase: AbstractPhase

    def __call__(self, angle: Values) -> Values:
        """Average over the directions that are off by each angle [rad], relative to no angle."""
        turns = (np.arange(16) + 0.5) * np.pi / 16
        nodes = np.linspace(0.0, np.pi, 361)[:, None]
        cosine = np.cos(nodes) * np.cos(_BACK) + np.sin(nodes) * np.sin(_BACK) * np.cos(turns)
        around = self.phase.at_cosine(cosine).mean(axis=1)
        return np.interp(angle, nodes[:, 0], around / around[0]) * (angle < np.pi / 2)


def _lambert(angle: Values) -> Values:
    """Give the light off the direct way, taken along the surface's normal [rad]."""
    return np.maximum(np.cos(angle), 0.0)


@lru_cache(maxsize=32)
def _fit_spread(medium: Medium, emission: Emission) -> Spread:
    """Fit the Gaussians at each depth; kept for each water."""
    shares = np.zeros((len(_DEPTHS), len(WIDTHS)))
    if medium.scattering > 0:
        light = OneScattering.of(medium.phase, emission)
        # Of one leg, where the depth is that of both.
        absorbed = _DEPTHS / 2 * medium.absorption / medium.scattering
        for row, depth, lost in zip(shares, _DEPTHS, absorbed, strict=True):
            density = light.repeat(depth, _RADII, absorption=lost)
            row[:] = _fit_gaussians(density) / np.expm1(depth)
    return Spread(WIDTHS, medium.scattering, shares)


def _fit_gaussians(density: Values) -> Scalars:
    """Fit a density, as it is looked at, by Gaussians, evenly well in proportion."""
    from scipy.optimize import nnls

    variances = WIDTHS**2 + blur_of(_RADII)[:, None]
    bells = np.exp(-0.5 * _RADII[:, None] ** 2 / variances) / (2 * np.pi * variances)
    rows = bells / density[:, None]
    scale = rows.max(axis=0)
    fitted, _ = nnls(rows / scale, np.ones(len(_RADII)), maxiter=2000)
    return fitted / scale
