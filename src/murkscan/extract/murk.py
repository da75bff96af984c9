"""Find the stripe where the water hides it: weigh all evidence, and say how probable each point is.

frames ─▶ scores ─▶ ridges ─▶ posteriors ─▶ centres ─▶ joined centres
          noise     ±1 frame  lines, ±4     fit        ±2 frames
"""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import starmap
from typing import ClassVar, TypeVar, final

import numpy as np

from ..errors import InputError
from ..types.arrays import Scalars
from ..types.background import Background, FixedPattern, Noise, Search, StripeShape
from ..types.frame import Frame
from ..types.rig import Rig
from ..types.stripe import Stripe
from .assemble import assemble_centres
from .at_once import map_at_once
from .attenuation import estimate_attenuation, nearer_side
from .base import AbstractExtractor
from .centres import Centres, doubt_wide, find_centres, join_frames
from .clutter import Rates, Stays, learn_rates, learn_stays, usual_rates, usual_stays
from .fixed import learn_fixed_patterns
from .glow import clearance, learn_glow, look_at_glow
from .markov import Markov, Posterior, ask_frames
from .matched_filter import FilterBank
from .neighbours import with_neighbours
from .noise import learn_levels, learn_noise
from .remarks import find_remarks
from .ridge_centres import take_ridges
from .ridges import Ridges, find_frame_ridges
from .rim import add_rim
from .row_noise import learn_row_noise
from .scan_lines import ScanLines
from .sheets import OtherLasers, expected_slope, look_along
from .stripe_shape import learn_stripe_shapes

_FAINT, _MORE = 15.0, 1.7
"""Median score of the stripe below which a deeper look is tried, and how many times as much it must
find to be taken; where it finds so much less, what was found before was noise. At c = 6 and 7 /m it
finds twice as much, from 1.0 to 1.5 times in clearer water, in texture and in encoded video, where
it is not worth its time (benchmarks/murk.py, seed 0)."""
_ROUNDED = 0.5
"""Standard deviation of a pixel's noise below which rounding draws lines itself [grey levels]."""
_LOW, _FEW_LONG = 8.0, 0.1
"""Median score, and share of what goes on over many scan lines, below which a recording shows no
stripe: a surface that is as faint as that, or that a deeper look alone shows, is found in long
lines, remnants of dirt in short ones. Small pieces of a surface are seen in clear water only, where
they are bright."""
_SOME = 0.07
"""Share of the scan lines that a deep look finds by chance, in what is left of rows' own noise."""
_DEEP, _WIDER = 0.6, 3
"""Factor of the least score in a deeper look, and how much farther its filters see [px]."""
_FEW = 16
"""Frames that suffice to learn shapes and rates; what is fixed to the picture needs more."""

Item = TypeVar("Item")


@final
@dataclass(frozen=True)
class Murk(AbstractExtractor):
    """A ridge of known width in known noise, followed over scan lines and frames.

    Each pixel is scored in standard deviations of its noise; a hidden Markov chain over scan lines
    that may also say "no stripe here" weighs ridges against one another, with what neighbouring
    frames show; a fit of core, skirt and background gives the centre.
    """

    look_ahead: ClassVar[int] = 7
    tells_lasers_apart: ClassVar[bool] = True

    min_posterior: float = 0.5
    """Probability from which a point is given, at least a half."""
    min_score: float = 2.5
    """Standard deviations of the noise from which a ridge is looked at."""
    birth: float = 3e-5
    """Probability that a stripe begins at a scan line."""
    death: float = 3e-3
    """Probability that it ends there."""

    def __post_init__(self) -> None:
        """Refuse settings that are no probabilities."""
        if not (0.5 <= self.min_posterior < 1.0 and self.min_score >= 1.0):
            raise InputError(
                "Murk needs min_posterior from 0.5 up to 1 and min_score ≥ 1, got "
                f"{self.min_posterior:g} and {self.min_score:g}."
            )
        self._markov(usual_rates(), usual_stays())

    def learn(self, frames: Sequence[Frame], rig: Rig, *, laser: int = 0) -> Background:
        """Learn the noise of each grey level, the stripe's shape, and how murky the water is."""
        return self._learn(frames, rig, laser, self._learn_depth)

    def learn_soon(self, frames: Sequence[Frame], rig: Rig, *, laser: int = 0) -> Background:
        """Learn the same without a deeper look; see `AbstractExtractor.learn_soon`."""
        return self._learn(frames, rig, laser, self._learn_rates)

    def _learn(
        self,
        frames: Sequence[Frame],
        rig: Rig,
        laser: int,
        learn_depth: Callable[[Sequence[ScanLines], FilterBank, Rig], "_Learnt"],
    ) -> Background:
        axis = rig.laser(laser).axis
        levels = learn_levels([f.image if axis == "y" else f.image.T for f in frames])
        if axis == "y":
            levels = replace(levels, rows=learn_row_noise([f.image for f in frames], levels))
        see = partial(ScanLines.of, axis=axis, noise=levels, slope=expected_slope(rig, laser))
        fixed, shapes = self._learn_fixed(frames, see, levels, lasers=len(rig.lasers))
        look = [see(frame, fixed=fixed) for frame in _thin(frames)]
        if any(one.levels.any() for one in fixed):
            shapes = self._learn_shapes(look, levels, self._plain)
        learnt = learn_depth(look, FilterBank.of(shapes, levels, self._plain), rig)
        background = Background(
            learn_noise(frames).noise,
            levels,
            learnt.bank.shapes,
            rates=learnt.rates,
            stays=learnt.stays,
            search=learnt.bank.search,
            fixed=fixed,
        )
        others = OtherLasers.of(rig, laser)

        def find(frame: Frame) -> Stripe:
            return next(self._find([see(frame, fixed=fixed)], background, others, laser))

        stripes = map_at_once(find, frames)
        near, clear = nearer_side(rig, laser=laser), clearance(background.shapes[0], frames[0])
        seen_glow = look_at_glow(frames, stripes, axis, levels, near=near, clear=clear)
        remarks = find_remarks(frames, stripes, seen_glow, levels)
        background = replace(background, remarks=remarks)
        if rig.water is None:
            return background
        glow = learn_glow(frames, seen_glow, axis, levels)
        return replace(background, attenuation=estimate_attenuation(glow, rig, laser=laser))

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        seen = look_along(frames, rig, background, laser)
        return self._find(seen, background, OtherLasers.of(rig, laser), laser)

    def extract_soon(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the same ridges, without a fit to each; see `AbstractExtractor.extract_soon`."""
        seen = look_along(frames, rig, background, laser)
        found = self._follow(seen, background, OtherLasers.of(rig, laser))
        return self._give(_measure(found, take_ridges, background), laser)

    def _find(
        self, seen: Iterable[ScanLines], background: Background, others: OtherLasers, laser: int
    ) -> Iterator[Stripe]:
        found = self._follow(seen, background, others)
        near = with_neighbours(_measure(found, find_centres, background), 2)
        return self._give((join_frames(one, noise=_law(background)) for one in near), laser)

    def _give(self, centres: Iterable[Centres], laser: int) -> Iterator[Stripe]:
        for one in map(doubt_wide, centres):
            yield assemble_centres(one[one.posterior >= self.min_posterior], laser)

    def _follow(
        self, seen: Iterable[ScanLines], background: Background, others: OtherLasers
    ) -> Iterator[tuple[Ridges, Posterior]]:
        """Give each frame's ridges, and how probably each is the stripe."""
        markov = self._markov(background.rates, background.stays)
        bank = FilterBank.of(background.shapes, _law(background), background.search)
        scored = (bank.score(lines) for lines in seen)
        ridges = (find_frame_ridges(near, bank) for near in with_neighbours(scored, 1))
        for near in with_neighbours(ridges, 4):
            own = others.tell(near[0])
            yield near[0], own * markov.follow(near[0], ask_frames(near, markov) + np.log(own))

    @property
    def _plain(self) -> Search:
        return Search(least=self.min_score)

    def _learn_shapes(
        self, look: Sequence[ScanLines], noise: Noise, search: Search
    ) -> tuple[StripeShape, ...]:
        markov = self._markov(usual_rates(), usual_stays())
        return learn_stripe_shapes(look, noise, markov=markov, search=search)

    def _learn_fixed(
        self, frames: Sequence[Frame], see: Callable[..., ScanLines], noise: Noise, *, lasers: int
    ) -> tuple[tuple[FixedPattern, ...], tuple[StripeShape, ...]]:
        """Learn what is fixed to the picture, and the stripe's looks before it is taken away."""
        see = partial(see, fixed=add_rim(frames, noise, ()))
        shapes = self._learn_shapes([see(frame) for frame in _thin(frames)], noise, self._plain)
        bank = FilterBank.of(shapes, noise, self._plain)
        markov = self._markov(usual_rates(), usual_stays())
        stays = learn_fixed_patterns(frames, see, bank, markov, lasers=lasers)
        return add_rim(frames, noise, stays), shapes

    def _learn_depth(self, look: Sequence[ScanLines], bank: FilterBank, rig: Rig) -> "_Learnt":
        """Learn how often clutter is met, after a deeper look where that finds much more."""
        learnt = self._learn_rates(look, bank, rig)
        faint = not learnt.height >= _FAINT
        if faint and bank.noise.typical(look[0].levels) > _ROUNDED:
            search = _deepen(bank.search)
            shapes = self._learn_shapes(look, bank.noise, search)
            deep = self._learn_rates(look, FilterBank.of(shapes, bank.noise, search), rig)
            few = _SOME * sum(lines.num_lines for lines in look)
            more = deep.count > _MORE * max(learnt.count, few)
            if more or _MORE * deep.count < learnt.count:
                learnt = deep
        is_faint = learnt.height < _LOW or learnt.bank.search != bank.search
        if is_faint and learnt.long < _FEW_LONG * learnt.count:
            return replace(learnt, rates=np.full_like(learnt.rates, np.inf))
        return learnt

    def _learn_rates(self, look: Sequence[ScanLines], bank: FilterBank, rig: Rig) -> "_Learnt":
        """Count the clutter of each height, twice: what is a stripe, of any laser, hangs on it."""
        ridges = map_at_once(lambda lines: find_frame_ridges({0: bank.score(lines)}, bank), look)
        lasers = [OtherLasers.of(rig, number) for number in range(len(rig.lasers))]
        rates = usual_rates()
        for _ in range(2):
            markov = self._markov(rates, usual_stays())
            follow = partial(_follow_each, markov=markov, lasers=lasers)
            stripes = map_at_once(follow, ridges)
            rates = learn_rates(ridges, stripes)
        heights = [
            one.heights[posterior > 0.5]
            for one, each in zip(ridges, stripes, strict=True)
            for posterior in each
        ]
        long = sum(
            int(one.are_in_lines(posterior > 0.5).sum())
            for one, each in zip(ridges, stripes, strict=True)
            for posterior in each
        )
        stays = learn_stays(ridges, stripes)
        return _Learnt(bank, rates, stays, np.concatenate(heights), long)

    def _markov(self, rates: Rates, stays: Stays) -> Markov:
        return Markov(rates, stays, self.birth, self.death)


@dataclass(frozen=True, eq=False)
class _Learnt:
    """What single frames show at one depth of search."""

    bank: FilterBank
    rates: Rates
    stays: Stays
    heights: Scalars
    """Scores of what is the stripe."""
    long: int
    """Scan lines of those that go on over many lines."""

    @property
    def count(self) -> int:
        """Count the scan lines that show a stripe."""
        return len(self.heights)

    @property
    def height(self) -> float:
        """Give the stripe's median score; NaN where there is none."""
        return float(np.median(self.heights)) if len(self.heights) else math.nan


def _law(background: Background) -> Noise:
    assert background.levels is not None  # by `look_along`
    return background.levels


def _measure(
    found: Iterable[tuple[Ridges, Posterior]], how: Callable[..., Centres], background: Background
) -> Iterator[Centres]:
    """Give the centres of each frame's ridges."""
    return starmap(partial(how, noise=_law(background), shapes=background.shapes), found)


def _follow_each(ridges: Ridges, markov: Markov, lasers: Sequence[OtherLasers]) -> list[Posterior]:
    """Give the posterior of each ridge being the stripe of each laser."""
    return [markov.follow(ridges, np.log(laser.tell(ridges))) for laser in lasers]


def _deepen(search: Search) -> Search:
    """Look deeper: what no scan line shows by itself, many together may."""
    return Search(_DEEP * search.least, 2 * search.most, search.window + _WIDER)


def _thin(items: Sequence[Item]) -> Sequence[Item]:
    """Take some of the frames that were given, both kinds of fields among them."""
    step = max(len(items) // _FEW, 1)
    return [item for number, item in enumerate(items) if number // 2 % step == 0]
