"""Where a stripe has ended, and its blur goes on for some scan lines."""

import numpy as np

from .compiled import loop, part


@loop()
def find_blurred_ends(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, shapes: np.ndarray,
    tails: np.ndarray, slope: float, least: float, margin: float,
) -> np.ndarray:  # fmt: skip
    """Tell which ridges are a stripe's blur beyond its end (lines, most).

    Such a one is no higher than what a stripe that has ended sends there, and what goes on from it
    is not, either. `tails` holds by shape how high the blur is 1, 2, … lines after the last one of
    the stripe, as a share of the stripe's height; a ridge is explained by `margin` times that.
    A stripe follows `slope` px a line. Ridges below `least` are not looked at.
    """
    faint = np.zeros(positions.shape, np.int8)
    most = np.empty(tails.shape[1])
    for far in range(len(most)):
        most[far] = tails[0, far]
        for shape in range(1, len(tails)):
            most[far] = max(most[far], tails[shape, far])
    for u in range(len(counts)):
        for k in range(counts[u]):
            if heights[u, k] > least:
                faint[u, k] = _end_beside(
                    u, k, positions, heights, counts, shapes, tails, most, slope, margin
                )
    is_blur = np.zeros(positions.shape, np.bool_)
    for u in range(len(counts)):
        for k in range(counts[u]):
            if faint[u, k] != 0:
                is_blur[u, k] = not _goes_on(u, k, positions, heights, counts, faint, slope, least)
    return is_blur


@part()
def _end_beside(
    u: int, k: int, positions: np.ndarray, heights: np.ndarray, counts: np.ndarray,
    shapes: np.ndarray, tails: np.ndarray, most: np.ndarray, slope: float, margin: float,
) -> int:  # fmt: skip
    """Give the direction (-1 or 1) in which a stripe has ended whose blur a ridge can be, or 0."""
    place, away, best = positions[u, k], 0, (heights[u, k] - 1.0) / margin
    for way in (-1, 1):
        for far in range(1, tails.shape[1] + 1):
            least = best / most[far - 1]
            if not _two_of_three(positions, heights, counts, u, -way, far, place, slope, least):
                continue
            first, second, third, shape = 0.0, 0.0, 0.0, 0
            for i in range(3):
                line = u - way * (far + i)
                near = 1.5 + abs(slope) * (far + i)
                found = _highest_near(positions, heights, counts, line, place, near)
                if found < 0:
                    break
                first, second, third = heights[line, found], first, second
                shape = max(shapes[line, found], 0)
            low, high = min(first, second), max(first, second)
            blur = max(low, min(high, third)) * tails[shape, far - 1]  # the middle one
            if blur > best:
                best, away = blur, way
    return away


@part()
def _two_of_three(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, u: int, way: int, far: int,
    place: float, slope: float, least: float,
) -> bool:  # fmt: skip
    """Tell whether two of the lines `far` and on away have a ridge of `least` near a place."""
    found = 0
    for i in range(3):
        line, near = u + way * (far + i), 1.5 + abs(slope) * (far + i)
        if 0 <= line < len(counts):
            for j in range(counts[line]):
                if heights[line, j] < least:
                    break
                if abs(positions[line, j] - place) < near:
                    found += 1
                    break
    return found >= 2


@part()
def _goes_on(
    u: int, k: int, positions: np.ndarray, heights: np.ndarray, counts: np.ndarray,
    faint: np.ndarray, slope: float, least: float,
) -> bool:  # fmt: skip
    """Tell whether a stripe goes on within three lines outwards from a faint ridge."""
    for far in range(1, 4):
        line = u + faint[u, k] * far
        near = 1.5 + abs(slope) * far
        found = _highest_near(positions, heights, counts, line, positions[u, k], near)
        if found >= 0 and heights[line, found] > least and faint[line, found] == 0:
            return True
    return False


@part()
def _highest_near(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray,
    line: int, position: float, near: float,
) -> int:  # fmt: skip
    """Give the number of a line's highest ridge within `near` of a place; -1: there is none."""
    if line < 0 or line >= len(counts):
        return -1
    for j in range(counts[line]):
        if abs(positions[line, j] - position) < near:
            return j
    return -1
