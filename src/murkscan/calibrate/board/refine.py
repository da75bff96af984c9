"""A lattice's corners, moved to where edges cross; those out of line with the rest are dropped."""

import cv2
import numpy as np
from jaxtyping import Float

from ...types.arrays import Image, Pixels
from .lattice import are_alone

LEAST_CORNERS = 12
"""Corners that a part of a board has at least."""
_WINDOWS = (0.3, 0.2, 0.13, 0.09)
"""Half widths of the refinement window over the pitch: the next edge stays outside. The widest
counts that holds nothing but the corner."""
_REACH = 1.2
"""Radius of the ring that must be a corner's own, over the half width: corners of the window count
little."""
_UNEVEN = 0.06
"""Distance of a corner, over the pitch, from where a smooth bend of the others has it, that no lens
makes: it is at a wrong place."""
_FOR_CUBIC = 24
"""Corners from which the bend is a cubic one, of 10 terms."""

Grid = Float[np.ndarray, "_ _ 2"]
"""Corners as the board has them [px]; NaN where one was not found."""


def refine_corners(photo: Image, grid: Grid) -> Grid:
    """Move each corner to where the edges cross, in a window that holds only its own edges.

    Corners that then are not where their neighbours have them are dropped.
    """
    pitch = smallest_pitch(grid)
    if not pitch > 1:
        return np.zeros((0, 0, 2))
    known = np.isfinite(grid[..., 0])
    moved = grid[known]
    left = np.ones(len(moved), dtype=bool)
    for share in _WINDOWS:
        half_width = int(max(share * pitch, 2))
        alone = are_alone(photo, moved, _REACH * half_width) | (share == _WINDOWS[-1])
        moved[left & alone] = _refine_within(photo, moved[left & alone], half_width)
        left &= ~alone
    grid = grid.copy()
    grid[known] = np.where(np.isfinite(moved), moved, np.nan)
    return _trim(_drop_uneven(grid))


def _refine_within(photo: Image, corners: Pixels, half_width: int) -> Pixels:
    if len(corners) == 0:
        return corners
    stop = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 50, 1e-4)
    start = np.ascontiguousarray(corners[:, None], dtype=np.float32)
    refined = cv2.cornerSubPix(photo, start, (half_width, half_width), (-1, -1), stop)
    return refined.reshape(-1, 2).astype(np.float64)


def _drop_uneven(grid: Grid) -> Grid:
    """Drop corners that are not where the others have them.

    A lens bends a grid smoothly, perspective apart; a misplaced corner bends it at one place.
    """
    flat = np.stack(np.meshgrid(*map(np.arange, grid.shape[1::-1])), axis=2).astype(np.float64)
    grid, limit = grid.copy(), _UNEVEN * smallest_pitch(grid)
    while np.isfinite(grid[..., 0]).sum() >= LEAST_CORNERS:
        known = np.isfinite(grid[..., 0])
        homography, _ = cv2.findHomography(flat[known], grid[known], cv2.LMEDS)
        if homography is None:
            break
        ideal = cv2.perspectiveTransform(flat[known][None], homography)[0]
        off = _unexplained(flat[known], grid[known] - ideal)
        worst = int(np.argmax(off))
        if off[worst] < limit:
            return grid
        row, column = np.argwhere(known)[worst]
        grid[row, column] = np.nan
    return np.zeros((0, 0, 2))


def _unexplained(places: Pixels, off: Pixels) -> Float[np.ndarray, "..."]:
    """Measure how far each corner is from what a smooth bend of all others predicts [px].

    References:
        Cook and Weisberg, Residuals and influence in regression, 1982, for leaving one out.
    """
    x, y = (2 * (places - places.mean(axis=0)) / np.maximum(np.ptp(places, axis=0), 1)).T
    order = 3 if len(places) >= _FOR_CUBIC else 1
    terms = [x**i * y**j for i in range(order + 1) for j in range(order + 1 - i)]
    q, _ = np.linalg.qr(np.stack(terms, axis=1))
    leverage = np.minimum(np.sum(q**2, axis=1), 0.9)
    return np.linalg.norm(off - q @ (q.T @ off), axis=1) / (1 - leverage)


def _trim(grid: Grid) -> Grid:
    """Cut off empty rows and columns at the ends."""
    known = np.isfinite(grid[..., 0])
    if not known.any():
        return np.zeros((0, 0, 2))
    rows, columns = np.flatnonzero(known.any(axis=1)), np.flatnonzero(known.any(axis=0))
    return grid[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]


def smallest_pitch(grid: Grid) -> float:
    """Compute the smallest distance of neighbouring corners [px]; NaN where there are none."""
    steps = [np.linalg.norm(np.diff(grid, axis=axis), axis=2).ravel() for axis in (0, 1)]
    known = np.concatenate(steps)
    known = known[np.isfinite(known)]
    return float(known.min()) if len(known) else np.nan
