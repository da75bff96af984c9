"""Peaks across scan lines: where pixels rise above their surroundings on both sides."""

import numpy as np

from .compiled import loop, part

_GAP = 2
"""Pixels in a row that may fail to rise within one peak."""
_FEWEST = 2
"""Pixels that must rise: a single one is a hot pixel, or noise."""


@part()
def _mark_risen(
    here: np.ndarray,
    before: tuple[np.ndarray, np.ndarray],
    after: tuple[np.ndarray, np.ndarray],
    rise: int,
    risen: np.ndarray,
) -> None:
    """Mark what exceeds both sides by `rise`; without branches, so that it becomes vector code.

    A side is the darker of two places, so that another stripe at one of them does not hide this.
    """
    far_before, near_before = before
    far_after, near_after = after
    for u in range(len(here)):
        left = far_before[u] if far_before[u] < near_before[u] else near_before[u]
        right = far_after[u] if far_after[u] < near_after[u] else near_after[u]
        side = left if left > right else right
        top = here[u] if here[u] > side else side
        risen[u] = (top - side) > rise


@part()
def _mark_ends(
    row: np.ndarray, start: int, end: int, rise: int, far: int, near: int, risen: np.ndarray
) -> None:
    """Mark pixels near the ends of a row; beyond its end counts as the end itself."""
    last = len(row) - 1
    for u in range(start, end):
        left = min(row[max(u - far, 0)], row[max(u - near, 0)])
        right = min(row[min(u + far, last)], row[min(u + near, last)])
        risen[u] = np.int64(row[u]) - np.int64(max(left, right)) > rise


@part()
def _mark_row(
    image: np.ndarray, v: int, down: bool, rise: int, far: int, near: int, risen: np.ndarray
) -> None:
    """Mark the risen pixels of one image row, across it or along it."""
    height, width = image.shape
    if down:
        before = (image[max(v - far, 0)], image[max(v - near, 0)])
        after = (image[min(v + far, height - 1)], image[min(v + near, height - 1)])
        _mark_risen(image[v], before, after, rise, risen)
        return
    row, inner, apart = image[v], max(width - 2 * far, 0), far - near
    before = (row[:inner], row[apart : apart + inner])
    after = (row[2 * far :], row[far + near : far + near + inner])
    _mark_risen(row[far : far + inner], before, after, rise, risen[far:])
    _mark_ends(row, 0, min(far, width), rise, far, near, risen)
    _mark_ends(row, min(far + inner, width), width, rise, far, near, risen)


@loop()
def find_peaks(
    image: np.ndarray, down: bool, rise: int, far: int, near: int, most: int
) -> np.ndarray:
    """Find the peaks of every scan line.

    A pixel has risen if it exceeds its surroundings, `near` and `far` pixels away on both sides, by
    more than `rise`; risen pixels side by side are one peak, at the middle of its highest level.
    Few pixels have risen: vector code finds them, and only these are looked at one by one.

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
    top, members = np.full(num_lines, -1), np.zeros(num_lines, np.int64)
    first_top, last_top = np.zeros(num_lines, np.int64), np.zeros(num_lines, np.int64)
    for v in range(height):
        _mark_row(image, v, down, rise, far, near, risen)
        for word in range(len(words)):
            if words[word] == 0:
                continue
            for u in range(8 * word, min(8 * word + 8, width)):
                if not risen[u]:
                    continue
                line, position = (u, v) if down else (v, u)
                level = np.int64(image[v, u])
                if position - last[line] > _GAP:
                    if members[line] >= _FEWEST and count < most:
                        peaks[count, 0] = line
                        peaks[count, 1] = (first_top[line] + last_top[line]) // 2
                        count += 1
                    top[line], members[line] = -1, 0
                last[line] = position
                members[line] += 1
                if level > top[line]:
                    top[line], first_top[line], last_top[line] = level, position, position
                elif level == top[line]:
                    last_top[line] = position
    for line in range(num_lines):
        if members[line] >= _FEWEST and count < most:
            peaks[count, 0] = line
            peaks[count, 1] = (first_top[line] + last_top[line]) // 2
            count += 1
    return peaks[:count]
