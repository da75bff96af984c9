"""How paint across the laser's sheet pulls the stripe: learnt from the stripes, and taken back."""

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from ..types.arrays import Indices, Scalars
from ..types.paint_pull import PaintPull
from ..types.rig import Rig
from ..types.stripe import Stripe

_REACH = 3.0
"""Pixels by which one surface's stripe goes on at most from frame to frame; see `extract.pull`."""
_LAG = 4
"""Frames between centres that are compared: `Murk` joins two on either side."""
_DARKEST = 0.1
"""Least light whose logarithm means anything [grey levels]."""
_BEND = 0.5
"""Second difference of centres from which it is an edge of the surface [px]."""
_STEEPEST = 0.5
"""Change of light from frame to frame from which it is no paint but an end of the surface."""
_OPEN = 0.35
"""Share of a pull that stays unknown, 1σ: paint that changes within a frame's travel, slants, a
sheet that is no Gaussian. It is what is left of pulls above .01 px in benchmarks/dent.py, seed
8."""
_LINES, _FRAMES = 8, 16
"""Scan lines, and frames, whose errors are taken to be common: patches of paint, and relief, span
some."""
_FEW = 20
"""Blocks of lines below which their scatter does not tell how sure their mean is."""
_SURE = 3.0
"""Standard deviations from which a pull is believed: where there is none, one recording in 400 is
touched, by as little as that."""
_CAUCHY = 2.0 / 0.6745
"""Median deviations at which a comparison weighs half: two standard deviations."""
_TINY = 1e-9
_ROUNDS = 10
"""After which the weights no longer change by what matters."""

Sums = Float[np.ndarray, "2 3 blocks"]
"""Of shift × change and of change², weighted, and of change² by the slope of the weighted residual;
in blocks of scan lines, and in blocks of frames."""


def learn_paint_pulls(stripes: Iterable[Stripe], rig: Rig) -> tuple[PaintPull, ...]:
    """Learn how far paint pulls the centres of each laser, from pieces of a recording.

    The centre of a Gaussian sheet of 1σ thickness s on paint of reflectance ρ lies s² · ∂ln ρ/∂x
    off. Where the surface passes by, that is proportional to the change of the stripe's brightness
    over frames. Relief changes over frames slowly, paint at once: how much of the one goes with the
    other is seen in second differences of both.

    Args:
        stripes: Some consecutive frames each; they are read once and not kept.
        rig: The rig that recorded them.

    Returns:
        The pull of each laser of which enough is seen to tell that there is any. It is as one over
        the speed: where that changes, it is the mean of what was seen; where frames lie far apart
        beside the sheet's thickness, or the way turns back, there is none to be seen.

    References:
        Curless and Levoy, Better optical triangulation through spacetime analysis, ICCV 1995.
        For the standard deviation, from the scatter of blocks: Huber, Robust Statistics, 1981,
        section 7.6, and Liang and Zeger, Biometrika 73(1), 1986.
    """
    sums = defaultdict[int, list[Sums]](list)
    for stripe in stripes:
        for laser in np.unique(stripe.laser):
            sums[int(laser)].append(_compare(_Followed.of(stripe, rig, int(laser))))
    learnt = (_weigh(laser, np.concatenate(sums[laser], axis=2)) for laser in sorted(sums))
    return tuple(one for one in learnt if one is not None)


def undo_paint_pull(
    stripe: Stripe, pulls: Iterable[PaintPull], rig: Rig, *, beside: Stripe | None = None
) -> Stripe:
    """Put centres back where they would be if paint were alike across the sheet.

    Args:
        stripe: Centres of consecutive frames.
        pulls: What has been learnt of some lasers.
        rig: The rig that recorded them.
        beside: Centres of frames before and after them, for the brightness there.

    Returns:
        The stripe with other pixels and a sigma that holds what stays unknown of the pull. Centres
        without one before and one after them stay as they are.
    """
    pixels, variance = stripe.pixels.copy(), stripe.sigma.astype(float) ** 2
    both = stripe if beside is None else Stripe.concatenate([stripe, beside])
    for pull in pulls:
        along = "xy".index(rig.lasers[pull.laser].axis)
        track = _Followed.of(both, rig, pull.laser)
        change, noise = track.change()
        told = np.isfinite(change) & (track.row < len(stripe))
        row, change, noise = track.row[told], change[told], noise[told]
        pixels[row, along] -= pull.shift * change
        open_share = np.hypot(pull.sigma, _OPEN * pull.shift)
        variance[row] += (open_share * change) ** 2 + (pull.shift * noise) ** 2
    return replace(stripe, pixels=pixels, sigma=np.sqrt(variance).astype(np.float32))


@dataclass(frozen=True, eq=False)
class _Followed:
    """Centres of one laser, and each one's neighbours in the frames before and after."""

    row: Indices
    """Their rows in the stripe."""
    frame: Scalars
    line: Scalars
    """Scan line."""
    position: Scalars
    """Along it [px]."""
    light: Scalars
    """Logarithm of the stripe's height."""
    noise: Scalars
    """Standard deviation of that: a fit's amplitude is as sure, in shares, as its centre in
    widths."""
    ahead: Indices
    """Number of the same place of the stripe in the next frame, or, where fields take turns, in the
    one after it; the number of centres where there is none."""
    behind: Indices

    @classmethod
    def of(cls, stripe: Stripe, rig: Rig, laser: int) -> "_Followed":
        row = np.flatnonzero(stripe.laser == laser)
        along = "xy".index(rig.lasers[laser].axis)
        mine = stripe[row]
        position = mine.pixels[:, along]
        line, frame = np.rint(mine.pixels[:, 1 - along]), mine.frame.astype(float)
        width = np.maximum(mine.width, 1.0) if len(mine.width) else 1.0
        light = np.log(np.maximum(mine.signal, _DARKEST, dtype=float))
        ahead, behind = (
            _find_neighbours(frame, line, position, towards=towards) for towards in (1, -1)
        )
        return cls(row, frame, line, position, light, mine.sigma / width, ahead, behind)

    def change(self) -> tuple[Scalars, Scalars]:
        """Compute the change of light a frame, and its standard deviation; NaN at ends."""
        light, frame, noise = (np.append(a, np.nan) for a in (self.light, self.frame, self.noise))
        frames = frame[self.ahead] - frame[self.behind]
        change = (light[self.ahead] - light[self.behind]) / frames
        change[~(np.abs(change) < _STEEPEST)] = np.nan
        return change, np.hypot(noise[self.ahead], noise[self.behind]) / frames

    def bend(self, *values: Scalars) -> list[Scalars]:
        """Compute second differences over frames; NaN where a neighbour is missing."""
        frame, *padded = (np.append(value, np.nan) for value in (self.frame, *values))
        after, before = (np.append(which, len(self.row)) for which in (self.ahead, self.behind))
        ahead = behind = np.arange(len(frame))
        for _ in range(_LAG):
            ahead = np.where(frame[ahead] - frame < _LAG, after[ahead], ahead)
            behind = np.where(frame - frame[behind] < _LAG, before[behind], behind)
        even = np.where(frame[ahead] + frame[behind] == 2 * frame, 1.0, np.nan)
        return [((v[ahead] - 2 * v + v[behind]) * even)[:-1] for v in padded]


def _find_neighbours(frame: Scalars, line: Scalars, position: Scalars, *, towards: int) -> Indices:
    """Find the nearest centre of the same scan line in the next frame, or in the one after it."""
    found = np.full(len(frame), len(frame))
    if not len(frame):
        return found
    # One number a centre, such that those of other frames and lines are out of reach.
    long, frames = np.ptp(position) + 2 * _REACH, np.ptp(frame) + 4
    number = (line * frames + frame - frame.min()) * long + position
    order = np.argsort(number, kind="stable")
    for step in (2, 1):
        wanted = number + towards * step * long
        after = np.searchsorted(number[order], wanted)
        near = order[np.clip([after - 1, after], 0, len(frame) - 1)]
        away = np.abs(number[near] - wanted)
        nearest = np.where(away[0] <= away[1], *near)
        found = np.where(away.min(axis=0) < _REACH, nearest, found)
    return found


def _compare(track: _Followed) -> Sums:
    """Sum how shifts of centres go with changes of light, over blocks of lines and of frames.

    What all lines of a frame share is the vehicle's heave, and left out. Edges of the surface weigh
    little.
    """
    change, _ = track.change()
    bend, bent = track.bend(track.position, change)
    told = (np.abs(bend) < _BEND) & np.isfinite(bent)
    if not told.any():
        return np.zeros((2, 3, 0))
    frame, line, pair = track.frame[told], track.line[told], np.stack([bend, bent])[:, told]
    _, place, count = np.unique(frame, return_inverse=True, return_counts=True)
    bend, bent = (one - (np.bincount(place, one) / count)[place] for one in pair)
    shift = 0.0
    for _ in range(_ROUNDS):
        off = np.abs(bend - shift * bent)
        # Cauchy's weights, at twice the usual scatter: an edge's share falls with its distance.
        weight = 1 / (1 + (off / (_CAUCHY * max(float(np.median(off)), _TINY))) ** 2)
        shift = float(np.sum(weight * bend * bent) / np.sum(weight * bent**2))
    blocks = [(v // size).astype(int) for v, size in ((line, _LINES), (frame, _FRAMES))]
    last = max(int(block.max()) for block in blocks)
    terms = weight * bent * bend, weight * bent**2, weight * (2 * weight - 1) * bent**2
    return np.array([[np.bincount(b, term, last + 1) for term in terms] for b in blocks])


def _weigh(laser: int, sums: Sums) -> PaintPull | None:
    """Join what blocks tell; None where they do not tell that there is any pull."""
    across, square, slope = np.moveaxis(sums, 1, 0)
    if np.count_nonzero(square[0]) < _FEW:
        return None
    shift = across[0].sum() / square[0].sum()
    # Paint and relief stretch along lines in some places, and along frames in others.
    scatter = np.sqrt(np.sum((across - shift * square) ** 2, axis=1)).max()
    sigma = scatter / slope[0].sum()
    return PaintPull(laser, float(shift), float(sigma)) if abs(shift) > _SURE * sigma else None
