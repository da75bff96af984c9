"""Sections as drawings in SVG, in true size, with a scale bar."""

import math
from collections.abc import Sequence
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np

from .text import save_text

_MARGIN = 0.06
"""Border around the drawing, in its larger side."""
_LONGEST_BAR = 0.3
"""Length of the scale bar, in widths of the drawing, that is not exceeded."""


def save_section_svg(path: Path, drawing: Sequence[np.ndarray], *, title: str) -> None:
    """Write a section's lines in millimetres: printed at 100 % they have their true size.

    Args:
        path: Where the file shall be.
        drawing: Each line in the drawing's x (right) and y (up) [m]; n 2 each.
        title: What is written below.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    flat = np.concatenate(drawing) * 1e3
    low, high = flat.min(axis=0), flat.max(axis=0)
    size = float(max(np.max(high - low), 1e-3))
    border, text = _MARGIN * size, 0.03 * size
    left, right = float(low[0]) - border, float(high[0]) + border
    top, bottom = -float(high[1]) - border, -float(low[1]) + border + 4 * text
    paths = "\n".join(f'<path d="{_as_path(line * 1e3)}"/>' for line in drawing)
    width, height = right - left, bottom - top
    bar = _round_down(_LONGEST_BAR * width)
    words = f'font-family="sans-serif" font-size="{text:.4g}" fill="#202428"'
    y = bottom - border / 2
    save_text(
        path,
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.3f}mm" height="{height:.3f}mm" '
        f'viewBox="{left:.3f} {top:.3f} {width:.3f} {height:.3f}">\n'
        f"<title>{escape(title)}</title>\n"
        f'<rect x="{left:.3f}" y="{top:.3f}" width="{width:.3f}" height="{height:.3f}" '
        'fill="#ffffff"/>\n'
        f'<g fill="none" stroke="#1f5fa8" stroke-width="{0.003 * size:.4g}" '
        f'stroke-linejoin="round">\n{paths}\n</g>\n'
        f'<path d="M{left + border:.3f} {y:.3f}h{bar:g}" stroke="#202428" '
        f'stroke-width="{0.006 * size:.4g}"/>\n'
        f'<text x="{left + border:.3f}" y="{y - 0.5 * text:.3f}" {words}>{bar:g} mm</text>\n'
        f'<text x="{right - border:.3f}" y="{y:.3f}" text-anchor="end" {words}>{escape(title)}'
        "</text>\n</svg>\n",
    )


def _as_path(line: np.ndarray) -> str:
    """Give SVG's path of a line [mm]; its y points down."""
    is_closed = len(line) > 2 and np.array_equal(line[0], line[-1])
    corners = line[:-1] if is_closed else line
    return "M" + "L".join(f"{x:.4f} {-y:.4f}" for x, y in corners) + ("Z" if is_closed else "")


def _round_down(value: float) -> float:
    power = 10.0 ** math.floor(math.log10(value))
    return power * max(s for s in (1, 2, 5) if s <= value / power * (1 + 1e-9))
