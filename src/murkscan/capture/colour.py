"""Grey levels from colour, weighted for the colour of the laser."""

import numpy as np
from jaxtyping import Shaped

from ..types.arrays import Image, Vector

_PEAKS = np.array([600e-9, 532e-9, 460e-9])
"""Where the red, green and blue filters of a colour camera pass most [m]."""
_WIDTHS = np.array([42e-9, 38e-9, 32e-9])
"""Standard deviations of bell curves through the filters' pass bands [m]."""
_CROSSTALK = 0.05
"""Share of any visible light that every filter passes: dyes are not perfect."""
_GREEN = (490e-9, 580e-9)
"""Wavelengths whose light lands mostly in the luma of YUV video [m]."""


def is_green(wavelength: float) -> bool:
    """Tell whether the luma of YUV video holds the light of this wavelength [m]."""
    return _GREEN[0] <= wavelength <= _GREEN[1]


def channel_weights(wavelength: float) -> Vector:
    """Give the weights of red, green and blue for a laser's light; they add up to 1.

    Each weight is the square root of the filter's response: half way from the response itself,
    best against noise, to equal weights, best where the laser's own channel is saturated and
    only the others still tell where the middle of the line is.

    Args:
        wavelength: Wavelength of the laser in air [m].

    References:
        Jiang, Liu, Gu, Süsstrunk, What is the space of spectral sensitivity functions for
        digital color cameras?, WACV 2013 (28 cameras measured; the bell curves approximate them).
    """
    # Beyond the visible a filter no longer matters: the nearest visible colour stands for it.
    visible = min(max(wavelength, 430e-9), 660e-9)
    bells = np.exp(-0.5 * ((visible - _PEAKS) / _WIDTHS) ** 2)
    weights = np.sqrt(_CROSSTALK + (1 - _CROSSTALK) * bells)
    return weights / weights.sum()


def grey_from_colour(image: Shaped[np.ndarray, "h w 3"], wavelength: float) -> Image:
    """Weigh red, green and blue for the colour of the laser.

    Args:
        image: Red, green, blue; 8 or 16 bit.
        wavelength: Wavelength of the laser in air [m].

    Returns:
        Grey levels of the same bit depth, rounded; white stays white.
    """
    weights = channel_weights(wavelength).astype(np.float32)
    return np.rint(image.astype(np.float32) @ weights).astype(image.dtype)
