"""Places where a score is highest along its scan line, and what speaks for each of them."""

import numpy as np

from .compiled import loop, part


@loop()
def find_ridges(
    scores: np.ndarray, least: float, most: int, reach: int, lobe: float, margin: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the highest local maxima of each column.

    Gives positions and heights (lines, most), the highest first, and how many a line has. One
    lower than `lobe` times a higher one within `reach` is that one's side lobe, and left out, as is
    what lies within `margin` of the ends.
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
                if position < margin or position > length - 1 - margin:
                    continue
                counts[u] = _insert(positions[u], heights[u], counts[u], position, height)
    for u in range(num_lines):
        counts[u] = _drop_lobes(positions[u], heights[u], counts[u], reach, lobe)
    return positions, heights, counts


@loop()
def merge_ridges(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, widths: np.ndarray,
    order: np.ndarray, narrow: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """Choose one width for each ridge that answers several filters.

    Ridges come by filter (filters, lines, most), each of a width [px]; `order` lists the widest
    first. A wide one is left out where one of a narrower filter, within its width, is at least
    `narrow` times as high; elsewhere the narrower ones within twice its width are its texture and
    its edges. Gives positions, heights, counts and filters by line, the highest first.
    """
    num_filters, num_lines, most = positions.shape
    out, tops = np.zeros((num_lines, most)), np.zeros((num_lines, most))
    which = np.zeros((num_lines, most), np.int8)
    number = np.zeros(num_lines, np.int64)
    gone = np.zeros((num_filters, most), np.bool_)
    for u in range(num_lines):
        gone[:] = False
        for wide in order:
            for i in range(counts[wide, u]):
                if not gone[wide, i]:
                    gone[wide, i] = _is_explained(
                        wide, i, positions[:, u], heights[:, u], counts[:, u], widths, narrow, gone
                    )
        for f in range(num_filters):
            for i in range(counts[f, u]):
                if not gone[f, i]:
                    number[u] = _insert_with(
                        out[u],
                        tops[u],
                        which[u],
                        number[u],
                        positions[f, u, i],
                        heights[f, u, i],
                        f,
                    )
    return out, tops, number, which


@part()
def _is_explained(
    wide: int, i: int, positions: np.ndarray, heights: np.ndarray, counts: np.ndarray,
    widths: np.ndarray, narrow: float, gone: np.ndarray,
) -> bool:  # fmt: skip
    """Tell whether narrower ridges explain a wide one; where not, mark those as gone."""
    for f in range(len(widths)):
        if widths[f] < widths[wide]:
            for j in range(counts[f]):
                off = abs(positions[f, j] - positions[wide, i])
                if off < widths[wide] and heights[f, j] >= narrow * heights[wide, i]:
                    return True
    for f in range(len(widths)):
        if widths[f] < widths[wide]:
            for j in range(counts[f]):
                off = abs(positions[f, j] - positions[wide, i])
                if off < 2.0 * widths[wide] and heights[f, j] < 0.5 * heights[wide, i]:
                    gone[f, j] = True
    return False


@part()
def _insert_with(
    positions: np.ndarray, heights: np.ndarray, shapes: np.ndarray, count: int,
    position: float, height: float, shape: int,
) -> int:  # fmt: skip
    """Put one in its place with its shape, highest first; see `_insert`."""
    if count == len(heights):
        if heights[count - 1] >= height:
            return count
        count -= 1
    at = count
    while at > 0 and heights[at - 1] < height:
        heights[at], positions[at], shapes[at] = heights[at - 1], positions[at - 1], shapes[at - 1]
        at -= 1
    heights[at], positions[at], shapes[at] = height, position, shape
    return count + 1


@part()
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


@part()
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


@loop()
def compare_ridges(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, grains: np.ndarray,
    other_positions: np.ndarray, other_heights: np.ndarray, other_counts: np.ndarray,
    shift: float, near: float, share: float,
) -> np.ndarray:  # fmt: skip
    """Tell which ridges another frame has, too, with the other's positions shifted (lines, most).

    It has one that lies within `near` grains and is at least `share` as high. Ridges come the
    highest first.
    """
    is_there = np.zeros(positions.shape, np.bool_)
    for u in range(min(len(counts), len(other_counts))):
        for k in range(counts[u]):
            least = share * heights[u, k]
            for j in range(other_counts[u]):
                if not other_heights[u, j] > least:
                    break
                off = abs(other_positions[u, j] + shift - positions[u, k])
                if off < near * grains[u, k]:
                    is_there[u, k] = True
                    break
    return is_there


@loop()
def are_near(positions: np.ndarray, which: np.ndarray, distance: float) -> np.ndarray:
    """Tell which entries lie within a distance of one of some in their line (lines, most)."""
    near = np.zeros(positions.shape, np.bool_)
    num_lines, most = positions.shape
    for u in range(num_lines):
        for j in range(most):
            if which[u, j]:
                for k in range(most):
                    near[u, k] |= abs(positions[u, k] - positions[u, j]) < distance
    return near


@loop()
def replace_near(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, shapes: np.ndarray,
    lines: np.ndarray, places: np.ndarray, tops: np.ndarray, reaches: np.ndarray, shape: int,
) -> None:  # fmt: skip
    """Put ridges of their own shape in the place of all lower ones within their reach."""
    for i in range(len(lines)):
        u = lines[i]
        kept = 0
        for k in range(counts[u]):
            if abs(positions[u, k] - places[i]) > reaches[i] or shapes[u, k] == shape:
                positions[u, kept], heights[u, kept] = positions[u, k], heights[u, k]
                shapes[u, kept] = shapes[u, k]
                kept += 1
        counts[u] = _insert_with(
            positions[u], heights[u], shapes[u], kept, places[i], tops[i], shape
        )


@loop()
def match_ridges(
    positions: np.ndarray, counts: np.ndarray, grains: np.ndarray,
    other_positions: np.ndarray, other_heights: np.ndarray, other_counts: np.ndarray,
    near: float,
) -> tuple[np.ndarray, np.ndarray]:  # fmt: skip
    """Find the highest ridge of another frame within `near` grains of each (lines, most).

    Gives its height, 0 where there is none, and how far on it lies.
    """
    found, away = np.zeros(positions.shape), np.zeros(positions.shape)
    for u in range(len(counts)):
        for k in range(counts[u]):
            for j in range(other_counts[u]):
                off = other_positions[u, j] - positions[u, k]
                if abs(off) < near * grains[u, k] and other_heights[u, j] > found[u, k]:
                    found[u, k], away[u, k] = other_heights[u, j], off
    return found, away


@loop()
def pool_along(
    positions: np.ndarray, counts: np.ndarray, marks: np.ndarray, values: np.ndarray,
    reach: int, slope: float, gap: int,
) -> np.ndarray:  # fmt: skip
    """Sum values over the marked ridges that go on from each over up to `reach` lines.

    A line's ridge goes on from another's that lies within `slope` pixels a line, and one pixel, of
    the last one found; where none does for more than `gap` lines, the thing has ended.
    """
    pooled = np.zeros(values.shape)
    for u in range(len(counts)):
        for k in range(counts[u]):
            if not marks[u, k]:
                continue
            pooled[u, k] = values[u, k]
            for way in (-1, 1):
                place, since = positions[u, k], 0
                for step in range(1, reach + 1):
                    line = u + way * step
                    if line < 0 or line >= len(counts):
                        break
                    since += 1
                    best, least = -1, 1.0 + slope * since
                    for j in range(counts[line]):
                        off = abs(positions[line, j] - place)
                        if marks[line, j] and off < least:
                            best, least = j, off
                    if best >= 0:
                        pooled[u, k] += values[line, best]
                        place, since = positions[line, best], 0
                    elif since > gap:
                        break
    return pooled


@loop()
def drop_hidden(
    positions: np.ndarray, heights: np.ndarray, counts: np.ndarray, shapes: np.ndarray,
    hidden: np.ndarray,
) -> None:  # fmt: skip
    """Leave out the ridges in hidden pixels (length, lines)."""
    for u in range(len(counts)):
        kept = 0
        for k in range(counts[u]):
            if not hidden[int(np.rint(positions[u, k])), u]:
                positions[u, kept], heights[u, kept] = positions[u, k], heights[u, k]
                shapes[u, kept] = shapes[u, k]
                kept += 1
        counts[u] = kept
