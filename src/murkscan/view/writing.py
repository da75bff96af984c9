"""What is written on a picture: its name, a scale bar, a colour bar, the axes."""

import math
from typing import TYPE_CHECKING

import numpy as np

from ..types.arrays import ColourImage
from .base import Legend
from .views import View
from .window import SAMPLES, Window

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_INK = "#202428"
_AXES = {"x": "#c0392b", "y": "#2e7d32", "z": "#1f5fa8"}
_TEXT = 1 / 38
"""Height of the letters, in heights of the picture."""
_LONGEST_BAR = 0.25
"""Length of the scale bar, in widths of the picture, that is not exceeded."""
_DPI = 100


def write_on(image: ColourImage, view: View, window: Window, legend: Legend | None) -> ColourImage:
    """Write the view's name, a scale bar, the world's axes and, with a legend, a colour bar.

    Args:
        image: The picture, of the window's size.
        view: From where it is taken.
        window: Its scale.
        legend: What its colours mean.

    Returns:
        The picture with the writing on it.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    width, height = window.size
    figure = Figure(figsize=(width / _DPI, height / _DPI), dpi=_DPI, frameon=False)
    points = height * _TEXT * 72 / _DPI
    figure.text(0.02, 0.975, view.name, va="top", size=1.2 * points, color=_INK)
    _write_scale(figure, window, points)
    _write_axes(figure, view, window, points)
    if legend is not None:
        _write_colours(figure, legend, points)
    canvas = FigureCanvasAgg(figure)
    renderer = canvas.get_renderer()  # type: ignore[no-untyped-call]
    paper = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
    # Laid under the writing as it is: a picture that the figure draws is resampled first.
    paper[..., :3], paper[..., 3] = image, 255
    figure.draw(renderer)
    return np.ascontiguousarray(paper[..., :3])


def _write_scale(figure: "Figure", window: Window, points: float) -> None:
    from matplotlib.lines import Line2D

    width, _ = window.size
    pixels_a_metre = window.scale / SAMPLES
    length = round_down(_LONGEST_BAR * width / pixels_a_metre)
    left, right, y, tick = 0.04, 0.04 + length * pixels_a_metre / width, 0.045, 0.012
    for xs, ys in (
        ((left, right), (y, y)),
        ((left, left), (y - tick, y + tick)),
        ((right, right), (y - tick, y + tick)),
    ):
        figure.add_artist(Line2D(xs, ys, color=_INK, linewidth=points / 7, solid_capstyle="butt"))
    text = f"{length:g} m" if length >= 1 else f"{length * 1e3:g} mm"
    figure.text((left + right) / 2, y + tick, text, ha="center", va="bottom", size=points)


def round_down(value: float) -> float:
    """Give the largest of 1, 2 and 5 times a power of ten that is not above a value."""
    power = 10.0 ** math.floor(math.log10(value))
    # The rounding error of the quotient must not turn 5 into 2.
    step = max(s for s in (1, 2, 5) if s <= value / power * (1 + 1e-9))
    return float(f"{step * power:.1g}")


def _write_axes(figure: "Figure", view: View, window: Window, points: float) -> None:
    """Draw the world's axes as the view shows them; one that points at the viewer is a dot."""
    from matplotlib.lines import Line2D

    width, height = window.size
    length = 1.35 * _TEXT * height
    middle = np.array([width - 3.6 * length, 2.0 * length])
    for name, axis in zip("xyz", view.view_from_world.T, strict=True):
        step = np.array([axis[0], -axis[1]]) * length
        if np.hypot(*step) < 0.1 * length:
            continue
        start, end, letter = (
            (middle + share * step) / (width, height) for share in (0.0, 1.0, 1.45)
        )
        line = Line2D(*np.stack([start, end], axis=1), color=_AXES[name], linewidth=points / 7)
        figure.add_artist(line)
        figure.text(
            letter[0], letter[1], name, color=_AXES[name], size=points, ha="center", va="center"
        )


def _write_colours(figure: "Figure", legend: Legend, points: float) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    axes = figure.add_axes((0.875, 0.27, 0.022, 0.58))
    colours = ScalarMappable(Normalize(legend.low, legend.high), legend.colour_map)
    bar = figure.colorbar(colours, cax=axes)
    if legend.top == "low":
        bar.ax.invert_yaxis()
    bar.ax.tick_params(labelsize=0.9 * points, colors=_INK, width=1.5, length=6)
    bar.ax.ticklabel_format(useOffset=False)
    bar.outline.set_visible(False)
    figure.text(0.875, 0.875, legend.label, size=points, color=_INK, va="bottom", ha="left")
