"""The nearest point of another cell of a scan's own grid."""

import numpy as np

from .compiled import loop


@loop()
def find_in_cells(
    points: np.ndarray,
    asking: np.ndarray,
    wanted: np.ndarray,
    cells: np.ndarray,
    order: np.ndarray,
    most: int,
) -> np.ndarray:
    """Find for some points the nearest of the points in one cell each.

    Args:
        points: All points [m], n × 3.
        asking: Numbers of those that ask.
        wanted: In which cell each looks, as many.
        cells: Every point's cell, in increasing order.
        order: The points in that order.
        most: Points of one cell that are looked at.

    Returns:
        The number of each one's neighbour; -1 where its cell is empty.
    """
    nearest = np.full(len(asking), -1)
    first = 0
    for i in range(len(asking)):
        # Who asks next mostly looks a little farther than who asked before.
        if first == len(cells) or cells[first] > wanted[i]:
            first = 0
        step = 1
        while first + step < len(cells) and cells[first + step] < wanted[i]:
            step *= 2
        stop = min(first + step, len(cells))
        while first < stop:
            middle = (first + stop) // 2
            if cells[middle] < wanted[i]:
                first = middle + 1
            else:
                stop = middle
        shortest = np.inf
        for k in range(first, min(first + most, len(cells))):
            if cells[k] != wanted[i]:
                break
            length = 0.0
            for axis in range(3):
                length += (points[order[k], axis] - points[asking[i], axis]) ** 2
            if length < shortest:
                shortest, nearest[i] = length, order[k]
    return nearest
