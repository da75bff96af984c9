"""The lattice of saddle points that a chessboard's corners are, as far as a photo shows it.

Unlike finders that look for a board of a given size, it also finds a board of which a part is out
of the picture, or some of whose corners are spoilt by a laser's line; and where there is no board
it is done as soon as no four saddle points stand in a square.
"""

from collections import deque
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.spatial import cKDTree

from ...types.arrays import Image, Pixels, Scalars

_BLUR = 1.5
"""Smoothing before derivatives are taken [px]: corners are blurred by about as much."""
_WEAK = 0.03
"""Strength of a saddle, over the strongest ones', from which it is looked at."""
_FAINT = 3.0
"""Least curvature of a saddle [grey levels per px²] in a smoothed photo: less is noise."""
_MANY = 3000
"""Saddles looked at, the strongest; a board has 100."""
_RING = 4.0
"""Radius of the ring on which a corner shows two dark and two light quarters [px]."""
_SAMPLES = 32
"""Samples on that ring."""
_LEVEL = 0.55
"""Share of the ring that follows two dark and two light quarters: correlation."""
_ASYMMETRIC = 0.1
"""Share of a ring's power that half a turn changes from which something lies beside a corner."""
_SEEDS = 60
"""Saddles that a lattice is grown from; one in the middle of a board is among them."""
_NEAR = 0.3
"""Distance from where the next corner is expected within which it is one, over the pitch."""
_LEAST_PITCH = 6.0
"""Least distance of corners [px]: below it their edges run into each other."""
_BENT = 0.35
"""Difference of two edges' directions that perspective and lens leave [rad]."""

Vector2 = Float[np.ndarray, "2"]
Step = tuple[int, int]
_STEPS: tuple[Step, ...] = ((1, 0), (-1, 0), (0, 1), (0, -1))


@dataclass(frozen=True, eq=False)
class Saddles:
    """Points where two dark and two light quarters meet."""

    pixels: Pixels
    strengths: Scalars
    angles: Scalars
    """Direction from a corner to the middle of its light quarters, from 0 to π [rad]."""


@dataclass(frozen=True, eq=False)
class Lattice:
    """Corners by their column and row, counted from the first."""

    pixels: Pixels
    places: Int[np.ndarray, "n 2"]
    """Column and row of each."""

    @property
    def shape(self) -> tuple[int, int]:
        """Number of columns and rows that it spans."""
        if len(self.places) == 0:
            return 0, 0
        columns, rows = self.places.max(axis=0) + 1
        return int(columns), int(rows)


def find_saddles(photo: Image) -> Saddles:
    """Find saddle points of brightness that look like corners of a chessboard.

    References:
        Chen and Zhang, A new sub-pixel detector for x-corners in camera calibration targets, WSCG
        2005, for the Hessian; Bennett and Lasenby, ChESS: quick and robust detection of chess-board
        features, CVIU 118, 2014, for the ring.
    """
    smooth = cv2.GaussianBlur(photo.astype(np.float32), (0, 0), _BLUR)
    dxx, dyy = (cv2.Sobel(smooth, cv2.CV_32F, *order, ksize=3) / 4 for order in ((2, 0), (0, 2)))
    dxy = cv2.Sobel(smooth, cv2.CV_32F, 1, 1, ksize=3) / 4
    strength = np.maximum(dxy * dxy - dxx * dyy, 0.0)
    highest = cv2.dilate(strength, np.ones((5, 5), np.uint8))
    threshold = max(_WEAK * float(np.partition(strength.ravel(), -200)[-200]), _FAINT**2)
    v, u = np.nonzero((strength == highest) & (strength > threshold))
    order = np.argsort(-strength[v, u], kind="stable")[:_MANY]
    pixels = np.stack([u[order], v[order]], axis=1).astype(np.float64)
    levels = _ring(smooth, pixels, _RING)
    # Two light and two dark quarters are the ring's second harmonic.
    harmonics = np.fft.rfft(levels - levels.mean(axis=1, keepdims=True), axis=1)
    power = np.abs(harmonics[:, 1:]) ** 2
    total = np.maximum(power.sum(axis=1), 1e-9)
    is_corner = power[:, 1] / total > _LEVEL
    angles = (-np.angle(harmonics[:, 2]) / 2) % np.pi
    return Saddles(pixels[is_corner], strength[v, u][order][is_corner], angles[is_corner])


def are_alone(photo: Image, pixels: Pixels, radius: float) -> Bool[np.ndarray, "..."]:
    """Tell which corners have nothing beside them within a radius [px], such as a rim or a line.

    Turned by half a turn a corner looks the same; what lies beside it does not.
    """
    levels = _ring(photo, pixels, radius)
    power = np.abs(np.fft.rfft(levels - levels.mean(axis=1, keepdims=True), axis=1)) ** 2
    return power[:, 1::2].sum(axis=1) < _ASYMMETRIC * np.maximum(power.sum(axis=1), 1e-9)


def _ring(image: np.ndarray, pixels: Pixels, radius: float) -> Float[np.ndarray, "n s"]:
    around = 2 * np.pi * np.arange(_SAMPLES) / _SAMPLES
    u = (pixels[:, :1] + radius * np.cos(around)).astype(np.float32)
    v = (pixels[:, 1:] + radius * np.sin(around)).astype(np.float32)
    if len(pixels) == 0:
        return np.zeros((0, _SAMPLES))
    return cv2.remap(image, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE).astype(float)


def grow_lattice(saddles: Saddles, enough: int) -> Lattice:
    """Grow the largest lattice of saddles whose light quarters alternate as a chessboard's do.

    Args:
        saddles: The saddles.
        enough: Number of corners at which no larger one is looked for.
    """
    best = Lattice(np.zeros((0, 2)), np.zeros((0, 2), dtype=np.int64))
    if len(saddles.pixels) < 4:
        return best
    tree, tried, num_tried = cKDTree(saddles.pixels), set[int](), 0
    for seed in range(len(saddles.pixels)):
        if num_tried >= _SEEDS or len(best.pixels) >= enough:
            break
        if seed in tried:
            continue
        num_tried += 1
        places = _grow(saddles, tree, seed)
        tried.update(places.values())
        if len(places) > len(best.pixels):
            numbers = np.array(list(places.values()))
            at = np.array(list(places))
            best = Lattice(saddles.pixels[numbers], at - at.min(axis=0))
    return best


def _grow(saddles: Saddles, tree: cKDTree, seed: int) -> dict[Step, int]:
    """Grow a lattice from one saddle, corner by corner."""
    start = _neighbours_of(saddles, tree, seed)
    if start is None:
        return {}
    places: dict[Step, int] = {(0, 0): seed}
    taken, steps = {seed}, {(0, 0): start}
    queue = deque([(0, 0)])
    while queue:
        at = queue.popleft()
        here, across = saddles.pixels[places[at]], steps[at]
        for step in _STEPS:
            there = (at[0] + step[0], at[1] + step[1])
            if there in places:
                continue
            along = step[0] * across[0] + step[1] * across[1]
            pitch = float(np.linalg.norm(along))
            found = _nearest(saddles, tree, here + along, pitch, places[at])
            if found is None or found in taken:
                continue
            places[there] = found
            taken.add(found)
            moved = (saddles.pixels[found] - here) * (step[0] + step[1])
            steps[there] = (moved, across[1]) if step[0] else (across[0], moved)
            queue.append(there)
    return places


def _neighbours_of(saddles: Saddles, tree: cKDTree, seed: int) -> tuple[Vector2, Vector2] | None:
    """Find the steps to the next column and the next row; None where there are none."""
    here = saddles.pixels[seed]
    distances, numbers = tree.query(here, k=min(14, len(saddles.pixels)))
    usable = [
        (float(d), int(n))
        for d, n in zip(np.ravel(distances)[1:], np.ravel(numbers)[1:], strict=True)
        if d >= _LEAST_PITCH and _alternates(saddles, seed, int(n))
    ]
    for _, first in usable[:4]:
        along = saddles.pixels[first] - here
        for _, second in usable:
            across = saddles.pixels[second] - here
            area = along[0] * across[1] - along[1] * across[0]
            sizes = np.linalg.norm(along), np.linalg.norm(across)
            if area > 0.4 * sizes[0] * sizes[1] and 1 / 3 < sizes[0] / sizes[1] < 3:
                return along, across
    return None


def _nearest(
    saddles: Saddles, tree: cKDTree, expected: Scalars, pitch: float, before: int
) -> int | None:
    distance, number = tree.query(expected)
    if distance > _NEAR * pitch or not _alternates(saddles, before, int(number)):
        return None
    return int(number)


def _alternates(saddles: Saddles, first: int, second: int) -> bool:
    """Tell whether light quarters of one lie where the other has its dark ones."""
    turn = (saddles.angles[first] - saddles.angles[second]) % np.pi
    return bool(abs(turn - np.pi / 2) < 2 * _BENT)
