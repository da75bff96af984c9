"""The parts of the page that a client reads: what was scanned, how well, and how to do it again."""

import math
from collections.abc import Mapping, Sequence
from datetime import datetime
from decimal import Decimal
from typing import Any

from ..page import Block, Code, Note, Table, format_cell
from .belief import Belief, name_classes
from .calibrated import CalibrationStep
from .coverage import Coverage
from .coverage_chart import NAMES, coverage_chart
from .reach import FAINT, PLAIN
from .recorded import Recorded
from .speed import Speed
from .summary import ScanSummary
from .words import rig_rows

_OLD = 365
"""Days after which a calibration is called old."""
_NO_LIGHT = ("too_far", "too_dark", "far_or_dark")
"""Causes of which the range decides."""
_ENOUGH = 1.005
"""A speed as much above the highest is still called right: half a percent is no one's concern."""


def scanned_rows(summary: ScanSummary) -> list[tuple[str, str]]:
    """Say what was scanned, when, with what and in what."""
    recorded = summary.recorded
    rig = dict(rig_rows(summary.rig))
    width, height = recorded.size
    fields = ", interlaced: each field is a frame" if recorded.fields_per_picture == 2 else ""
    return [
        ("recording", recorded.path or recorded.name),
        ("recorded", _when_recorded(recorded)),
        ("length", _duration(summary)),
        ("frames", f"{format_cell(summary.num_frames)} of {width} × {height} px{fields}"),
        ("scanned", _moment(recorded.scanned)),
        ("rig", f"{recorded.rig_file or 'file not known'}; parts are listed below"),
        ("water, by the rig's file", rig["water"]),
        ("water, by the recording", _murk(recorded)),
    ]


def coverage_blocks(coverage: Coverage, *, is_asked: bool) -> list[Block]:
    """Show the map, and the areas that it has and misses."""
    told = "was asked for" if is_asked else "is this scan's own; --spacing-mm asks for another"
    areas = {NAMES[cause]: area for cause, area in coverage.missing.items()}
    areas = {"covered": coverage.covered} | areas | {"all": coverage.mapped}
    digits = max(3 - math.floor(math.log10(coverage.mapped)), 0)
    rows = [
        (name, Decimal(f"{area:.{digits}f}"), Decimal(f"{100 * area / coverage.mapped:.1f}"))
        for name, area in areas.items()
    ]
    text = (
        f"Gaps are judged by a spacing of {1e3 * coverage.wanted:.3g} mm, which {told}. Where "
        f"neighbours on a scan line lie more than {1e3 * coverage.hole:.3g} mm apart, what is "
        "between them is missing. What lies outside of all profiles is not known to be a surface "
        "and is not counted; areas are as seen from the scanner. Where the model is white, "
        "this map says why."
    )
    return [
        Note(text),
        *_reach_notes(coverage),
        coverage_chart(coverage),
        Table(rows, head=("", "area [m²]", "share [%]")),
    ]


def speed_blocks(speed: Speed, summary: ScanSummary) -> list[Block]:
    """Set the speed of the motion against what the spacing needs."""
    scale = 1e3
    rows: list[tuple[str, str]] = [("from frame to frame", _spread(speed.step.median, "mm"))]
    if speed.shown.median is not None:
        low, high = speed.shown.low or 0.0, speed.shown.high or 0.0
        rows.append(
            (
                "speed of the motion",
                f"{scale * speed.shown.median:.4g} mm/s in the median, 90 % of it from "
                f"{scale * low:.4g} to {scale * high:.4g} mm/s",
            )
        )
    rows += [
        ("spacing along the stripe, median", _spread(summary.along.median, "mm")),
        ("spacing along the motion, median", _spread(summary.across.median, "mm")),
    ]
    if speed.rate is not None:
        rows.append(("frame rate", f"{speed.rate:.4g} a second"))
    aim = "a grid as dense both ways"
    if summary.wanted is not None:
        aim = "the wanted spacing"
        rows.append(("wanted spacing", _spread(summary.wanted, "mm")))
    if speed.highest is not None:
        rows.append((f"highest speed for {aim}", f"{1e3 * speed.highest:.4g} mm/s"))
    if speed.needed_rate is not None:
        rows.append((f"frame rate for {aim}", f"{speed.needed_rate:.4g} a second"))
    return [*_speed_verdict(speed, is_asked=summary.wanted is not None), Table(rows)]


def belief_rows(belief: Belief) -> list[tuple[str, int, float]]:
    """List how many points have which posterior."""
    names = [name for _, name in name_classes()]
    return [
        (name, count, 100 * share)
        for name, count, share in zip(names, belief.counts, belief.shares, strict=True)
    ]


def calibration_blocks(
    calibration: Mapping[str, Any] | None, steps: Sequence[CalibrationStep]
) -> list[Block]:
    """Say what the rig's file tells of its calibration: the record, and its steps."""
    if calibration is None:
        return [Note("The rig's file is not known here, so neither is its calibration.", "warning")]
    if not steps:
        text = (
            "The rig's file holds no record of a calibration: camera and laser are taken as they "
            "stand there, and how far that is true cannot be told. murkscan calibrate writes one."
        )
        return [Note(text, "warning")]
    rows = [
        (step.name, _age(step), step.evidence, step.verdict or "not recorded") for step in steps
    ]
    head = ("step", "made", "evidence", "verdict")
    return [*_calibration_verdict(steps), Table(rows, head=head)]


def repeat_blocks(commands: Sequence[str]) -> list[Block]:
    """Say how to do the same again."""
    if not commands:
        return [Note("Made from Python, with the settings listed here.")]
    return [
        Note("What was typed; with the same recording, rig file and version it gives the same."),
        Code(commands),
    ]


def _reach_notes(coverage: Coverage) -> list[Block]:
    """Say how far the light went, and what that tells of gaps from which none came back."""
    if not any(coverage.missing[cause] > 0 for cause in _NO_LIGHT):
        return []
    far, least = coverage.reach.farthest, coverage.reach.least
    beyond = "nowhere in this scan" if far is None else f"in this scan from {1e3 * far:.0f} mm on"
    text = (
        "Where no light came back, the range of the gap's neighbours tells why. Stripes of this "
        f"scan below {least:.3g} grey levels are not surely found. Too far is where the usual "
        f"stripe is less than {FAINT:g} times as strong, {beyond}. Near enough is where it is more "
        f"than {PLAIN:g} times as strong: darker paint, a surface too steep, and nothing being "
        "there cannot be told apart then; nor can far and dark in between."
    )
    return [Note(text)]


def _speed_verdict(speed: Speed, *, is_asked: bool) -> list[Block]:
    if speed.wanted is None or speed.step.median is None:
        return []
    ratio = speed.step.median / speed.wanted
    if not is_asked:
        text = (
            f"Profiles lie {ratio:.3g} times as far apart as the points along them. Whether that "
            "is near enough is for you to say: --spacing-mm judges the speed by what you need."
        )
        return [Note(text)]
    if ratio > _ENOUGH:
        cure = "" if speed.highest is None else f" Move at {1e3 * speed.highest:.3g} mm/s or less"
        needed = speed.needed_rate
        rate = "" if needed is None else f", or take {needed:.3g} frames a second"
        text = f"Too fast: profiles lie {ratio:.3g} times as far apart as wanted."
        return [Note(f"{text}{cure}{rate}{'.' if cure else ''}", "warning")]
    most = "" if speed.highest is None else f", and up to {1e3 * speed.highest:.3g} mm/s would do"
    text = f"Slow enough: profiles lie {ratio:.2g} times the wanted spacing apart{most}."
    return [Note(text, "good")]


def _calibration_verdict(steps: Sequence[CalibrationStep]) -> list[Block]:
    notes: list[Block] = []
    bad = [step.name for step in steps if not step.is_usable]
    if bad:
        text = f"Not usable, by the verdict on {', '.join(bad)}: its corners did not fit."
        notes.append(Note(text, "warning"))
    poor = [s.name for s in steps if s.verdict and not s.is_good and s.name not in bad]
    if poor:
        notes.append(Note(f"Usable, with advice on {', '.join(poor)}: see its verdict.", "warning"))
    elif all(step.is_good for step in steps):
        notes.append(Note("Good in every step that was recorded.", "good"))
    if old := [step.name for step in steps if abs(step.age_days or 0) > _OLD]:
        text = (
            f"More than a year lies between the recording and the calibration of {', '.join(old)}."
        )
        notes.append(Note(f"{text} Check it with murkscan calibrate check.", "warning"))
    return notes


def _age(step: CalibrationStep) -> str:
    if step.date is None:
        return "date not recorded"
    if step.age_days is None:
        return step.date.isoformat()
    if step.age_days < 0:
        return f"{step.date.isoformat()}, {-step.age_days} days after the recording"
    return f"{step.date.isoformat()}, {step.age_days} days before the recording"


def _when_recorded(recorded: Recorded) -> str:
    if recorded.began is not None:
        return f"{_moment(recorded.began)}, by the clock of the poses"
    if recorded.written is not None:
        return f"not stated; its files were last written on {_moment(recorded.written)}"
    return "not known"


def _moment(moment: datetime | None) -> str:
    return "not known" if moment is None else moment.strftime("%Y-%m-%d %H:%M:%S %Z").strip()


def _duration(summary: ScanSummary) -> str:
    if not summary.recorded.is_timed:
        return f"{summary.duration:g} pictures; the recording has no times"
    minutes, seconds = divmod(summary.duration, 60)
    return f"{minutes:.0f} min {seconds:.1f} s" if minutes else f"{seconds:.2f} s"


def _murk(recorded: Recorded) -> str:
    water = recorded.attenuation
    if water is None:
        return "not told by the glow"
    between = f"beam attenuation between {water.low:.2g} and {water.high:.2g} per metre"
    return f"the glow fades by {water.effective:.2g} per metre; {between}"


def _spread(value: float | None, unit: str) -> str:
    return "–" if value is None else f"{1e3 * value:.4g} {unit}"
