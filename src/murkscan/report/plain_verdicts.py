"""Coverage, speed, distributions and calibration, as report.json has them."""

from typing import Any

import numpy as np

from .belief import Belief, name_classes
from .coverage import Coverage
from .histogram import Histogram
from .plain_numbers import as_list, as_plain, round_off
from .speed import Speed
from .summary import ScanSummary
from .swath import CAUSES

_LETTERS = dict(zip(("nothing", "covered", *CAUSES), ".cnuvdhbw", strict=True))
"""One letter a state of a cell: no stripe, unreadable, speed (v), distance, hidden, black, weak."""


def as_plain_verdicts(summary: ScanSummary) -> dict[str, Any]:
    """Give what a report says beyond counts and spreads; None for what is not known."""
    recorded = summary.recorded
    return {
        "coverage": None
        if summary.coverage is None
        else _coverage(summary.coverage, summary.wanted),
        "speed": None if summary.speed is None else _speed(summary.speed, summary.wanted),
        "signal_histogram_grey_levels": _histogram(summary.signals, 1.0),
        "sigma_histogram_mm": _histogram(summary.sigmas, 1e3),
        "posterior": _belief(summary.belief) if summary.belief.is_told else None,
        "calibration": {
            "rig_file": recorded.rig_file or None,
            "is_recorded": None if recorded.calibration is None else bool(summary.steps),
            "steps": [
                {
                    "step": step.name,
                    "date": None if step.date is None else step.date.isoformat(),
                    "age_days": step.age_days,
                    "verdict": step.verdict or None,
                    "is_good": step.is_good,
                    "evidence": step.evidence,
                }
                for step in summary.steps
            ],
        },
        "commands": list(recorded.commands),
    }


def _coverage(coverage: Coverage, wanted: float | None) -> dict[str, Any]:
    directions = coverage.directions
    return {
        "wanted_spacing_mm": _perhaps(wanted, 1e3),
        "judged_by_spacing_mm": round_off(1e3 * coverage.wanted),
        "hole_above_mm": round_off(1e3 * coverage.hole),
        "share_covered": round_off(coverage.covered / coverage.mapped),
        "area_m2": {
            "all": round_off(coverage.mapped),
            "covered": round_off(coverage.covered),
            **{cause: round_off(area) for cause, area in coverage.missing.items()},
        },
        "reach": {
            "least_signal_grey_levels": round_off(coverage.reach.least),
            "too_far_from_mm": _perhaps(coverage.reach.farthest, 1e3),
            "range_mm": as_list(1e3 * coverage.reach.ranges),
            "usual_signal_grey_levels": as_list(coverage.reach.usual),
        },
        "directions": {
            "along_motion": as_list(directions.along),
            "across": as_list(directions.across),
            "towards_scanner": as_list(directions.towards),
        },
        "map": {
            "cell_mm": round_off(1e3 * coverage.cell),
            "corner_mm": [round_off(1e3 * place) for place in coverage.corner],
            "letters": {letter: name for name, letter in _LETTERS.items()},
            "rows_across": _draw(coverage),
            "points": coverage.points.tolist(),
        },
    }


def _draw(coverage: Coverage) -> list[str]:
    """Write each row of cells, all at one place across, as letters along the motion."""
    letters = np.array(list(_LETTERS.values()))
    return ["".join(row) for row in letters[coverage.state() + 1]]


def _speed(speed: Speed, wanted: float | None) -> dict[str, Any]:
    return {
        "frame_rate_hz": _perhaps(speed.rate, 1.0),
        "step_mm": as_plain(speed.step, 1e3),
        "speed_mm_s": as_plain(speed.shown, 1e3),
        "wanted_spacing_mm": _perhaps(wanted, 1e3),
        "highest_speed_mm_s": _perhaps(speed.highest, 1e3),
        "needed_frame_rate_hz": _perhaps(speed.needed_rate, 1.0),
    }


def _histogram(histogram: Histogram, scale: float) -> dict[str, Any]:
    return {
        "edges": as_list(scale * histogram.edges),
        "shares": as_list(histogram.shares),
        "share_below": round_off(histogram.below),
        "share_above": round_off(histogram.above),
    }


def _belief(belief: Belief) -> dict[str, Any]:
    names = [name for name, _ in name_classes()]
    columns = zip(names, belief.counts, belief.shares, strict=True)
    return {name: {"points": n, "share": round_off(share)} for name, n, share in columns}


def _perhaps(value: float | None, scale: float) -> float | None:
    return None if value is None else round_off(scale * value)
