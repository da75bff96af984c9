"""A plan: the forecast for a rig in a water, its table, its page and its numbers."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import MurkscanError
from ..io.json_files import save_json
from ..io.text import save_text
from ..page import Facts, Note, Section, Table, render_page
from ..plan import (
    Conditions,
    Forecast,
    Placement,
    forecast,
    place_laser,
    visibility_from_attenuation,
)
from ..plan.charts import bound_chart, sigma_chart
from ..plan.placement import COVERED, judge_present, present_place
from ..types.rig import Rig

_NUM_ROWS = 8
_HEAD = ("z [m]", "in view %", "found %", "σ noise", "σ speckle", "σ across", "σ common", "spacing")
"""The last five in millimetres."""


@dataclass(frozen=True, eq=False)
class Plan:
    """What is said of a rig."""

    seen: Forecast
    head: tuple[str, ...]
    rows: list[tuple[str, ...]]
    """The table, as it is printed."""
    sentences: list[str]
    """What it comes to, in plain words."""
    numbers: dict[str, Any]
    """The same for programs."""


def make_plan(
    rig: Rig,
    conditions: Conditions,
    *,
    out: Path,
    working_range: tuple[float | None, float | None] = (None, None),
    spacing: float = 5e-3,
    frame_rate: float = 25.0,
    longest: float | None = None,
    laser: int = 0,
) -> Plan:
    """Say what a rig will see, into OUT/index.html and OUT/plan.json.

    Args:
        rig: The rig.
        conditions: Water, light, sensor and surface.
        out: The folder.
        working_range: Nearest and farthest distance of the surface [m]; None: as the rig sees.
        spacing: Wanted distance from profile to profile [m].
        frame_rate: Frames, or fields, a second.
        longest: Longest baseline that the vehicle can carry [m]; None: twice the present one.
        laser: Number of the laser.

    Raises:
        NotEnoughData: The rig will see nothing in this water.
        InputError: The rig has no such laser.
        DeviceError: The disk is full.
    """
    whole = forecast(rig, conditions, laser=laser)
    nearest, farthest = whole.reach
    near, far = working_range[0] or nearest, working_range[1] or farthest
    depths = np.geomspace(near, far, _NUM_ROWS) if near < far else np.array([near])
    shown = forecast(rig, conditions, depths=depths, laser=laser)
    now, _ = present_place(rig, laser)
    best = _place(rig, conditions, (near, far), longest or 2 * now, laser)
    present = judge_present(rig, conditions, near=near, far=far, laser=laser) if best else None
    speed = spacing * frame_rate
    sentences = [
        f"It sees from {nearest:.2f} to {farthest:.2f} m: there half of the points or more are "
        f"found, in water of beam attenuation {conditions.medium.attenuation:.2f} per metre, in "
        f"which a diver sees {visibility_from_attenuation(conditions.medium.attenuation):.1f} m.",
        f"Profiles {spacing * 1e3:g} mm apart at {frame_rate:g} frames a second: go no faster than "
        f"{speed * 1e3:.0f} mm/s. While a frame is exposed that is "
        f"{speed * conditions.sensor.exposure * 1e3:.2g} mm.",
        tell_placement(present, best, (near, far)),
    ]
    made = Plan(whole, _HEAD, _rows(shown), sentences, _numbers(whole, shown, best, speed))
    save_json(out / "plan.json", made.numbers)
    save_text(out / "index.html", _page(made))
    return made


def _place(
    rig: Rig, conditions: Conditions, span: tuple[float, float], longest: float, laser: int
) -> Placement | None:
    try:
        return place_laser(rig, conditions, near=span[0], far=span[1], longest=longest, laser=laser)
    except MurkscanError:
        return None


def tell_placement(now: Placement | None, best: Placement | None, span: tuple[float, float]) -> str:
    """Say what a laser shows of a range from where it is, and from where it would better sit.

    Args:
        now: From where it is.
        best: From the best place; None where no place shows anything.
        span: The nearest and the farthest distance [m].
    """
    if now is None or best is None:
        return "No other place of the laser shows more of this range."
    here = (
        f"Between {span[0]:.2f} and {span[1]:.2f} m the laser as it is shows "
        f"{_per_cent(now.share_found)} of the points, with σ up to {now.sigma * 1e3:.2g} mm"
    )
    rule = f"{COVERED:.0%}" if best.share_found >= COVERED else "as many as any place does"
    is_enough = now.share_found >= min(COVERED, best.share_found)
    if is_enough and best.sigma >= 0.97 * now.sigma:
        return f"{here}; no other place that was tried and shows {rule} has a smaller σ."
    there = (
        f"a baseline of {best.baseline * 1e3:.0f} mm at an angle of "
        f"{math.degrees(best.angle):.1f}° shows {_per_cent(best.share_found)} with σ up to "
        f"{best.sigma * 1e3:.2g} mm, the smallest σ of places that show {rule}"
    )
    if is_enough:
        return f"{here}; {there}."
    return f"{here}. More points come first: {there}, even where that is more than now."


def _per_cent(share: float) -> str:
    """Write a share, rounded down, so that what misses a bound never looks as if it met it."""
    return f"{math.floor(1e3 * share + 1e-6) / 10:g} %"


def _rows(shown: Forecast) -> list[tuple[str, ...]]:
    columns = [1e3 * shown.median(values) for values in _sigmas(shown)]
    return [
        (
            f"{depth:.2f}",
            f"{100 * in_view:.0f}",
            f"{100 * found:.0f}",
            *("–" if math.isnan(value) else f"{value:.2g}" for value in values),
        )
        for depth, in_view, found, *values in zip(
            shown.depths, shown.share_in_view, shown.share_found, *columns, strict=True
        )
    ]


def _sigmas(shown: Forecast) -> tuple[np.ndarray, ...]:
    return (
        shown.sigma_along,
        shown.sigma_speckle,
        shown.sigma_across,
        shown.sigma_common,
        shown.spacing,
    )


def _numbers(
    whole: Forecast, shown: Forecast, best: Placement | None, speed: float
) -> dict[str, Any]:
    names = ("sigma_along_m", "sigma_speckle_m", "sigma_across_m", "sigma_common_m", "spacing_m")
    return {
        "format": 1,
        "reach_m": list(whole.reach),
        "depth_m": shown.depths.tolist(),
        "share_in_view": shown.share_in_view.tolist(),
        "share_found": shown.share_found.tolist(),
        **{
            name: [None if math.isnan(v) else v for v in shown.median(values).tolist()]
            for name, values in zip(names, _sigmas(shown), strict=True)
        },
        "fastest_m_s": speed,
        "best": None
        if best is None
        else {
            "baseline_m": best.baseline,
            "angle_deg": math.degrees(best.angle),
            "share_found": best.share_found,
            "sigma_m": best.sigma,
        },
    }


def _as_cell(text: str) -> float | None:
    return None if text == "–" else float(text)


def _page(made: Plan) -> str:
    """Show the plan."""
    nearest, farthest = made.seen.reach
    facts = Facts(
        [
            (f"{nearest:.2f} – {farthest:.2f} m", "half of the points or more are found"),
            (f"{made.numbers['fastest_m_s'] * 1e3:.0f} mm/s", "fastest for the wanted spacing"),
        ]
    )
    notes = [Note(sentence) for sentence in made.sentences]
    rows = [[_as_cell(text) for text in row] for row in made.rows]
    about = Note(
        "A plain wall that faces the camera at z in front of it; σ and spacing in millimetres. σ "
        "noise is that of a point along its ray, the least that the noise of one scan line allows; "
        "neighbouring lines and frames may lower it. σ speckle is what rough paint adds to it in "
        "laser light; averaging over motion lowers it. σ across is the width of a scan line, σ "
        "common the calibration's, the same for all points; 0 where the rig file states none. "
        "Spacing is that of points along the line."
    )
    return render_page(
        "What this rig will see",
        [
            Section("", [facts, *notes]),
            Section("Against distance", [sigma_chart(made.seen), bound_chart(made.seen)]),
            Section("Numbers", [Table(rows, made.head), about]),
        ],
    )
