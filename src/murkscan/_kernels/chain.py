"""A hidden Markov chain over scan lines: at which ridge is the stripe, or is there none?"""

import numpy as np

from .compiled import loop, part

_GAP = 4
"""Lines over which a link may reach: three may be missing between."""
_FAR = 12.0
"""Pixels a line beyond which only a jump can link."""


_DECAY = 64
"""Parts that an exponent is cut into, so that a short series gives it: to 1e-9 down to e^-16, which
compilers do for several numbers at once."""
_LEAST = 16.0
"""Exponent beyond which nothing is left beside anything over four e-folds."""
_ANYTHING = 0.0375
"""Density of a step in height that may be anything."""


@loop(error_model="numpy")
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
    faded = np.empty((_GAP, most))
    for u in range(num_lines):
        before = none_ahead[u - 1] if u else 1.0
        none = (1.0 - birth) * before
        first = start * before * (1.0 if u else 10.0)
        reach = min(_GAP, u)
        for gap in range(1, reach + 1):
            fade = np.exp(scale[u - gap] - scale[u - 1])
            for j in range(counts[u - gap]):
                faded[gap - 1, j] = fade * ahead[u - gap, j]
        total = 0.0
        for k in range(counts[u]):
            if evidence[u, k] == 0.0:
                continue
            reached = 0.0
            for gap in range(reach):
                for j in range(counts[u - gap - 1]):
                    reached += faded[gap, j] * links[u, gap, k, j]
            ahead[u, k] = (first + reached) * evidence[u, k]
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
    for u in range(num_lines):
        for k in range(most):
            both = ahead[u, k] * behind[u, k]
            ahead[u, k] = 1.0 if both > 1.0 else both
    return ahead


@part(error_model="numpy")
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
        reached = behind[u]
        reached[:] = death * next_none * fade
        for gap in range(1, min(_GAP, num_lines - 1 - u) + 1):
            faded = np.exp(scale[u] - scale[u + gap])
            for k in range(counts[u + gap]):
                onward = faded * evidence[u + gap, k] * behind[u + gap, k]
                if onward != 0.0:
                    for j in range(counts[u]):
                        reached[j] += onward * links[u + gap, gap - 1, k, j]
    return behind


@part(error_model="numpy")
def _weigh_links(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, grains: np.ndarray,
    evidence: np.ndarray, length: int, death: float, miss: float, bends: np.ndarray,
) -> np.ndarray:  # fmt: skip
    """Give how probable each step is to a ridge from one up to three missing lines before.

    Of a ridge that may not be taken, steps to it have no meaning.
    """
    num_lines, most = positions.shape
    links = np.empty((num_lines, _GAP, most, most), np.float32)
    logs = np.log(np.maximum(heights, 1e-9))
    like = np.empty(most)
    for u in range(1, num_lines):
        for gap in range(1, min(_GAP, u) + 1):
            kept = (1.0 - death) * miss ** (gap - 1)
            jump = (1.0 - bends[2] - bends[3]) / length
            for k in range(counts[u]):
                if evidence[u, k] == 0.0:
                    continue
                link, before = links[u, gap - 1, k], logs[u - gap, : counts[u - gap]]
                _weigh_changes(logs[u, k], before, bends[4] * np.sqrt(gap), like)
                for j in range(len(before)):
                    link[j] = kept * jump * like[j]
                    step = abs(positions[u, k] - positions[u - gap, j])
                    if step < _FAR * gap:
                        grain = max(grains[u, k], grains[u - gap, j])
                        link[j] = kept * (jump + _weigh_step(step, gap, grain, bends)) * like[j]
    return links


@part()
def _weigh_step(step: float, gap: int, grain: float, bends: np.ndarray) -> float:
    """Give the density of a step in position that is no jump to anywhere: two Laplace laws."""
    narrow, broad = bends[0] * gap + 0.1 * grain, bends[1] * gap
    density = bends[2] * np.exp(-step / narrow) / (2.0 * narrow)
    return density + bends[3] * np.exp(-step / broad) / (2.0 * broad)


@part(error_model="numpy")
def _weigh_changes(log: float, others: np.ndarray, spread: float, like: np.ndarray) -> None:
    """Compute the densities of steps in the logarithm of height from others to one.

    A Gaussian with exponential tails, whose norm is 2.66, and for 15 of 100 anything over four
    e-folds.
    """
    share, norm = 1.0 / spread, 0.85 / (2.6 * spread)
    for j in range(len(others)):
        off = (log - others[j]) * share
        tail = off if off > 0.0 else -off
        bell = 0.5 * off * off
        x = bell if bell < tail else tail
        x = (x if x < _LEAST else _LEAST) * (-1.0 / _DECAY)
        rest = 1 / 24 + x * (1 / 120 + x * (1 / 720 + x * (1 / 5040)))
        power = 1.0 + x * (1.0 + x * (1 / 2 + x * (1 / 6 + x * rest)))
        power *= power
        power *= power
        power *= power
        power *= power
        power *= power
        power *= power
        like[j] = norm * power + _ANYTHING
