"""The distribution of deviations, as a picture."""

import numpy as np

from ..types.arrays import ColourImage, Scalars

_INK, _BEHIND, _BEFORE = "#202428", "#2166ac", "#b2182b"
_BINS = 80
_SHARE = 0.5
"""Percent of the values at each end that may lie beyond the picture."""


def draw_histogram(values: Scalars, *, title: str) -> ColourImage:
    """Draw how many points lie how far from the reference, with mean and middle 95 %.

    Args:
        values: Distances [m]; NaN is left out.
        title: What is compared.

    Returns:
        A picture of 1280 × 800 px.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    known = values[np.isfinite(values)] * 1e3
    low, high = np.percentile(known, [_SHARE, 100 - _SHARE])
    half = max(abs(low), abs(high), 0.05)
    counts, edges = np.histogram(known, _BINS, (-half, half))
    share = 100 * counts / len(known)
    figure = Figure(figsize=(12.8, 8), dpi=100, layout="constrained")
    canvas, axes = FigureCanvasAgg(figure), figure.add_subplot()
    colours = [_BEHIND if edge < 0 else _BEFORE for edge in (edges[:-1] + edges[1:]) / 2]
    axes.bar(edges[:-1], share, np.diff(edges), align="edge", color=colours, alpha=0.75)
    first, last = np.percentile(known, [2.5, 97.5])
    axes.axvspan(first, last, color=_INK, alpha=0.06, zorder=0)
    axes.axvline(float(known.mean()), color=_INK, linewidth=2)
    axes.set_xlim(-half, half)
    axes.set_xlabel("behind  ◀  deviation [mm]  ▶  standing out", size=18, color=_INK)
    axes.set_ylabel("points [%]", size=18, color=_INK)
    axes.tick_params(labelsize=15, colors=_INK)
    axes.spines[["top", "right"]].set_visible(False)
    words = (
        f"{title}\n{len(known):,} points · mean {known.mean():+.3f} mm · RMS "
        f"{np.sqrt(np.mean(known**2)):.3f} mm · 95 % from {first:+.3f} to {last:+.3f} mm"
    )
    axes.set_title(words, size=17, color=_INK, loc="left", pad=14)
    canvas.draw()  # type: ignore[no-untyped-call]
    return np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[..., :3])  # type: ignore[no-untyped-call]
