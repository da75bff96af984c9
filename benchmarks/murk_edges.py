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
AROUND = np.arange(-9, 11)
"""Scan lines from the last one before a step of paint."""
_PLATEAU = 4
"""How many of them, at both ends, show what is on either side."""
_STEP = 0.7
"""Change of the albedo's logarithm from one scan line to the next that is a step."""
_EVEN = 0.02
"""The same up to which paint is even."""
_STRONG = 0.08
"""Change of the albedo's logarithm from line to line, or frame to frame, that is strong."""


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


def rise_of(total: np.ndarray, count: np.ndarray, offsets: np.ndarray = OFFSETS) -> float:
    """Give the 10 to 90 % width of the mean answer [scan lines]; lines without any prolong it."""
    known = count > 0.1 * count.max(initial=0)
    if known.sum() < SIDE:
        return float("nan")
    at, mean = offsets[known].astype(float), total[known] / count[known]
    mean = (mean - mean[:3].mean()) / (mean[-3:].mean() - mean[:3].mean())
    up, down = np.flatnonzero(mean > 0.1), np.flatnonzero(mean < 0.9)
    if len(up) == 0 or len(down) == 0 or up[0] == 0 or down[-1] == len(at) - 1:
        return float("nan")
    first = np.interp(0.1, mean[up[0] - 1 : up[0] + 1], at[up[0] - 1 : up[0] + 1])
    last = np.interp(0.9, mean[down[-1] : down[-1] + 2], at[down[-1] : down[-1] + 2])
    return float(last - first)


def answer_to_paint(matched: Matched) -> np.ndarray:
    """Add up how the height of the stripe goes over steps of paint on a smooth surface.

    Each height is put between its means on both sides: 0 is on the one, 1 on the other.

    Returns:
        At each of `AROUND` the sum and the number of the answers of the finder, and those of the
        picture itself: 4 rows.
    """
    first = ~matched.truth.is_reflected & (matched.truth.branch == 0)
    hit = first & matched.is_hit
    heights = matched.found.signal[matched.found_of_truth] if len(matched.found) else hit
    found = _as_grid(matched, heights.astype(float), hit)
    true = _as_grid(matched, matched.truth.signal, first & matched.is_visible)
    row, light = (
        _as_grid(matched, one, first)
        for one in (matched.truth.pixels[:, 1], np.log(matched.albedo))
    )
    answers = np.zeros((4, len(AROUND)))
    for frame, line in np.argwhere(np.abs(np.diff(light, axis=1)) > _STEP).tolist():
        at = line + AROUND
        if at[0] < 0 or at[-1] >= row.shape[1]:
            continue
        changes = np.abs(np.diff(light[frame, at]))
        if np.nansum(changes > _EVEN) == 1 and (np.abs(np.diff(row[frame, at])) < _SMOOTH).all():
            answers[:2] += _gone(found[frame, at])
            answers[2:] += _gone(true[frame, at])
    return answers


def _gone(heights: np.ndarray) -> np.ndarray:
    """Give the answer to one step, where the heights on both sides are known, and whether it is."""
    sides = heights[:_PLATEAU], heights[-_PLATEAU:]
    if not np.isfinite(sides).all():
        return np.zeros((2, len(heights)))
    start, end = np.mean(sides, axis=1)
    gone = (heights - start) / (end - start)
    return np.stack([np.nan_to_num(gone), np.isfinite(gone)])


def width_of_paint(answers: np.ndarray) -> tuple[float, float]:
    """Give the 10 to 90 % width of a step of paint in what is found, and in the picture."""
    found, picture = (rise_of(*answers[k : k + 2], AROUND) for k in (0, 2))
    return found, picture


def _as_grid(matched: Matched, values: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Give values of some true centres by frame and scan line; NaN where there is none."""
    truth = matched.truth
    columns = np.rint(truth.pixels[:, 0]).astype(int)
    size = int(truth.frame.max(initial=0)) + 1, int(columns.max(initial=1)) + 1
    grid = np.full(size, np.nan)
    grid[truth.frame[which], columns[which]] = values[which]
    return grid


def pull_of_paint(matched: Matched) -> dict[str, float]:
    """Give the median error towards brighter paint [px], where paint changes strongly.

    Along the stripe, a picture's blur mixes in neighbours that lie higher or lower where the stripe
    is aslant; across it, the brighter side of the sheet weighs more (Curless and Levoy 1995).
    """
    truth = matched.truth
    first = ~truth.is_reflected & (truth.branch == 0)
    row, light, error = (
        _as_grid(matched, one, first)
        for one in (truth.pixels[:, 1], np.log(matched.albedo), matched.error)
    )
    sure = _as_grid(matched, truth.crlb, first) <= 0.3
    slope, along = np.gradient(row, axis=1), np.gradient(light, axis=1)
    across = np.gradient(light, axis=0) if len(light) > 1 else np.full(light.shape, np.nan)
    sure &= np.abs(slope) < _SMOOTH
    return {
        "along": _median(error * np.sign(slope * along), sure & (np.abs(along) > _STRONG)),
        "across": _median(error * np.sign(across), sure & (np.abs(across) > _STRONG)),
    }


def _median(values: np.ndarray, where: np.ndarray) -> float:
    kept = values[where & np.isfinite(values)]
    return float(np.median(kept)) if len(kept) >= 200 else float("nan")
