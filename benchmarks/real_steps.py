"""The block of steps under water: which share of each piece of the line is found."""

from dataclasses import dataclass

import numpy as np
from real_sets import Shot
from real_truth import DRAWN, is_unclear, load_drawing

_SHOT = "steps"


@dataclass(frozen=True)
class Shares:
    """What a finder made of the five pieces, and of the rest of the picture."""

    pieces: tuple[float, ...]
    """Share of the scan lines of each piece in which it is found [%]."""
    elsewhere: int
    """Points on none of them, nor on the faint sixth piece."""

    def __str__(self) -> str:
        """Tell it in a line."""
        pieces = " / ".join(f"{share:.1f}" for share in self.pieces)
        return f"pieces found over {pieces} %, points elsewhere: {self.elsewhere}"


def shares_of_steps(shot: Shot, rows: np.ndarray) -> Shares | None:
    """Measure how much of each piece was found, in the recording of the steps alone."""
    if shot.name != _SHOT:
        return None
    drawing = load_drawing(_SHOT, shot.rig.camera.size[0])
    of_piece = _piece_of(rows, drawing.pieces)
    shares = (
        100 * len(set(rows[of_piece == k, 1])) / len(piece)
        for k, piece in enumerate(drawing.pieces)
    )
    elsewhere = (of_piece < 0) & ~is_unclear(rows, drawing.unclear)
    return Shares(tuple(shares), int(elsewhere.sum()))


def _piece_of(rows: np.ndarray, pieces: list[np.ndarray]) -> np.ndarray:
    """Number the piece that each point lies on; -1: none."""
    of_piece = np.full(len(rows), -1)
    for k, piece in enumerate(pieces):
        places = dict(piece)
        off = [abs(position - places.get(line, np.inf)) for _, line, position in rows]
        of_piece[np.array(off) <= DRAWN] = k
    return of_piece
