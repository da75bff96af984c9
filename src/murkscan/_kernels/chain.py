"""A hidden Markov chain over scan lines: at which ridge is the stripe, or is there none?"""

import numpy as np
from numba import njit

_GAP = 4
"""Lines over which a link may reach: three may be missing between."""
_FAR = 12.0
"""Pixels a line beyond which only a jump can link."""


@njit(cache=True, nogil=True)
def follow_chain(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, grains: np.ndarray,
    evidence: np.ndarray, length: int, birth: float, death: float, miss: float, bends: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Give the posterior of each ridge (lines, most), by the forward-backward algorithm.

    A state is a ridge of the line, or that the line shows no stripe. Positions are as fine as a
    tenth of a grain. `evidence` is the likelihood
    ratio of each ridge against noise and clutter, 0 for one that may not be taken. `bends` holds
    the scale of small steps and of larger ones [px a line], their shares, and the scale of steps
    in the logarithm of the height.

    References:
        Rabiner, A tutorial on hidden Markov models, Proc. IEEE 77(2), 1989, section III, with
        each line scaled on its own.
    """
    num_lines, most = positions.shape
    links = _weigh_links(positions, heights, counts, grains, evidence, length, death, miss, bends)
    start = birth / length * 0.25
    ahead, none_ahead = np.zeros((num_lines, most)), np.zeros(num_lines)
    scale = np.zeros(num_lines)
    for u in range(num_lines):
        before = none_ahead[u - 1] if u else 1.0
        none = (1.0 - birth) * before
        first = start * before * (1.0 if u else 10.0)
        total = 0.0
        for k in range(counts[u]):
            if evidence[u, k] == 0.0:
                continue
            reached = first
            for gap in range(1, min(_GAP, u) + 1):
                faded = np.exp(scale[u - gap] - scale[u - 1])
                for j in range(counts[u - gap]):
                    reached += faded * ahead[u - gap, j] * links[u, gap - 1, k, j]
            ahead[u, k] = reached * evidence[u, k]
            total += ahead[u, k]
        if u:
            for j in range(counts[u - 1]):
                none += death * ahead[u - 1, j]
        total += none
        for k in range(counts[u]):  # an array that is set by another compiles for 2 s
            ahead[u, k] /= total
        none_ahead[u] = none / total
        scale[u] = (scale[u - 1] if u else 0.0) + np.log(total)
    behind = _run_back(counts, evidence, links, scale, start, birth, death)
    return np.minimum(ahead * behind, 1.0)


@njit(cache=True, nogil=True)
def _run_back(
    counts: np.ndarray, evidence: np.ndarray, links: np.ndarray, scale: np.ndarray,
    start: float, birth: float, death: float,
) -> np.ndarray:  # fmt: skip
    """Give how likely all later lines are, from each ridge, scaled as on the way ahead."""
    num_lines, most = evidence.shape
    behind = np.ones((num_lines, most))
    none = 1.0
    for u in range(num_lines - 2, -1, -1):
        next_none = none
        fade = np.exp(scale[u] - scale[u + 1])
        none = (1.0 - birth) * next_none
        for k in range(counts[u + 1]):
            none += start * evidence[u + 1, k] * behind[u + 1, k]
        none *= fade
        for j in range(counts[u]):
            reached = death * next_none * fade
            for gap in range(1, min(_GAP, num_lines - 1 - u) + 1):
                faded = np.exp(scale[u] - scale[u + gap])
                for k in range(counts[u + gap]):
                    onward = evidence[u + gap, k] * behind[u + gap, k]
                    reached += faded * links[u + gap, gap - 1, k, j] * onward
            behind[u, j] = reached
    return behind


@njit(cache=True, nogil=True)
def _weigh_links(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, grains: np.ndarray,
    evidence: np.ndarray, length: int, death: float, miss: float, bends: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Give how probable each step is to a ridge from one up to three missing lines before."""
    num_lines, most = positions.shape
    links = np.zeros((num_lines, _GAP, most, most))
    logs = np.log(np.maximum(heights, 1e-9))
    for u in range(1, num_lines):
        for gap in range(1, min(_GAP, u) + 1):
            kept = (1.0 - death) * miss ** (gap - 1)
            for k in range(counts[u]):
                if evidence[u, k] == 0.0:
                    continue
                for j in range(counts[u - gap]):
                    if evidence[u - gap, j] == 0.0:
                        continue
                    step = abs(positions[u, k] - positions[u - gap, j])
                    change = logs[u, k] - logs[u - gap, j]
                    grain = max(grains[u, k], grains[u - gap, j])
                    like = _weigh_step(step, change, gap, length, grain, bends)
                    links[u, gap - 1, k, j] = kept * like
    return links


@njit(cache=True, nogil=True)
def _weigh_step(
    step: float, change: float, gap: int, length: int, grain: float, bends: np.ndarray
) -> float:
    """Give the density of a step in position and in the logarithm of height.

    Steps in position are two Laplace laws and a jump to anywhere; those in height a Gaussian with
    exponential tails, whose norm is 2.66, and for 15 of 100 anything over four e-folds.
    """
    near, wide, near_share, wide_share, scale = bends
    density = (1.0 - near_share - wide_share) / length
    if step < _FAR * gap:
        narrow, broad = near * gap + 0.1 * grain, wide * gap
        density += near_share * np.exp(-step / narrow) / (2.0 * narrow)
        density += wide_share * np.exp(-step / broad) / (2.0 * broad)
    spread = scale * np.sqrt(gap)
    off = abs(change) / spread
    like = 0.85 * np.exp(-min(off, 0.5 * off * off)) / (2.6 * spread)
    return density * (like + 0.0375)
