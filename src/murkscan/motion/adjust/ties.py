"""Ties: that two legs saw one surface in the same place.

A tie joins a point at one moment with a point at another along one direction. Both moments' poses
enter, so that it says how the vehicle moved from one to the other.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Float, Int

from ..._kernels.spline_poses import lever_points
from ..._kernels.ties import sum_groups, sum_vectors
from ...types.arrays import Directions, Indices, Points, Scalars
from .path import WIDTH, Path, Poses
from .spline import Weights

_BLOCK = 2 * 4 * WIDTH
OPEN = 1.0
"""Variance of a tie that says nothing [m²]."""


@dataclass(frozen=True, eq=False)
class Ties:
    """direction · (a − b) = offset, each with its variance; one a row."""

    pass_a: Indices
    """Number of the pass that saw each first point."""
    time_a: Scalars
    point_a: Points
    """In the vehicle's frame [m]."""
    pass_b: Indices
    time_b: Scalars
    point_b: Points
    direction: Directions
    """In the world."""
    offset: Scalars
    """What the difference should be [m]."""
    variance: Scalars
    """Of the difference [m²]."""

    def __len__(self) -> int:
        """Count the ties."""
        return len(self.time_a)

    def __getitem__(self, which: np.ndarray) -> "Ties":
        """Pick some."""
        return Ties(*(getattr(self, column.name)[which] for column in fields(self)))

    @classmethod
    def concatenate(cls, parts: Sequence["Ties"]) -> "Ties":
        """Put ties one after another."""
        return cls(*(np.concatenate([getattr(p, c.name) for p in parts]) for c in fields(cls)))


def as_seen(number: Indices, times: Scalars, points: Points, paths: Sequence[Path]) -> Points:
    """Carry points of the world into the frame of the vehicle that is to have seen them [m]."""
    at, _ = _moments(number, times, paths)
    return np.einsum("nji,nj->ni", at.rotations, points - at.positions)


def as_placed(number: Indices, times: Scalars, points: Points, paths: Sequence[Path]) -> Points:
    """Carry points in the frame of the vehicle that saw them into the world [m]."""
    at, _ = _moments(number, times, paths)
    return np.einsum("nij,nj->ni", at.rotations, points) + at.positions


@dataclass(frozen=True, eq=False)
class LinearTies:
    """Ties where the paths lie now, and how each residual changes with its control values."""

    residuals: Scalars
    slopes_a: Float[np.ndarray, "n 6"]
    slopes_b: Float[np.ndarray, "n 6"]
    weights_a: Weights
    weights_b: Weights
    first_a: Indices
    """Place of the first of the control values that count, among those of all paths."""
    first_b: Indices


def linearise(ties: Ties, paths: Sequence[Path]) -> LinearTies:
    """Give the ties' residuals and slopes."""
    at_a, first_a = _moments(ties.pass_a, ties.time_a, paths)
    at_b, first_b = _moments(ties.pass_b, ties.time_b, paths)
    (place_a, slopes_a), (place_b, slopes_b) = (
        lever_points(at.positions, at.rotations, at.turned_by, points, ties.direction)
        for at, points in ((at_a, ties.point_a), (at_b, ties.point_b))
    )
    residuals = place_a - place_b - ties.offset
    return LinearTies(residuals, slopes_a, slopes_b, at_a.weights, at_b.weights, first_a, first_b)


def measure_aside(ties: Ties, paths: Sequence[Path]) -> Float[np.ndarray, "k 2"]:
    """Give how far tiles lie aside of where they belong, along axes that they tell [m]."""
    off = np.where(ties.variance < OPEN, linearise(ties, paths).residuals, 0.0)
    return off.reshape(-1, 3)[:, :2]


def _moments(number: Indices, times: Scalars, paths: Sequence[Path]) -> tuple[Poses, Indices]:
    """Give poses at some times of some passes, and the place of their control values."""
    count = len(times)
    found = Poses(times, np.empty((count, 3)), np.empty((count, 3, 3)), np.empty((count, 3, 3)),
                  np.empty(count, np.int64), np.empty((count, 4)))  # fmt: skip
    place, start = np.empty(count, np.int64), 0
    for i, path in enumerate(paths):
        mine = np.flatnonzero(number == i)
        poses = path.at(times[mine])
        for name in ("positions", "rotations", "turned_by", "first", "weights"):
            getattr(found, name)[mine] = getattr(poses, name)
        place[mine] = start + poses.first
        start += path.knots.num_controls
    return found, place


@dataclass(frozen=True, eq=False)
class TieSums:
    """Normal equations of ties in blocks of 48: four control values of each way."""

    places: Int[np.ndarray, "g 48"]
    matrix: Float[np.ndarray, "g k k"]
    vector: Float[np.ndarray, "g 48"]

    @classmethod
    def stack(cls, parts: Sequence["TieSums"]) -> "TieSums":
        """Put the sums of several sets of ties below one another."""
        return cls(*(np.concatenate([getattr(p, c.name) for p in parts]) for c in fields(cls)))


def sum_ties(linear: LinearTies, weights: Scalars, *, with_matrix: bool = True) -> TieSums:
    """Sum the normal equations of ties, each with its own weight [1/m²]; the matrix if wanted."""
    key = linear.first_a * (int(linear.first_b.max(initial=0)) + 1) + linear.first_b
    order = np.argsort(key, kind="stable")
    key = key[order]
    starts = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
    matrix, vector = (sum_groups if with_matrix else sum_vectors)(
        np.append(starts, len(key)),
        linear.slopes_a[order],
        linear.slopes_b[order],
        linear.weights_a[order],
        linear.weights_b[order],
        linear.residuals[order],
        weights[order],
    )
    inner = np.arange(_BLOCK // 2)
    head = order[starts]
    places = np.hstack(
        [
            WIDTH * linear.first_a[head][:, None] + inner,
            WIDTH * linear.first_b[head][:, None] + inner,
        ]
    )
    return TieSums(places, matrix, vector)
