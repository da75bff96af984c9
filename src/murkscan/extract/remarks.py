"""What is odd about a recording, in plain words with their cure."""

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from ..types.arrays import Scalars
from ..types.background import Noise
from ..types.frame import Frame
from ..types.stripe import Stripe
from .at_once import map_at_once
from .glow import Levels
from .quantiles import count_levels_of, quantile_of_counts, quantiles

_LIT = 0.2
"""Share of white from which the darker half of a picture is lit by something else."""
_DARK = 3.0
"""Standard deviations of its noise above its median that a black frame's brightest pixels reach."""
_BRIGHT = 0.9999
"""Share of a picture's pixels that its brightest exceed."""
_STEP = 1.3
"""Ratio of the glow's brightness over frames from which the exposure has changed."""
_MOVED = 0.25
"""Change of the glow's pattern, as a share of it, from which it lies elsewhere."""
_SEEN = 1.5
"""Grey levels above the darkest from which glow is glow."""
_MOST = 10_000
"""Places that tell of the glow as well as more would: more than all of a PAL field."""
_FEWEST = 200
"""Places that two frames must share to be compared."""

Places = Float[np.ndarray, "frames places"]


def find_remarks(
    frames: Sequence[Frame], stripes: Sequence[Stripe], seen: Sequence[Levels], noise: Noise
) -> tuple[str, ...]:
    """Look for what makes a recording worse than it could be.

    Args:
        frames: Frames spread over the recording, in order.
        stripes: What was found in each.
        seen: What each shows of the glow.
        noise: Of a pixel.

    Returns:
        Sentences that say what was seen and what to do; none for a good recording.
    """
    remarks = [*_about_stripes(frames, stripes), *_about_light(frames, noise)]
    glow = _gather_glow(
        [own for own, frame in zip(seen, frames, strict=True) if _is_like(frame, frames)]
    )
    if glow.shape[1] >= _FEWEST:
        remarks += _about_glow(glow, [frame.index for frame in frames if _is_like(frame, frames)])
    return tuple(remarks)


def _about_stripes(frames: Sequence[Frame], stripes: Sequence[Stripe]) -> list[str]:
    remarks = []
    if not any(len(stripe) for stripe in stripes):
        remarks.append(
            f"None of the {len(frames)} frames looked at first shows a stripe: was the laser on, "
            "and does it cross the picture?"
        )
    if len(frames) == 1:
        remarks.append(
            "There is one frame only, so that nothing but the stripe's own length tells it from "
            "snow; record a film."
        )
    return remarks


def _about_light(frames: Sequence[Frame], noise: Noise) -> list[str]:
    remarks = []
    counts = map_at_once(lambda frame: count_levels_of(frame.image), frames)
    middle, bright = (
        np.array([quantile_of_counts(each, share) for each in counts]) for share in (0.5, _BRIGHT)
    )
    spread = np.sqrt(noise.variance(middle))
    black = int(np.sum(bright <= middle + _DARK * spread + 2.0))
    if black:
        remarks.append(f"{black} of the {len(frames)} frames looked at first are black or even.")
    if np.median(middle) > _LIT * noise.white:
        remarks.append(
            f"Something beside the laser lights the picture: half of it is brighter than "
            f"{np.median(middle):.0f} of {noise.white:.0f} grey levels. Turn lamps off, wait for "
            "dusk or shade the camera: their light is noise."
        )
    return remarks


def _gather_glow(seen: Sequence[Levels]) -> Places:
    """Give the glow of frames with the same rows, where all show it and it is bright enough."""
    stack = np.stack([levels.ravel() for levels in seen])
    shown = np.flatnonzero(np.isfinite(stack).sum(axis=0) >= max(2, len(stack) // 2))
    if len(shown) == 0:
        return stack[:, shown]
    stack = stack[:, shown[:: math.ceil(len(shown) / _MOST)]]
    stack = stack - np.nanmin(stack)
    return stack[:, _medians(stack) > _SEEN]


def _medians(levels: Places) -> Scalars:
    """Give each place's median over the frames that show it."""
    return np.asarray(quantiles(levels, (0.5,))[0, 0])


def _is_like(frame: Frame, frames: Sequence[Frame]) -> bool:
    return frame.first_row == frames[0].first_row and frame.image.shape == frames[0].image.shape


def _about_glow(glow: Places, indices: Sequence[int]) -> list[str]:
    usual = _medians(glow)
    exposure = np.array([_shared_factor(one, usual) for one in glow])
    known = exposure[np.isfinite(exposure)]
    remarks = []
    if len(known) > 1 and known.max() > _STEP * known.min():
        remarks.append(
            f"The picture's brightness changes by a factor of {known.max() / known.min():.1f} "
            "while the water's does not: fix exposure and gain, so that signals can be compared."
        )
    pattern = glow / exposure[:, None]
    change = [_change(pattern, cut) for cut in range(1, len(pattern))]
    if change and np.nanmax([0.0, *change]) > _MOVED:
        cut = int(np.nanargmax(change)) + 1
        remarks.append(
            f"The glow lies elsewhere from about frame {indices[cut]} on: camera or laser has "
            "moved in its mount. Calibrate anew, and scan what comes before and after apart."
        )
    return remarks


def _shared_factor(levels: Scalars, usual: Scalars) -> float:
    """Give the factor that dim, middling and bright places have in common.

    Exposure multiplies all alike; the skirt of a near, bright stripe adds to some of them.
    """
    known = np.flatnonzero(np.isfinite(levels))
    if len(known) < _FEWEST:
        return float("nan")
    thirds = np.array_split(known[np.argsort(usual[known])], 3)
    factors = [float(np.median(levels[third] / usual[third])) for third in thirds]
    if min(factors) <= 0:  # no glow at all: the laser was off, which is no exposure
        return float("nan")
    return max(1.0, min(factors)) * min(1.0, max(factors))


def _change(pattern: Places, cut: int) -> float:
    """Give by how much the usual pattern differs before and after a cut, of three frames each."""
    if not 3 <= cut <= len(pattern) - 3:
        return float("nan")
    shown = np.isfinite(pattern[:cut]).any(axis=0) & np.isfinite(pattern[cut:]).any(axis=0)
    if shown.sum() < _FEWEST:
        return float("nan")
    before = _medians(pattern[:cut, shown])
    after = _medians(pattern[cut:, shown])
    return float(np.median(np.abs(before - after)) / np.median(before + after) * 2)
