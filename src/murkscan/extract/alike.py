"""How far errors of centres are alike: over scan lines, and in several frames."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from .._kernels.bends import count_signs, third_differences
from ..types.arrays import Scalars
from ..types.background import Noise
from .scatter import APART, ENOUGH, JUMP, MEDIAN, THIRD

_SHARED = 2.0 / 3.0
"""Correlation of neighbours, as a multiple of what the variance of third differences lacks: of 20
terms' worth of it, neighbours alone take away 30."""
_LONGEST = 5.0
"""Scan lines over which noise is alike, at most: what goes on longer is the surface."""
_BLOCKS = np.array([0.80, 0.53, 0.28, 0.10, 0.0, 0.0, 0.0, 0.0, 0.0])
"""Correlation of the errors of centres one, two … scan lines apart that an encoder leaves where it
has smoothed all noise away: its blocks have four and eight pixels. Measured in H.264 of crf 23 at
PAL size and of crf 32 at 1920 × 1200 alike (benchmarks/murk.py, c3-lamp20-colour-h264, c3-h264-hd,
seed 10)."""
_BENT = [1.0 + _BLOCKS[[a - 1, 2 * a - 1, 3 * a - 1]] @ [-1.5, 0.6, -0.1] for a in APART]
"""What that leaves of the variance of third differences."""
_EDGE = 4.0
"""Standard deviations from which a third difference is an edge of the surface and no noise."""
_MOST = 0.9
"""Correlation of frames at most: frames that are all the same tell nothing of their noise."""
_EACH = 4
"""Centres of a third difference: of neighbouring ones, one in so many is independent."""

_UNEVEN = 1.0
"""Standard deviations that uneven light should add to a third difference, to tell whether it does.
"""

_Bends = Float[np.ndarray, "frames _"]
"""Third differences, or what is expected of them, in standard deviations, by frame and scan line;
NaN where there are none."""
_Starts = Int[np.ndarray, " _"]
"""Number of the first centre of each frame, and of all."""


@dataclass(frozen=True)
class Alike:
    """How far the errors of some frames' centres are alike."""

    lines: float = 1.0
    """Scan lines over which they are."""
    own: float = 1.0
    """Variance that each frame has by itself, as a share of what centres are told to have."""
    same: float = 0.0
    """Variance that frames have in common by error, as a share of the same."""
    seen: float = 0.0
    """Variance that they have in common from line to line, by error or as a rough surface has it,
    which centres are told to have as well; as a share of the same."""
    drawn: float = 1.0
    """By how much of what is expected uneven light draws centres."""

    @classmethod
    def of(
        cls,
        lines: Scalars,
        straight: Scalars,
        sigma: Scalars,
        drawn: Scalars,
        starts: _Starts,
        *,
        noise: Noise,
    ) -> "Alike":
        """Measure it by third differences of centres that are one, two and three lines apart.

        An encoder copies what has hardly changed from frame to frame, with its errors, and a colour
        mosaic errs by where a stripe lies in it. Surfaces go on from frame to frame as well, but
        differences of neighbouring lines are blind to them; what those farther apart have more in
        common is the surface, and their noise is what is left.

        Args:
            lines: Scan line of each centre, frame by frame.
            straight: Where it lies from an even wall [full-frame px].
            sigma: Its standard deviation by itself [full-frame px].
            drawn: What uneven light is expected to draw it by, 1σ [full-frame px].
            starts: Number of each frame's first centre, and of all.
            noise: Of a pixel: frames share errors where neighbouring pixels do.
        """
        bends, uneven = _list_bends(lines, straight, sigma, drawn, starts)
        draws = _measure_draws(bends[-1], uneven[-1])
        sizes = [np.abs(each[np.isfinite(each)]) for each in bends]
        if min(map(len, sizes)) <= 3 * ENOUGH:
            return cls(drawn=draws)
        same = [_correlate(each) for each in bends]
        spread = [(float(np.median(each)) / MEDIAN) ** 2 for each in sizes]
        copied = min(max(_correlate(bends[0], _EDGE), 0.0), _MOST)
        if noise.smoothed:
            blocks = max(min(np.array(same) * spread / _BENT), 0.0)
            seen = copied + blocks
            return cls(1.0 + 2.0 * float(_BLOCKS.sum()), 1.0 - copied, seen, seen, draws)
        *near, far = (
            one * (1.0 - max(both - same[0], 0.0)) for one, both in zip(spread, same, strict=True)
        )
        shared = sum(_SHARED * max(1.0 - each / max(far, 1e-12), 0.0) for each in near)
        erring = copied if noise.shared else 0.0
        length = min(1.0 + 2.0 * shared, _LONGEST)
        return cls(length, 1.0 - erring, erring, copied, draws)


def _list_bends(
    lines: Scalars, straight: Scalars, sigma: Scalars, drawn: Scalars, starts: _Starts
) -> tuple[list[_Bends], list[_Bends]]:
    """List the third differences of centres, by how many scan lines they are apart.

    And what uneven light is expected to add to each.
    """
    # Fields' lines may lie half a line apart.
    step = 1 if np.all(lines == np.rint(lines)) else 2
    place = np.rint(step * (lines - lines.min())).astype(int)
    table = np.full((3, len(starts) - 1, int(place.max()) + 1), np.nan)
    frame = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
    table[:, frame, place] = straight, sigma**2, drawn**2
    jump = JUMP * float(np.linalg.norm(THIRD))
    both = [third_differences(table, step * each, THIRD, jump) for each in APART]
    return [bends for bends, _ in both], [uneven for _, uneven in both]


def _measure_draws(bends: _Bends, uneven: _Bends) -> float:
    """Measure by how much of what is expected uneven light adds to third differences.

    Half of them lie within their median size, noise and light together, if it is that much; what
    is more than expected is the surface.
    """
    told = np.isfinite(bends) & (uneven > _UNEVEN)
    shares = ((bends[told] / MEDIAN) ** 2 - 1.0) / uneven[told] ** 2
    # As much as `ENOUGH` would tell is known beforehand.
    known = np.concatenate([shares, np.tile([0.0, 2.0], ENOUGH // 2)])
    return math.sqrt(np.clip(np.median(known), 0.0, 1.0))


def _correlate(bends: _Bends, most: float = math.inf) -> float:
    """Estimate the correlation of frames by how often signs agree; 0 where it may be chance.

    Only what is less than `most` counts.

    References:
        Blomqvist, On a measure of dependence between two random variables, Annals of Mathematical
        Statistics 21(4), 1950 (the quadrant correlation).
    """
    pairs, agree = count_signs(bends, most)
    if pairs == 0:
        return 0.0
    correlation = math.sin(0.5 * math.pi * agree / pairs)
    chance = 0.5 * math.pi * math.sqrt(2 * _EACH / pairs)
    return correlation * max(1.0 - (chance / max(abs(correlation), chance)) ** 2, 0.0)
