"""Points in front of what was seen through them: a fish, a cloud of silt, a reflection.

A ray from the camera to a measured point has passed through water only. Where it pierces a patch
of other points on its way, one of the two is false::

      camera ──────────▶ patch ─────────────▶ point
"""

from dataclasses import dataclass
from typing import final

import numpy as np
from jaxtyping import Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..errors import InputError
from ..geometry.grid import NONE, ScanGrid
from ..geometry.ray_casting import RayCaster
from ..types.arrays import Faces, Indices, Mask, Scalars
from ..types.mesh import Mesh
from ..types.rays import Rays
from .base import AbstractOutlierRule, SeenCloud

_SIGMAS = 4.0
"""Standard deviations that a ray may end behind a patch and still be of it."""
_FACING = 0.35
"""Cosine of the angle between ray and normal below which a patch is grazed, not pierced."""
_PIERCED = 0.3
"""Share of the patches around a point that rays must have pierced. A cell of the grid has two
patches and is met by one ray: about half of them are, and at a true edge only those beyond it."""
_FEWEST = 3
"""Rays that must have gone through around a point."""
_ROUNDS = 3
"""Times that points go with most of their neighbours: rays fall by chance, and fewer at a rim."""


@final
@dataclass(frozen=True)
class SeenThrough(AbstractOutlierRule):
    """Points that rays to other points go through, and points behind a surface that hides them.

    Neighbours on the scan's grid make patches, and patches that hang together a piece. Where a ray
    pierces a patch far in front of its end, the smaller piece is false: a fish before a hull, or
    the hull's mirror image behind it.
    """

    clearance: float = 0.05
    """How far in front of its end a ray must pierce a patch, in the ray's length: more than a pose
    log drifts between two passes."""

    def __post_init__(self) -> None:
        """Refuse a clearance of nothing."""
        if not 0 < self.clearance < 1:
            raise InputError(f"clearance must lie between 0 and 1, got {self.clearance:g}.")

    @property
    def cause(self) -> str:
        """See `AbstractOutlierRule.cause`."""
        return "visibility"

    def find(self, seen: SeenCloud) -> Mask:
        """See `AbstractOutlierRule.find`."""
        is_false = np.zeros(len(seen.cloud), bool)
        if len(seen.cloud) == 0:
            return is_false
        grid = seen.lay_grid()
        faces, pieces = _patches(grid)
        if len(faces) == 0:
            return is_false
        ray, face = self._pierce(seen, faces)
        size = np.bincount(pieces)
        is_front = size[pieces[faces[face, 0]]] <= size[pieces[ray]]
        is_false[ray[~is_front]] = True
        is_false |= _surrounded(faces, face[is_front], len(is_false))
        return is_false

    def _pierce(
        self, seen: SeenCloud, faces: Faces
    ) -> tuple[Int[np.ndarray, " rays"], Int[np.ndarray, " rays"]]:
        """Give which rays pierce which patches clearly in front of their end."""
        caster = RayCaster(Mesh(seen.cloud.points, faces))
        between = seen.cloud.points - seen.cameras
        lengths = np.linalg.norm(between, axis=1)
        rays = Rays(seen.cameras, between / np.maximum(lengths, 1e-12)[:, None])
        hits = caster.first_hits(rays)
        room = self.clearance * lengths + _SIGMAS * np.nan_to_num(seen.cloud.sigma)
        ray = np.flatnonzero(hits.is_hit & (hits.range < lengths - room))
        face = hits.face[ray]
        facing = np.einsum("ij,ij->i", rays.directions[ray], caster.normals[face])
        pierced = np.abs(facing) > _FACING
        return ray[pierced], face[pierced]


def _patches(grid: ScanGrid) -> tuple[Faces, Indices]:
    """Make triangles between neighbours; number the piece that each point belongs to."""
    along, across = grid.linked(0, 1), grid.linked(1, 0)
    corner = np.flatnonzero((along != NONE) & (across != NONE))
    opposite = across[along[corner]]
    closed = (opposite != NONE) & (opposite == along[across[corner]])
    a, d = corner[closed], opposite[closed]
    b, c = along[a], across[a]
    faces = np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)])
    return faces, _number_pieces(along, across)


def _number_pieces(along: Indices, across: Indices) -> Indices:
    count = len(along)
    here = np.concatenate([np.flatnonzero(links != NONE) for links in (along, across)])
    there = np.concatenate([links[links != NONE] for links in (along, across)])
    links = coo_array((np.ones(len(here), bool), (here, there)), shape=(count, count))
    return connected_components(links, directed=False)[1].astype(np.int64)


def _surrounded(faces: Faces, pierced: Int[np.ndarray, " rays"], count: int) -> Mask:
    """Find the points that enough rays have gone through on all sides, and what lies between."""
    rays = np.bincount(pierced, minlength=len(faces)).astype(float)
    around = _add_up(faces, np.ones(len(faces)), count)
    through = _add_up(faces, (rays > 0).astype(float), count)
    found = (through > _PIERCED * around) & (_add_up(faces, rays, count) >= _FEWEST)
    for _ in range(_ROUNDS if found.any() else 0):
        others = found[faces].sum(axis=1, keepdims=True) - found[faces]
        of_found = np.bincount(faces.ravel(), weights=others.ravel(), minlength=count)
        found |= of_found > np.maximum(around, 1)
    return found


def _add_up(faces: Faces, values: Float[np.ndarray, " m"], count: int) -> Scalars:
    return np.bincount(faces.ravel(), weights=np.repeat(values, 3), minlength=count)
