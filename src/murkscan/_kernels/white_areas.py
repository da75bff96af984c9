"""Areas of white pixels that touch one another."""

import numpy as np

from .compiled import loop, part


@loop()
def box_white_areas(levels: np.ndarray, white: float) -> np.ndarray:
    """Give the box of each area that touches itself, also at corners, and its number of pixels.

    A row each: first column, first row, columns, rows, pixels (n 5).
    """
    height, width = levels.shape
    is_new = np.empty((height, width), np.bool_)
    for v in range(height):
        for u in range(width):
            is_new[v, u] = levels[v, u] >= white
    boxes = [np.zeros(5, np.int64) for _ in range(0)]
    waiting = [(0, 0) for _ in range(0)]
    for v in range(height):
        for u in range(width):
            if is_new[v, u]:
                is_new[v, u] = False
                waiting.append((v, u))
                boxes.append(_grow(is_new, waiting))
    found = np.zeros((len(boxes), 5), np.int64)
    for i in range(len(boxes)):
        for k in range(5):
            found[i, k] = boxes[i][k]
    return found


@part()
def _grow(is_new: np.ndarray, waiting: "list[tuple[int, int]]") -> np.ndarray:
    """Take all that is reached from what waits; give its box and its size."""
    height, width = is_new.shape
    low, high = np.array(waiting[0]), np.array(waiting[0])
    size = 0
    while len(waiting) > 0:
        v, u = waiting.pop()
        size += 1
        low[0], low[1] = min(low[0], v), min(low[1], u)
        high[0], high[1] = max(high[0], v), max(high[1], u)
        for y in range(max(v - 1, 0), min(v + 2, height)):
            for x in range(max(u - 1, 0), min(u + 2, width)):
                if is_new[y, x]:
                    is_new[y, x] = False
                    waiting.append((y, x))
    return np.array([low[1], low[0], high[1] - low[1] + 1, high[0] - low[0] + 1, size])
