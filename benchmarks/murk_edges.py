"""How sharply a finder sees an edge along the stripe: of depth, and of paint."""

import numpy as np
from murk_match import Matched, scan_line

SIDE = 6
"""Scan lines on each side of a jump that must be smooth, and show what is there."""
_JUMP = 4.0
"""Least height of a jump [px]."""
_GAP = 2
"""Scan lines between both sides that may show no surface at all."""
_SMOOTH = 2.0
"""Largest step between scan lines of a surface without a jump [px]."""
_SLACK = 1.5
"""What lies further than this beyond either side is false, and no answer to the jump [px]."""
OFFSETS = np.arange(-SIDE, SIDE + _GAP + 1)
"""Scan lines from the last one before the jump."""
_WINDOW = 10
"""Scan lines on each side whose mean is taken off, so that edges stand out of what is broad."""
_BLURS = np.arange(0.0, 6.01, 0.1)
"""Blurs along the stripe that are tried, 1σ [scan lines]."""
_TO_WIDTH = 2.563
"""10 to 90 % width of an edge that is blurred by a Gaussian, in its standard deviations."""
_STRONG = 0.08
"""Change of the logarithm of the stripe's height from line to line that counts as strong."""


def answer_to_jumps(matched: Matched) -> tuple[np.ndarray, np.ndarray]:
    """Add up how far found centres have gone over jumps between two surfaces, both visible.

    Each centre is put between what the surfaces on both sides, prolonged, would show in its scan
    line: 0 is on the one, 1 on the other.

    Returns:
        Sum and number of the answers, at each of `OFFSETS`.
    """
    total, count = np.zeros(len(OFFSETS)), np.zeros(len(OFFSETS))
    truth, found = matched.truth, matched.found
    place = scan_line(found.frame, found.pixels)
    order = np.argsort(place, kind="stable")
    place, rows = place[order], found.pixels[order, 1]
    for first, left, right in _jumps(matched):
        lines = scan_line(truth.frame[first : first + 1], truth.pixels[first : first + 1]) + OFFSETS
        start, end = np.polyval(left, OFFSETS), np.polyval(right, OFFSETS)
        for k, (low, high) in enumerate(
            zip(np.searchsorted(place, lines), np.searchsorted(place, lines, "right"), strict=True)
        ):
            gone = (rows[low:high] - start[k]) / (end[k] - start[k])
            gone = gone[np.abs(gone - 0.5) < 0.5 + _SLACK / abs(end[k] - start[k])]
            total[k] += gone.sum()
            count[k] += len(gone)
    return total, count


def _jumps(matched: Matched) -> list[tuple[int, np.ndarray, np.ndarray]]:
    """Give the last true centre before each jump, and a line through either side."""
    truth = matched.truth
    order = np.flatnonzero(~truth.is_reflected)
    order = order[np.argsort(scan_line(truth.frame, truth.pixels)[order], kind="stable")]
    line, row = scan_line(truth.frame, truth.pixels)[order], truth.pixels[order, 1]
    seen = matched.is_visible[order]
    step, rise = np.diff(line), np.diff(row)
    jumps = np.flatnonzero((step <= 1 + _GAP) & (step >= 1) & (np.abs(rise) >= _JUMP))
    smooth = (step == 1) & (np.abs(rise) < _SMOOTH) & seen[1:] & seen[:-1]
    kept = []
    for at in jumps[(jumps >= SIDE) & (jumps < len(row) - SIDE - 1)].tolist():
        before, after = slice(at - SIDE + 1, at + 1), slice(at + 1, at + SIDE + 1)
        if smooth[at - SIDE + 1 : at].all() and smooth[at + 1 : at + SIDE].all():
            sides = [np.polyfit(line[s] - line[at], row[s], 1) for s in (before, after)]
            kept.append((int(order[at]), sides[0], sides[1]))
    return kept


def rise_of(total: np.ndarray, count: np.ndarray) -> float:
    """Give the 10 to 90 % width of the mean answer [scan lines]; lines without any prolong it."""
    known = count > 0.1 * count.max(initial=0)
    if known.sum() < SIDE:
        return float("nan")
    at, mean = OFFSETS[known].astype(float), total[known] / count[known]
    mean = (mean - mean[:3].mean()) / (mean[-3:].mean() - mean[:3].mean())
    up, down = np.flatnonzero(mean > 0.1), np.flatnonzero(mean < 0.9)
    if len(up) == 0 or len(down) == 0 or up[0] == 0 or down[-1] == len(at) - 1:
        return float("nan")
    first = np.interp(0.1, mean[up[0] - 1 : up[0] + 1], at[up[0] - 1 : up[0] + 1])
    last = np.interp(0.9, mean[down[-1] : down[-1] + 2], at[down[-1] : down[-1] + 2])
    return float(last - first)


def blur_of_paint(matched: Matched) -> np.ndarray:
    """Correlate the found height of the stripe with the true one, blurred ever more along it.

    Returns:
        One sum of products for each of `_BLURS`, with those of both squares: 3 rows.
    """
    heights, true = _heights(matched)
    known = np.isfinite(heights) & np.isfinite(true)
    sums = np.zeros((3, len(_BLURS)))
    if known.sum() < 1000:
        return sums
    found = _stand_out(np.where(known, heights, 0.0), known)
    reach = np.arange(-15, 16)
    for k, blur in enumerate(_BLURS):
        kernel = np.exp(-0.5 * (reach / max(blur, 1e-3)) ** 2)
        blurred = _spread(np.where(known, true, 0.0), kernel) / np.maximum(
            _spread(known.astype(float), kernel), 1e-9
        )
        wanted = _stand_out(np.where(known, blurred, 0.0), known)
        sums[:, k] = (found * wanted).sum(), (found**2).sum(), (wanted**2).sum()
    return sums


def width_of_paint(sums: np.ndarray) -> float:
    """Give the 10 to 90 % width of an edge of paint, beyond that of the picture [scan lines]."""
    with np.errstate(invalid="ignore", divide="ignore"):
        alike = sums[0] / np.sqrt(sums[1] * sums[2])
    return float("nan") if np.isnan(alike).all() else _TO_WIDTH * _BLURS[np.nanargmax(alike)]


def _heights(matched: Matched) -> tuple[np.ndarray, np.ndarray]:
    """Give height found and true height by frame and scan line, where both are, and clearly."""
    truth, which = matched.truth, np.flatnonzero(matched.is_hit & (matched.truth.crlb <= 0.3))
    frames, columns = (
        int(truth.frame.max(initial=0)) + 1,
        int(truth.pixels[:, 0].max(initial=0)) + 1,
    )
    found, true = np.full((2, frames, columns), np.nan)
    at = truth.frame[which], np.rint(truth.pixels[which, 0]).astype(int)
    found[at], true[at] = matched.found.signal[matched.found_of_truth[which]], truth.signal[which]
    return found, true


def _stand_out(values: np.ndarray, known: np.ndarray) -> np.ndarray:
    box = np.ones(2 * _WINDOW + 1)
    mean = _spread(np.where(known, values, 0.0), box) / np.maximum(
        _spread(known.astype(float), box), 1e-9
    )
    return np.where(known, values - mean, 0.0)


def _spread(rows: np.ndarray, kernel: np.ndarray) -> np.ndarray:
    return np.apply_along_axis(np.convolve, 1, rows, kernel, "same")


def pull_of_paint(matched: Matched) -> dict[str, float]:
    """Give the median error towards brighter paint [px], where paint changes strongly.

    Along the stripe, a picture's blur mixes in neighbours that lie higher or lower where the stripe
    is aslant; across it, the brighter side of the sheet weighs more (Curless and Levoy 1995).
    """
    truth = matched.truth
    frames, columns = (
        int(truth.frame.max(initial=0)) + 1,
        int(truth.pixels[:, 0].max(initial=0)) + 1,
    )
    row, light, error = np.full((3, frames, columns), np.nan)
    which = np.flatnonzero(~truth.is_reflected & (truth.branch == 0))
    at = truth.frame[which], np.rint(truth.pixels[which, 0]).astype(int)
    row[at], light[at] = truth.pixels[which, 1], np.log(np.maximum(truth.signal[which], 1e-9))
    error[at] = np.where(truth.crlb[which] <= 0.3, matched.error[which], np.nan)
    slope, along = np.gradient(row, axis=1), np.gradient(light, axis=1)
    smooth = np.abs(slope) < _SMOOTH
    return {
        "along": _median(error * np.sign(slope * along), (np.abs(along) > _STRONG) & smooth),
        "across": _median(*_towards(error, np.gradient(light, axis=0), smooth)),
    }


def _towards(
    error: np.ndarray, change: np.ndarray, smooth: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    return error * np.sign(change), (np.abs(change) > _STRONG) & smooth


def _median(values: np.ndarray, where: np.ndarray) -> float:
    kept = values[where & np.isfinite(values)]
    return float(np.median(kept)) if len(kept) >= 200 else float("nan")
