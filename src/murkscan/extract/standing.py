"""Ridges that stay in their place: fixed to the picture, or a surface that keeps still."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from .._kernels.ridges import match_ridges, pool_along
from ..types.arrays import Mask
from .at_once import map_at_once
from .markov import Markov
from .quantiles import quantiles
from .ridges import Marks, Ridges

_STANDS, LEAST = 0.6, 3.0
"""Share of the frames in which a ridge stands in its place, and its least score."""
_NEAR, _HALF = 1.5, 0.4
"""Grains within which it is the same one, and the share of its height that it keeps."""
_SIGMA = (0.159, 0.5, 0.841)
"""Quantiles of a Gaussian one standard deviation below and above its middle, and at it."""
_STIR = 0.3
"""Standard deviation of the place from which it moves [px]; noise adds a grain by the score."""
_CLEARLY = 6.0
"""Logarithm of the ratio from which what stands is fixed to the picture."""
_SURELY = 100.0
"""Logarithm by which another line of the same scan lines is more of a surface, so that this is
none: fifty lines that flicker as paint does. Between shorter ones is an edge with two surfaces."""
_NEAR_LINES, _FAR_LINES, _SLOPE = 8, 150, 1.0
"""Scan lines on both sides whose evidence is put together, those that decide together, and the
steepest slope of a thing [px a line]."""
_GAP = 10
"""Scan lines over which a thing may be missing: an anode or a hole in a hull."""
_OFTEN = 0.5
"""Share of frames that must have the stripe elsewhere to tell anything: snow and a row's noise are
taken for it in one of ten."""
_BOTH, _ONLY = math.log(0.95 / 0.15), math.log(0.05 / 0.85)
"""Logarithms of the likelihood ratios of being fixed to the picture, of a frame whose stripe is
elsewhere in the scan line while the thing is in its place, and while it is not. A surface shows in
two places of a scan line beside an occlusion only."""
_SURE = 0.9
"""Posterior from which a frame surely has its stripe elsewhere."""
_WEAK = 1 / 3
"""Share of a standing thing's height below which what is elsewhere tells nothing of it: texture and
edges in a lamp's light beside a stripe that keeps still. A ghost of 40 grey levels is 2.7 times as
high as the stripe at c = 5 /m (benchmarks/murk.py, c5-clutter), and has to be told."""
_MOST_TOLD, _STEADY = 3.0, 2.0
"""Bound of the logarithm of the ratio that one ridge tells, what one e-fold of flicker tells."""
_FLICKER, _MOST_FLICKER = 0.1, 0.5
"""Relative standard deviation of a height over frames from which it is the light of a surface that
passes by: speckle and paint of painted, grown-over or bare walls vary by 0.2 to 0.5, dirt on the
window by 0.05 at most (measured on the cases of benchmarks/murk.py with fixed clutter); and the
most that one ridge counts with: a particle before it, or a digit that changes, is more."""
_LONE = 1.2
"""Standing ridges a scan line and laser up to which a steady line is the laser's own: a still
stripe on an even wall, if nothing else in the picture is dirt."""


@dataclass(frozen=True, eq=False)
class Standing:
    """Ridges that stay in their place over frames."""

    ridges: Ridges
    frames: Sequence[Ridges]
    heights: Float[np.ndarray, "frames lines most"]
    """In each frame; 0 where a frame lacks it."""
    moves: Float[np.ndarray, "frames lines most"]
    """How far from its place each frame has it [px]."""
    stand: Marks

    @classmethod
    def of(cls, ridges: Ridges, frames: Sequence[Ridges]) -> "Standing":
        """Find which ridges of the low levels most frames have, too."""
        own = ridges.positions, ridges.counts, ridges.grains
        matched = [
            match_ridges(*own, one.positions, one.heights, one.counts, _NEAR) for one in frames
        ]
        heights, moves = (np.stack(column) for column in zip(*matched, strict=True))
        share = (heights > _HALF * ridges.heights).mean(axis=0)
        stand = ridges.exist & (ridges.heights > LEAST) & (share > _STANDS)
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

    def are_surface(self, markov: Markov, *, lasers: int) -> Marks:
        """Tell which are a surface that keeps its distance, and not fixed to the picture.

        Args:
            markov: The chain that tells the stripe from the rest.
            lasers: How many stripes a scan line has; of several, one being elsewhere says nothing.
        """
        both, only = self._count_elsewhere(markov)
        told = np.clip(_BOTH * both + _ONLY * only, -_MOST_TOLD, _MOST_TOLD)
        share = self.pool(both + only, _NEAR_LINES) / len(self.frames)
        is_known = share > _OFTEN * self.pool(self.stand.astype(float), _NEAR_LINES)
        told = np.where(is_known & (lasers == 1), told, 0.0)
        is_dirty = self.stand.sum() > _LONE * lasers * len(self.stand)
        steady = self.steadiness() + np.where(self.are_crowded(), _MOST_TOLD, 0.0)
        steady = np.where(self.are_moving(), -_MOST_TOLD, steady)
        if not is_dirty:
            steady = np.minimum(steady, 0.0)
        pooled = self.pool(told + steady, _FAR_LINES)
        if lasers == 1:
            beside = self.pool(self._are_beside_surface(pooled).astype(float), _FAR_LINES)
            most = beside > 0.5 * self.pool(self.stand.astype(float), _FAR_LINES)
            pooled += np.where(most, _BOTH * beside, 0.0)
        return self.stand & (pooled < _CLEARLY)

    def _are_beside_surface(self, pooled: Float[np.ndarray, "lines most"]) -> Marks:
        """Tell which stand beside what is surely a surface, and more so: of two one is the stripe.

        Args:
            pooled: Logarithm of the ratio of being fixed to the picture.
        """
        value = np.where(self.stand, pooled, np.inf)
        place = np.where(self.stand, self.ridges.positions, np.inf)
        with np.errstate(invalid="ignore"):
            apart = np.abs(place[:, :, None] - place[:, None, :]) > self.ridges.reach
            lower = value[:, None, :] < np.minimum(value[:, :, None], 0.0) - _SURELY
        return self.stand & (apart & lower).any(axis=2)

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
        low, high = quantiles(seen, (_SIGMA[0], _SIGMA[2]))[:, 0]
        least = _STIR + self.ridges.grains / np.maximum(self.ridges.heights, 1.0)
        return self.stand & (0.5 * (high - low) > least)

    def steadiness(self) -> Float[np.ndarray, "lines most"]:
        """Weigh by how little each height varies over frames beside the noise: high for dirt."""
        seen = np.where(self.is_there, self.heights, np.nan)
        seen = np.where(self.stand, seen, 0.0)
        low, middle, high = quantiles(seen, _SIGMA)[:, 0]
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
        if not self.stand.any():
            return both, only
        told = map_at_once(lambda frame: self._is_elsewhere(frame, markov), self.frames)
        for elsewhere, is_there in zip(told, self.is_there, strict=True):
            both += elsewhere[:, None] & is_there & self.stand
            only += elsewhere[:, None] & ~is_there & self.stand
        return both, only

    def _is_elsewhere(self, frame: Ridges, markov: Markov) -> Mask:
        """Tell in which scan lines a frame has a stripe that is none of those that stand."""
        heights = np.where(self.stand, self.ridges.heights, 0.0)
        places = self.ridges.positions, heights, self.ridges.counts
        own = match_ridges(frame.positions, frame.counts, frame.grains, *places, 2.0)[0] > 0
        posterior = markov.follow_some(frame, ~frame.are_within(own, frame.reach))
        is_high = frame.heights > _WEAK * heights.max(axis=1, initial=0.0)[:, None]
        return np.any((posterior > _SURE) & is_high, axis=1)
