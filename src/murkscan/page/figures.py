"""Figures in one style, as SVG that follows the page's theme.

matplotlib draws them and costs a second to import, so it is imported when the first is drawn.
"""

import io
import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK = "#010101"
"""Text and axes. These colours stand for the page's own: `as_svg` puts those in their place."""
FAINT = "#010102"
"""Grid lines."""
ACCENT = "#010103"
"""The first thing shown."""
SECOND = "#010104"
"""The second thing shown."""
_THEME = {INK: "--muted", FAINT: "--line", ACCENT: "--accent", SECOND: "--second"}

_STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "murkscan",
    "font.family": "sans-serif",
    "font.size": 10,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": FAINT,
    "axes.facecolor": "none",
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": "cycler('color', ['#010103', '#010104'])",
    "figure.facecolor": "none",
    "grid.color": FAINT,
    "grid.linewidth": 0.8,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
    "legend.frameon": False,
    "lines.linewidth": 1.6,
    "lines.solid_joinstyle": "round",
}


def new_figure(*, width: float = 4.8, height: float = 2.5) -> "tuple[Figure, Axes]":
    """Make an empty figure with one pair of axes, in the house style.

    Args:
        width: Width [inch]; the page scales the figure, at this width its text is 10 point high.
        height: Height [inch].
    """
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(_STYLE):
        figure = Figure(figsize=(width, height), layout="constrained")
        return figure, figure.add_subplot()


def as_svg(figure: "Figure", *, name: str, title: str) -> str:
    """Give a figure as an `<svg>` element to stand in a page.

    Args:
        figure: A figure of `new_figure`.
        name: A word that no other figure of the page has; it keeps their parts apart.
        title: What the figure shows, for those who cannot see it.

    Returns:
        The element; the same figure gives the same text.
    """
    import matplotlib as mpl

    buffer = io.StringIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    with mpl.rc_context(_STYLE):
        figure.savefig(buffer, format="svg", metadata=nothing)
    svg = buffer.getvalue()
    svg = svg[svg.index("<svg") :].rstrip()
    svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
    svg = re.sub(r'\s+xmlns(:\w+)?="[^"]*"', "", svg).replace("xlink:href", "href")
    svg = re.sub(r'(\bid="|url\(#|href="#)', rf"\g<1>{name}-", svg)
    # Fixed measures in points would not let the page scale the figure.
    svg = re.sub(r'<svg[^>]*?(viewBox="[^"]*")[^>]*>', r'<svg \1 role="img" {}>', svg, count=1)
    label = title.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    svg = svg.replace("{}", f'aria-label="{label}"', 1)
    for stand_in, variable in _THEME.items():
        svg = svg.replace(stand_in, f"var({variable})")
    return re.sub(r"font: ([\d.]+)px [^;\"]*", r"font: \1px var(--sans)", svg)
