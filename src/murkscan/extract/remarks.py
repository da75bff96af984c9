"""What is odd about a recording, in plain words with their cure."""

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from ..types.arrays import Scalars
from ..types.background import Noise
from ..types.frame import Frame
from ..types.laser import Axis
from ..types.stripe import Stripe
from .glow import average_blocks, is_behind
from .quantiles import quantiles
from .scan_lines import ScanLines

_LIT = 0.2
"""Share of white from which the darker half of a picture is lit by something else."""
_DARK = 3.0
"""Standard deviations of its noise above its median that a black frame's brightest pixels reach."""
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

Levels = Float[np.ndarray, "frames places"]


def find_remarks(
    frames: Sequence[Frame],
    stripes: Sequence[Stripe],
    axis: Axis,
    noise: Noise,
    *,
    near: int,
    clear: float,
) -> tuple[str, ...]:
    """Look for what makes a recording worse than it could be.

    Args:
        frames: Frames spread over the recording, in order.
        stripes: What was found in each.
        axis: The camera's axis along which the laser sits.
        noise: Of a pixel.
        near: -1 or 1, the way along scan lines in which nearer surfaces are seen.
        clear: Distance from the stripe at which its skirt is gone [full-frame px].

    Returns:
        Sentences that say what was seen and what to do; none for a good recording.
    """
    remarks = [*_about_stripes(frames, stripes), *_about_light(frames, noise)]
    glow = _gather_glow(frames, stripes, axis, noise, near, clear)
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
    middle = np.array([float(np.median(frame.image)) for frame in frames])
    bright = np.array([float(np.quantile(frame.image, 0.9999)) for frame in frames])
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


def _gather_glow(
    frames: Sequence[Frame],
    stripes: Sequence[Stripe],
    axis: Axis,
    noise: Noise,
    near: int,
    clear: float,
) -> Levels:
    """Give the glow of frames with the same rows, where all show it and it is bright enough."""
    levels = []
    for frame, stripe in zip(frames, stripes, strict=True):
        if _is_like(frame, frames):
            lines = ScanLines.of(frame, axis, noise=noise)
            behind = is_behind(lines, stripe, near, clear)
            levels.append(np.where(behind, np.nan, average_blocks(lines, noise)).ravel())
    stack = np.stack(levels)
    shown = np.isfinite(stack).sum(axis=0) >= max(2, len(stack) // 2)
    stack = stack[:, shown]
    if stack.size == 0:
        return stack
    stack = stack[:, :: math.ceil(stack.shape[1] / _MOST)]
    stack = stack - np.nanmin(stack)
    return stack[:, _medians(stack) > _SEEN]


def _medians(levels: Levels) -> Scalars:
    """Give each place's median over the frames that show it."""
    return np.asarray(quantiles(levels, (0.5,))[0, 0])


def _is_like(frame: Frame, frames: Sequence[Frame]) -> bool:
    return frame.first_row == frames[0].first_row and frame.image.shape == frames[0].image.shape


def _about_glow(glow: Levels, indices: Sequence[int]) -> list[str]:
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
    return max(1.0, min(factors)) * min(1.0, max(factors))


def _change(pattern: Levels, cut: int) -> float:
    """Give by how much the usual pattern differs before and after a cut, of three frames each."""
    if not 3 <= cut <= len(pattern) - 3:
        return float("nan")
    shown = np.isfinite(pattern[:cut]).any(axis=0) & np.isfinite(pattern[cut:]).any(axis=0)
    if shown.sum() < _FEWEST:
        return float("nan")
    before = _medians(pattern[:cut, shown])
    after = _medians(pattern[cut:, shown])
    return float(np.median(np.abs(before - after)) / np.median(before + after) * 2)
