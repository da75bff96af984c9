"""What a recording's stripe looks like across its scan lines, learnt from the recording itself."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import partial

import numpy as np
from jaxtyping import Float, Shaped

from ..geometry.stripe_blur import MOST_BLUR
from ..types.arrays import Indices, Scalars
from ..types.background import Noise, Search, StripeShape
from .at_once import map_at_once
from .centres import Tightness, fit_ridges
from .clutter import learn_response_law
from .markov import Markov
from .matched_filter import FilterBank, MatchedFilter
from .pull import Slants
from .ridges import Ridges, find_frame_ridges, find_runs
from .scan_lines import ScanLines
from .scatter import ENOUGH, Bends, third_differences, weighted_median, with_scatter

_BINNINGS = (1, 2, 4, 8, 16, 32)
"""Pixels averaged, to find a stripe of whatever width with one filter."""
_FIRST_WIDTH = 0.6
"""1σ of that filter [px after averaging]."""
_FOUND = 0.2
"""Share of the most stripe found under any of them, from which the narrowest is taken: a wide
filter is fed by the skirt as well."""
_WINDOW = 10
"""Pixels on both sides of a stripe within which it sinks to half its height."""
_TOGETHER = 16
"""Neighbouring profiles that are averaged before their width is measured."""
_WIDEST, _WANTED = 2.2, 1.1
"""Width above which more pixels are averaged, and the one that is wanted then [px]."""
_WIDEST_BAND = 24.0
"""1σ of a white band of 60 px [px]."""
_LONGER = 10.0
"""Times that a stripe is longer than 1σ of its width, at least, to be told from a round blur."""
_CLEAR, _FEW, _SHARE = 8.0, 100, 0.01
"""Score from which a ridge tells of another width, and how many, and what share, must tell."""
_SURE = 0.9
"""Posterior from which a ridge is learnt from."""


def learn_stripe_shapes(
    look: Sequence[ScanLines], noise: Noise, *, markov: Markov, search: Search
) -> tuple[StripeShape, ...]:
    """Learn the core's widths, the skirt, and how much more than noise the centres scatter.

    Args:
        look: Frames spread over the recording, along their scan lines.
        noise: Of a pixel.
        markov: The chain that tells the stripe from the rest.
        search: How deep ridges are looked for.

    Returns:
        One shape for each width that the recording has, an octave apart, the commonest first; a
        narrow one where the frames show no stripe.
    """
    learner = _Learner(look, noise, markov, search)
    width = learner.measure_width()
    shape = learner.learn((_begin(width),))[0]
    # In faint stripes noise widens what is half as high: the fit knows better.
    fitted = shape.binning * shape.width
    if _binning(fitted) != shape.binning:
        shape = learner.learn((_begin(fitted),))[0]
    others = learner.find_others(shape)
    return learner.learn((shape, *others)) if others else (shape,)


def _begin(width: float) -> StripeShape:
    """Make a first shape for a stripe of a width [px]."""
    return _begin_at(width / _binning(width), _binning(width))


def _begin_at(width: float, binning: int) -> StripeShape:
    """Make a first shape of a width [px after averaging so many]."""
    return StripeShape(width, 0.1, binning, 1.0, 0.0)


def _binning(width: float) -> int:
    """Give how many pixels to average where a stripe has a width [px]."""
    return 1 if width <= _WIDEST else round(width / _WANTED)


@dataclass(frozen=True)
class _Learner:
    """How the stripe is looked for in single frames."""

    look: Sequence[ScanLines]
    noise: Noise
    markov: Markov
    search: Search

    def measure_width(self) -> float:
        """Measure the width at half height, under the least averaging that shows much stripe [px].

        Gives 1σ of a Gaussian that is as wide.
        """
        few = self.look[:: max(len(self.look) // 6, 1)]
        counts, widths = list[int](), list[Scalars]()
        length = len(self.look[0].levels)
        binnings = [binning for binning in _BINNINGS if 3 * binning <= length] or [1]
        for binning in binnings:
            measure = partial(self._measure_widths, binning=binning)
            found, measured = zip(*map_at_once(measure, few), strict=True)
            counts.append(sum(found))
            widths.append(np.concatenate(measured))
        known = widths[int(np.argmax(np.array(counts) >= _FOUND * max(counts)))]
        return float(np.nanmedian(known)) if np.isfinite(known).any() else _FIRST_WIDTH

    def _measure_widths(self, lines: ScanLines, binning: int) -> tuple[int, Scalars]:
        """Count the scan lines of a frame that show a stripe, and measure it there."""
        ridges = self._ridges(lines, self._bank((_begin_at(_FIRST_WIDTH, binning),)))
        line, which = self._sure(ridges, 6.0)
        seen = ridges.lines.binned(binning)
        middle = np.rint(seen.from_image(ridges.positions[line, which])).astype(int)
        return len(np.unique(line)), binning * _half_widths(seen.signal, line, middle)

    def find_others(self, shape: StripeShape) -> list[StripeShape]:
        """Find out which wider looks the stripe has, octaves away from a shape's."""
        first = shape.width * shape.binning
        length = len(self.look[0].levels)
        octaves = [first * 2.0**k for k in range(1, 6)]
        widths = [w for w in octaves if w <= min(_WIDEST_BAND, length / 12)]
        shapes = (shape, *(_begin(width) for width in widths))
        bank = self._bank(shapes)

        def list_heights(lines: ScanLines) -> list[Scalars]:
            ridges = self._ridges(lines, bank)
            return [self._long_heights(ridges, *each) for each in enumerate(shapes)]

        few = self.look[:: max(len(self.look) // 8, 1)]
        known = [np.concatenate(each) for each in zip(*map_at_once(list_heights, few), strict=True)]
        enough = max(_FEW, _SHARE * sum(len(each) for each in known))
        # Where paint is dark, the water's skirt alone is left of a stripe: wide, but fainter.
        usual = np.median(known[0]) if len(known[0]) else 0.0
        found = zip(shapes[1:], known[1:], strict=True)
        return [s for s, one in found if len(one) >= enough and np.median(one) >= usual]

    def _long_heights(self, ridges: Ridges, number: int, shape: StripeShape) -> Scalars:
        """List the heights of sure ridges of one shape that follow one another for long."""
        line, which = self._sure(ridges, _CLEAR)
        own = ridges.shapes[line, which] == number
        on, place = np.zeros(len(ridges.counts), bool), np.zeros(len(ridges.counts))
        on[line[own]] = True
        place[line[own]] = ridges.straight[line[own], which[own]]
        # Snow out of focus is as wide, but no longer than it is wide.
        least = max(_LONGER * shape.width * shape.binning, 24.0)
        long = find_runs(on, place, least=least)
        return ridges.heights[line[own], which[own]][long[line[own]]]

    def learn(self, shapes: tuple[StripeShape, ...]) -> tuple[StripeShape, ...]:
        """Learn the shapes, from first ones."""
        shapes = tuple(self._with_clutter(shape) for shape in shapes)
        learnt = []
        for fits, shape in zip(self._fit_all(shapes, Tightness(0.5, 0.3)), shapes, strict=True):
            if len(fits) > ENOUGH:
                width = weighted_median(fits.width, fits.trust)
                skirt = weighted_median(fits.skirt, fits.trust)
                shape = replace(shape, width=width, skirt=float(np.clip(skirt, 0.0, 0.5)))
            learnt.append(shape)
        fitted = self._fit_all(tuple(learnt), Tightness())
        return tuple(
            with_scatter(shape, fits.bends, widest=self._upright(shape))
            for shape, fits in zip(learnt, fitted, strict=True)
        )

    def _upright(self, shape: StripeShape) -> float:
        """Compute the width at right angles to an even wall's stripe [px of the full frame]."""
        lines = self.look[0].binned(shape.binning)
        return MOST_BLUR * lines.stretch * shape.width / math.hypot(1.0, lines.slope)

    def _with_clutter(self, shape: StripeShape) -> StripeShape:
        """Learn how strongly a filter of this width answers what is no stripe."""
        noise = self.noise.averaged(shape.binning)
        matched = MatchedFilter.of(shape.width, noise, shape.binning, search=self.search)
        return replace(shape, clutter=learn_response_law(self.look, matched))

    def _fit_all(self, shapes: tuple[StripeShape, ...], tightness: Tightness) -> list["_Fits"]:
        """Fit the sure ridges of all frames; those of each shape by themselves."""
        bank = self._bank(shapes)

        def fit(each: ScanLines) -> list[_Fits]:
            ridges = self._ridges(each, bank)
            lines, which = self._sure(ridges, 0.0)
            own = [ridges.shapes[lines, which] == number for number in range(len(shapes))]
            return [
                self._fit(ridges, lines[some], which[some], shape, tightness)
                for some, shape in zip(own, shapes, strict=True)
            ]

        return [_Fits.concatenate(each) for each in zip(*map_at_once(fit, self.look), strict=True)]

    def _fit(
        self, ridges: Ridges, lines: Indices, which: Indices, shape: StripeShape, held: Tightness
    ) -> "_Fits":
        seen = ridges.lines.binned(shape.binning)
        start = seen.from_image(ridges.positions[lines, which])
        noise = self.noise.averaged(shape.binning)
        found = fit_ridges(seen, lines, start, noise=noise, shape=shape, tightness=held)
        return _Fits.of(seen, lines, found, ridges.heights[lines, which])

    def _bank(self, shapes: tuple[StripeShape, ...]) -> FilterBank:
        return FilterBank.of(shapes, self.noise, self.search)

    def _ridges(self, lines: ScanLines, bank: FilterBank) -> Ridges:
        return find_frame_ridges({0: bank.score(lines)}, bank)

    def _sure(self, ridges: Ridges, least: float) -> tuple[Indices, Indices]:
        """Give the scan lines and the numbers of ridges that are surely the stripe."""
        posterior = self.markov.follow(ridges)
        lines, which = np.nonzero((posterior > _SURE) & (ridges.heights > least))
        return lines, which


@dataclass(frozen=True, eq=False)
class _Fits:
    """What was fitted to sure ridges."""

    width: Scalars
    skirt: Scalars
    trust: Scalars
    bends: Bends

    def __len__(self) -> int:
        """Count the ridges."""
        return len(self.width)

    @classmethod
    def of(
        cls, seen: ScanLines, lines: Indices, found: Float[np.ndarray, "n 5"], height: Scalars
    ) -> "_Fits":
        """Take what fits; a score above 50 is trusted no more than 50."""
        fits = np.isfinite(found[:, 0])
        clear = fits & (height > 6.0)
        centres, sigma, light, width, _ = found[clear].T
        at, places = lines[clear], seen.as_full_frame(centres)
        slants = Slants.of(seen, at, places, light=light, spread=sigma / width)
        pull = slants.pull() / seen.stretch
        straight = places - seen.even_wall(at.astype(float))
        bends = third_differences(at, centres, straight, sigma, pull)
        trust = np.minimum(height[fits], 50.0) ** 2
        return cls(found[fits, 3], found[fits, 4], trust, bends)

    @classmethod
    def concatenate(cls, parts: Sequence["_Fits"]) -> "_Fits":
        """Put those of several frames together."""
        return cls(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(cls)))


def _half_widths(
    levels: Shaped[np.ndarray, "h w"], lines: Indices, middle: Indices
) -> Float[np.ndarray, " groups"]:
    """Give 1σ of Gaussians as wide at half height as stripes are; NaN where they end too late.

    One faint profile is as wide as its noise; some of them together are as wide as the stripe.
    """
    at = middle[:, None] + np.arange(-_WINDOW, _WINDOW + 1)
    scan = levels[np.clip(at, 0, len(levels) - 1), lines[:, None]].astype(float)
    size = min(_TOGETHER, max(len(scan), 1))
    scan = scan[: len(scan) // size * size].reshape(-1, size, scan.shape[1]).mean(axis=1)
    scan -= 0.25 * scan[:, [0, 1, -2, -1]].sum(axis=1, keepdims=True)
    scan /= np.maximum(scan[:, _WINDOW - 1 : _WINDOW + 2].max(axis=1, keepdims=True), 1e-9)
    sides = _half_crossing(scan[:, _WINDOW:]) + _half_crossing(scan[:, _WINDOW::-1])
    return sides / math.sqrt(8 * math.log(2))


def _half_crossing(side: Float[np.ndarray, "n reach"]) -> Scalars:
    """Give the distance at which each row, above a half at first, sinks below; else NaN."""
    below = side < 0.5
    first = np.argmax(below, axis=1)
    every = np.arange(len(side))
    above, under = side[every, first - 1], side[every, first]
    crossing = first - 1 + (above - 0.5) / np.maximum(above - under, 1e-9)
    return np.where(first > 0, crossing, np.nan)
