"""Points in front of what was seen through them: a fish, a cloud of silt, a reflection.

A ray from the camera to a measured point has passed through water only. Where it pierces a patch
of other points on its way, one of the two is false::

      camera ──────────▶ patch ─────────────▶ point
"""

from dataclasses import dataclass
from typing import final

import numpy as np
from jaxtyping import Int

from ..errors import InputError
from ..geometry.grid import NONE, ScanGrid
from ..geometry.ray_casting import RayCaster
from ..types.arrays import Faces, Indices, Mask
from ..types.mesh import Mesh
from ..types.rays import Rays
from .base import AbstractOutlierRule, SeenCloud
from .pieces import number_pieces

Pierced = tuple[Int[np.ndarray, " pairs"], Int[np.ndarray, " pairs"]]
"""Rays, and the patch that each of them pierces."""

_SIGMAS = 4.0
"""Standard deviations that a ray may end behind a patch and still be of it."""
_FACING = 0.35
"""Cosine of the angle between ray and normal below which a patch is grazed, not pierced."""
_PIERCED = 0.25
"""Share of the patches of a piece that rays must have pierced. A cell of the grid has two patches
and is met by one ray, so it is about half of them where the whole piece is false; where poses or a
rig are millimetres off, rays pierce a true piece, too, but along its edges only."""
_RAYS = 50_000
"""Rays that are cast together: what lies between takes 10 MB."""
_BEHIND = 0.5
"""Share of the points of a piece that must lie behind larger pieces."""


@final
@dataclass(frozen=True)
class SeenThrough(AbstractOutlierRule):
    """Points that rays to other points go through, and points behind a surface that hides them.

    Neighbours on the scan's grid make patches, and points that hang together a piece. Where rays
    pierce a piece far in front of their ends, over its whole width, the smaller of the two is
    false and goes as a whole: a fish before a hull, or the hull's mirror image behind it.
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
        faces, piece = _patches(grid), number_pieces(grid)
        if len(faces) == 0:
            return is_false
        ray, face = self._pierce(seen, faces)
        size, piece_of_face = np.bincount(piece), piece[faces[:, 0]]
        of_two = piece_of_face[face] != piece[ray]
        ray, face = ray[of_two], face[of_two]
        is_front = size[piece_of_face[face]] <= size[piece[ray]]
        pierced = np.bincount(piece_of_face[np.unique(face[is_front])], minlength=len(size))
        behind = np.bincount(piece[ray[~is_front]], minlength=len(size))
        patches = np.bincount(piece_of_face, minlength=len(size))
        is_false_piece = (pierced > _PIERCED * patches) | (behind > _BEHIND * size)
        return is_false_piece[piece]

    def _pierce(self, seen: SeenCloud, faces: Faces) -> Pierced:
        """Give which rays pierce which patches clearly in front of their end."""
        caster = RayCaster(Mesh(seen.cloud.points, faces))
        found = [
            self._pierce_by(caster, seen, np.arange(start, min(start + _RAYS, len(seen.cloud))))
            for start in range(0, len(seen.cloud), _RAYS)
        ]
        rays, pierced = zip(*found, strict=True)
        return np.concatenate(rays), np.concatenate(pierced)

    def _pierce_by(self, caster: RayCaster, seen: SeenCloud, which: Indices) -> Pierced:
        between = seen.cloud.points[which] - seen.cameras[which]
        lengths = np.linalg.norm(between, axis=1)
        rays = Rays(seen.cameras[which], between / np.maximum(lengths, 1e-12)[:, None])
        hits = caster.first_hits(rays)
        room = self.clearance * lengths + _SIGMAS * np.nan_to_num(seen.cloud.sigma[which])
        ray = np.flatnonzero(hits.is_hit & (hits.range < lengths - room))
        face = hits.face[ray]
        facing = np.einsum("ij,ij->i", rays.directions[ray], caster.normals[face])
        pierced = np.abs(facing) > _FACING
        return which[ray[pierced]], face[pierced]


def _patches(grid: ScanGrid) -> Faces:
    """Make triangles between neighbours."""
    along, across = grid.linked(0, 1), grid.linked(1, 0)
    corner = np.flatnonzero((along != NONE) & (across != NONE))
    opposite = across[along[corner]]
    closed = (opposite != NONE) & (opposite == along[across[corner]])
    a, d = corner[closed], opposite[closed]
    b, c = along[a], across[a]
    return np.concatenate([np.stack([a, b, d], axis=1), np.stack([a, d, c], axis=1)])
