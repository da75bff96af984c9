"""The sheet's own glow, learnt where frames show it with the surface beyond."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from ..types.arrays import Indices, Mask, Pixels, Scalars
from ..types.background import Noise, StripeShape
from ..types.frame import Frame
from ..types.laser import Axis
from ..types.stripe import Stripe
from .quantiles import quantiles
from .scan_lines import ScanLines

_BLOCK = 8
"""Scan lines that are averaged, but for those that a particle covers."""
_EVERY = 3
"""Pixels from one sample to the next along a scan line."""
_CLEAR = 24.0, 10.0
"""Full-frame pixels, and widths of the stripe, that it must be away with its skirt."""
_FEWEST = 4
"""Frames that must show a place."""

Levels = Float[np.ndarray, "length blocks"]


@dataclass(frozen=True, eq=False)
class Glow:
    """Levels where the camera looks through lit water only; one place a row."""

    pixels: Pixels
    """Places [px of the full frame]."""
    block: Indices
    """Number of the block of scan lines that a place is in."""
    level: Scalars
    """Mean grey level there."""
    variance: Scalars
    """Variance of that mean."""

    def __len__(self) -> int:
        """Count the places."""
        return len(self.level)

    def __getitem__(self, which: Mask) -> "Glow":
        """Pick some of the places."""
        columns = (self.pixels, self.block, self.level, self.variance)
        return Glow(*(column[which] for column in columns))


def learn_glow(
    frames: Sequence[Frame],
    stripes: Sequence[Stripe],
    axis: Axis,
    noise: Noise,
    *,
    near: int,
    clear: float,
) -> Glow:
    """Average what lies before the surface over frames.

    The glow is fixed to the rig: a pixel has the same in every frame whose surface lies beyond.

    Args:
        frames: Frames of a recording.
        stripes: What was found in each.
        axis: The camera's axis along which the laser sits.
        noise: Of a pixel.
        near: -1 or 1, the way along scan lines in which nearer surfaces are seen.
        clear: Distance from the stripe; see `clearance`.
    """
    parts = []
    for row in sorted({frame.first_row for frame in frames}):
        alike = [
            (ScanLines.of(frame, axis, noise=noise), stripe)
            for frame, stripe in zip(frames, stripes, strict=True)
            if frame.first_row == row
        ]
        parts.append(_average(alike, noise, near, clear))
    columns = ("pixels", "block", "level", "variance")
    joined = (np.concatenate([getattr(part, name) for part in parts]) for name in columns)
    return Glow(*joined)


def clearance(shape: StripeShape, frame: Frame) -> float:
    """Give how far from the stripe its skirt is gone [full-frame px]."""
    least, widths = _CLEAR
    return max(least, widths * shape.width * shape.binning * frame.row_step)


def _average(
    alike: Sequence[tuple[ScanLines, Stripe]], noise: Noise, near: int, clear: float
) -> Glow:
    """Average over frames of the same rows what lies before their surface."""
    lines = alike[0][0]
    stack = np.stack([average_blocks(each, noise) for each, _ in alike])
    behind = np.stack([is_behind(each, stripe, near, clear) for each, stripe in alike])
    before = np.where(behind, np.nan, stack)
    place, block = np.nonzero(np.isfinite(before).sum(axis=0) >= _FEWEST)
    level, number = _mean_within(before[:, place, block], 0, noise)
    # Twice that of as many pixels: the lens has smeared their noise, or their snow.
    variance = noise.variance(level) * 2.0 / _BLOCK / number
    along = lines.as_full_frame(_EVERY * place.astype(float))
    pixels = lines.join(_BLOCK * block + 0.5 * (_BLOCK - 1), along)
    return Glow(pixels, block, level, variance)


def average_blocks(lines: ScanLines, noise: Noise) -> Levels:
    """Average each block of scan lines, without particles."""
    count = lines.num_lines // _BLOCK
    levels = lines.levels[::_EVERY, : count * _BLOCK].astype(float)
    return _mean_within(levels.reshape(len(levels), count, _BLOCK), 2, noise)[0]


def is_behind(
    lines: ScanLines, stripe: Stripe, near: int, clear: float
) -> Bool[np.ndarray, "length blocks"]:
    """Tell which samples are at the stripe or behind it, or have none in their block."""
    count = lines.num_lines // _BLOCK
    line, along = lines.split(stripe.pixels)
    inside = line < count * _BLOCK
    ends = np.full(count, -near * np.inf)
    nearest = np.minimum if near < 0 else np.maximum
    nearest.at(ends, line[inside] // _BLOCK, along[inside])
    samples = len(lines.levels[::_EVERY])
    place = lines.as_full_frame(_EVERY * np.arange(samples, dtype=float))[:, None]
    return ~(near * (place - ends) > clear) | ~np.isfinite(ends)


def _mean_within(
    values: Float[np.ndarray, "..."], axis: int, noise: Noise
) -> tuple[Float[np.ndarray, "..."], Float[np.ndarray, "..."]]:
    """Give the mean, and the number, of what lies within the noise of the median: no particles."""
    if values.size == 0:
        empty = np.zeros(np.delete(values.shape, axis))
        return empty, empty
    (middle,) = quantiles(values, (0.5,), axis=axis)
    variance = noise.variance(middle)
    keep = np.abs(values - middle) < np.maximum(3.0 * np.sqrt(variance), 1.5)
    number = np.maximum(keep.sum(axis=axis), 1)
    return np.where(keep, values, 0.0).sum(axis=axis) / number, number.astype(float)
