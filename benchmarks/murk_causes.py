"""Where points are lost and false ones come from, told from the truth."""

import numpy as np
from murk_match import REACH, Matched, nearest_in_line, scan_line

from murkscan.types.true_stripe import TrueStripe

_NEAR = 3
"""Scan lines from a jump, or from an end of the stripe, that count as near."""
_STEP = 2.0
"""Step from one scan line to the next that is a jump [px]."""
_PAINT = 0.12
"""Change of the albedo's logarithm from line to line that is an edge of paint."""
_DISPLACED = 4.0
"""Distance from a true centre up to which a false one is that one, displaced [px]."""
MISSED = ("jump", "paint", "bound 0.3–0.5", "bound 0.1–0.3", "bound ≤ 0.1")
_BESIDE = 2
"""Scan lines beyond its end into which the picture's blur carries a stripe."""
FALSE = (
    "displaced at a jump",
    "displaced",
    "over an end",
    "second line",
    "before the surface",
    "elsewhere",
)


def count_causes(matched: Matched) -> dict[str, dict[str, int]]:
    """Count the missed visible points and the false ones, each under the first cause that fits."""
    jump, paint = edges_of(matched)
    crlb, missed = matched.truth.crlb, matched.is_visible & ~matched.is_hit
    causes = (jump, paint, crlb > 0.3, crlb > 0.1, np.ones(len(crlb), bool))
    found, truth = matched.found, matched.truth
    line, rows = scan_line(found.frame, found.pixels), found.pixels[:, 1]
    away, nearest = nearest_in_line(line, rows, truth, np.flatnonzero(~truth.is_reflected))
    second, _ = nearest_in_line(line, rows, truth, np.flatnonzero(truth.is_reflected))
    displaced = away <= _DISPLACED
    at_jump = displaced & jump[nearest] if len(jump) else displaced
    # The laser sits above: what the sheet lights before the surface is above it in the picture.
    before = np.isfinite(away) & (rows < truth.pixels[nearest, 1]) if len(jump) else displaced
    over = _goes_on(line, rows, truth) <= REACH
    excuses = (at_jump, displaced, over, second <= REACH, before, np.ones(len(away), bool))
    return {
        "missed": _first_that_fits(missed, MISSED, causes),
        "false": _first_that_fits(~matched.is_right, FALSE, excuses),
    }


def _goes_on(line: np.ndarray, rows: np.ndarray, truth: TrueStripe) -> np.ndarray:
    """Give the distance from the line itself in the scan lines beside [px]."""
    direct = np.flatnonzero(~truth.is_reflected)
    beside = [shift for shift in range(-_BESIDE, _BESIDE + 1) if shift != 0]
    return np.min([nearest_in_line(line + s, rows, truth, direct)[0] for s in beside], axis=0)


def _first_that_fits(
    which: np.ndarray, names: tuple[str, ...], causes: tuple[np.ndarray, ...]
) -> dict[str, int]:
    counts, left = {}, which.copy()
    for name, cause in zip(names, causes, strict=True):
        counts[name] = int((left & cause).sum())
        left &= ~cause
    return counts


def edges_of(matched: Matched) -> tuple[np.ndarray, np.ndarray]:
    """Tell which true centres are near a jump or an end of the stripe, and at an edge of paint."""
    truth = matched.truth
    rows, columns = truth.pixels[:, 1], np.rint(truth.pixels[:, 0]).astype(int)
    light = np.log(matched.albedo)
    everywhere = np.arange(len(truth))
    jump, paint = np.zeros((2, len(truth)), bool)
    for shift in (-1, 1):
        line = scan_line(truth.frame, truth.pixels) + shift
        away, next_one = nearest_in_line(line, rows, truth, everywhere)
        follows = np.where(away < _STEP, next_one, -1)
        at_border = columns == (0 if shift < 0 else columns.max(initial=0))
        jump |= _reached(follows, at_border)
        paint |= (follows >= 0) & (np.abs(light[follows] - light) > _PAINT)
    return jump, paint


def _reached(follows: np.ndarray, at_border: np.ndarray) -> np.ndarray:
    """Tell from which centres an end is reached in a few steps; the picture's border is none."""
    ends = (follows < 0) & ~at_border
    near = ends.copy()
    at = np.arange(len(follows))
    for _ in range(_NEAR - 1):
        at = np.where((at >= 0) & (follows[at] >= 0), follows[at], -1)
        near |= (at >= 0) & ends[at]
    return near
