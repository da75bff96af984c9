"""What every triangulation can do."""

import abc

import numpy as np

from ..types.arrays import Pixels, Points, Scalars
from ..types.profile import Profile
from ..types.rig import Rig
from ..types.stripe import Stripe

_STEP = 1e-3
"""Shift of a pixel for the derivative of its range [px]: small against the picture, large against
rounding."""


class AbstractTriangulation(abc.ABC):
    """A way from pixels to points. Subclasses are final: wrap one, do not subclass it."""

    @abc.abstractmethod
    def locate(self, pixels: Pixels, rig: Rig, laser: int) -> Points:
        """Give the point of the laser's sheet that each pixel sees.

        Args:
            pixels: Stripe centres, in pixels of the full frame [px].
            rig: The calibrated rig.
            laser: Number of the laser in the rig.

        Returns:
            Points in the camera frame [m]; row i belongs to pixel i and is NaN where its ray does
            not meet the sheet in front of the camera.
        """


def triangulate(stripe: Stripe, rig: Rig, method: AbstractTriangulation) -> Profile:
    """Turn stripe centres into surface points; centres that see no point are left out.

    Args:
        stripe: Centres of any number of frames.
        rig: The calibrated rig; it has the lasers that the stripe names.
        method: The way from pixels to points.

    Returns:
        Points in the camera frame, with the standard deviation of their range that follows from
        the standard deviation of their centres.
    """
    points = np.full((len(stripe), 3), np.nan)
    slope = np.zeros(len(stripe))
    for number in np.unique(stripe.laser):
        mine = stripe.laser == number
        points[mine] = method.locate(stripe.pixels[mine], rig, int(number))
        slope[mine] = _range_slope(stripe.pixels[mine], points[mine], rig, int(number), method)
    seen = np.isfinite(points).all(axis=1)
    return Profile(
        frame=stripe.frame[seen],
        time=stripe.time[seen],
        laser=stripe.laser[seen],
        pixels=stripe.pixels[seen],
        points=points[seen],
        sigma=(np.abs(slope[seen]) * stripe.sigma[seen]).astype(np.float32),
        signal=stripe.signal[seen],
        posterior=stripe.posterior[seen],
        branch=stripe.branch[seen],
        blur_shift=(slope[seen] * stripe.blur_shift[seen]).astype(np.float32),
        width=stripe.width[seen],
    )


def _range_slope(
    pixels: Pixels, points: Points, rig: Rig, laser: int, method: AbstractTriangulation
) -> Scalars:
    """Change of a point's range with its centre's shift along the scan line [m/px]."""
    step = np.full(len(pixels), _STEP)
    shift = _STEP * (np.arange(2) == "xy".index(rig.lasers[laser].axis))
    ranges = np.linalg.norm(points, axis=1)
    shifted = np.linalg.norm(method.locate(pixels + shift, rig, laser), axis=1)
    # At the very edge of the sheet the shifted ray may miss it: there the other side is taken.
    missed = np.isnan(shifted) & np.isfinite(ranges)
    if missed.any():
        shifted[missed] = np.linalg.norm(method.locate(pixels[missed] - shift, rig, laser), axis=1)
        step[missed] = -_STEP
    return (shifted - ranges) / step
