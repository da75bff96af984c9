"""The elevation of a wall as a picture to scale, with its sections and anomalies."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..types.arrays import ColourImage
from .deflection import Deflection
from .wall_map import Anomaly, WallMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.image import AxesImage

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

    sheet = _Sheet.of(wall, len(curves))
    figure = Figure(figsize=(sheet.size[0] / _INCH, sheet.size[1] / _INCH), dpi=_DPI)
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes(sheet.panel(_MARGIN[0] / 2, sheet.map[0]))
    colours = figure.add_axes(sheet.panel(_MARGIN[0] * 0.65 + sheet.map[0], 0.004))
    figure.colorbar(_draw_map(axes, wall), cax=colours, label="out of the wall [mm]")
    for number, one in enumerate(anomalies, 1):
        _box(axes, number, one)
    for number, curve in enumerate(curves):
        axes.axvline(curve.along, color=_INK, linewidth=0.6, linestyle="--")
        start = 2 * _MARGIN[0] + sheet.map[0] + number * _CURVES
        beside = figure.add_axes(sheet.panel(start, 0.75 * _CURVES))
        _draw_curve(beside, curve, axes.get_ylim())
        beside.tick_params(labelsize=7, labelleft=number == 0)
    title = f"{title}, 1 : {sheet.scale} at {_DPI} dots an inch"
    figure.suptitle(title, size=11, color=_INK)
    return _as_picture(canvas), sheet.scale


def _as_picture(canvas: "FigureCanvasAgg") -> ColourImage:
    canvas.draw()  # type: ignore[no-untyped-call]
    picture = np.asarray(canvas.buffer_rgba())[..., :3]  # type: ignore[no-untyped-call]
    return np.ascontiguousarray(picture)


def draw_anomaly(wall: WallMap, anomaly: Anomaly, number: int, *, title: str) -> ColourImage:
    """Draw the map around an anomaly, boxed and numbered.

    Args:
        wall: The whole map.
        anomaly: What is shown.
        number: Of the anomaly.
        title: What stands above.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.0, 4.0), dpi=_DPI, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    figure.colorbar(_draw_map(axes, wall.around(anomaly)), ax=axes, label="out of the wall [mm]")
    _box(axes, number, anomaly)
    figure.suptitle(title, size=11, color=_INK)
    return _as_picture(canvas)


@dataclass(frozen=True)
class _Sheet:
    """How a wall and its curves are laid out on paper."""

    scale: int
    """Denominator of the map's scale."""
    map: tuple[float, float]
    """Width and height of the map [m]."""
    size: tuple[float, float]
    """Of the whole [m]."""

    @classmethod
    def of(cls, wall: WallMap, num_curves: int) -> "_Sheet":
        height, width = (count * wall.cell for count in wall.values.shape)
        scale = _round_up(max(width / _SHEET[0], height / _SHEET[1], 1e-3))
        drawn = (max(width / scale, 0.03), max(height / scale, 0.05))
        whole = (drawn[0] + 3 * _MARGIN[0] + num_curves * _CURVES, drawn[1] + 2 * _MARGIN[1])
        return cls(scale, drawn, whole)

    def panel(self, left: float, width: float) -> tuple[float, float, float, float]:
        """Give where a panel of the map's height lies, in shares of the whole."""
        low, height = _MARGIN[1] / self.size[1], self.map[1] / self.size[1]
        return left / self.size[0], low, width / self.size[0], height


def _draw_map(axes: "Axes", wall: WallMap) -> "AxesImage":
    """Draw the wall in colours that all but the last percents of the cells lie within."""
    height, width = (count * wall.cell for count in wall.values.shape)
    left, low = wall.low
    known = 1e3 * wall.values[np.isfinite(wall.values)]
    reach = max(float(np.abs(np.percentile(known, [_SHARE, 100 - _SHARE])).max()), 0.5)
    axes.set_xlabel("along [m]")
    axes.set_ylabel("height [m]")
    return axes.imshow(
        1e3 * wall.values, cmap="RdBu_r", vmin=-reach, vmax=reach, origin="lower",
        extent=(left, left + width, low, low + height), interpolation="nearest",
    )  # fmt: skip


def _box(axes: "Axes", number: int, anomaly: Anomaly) -> None:
    """Draw a box around an anomaly, with its number."""
    from matplotlib.patches import Rectangle

    corner = (anomaly.along - anomaly.width / 2, anomaly.height - anomaly.rise / 2)
    axes.add_patch(Rectangle(corner, anomaly.width, anomaly.rise, fill=False, edgecolor=_MARK))
    middle = (anomaly.along, anomaly.height)
    axes.annotate(str(number), middle, color=_MARK, ha="center", va="center")


def _draw_curve(axes: "Axes", curve: Deflection, heights: tuple[float, float]) -> None:
    """Draw a section's deflection beside the map, at the map's own heights."""
    half = curve.half_width
    edges = 1e3 * (curve.distance - half), 1e3 * (curve.distance + half)
    axes.fill_betweenx(curve.height, *edges, color=_CURVE, alpha=0.3, linewidth=0)
    axes.plot(1e3 * curve.distance, curve.height, color=_CURVE, linewidth=0.8)
    axes.set_ylim(*heights)
    axes.set_title(f"at {curve.along:.2f} m", size=8, color=_INK)
    axes.set_xlabel("[mm]", size=8)
    axes.grid(alpha=0.3)


def _round_up(number: float) -> int:
    """Give the next larger one of 1, 2, 5, 10 and so on."""
    power = 10 ** int(np.floor(np.log10(max(number, 1.0))))
    return int(next(step * power for step in (1, 2, 5, 10) if step * power >= number - 1e-9))
