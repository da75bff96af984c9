"""Peaks across scan lines: where pixels rise above their surroundings on both sides."""

import numpy as np
from numba import njit

_GAP = 2
"""Pixels in a row that may fail to rise within one peak."""


@njit(cache=True, nogil=True)
def _mark_risen(
    here: np.ndarray, before: np.ndarray, after: np.ndarray, rise: int, risen: np.ndarray
) -> None:
    """Mark what exceeds both sides by `rise`; without branches, so that it becomes vector code."""
    for u in range(len(here)):
        side = before[u] if before[u] > after[u] else after[u]
        top = here[u] if here[u] > side else side
        risen[u] = (top - side) > rise


@njit(cache=True, nogil=True)
def _mark_ends(
    row: np.ndarray, start: int, end: int, rise: int, reach: int, risen: np.ndarray
) -> None:
    """Mark pixels near the ends of a row, where the sides are cut off."""
    for u in range(start, end):
        side = max(row[max(u - reach, 0)], row[min(u + reach, len(row) - 1)])
        risen[u] = np.int64(row[u]) - np.int64(side) > rise


@njit(cache=True, nogil=True)
def _mark_row(
    image: np.ndarray, v: int, down: bool, rise: int, reach: int, risen: np.ndarray
) -> None:
    """Mark the risen pixels of one image row; beyond the border counts as the border itself."""
    height, width = image.shape
    if down:
        before, after = image[max(v - reach, 0)], image[min(v + reach, height - 1)]
        _mark_risen(image[v], before, after, rise, risen)
        return
    row, inner = image[v], max(width - 2 * reach, 0)
    _mark_risen(row[reach : reach + inner], row[:inner], row[2 * reach :], rise, risen[reach:])
    _mark_ends(row, 0, min(reach, width), rise, reach, risen)
    _mark_ends(row, min(reach + inner, width), width, rise, reach, risen)


@njit(cache=True, nogil=True)
def find_peaks(image: np.ndarray, down: bool, rise: int, reach: int, most: int) -> np.ndarray:
    """Find the peaks of every scan line.

    A pixel has risen if it exceeds the pixels `reach` before and after it in its scan line by more
    than `rise`; risen pixels side by side are one peak, at the middle of its highest level. Few
    pixels have risen: vector code finds them, and only what it finds is looked at one by one.

    Scan lines are image columns if `down`, otherwise image rows. Gives scan line and position, one
    peak a row (n 2), at most `most` of them.
    """
    height, width = image.shape
    num_lines = width if down else height
    peaks = np.empty((most, 2), np.int64)
    count = 0
    words = np.zeros((width + 7) // 8, np.uint64)
    risen = words.view(np.bool_)
    last = np.full(num_lines, -_GAP - 2)
    top, first_top, last_top = (
        np.full(num_lines, -1),
        np.zeros(num_lines, np.int64),
        np.zeros(num_lines, np.int64),
    )
    for v in range(height):
        _mark_row(image, v, down, rise, reach, risen)
        for word in range(len(words)):
            if words[word] == 0:
                continue
            for u in range(8 * word, min(8 * word + 8, width)):
                if not risen[u]:
                    continue
                line, position = (u, v) if down else (v, u)
                level = np.int64(image[v, u])
                if position - last[line] > _GAP:
                    if top[line] >= 0 and count < most:
                        peaks[count] = line, (first_top[line] + last_top[line]) // 2
                        count += 1
                    top[line] = -1
                last[line] = position
                if level > top[line]:
                    top[line], first_top[line], last_top[line] = level, position, position
                elif level == top[line]:
                    last_top[line] = position
    for line in range(num_lines):
        if top[line] >= 0 and count < most:
            peaks[count] = line, (first_top[line] + last_top[line]) // 2
            count += 1
    return peaks[:count]
