"""The figures of a plan."""

import numpy as np

from ..page import ACCENT, INK, SECOND, Figure, as_svg, new_figure
from .forecast import Forecast


def sigma_chart(seen: Forecast) -> Figure:
    """Draw σ of a point along and across its ray against the distance."""
    figure, axes = new_figure()
    along, across = seen.median(seen.sigma_along), seen.median(seen.sigma_across)
    axes.plot(seen.depths, 1e3 * along, color=ACCENT, label="noise, along the ray")
    speckle = 1e3 * seen.median(seen.sigma_speckle)
    axes.plot(seen.depths, speckle, color=ACCENT, linestyle="--", label="speckle, along the ray")
    axes.plot(seen.depths, 1e3 * across, color=SECOND, label="across the ray")
    common = seen.median(seen.sigma_common)
    if np.nanmax(common, initial=0.0) > 0:
        axes.plot(seen.depths, 1e3 * common, color=INK, linestyle=":", label="common")
    axes.set(xlabel="distance [m]", ylabel="σ [mm]", yscale="log")
    axes.legend()
    title = "Standard deviation of a point against the distance"
    return Figure(as_svg(figure, name="sigma", title=title), f"{title}, where it is found.")


def bound_chart(seen: Forecast) -> Figure:
    """Draw the shares in view and found against the distance."""
    figure, axes = new_figure()
    shares = 100 * seen.share_found * seen.share_in_view
    axes.fill_between(seen.depths, shares, color=ACCENT, alpha=0.22, linewidth=0)
    axes.plot(seen.depths, shares, color=ACCENT)
    axes.plot(seen.depths, 100 * seen.share_in_view, color=SECOND, linestyle="--")
    lit = np.flatnonzero(seen.share_in_view > 0)
    if len(lit):
        axes.set_xlim(0, min(seen.depths[-1], 1.6 * seen.reach[1]))
    axes.set(xlabel="distance [m]", ylabel="points [%]", ylim=(0, 104))
    title = "Share of the points that are found against the distance"
    return Figure(
        as_svg(figure, name="share", title=title),
        f"{title}; dashed: that lie in the picture.",
    )
