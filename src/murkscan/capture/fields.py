"""Interlaced pictures: two fields, exposed half a picture's period apart, woven row by row."""

from collections.abc import Iterable, Sequence
from typing import Literal

import cv2
import numpy as np
from jaxtyping import Float, Float32

from ..types.arrays import Image
from ..types.frame import Frame

FieldOrder = Literal["progressive", "top-first", "bottom-first"]
"""What a picture is made of; the top field has the even rows 0, 2, 4 …"""
FieldVerdict = Literal["progressive", "top-first", "bottom-first", "interlaced", "undecided"]
"""What pictures tell of their fields: interlaced where only their order is unknown, undecided where
nothing moves."""

_SCALES = (4, 8, 16)
"""Sizes of the cells over which a field is averaged, in pixels of the full picture."""
_ROWS = 32
"""Height below which a picture is too small to tell [px]."""
_SIGNIFICANT = 5.0
"""Standard deviations by which motion, and one order over the other, must stand out of noise."""
_LEAN = 0.2
"""Ratio from which a recording is interlaced, of 1. Not half, since an encoder that takes fields
for noise smears them into each other; progressive video of all kinds was seen to stay below 0.1.
"""

_UNUSUAL = 0.999
"""Quantile of a picture's differences above which they count no more than it."""
_APART = 0.1
"""Ratio of a to the smaller of b and c from which fields may be apart; 1 but for an encoder."""
_DETAIL = 2.0
"""Ratio of a to d, the difference of a field from the same one of the next picture, in cells that
move, from which it is what rows miss of a stripe, and no motion: that of half a period is less than
that of a whole one. Interlaced films reach 1, where noise is all there is; progressive ones of a
stripe that creeps by a part of a row were seen at 10."""
_AGREEMENT = 0.8
"""Share of the runs that move, from which they say the same."""
_FAINT = 0.2
"""Difference of b and c, as a share of both, up to which rows that miss a part of a narrow stripe
may make it, in progressive pictures, too: to either side, as the stripe wanders."""
_FEWEST = 4
"""Runs over which such a stripe wanders, so that a faint lean to one side in all of them is none of
its doing."""

_JUMPS = 4.0
"""Pairs of pictures that must share the motion, so that it is none of a few jumps."""

_SPOTTY = 10.0
"""Fourth powers of differences over the square of their squares, from which they are spots."""
_FRESH = 0.5
"""Share of what changes to the next picture that changes between fields, where spots are snow."""

Field = Float32[np.ndarray, "_ _"]
Sums = Float[np.ndarray, "pairs 4"]


def split_fields(
    image: Image, *, picture: int, time: float, period: float, order: FieldOrder
) -> list[Frame]:
    """Make the frames of one picture: one, or its two fields in the order of their exposure.

    Args:
        image: The picture as it was recorded.
        picture: Its number in the recording.
        time: When it, or its first field, was exposed [s].
        period: Time from one picture to the next [s]; the second field comes half of it later,
            and before the next picture if this is no longer than the time to that.
        order: What the picture is made of.
    """
    if order == "progressive":
        return [Frame(image, picture, time)]
    first = 0 if order == "top-first" else 1
    return [
        Frame(
            np.ascontiguousarray(image[row::2]),
            index=2 * picture + number,
            time=time + number * period / 2,
            first_row=row,
            row_step=2,
        )
        for number, row in enumerate((first, 1 - first))
    ]


def find_field_order(runs: Iterable[Sequence[Image]]) -> FieldVerdict:
    """Tell from the picture whether it is interlaced, and which field came first.

    What moves differs the more, the longer the time between two looks at it. Of two pictures in
    a row, with fields top T and bottom B, three differences tell all::

        time ──▶     T0    B0    T1    B1       a = |T0 - B0|⁴   b = |B0 - T1|⁴   c = |T0 - B1|⁴
        top first    ●──a──●──b──●─────●        a = b < c
                     └────────c────────┘
        bottom first: mirrored                  a = c < b
        progressive: T and B at one time        a < b = c

    so that (c - b) / (b + c - 2a) is 1, -1 and 0, whatever moves, however far, and which way the
    stripe runs; noise, and what a picture's own rows differ by, cancel out of it. Fourth powers
    let the moving stripe count for more than an encoder's faint noise everywhere. The sums run
    over all pairs at three coarse scales, of which the one where motion stands out most counts:
    a large one sees fast motion, and weak stripes in noise.

    Args:
        runs: Pictures that follow one another, all of one size; several runs from different
            places of a recording.
    """
    motion, lean = [np.zeros((2, len(_SCALES)))], [np.zeros((2, len(_SCALES)))]
    sums, moving = np.zeros((3, len(_SCALES))), np.zeros((2, len(_SCALES)))
    pairs = [np.zeros(len(_SCALES))]
    snow = [np.zeros((0, 4))]
    for run in runs:
        motion.append(np.zeros_like(motion[0]))
        lean.append(np.zeros_like(lean[0]))
        fields = (_shrink_fields(image) for image in run if min(image.shape) >= _ROWS)
        previous = next(fields, None)
        for current in fields:
            pairs.append(np.zeros(len(_SCALES)))
            for scale, (old, new) in enumerate(zip(previous or (), current, strict=True)):
                others = ((old[1], new[0]), (old[0], new[1]), (old[0], new[0]), (old[1], new[1]))
                a, b, c, d, e = _differences((old, *others))
                moving[:, scale] += _sums_that_move(a, (d + e) / 2)
                motion[-1][:, scale] += _sums(b + c - 2 * a)
                pairs[-1][scale] = float((b + c - 2 * a).sum())
                lean[-1][:, scale] += _sums(c - b)
                sums[:, scale] += float(a.sum()), float(b.sum()), float(c.sum())
            if previous:
                snow.append(_look_for_snow(previous[0], current[0]))
            previous = current
    verdict = _judge(np.array(motion), np.array(lean), sums, moving, np.array(pairs))
    return "interlaced" if verdict == "undecided" and _is_snow(np.concatenate(snow)) else verdict


def _look_for_snow(old: tuple[Field, Field], new: tuple[Field, Field]) -> Sums:
    """Give means of fourth powers of T0 - B0, B0 - T1 and T0 - T1, and of squares of T0 - B0."""
    a, b, d = _differences((old, (old[1], new[0]), (old[0], new[0])))
    return np.array([[a.mean(), b.mean(), d.mean(), np.sqrt(a).mean()]])


def _is_snow(means: Sums) -> bool:
    """Tell whether each field has spots of its own, as particles have that two exposures see.

    In a progressive picture both fields share them, and what stands still is in the next picture,
    too. Mere noise has no spots: the fourth powers of its differences are 3 times their squares'.
    """
    if len(means) == 0:
        return False
    here, next_field, next_picture, _ = means.sum(axis=0)
    spots = np.median(means[:, 0] / (means[:, 3] ** 2 + 1e-9))
    is_apart, is_gone = (
        here >= _FRESH * max(next_field, next_picture),
        next_picture >= _FRESH * here,
    )
    return bool(spots > _SPOTTY and is_apart and is_gone)


def _shrink_fields(image: Image) -> list[tuple[Field, Field]]:
    """Give both fields, brought to common rows by interpolation, at each scale."""
    rows, columns = image.shape[0] // 2, image.shape[1]
    top, bottom = (image[p : 2 * rows : 2].astype(np.float32) for p in (0, 1))
    # A quarter of a field's row down, and up: both at row 2r + 1/2 of the picture, blurred alike.
    pair = [_shift(top, _QUARTER)[1:], _shift(bottom, _QUARTER[::-1])[:-1]]
    shrunk = []
    for scale in _SCALES:
        size = (max(columns // scale, 1), max(2 * rows // scale, 1))
        pair = [cv2.resize(field, size, interpolation=cv2.INTER_AREA) for field in pair]
        shrunk.append((pair[0], pair[1]))
    return shrunk


def _shift(field: Field, weights: Float32[np.ndarray, " taps"]) -> Field:
    """Interpolate between rows: sums of as many neighbours as there are weights."""
    count = len(field) - len(weights) + 1
    return cv2.filter2D(field, -1, weights[:, None], anchor=(0, 0))[:count]


def _interpolation_weights(count: int, at: float) -> Float32[np.ndarray, " taps"]:
    """Lagrange's weights of `count` rows around rows 0 and 1, for the place `at` between them."""
    rows = np.arange(count) - (count // 2 - 1)
    return np.array(
        [np.prod([(at - other) / (row - other) for other in rows if other != row]) for row in rows],
        np.float32,
    )


_QUARTER = _interpolation_weights(8, 0.25)
"""Eight rows: with two, what a thin stripe leaves between the rows outweighs its slow motion."""


def _differences(pairs: Sequence[tuple[Field, Field]]) -> list[Field]:
    """Give the fourth powers of the differences, those of the few largest cells made equal.

    A particle that the sheet lights up in one field only tells nothing of their order, but would
    outweigh the stripe.
    """
    sizes = [np.abs(a - b) for a, b in pairs]
    cap = np.quantile(np.maximum.reduce(sizes), _UNUSUAL)
    return [np.square(np.square(np.minimum(size, cap))) for size in sizes]


def _sums_that_move(fields: Field, pictures: Field) -> tuple[float, float]:
    """Sum the differences of fields, and of pictures, over the cells in which pictures differ most.

    Elsewhere text, or the edges of what stands still, make a field differ from the other one.
    """
    moves = pictures >= pictures.mean()
    return float(fields[moves].sum()), float(pictures[moves].sum())


def _sums(values: Field) -> tuple[float, float]:
    """Sum, and sum of squares: its square root is the spread of the sum under mere noise."""
    exact = values.astype(np.float64)
    return float(exact.sum()), float(np.square(exact).sum())


def _judge(
    motions: np.ndarray,
    leans: np.ndarray,
    sums: np.ndarray,
    moving: np.ndarray,
    pairs: np.ndarray,
) -> FieldVerdict:
    """Decide at the scale where motion stands out most.

    Args:
        motions: b + c - 2a of each run: its sum and its sum of squares, at each scale.
        leans: c - b, likewise.
        sums: a, b and c of all runs together, at each scale.
        moving: a and d of all runs together, in cells that move, at each scale.
        pairs: The sum of b + c - 2a of each pair of pictures, at each scale.
    """
    motion, lean = motions.sum(axis=0), leans.sum(axis=0)
    clear = motion[0] / np.sqrt(motion[1] + 1e-9)
    best = int(clear.argmax())
    if clear[best] < _SIGNIFICANT:
        return "undecided"
    ratio = lean[0, best] / motion[0, best]
    certain = abs(lean[0, best]) / np.sqrt(lean[1, best] + 1e-9)
    agreed = _agree(motions[:, :, best], leans[:, :, best], ratio)
    # Fields that were taken apart in time differ from each other no less than from the next one.
    apart = sums[0, best] >= _APART * min(sums[1, best], sums[2, best])
    if abs(ratio) < _LEAN or not agreed or not apart:
        return "progressive"
    num_runs = len(motions) - 1  # the first stands for none
    faint = abs(sums[2, best] - sums[1, best]) < _FAINT * (sums[1, best] + sums[2, best])
    if moving[0, best] > _DETAIL * moving[1, best] or _are_jumps(pairs[:, best]):
        return "undecided"
    if certain < _SIGNIFICANT or (faint and num_runs < _FEWEST):
        return "undecided"
    return "top-first" if ratio > 0 else "bottom-first"


def _are_jumps(motion: np.ndarray) -> bool:
    """Tell whether hardly a pair of pictures has all of the motion.

    A stripe that jumps at a step of the object does so before or after either field; which, the
    next jump would tell otherwise.
    """
    moves = np.abs(motion[motion != 0])
    alike = float(moves.sum() ** 2 / max((moves**2).sum(), 1e-300))
    return alike < min(_JUMPS, len(moves) / 2)


def _agree(motions: np.ndarray, leans: np.ndarray, ratio: float) -> bool:
    """Tell whether nearly all runs that move lean to the side of their sum.

    Fields lean to one side always. Where a narrow stripe creeps, so that what its rows miss of it
    outweighs its motion, a progressive recording leans too, but to either side.
    """
    moving = motions[:, 0] > _SIGNIFICANT * np.sqrt(motions[:, 1] + 1e-9)
    same_side = leans[moving, 0] * ratio > _LEAN * abs(ratio) * motions[moving, 0]
    return bool(same_side.sum() >= _AGREEMENT * moving.sum())
