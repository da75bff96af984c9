"""The page that shows a calibration: what was seen, what is left over, and what it is worth."""

from collections.abc import Mapping

import numpy as np

from ..page import (
    ACCENT,
    SECOND,
    Facts,
    Figure,
    Gallery,
    Note,
    Picture,
    Section,
    Table,
    as_svg,
    new_figure,
    render_page,
)
from .board.coverage import cover
from .calibration import Calibration
from .verdict import CalibrationVerdict
from .words import MEANING, as_read, describe, most_influential, strongest_pairs, value_of

_PICTURES = 8
"""Photos shown on the page, those that fit worst first."""
_GAIN = 40
"""How much longer than they are residuals are drawn."""


def write_page(
    calibration: Calibration,
    verdict: CalibrationVerdict,
    unused: Mapping[str, str],
    *,
    title: str,
    suffix: str,
) -> str:
    """Make the page of any calibration, which lies beside the drawings of the photos.

    Args:
        calibration: What was found.
        verdict: What that is worth.
        unused: Photos that were not used, and why.
        title: What was calibrated.
        suffix: What follows a photo's name in the name of its drawing.
    """
    notes = [Note(sentence, "warning") for sentence in verdict.advice]
    notes = notes or [Note(verdict.praise, "good")]
    sections = [
        Section("", [*notes, _facts(calibration, unused)]),
        Section("What that means where you measure", [_errors(verdict), Note(MEANING)]),
        Section("What was seen", [_coverage_figure(calibration), _reach_figure(calibration)]),
        Section("Parameters", [_parameters(calibration), *_correlations(calibration)]),
        Section("Photos used", [Gallery(_pictures(calibration, suffix))]),
    ]
    if unused:
        rows = [(name, reason) for name, reason in unused.items()]
        sections.append(Section("Photos not used", [Table(rows, head=("photo", "reason"))]))
    return render_page(title, sections, subtitle=f"{len(calibration.sightings)} photos used")


def _facts(calibration: Calibration, unused: Mapping[str, str]) -> Facts:
    found = calibration.adjustment
    share = cover(calibration.corners, found.rig.camera.size).share
    items = [
        (f"{found.corner_sigma:.3f} px", "noise of a corner, 1σ"),
        (f"{share:.0%}", "of the picture covered by corners"),
        (f"× {np.sqrt(found.worth.dispersion):.1f}", "disagreement of photos beyond that noise"),
        (str(len(unused)), "photos not used"),
    ]
    if calibration.lasers:
        items.insert(1, (f"{found.stripe_sigma:.3f} px", "noise of a stripe point, 1σ"))
    return Facts(items)


def _errors(verdict: CalibrationVerdict) -> Table:
    rows = [
        (error.what, f"{error.depth * 1e3:.0f} mm", f"{error.sigma * 1e3:.3f} mm")
        for error in verdict.errors
        if np.isfinite(error.sigma)
    ]
    return Table(rows, head=("where boards were seen", "distance", "± 1σ, common part"))


def _coverage_figure(calibration: Calibration) -> Figure:
    figure, axes = new_figure(width=4.8, height=3.2)
    found = calibration.adjustment
    width, height = found.rig.camera.size
    corners = np.concatenate([sighting.corners for sighting in calibration.sightings])
    ends = corners + _GAIN * np.concatenate(found.corner_residuals)
    # One line with gaps: to draw a thousand takes half a second.
    lines = np.stack([corners, ends, np.full_like(corners, np.nan)], axis=1).reshape(-1, 2)
    axes.plot(*lines.T, color=ACCENT, linewidth=0.8)
    points = np.concatenate([sighting.stripe for sighting in calibration.sightings])
    axes.plot(*points.T, ".", color=SECOND, markersize=1)
    axes.set(xlim=(0, width), ylim=(height, 0), xlabel="u [px]", ylabel="v [px]", aspect="equal")
    svg = as_svg(figure, name="coverage", title="Corners and their residuals over the picture")
    stripes = "; stripe points in the second colour" if calibration.lasers else ""
    return Figure(
        svg, f"Corners of all photos with their residuals, {_GAIN} times too long{stripes}."
    )


def _reach_figure(calibration: Calibration) -> Figure:
    figure, axes = new_figure(width=4.8, height=2.4)
    depths = [depth * 1e3 for depth in calibration.depths]
    axes.plot(depths, calibration.adjustment.view_rms, "o", color=ACCENT, markersize=4)
    axes.set(xlabel="distance of the board z [mm]", ylabel="RMS [px]", ylim=(0, None))
    svg = as_svg(figure, name="reach", title="Residuals of each photo over the board's distance")
    return Figure(svg, "Each photo's RMS over the distance of its board.")


def _parameters(calibration: Calibration) -> Table:
    found = calibration.adjustment
    rows = [
        (describe(found.rig, name), value_of(found.rig, name), as_read(name, float(s)),
         f"{max(share, 0.0):.0%}")
        for name, s, share in zip(found.names, found.sigma, found.worth.from_photos, strict=True)
    ]  # fmt: skip
    return Table(rows, head=("parameter", "value", "± 1σ", "told by these photos"))


def _correlations(calibration: Calibration) -> list[Note]:
    found = calibration.adjustment
    names = [sighting.name for sighting in calibration.sightings]
    return [*map(Note, strongest_pairs(found.rig)), Note(most_influential(found, names))]


def _pictures(calibration: Calibration, suffix: str) -> list[Picture]:
    rms = calibration.adjustment.view_rms
    order = np.argsort(rms)[::-1][:_PICTURES]
    names = [sighting.name for sighting in calibration.sightings]
    return [Picture(f"{names[i]}{suffix}", f"{names[i]}: {rms[i]:.2f} px") for i in order]
