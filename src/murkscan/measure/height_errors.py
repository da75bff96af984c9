"""How far the corners of a surface lie from the smoothest one that they agree with."""

import math
from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from ..errors import NotEnoughData
from ..geometry.height_map import MapFrame
from ..geometry.spline_surface import fit_spline_surface
from ..types.arrays import Points, Scalars, Vector

_PIECES = (1, 2, 4, 8, 16)
"""Pieces of a spline along the longer side, one after the other."""
_CELLS = 64
"""Cells of the map that splines are fitted to, along the longer side at most."""
_AGREES = 1.5
"""Noise of the points up to which a surface leaves them by chance."""
_EDGE = 4.0
"""Robust standard deviations beyond which a height differs by shape."""
_GAUSSIAN = 1.4826
_TUKEY = 4.685
_ROUNDS = 8


def find_height_errors(vertices: Points, up: Vector, *, noise: float) -> Scalars:
    """Give how far each corner lies from a smooth surface, along a direction [m].

    The surface is a plane, a paraboloid or a spline of more and more pieces: the first that leaves
    the corners by no more than their noise, for what it follows without need is no error any more.

    Args:
        vertices: The corners of a surface [m].
        up: The direction, unit length.
        noise: Their standard deviation [m].
    """
    errors = np.zeros(len(vertices))
    for surface in _surfaces(vertices, up):
        errors = surface
        if _spread(errors) <= _AGREES * noise:
            break
    # At an edge the smooth surface is what errs.
    limit = _EDGE * _spread(errors)
    return np.clip(errors, -limit, limit)


def _spread(errors: Scalars) -> float:
    return _GAUSSIAN * float(np.median(np.abs(errors)))


def _surfaces(vertices: Points, up: Vector) -> Iterator[Scalars]:
    """Give the errors beside each surface, the smoothest first."""
    side = float(np.sort(np.ptp(vertices, axis=0))[1])
    cell = max(side / _CELLS, 2 * side / math.sqrt(len(vertices)), 1e-6)
    frame = MapFrame.over(vertices, np.broadcast_to(up, vertices.shape), cell)
    located = frame.locate(vertices)
    x, y = (located[:, :2] / side - 0.5).T
    ones = np.ones_like(x)
    for terms in ([ones, x, y], [ones, x, y, x * x, x * y, y * y]):
        yield _leave(np.stack(terms, axis=1), located[:, 2])
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
        yield located[:, 2] - surface.heights(located[:, :2])


def _leave(design: Float[np.ndarray, "n p"], heights: Scalars) -> Scalars:
    """Give what a robust fit leaves, by Tukey's weights as those of a spline."""
    weights, errors = np.ones(len(heights)), heights
    for _ in range(_ROUNDS):
        solved = np.linalg.lstsq(weights[:, None] * design, weights * heights, rcond=None)[0]
        errors = heights - design @ solved
        limit = _TUKEY * max(_spread(errors), 1e-9)
        weights = np.clip(1 - (errors / limit) ** 2, 0.0, None)
    return errors
