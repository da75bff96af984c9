"""What is true in a real recording: where the eye sees the line, and where finders agree on it.

Where the line lies, `real_truth.toml` says: it was drawn by hand, and there is nothing where it
says nothing. Where in its corridor a centre lies, two finders of other families than the one that
is judged say together; where they do not agree, it is the drawing itself.
"""

import tomllib
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
_CORRIDOR = 6.0
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
    covers_all: bool
    """Whether there is nothing wherever nothing is drawn; else what two finders agree on counts."""


@cache
def _table() -> dict[str, Any]:
    return tomllib.loads(_TABLE.read_text("utf-8"))


def load_drawing(name: str) -> Drawing:
    """Load what was drawn into a recording."""
    table = _table()[name]
    lines: Lines = {}
    pieces: list[np.ndarray] = []
    for entry in table.get("line", []):
        first, last = entry["frames"]
        points = np.array(entry["points"], float)
        at = np.arange(np.ceil(points[0, 0]), np.floor(points[-1, 0]) + 1)
        pieces.append(np.stack([at, np.interp(at, *points.T)], axis=1))
        for frame in range(first, last + 1):
            for line, position in zip(at, np.interp(at, *points.T), strict=True):
                lines.setdefault((frame, int(line)), []).append(float(position))
    unclear: Spans = {}
    for box in table.get("unclear", []):
        for frame in range(box["frames"][0], box["frames"][1] + 1):
            for line in range(box["lines"][0], box["lines"][1] + 1):
                unclear.setdefault((frame, line), []).append(tuple(box["positions"]))
    return Drawing(lines, pieces, unclear, table["covers_all"])


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
    unclear = dict(drawing.unclear)
    for cell, positions in drawing.lines.items():
        agreed, _ = _agreed(cell, sides)
        rows += [(*cell, *_place(position, agreed)) for position in positions]
    if not drawing.covers_all:
        seen = set().union(*(lines.keys() for side in sides for lines in side))
        for cell in seen - drawing.lines.keys() - unclear.keys():
            agreed, is_open = _agreed(cell, sides)
            rows += [(*cell, position, AGREE) for position in agreed]
            if is_open:
                unclear[cell] = [(-np.inf, np.inf)]
    true = np.array(sorted(rows)).reshape(-1, 4)
    return Truth(true[~is_unclear(true, unclear)], unclear)


def _agreed(cell: tuple[int, int], sides: list[list[Lines]]) -> tuple[list[float], bool]:
    """Give the centres that both sides found, and whether they agree on none of several."""
    one, other = ([p for lines in side for p in lines.get(cell, ())] for side in sides)
    agreed: list[float] = []
    for p in sorted(one):
        near = [q for q in other if abs(p - q) < AGREE]
        if near and not (agreed and p - agreed[-1] < AGREE):
            agreed.append((p + min(near, key=lambda q, p=p: abs(p - q))) / 2)
    return agreed, not agreed and bool(one or other)


def _place(drawn: float, agreed: list[float]) -> tuple[float, float]:
    """Give a drawn centre's position, and how near a found one must be."""
    near = [p for p in agreed if abs(p - drawn) <= _CORRIDOR]
    if not near:
        return drawn, DRAWN
    return min(near, key=lambda p: abs(p - drawn)), AGREE
