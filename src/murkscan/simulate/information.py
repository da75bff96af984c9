"""How much the picture tells about each true centre: what no finder can beat."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float32

from ..optics.stripe_bound import bound_of_position
from ..types.arrays import Ratios, Scalars
from .lit_line import LitLine

_REACH = 4.0
"""Standard deviations of the stripe's core that are looked at."""
_WIDEST = 64
"""Pixels to one side, at most."""

LinePicture = Float32[np.ndarray, "lines length"]
"""A picture whose rows are scan lines."""


@dataclass(frozen=True, eq=False)
class Information:
    """One true centre a row."""

    snr: Ratios
    """Signal-to-noise ratio of the stripe in its scan line."""
    crlb: Ratios
    """The lowest standard deviation that an unbiased estimate can have [px]; infinite where the
    picture tells nothing."""
    peak: Ratios
    """Highest pixel of the stripe [electrons]."""


def measure_information(
    line: LitLine,
    widths: Scalars,
    *,
    stripe: LinePicture,
    slope: LinePicture,
    variance: LinePicture,
    told: Bool[np.ndarray, " length"],
) -> Information:
    """Add up the Fisher information of the pixels around each centre.

    Args:
        line: The true centres.
        widths: Of the stripe's core there, with the lens's blur [px], 1σ.
        stripe: Noise-free light of the stripe alone [electrons]; rows are scan lines.
        slope: Its derivative by the position [electrons/px].
        variance: Of the whole picture [electrons²].
        told: Which pixels along a scan line the frame has: half of them in a field.
    """
    half = int(min(np.ceil(_REACH * widths.max(initial=1.0)), _WIDEST))
    at = np.rint(line.positions).astype(int)[:, None] + np.arange(-half, half + 1)
    inside = (at >= 0) & (at < stripe.shape[1])
    inside &= np.abs(at - line.positions[:, None]) <= _REACH * widths[:, None]
    at = np.clip(at, 0, stripe.shape[1] - 1)
    inside &= told[at]
    rows = np.broadcast_to(line.lines[:, None], at.shape)
    weight = np.where(inside, 1.0 / variance[rows, at], 0.0)
    light = stripe[rows, at]
    power = (weight * light**2).sum(axis=1)
    crlb = bound_of_position(slope[rows, at], weight)
    peak = np.where(inside, light, 0.0).max(axis=1, initial=0.0)
    return Information(*(a.astype(np.float32) for a in (np.sqrt(power), crlb, peak)))
