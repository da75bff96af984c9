"""Arrays as text: whole numbers, differences, bytes of one weight together, deflated, base64."""

import base64
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Int

from ..types.arrays import Directions, Points, Scalars

_LEVEL = 6
"""Of the compression: more costs time and saves little."""
_FINE = 2e-5
"""Rounding of a position, at most [m]."""
_SIGMA_SHARE = 0.1
"""The same as a share of the points' own standard deviation."""
_NORMAL_STEPS = 511
"""Steps on either side of zero of each number of a packed direction: a quarter of a degree."""
NO_VALUE = 65535
"""Code of a value that is not there."""

Codes = Int[np.ndarray, "n k"]


def pack(codes: Codes, num_bytes: int) -> str:
    """Pack rows of whole numbers of 0 or more, below 256 to the power of the bytes.

    Rows are replaced by their difference from the row before, folded to 0 or more; then come all
    bytes of the first column's lowest weight, of its next, and so on with the other columns.

    Args:
        codes: The numbers.
        num_bytes: Bytes that one of them takes, 1 to 4.

    Returns:
        The zlib stream of these bytes, in base64.
    """
    span = 1 << (8 * num_bytes)
    raw = np.diff(codes.astype(np.int64), axis=0, prepend=np.int64(0))
    # The nearer way round, so that both directions stay small numbers.
    steps = np.mod(raw + span // 2, span) - span // 2
    folded = np.where(steps >= 0, 2 * steps, -2 * steps - 1)
    planes = [
        ((folded[:, column] >> (8 * weight)) & 0xFF).astype(np.uint8)
        for column in range(codes.shape[1])
        for weight in range(num_bytes)
    ]
    return base64.b64encode(zlib.compress(b"".join(p.tobytes() for p in planes), _LEVEL)).decode()


@dataclass(frozen=True)
class PackedPositions:
    """Positions on a grid."""

    text: str
    low: tuple[float, float, float]
    """The grid's corner [m]."""
    step: float
    """Distance between its lines [m]; no position is off by more than half of it on any axis."""
    num_bytes: int

    def codes_of(self, points: Points) -> Int[np.ndarray, "n 3"]:
        """Give the grid's nearest line on each axis; outside of it below 0 or above the last."""
        return np.rint((points - np.array(self.low)) / self.step).astype(np.int64)

    def as_plain(self) -> dict[str, Any]:
        """Give all but the text, for the page's JSON."""
        return {"low": self.low, "step": self.step, "bytes": self.num_bytes}


def pack_positions(points: Points, sigma: Scalars) -> PackedPositions:
    """Pack positions, as finely as the scan deserves.

    Args:
        points: Positions [m], at least one.
        sigma: Standard deviations of the points [m], 0 where unknown.

    Returns:
        The positions, rounded by no more than 0.02 mm and a tenth of the median sigma; for scans of
        more than half a kilometre, by a 33 millionth of the longest edge. Rounding no finer than
        that keeps the page small.
    """
    low = points.min(axis=0)
    extent = max(float(np.ptp(points, axis=0).max()), 1e-6)
    known = sigma[sigma > 0]
    wanted = min([_FINE, *([_SIGMA_SHARE * float(np.median(known))] if len(known) else [])])
    step = max(2 * wanted, extent / (256**3 - 1))
    codes = np.rint((points - low) / step).astype(np.int64)
    num_bytes = 2 if codes.max() < 256**2 else 3
    x, y, z = low.tolist()
    return PackedPositions(pack(codes, num_bytes), (x, y, z), step, num_bytes)


def pack_moves(points: Points, to: Points, grid: PackedPositions) -> tuple[str, int] | None:
    """Pack how far places have moved, in steps of the grid.

    Args:
        points: The packed positions [m].
        to: Where they have moved to [m].
        grid: The grid of the positions.

    Returns:
        The text, of one byte more than the positions have, and the smallest step, which is taken
        off; None where nothing has moved.
    """
    steps = grid.codes_of(to) - grid.codes_of(points)
    if not steps.any():
        return None
    low = int(steps.min())
    return pack(steps - low, grid.num_bytes + 1), low


def pack_directions(directions: Directions) -> str:
    """Pack unit directions as two numbers of ten bits each: an octahedron, unfolded.

    A zero direction becomes (0, 0, 1).

    References:
        Cigolle et al., A survey of efficient representations for independent unit vectors, Journal
        of Computer Graphics Techniques 3(2), 2014.
    """
    size = np.abs(directions).sum(axis=1, keepdims=True)
    flat = np.where(size > 0, directions / np.maximum(size, 1e-30), [0.0, 0.0, 1.0])
    x, y, z = flat.T
    below = z < 0
    sign_x, sign_y = np.where(x < 0, -1.0, 1.0), np.where(y < 0, -1.0, 1.0)
    u = np.where(below, (1 - np.abs(y)) * sign_x, x)
    v = np.where(below, (1 - np.abs(x)) * sign_y, y)
    codes = np.rint(np.stack([u, v], axis=1) * _NORMAL_STEPS).astype(np.int64) + _NORMAL_STEPS
    return pack(codes, 2)


def pack_values(values: Scalars) -> tuple[str, float, float]:
    """Pack values in 65 535 steps from the smallest to the largest; what is not finite stays none.

    Returns:
        The text, the smallest value, and the step: a value is off by half of it at most.
    """
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    step = (high - low) / (NO_VALUE - 1) or 1.0
    codes = np.full(len(values), NO_VALUE, np.int64)
    codes[np.isfinite(values)] = np.rint((finite - low) / step).astype(np.int64)
    return pack(codes[:, None], 2), low, step
