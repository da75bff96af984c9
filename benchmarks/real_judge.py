"""From found and true centres to recall and precision, and to a list of what went wrong."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from real_truth import Truth, is_unclear

EDGE = 4.0
"""Distance from the end of a scan line within which a false point lies along the edge [px]."""


@dataclass(frozen=True)
class Judged:
    """One finder on one recording: each true and each found centre, and which are which."""

    true: np.ndarray
    """Frame, scan line, position, and tolerance of each true centre."""
    is_hit: np.ndarray
    found: np.ndarray
    """Frame, scan line and position of each found centre that is judged."""
    is_right: np.ndarray
    is_edge: np.ndarray
    """Which found centres lie near an end of their scan line."""
    unclear: np.ndarray
    """Frame, scan line and position of each that is not judged."""

    def of_frames(self, first: int, last: int) -> "Judged":
        """Pick the frames from `first` up to `last`, without it."""
        true, found, unclear = (
            (first <= rows[:, 0]) & (rows[:, 0] < last)
            for rows in (self.true, self.found, self.unclear)
        )
        return Judged(
            self.true[true], self.is_hit[true], self.found[found], self.is_right[found],
            self.is_edge[found], self.unclear[unclear],
        )  # fmt: skip


def judge(found: np.ndarray, truth: Truth, *, length: int) -> Judged:
    """Pair each found centre with a true one within its tolerance, one to one, nearest first.

    Args:
        found: Frame, scan line and position of each.
        truth: What is true.
        length: Pixels of a scan line.
    """
    is_judged = ~is_unclear(found, truth.unclear)
    judged = found[is_judged]
    is_hit, is_right = np.zeros(len(truth.rows), bool), np.zeros(len(judged), bool)
    for _, i, k in sorted(_near_pairs(judged, truth.rows)):
        if not is_right[i] and not is_hit[k]:
            is_right[i] = is_hit[k] = True
    is_edge = (judged[:, 2] < EDGE) | (judged[:, 2] > length - 1 - EDGE)
    return Judged(truth.rows, is_hit, judged, is_right, is_edge, found[~is_judged])


def _near_pairs(found: np.ndarray, true: np.ndarray) -> Iterator[tuple[float, int, int]]:
    places: dict[tuple[float, float], list[int]] = {}
    for k, (frame, line) in enumerate(true[:, :2]):
        places.setdefault((frame, line), []).append(k)
    for i, (frame, line, position) in enumerate(found):
        for k in places.get((frame, line), ()):
            if (off := abs(position - true[k, 2])) <= true[k, 3]:
                yield off, i, k


def pool(parts: list[Judged]) -> dict[str, float]:
    """Give the figures of one finder in all recordings of a set together [%]."""
    hit, true = sum(int(p.is_hit.sum()) for p in parts), sum(len(p.true) for p in parts)
    right, found = sum(int(p.is_right.sum()) for p in parts), sum(len(p.found) for p in parts)
    edge = sum(int((p.is_edge & ~p.is_right).sum()) for p in parts)
    return {
        "R": 100 * hit / true if true else np.nan,
        "P": 100 * right / found if found else np.nan,
        "edge": 100 * edge / found if found else 0.0,
        "true": true,
        "found": found,
        "unclear": sum(len(p.unclear) for p in parts),
    }


def failures(name: str, judged: Judged) -> Iterator[str]:
    """Tell each missed and each false point: recording, frame, scan line, position, what, why."""
    true_in: dict[tuple[int, int], list[float]] = {}
    found_in: dict[tuple[int, int], list[float]] = {}
    for rows, places in ((judged.true, true_in), (judged.found, found_in)):
        for frame, line, position in rows[:, :3]:
            places.setdefault((int(frame), int(line)), []).append(position)
    for frame, line, position, _ in judged.true[~judged.is_hit]:
        there = found_in.get((int(frame), int(line)), [])
        why = f"nearest found at {_nearest(position, there):+.1f}" if there else "nothing found"
        yield f"{name},{frame:.0f},{line:.0f},{position:.1f},missed,{why}"
    wrong = ~judged.is_right
    for (frame, line, position), edge in zip(judged.found[wrong], judged.is_edge[wrong],
                                             strict=True):  # fmt: skip
        there = true_in.get((int(frame), int(line)), [])
        why = f"true line at {_nearest(position, there):+.1f}" if there else "no line here"
        why = f"along the edge; {why}" if edge else why
        yield f"{name},{frame:.0f},{line:.0f},{position:.1f},false,{why}"


def _nearest(position: float, others: list[float]) -> float:
    return min((other - position for other in others), key=abs)
