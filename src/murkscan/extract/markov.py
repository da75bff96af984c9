"""Which ridges are the stripe: a hidden Markov chain over scan lines, with what frames say."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from .._kernels.chain import follow_chain
from ..errors import InputError
from .branches import go_on_beside
from .clutter import Rates, Stays, bound_by_stays, weigh_heights
from .ridges import Marks, Ridges, find_runs

_STEPS = np.array([0.25, 1.2, 0.80, 0.19, 0.35])
"""Scales of a surface's small and larger steps [px a line], their shares, and the scale of steps in
the logarithm of its brightness. What is left of the shares are jumps."""
_MISS = 0.04
"""Probability that a line of a stripe lacks its ridge."""
_FRAMES = (-4, -2, 2, 4)
"""Frames that are asked, too: snow is gone by then, and their rows are a field's own."""
_SEEN, _SEEN_FAINT, _UNSEEN = 1.8, 1.0, -2.5
"""Logarithms of the likelihood ratios of a ridge that such a frame has, too, or has not."""
_FAINT, _FULL = 4.5, (2.5, 5.5)
"""Score below which noise hides a ridge, and scores over which its absence comes to count."""
_PERSISTENT = (0.3, 0.6)
"""Share of sure ridges that the next frame of the same rows has, too, over which frames come to
count at all."""
_END = -12.0
"""Logarithm of the likelihood ratio of a stripe's blur beyond its end. It stays over frames as the
stripe does, and its height, up to e^6 times likelier to be a stripe's than clutter's, says nothing.
"""
_CLEAR = 4.0
"""Score of a ridge from which it may be a second branch."""

Posterior = Float[np.ndarray, "lines most"]
Evidence = Float[np.ndarray, "lines most"]


@dataclass(frozen=True, eq=False)
class Markov:
    """The chain's settings."""

    rates: Rates
    """Ridges of snow and glow in a pixel and an e-fold of height; see `weigh_heights`."""
    stays: Stays
    """Share of these that other frames show, too, by height; see `bound_by_stays`."""
    birth: float
    """Probability that a stripe begins at a scan line."""
    death: float
    """Probability that it ends there."""

    def __post_init__(self) -> None:
        """Refuse what are no probabilities."""
        if not (0 < self.birth < 1 and 0 < self.death < 1):
            raise InputError(
                f"Birth and death must lie between 0 and 1, got {self.birth:g} and {self.death:g}."
            )

    def follow(self, ridges: Ridges, said: Evidence | None = None) -> Posterior:
        """Give the posterior of each ridge being the stripe, 0 where there is no ridge.

        Args:
            ridges: Of one frame.
            said: Logarithm of the likelihood ratio that others give each ridge; none unless given.
        """
        ratio = self._weigh(ridges, said)
        first = self._chain(ridges, ratio)
        clear = ridges.exist & (ridges.heights > _CLEAR)
        free = clear & ~ridges.are_within(first > 0.5, ridges.reach)
        if not free.any():
            return first
        second = self._chain(ridges, np.where(free, ratio, 0.0))
        return np.where(go_on_beside(ridges, first, second), second, first)

    def follow_alone(self, ridges: Ridges) -> Posterior:
        """Give the posterior by what this frame alone says, without second branches."""
        return self._chain(ridges, self._weigh(ridges, None))

    def follow_some(self, ridges: Ridges, which: Marks) -> Posterior:
        """Compute the posterior as if only some ridges were there, without second branches."""
        return self._chain(ridges, np.where(which, self._weigh(ridges, None), 0.0))

    def _weigh(self, ridges: Ridges, said: Evidence | None) -> Evidence:
        """Give the likelihood ratio of each ridge against noise and clutter."""
        like = weigh_heights(ridges.heights, self.rates)
        other = ridges.edges if said is None else ridges.edges + np.minimum(said, 20.0)
        return np.where(ridges.exist, np.exp(other) * like, 0.0)

    def _chain(self, ridges: Ridges, ratio: Evidence) -> Posterior:
        length = len(ridges.lines.levels)
        own = ridges.straight, ridges.heights, ridges.counts, ridges.grains
        return follow_chain(*own, ratio, length, self.birth, self.death, _MISS, _STEPS)


def ask_frames(near: Mapping[int, Ridges], markov: Markov) -> Evidence:
    """Tell what the frames around say of each ridge: a surface stays, snow does not.

    Frames count as far as the recording's surely are of one surface: photographs of a board that
    was moved say nothing about one another.

    Returns:
        Logarithm of the likelihood ratio of each ridge of frame 0.
    """
    own = near[0]
    said = np.zeros_like(own.heights)
    sure = np.clip((own.heights - _FULL[0]) / (_FULL[1] - _FULL[0]), 0.0, 1.0)
    for distance in (distance for distance in _FRAMES if distance in near):
        is_there = own.are_also_in(near[distance], near=1.0 + 0.25 * abs(distance))
        seen = np.where(own.heights > _FAINT, _SEEN, _SEEN_FAINT)
        said += np.where(is_there, seen, _UNSEEN * sure)
    said = bound_by_stays(_persistence(near) * said, own.heights, markov.stays)
    _spare_long(own, said, markov)
    return np.where(own.are_blurred_ends(), np.minimum(said, 0.0) + _END, said)


def _persistence(near: Mapping[int, Ridges]) -> float:
    """Give from 0 to 1 how far frames that follow one another show the same surface."""
    shares = [near[k].agreement(near[k + 2]) for k in near if k + 2 in near]
    known = [share for share in shares if not np.isnan(share)]
    if not known:
        return 1.0
    low, high = _PERSISTENT
    return float(np.clip((np.median(known) - low) / (high - low), 0.0, 1.0))


def _spare_long(ridges: Ridges, said: Evidence, markov: Markov) -> None:
    """Let a surface that is new as a whole be: a long stripe needs no other frame."""
    against = (said[:, 0] < -3.0) & (ridges.heights[:, 0] > 6.0) & ridges.exist[:, 0]
    if not find_runs(against, ridges.straight[:, 0]).any():
        return
    posterior = markov.follow_alone(ridges)
    best, every = np.argmax(posterior, axis=1), np.arange(len(said))
    on = (posterior[every, best] > 0.5) & (ridges.heights[every, best] > 5.0)
    run = np.flatnonzero(find_runs(on, ridges.straight[every, best]))
    said[run, best[run]] = np.maximum(said[run, best[run]], 0.0)
