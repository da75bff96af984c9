"""What is true in a real recording: where the eye sees the line, and where finders agree on it.

Where the line lies, `real_truth.toml` says: it was drawn by hand, and there is nothing where it
says nothing. Where in its corridor a centre lies, two finders of other families than the one that
is judged say together; where they do not agree, it is the drawing itself.
"""

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from murkscan.types.stripe import Stripe

_TABLE = Path(__file__).with_name("real_truth.toml")
AGREE = 1.5
"""Distance up to which two finders agree, and a found centre is right [px]."""
DRAWN = 2.5
"""Distance from the drawing up to which a centre is right where no two finders agree [px]."""
_END = 3
"""Scan lines to either side of an end of the line that are not judged: the eye reads ends to a few,
and the picture's blur carries light over them."""
_CORRIDOR = 4.0
"""Distance from the drawing up to which an agreed centre is the drawn line's [px]."""
_FAMILIES = {
    "threshold-skeleton": "thinning",
    "gray-gravity": "mass",
    "maximum": "mass",
    "find-peaks": "mass",
    "oplab": "mass",
    "gaussian": "ridge",
    "steger": "ridge",
    "ridge-detector": "ridge",
    "murk": "chain",
}
_WITNESSES = {
    "mass": (("gaussian", "steger"), ("murk", "threshold-skeleton")),
    "ridge": (("gray-gravity",), ("murk", "threshold-skeleton")),
    "thinning": (("gray-gravity",), ("gaussian", "steger")),
    "chain": (("gray-gravity",), ("gaussian", "steger")),
}
"""For each family, the finders of which one on each side must agree."""

Lines = dict[tuple[int, int], list[float]]
"""Positions along each (frame, scan line) [px]."""
Spans = dict[tuple[int, int], list[tuple[float, float]]]
"""From where to where along each (frame, scan line) [px]."""


def as_rows(stripe: Stripe, axis: str) -> np.ndarray:
    """Give frame, scan line and position along it of each centre."""
    across, along = ("uv".index("v"), "uv".index("u")) if axis == "x" else (0, 1)
    columns = (stripe.frame, np.rint(stripe.pixels[:, across]), stripe.pixels[:, along])
    return np.stack([np.asarray(column, float) for column in columns], axis=1)


def by_line(rows: np.ndarray) -> Lines:
    """Sort positions by frame and scan line."""
    lines: Lines = {}
    for frame, line, position in rows:
        lines.setdefault((int(frame), int(line)), []).append(float(position))
    return lines


@dataclass(frozen=True)
class Truth:
    """True centres of one recording, and where nothing can be said."""

    rows: np.ndarray
    """Frame, scan line, position, and distance up to which a found centre is right."""
    unclear: Spans
    """Where nothing is judged."""


@dataclass(frozen=True)
class Drawing:
    """What was drawn by hand into one recording."""

    lines: Lines
    """Positions of the line; several where a scan line shows it more than once."""
    pieces: list[np.ndarray]
    """The same by piece: scan line and position of each of its centres."""
    unclear: Spans
    """Where the eye cannot tell, or what is seen is neither the line nor anything else."""
    wide: dict[tuple[int, int], float]
    """How near a centre must be where the band is wide [px]."""


@cache
def _table() -> dict[str, Any]:
    return tomllib.loads(_TABLE.read_text("utf-8"))


def load_drawing(name: str, num_lines: int) -> Drawing:
    """Load what was drawn into a recording of a number of scan lines."""
    table = _table()[name]
    lines: Lines = {}
    pieces: list[np.ndarray] = []
    unclear: Spans = {}
    for entry in table["line"]:
        points = np.array(entry["points"], float)
        at = np.arange(points[0, 0], points[-1, 0] + 1)
        pieces.append(np.stack([at, np.interp(at, *points.T)], axis=1))
        for frame in _between(entry["frames"]):
            for line, position in pieces[-1]:
                lines.setdefault((frame, int(line)), []).append(float(position))
            for line, position in _ends(pieces[-1], num_lines):
                span = (position - _CORRIDOR, position + _CORRIDOR)
                unclear.setdefault((frame, line), []).append(span)
    for box in table.get("unclear", []):
        for cell in _cells(box):
            unclear.setdefault(cell, []).append(tuple(box["positions"]))
    wide = {cell: box["within"] for box in table.get("wide", []) for cell in _cells(box)}
    return Drawing(lines, pieces, unclear, wide)


def _between(span: list[int]) -> range:
    return range(span[0], span[1] + 1)


def _cells(box: dict[str, list[int]]) -> list[tuple[int, int]]:
    return [(frame, line) for frame in _between(box["frames"]) for line in _between(box["lines"])]


def _ends(piece: np.ndarray, num_lines: int) -> Iterator[tuple[int, float]]:
    """Give scan lines and positions around those ends that lie inside the picture."""
    first, last = (int(line) for line in piece[[0, -1], 0])
    if first > 0:
        yield from ((first + k, float(piece[0, 1])) for k in range(-_END, _END + 1))
    if last < num_lines - 1:
        yield from ((last + k, float(piece[-1, 1])) for k in range(-_END, _END + 1))


def is_unclear(rows: np.ndarray, unclear: Spans) -> np.ndarray:
    """Tell which centres lie where nothing is judged; rows begin with frame, line, position."""
    told = (
        any(low <= row[2] <= high for low, high in unclear.get((int(row[0]), int(row[1])), ()))
        for row in rows
    )
    return np.fromiter(told, bool, len(rows))


def tell_truth(drawing: Drawing, finder: str, found: dict[str, Lines]) -> Truth:
    """Give the truth by which one finder is judged.

    Args:
        drawing: What was drawn by hand.
        finder: Name of the finder that is judged.
        found: What each witness found.
    """
    sides = [[found[name] for name in side] for side in _WITNESSES[_FAMILIES[finder]]]
    rows: list[tuple[float, ...]] = []
    for cell, positions in drawing.lines.items():
        agreed = _agreed(cell, sides)
        for position in positions:
            place, within = _place(position, agreed)
            rows.append((*cell, position, place, max(within, drawing.wide.get(cell, 0.0))))
    true = np.array(sorted(rows)).reshape(-1, 5)
    true = true[~is_unclear(true, drawing.unclear)]
    return Truth(true[:, [0, 1, 3, 4]], drawing.unclear)


def _agreed(cell: tuple[int, int], sides: list[list[Lines]]) -> list[float]:
    """Give the centres of a scan line that both sides found."""
    one, other = ([p for lines in side for p in lines.get(cell, ())] for side in sides)
    pairs = ((p, min(other, key=lambda q, p=p: abs(p - q))) for p in one if other)
    return [(p + q) / 2 for p, q in pairs if abs(p - q) < AGREE]


def _place(drawn: float, agreed: list[float]) -> tuple[float, float]:
    """Give a drawn centre's position, and how near a found one must be."""
    near = [p for p in agreed if abs(p - drawn) <= _CORRIDOR]
    if not near:
        return drawn, DRAWN
    return min(near, key=lambda p: abs(p - drawn)), AGREE
