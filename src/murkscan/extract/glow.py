"""The sheet's own glow, learnt where frames show it with the surface beyond."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Shaped

from .._kernels.alike import average_alike
from ..types.arrays import Indices, Mask, Pixels, Scalars
from ..types.background import Noise, StripeShape
from ..types.frame import Frame
from ..types.laser import Axis
from ..types.stripe import Stripe
from .at_once import map_at_once
from .scan_lines import ScanLines

_BLOCK = 8
"""Scan lines that are averaged, but for those that a particle covers."""
_EVERY = 3
"""Pixels from one sample to the next along a scan line."""
_CLEAR = 24.0, 10.0
"""Full-frame pixels, and widths of the stripe, that it must be away with its skirt."""
_FEWEST = 4
"""Frames that must show a place."""
_MOST = 10_000
"""Places that tell of the water as well as more would: more than all of a PAL field."""
_WITHIN = 3.0, 1.5
"""Standard deviations of the noise, and grey levels, up to which levels are alike."""

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


def look_at_glow(
    frames: Sequence[Frame],
    stripes: Sequence[Stripe],
    axis: Axis,
    noise: Noise,
    *,
    near: int,
    clear: float,
) -> list[Levels]:
    """Average in each frame what lies before the surface; NaN elsewhere.

    Args:
        frames: Frames of a recording.
        stripes: What was found in each.
        axis: The camera's axis along which the laser sits.
        noise: Of a pixel.
        near: -1 or 1, the way along scan lines in which nearer surfaces are seen.
        clear: Distance from the stripe; see `clearance`.
    """

    def look(shown: tuple[Frame, Stripe]) -> Levels:
        lines = ScanLines.bare(shown[0], axis)
        levels = _average_blocks(lines, noise)
        levels[_is_behind(lines, shown[1], near, clear)] = np.nan
        return levels

    return map_at_once(look, zip(frames, stripes, strict=True))


def learn_glow(frames: Sequence[Frame], seen: Sequence[Levels], axis: Axis, noise: Noise) -> Glow:
    """Average what lies before the surface over frames.

    The glow is fixed to the rig: a pixel has the same in every frame whose surface lies beyond.

    Args:
        frames: Frames of a recording.
        seen: What each shows of the glow; see `look_at_glow`.
        axis: The camera's axis along which the laser sits.
        noise: Of a pixel.
    """
    parts = []
    for row in sorted({frame.first_row for frame in frames}):
        alike = [number for number, frame in enumerate(frames) if frame.first_row == row]
        lines = ScanLines.bare(frames[alike[0]], axis)
        parts.append(_average(np.stack([seen[number] for number in alike]), lines, noise))
    columns = ("pixels", "block", "level", "variance")
    joined = (np.concatenate([getattr(part, name) for part in parts]) for name in columns)
    return Glow(*joined)


def clearance(shape: StripeShape, frame: Frame) -> float:
    """Give how far from the stripe its skirt is gone [full-frame px]."""
    least, widths = _CLEAR
    return max(least, widths * shape.width * shape.binning * frame.row_step)


def _average(
    seen: Float[np.ndarray, "frames length blocks"], lines: ScanLines, noise: Noise
) -> Glow:
    """Average over frames of the same rows."""
    shown = np.isfinite(seen).sum(axis=0) >= _FEWEST
    shown[np.arange(len(shown)) % max(math.ceil(shown.sum() / _MOST), 1) > 0] = False
    place, block = np.nonzero(shown)
    level, number = _mean_within(seen[:, place, block].T, noise)
    # Twice that of as many pixels: the lens has smeared their noise, or their snow.
    variance = noise.variance(level) * 2.0 / _BLOCK / number
    along = lines.as_full_frame(_EVERY * place.astype(float))
    pixels = lines.join(_BLOCK * block + 0.5 * (_BLOCK - 1), along)
    return Glow(pixels, block, level, variance)


def _average_blocks(lines: ScanLines, noise: Noise) -> Levels:
    """Average each block of scan lines, without particles."""
    count = lines.num_lines // _BLOCK
    levels = np.ascontiguousarray(lines.levels[::_EVERY, : count * _BLOCK])
    return _mean_within(levels.reshape(-1, _BLOCK), noise)[0].reshape(len(levels), count)


def _is_behind(
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


def _mean_within(values: Shaped[np.ndarray, "n each"], noise: Noise) -> tuple[Scalars, Scalars]:
    """Give the mean, and the number, of what lies within the noise of the median: no particles."""
    return average_alike(values, noise.as_law(), *_WITHIN)
