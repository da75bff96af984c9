"""Find a piece of one relief in another by normalised correlation."""

import numpy as np

from .compiled import loop


@loop(error_model="numpy")
def draw_relief(
    along: np.ndarray,
    across: np.ndarray,
    height: np.ndarray,
    pitch: float,
    num_rows: int,
    num_columns: int,
) -> np.ndarray:
    """Draw scattered heights as an image: each pixel the weighted mean of what lies nearby.

    A point spreads over its four nearest pixels; pixels (0, 0) lie at 0, one `pitch` [m] apart.
    NaN where nothing lies.
    """
    total = np.zeros((num_rows, num_columns))
    weight = np.zeros((num_rows, num_columns))
    for n in range(len(along)):
        y, x = along[n] / pitch, across[n] / pitch
        i, j = int(np.floor(y)), int(np.floor(x))
        if not (0 <= i < num_rows - 1 and 0 <= j < num_columns - 1):
            continue
        fy, fx = y - i, x - j
        for di in range(2):
            for dj in range(2):
                w = (fy if di else 1 - fy) * (fx if dj else 1 - fx)
                total[i + di, j + dj] += w * height[n]
                weight[i + di, j + dj] += w
    relief = np.full((num_rows, num_columns), np.nan)
    for i in range(num_rows):
        for j in range(num_columns):
            if weight[i, j] > 0.15:
                relief[i, j] = total[i, j] / weight[i, j]
    return relief


@loop(error_model="numpy")
def correlate(tile: np.ndarray, relief: np.ndarray, least: int) -> np.ndarray:
    """Correlate a tile with each piece of a larger relief, over the pixels that both have.

    A plane is taken out of neither: both must have none. Score (i, j) lays pixel (0, 0) of the tile
    on pixel (i, j); NaN where fewer than `least` pixels meet.
    """
    rows, columns = tile.shape
    scores = np.full((relief.shape[0] - rows + 1, relief.shape[1] - columns + 1), np.nan)
    for i in range(scores.shape[0]):
        for j in range(scores.shape[1]):
            n = sa = sb = saa = sbb = sab = 0.0
            for p in range(rows):
                for q in range(columns):
                    a, b = tile[p, q], relief[i + p, j + q]
                    ok = a == a and b == b
                    a = a if ok else 0.0
                    b = b if ok else 0.0
                    n += 1.0 if ok else 0.0
                    sa += a
                    sb += b
                    saa += a * a
                    sbb += b * b
                    sab += a * b
            if n >= least:
                va, vb = saa - sa * sa / n, sbb - sb * sb / n
                if va > 0 and vb > 0:
                    scores[i, j] = (sab - sa * sb / n) / np.sqrt(va * vb)
    return scores
