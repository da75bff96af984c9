"""Places where a score is highest along its scan line, and what speaks for each of them."""

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def find_ridges(
    scores: np.ndarray, least: float, most: int, reach: int, lobe: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the highest local maxima of each column.

    Gives positions and heights (lines, most), the highest first, and how many a line has. One
    lower than `lobe` times a higher one within `reach` is that one's side lobe, and left out.
    """
    length, num_lines = scores.shape
    positions, heights = np.zeros((num_lines, most)), np.zeros((num_lines, most))
    counts = np.zeros(num_lines, np.int64)
    for v in range(1, length - 1):
        before, row, after = scores[v - 1], scores[v], scores[v + 1]
        for u in range(num_lines):
            height = row[u]
            if height > least and height > before[u] and height >= after[u]:
                bend = before[u] - 2.0 * height + after[u]
                position = v + 0.5 * (before[u] - after[u]) / bend
                counts[u] = _insert(positions[u], heights[u], counts[u], position, height)
    for u in range(num_lines):
        counts[u] = _drop_lobes(positions[u], heights[u], counts[u], reach, lobe)
    return positions, heights, counts


@njit(cache=True, nogil=True)
def _insert(
    positions: np.ndarray, heights: np.ndarray, count: int, position: float, height: float
) -> int:
    """Put one in its place, highest first; the lowest is lost where there is no room."""
    if count == len(heights):
        if heights[count - 1] >= height:
            return count
        count -= 1
    at = count
    while at > 0 and heights[at - 1] < height:
        heights[at], positions[at] = heights[at - 1], positions[at - 1]
        at -= 1
    heights[at], positions[at] = height, position
    return count + 1


@njit(cache=True, nogil=True)
def _drop_lobes(
    positions: np.ndarray, heights: np.ndarray, count: int, reach: int, lobe: float
) -> int:
    kept = 0
    for i in range(count):
        is_lobe = False
        for j in range(kept):
            near = abs(positions[i] - positions[j]) < reach
            is_lobe |= near and heights[i] < lobe * heights[j]
        if not is_lobe:
            positions[kept], heights[kept] = positions[i], heights[i]
            kept += 1
    return kept


@njit(cache=True, nogil=True)
def compare_ridges(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray,
    other_positions: np.ndarray, other_heights: np.ndarray, other_counts: np.ndarray,
    shift: float, near: float, share: float,
) -> np.ndarray:  # fmt: skip
    """Tell which ridges another frame has, too, with the other's positions shifted (lines, most).

    It has one that lies within `near` and is at least `share` as high.
    """
    is_there = np.zeros(positions.shape, np.bool_)
    for u in range(min(len(counts), len(other_counts))):
        for k in range(counts[u]):
            for j in range(other_counts[u]):
                off = abs(other_positions[u, j] + shift - positions[u, k])
                is_there[u, k] |= off < near and other_heights[u, j] > share * heights[u, k]
    return is_there


@njit(cache=True, nogil=True)
def find_blurred_ends(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray,
    near: float, inner_share: float, outer_share: float, least: float,
) -> np.ndarray:  # fmt: skip
    """Tell which ridges are a stripe's blur beyond its end (lines, most).

    Such a one is faint beside what is three lines further in, and has nothing further out.
    """
    num_lines = len(counts)
    is_blur = np.zeros(positions.shape, np.bool_)
    for u in range(3, num_lines - 3):
        for k in range(counts[u]):
            if heights[u, k] <= least:
                continue
            for way in (-1, 1):
                inner = _highest(positions, heights, counts, u + 3 * way, positions[u, k], near)
                outer = max(
                    _highest(positions, heights, counts, u - 2 * way, positions[u, k], near),
                    _highest(positions, heights, counts, u - 3 * way, positions[u, k], near),
                )
                is_end = heights[u, k] < inner_share * inner
                is_blur[u, k] |= is_end and outer < outer_share * heights[u, k]
    return is_blur


@njit(cache=True, nogil=True)
def _highest(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray,
    line: int, position: float, near: float,
) -> float:  # fmt: skip
    best = 0.0
    for j in range(counts[line]):
        if abs(positions[line, j] - position) < near:
            best = max(best, heights[line, j])
    return best
