"""How well pixels around some places fit several templates."""

import numpy as np

from .compiled import loop


@loop()
def answer_best(
    signal: np.ndarray, lines: np.ndarray, places: np.ndarray, templates: np.ndarray, parts: int
) -> np.ndarray:
    """Give the best answers around each place: of the first templates, and of the others' size.

    Templates (window, number) are columns; the first `parts` answer what is bright, the others
    what changes either way. Beyond its ends a column of the signal goes on as it ends.
    """
    size, number = templates.shape
    best = np.zeros((len(lines), 2))
    total = np.empty(number, np.float32)
    for i in range(len(lines)):
        total[:] = 0.0
        for k in range(size):
            at = min(max(places[i] + k - size // 2, 0), len(signal) - 1)
            level, row = np.float32(signal[at, lines[i]]), templates[k]
            for j in range(number):
                total[j] += row[j] * level
        for j in range(number):
            if j < parts:
                best[i, 0] = max(best[i, 0], total[j])
            else:
                best[i, 1] = max(best[i, 1], abs(total[j]))
    return best
