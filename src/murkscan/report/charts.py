"""The figures of a report."""

from typing import TYPE_CHECKING

import numpy as np

from ..page import ACCENT, Figure, as_svg, new_figure
from .timeline import Quantiles, Timeline

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def signal_chart(timeline: Timeline, *, time_label: str) -> Figure:
    """Draw the signal over time."""
    caption = "Height of the stripe above its surroundings: median and 90 % of each frame's points."
    return _band(
        timeline,
        timeline.signal,
        "signal",
        labels=(time_label, "signal [grey levels]"),
        caption=caption,
    )


def depth_chart(timeline: Timeline, *, time_label: str) -> Figure:
    """Draw the distance of the surface over time."""
    caption = (
        "Distance of the surface in front of the camera (z): median and 90 % of each frame's "
        "points."
    )
    return _band(
        timeline,
        1e3 * timeline.depth,
        "depth",
        labels=(time_label, "depth z [mm]"),
        caption=caption,
    )


def points_chart(timeline: Timeline, *, time_label: str) -> Figure:
    """Draw the number of points a frame over time."""
    figure, axes = new_figure()
    axes.fill_between(timeline.time, timeline.points, color=ACCENT, alpha=0.22, linewidth=0)
    axes.plot(timeline.time, timeline.points, color=ACCENT)
    axes.set(xlabel=time_label, ylabel="points a frame")
    axes.set_ylim(bottom=0)
    _span_all(axes, timeline)
    title = "Points a frame over time"
    return Figure(as_svg(figure, name="points", title=title), f"{title}; 0 where none was found.")


def _band(
    timeline: Timeline, values: Quantiles, name: str, *, labels: tuple[str, str], caption: str
) -> Figure:
    """Draw a median in the band of its 5 % and 95 %; gaps where there is nothing."""
    low, median, high = values.T
    figure, axes = new_figure()
    axes.fill_between(timeline.time, low, high, color=ACCENT, alpha=0.22, linewidth=0)
    # A point shows a median whose neighbours are missing, which a line cannot.
    axes.plot(timeline.time, median, color=ACCENT, marker="." if _has_gaps(median) else "")
    axes.set(xlabel=labels[0], ylabel=labels[1])
    _span_all(axes, timeline)
    return Figure(as_svg(figure, name=name, title=caption), caption)


def _span_all(axes: "Axes", timeline: Timeline) -> None:
    """Give all figures the same time axis, so that they can be read together."""
    first, last = float(timeline.time[0]), float(timeline.time[-1])
    axes.set_xlim(first, last if last > first else first + 1)


def _has_gaps(values: np.ndarray) -> bool:
    """Tell whether a value stands alone between missing ones."""
    finite = np.concatenate([[False], np.isfinite(values), [False]])
    return bool(np.any(finite[1:-1] & ~finite[:-2] & ~finite[2:]))
