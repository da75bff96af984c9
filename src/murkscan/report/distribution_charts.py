"""How signal and uncertainty are spread over the points."""

from typing import TYPE_CHECKING

from ..page import ACCENT, Figure, as_svg, new_figure
from .histogram import Histogram

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def signal_distribution(signals: Histogram) -> Figure:
    """Draw how the signal is spread over the points."""
    return _draw(signals, "signal-spread", "signal [grey levels]", scale=1.0, is_ratio=False)


def sigma_distribution(sigmas: Histogram) -> Figure:
    """Draw how the standard deviation along the ray is spread over the points."""
    label = "standard deviation along the ray [mm]"
    return _draw(sigmas, "sigma-spread", label, scale=1e3, is_ratio=True)


def _draw(histogram: Histogram, name: str, label: str, *, scale: float, is_ratio: bool) -> Figure:
    figure, axes = new_figure()
    axes.stairs(
        100 * histogram.shares, scale * histogram.edges, fill=True, color=ACCENT, alpha=0.55
    )
    if is_ratio:
        axes.set_xscale("log")
        _label_plainly(axes)
    axes.set(xlabel=label, ylabel="points [%]")
    axes.set_ylim(bottom=0)
    title = f"Points by their {label.split(' [')[0]}"
    beyond = histogram.below + histogram.above
    caption = f"{title}{f'; {beyond:.1%} lie outside' if beyond > 0 else ''}."
    return Figure(as_svg(figure, name=name, title=title), caption)


def _label_plainly(axes: "Axes") -> None:
    """Write 0.05 and 0.1, not powers of ten, which few read."""
    from matplotlib.ticker import FuncFormatter, LogLocator

    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(FuncFormatter(lambda value, _: ""))
