"""The page that tells how a scan went."""

from collections.abc import Iterator, Sequence

from ..page import Block, Facts, Gallery, Note, Picture, Section, Table, format_cell, render_page
from .charts import depth_chart, points_chart, signal_chart
from .distribution_charts import sigma_distribution, signal_distribution
from .heading import NO_HEADING, Heading
from .placed import placed_sections
from .quantiles import Quantiles
from .recorded import ModelSize, Shown
from .sections import (
    belief_rows,
    calibration_blocks,
    coverage_blocks,
    repeat_blocks,
    scanned_rows,
    speed_blocks,
)
from .summary import ScanSummary
from .trust import AT_95, Trust
from .walls import wall_sections
from .words import describe_range, rig_rows, setting_rows

_SKIPS_SHOWN = 50
"""Rows of the table of skipped frames, at most; report.json has them all."""

_UNITS = "Lengths in metres, times in seconds, angles in radians, pictures in pixels."


_NO_MAP = (
    "There is no map: it needs neighbouring points on two profiles at least, and a motion between "
    "them."
)


def as_html(summary: ScanSummary, heading: Heading = NO_HEADING) -> str:
    """Make report/index.html."""
    sections = [*_seen(summary), *_trusted(summary), *_left_out(summary), *_record(summary)]
    subtitle = heading.subtitle(summary.recorded.name)
    return render_page(heading.title or "Scan report", sections, subtitle=subtitle)


def _seen(summary: ScanSummary) -> Iterator[Section]:
    """Show what was scanned, how much of it was seen, and how well."""
    yield Section("", _headline(summary))
    yield Section("What was scanned", [Table(scanned_rows(summary))])
    views = [shown for shown in summary.pictures if not shown.is_frame]
    if views:
        yield Section("Pictures", [gallery(views, is_first_large=True)])
    if summary.coverage is not None:
        is_asked = summary.wanted is not None
        yield Section("Coverage", coverage_blocks(summary.coverage, is_asked=is_asked))
    elif summary.num_points:
        yield Section("Coverage", [Note(_NO_MAP, "warning")])
    if summary.speed is not None:
        yield Section("Speed and spacing", speed_blocks(summary.speed, summary))
    if summary.num_points:
        yield Section("Signal and uncertainty", _distributions(summary))
        yield Section("Over time", _charts(summary))


def _trusted(summary: ScanSummary) -> Iterator[Section]:
    """Show how far the model may be off, where it lies, and what that rests on."""
    recorded = summary.recorded
    if summary.trust is not None:
        blocks = uncertainty_blocks(
            summary.trust, motion=recorded.motion, unstated=recorded.unstated
        )
        yield Section("Uncertainty at 68 and 95 %", blocks)
    yield from placed_sections(summary.model.placed)
    yield from wall_sections(summary.model.walls)
    if recorded.correction:
        notes = [Note(f"{words[0].upper()}{words[1:]}.") for words in recorded.correction]
        yield Section("Trajectory", notes)
    yield Section("Calibration", calibration_blocks(recorded.calibration, summary.steps))


def _left_out(summary: ScanSummary) -> Iterator[Section]:
    """Show the frames that were not read, and some of those that were."""
    if summary.recorded.skips:
        yield Section("Skipped frames", _skips(summary))
    frames = [shown for shown in summary.pictures if shown.is_frame]
    if frames:
        yield Section("Frames", [gallery(frames)])


def _record(summary: ScanSummary) -> list[Section]:
    """Give all that is needed to do the scan again."""
    sections = [
        Section("To do it again", repeat_blocks(summary.recorded.commands)),
        Section("Rig", [Table(rig_rows(summary.rig))]),
        Section("Settings", [Note(_UNITS), Table(list(setting_rows(summary.settings)))]),
        Section("Versions", [Table(list(summary.versions.items()))]),
    ]
    if summary.durations:
        times = [(name, f"{seconds:.1f} s") for name, seconds in summary.durations.items()]
        sections.append(Section("Time taken", [Table(times)]))
    return sections


def gallery(pictures: Sequence[Shown], *, is_first_large: bool = False) -> Gallery:
    """Show pictures side by side."""
    return Gallery([Picture(shown.path, shown.caption) for shown in pictures], is_first_large)


def _headline(summary: ScanSummary) -> list[Block]:
    model, (width, height) = summary.model, summary.recorded.size
    facts = [
        (format_cell(model.points), "points in the cloud"),
        (format_cell(model.faces), "triangles"),
        (format_cell(summary.num_frames), f"frames read, {width} × {height} px"),
        (format_cell(summary.num_empty), "frames without a stripe"),
    ]
    if summary.recorded.num_skipped:
        facts.append((format_cell(summary.recorded.num_skipped), "frames skipped"))
    if model.outliers:
        facts.append((format_cell(model.outliers), "outliers taken out"))
    if summary.num_points:
        facts.append((describe_range(summary.depth), "depth range"))
    facts += size_facts(model)
    if summary.coverage is not None:
        share = summary.coverage.covered / summary.coverage.mapped
        facts.append((f"{100 * share:.1f} %", "of the surface between the profiles covered"))
    if (water := summary.recorded.attenuation) is not None:
        between = f"between {water.low:.2g} and {water.high:.2g}"
        told = f"per metre: attenuation of the water, by its glow, {between}"
        facts.append((f"{water.effective:.2g}", told))
    odd = [Note(remark, "warning") for remark in summary.recorded.remarks]
    return [*_verdict(summary), *odd, Facts(facts)]


def size_facts(model: ModelSize) -> list[tuple[str, str]]:
    """Say how large a cloud is, where it has points, and from where its files count."""
    if model.size is None:
        return []
    facts = [(" × ".join(f"{1e3 * edge:.0f}" for edge in model.size), "mm along x, y and z")]
    if any(model.origin):
        origin = ", ".join(f"{x:.0f}" for x in model.origin)
        facts.append((origin, "m: origin of mesh.stl and mesh.glb, to be added to their numbers"))
    return facts


def _verdict(summary: ScanSummary) -> list[Block]:
    """Say in plain words how the scan went."""
    frames, empty, skipped = summary.num_frames, summary.num_empty, summary.recorded.num_skipped
    if summary.num_points == 0:
        return [
            Note(
                f"There is no stripe in this recording: none of its {format_cell(frames)} frames "
                "shows one, so there is no cloud and no surface. Look at the pictures in "
                "extract/overlay: is the laser on, is the rig the one that recorded this, is the "
                "extractor's threshold below the line's brightness?",
                "warning",
            )
        ]
    notes: list[Block] = [
        Note(
            f"The laser line was found in {format_cell(frames - empty)} of {format_cell(frames)} "
            f"frames and gave {format_cell(summary.num_points)} points."
        )
    ]
    if skipped:
        frames_were = "1 frame was" if skipped == 1 else f"{format_cell(skipped)} frames were"
        text = f"{frames_were} skipped as unreadable; see below for the reasons."
        notes.append(Note(text, "warning"))
    return notes


def _charts(summary: ScanSummary) -> list[Block]:
    label = "time [s]" if summary.recorded.is_timed else "picture"
    return [
        draw(summary.timeline, time_label=label)
        for draw in (signal_chart, points_chart, depth_chart)
    ]


def _distributions(summary: ScanSummary) -> list[Block]:
    """Show how the numbers of all points are spread."""
    blocks: list[Block] = [_spreads(summary)]
    blocks += [signal_distribution(summary.signals), sigma_distribution(summary.sigmas)]
    if summary.belief.is_told:
        head = ("probability that the point is the surface", "points", "share [%]")
        blocks.append(Table(belief_rows(summary.belief), head=head))
    else:
        blocks.append(Note("The extractor gives no probability of a point: all count as sure."))
    return blocks


def _spreads(summary: ScanSummary) -> Table:
    rows = [
        ("spacing along the stripe [mm]", *_figures(summary.along, 1e3)),
        ("spacing along the motion [mm]", *_figures(summary.across, 1e3)),
        ("depth z [mm]", *_figures(summary.depth, 1e3)),
        ("standard deviation along the ray [mm]", *_figures(summary.sigma, 1e3)),
        ("signal [grey levels]", *_figures(summary.signal, 1.0)),
    ]
    return Table(rows, head=("", "smallest", "5 %", "median", "95 %", "largest"))


def uncertainty_blocks(
    trust: Trust, *, motion: str = "", unstated: Sequence[str] = ()
) -> list[Block]:
    """Show both parts of the points' uncertainty at two levels, and what is in neither."""
    parts = [("independent", trust.independent), ("common", trust.common), ("both", trust.total)]
    rows = [
        (name, *(_at(part, share) for share in ("median", "high")), *_at_95(part))
        for name, part in parts
    ]
    below = "95 % of points below"
    head = ("[mm]", "at 68 %: median", below, "at 95 %: median", below)
    blocks: list[Block] = [
        Note(
            "How far a point may be off, with a confidence of 68 % (1 σ) and of 95 % (1.96 σ): for "
            "the median point, and what 95 % of the points do not exceed. The independent part "
            "differs from point to point, and averaging lowers it; the common part is shared by "
            f"the points of the scan, and no average lowers it.{_tell_motion(motion)}"
        ),
        Table(rows, head=head),
    ]
    return [*(Note(text, "warning") for text in unstated), *blocks]


def _tell_motion(motion: str) -> str:
    if not motion:
        return ""
    return (
        f" It is that of the rig and of the motion: {motion}. The motion's grows from the first "
        "frame on, and a length feels only what its two ends do not share."
    )


def _at(part: Quantiles | None, share: str) -> float | None:
    value = None if part is None else getattr(part, share)
    return None if value is None else 1e3 * value


def _at_95(part: Quantiles | None) -> list[float | None]:
    values = [_at(part, share) for share in ("median", "high")]
    return [None if value is None else AT_95 * value for value in values]


def _figures(spread: Quantiles, scale: float) -> list[float | None]:
    values = (spread.smallest, spread.low, spread.median, spread.high, spread.largest)
    return [None if value is None else scale * value for value in values]


def _skips(summary: ScanSummary) -> list[Block]:
    skips = summary.recorded.skips
    blocks: list[Block] = [Table(skips[:_SKIPS_SHOWN], head=("frame", "frames", "reason"))]
    if len(skips) > _SKIPS_SHOWN:
        rest = format_cell(len(skips) - _SKIPS_SHOWN)
        blocks.append(Note(f"And {rest} more, listed in report.json."))
    return blocks
