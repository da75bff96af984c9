"""The exact centre of a stripe where its ridge is, and how sure it is."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
import scipy
from jaxtyping import Float

from .._kernels.join_centres import join_centres
from .._kernels.stripe_fit import fit_stripes, spread_skirts
from ..types.arrays import Indices, Mask, Scalars
from ..types.background import Noise, StripeShape
from .alike import Alike
from .matched_filter import SKIRT
from .plateaus import measure_at
from .pull import Slants, undo_pull
from .ridges import PLATEAU, Marks, Ridges
from .scan_lines import ScanLines

_WIDTH_SPREAD, _SKIRT_SPREAD = 0.15, 0.1
"""Spreads of the priors on a stripe's width (of its logarithm) and on its skirt's share."""
_REACH = 8.0
"""Scan lines over which centres are joined."""
_ROUGH = 0.04
"""Most roughness of a surface from scan line to scan line, as far as nothing shows more [px]."""
_DARK = 0.7
"""E-folds by which an end is darker than the stripe further in, from which it is blur: half of the
light is left where a surface ends."""
_CREDIBLE = 0.2
"""Share of the height that a ridge's score stands for, below which a fit has explained it away."""
_BLUR = 0.2
"""Chance that such an end is the surface and not the lens's blur."""
_RIGHT = 1.5
"""Pixels within which a centre is the surface's, and not something beside it."""


@dataclass(frozen=True, eq=False)
class Centres:
    """Centres of one frame, by scan line."""

    lines: ScanLines
    scan_line: Indices
    position: Scalars
    """Along the scan line [full-frame px]."""
    sigma: Scalars
    """Standard deviation [full-frame px]."""
    signal: Scalars
    """Height of the stripe above its surroundings [grey levels]."""
    posterior: Scalars
    common: Scalars
    """What all centres err by together where the blur errs by 1σ, with its sign [full-frame px]."""
    drawn: Scalars
    """What uneven light draws it by in all frames alike, 1σ [full-frame px]."""
    rough: Scalars
    """Roughness of the surface from scan line to scan line [full-frame px]."""
    blur_shift: Scalars
    """How far the lens's blur had drawn it before it was put back [full-frame px]."""
    width: Scalars
    """1σ of the stripe at right angles to it, where it is learnt [full-frame px]; else 0."""

    def __len__(self) -> int:
        """Count the centres."""
        return len(self.scan_line)

    def __getitem__(self, which: Mask | Indices) -> "Centres":
        """Pick some of them."""
        return Centres(self.lines, *(getattr(self, name)[which] for name in _COLUMNS))

    @property
    def index(self) -> int:
        """Number of the frame in its recording."""
        return self.lines.index

    @classmethod
    def concatenate(cls, parts: Sequence["Centres"]) -> "Centres":
        """Put centres of one frame one after another."""
        columns = (np.concatenate([getattr(part, name) for part in parts]) for name in _COLUMNS)
        return cls(parts[0].lines, *columns)


_COLUMNS = tuple(field.name for field in fields(Centres) if field.name != "lines")


@dataclass(frozen=True)
class Tightness:
    """How firmly a fit is held to the shape that was learnt."""

    width: float = _WIDTH_SPREAD
    """Spread of the logarithm of the core's width."""
    skirt: float = _SKIRT_SPREAD
    """Spread of the skirt's share."""


def fit_ridges(
    lines: ScanLines,
    scan_lines: Indices,
    positions: Scalars,
    *,
    noise: Noise,
    shape: StripeShape,
    tightness: Tightness = Tightness(),
) -> Float[np.ndarray, "n 5"]:
    """Fit core, skirt and a curved background around each ridge, weighted by the noise.

    Args:
        lines: The frame.
        scan_lines: Scan line of each ridge.
        positions: Its position [px of `lines`].
        noise: Of a pixel of `lines`.
        shape: The stripe's usual shape.
        tightness: How firmly the fit is held to it.

    Returns:
        Position and its standard deviation [px of `lines`], the core's height [grey levels] and
        width [px of `lines`], and the skirt's share; NaN where nothing fits.
    """
    scan_lines = np.ascontiguousarray(scan_lines)  # loops are compiled anew for each layout
    half = max(6, math.ceil(5 * shape.width) + 3)
    look = np.array([shape.width, tightness.width, shape.skirt, tightness.skirt])
    along = SKIRT * shape.width
    across = along * lines.stretch / lines.line_step
    skirts = spread_skirts(lines.signal, scan_lines, positions, half, along, across)
    return fit_stripes(
        lines.levels, lines.signal, scan_lines, positions, skirts, noise.as_law(), look
    )


def find_centres(
    ridges: Ridges,
    posterior: Float[np.ndarray, "lines most"],
    *,
    noise: Noise,
    shapes: Sequence[StripeShape],
) -> Centres:
    """Fit the ridges that are more probably the stripe than not, each in its own width."""
    wanted = posterior > 0.5
    parts = [
        _fit_one_width(ridges, posterior, wanted & (ridges.shapes == number), noise, shape)
        for number, shape in enumerate(shapes)
    ]
    white = wanted & (ridges.shapes == PLATEAU)
    if white.any():
        parts.append(_measure_white(ridges, posterior, white, noise))
    if len(parts) == 1:
        return parts[0]
    joined = Centres.concatenate(parts)
    return joined[np.argsort(joined.scan_line, kind="stable")]


def _is_credible(
    ridges: Ridges,
    line: Indices,
    which: Indices,
    height: Scalars,
    noise: Noise,
    shape: StripeShape,
) -> Mask:
    """Tell which fits have a height that their ridge's score can stand for, and a sensor can hold.

    A filter of norm 1 answers a stripe of height A and width w by A √(√π w).
    """
    score = ridges.heights[line, which]
    least = np.sqrt(noise.variance(np.zeros(1)))[0]
    expected = score * least / math.sqrt(math.sqrt(math.pi) * shape.width)
    top = np.rint(ridges.positions[line, which]).astype(int)
    is_white = ridges.lines.levels[top, line] >= noise.white
    # What is cut off at white may be higher than that by any factor.
    return (height > _CREDIBLE * expected) & (is_white | (height < 1.5 * noise.white))


def _measure_white(
    ridges: Ridges, posterior: Float[np.ndarray, "lines most"], wanted: Marks, noise: Noise
) -> Centres:
    """Measure plateaus of white by both their edges."""
    lines = ridges.lines
    line, which = np.nonzero(wanted)
    middle, sigma, rise, _ = measure_at(lines, line, ridges.positions[line, which], noise).T
    whole = np.isfinite(middle)
    full, spread = lines.as_full_frame(middle), lines.stretch * sigma
    held, usual = posterior[line, which], learnt_of(lines, len(line), None)
    return Centres(lines, line, full, spread, rise, held, *usual)[whole]


def learnt_of(lines: ScanLines, count: int, shape: StripeShape | None) -> tuple[Scalars, ...]:
    """List what is learnt of centres: see the last columns of `Centres`, from `common` on.

    Nothing errs alike yet, and nothing has been put back.
    """
    rough, width = _ROUGH, 0.0
    if shape is not None:
        rough = lines.stretch * shape.rough
        width = lines.stretch * shape.width / math.hypot(1.0, lines.slope)
    return tuple(np.full(count, each) for each in (0.0, 0.0, min(rough, _ROUGH), 0.0, width))


def _fit_one_width(
    ridges: Ridges,
    posterior: Float[np.ndarray, "lines most"],
    wanted: Marks,
    noise: Noise,
    shape: StripeShape,
) -> Centres:
    line, which = np.nonzero(wanted)
    seen = ridges.lines.binned(shape.binning)
    start = seen.from_image(ridges.positions[line, which])
    averaged = noise.averaged(shape.binning)
    position, sigma, height, _, skirt = fit_ridges(seen, line, start, noise=averaged, shape=shape).T
    fits = np.isfinite(position) & _is_credible(ridges, line, which, height, averaged, shape)
    spread = seen.stretch * np.hypot(shape.misfit * sigma, shape.floor)
    full = seen.as_full_frame(position)
    signal = np.clip(height * (1 + skirt), 0.0, noise.white)
    held, learnt = posterior[line, which], learnt_of(seen, len(line), shape)
    centres = Centres(ridges.lines, line, full, spread, signal, held, *learnt)[fits]
    width = seen.stretch * shape.width
    return _without_blur(centres, width=width, blur=shape.blur)


def _without_blur(centres: Centres, *, width: float, blur: float) -> Centres:
    """Put centres back to where the light of their own scan line lies, and doubt what has none.

    Half of a line's light is left at its very end; where less is, the lens has carried it there.

    Args:
        centres: Of one frame, before they are joined.
        width: 1σ of the stripe [full-frame px].
        blur: See `Slants.pull`.
    """
    # A stripe's height is known as well, in proportion, as its place in units of its width.
    spread = centres.sigma / width
    slants = Slants.of(
        centres.lines,
        centres.scan_line,
        centres.position,
        light=centres.signal,
        spread=spread,
    )
    added, noise, unknown = undo_pull(slants.pull(), blur).T
    is_blur = slants.dark - spread > _DARK
    return replace(
        centres,
        position=centres.position - added,
        sigma=np.hypot(centres.sigma, noise),
        posterior=np.where(is_blur, _BLUR, 1.0) * centres.posterior,
        common=unknown,
        drawn=slants.draw(width),
        blur_shift=added,
    )


def join_frames(near: Mapping[int, Centres], *, noise: Noise) -> Centres:
    """Join a frame's centres with those around them, in scan lines and in frames.

    A parabola over scan lines and over frames is put through the neighbours of each centre. They
    count as far as surfaces are smooth: less with distance, and with their misfit.

    Args:
        near: Centres of the frame, 0, and of those around it.
        noise: Of a pixel.
    """
    own = near[0]
    if len(own) == 0:
        return own
    distances = sorted(near)
    groups = [near[distance] for distance in distances]
    starts = np.cumsum([0] + [len(group) for group in groups])
    first = starts[distances.index(0)]
    lines = [group.scan_line + own.lines.offset(group.lines)[1] for group in groups]
    at = np.concatenate(lines)
    straight = np.concatenate([group.position for group in groups]) - own.lines.even_wall(at)
    sigma = np.concatenate([group.sigma for group in groups])
    drawn = np.concatenate([group.drawn for group in groups])
    common = np.concatenate([group.common for group in groups])
    alike = Alike.of(at, straight, np.hypot(sigma, common), drawn, starts, noise=noise)
    joined = join_centres(
        at,
        np.repeat(np.array(distances, float), np.diff(starts)),
        straight,
        sigma,
        common,
        alike.drawn * drawn,
        np.concatenate([group.rough for group in groups]),
        starts,
        first,
        first + len(own),
        _REACH,
        alike.lines,
        alike.own,
        alike.same,
        alike.seen,
    )
    wall = own.lines.even_wall(own.scan_line.astype(float))
    return replace(own, position=wall + joined[:, 0], sigma=joined[:, 1])


def doubt_wide(centres: Centres) -> Centres:
    """Lower the posterior by the chance that the centre is not within what counts as right."""
    right = scipy.special.erf(_RIGHT / np.maximum(centres.sigma, 1e-6) / math.sqrt(2))
    return replace(centres, posterior=centres.posterior * right)
