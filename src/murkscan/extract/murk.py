"""Find the stripe where the water hides it: weigh all evidence, and say how probable each point is.

frames ─▶ scores ─▶ ridges ─▶ posteriors ─▶ centres ─▶ joined centres
          noise     ±1 frame  lines, ±4     fit        ±2 frames
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, final

from ..errors import InputError
from ..types.background import Background, Noise, StripeShape
from ..types.frame import Frame
from ..types.laser import Axis
from ..types.rig import Rig
from ..types.stripe import Stripe
from .assemble import assemble_stripe
from .attenuation import estimate_attenuation, nearer_side
from .base import AbstractExtractor
from .centres import Centres, doubt_wide, find_centres, join_frames
from .glow import clearance, learn_glow
from .markov import Markov, ask_frames
from .matched_filter import MatchedFilter
from .neighbours import with_neighbours
from .noise import learn_levels, learn_noise
from .remarks import find_remarks
from .ridges import find_frame_ridges
from .scan_lines import ScanLines
from .stripe_shape import learn_stripe_shape


@final
@dataclass(frozen=True)
class Murk(AbstractExtractor):
    """A ridge of known width in known noise, followed over scan lines and frames.

    Each pixel is scored in standard deviations of its noise; a hidden Markov chain over scan lines
    that may also say "no stripe here" weighs ridges against one another, with what neighbouring
    frames show; a fit of core, skirt and background gives the centre.
    """

    look_ahead: ClassVar[int] = 7

    min_posterior: float = 0.5
    """Probability from which a point is given, at least a half."""
    min_score: float = 2.5
    """Standard deviations of the noise from which a ridge is looked at."""
    clutter: float = 0.02
    """Ridges of snow and glow that are expected in a pixel and an e-fold of height."""
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
        self._markov()

    def learn(self, frames: Sequence[Frame], rig: Rig, *, laser: int = 0) -> Background:
        """Learn the noise of each grey level, the stripe's shape, and how murky the water is."""
        axis = rig.laser(laser).axis
        levels = learn_levels([f.image if axis == "y" else f.image.T for f in frames])
        shape = learn_stripe_shape(
            frames, axis, levels, markov=self._markov(), min_score=self.min_score
        )
        background = Background(learn_noise(frames).noise, levels, shape)
        alone = (self.extract([frame], rig, background, laser=laser) for frame in frames)
        stripes = [next(found) for found in alone]
        near, clear = nearer_side(rig, laser=laser), clearance(shape, frames[0])
        remarks = find_remarks(frames, stripes, axis, levels, near=near, clear=clear)
        background = replace(background, remarks=remarks)
        if rig.water is None:
            return background
        glow = learn_glow(frames, stripes, axis, levels, near=near, clear=clear)
        return replace(background, attenuation=estimate_attenuation(glow, rig, laser=laser))

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        levels, shape = background.levels, background.stripe
        if levels is None or shape is None:
            raise InputError("Murk needs what it has learnt itself: give what its `learn` gave.")
        axis = rig.laser(laser).axis
        centres = self._centres(frames, axis, levels, shape)
        for near in with_neighbours(centres, 2):
            joined = doubt_wide(join_frames(near))
            yield _as_stripe(joined[joined.posterior >= self.min_posterior], laser)

    def _centres(
        self, frames: Iterable[Frame], axis: Axis, levels: Noise, shape: StripeShape
    ) -> Iterator[Centres]:
        markov, noise = self._markov(), levels.averaged(shape.binning)
        matched = MatchedFilter.of(shape.width, noise)
        look = partial(ScanLines.of, axis=axis, binning=shape.binning, white=levels.white)
        scored = (matched.score(look(frame)) for frame in frames)
        ridges = (
            find_frame_ridges(near, least=self.min_score, reach=matched.reach)
            for near in with_neighbours(scored, 1)
        )
        for near in with_neighbours(ridges, 4):
            posterior = markov.follow(near[0], ask_frames(near, markov))
            yield find_centres(near[0], posterior, noise=noise, shape=shape)

    def _markov(self) -> Markov:
        return Markov(self.clutter, self.birth, self.death)


def _as_stripe(centres: Centres, laser: int) -> Stripe:
    lines = centres.lines
    stretch = lines.frame.row_step if lines.axis == "y" else 1
    return assemble_stripe(
        lines.frame,
        lines.axis,
        laser,
        lines=centres.scan_line,
        centres=lines.from_full_frame(centres.position),
        sigma=centres.sigma / stretch,
        signal=centres.signal,
        posterior=centres.posterior,
    )
