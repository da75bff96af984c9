"""Third differences of centres along a stripe, and how far frames have them alike."""

import numpy as np

from .compiled import loop


@loop(error_model="numpy")
def third_differences(
    table: np.ndarray, apart: int, weights: np.ndarray, jump: float
) -> tuple[np.ndarray, np.ndarray]:
    """Give third differences of centres `apart` columns from one another (frames, _), scaled.

    `table` holds by frame and column the centre, its variance and another one (3, frames, columns),
    NaN where there is none. Differences are in standard deviations by the variance; second is what
    the other one adds, in the same. Those of `jump` and more are NaN.
    """
    _, frames, columns = table.shape
    count = max(columns - 3 * apart, 0)
    bends, uneven = np.empty((frames, count)), np.empty((frames, count))
    for f in range(frames):
        for c in range(count):
            total, spread, more = 0.0, 0.0, 0.0
            for k in range(4):
                at, weight = c + k * apart, weights[k]
                total += weight * table[0, f, at]
                spread += weight * weight * table[1, f, at]
                more += weight * weight * table[2, f, at]
            bends[f, c] = total / np.sqrt(spread) if abs(total) < jump else np.nan
            uneven[f, c] = np.sqrt(more / spread)
    return bends, uneven


@loop()
def count_signs(bends: np.ndarray, most: float) -> tuple[int, int]:
    """Count pairs of frames by column, and how many more have one sign than have both.

    Only what is nearer to 0 than `most` counts. Each pair is counted twice.
    """
    frames, columns = bends.shape
    pairs, agree = 0, 0
    for c in range(columns):
        shown, total = 0, 0
        for f in range(frames):
            if 0.0 < abs(bends[f, c]) < most:
                shown += 1
                total += 1 if bends[f, c] > 0.0 else -1
        pairs += shown * (shown - 1)
        agree += total * total - shown
    return pairs, agree
