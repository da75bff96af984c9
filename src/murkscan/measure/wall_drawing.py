"""The elevation of a wall as a picture to scale, with its sections and anomalies."""

from collections.abc import Sequence

import numpy as np

from ..types.arrays import ColourImage
from .deflection import Deflection
from .wall_map import Anomaly, WallMap

_INK, _MARK, _CURVE = "#202428", "#7b3294", "#2166ac"
_DPI = 150
_INCH = 0.0254
_SHEET = (0.36, 0.24)
"""Largest width and height of the wall on paper [m]."""
_MARGIN = (0.05, 0.035)
"""Room for axes and colours on paper, beside and below [m]."""
_CURVES = 0.055
"""Width on paper of a curve's panel [m]."""
_SHARE = 2.0
"""Percent of the cells at each end that may lie beyond the colours."""


def draw_wall(
    wall: WallMap, curves: Sequence[Deflection], anomalies: Sequence[Anomaly], *, title: str
) -> tuple[ColourImage, int]:
    """Draw the map, and beside it each section's curve with its 95 % interval.

    Args:
        wall: The map.
        curves: The sections, in order along the wall.
        anomalies: What is boxed and numbered.
        title: What stands above.

    Returns:
        The picture, and the denominator of the map's scale where it is printed at 150 dots an inch.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    height, width = (count * wall.cell for count in wall.values.shape)
    scale = _round_up(max(width / _SHEET[0], height / _SHEET[1], 1e-3))
    on_paper = (max(width / scale, 0.03), max(height / scale, 0.05))
    full = (on_paper[0] + 3 * _MARGIN[0] + len(curves) * _CURVES, on_paper[1] + 2 * _MARGIN[1])
    figure = Figure(figsize=(full[0] / _INCH, full[1] / _INCH), dpi=_DPI)
    canvas = FigureCanvasAgg(figure)

    def panel(left: float, wide: float) -> tuple[float, float, float, float]:
        return left / full[0], _MARGIN[1] / full[1], wide / full[0], on_paper[1] / full[1]

    axes = figure.add_axes(panel(_MARGIN[0] / 2, on_paper[0]))
    left, low = wall.low
    known = 1e3 * wall.values[np.isfinite(wall.values)]
    reach = max(float(np.abs(np.percentile(known, [_SHARE, 100 - _SHARE])).max()), 0.5)
    shown = axes.imshow(
        1e3 * wall.values, cmap="RdBu_r", vmin=-reach, vmax=reach, origin="lower",
        extent=(left, left + width, low, low + height), interpolation="nearest",
    )  # fmt: skip
    colours = figure.add_axes(panel(_MARGIN[0] * 0.65 + on_paper[0], 0.004))
    figure.colorbar(shown, cax=colours, label="out of the wall [mm]")
    for number, one in enumerate(anomalies, 1):
        corner = (one.along - one.width / 2, one.height - one.rise / 2)
        axes.add_patch(Rectangle(corner, one.width, one.rise, fill=False, edgecolor=_MARK))
        axes.annotate(str(number), (one.along, one.height), color=_MARK, ha="center", va="center")
    start = 2 * _MARGIN[0] + on_paper[0]
    for number, curve in enumerate(curves):
        axes.axvline(curve.along, color=_INK, linewidth=0.6, linestyle="--")
        beside = figure.add_axes(panel(start + number * _CURVES, 0.75 * _CURVES))
        half = curve.half_width
        edges = 1e3 * (curve.distance - half), 1e3 * (curve.distance + half)
        beside.fill_betweenx(curve.height, *edges, color=_CURVE, alpha=0.3, linewidth=0)
        beside.plot(1e3 * curve.distance, curve.height, color=_CURVE, linewidth=0.8)
        beside.set_ylim(low, low + height)
        beside.set_title(f"at {curve.along:.2f} m", size=8, color=_INK)
        beside.set_xlabel("[mm]", size=8)
        beside.tick_params(labelsize=7, labelleft=number == 0)
        beside.grid(alpha=0.3)
    axes.set_xlabel("along [m]")
    axes.set_ylabel("height [m]")
    figure.suptitle(f"{title}, 1 : {scale} at {_DPI} dots an inch", size=11, color=_INK)
    canvas.draw()  # type: ignore[no-untyped-call]
    picture = np.asarray(canvas.buffer_rgba())[..., :3]  # type: ignore[no-untyped-call]
    return np.ascontiguousarray(picture), scale


def _round_up(number: float) -> int:
    """Give the next larger one of 1, 2, 5, 10 and so on."""
    power = 10 ** int(np.floor(np.log10(max(number, 1.0))))
    return int(next(step * power for step in (1, 2, 5, 10) if step * power >= number - 1e-9))
