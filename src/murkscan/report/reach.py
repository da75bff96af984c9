"""How far the light of a scan went: what would have been seen at a range, and what would not."""

from dataclasses import dataclass

import numpy as np

from ..types.arrays import Indices, Scalars
from .swath import FAR_OR_DARK, TOO_DARK, TOO_FAR

FAINT, PLAIN = 2.0, 4.0
"""A usual stripe below so many times the weakest is lost to texture and speckle now and then; above
so many times it is found, unless the paint is darker by that factor."""
_BINS = 64
_FEWEST = 20
"""Points of a bin of ranges below which it says nothing."""
_STRAY = 0.1
"""Percent of the points at either end of the ranges that share the bin beside them."""
_NEAR, _WEAK = 5, 1
"""Percent of the points: so many are nearer than near, and weaker than the weakest."""
_HIDDEN = 5.0
"""Standard deviations of a pixel's noise below which a stripe may be lost in it."""
_STRONG = 8.0
"""Where even the weakest stripe is stronger than this part of a near one, it shows no limit."""


@dataclass(frozen=True, eq=False)
class Reach:
    """How the scan's own stripe fades with range, in its own water, and how weak it may become."""

    ranges: Scalars
    """Distances from the camera at which something was seen, growing [m]."""
    usual: Scalars
    """Median signal at each [grey levels]."""
    least: float
    """Signal below which a stripe is not surely found [grey levels]."""

    @classmethod
    def from_points(cls, ranges: Scalars, signals: Scalars, *, noise: float = 0.0) -> "Reach":
        """Learn it from points.

        The limit is the signal that 1 % of the points do not reach: that of the extractor, or of
        the noise. A scan of strong stripes alone shows no limit: then it is five times the noise,
        or an eighth of a near stripe where that is more.

        Args:
            ranges: Distance of each point from the camera [m].
            signals: Height of its stripe [grey levels].
            noise: Standard deviation of a pixel [grey levels]; 0 where it is not known.
        """
        known = np.isfinite(ranges) & (signals > 0)
        ranges, signals = ranges[known], signals[known]
        if len(ranges) == 0:
            return cls(np.zeros(0), np.zeros(0), 0.0)
        places, usual = _medians(ranges, signals)
        near = float(np.interp(np.percentile(ranges, _NEAR), places, usual))
        weakest = float(np.percentile(signals, _WEAK))
        return cls(places, usual, min(weakest, max(_HIDDEN * noise, near / _STRONG)))

    def headroom(self, ranges: Scalars) -> Scalars:
        """Give how many times the least signal the usual stripe has at ranges; NaN if unknown."""
        if len(self.ranges) == 0:
            return np.full(np.shape(ranges), np.nan)
        usual = np.exp(np.interp(ranges, self.ranges, np.log(self.usual)))
        return np.asarray(usual / self.least)

    def tell(self, ranges: Scalars) -> Indices:
        """Tell why no light came back from ranges, one cause a row."""
        headroom = self.headroom(ranges)
        rules = [headroom < FAINT, headroom > PLAIN]
        return np.select(rules, [TOO_FAR, TOO_DARK], FAR_OR_DARK)

    @property
    def farthest(self) -> float | None:
        """Range from which the usual stripe is too weak [m]; None where it never is."""
        faint = self.headroom(self.ranges) < FAINT
        lasting = faint[::-1].argmin() if not faint.all() else len(faint)
        return float(self.ranges[len(faint) - lasting]) if lasting else None


def _medians(ranges: Scalars, signals: Scalars) -> tuple[Scalars, Scalars]:
    """Give the middle of bins of equal width that hold enough points, and their median signal."""
    # A few false points far away must not make one bin of all others.
    low, high = np.percentile(ranges, [_STRAY, 100 - _STRAY])
    edges = np.linspace(low, high, _BINS + 1)
    which = np.clip(np.searchsorted(edges, ranges, side="right") - 1, 0, _BINS - 1)
    order = np.argsort(which, kind="stable")
    groups = np.split(order, np.cumsum(np.bincount(which, minlength=_BINS))[:-1])
    told = [g for g in groups if len(g) >= _FEWEST] or [np.arange(len(ranges))]
    places = np.array([np.median(ranges[g]) for g in told])
    return places, np.array([np.median(signals[g]) for g in told])
