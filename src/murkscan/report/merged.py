"""What the report of a merged scan says: its passes, how each was moved, how far they disagree."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..page import Block, Facts, Note, Section, Table, format_cell, render_page
from ..types.rig import Rig
from .calibrated import CalibrationStep
from .heading import NO_HEADING, Heading
from .html import gallery, size_facts, uncertainty_blocks
from .placed import placed_sections
from .plain import as_uncertainty, model_as_plain
from .plain_numbers import round_off
from .recorded import ModelSize, Shown
from .sections import calibration_blocks, repeat_blocks
from .trust import AT_95, Trust
from .walls import wall_sections
from .words import rig_rows, setting_rows

_TO_KNOW = (
    "Coverage, speed and the stripe itself are told by each pass's own report, in its own folder; "
    "its path is relative to this one."
)
_APART = (
    "Where two passes saw the same surface, after they were laid on one another: the mean "
    "distance, positive where the first lies in front of the second, the root mean square, and "
    "what 95 % of the places do not exceed; the noise of single points is averaged out. Stated is "
    "how far rigs and alignments may bring the two apart in the mean, at 95 %."
)


@dataclass(frozen=True)
class ReportedPass:
    """One pass."""

    name: str
    """Of its folder or file."""
    path: str
    """Relative to the merged folder."""
    points: int
    frames: tuple[int, int]
    """First and last of its frames, by the merged cloud's count."""
    first_frame: int
    """Its own number of the first of them."""
    words: str
    """How it was moved."""
    shift: tuple[float, ...] | None
    """How far the middle of its overlap moved [m]; None for a pass that stays."""
    turn: tuple[float, ...] | None
    """Rotation vector [rad]."""
    overlap: float | None
    """Share of it that lies on passes before it."""
    rms: float | None
    """Root mean square distance there when it was laid [m]."""
    laid_on: Sequence[float]
    """Share of that overlap in each pass before it."""
    correction: Sequence[str]
    """How its way was corrected, in sentences; none where it was moved as a rigid body."""
    corrected: float | None
    """By how far, RMS [m]."""
    rig: int | None
    """Number of its rig among those below; None where it is not known."""


@dataclass(frozen=True)
class ReportedRig:
    """One rig, which one or more passes were recorded with."""

    rig: Rig
    file: str
    calibration: Mapping[str, Any] | None
    """What its file says of its calibration; None where that is not known."""
    steps: Sequence[CalibrationStep]


@dataclass(frozen=True)
class ReportedPair:
    """Two passes that saw the same surface."""

    first: int
    second: int
    """Their numbers, from 0."""
    share: float
    """Share of the smaller one that both saw."""
    mean: float
    """Mean distance of the first in front of the second [m]."""
    rms: float
    within_95: float
    """Distance that 95 % of the places do not exceed [m]."""
    stated: float | None
    """Standard deviation of the distance by what rigs and alignments state [m]."""


@dataclass(frozen=True)
class MergedSummary:
    """All that the report of a merged scan says."""

    name: str
    passes: Sequence[ReportedPass]
    pairs: Sequence[ReportedPair]
    rigs: Sequence[ReportedRig]
    model: ModelSize
    trust: Trust | None
    """How far to trust the points; None without any."""
    settings: Mapping[str, Any]
    versions: Mapping[str, str]
    durations: Mapping[str, float]
    """Time that each stage took [s]."""
    commands: Sequence[str]
    pictures: Sequence[Shown]
    unstated: Sequence[str]
    """Whose errors no interval knows, in sentences."""
    remarks: Sequence[str]
    """Why passes were moved as rigid bodies, in sentences."""


def merged_as_html(summary: MergedSummary, heading: Heading = NO_HEADING) -> str:
    """Make report/index.html of a merged scan."""
    sections = [Section("", _headline(summary)), Section("Passes", _passes(summary))]
    if ways := _ways(summary):
        sections.append(Section("Ways of the passes", ways))
    if summary.pairs:
        sections.append(Section("Disagreement of the passes", _disagreement(summary)))
    if summary.pictures:
        sections.append(Section("Pictures", [gallery(summary.pictures, is_first_large=True)]))
    if summary.trust is not None:
        sections.append(Section("Uncertainty at 68 and 95 %", _uncertainty(summary)))
    sections += placed_sections(summary.model.placed)
    sections += wall_sections(summary.model.walls)
    for number, one in enumerate(summary.rigs, 1):
        blocks = [Table(rig_rows(one.rig)), *calibration_blocks(one.calibration, one.steps)]
        sections.append(Section(f"Rig {number}", blocks))
    sections += [
        Section("To do it again", repeat_blocks(summary.commands)),
        Section("Settings", [Table(list(setting_rows(summary.settings)))]),
        Section("Versions", [Table(list(summary.versions.items()))]),
        Section("Time taken", [Table([(k, f"{s:.1f} s") for k, s in summary.durations.items()])]),
    ]
    title = heading.title or "Report of merged passes"
    return render_page(title, sections, subtitle=heading.subtitle(summary.name))


def merged_as_json(summary: MergedSummary, heading: Heading = NO_HEADING) -> dict[str, Any]:
    """Give the content of report.json: plain values, units in the keys, None for what is not."""
    model = summary.model
    return {
        "format": 1,
        **heading.as_plain(),
        "merged": [_as_plain_pass(one) for one in summary.passes],
        "remarks": list(summary.remarks),
        "disagreement": [_as_plain_pair(one) for one in summary.pairs],
        "points": {"in_cloud": model.points},
        **model_as_plain(model),
        "uncertainty_mm": None if summary.trust is None else as_uncertainty(summary.trust),
        "not_in_uncertainty": list(summary.unstated),
        "rigs": [{"file": one.file or None, **dict(rig_rows(one.rig))} for one in summary.rigs],
        "settings": dict(summary.settings),
        "versions": dict(summary.versions),
        "durations_s": {name: round_off(time) for name, time in summary.durations.items()},
        "commands": list(summary.commands),
        "pictures": [{"path": p.path, "caption": p.caption} for p in summary.pictures],
    }


def _headline(summary: MergedSummary) -> list[Block]:
    count = len(summary.passes)
    facts = [
        (format_cell(count), "pass" if count == 1 else "passes"),
        (format_cell(summary.model.points), "points in the cloud"),
        (format_cell(summary.model.faces), "triangles"),
        *size_facts(summary.model),
    ]
    return [Facts(facts), *_doubts(summary)]


def _doubts(summary: MergedSummary) -> Iterator[Note]:
    """Say which passes lie farther apart than is stated."""
    for pair in summary.pairs:
        if pair.stated is not None and abs(pair.mean) > AT_95 * pair.stated:
            names = " and ".join(summary.passes[n].name for n in (pair.first, pair.second))
            yield Note(
                f"{names} lie {1e3 * abs(pair.mean):.2f} mm apart in the mean, more than the "
                f"{1e3 * AT_95 * pair.stated:.2f} mm that their rigs and alignments state at 95 %.",
                "warning",
            )


def _passes(summary: MergedSummary) -> list[Block]:
    rows = [
        (
            one.name,
            one.path,
            one.points,
            f"{one.first_frame} to {one.first_frame + one.frames[1] - one.frames[0]}",
            "not known" if one.rig is None else one.rig + 1,
            one.words,
        )
        for one in summary.passes
    ]
    return [Note(_TO_KNOW), Table(rows, ("pass", "folder", "points", "frames", "rig", "place"))]


def _ways(summary: MergedSummary) -> list[Block]:
    """Say how each way was corrected along its length, or why not."""
    notes: list[Block] = [Note(f"{words[:1].upper()}{words[1:]}.") for words in summary.remarks]
    rows = [(one.name, "; ".join(one.correction)) for one in summary.passes if one.correction]
    return [*notes, Table(rows)] if rows else notes


def _disagreement(summary: MergedSummary) -> list[Block]:
    rows = [
        (
            " and ".join(summary.passes[n].name for n in (one.first, one.second)),
            100 * one.share,
            *(_as_mm(length) for length in (one.mean, one.rms, one.within_95)),
            None if one.stated is None else _as_mm(AT_95 * one.stated),
        )
        for one in summary.pairs
    ]
    head = (
        "passes", "both saw [%]", "mean [mm]", "RMS [mm]", "95 % within [mm]", "stated, 95 % [mm]",
    )  # fmt: skip
    return [Note(_APART), Table(rows, head)]


def _as_mm(length: float) -> float:
    """Write a length in millimetres, to a tenth of a micrometre."""
    return round(1e3 * length, 4)


def _uncertainty(summary: MergedSummary) -> list[Block]:
    assert summary.trust is not None
    text = "The common part is that of the passes' rigs, poses and alignment together."
    return [*uncertainty_blocks(summary.trust, unstated=summary.unstated), Note(text)]


def _as_plain_pass(one: ReportedPass) -> dict[str, Any]:
    return {
        "name": one.name,
        "path": one.path,
        "points": one.points,
        "frames": list(one.frames),
        "own_first_frame": one.first_frame,
        "moved": one.words,
        "shift_mm": None if one.shift is None else [round_off(1e3 * part) for part in one.shift],
        "turn_rad": None if one.turn is None else [round_off(part) for part in one.turn],
        "overlap": one.overlap,
        "rms_mm": None if one.rms is None else round_off(1e3 * one.rms),
        "rig": one.rig,
        "laid_on": [round_off(share) for share in one.laid_on],
        "corrected_mm": None if one.corrected is None else round_off(1e3 * one.corrected),
        "correction": list(one.correction),
    }


def _as_plain_pair(one: ReportedPair) -> dict[str, Any]:
    return {
        "passes": [one.first, one.second],
        "share": round_off(one.share),
        "mean_mm": round_off(1e3 * one.mean),
        "rms_mm": round_off(1e3 * one.rms),
        "within_95_percent_mm": round_off(1e3 * one.within_95),
        "stated_sigma_mm": None if one.stated is None else round_off(1e3 * one.stated),
    }
