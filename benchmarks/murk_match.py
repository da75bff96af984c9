"""Which found centre is which true one."""

from dataclasses import dataclass, fields

import numpy as np

from murkscan.types.stripe import Stripe
from murkscan.types.true_stripe import TrueStripe

REACH = 1.5
"""Distance from a true centre up to which a found one is right [px of the full frame]."""
VISIBLE = 0.5
"""Bound of a scan line up to which a true centre counts as visible [px]."""
_WHITE = 251
"""Height above black at which a stripe is white [grey levels]."""
_WIDEST = 1 << 16
"""More scan lines than any picture has."""


@dataclass(frozen=True, eq=False)
class Matched:
    """Found and true centres of one recording, those that belong together paired one to one."""

    found: Stripe
    truth: TrueStripe
    albedo: np.ndarray
    """Of each true centre; NaN where it is even all around."""
    truth_of_found: np.ndarray
    """Number of the true centre that each found one is; -1: it is none."""
    found_of_truth: np.ndarray
    """Number of the found centre that each true one is found as; -1: it is missed."""
    visible: float = VISIBLE
    """Bound of a scan line up to which a true centre counts as visible [px]."""

    @property
    def is_right(self) -> np.ndarray:
        """Which found centres are true ones."""
        return self.truth_of_found >= 0

    @property
    def is_hit(self) -> np.ndarray:
        """Which true centres are found."""
        return self.found_of_truth >= 0

    @property
    def is_visible(self) -> np.ndarray:
        """Which true centres a finder can be asked for: of the line itself, with enough light.

        A white plateau tells little of its bound's kind, and has two edges that anybody sees.
        """
        known = (self.truth.crlb <= self.visible) | (self.truth.signal >= _WHITE)
        return ~self.truth.is_reflected & known

    @property
    def is_of_its_laser(self) -> np.ndarray:
        """Which of the right found centres are told as the laser's whose they are."""
        right = np.flatnonzero(self.is_right)
        return self.found.laser[right] == self.truth.laser[self.truth_of_found[right]]

    @property
    def error(self) -> np.ndarray:
        """Signed error of each true centre along its scan line [px]; NaN where it is missed."""
        error = np.full(len(self.truth), np.nan)
        hit = np.flatnonzero(self.is_hit)
        rows = self.found.pixels[self.found_of_truth[hit], 1]
        error[hit] = rows - self.truth.pixels[hit, 1]
        return error


def scan_line(frame: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    """Give one number for frame and scan line; scan lines are image columns."""
    return frame.astype(np.int64) * _WIDEST + np.rint(pixels[:, 0]).astype(np.int64)


def pick_frames(truth: TrueStripe, frames: list[int]) -> TrueStripe:
    """Give the true centres of some frames."""
    kept = np.isin(truth.frame, frames)
    return TrueStripe(*(getattr(truth, column.name)[kept] for column in fields(truth)))


def match_stripes(
    found: Stripe,
    truth: TrueStripe,
    albedo: np.ndarray,
    *,
    visible: float = VISIBLE,
    reach: float = REACH,
) -> Matched:
    """Pair each found centre with the true one nearest to it, one to one, nearest pairs first.

    Only centres of the line itself can be paired: where gloss throws a second line, a point there
    would be triangulated to where no surface is.
    """
    a, b, away = _pairs(found, truth, reach)
    of_found, of_truth = np.full(len(found), -1), np.full(len(truth), -1)
    for i in np.argsort(away, kind="stable"):
        if of_found[a[i]] < 0 and of_truth[b[i]] < 0:
            of_found[a[i]], of_truth[b[i]] = b[i], a[i]
    return Matched(found, truth, albedo, of_found, of_truth, visible)


def _pairs(
    found: Stripe, truth: TrueStripe, reach: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Give all pairs within reach in one scan line: found, true, and their distance [px]."""
    direct = np.flatnonzero(~truth.is_reflected)
    place = scan_line(truth.frame, truth.pixels)[direct]
    order = np.argsort(place, kind="stable")
    direct, place = direct[order], place[order]
    wanted = scan_line(found.frame, found.pixels)
    low, high = np.searchsorted(place, wanted), np.searchsorted(place, wanted, "right")
    a = np.repeat(np.arange(len(found)), high - low)
    b = direct[np.arange(len(a)) - np.repeat(np.cumsum(high - low) - high, high - low)]
    away = np.abs(found.pixels[a, 1] - truth.pixels[b, 1])
    near = away <= reach
    return a[near], b[near], away[near]


def nearest_in_line(
    line: np.ndarray, rows: np.ndarray, truth: TrueStripe, which: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Find the true centre nearest to each place in the same scan line.

    Args:
        line: Scan lines of the places, as `scan_line` numbers them.
        rows: Where they lie in them [px].
        truth: The true centres.
        which: Numbers of those that are looked among.

    Returns:
        Distance [px], infinite where a scan line has none, and number of the true centre.
    """
    away, nearest = np.full(len(line), np.inf), np.zeros(len(line), int)
    place = scan_line(truth.frame, truth.pixels)[which]
    order = np.argsort(place, kind="stable")
    which, place = which[order], place[order]
    low, high = np.searchsorted(place, line), np.searchsorted(place, line, "right")
    for k in range(int((high - low).max(initial=0))):
        at = which[np.minimum(low + k, len(which) - 1)]
        off = np.where(low + k < high, np.abs(rows - truth.pixels[at, 1]), np.inf)
        nearest, away = np.where(off < away, at, nearest), np.minimum(off, away)
    return away, nearest
