"""From found and true centres to the figures of one finder in one recording, and of several."""

import math
from typing import Any

import numpy as np
from murk_causes import count_causes
from murk_edges import answer_to_jumps, answer_to_paint, pull_of_paint, rise_of, width_of_paint
from murk_match import VISIBLE, Matched, scan_line

BOUNDS = (0.1, 0.3, VISIBLE)
"""Bounds of a scan line by which recall is told [px]."""
DEEP = (2.0, 4.6, 10.0)
"""Further bounds, where it is asked for what no single scan line shows [px]."""
DEEP_BINS = ("0.5–2", "2–4.6", "4.6–10")
_SURE = 0.3
"""Bound up to which errors are held against it [px]."""
_MEDIAN = 0.6745
"""Median of a Gaussian's absolute errors, in its standard deviations."""
_POSTERIORS = np.array(
    [0, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.999, 1.001]
)
_FULL = 2000
"""Detections that a bin of posteriors holds at least."""


_HOLE = 60
"""Scan lines without a surface that count as a hole, at most, between others that have one."""


def judge(matched: Matched, lines: int) -> dict[str, Any]:
    """Give what is known of one finder in one recording: counts to be added up, and medians.

    Args:
        matched: Found and true centres.
        lines: Scan lines of all frames.
    """
    seen, hit, error = matched.is_visible, matched.is_hit, matched.error
    crlb = matched.truth.crlb
    edges = (*BOUNDS, *DEEP, math.inf)
    within = [(low < crlb) & (crlb <= high) for low, high in zip((-1, *edges), edges, strict=False)]
    sure = seen & hit & (crlb <= _SURE)
    known = np.flatnonzero(seen & hit)
    sigma = matched.found.sigma[matched.found_of_truth[known]]
    jumps, paint = answer_to_jumps(matched), answer_to_paint(matched)
    return {
        "visible": [int((seen & one).sum()) for one in within],
        "hit": [int((seen & hit & one).sum()) for one in within],
        "lines": lines,
        "lasers": [int(matched.is_of_its_laser.sum()), int(matched.is_right.sum())],
        "holes": _count_in_holes(matched),
        "found": len(matched.found),
        "right": int(matched.is_right.sum()),
        "ratio": _median(np.abs(error[sure]) / crlb[sure]) / _MEDIAN,
        "bias": _median(error[sure]),
        "mean": float(error[sure].mean()) if sure.any() else math.nan,
        "absolute": _median(np.abs(error[known])),
        "within": [int((np.abs(error[known]) <= sigma).sum()), len(known)],
        "posterior": _by_posterior(matched),
        "jump": [one.tolist() for one in jumps],
        "paint": paint.tolist(),
        "pull": pull_of_paint(matched),
        "causes": count_causes(matched),
    }


def _count_in_holes(matched: Matched) -> list[int]:
    """Count the scan lines of holes in which a point is given, and all of them."""
    direct = ~matched.truth.is_reflected
    shown = np.unique(scan_line(matched.truth.frame[direct], matched.truth.pixels[direct]))
    step = np.diff(shown)
    ends = np.flatnonzero((step > 1) & (step <= _HOLE))
    holes = np.concatenate([[0], *(np.arange(shown[i] + 1, shown[i + 1]) for i in ends)])[1:]
    given = np.isin(holes, scan_line(matched.found.frame, matched.found.pixels))
    return [int(given.sum()), len(holes)]


def _by_posterior(matched: Matched) -> list[list[float]]:
    """Give number, sum of posteriors and number of right ones of each bin."""
    posterior = matched.found.posterior.astype(float)
    bins = np.digitize(posterior, _POSTERIORS) - 1
    count = len(_POSTERIORS)
    return [
        np.bincount(bins, weight, count).tolist()
        for weight in (np.ones(len(posterior)), posterior, matched.is_right.astype(float))
    ]


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if len(values) >= 50 else math.nan


def pool(parts: list[dict[str, Any]]) -> dict[str, float]:
    """Give one finder's figures in one case: counts of all seeds together, means of medians."""
    visible, hit = _sum(parts, "visible"), _sum(parts, "hit")
    inside, known = _sum(parts, "within")
    figures = {"recall": _share(hit.sum(), visible.sum())}
    for k, name in enumerate(("≤ 0.1", "0.1–0.3", "0.3–0.5", *DEEP_BINS)):
        figures[f"recall {name}"] = _share(hit[k], visible[k])
    right, found = _sum(parts, "right"), _sum(parts, "found")
    figures["precision"] = _share(right, found)
    figures["false"] = 1e4 * float((found - right) / _sum(parts, "lines"))
    figures["lasers"] = _share(*_sum(parts, "lasers"))
    figures["in holes"] = _share(*_sum(parts, "holes"))
    for name in ("ratio", "bias", "mean", "absolute"):
        figures[name] = _mean([part[name] for part in parts])
    figures["within sigma"] = _share(inside, known)
    figures["calibration"] = _worst_bin(_sum(parts, "posterior"))
    figures["jump"] = rise_of(*_sum(parts, "jump"))
    figures["paint"], figures["paint itself"] = width_of_paint(_sum(parts, "paint"))
    for way in ("along", "across"):
        figures[f"pull {way}"] = _mean([part["pull"][way] for part in parts])
    return figures


def _worst_bin(bins: np.ndarray) -> float:
    """Give the largest difference of posterior and observed share, in points; of full bins."""
    worst, kept = math.nan, np.zeros(3)
    for one in bins.T[::-1]:  # neighbours are put together until they are enough
        kept = kept + one
        if kept[0] >= _FULL:
            off = 100 * abs(kept[1] - kept[2]) / kept[0]
            worst, kept = off if math.isnan(worst) else max(worst, off), np.zeros(3)
    return worst


def _sum(parts: list[dict[str, Any]], name: str) -> np.ndarray:
    return np.sum([np.asarray(part[name], float) for part in parts], axis=0)


def _share(part: float, whole: float, least: int = 50) -> float:
    return float(part / whole) if whole >= least else math.nan


def _mean(values: list[float]) -> float:
    known = [value for value in values if value is not None and not math.isnan(value)]
    return float(np.mean(known)) if known else math.nan
