"""The picture of what a scan has and what it misses."""

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from ..page import INK, Figure, as_svg, new_figure
from .coverage import Coverage

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FEW, _MANY = (0.80, 0.91, 0.86), (0.13, 0.53, 0.39)
"""Covered cells with few points and with as many as usual."""
_COLOURS = {
    "no_stripe": "#7b5ea7",
    "unreadable": "#4d4d4d",
    "too_fast": "#e69f00",
    "too_far": "#0072b2",
    "occluded": "#d1495b",
    "too_dark": "#6b4423",
    "far_or_dark": "#8cb8d9",
}
"""Told apart by those who see colours differently, and on white and on black."""
NAMES = {
    "no_stripe": "no stripe in the frame",
    "unreadable": "frame could not be read",
    "too_fast": "too fast: profiles too far apart",
    "too_far": "too far for this water and light",
    "occluded": "hidden by an edge, from the laser or from the camera",
    "too_dark": "no light came back from near enough: too dark, too steep, or nothing there",
    "far_or_dark": "no light came back: too far or too dark, which cannot be told here",
}
_WIDTH = 9.6
"""Width of the figure [inch]: over the page's whole width its text is as high as elsewhere."""
_LEAST, _MOST = 1.3, 6.5
"""Height of the map [inch]; what is longer or narrower is not drawn to scale."""
_SHORT = 50
"""Letters of a label of which two stand side by side under the map."""
_LONG = 4.0
"""Extent from which the axes count metres [m]."""


def coverage_chart(coverage: Coverage) -> Figure:
    """Draw the map: motion to the right, across it upwards."""
    rows, columns = coverage.points.shape
    height = (_WIDTH - 1.0) * rows / columns
    shown = float(np.clip(height, _LEAST, _MOST))
    figure, axes = new_figure(width=_WIDTH, height=shown + 1.25)
    figure.set_dpi(200)
    scale, unit = (1.0, "m") if max(rows, columns) * coverage.cell > _LONG else (1e3, "mm")
    left, low = (scale * place for place in coverage.corner)
    edge = scale * coverage.cell
    axes.imshow(
        _paint(coverage),
        origin="lower",
        extent=(left, left + columns * edge, low, low + rows * edge),
        interpolation="nearest",
        zorder=1,
        aspect="equal" if height == shown or shown == _MOST else "auto",
    )
    axes.set(xlabel=f"along the motion [{unit}]", ylabel=f"across [{unit}]")
    axes.spines[["top", "right"]].set_visible(True)
    _add_legend(coverage, axes)
    title = f"Coverage, in cells of {1e3 * coverage.cell:.3g} mm, as seen from the scanner."
    stretched = "" if height >= _LEAST else " Across is stretched."
    caption = (
        f"{title}{stretched} Green is covered, the darker the more points; a cell has the colour "
        "of what most of it is; where it is empty, no profile says that there is a surface."
    )
    return Figure(as_svg(figure, name="coverage", title=title), caption, is_wide=True)


def _paint(coverage: Coverage) -> Float[np.ndarray, "h w 4"]:
    state = coverage.state()
    covered = coverage.points[state == 0]
    usual = np.median(covered[covered > 0]) if np.any(covered > 0) else 1.0
    share = np.clip(coverage.points / usual, 0, 1)[..., None]
    picture = np.zeros((*state.shape, 4))
    picture[..., :3] = (1 - share) * np.array(_FEW) + share * np.array(_MANY)
    picture[..., 3] = state >= 0
    for number, colour in enumerate(_COLOURS.values(), start=1):
        rgb = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
        picture[state == number, :3] = rgb
    return picture


def _add_legend(coverage: Coverage, axes: "Axes") -> None:
    from matplotlib.patches import Patch

    patches = [Patch(color=_MANY, label="covered")]
    patches += [
        Patch(color=_COLOURS[cause], label=NAMES[cause])
        for cause, area in coverage.missing.items()
        if area > 0
    ]
    axes.figure.legend(
        handles=patches,
        loc="outside lower left",
        ncols=1 if any(len(str(patch.get_label())) > _SHORT for patch in patches) else 2,
        labelcolor=INK,
        frameon=False,
        handlelength=1.0,
        handleheight=1.0,
    )
