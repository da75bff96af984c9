"""How far points of a surface lie from the smoothest one that they agree with."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.special import ndtri

from ..errors import NotEnoughData
from ..geometry.correlated_errors import variance_of_sum
from ..geometry.height_map import MapFrame
from ..geometry.row_keys import row_keys
from ..geometry.spline_surface import fit_spline_surface
from ..types.arrays import Indices, Points, Scalars, Vector

_PIECES = (1, 2, 4, 8, 16)
"""Pieces of a spline along the longer side, one after the other."""
_CELLS = 64
"""Cells of the map that splines are fitted to, along the longer side at most."""
_AGREES, _NEARLY_ALL = 1.15, 0.9
"""Share of the points, and how far they may lie off over what noise alone leaves: a misfit of half
the noise then still counts as one."""
_EDGE = 4.0
"""Robust standard deviations beyond which a height differs by shape."""
_TUKEY = 4.685
_ROUNDS = 8


@dataclass(frozen=True, eq=False)
class HeightErrors:
    """How far points lie from a smooth surface, and what that surface may have followed of it."""

    values: Scalars
    """[m]."""
    pieces: Indices
    """Number of the surface's piece under each point."""

    def variance_of_sum(
        self, weights: Scalars, profile: Indices, line: Indices, *, noise: float
    ) -> float:
        """Compute the variance of a weighted sum of the heights' errors.

        Noise that the points state and the surface does not leave was followed by its pieces: each
        is off alike by that much.

        Args:
            weights: Weight of each error in the sum.
            profile: Number of each point's profile.
            line: Number of each point's scan line.
            noise: Standard deviation of a point [m].
        """
        followed = max(noise**2 - float(np.mean(self.values**2)), 0.0)
        together = np.bincount(self.pieces, weights)
        own = variance_of_sum(weights, self.values, profile, line)
        return own + followed * float(together @ together)


def find_height_errors(points: Points, up: Vector, *, noise: float) -> HeightErrors:
    """Find how far each point lies from a smooth surface, along a direction.

    The surface is a plane, a paraboloid or a spline of more and more pieces: the first that nine
    of ten points leave by no more than their noise, for what it follows without need is no error
    any more. A surface that most points agree with is not enough: what stands out of a wall would
    count as its error.

    Args:
        points: Points of a surface [m].
        up: The direction, unit length.
        noise: Their standard deviation [m].
    """
    found = HeightErrors(np.zeros(len(points)), np.zeros(len(points), np.int64))
    for found in _surfaces(points, up):
        if _spread(found.values, _NEARLY_ALL) <= _AGREES * noise:
            break
    # At an edge the smooth surface is what errs.
    limit = _EDGE * _spread(found.values)
    return replace(found, values=np.clip(found.values, -limit, limit))


def _spread(errors: Scalars, share: float = 0.5) -> float:
    """Give the standard deviation of Gaussian errors of which a share lies as far off as here."""
    return float(np.quantile(np.abs(errors), share) / ndtri((1 + share) / 2))


def _surfaces(points: Points, up: Vector) -> Iterator[HeightErrors]:
    """Give the errors beside each surface, the smoothest first."""
    side = float(np.sort(np.ptp(points, axis=0))[1])
    cell = max(side / _CELLS, 2 * side / math.sqrt(len(points)), 1e-6)
    frame = MapFrame.over(points, np.broadcast_to(up, points.shape), cell)
    located = frame.locate(points)
    x, y = (located[:, :2] / side - 0.5).T
    ones = np.ones_like(x)
    for terms in ([ones, x, y], [ones, x, y, x * x, x * y, y * y]):
        errors = _leave(np.stack(terms, axis=1), located[:, 2])
        yield HeightErrors(errors, np.arange(len(points)))
    _, count = frame.gather(located, located[:, 2])
    rows, columns = np.nonzero(count)
    means = [frame.gather(located, v)[0][rows, columns] / count[rows, columns] for v in located.T]
    places, heights = np.stack(means[:2], axis=1), means[2]
    extent = (frame.shape[1] * cell, frame.shape[0] * cell)
    for pieces in _PIECES:
        try:
            surface = fit_spline_surface(
                places, heights, spacing=max(extent) / pieces, extent=extent
            )
        except NotEnoughData:
            return
        squares = (located[:, :2] // (max(extent) / pieces)).astype(int)
        number = np.unique(row_keys(squares), return_inverse=True)[1]
        yield HeightErrors(located[:, 2] - surface.heights(located[:, :2]), number)


def _leave(design: Float[np.ndarray, "n p"], heights: Scalars) -> Scalars:
    """Give what a robust fit leaves, by Tukey's weights as those of a spline."""
    weights, errors = np.ones(len(heights)), heights
    for _ in range(_ROUNDS):
        solved = np.linalg.lstsq(weights[:, None] * design, weights * heights, rcond=None)[0]
        errors = heights - design @ solved
        limit = _TUKEY * max(_spread(errors), 1e-9)
        weights = np.clip(1 - (errors / limit) ** 2, 0.0, None)
    return errors
