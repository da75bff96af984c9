"""The page that shows a calibration: what was seen, what is left over, and what it is worth."""

from collections.abc import Sequence
from dataclasses import dataclass

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
from .adjust import Adjustment
from .coverage import cover
from .limits import as_read, most_influential, strongest_pairs, value_of
from .reach import point_sigma, reach_of, shape_sigma
from .sighting import Sighting
from .verdict import CalibrationVerdict

_PICTURES = 8
"""Photos shown on the page, those that fit worst first."""
_GAIN = 40
"""How much longer than they are residuals are drawn."""


@dataclass(frozen=True, eq=False)
class Story:
    """What a page tells of one calibration."""

    title: str
    found: Adjustment
    sightings: tuple[Sighting, ...]
    """The photos used."""
    verdict: CalibrationVerdict
    without_board: tuple[str, ...]
    """Names of photos in which the board was not found."""
    laser: int | None = None
    """Number of the laser, where the calibration was one of a laser."""


def write_story(story: Story, *, suffix: str) -> str:
    """Make the page, which lies beside the drawings of the photos.

    Args:
        story: What to tell.
        suffix: What follows a photo's name in the name of its drawing.
    """
    notes = [Note(sentence, "warning") for sentence in story.verdict.advice]
    notes = notes or [Note(story.verdict.praise, "good")]
    sections = [
        Section("", [*notes, _facts(story)]),
        Section("What was seen", [_coverage_figure(story), _reach_figure(story)]),
        Section("Parameters", [_parameters(story), *_correlations(story)]),
        Section("What that means where you measure", [_spreads(story)]),
        Section("Photos", [Gallery(_pictures(story, suffix))]),
    ]
    return render_page(story.title, sections, subtitle=f"{len(story.sightings)} photos used")


def _facts(story: Story) -> Facts:
    found = story.found
    corners = np.concatenate([s.corners for s in story.sightings])
    items = [
        (f"{found.corner_sigma:.3f} px", "noise of a corner, 1σ"),
        (f"{cover(corners, found.rig.camera.size).share:.0%}", "of the picture covered by corners"),
        (f"× {np.sqrt(found.worth.dispersion):.1f}", "disagreement of photos beyond that noise"),
        (str(len(story.without_board)), "photos without a whole board"),
    ]
    if story.laser is not None:
        items.insert(1, (f"{found.stripe_sigma:.3f} px", "noise of a stripe point, 1σ"))
    return Facts(items)


def _coverage_figure(story: Story) -> Figure:
    figure, axes = new_figure(width=4.8, height=3.2)
    width, height = story.found.rig.camera.size
    for sighting, residuals in zip(story.sightings, story.found.corner_residuals, strict=True):
        ends = sighting.corners + _GAIN * residuals
        axes.plot(
            np.stack([sighting.corners[:, 0], ends[:, 0]]),
            np.stack([sighting.corners[:, 1], ends[:, 1]]),
            color=ACCENT, linewidth=0.8,
        )  # fmt: skip
        if len(sighting.stripe):
            axes.plot(*sighting.stripe.T, ".", color=SECOND, markersize=1)
    axes.set(xlim=(0, width), ylim=(height, 0), xlabel="u [px]", ylabel="v [px]", aspect="equal")
    svg = as_svg(figure, name="coverage", title="Corners and their residuals over the picture")
    stripes = "; stripe points in the second colour" if story.laser is not None else ""
    return Figure(
        svg, f"Corners of all photos with their residuals, {_GAIN} times too long{stripes}."
    )


def _reach_figure(story: Story) -> Figure:
    figure, axes = new_figure(width=4.8, height=2.4)
    depths = [
        (pose @ s.points.mean(axis=0)[None])[0, 2] * 1e3
        for pose, s in zip(story.found.camera_from_boards, story.sightings, strict=True)
    ]
    rms = [np.sqrt(np.mean(np.sum(r**2, axis=1))) for r in story.found.corner_residuals]
    axes.plot(depths, rms, "o", color=ACCENT, markersize=4)
    axes.set(xlabel="distance of the board z [mm]", ylabel="RMS [px]", ylim=(0, None))
    svg = as_svg(figure, name="reach", title="Residuals of each photo over the board's distance")
    return Figure(svg, "Each photo's RMS over the distance of its board.")


def _parameters(story: Story) -> Table:
    found = story.found
    sigma = found.rig.covariance.select(found.names).sigma
    rows = [
        (name, value_of(found.rig, name), as_read(name, float(s)), f"{max(share, 0.0):.0%}")
        for name, s, share in zip(found.names, sigma, found.worth.from_photos, strict=True)
    ]
    return Table(rows, head=("parameter", "value", "± 1σ", "told by these photos"))


def _correlations(story: Story) -> list[Note]:
    found = story.found
    pairs = [
        Note(f"{p.first} and {p.second} go together: correlation {p.correlation:+.3f}.")
        for p in strongest_pairs(found.rig.covariance)
    ]
    return [*pairs, Note(most_influential(found, [s.name for s in story.sightings]))]


def _spreads(story: Story) -> Table:
    rig = story.found.rig
    depths = reach_of(story.found.camera_from_boards, story.sightings)
    words = [f"{name}, {depth * 1e3:.0f} mm" for name, depth in zip(
        ("near", "middle", "far"), depths, strict=True)]  # fmt: skip
    if story.laser is None:
        rows = [(w, _millimetres(shape_sigma(rig, z))) for w, z in zip(words, depths, strict=True)]
        return Table(rows, head=("distance", "a point of a flat shape, ± 1σ"))
    rows = [
        (w, _millimetres(point_sigma(rig, story.laser, z)))
        for w, z in zip(words, depths, strict=True)
    ]
    return Table(rows, head=("distance", "a measured point, common part, ± 1σ"))


def _millimetres(sigma: float) -> str | None:
    return f"{sigma * 1e3:.3f} mm" if np.isfinite(sigma) else None


def _pictures(story: Story, suffix: str) -> Sequence[Picture]:
    rms = [float(np.sqrt(np.mean(np.sum(r**2, axis=1)))) for r in story.found.corner_residuals]
    order = np.argsort(rms)[::-1][:_PICTURES]
    return [
        Picture(f"{story.sightings[i].name}{suffix}", f"{story.sightings[i].name}: {rms[i]:.2f} px")
        for i in order
    ]
