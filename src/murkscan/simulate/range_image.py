"""How far everything is that a picture shows: with few rays where the surface is flat."""

import cv2
import numpy as np
from jaxtyping import Bool, Float

from ..geometry.ray_casting import Hits, RayCaster
from ..types.arrays import Scalars
from ..types.rays import Rays

_BLOCK = 4
"""Pixels from one node to the next at which the surface is first looked up."""
_BENT = 0.002
"""Share of its nearness by which a block's corners may miss a plane and still count as flat."""
_STEEP = 1.05
"""Ratio of ranges within a block above which it counts as an edge."""

Grid = Float[np.ndarray, "rows columns"]


def cast_picture(caster: RayCaster, rays: Rays, shape: tuple[int, int]) -> Hits:
    """Find what each pixel of a picture shows; the rays are its pixels', row by row.

    The corners of blocks of pixels are cast. In blocks that are flat the ranges between are
    interpolated; in others, and beside them, every pixel is cast.
    """
    nodes = tuple(np.append(np.arange(0, size - 1, _BLOCK), size - 1) for size in shape)
    which = (nodes[0][:, None] * shape[1] + nodes[1]).ravel()
    hits = caster.first_hits(Rays(rays.origins[which], rays.directions[which]))
    grid = (len(nodes[0]), len(nodes[1]))
    near = np.zeros(grid)
    near.ravel()[hits.is_hit] = 1 / np.maximum(hits.range[hits.is_hit], 1e-6)
    blocks = [np.minimum(np.arange(n) // _BLOCK, g - 2) for n, g in zip(shape, grid, strict=True)]
    face = hits.face.reshape(grid)[np.ix_(*blocks)].ravel()
    ranges = _between(near, nodes, shape)
    left = np.flatnonzero(_is_bent(near)[np.ix_(*blocks)].ravel())
    again = caster.first_hits(Rays(rays.origins[left], rays.directions[left]))
    face[left], ranges[left] = again.face, again.range
    return Hits(face, np.where(face >= 0, ranges, np.inf))


def _is_bent(near: Grid) -> Bool[np.ndarray, "down right"]:
    """Tell which blocks, or blocks beside them, are no plane; 1 / range is linear over one."""
    corners = np.stack([near[:-1, :-1], near[1:, 1:], near[1:, :-1], near[:-1, 1:]])
    low, high = corners.min(axis=0), corners.max(axis=0)
    twist = np.abs(corners[0] + corners[1] - corners[2] - corners[3])
    bent = (twist > _BENT * high) | (high > _STEEP * low)
    return cv2.dilate(bent.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool)


def _between(near: Grid, nodes: tuple[np.ndarray, ...], shape: tuple[int, int]) -> Scalars:
    """Interpolate the ranges of all pixels between the nodes'."""
    places = [
        np.interp(np.arange(size), node, np.arange(len(node)))
        for size, node in zip(shape, nodes, strict=True)
    ]
    v, u = (place.astype(np.float32) for place in np.meshgrid(*places, indexing="ij"))
    fine = cv2.remap(near, u, v, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return (1 / np.maximum(fine, 1e-12)).ravel().astype(float)
