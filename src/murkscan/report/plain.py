"""The numbers of a report as plain values, as report.json has them."""

from datetime import datetime
from typing import Any

import numpy as np

from .heading import NO_HEADING, Heading
from .placed import placed_as_plain
from .plain_numbers import as_list, as_plain, round_off
from .plain_verdicts import as_plain_verdicts
from .recorded import ModelSize
from .summary import ScanSummary
from .timeline import Timeline
from .trust import AT_95, Trust
from .walls import walls_as_plain
from .words import rig_rows


def as_json(summary: ScanSummary, heading: Heading = NO_HEADING) -> dict[str, Any]:
    """Give the content of report.json: plain values, units in the keys, None for what is not."""
    return {
        "format": 1,
        **heading.as_plain(),
        **_counts(summary),
        **model_as_plain(summary.model),
        "signal_grey_levels": as_plain(summary.signal, 1.0),
        "depth_mm": as_plain(summary.depth, 1e3),
        "sigma_mm": as_plain(summary.sigma, 1e3),
        "uncertainty_mm": None if summary.trust is None else as_uncertainty(summary.trust),
        "motion_accuracy": summary.recorded.motion or None,
        "motion_correction": list(summary.recorded.correction),
        "not_in_uncertainty": list(summary.recorded.unstated),
        "spacing_along_stripe_mm": as_plain(summary.along, 1e3),
        "spacing_along_motion_mm": as_plain(summary.across, 1e3),
        "rig": dict(rig_rows(summary.rig)),
        "laser": summary.lasers[0],
        "lasers": list(summary.lasers),
        "settings": dict(summary.settings),
        "versions": dict(summary.versions),
        "durations_s": {name: round_off(time) for name, time in summary.durations.items()},
        "pictures": [{"path": p.path, "caption": p.caption} for p in summary.pictures],
        **as_plain_verdicts(summary),
        "timeline": _as_columns(summary.timeline, is_timed=summary.recorded.is_timed),
    }


def model_as_plain(model: ModelSize) -> dict[str, Any]:
    """Give what is told of the surface, and of where and how large it is."""
    return {
        "mesh": {
            "vertices": model.vertices,
            "faces": model.faces,
            "origin_m": list(model.origin),
        },
        "georeference": placed_as_plain(model.placed),
        "walls": walls_as_plain(model.walls),
        "size_mm": None if model.size is None else [round_off(1e3 * edge) for edge in model.size],
    }


def _counts(summary: ScanSummary) -> dict[str, Any]:
    """Give what was recorded, and how many frames and points came of it."""
    recorded = summary.recorded
    return {
        "recording": {
            "name": recorded.name,
            "size_px": list(recorded.size),
            "fields_per_picture": recorded.fields_per_picture,
            "is_timed": recorded.is_timed,
            "remarks": list(recorded.remarks),
            "path": recorded.path,
            "began": _moment(recorded.began),
            "files_written": _moment(recorded.written),
            "scanned": _moment(recorded.scanned),
            "duration_s" if recorded.is_timed else "pictures": round_off(summary.duration),
        },
        "attenuation_per_m": None
        if (water := recorded.attenuation) is None
        else {
            "effective": round_off(water.effective),
            "low": round_off(water.low),
            "high": round_off(water.high),
        },
        "frames": {
            "read": summary.num_frames,
            "skipped": recorded.num_skipped,
            "without_stripe": summary.num_empty,
            "skips": [
                {"frame": index, "frames": count, "reason": reason}
                for index, count, reason in recorded.skips
            ],
        },
        "points": {
            "on_profiles": summary.num_points,
            "outliers": summary.model.outliers,
            "in_cloud": summary.model.points,
        },
    }


def _as_columns(timeline: Timeline, *, is_timed: bool) -> dict[str, Any]:
    return {
        "time_s" if is_timed else "picture": as_list(timeline.time),
        "frames": timeline.frames.tolist(),
        "frames_without_stripe": timeline.empty.tolist(),
        "points_per_frame": as_list(timeline.points),
        **_as_lists("signal_grey_levels", timeline.signal, 1.0),
        **_as_lists("depth_mm", timeline.depth, 1e3),
    }


def as_uncertainty(trust: Trust) -> dict[str, Any]:
    """Give the spread over the points of each part, at 68 % (1 σ) and at 95 %."""
    parts = {"independent": trust.independent, "common": trust.common, "total": trust.total}
    return {
        f"{name}_{level}_percent": None if part is None else as_plain(part, scale)
        for name, part in parts.items()
        for level, scale in ((68, 1e3), (95, 1e3 * AT_95))
    }


def _as_lists(name: str, values: np.ndarray, scale: float) -> dict[str, list[float | None]]:
    shares = ("percent_5", "median", "percent_95")
    columns = zip(shares, values.T, strict=True)
    return {f"{name}_{share}": as_list(scale * column) for share, column in columns}


def _moment(moment: datetime | None) -> str | None:
    return None if moment is None else moment.isoformat()
