"""Ties: that two legs saw one surface in the same place.

A tie joins a point at one moment with a point at another along one direction. Both moments' poses
enter, so that it says how the vehicle moved from one to the other.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Float, Int

from ..._kernels.ties import sum_groups, sum_vectors
from ...types.arrays import Directions, Indices, Points, Scalars
from .path import WIDTH, Path, Poses
from .spline import Weights

_BLOCK = 2 * 4 * WIDTH


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
    at, _, _ = _moments(number, times, points, paths)
    return np.einsum("nji,nj->ni", at.rotations, points - at.positions)


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
    at_a, place_a, arms_a = _moments(ties.pass_a, ties.time_a, ties.point_a, paths)
    at_b, place_b, arms_b = _moments(ties.pass_b, ties.time_b, ties.point_b, paths)
    between = at_a.positions + arms_a - at_b.positions - arms_b
    return LinearTies(
        np.einsum("ni,ni->n", ties.direction, between) - ties.offset,
        _slopes(ties.direction, arms_a, at_a),
        _slopes(ties.direction, arms_b, at_b),
        at_a.weights,
        at_b.weights,
        place_a,
        place_b,
    )


def _moments(
    number: Indices, times: Scalars, points: Points, paths: Sequence[Path]
) -> tuple[Poses, Indices, Points]:
    """Give poses at some times of some passes, the place of their control values, and arms."""
    count = len(times)
    found = Poses(times, np.empty((count, 3)), np.empty((count, 3, 3)), np.empty((count, 3, 3)),
                  np.empty(count, np.int64), np.empty((count, 4)))  # fmt: skip
    place, start = np.empty(count, np.int64), 0
    for i, path in enumerate(paths):
        mine = np.flatnonzero(number == i)
        if len(mine) == 0:
            start += path.knots.num_controls
            continue
        # Few moments stand behind many ties: those of the rows of cells.
        moments, which = np.unique(times[mine], return_inverse=True)
        poses = path.at(moments)
        for name in ("positions", "rotations", "turned_by", "first", "weights"):
            getattr(found, name)[mine] = getattr(poses, name)[which]
        place[mine] = start + poses.first[which]
        start += path.knots.num_controls
    return found, place, np.einsum("nij,nj->ni", found.rotations, points)


def _slopes(direction: Directions, arms: Points, poses: Poses) -> Float[np.ndarray, "n 6"]:
    turn = np.einsum("nji,nj->ni", poses.turned_by, np.cross(arms, direction))
    return np.hstack([direction, turn])


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
