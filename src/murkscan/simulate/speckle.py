"""Speckle: coherent light that interferes with itself on a rough surface."""

import math

import numpy as np
from scipy.special import gammaincinv, ndtr

from ..optics.sensor import Picture
from ..types.arrays import Vector
from .sensor import blur_lens

_GRAIN = 1e-5
"""Way over which a vehicle leaves its speckle behind [m]."""
_TABLE = np.linspace(-5.0, 5.0, 2001)
"""Standard normal values at which the intensity is tabled."""


def draw_speckle(
    size: tuple[int, int], contrast: float, *, spot: float, place: Vector, seed: int
) -> Picture:
    """Give the factor by which speckle changes each pixel's light; its mean is 1.

    The intensity has a gamma distribution, that of a sum of speckle patterns. It stays as long as
    the camera stays, and is another one elsewhere.

    Args:
        size: Width and height of the picture [px].
        contrast: Standard deviation of the intensity as a share of its mean.
        spot: Width of the lens's spot, over which neighbouring pixels have it in common [px], 1σ.
        place: Where the camera is [m].
        seed: Which speckle.

    References:
        Goodman, Speckle Phenomena in Optics, 2007, sections 3.3 and 4.4.
    """
    width, height = size
    grain = np.rint(place / _GRAIN).astype(np.int64) % 2**32
    random = np.random.default_rng([seed, 6, *grain.tolist()])
    field = random.standard_normal((height, width), np.float32)
    # A field blurred by a Gaussian is correlated over a Gaussian that is wider by √2.
    field = blur_lens(field, spot / math.sqrt(2), spot / math.sqrt(2))
    degrees = contrast**-2
    intensity = gammaincinv(degrees, ndtr(_TABLE)) / degrees
    return np.interp(field / field.std(), _TABLE, intensity).astype(np.float32)
