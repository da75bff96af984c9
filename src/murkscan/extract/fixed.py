"""What is fixed to the picture and not to the scene: rim, dirt, scratches, ghosts, text."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Shaped

from .._kernels.ridges import match_ridges, pool_along
from ..types.arrays import Mask
from ..types.background import FixedPattern, Noise
from .markov import Markov
from .matched_filter import FilterBank
from .ridges import Marks, Ridges, find_frame_ridges
from .scan_lines import ScanLines

_FEWEST = 8
"""Frames of the same rows from which something is learnt about what stays."""
_STANDS, _LEAST = 0.6, 3.0
"""Share of the frames in which a ridge stands in its place, and its least score."""
_NEAR, _HALF = 1.5, 0.4
"""Grains within which it is the same one, and the share of its height that it keeps."""
_SIGMA = (0.159, 0.5, 0.841)
"""Quantiles of a Gaussian one standard deviation below and above its middle, and at it."""
_STIR = 0.3
"""Standard deviation of the place from which it moves [px]; noise adds a grain by the score."""
_CLEARLY = 6.0
"""Logarithm of the ratio from which what stands is fixed to the picture."""
_NEAR_LINES, _FAR_LINES, _SLOPE = 8, 150, 1.0
"""Scan lines on both sides whose evidence is put together, those that decide together, and the
steepest slope of a thing [px a line]."""
_GAP = 10
"""Scan lines over which a thing may be missing: an anode or a hole in a hull."""
_OFTEN = 0.25
"""Share of frames that must have the stripe elsewhere to tell anything: snow and a row's noise are
taken for it in one of ten."""
_BOTH, _ONLY = math.log(0.95 / 0.15), math.log(0.05 / 0.85)
"""Logarithms of the likelihood ratios of being fixed to the picture, of a frame whose stripe is
elsewhere in the scan line while the thing is in its place, and while it is not. A surface shows in
two places of a scan line beside an occlusion only."""
_SURE = 0.9
"""Posterior from which a frame surely has its stripe elsewhere."""
_MOST_TOLD, _STEADY = 3.0, 2.0
"""Bound of the logarithm of the ratio that one ridge tells, what one e-fold of flicker tells."""
_FLICKER, _MOST_FLICKER = 0.1, 0.5
"""Relative standard deviation of a height over frames from which it is the light of a surface that
passes by: speckle and paint of painted, grown-over or bare walls vary by 0.2 to 0.5, dirt on the
window by 0.05 at most (measured on the cases of benchmarks/murk.py with fixed clutter); and the
most that one ridge counts with: a particle before it, or a digit that changes, is more."""
_LONE = 1.2
"""Standing ridges a scan line up to which a steady line is the picture's only one: a still stripe
on an even wall, if nothing else in the picture is dirt."""
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
_ROUGH = 15
"""Pixels of the median that tells what surely stands out."""
_HALF_MEAN = math.sqrt(2 / math.pi)
_OUT = 4.0
"""Standard deviations of the noise that is left from which something stands out."""

Levels = Float32[np.ndarray, "length lines"]


def learn_fixed_patterns(
    look: Sequence[ScanLines], bank: FilterBank, markov: Markov
) -> tuple[FixedPattern, ...]:
    """Learn what stays in its place whatever the scene does; one pattern for each kind of field.

    What stays while the stripe is elsewhere in the same scan line is fixed to the picture. What
    stays and flickers, as paint and speckle do that pass by, is a surface that keeps its distance.

    Args:
        look: Frames spread over the recording, along their scan lines.
        bank: The filters.
        markov: The chain that tells the stripe from the rest.
    """
    patterns = []
    for row in sorted({lines.frame.first_row for lines in look}):
        group = [lines for lines in look if lines.frame.first_row == row]
        group = [lines for lines in group if lines.levels.shape == group[0].levels.shape]
        if len(group) >= _FEWEST:
            levels = _learn_levels(group, bank, markov)
            if group[0].axis == "x":
                levels = np.ascontiguousarray(levels.T)
            patterns.append(FixedPattern(row, levels, _find_overlay(levels, bank.noise.white)))
    return tuple(patterns)


def _learn_levels(group: Sequence[ScanLines], bank: FilterBank, markov: Markov) -> Levels:
    low, lasting = _low_levels([lines.levels for lines in group], bank.noise)
    base = replace(group[0], levels=low, signal=low)
    frames = [
        find_frame_ridges({0: bank.score(each)}, bank, least=_LEAST / 2) for each in (base, *group)
    ]
    standing = _Standing.of(frames[0], frames[1:])
    is_surface = standing.are_surface(markov)
    covered = standing.cover(is_surface, low.shape)
    judged = standing.cover(standing.stand & ~is_surface, low.shape)
    return _stand_out(low, covered, judged, lasting, bank.noise, len(group))


def _low_levels(
    levels: Sequence[Shaped[np.ndarray, "length lines"]], noise: Noise
) -> tuple[Levels, Bool[np.ndarray, "length lines"]]:
    """Average the darker half of each pixel's levels over frames: light that passes by only adds.

    By what that is too dark where nothing passes is known: half a Gaussian has a mean of 0.798 σ.

    Returns:
        The levels, and where they last: the darkest frames have them, too, as far as noise goes.
    """
    half, few = (len(levels) + 1) // 2, len(levels) // _FEW_DARK
    stack = np.partition(np.stack(levels), (few, half - 1), axis=0)[:half]
    mean = stack.mean(axis=0, dtype=np.float32)
    scatter = np.sqrt(noise.variance(mean)).astype(np.float32)
    low = mean + np.float32(_HALF_MEAN) * scatter
    return low, low - stack[few] < _LASTING[0] * scatter + _LASTING[1] * low


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


@dataclass(frozen=True, eq=False)
class _Standing:
    """Ridges that stay in their place over frames."""

    ridges: Ridges
    frames: Sequence[Ridges]
    heights: Float[np.ndarray, "frames lines most"]
    """In each frame; 0 where a frame lacks it."""
    moves: Float[np.ndarray, "frames lines most"]
    """How far from its place each frame has it [px]."""
    stand: Marks

    @classmethod
    def of(cls, ridges: Ridges, frames: Sequence[Ridges]) -> "_Standing":
        """Find which ridges of the low levels most frames have, too."""
        own = ridges.positions, ridges.counts, ridges.grains
        matched = [
            match_ridges(*own, one.positions, one.heights, one.counts, _NEAR) for one in frames
        ]
        heights, moves = (np.stack(column) for column in zip(*matched, strict=True))
        share = (heights > _HALF * ridges.heights).mean(axis=0)
        stand = ridges.exist & (ridges.heights > _LEAST) & (share > _STANDS)
        return cls(ridges, frames, heights, moves, stand)

    @property
    def is_there(self) -> Bool[np.ndarray, "frames lines most"]:
        """Tell in which frames each is in its place."""
        return self.heights > _HALF * self.ridges.heights

    def cover(self, which: Marks, shape: tuple[int, ...]) -> Bool[np.ndarray, "length lines"]:
        """Mark the pixels within reach of some."""
        line, number = np.nonzero(which)
        place = np.rint(self.ridges.positions[line, number]).astype(int)
        covered = np.zeros(shape, bool)
        reach = math.ceil(self.ridges.reach)
        for off in range(-reach, reach + 1):
            covered[np.clip(place + off, 0, shape[0] - 1), line] = True
        return covered

    def pool(
        self, values: Float[np.ndarray, "lines most"], reach: int
    ) -> Float[np.ndarray, "lines most"]:
        """Sum values along the thing that a ridge belongs to, up to so many lines away."""
        own = self.ridges.positions, self.ridges.counts, self.stand
        return pool_along(*own, values, reach, _SLOPE, _GAP)

    def are_surface(self, markov: Markov) -> Marks:
        """Tell which are a surface that keeps its distance, and not fixed to the picture."""
        both, only = self._count_elsewhere(markov)
        told = np.clip(_BOTH * both + _ONLY * only, -_MOST_TOLD, _MOST_TOLD)
        share = self.pool(both + only, _NEAR_LINES) / len(self.frames)
        is_known = share > _OFTEN * self.pool(self.stand.astype(float), _NEAR_LINES)
        told = np.where(is_known, told, 0.0)
        is_dirty = self.stand.sum() > _LONE * len(self.stand)
        steady = self.steadiness() + np.where(self.are_crowded(), _MOST_TOLD, 0.0)
        steady = np.where(self.are_moving(), -_MOST_TOLD, steady)
        if not is_dirty:
            steady = np.minimum(steady, 0.0)
        return self.stand & (self.pool(told + steady, _FAR_LINES) < _CLEARLY)

    def are_crowded(self) -> Marks:
        """Tell which have others nearby in their scan line, as strokes of letters have."""
        place = np.where(self.stand, self.ridges.positions, np.inf)
        height = np.where(self.stand, self.ridges.heights, 0.0)
        apart = np.abs(self.ridges.positions[:, :, None] - place[:, None, :])
        alike = height[:, None, :] > _HALF * self.ridges.heights[:, :, None]
        near = (apart < self.ridges.reach) & (apart > _NEAR) & alike
        return self.stand & near.any(axis=2)

    def are_moving(self) -> Marks:
        """Tell which move to and fro by more than noise moves a ridge: no dirt does."""
        seen = np.where(self.stand, np.where(self.is_there, self.moves, np.nan), 0.0)
        low, high = np.nanquantile(seen, (_SIGMA[0], _SIGMA[2]), axis=0)
        least = _STIR + self.ridges.grains / np.maximum(self.ridges.heights, 1.0)
        return self.stand & (0.5 * (high - low) > least)

    def steadiness(self) -> Float[np.ndarray, "lines most"]:
        """Weigh by how little each height varies over frames beside the noise: high for dirt."""
        seen = np.where(self.is_there, self.heights, np.nan)
        seen = np.where(self.stand, seen, 0.0)
        low, middle, high = np.nanquantile(seen, _SIGMA, axis=0)
        middle = np.maximum(middle, 1.0)
        square = middle**2
        excess = np.clip((0.5 * (high - low)) ** 2 - 1.0, -1.0, _MOST_FLICKER**2 * square)
        count, excess, square = (
            np.maximum(self.pool(np.where(self.stand, each, 0.0), _FAR_LINES), 0.0)
            for each in (np.ones_like(square), excess, square)
        )
        count, square = np.maximum(count, 1.0), np.maximum(square, 1.0)
        doubt = 2.0 * np.sqrt(2.0 * count / len(self.frames))
        flicker, most = (np.sqrt(each / square) for each in (excess, excess + doubt))
        # Noise alone scatters faint ones: they may flicker or not.
        flicker = np.where(flicker < _FLICKER, np.clip(most, _FLICKER / 10, _FLICKER), flicker)
        ratio = np.clip(_STEADY * np.log(_FLICKER / flicker), -_MOST_TOLD, _MOST_TOLD)
        return np.where(self.stand, ratio, 0.0)

    def _count_elsewhere(
        self, markov: Markov
    ) -> tuple[Float[np.ndarray, "lines most"], Float[np.ndarray, "lines most"]]:
        """Count frames whose stripe is elsewhere in the line, with each in its place or not."""
        both, only = np.zeros(self.stand.shape), np.zeros(self.stand.shape)
        for frame, is_there in zip(self.frames, self.is_there, strict=True):
            elsewhere = self._is_elsewhere(frame, markov)[:, None]
            both += elsewhere & is_there & self.stand
            only += elsewhere & ~is_there & self.stand
        return both, only

    def _is_elsewhere(self, frame: Ridges, markov: Markov) -> Mask:
        """Tell in which scan lines a frame has a stripe that is none of those that stand."""
        heights = np.where(self.stand, self.ridges.heights, 0.0)
        places = self.ridges.positions, heights, self.ridges.counts
        own = match_ridges(frame.positions, frame.counts, frame.grains, *places, 2.0)[0] > 0
        posterior = markov.follow_some(frame, ~frame.are_within(own, frame.reach))
        return np.any(posterior > _SURE, axis=1)
