"""What is fixed to the picture and not to the scene: rim, dirt, scratches, ghosts, text."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import Bool, Float32, Shaped

from .._kernels.smallest import find_smallest, sum_smallest
from ..types.background import FixedPattern, Noise
from ..types.frame import Frame
from .at_once import map_at_once
from .markov import Markov
from .matched_filter import FilterBank
from .ridges import Ridges, find_frame_ridges
from .scan_lines import ScanLines
from .standing import LEAST, Standing

_FEWEST = 8
"""Frames of the same rows from which something is learnt about what stays."""
_SMOOTH, _KNOWN = (9, 25, 75, 225), 0.2
"""Pixels over which levels are averaged where nothing stands out: the least of which that share is
known."""
_WRITING, _WRITTEN, _DENSE = (25, 9), 0.35, 0.15
"""Pixels over which writing is dense, and high; share of white that its strokes have at least, and
the share of pixels that they cover. A bright rim of one pixel covers a ninth, a ghost is darker."""
_FEW_DARK, _LASTING = 8, (3.0, 0.15)
"""One frame in so many is darker than what lasts: a level is missed there by no more than so many
standard deviations of the noise, which one in eight is 1.15 below, and such a share of it."""
_SKIRT, _PLAIN, _LONE_PIXEL = 61, 0.1, 1.3
"""Pixels around a surface's stripe that its skirt brightens; share of white by which what lasts
stands out so that no filter need tell; and how much brighter than its neighbours a hot pixel is."""
_BLOCK = 32
"""Pixels of scan lines that are looked at together over all frames: no more is held at once."""
_ROUGH = 15
"""Pixels of the median that tells what surely stands out."""
_RIM = 0.5
"""Widths from the picture's edge from which something may stand: nearer to it than any stripe."""
_HALF_MEAN = math.sqrt(2 / math.pi)
_OUT = 4.0
"""Standard deviations of the noise that is left from which something stands out."""

Levels = Float32[np.ndarray, "length lines"]


def learn_fixed_patterns(
    frames: Sequence[Frame],
    see: Callable[[Frame], ScanLines],
    bank: FilterBank,
    markov: Markov,
    *,
    lasers: int = 1,
) -> tuple[FixedPattern, ...]:
    """Learn what stays in its place whatever the scene does; one pattern for each kind of field.

    What stays while the stripe is elsewhere in the same scan line is fixed to the picture. What
    stays and flickers, as paint and speckle do that pass by, is a surface that keeps its distance.

    Args:
        frames: Frames spread over the recording.
        see: Looks at one along its scan lines.
        bank: The filters.
        markov: The chain that tells the stripe from the rest.
        lasers: How many stripes the pictures show.

    Returns:
        The patterns; none for a kind of field in which nothing stays.
    """
    patterns = []
    for row in sorted({frame.first_row for frame in frames}):
        group = [frame for frame in frames if frame.first_row == row]
        group = [frame for frame in group if frame.image.shape == group[0].image.shape]
        if len(group) >= _FEWEST:
            levels = _learn_levels(group, see, bank, markov, lasers)
            if levels.any():
                patterns.append(FixedPattern(row, levels, _find_overlay(levels, bank.noise.white)))
    return tuple(patterns)


def _learn_levels(
    group: Sequence[Frame],
    see: Callable[[Frame], ScanLines],
    bank: FilterBank,
    markov: Markov,
    lasers: int,
) -> Float32[np.ndarray, "h w"]:
    first = see(group[0])
    pictures = [ScanLines.bare(frame, first.axis).levels for frame in group]
    low, lasting = _low_levels(pictures, bank.noise)
    # Along the picture's edge a filter sees what is fixed sooner than what a stripe may be.
    low_bank = replace(bank, search=replace(bank.search, least=LEAST / 2, rim=_RIM))
    ridges = _find_ridges(replace(first, levels=low, signal=low), low_bank)
    frames = map_at_once(lambda frame: _find_ridges(see(frame), low_bank).bare(), group)
    standing = Standing.of(ridges, frames)
    is_surface = standing.are_surface(markov, lasers=lasers)
    is_fixed = standing.stand & ~is_surface
    # A stripe that moves by less than its width leaves a line as well, which stands nowhere.
    lingers = ridges.are_in_lines(ridges.exist & (ridges.heights > LEAST) & ~is_fixed)
    covered = standing.cover(is_surface | lingers, low.shape)
    judged = standing.cover(is_fixed, low.shape)
    levels = _stand_out(low, covered, judged, lasting, bank.noise, len(group))
    return np.ascontiguousarray(levels.T) if first.axis == "x" else levels


def _find_ridges(lines: ScanLines, bank: FilterBank) -> Ridges:
    return find_frame_ridges({0: bank.score(lines)}, bank)


def _low_levels(
    levels: Sequence[Shaped[np.ndarray, "length lines"]], noise: Noise
) -> tuple[Levels, Bool[np.ndarray, "length lines"]]:
    """Average the darker half of each pixel's levels over frames: light that passes by only adds.

    By what that is too dark where nothing passes is known: half a Gaussian has a mean of 0.798 σ.

    Returns:
        The levels, and where they last: the darkest frames have them, too, as far as noise goes.
    """
    low = np.empty(levels[0].shape, np.float32)
    lasting = np.empty(levels[0].shape, bool)
    half, few = (len(levels) + 1) // 2, len(levels) // _FEW_DARK

    def average(first: int) -> None:
        rows = slice(first, first + _BLOCK)
        stack = np.stack([one[rows] for one in levels]).reshape(len(levels), -1)
        middle, shape = find_smallest(stack, half - 1), low[rows].shape
        mean = (sum_smallest(stack, half, middle) / half).astype(np.float32).reshape(shape)
        scatter = np.sqrt(noise.variance(mean)).astype(np.float32)
        low[rows] = mean + np.float32(_HALF_MEAN) * scatter
        missed = low[rows] - find_smallest(stack, few).reshape(shape)
        lasting[rows] = missed < _LASTING[0] * scatter + _LASTING[1] * low[rows]

    map_at_once(average, range(0, len(low), _BLOCK))
    return low, lasting


def _find_overlay(
    levels: Float32[np.ndarray, "h w"], white: float
) -> Bool[np.ndarray, "h w"] | None:
    """Find what a display has written over the picture, with the digits that change beside it."""
    width, height = _WRITING
    strokes = (levels > _WRITTEN * white).astype(np.float32)
    dense = cv2.blur(strokes, (width, height)) > _DENSE
    if not dense.any():
        return None
    beside = np.ones((height, 2 * width), np.uint8)
    return cv2.dilate(dense.astype(np.uint8), beside).astype(bool)


def _stand_out(
    levels: Levels,
    covered: Bool[np.ndarray, "length lines"],
    judged: Bool[np.ndarray, "length lines"],
    lasting: Bool[np.ndarray, "length lines"],
    noise: Noise,
    count: int,
) -> Levels:
    """Subtract the average of what is around, and keep what stands out of it where it can be seen.

    What is even, and what a surface covers, is 0: so no noise of this pattern is added. What single
    frames do not show, and was not judged to be fixed, may be a faint surface.
    """
    spread = np.sqrt(noise.variance(levels) / count)
    scale = np.float32(255.0 / noise.white)
    rough = cv2.medianBlur(np.clip(levels * scale, 0, 255).astype(np.uint8), _ROUGH) / scale
    smooth = _fill(levels, ~covered & (np.abs(levels - rough) < _OUT * spread + 1.0 / scale))
    smooth = _fill(levels, ~covered & ~_are_out(levels - smooth, spread))
    near = cv2.blur(covered.astype(np.float32), (1, _SKIRT)) > 0
    is_plain = lasting & ~near & (levels - smooth > _PLAIN * noise.white)
    kept = _are_out(levels - smooth, spread) & ~covered & (judged | is_plain)
    beside = 0.5 * (np.roll(levels, 1, axis=1) + np.roll(levels, -1, axis=1))
    lone = ~kept & lasting & _are_lone(levels, spread * math.sqrt(count))
    return np.where(lone, levels - beside, np.where(kept, levels - smooth, 0.0)).astype(np.float32)


def _are_lone(levels: Levels, scatter: Levels) -> Bool[np.ndarray, "length lines"]:
    """Tell which pixels are far brighter than those of the scan lines on both sides."""
    sides = np.maximum(np.roll(levels, 1, axis=1), np.roll(levels, -1, axis=1))
    return levels > _LONE_PIXEL * sides + _OUT * scatter


def _are_out(off: Levels, spread: Levels) -> Bool[np.ndarray, "length lines"]:
    """Tell which pixels, or they with their neighbours, are off by more than noise explains."""
    wide = cv2.blur(off, (3, 3), borderType=cv2.BORDER_REPLICATE)
    return (np.abs(off) > _OUT * spread) | (np.abs(wide) > _OUT * spread / 3)


def _fill(levels: Levels, known: Bool[np.ndarray, "length lines"]) -> Levels:
    """Average the known pixels around each one, over as few as there are enough of."""
    filled, missing = levels.copy(), np.ones(levels.shape, bool)
    weight = known.astype(np.float32)
    for size in _SMOOTH:
        share = cv2.blur(weight, (size, size), borderType=cv2.BORDER_REPLICATE)
        total = cv2.blur(weight * levels, (size, size), borderType=cv2.BORDER_REPLICATE)
        enough = missing & (share > _KNOWN)
        filled[enough] = total[enough] / share[enough]
        missing &= ~enough
    return filled
