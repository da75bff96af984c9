"""Where one sheet of a surface lies on another: the same surface, seen twice."""

import numpy as np

from ..types.arrays import Indices, Mask
from ..types.mesh import Mesh
from ..types.rays import Rays
from .closest import face_normals, find_closest
from .ray_casting import RayCaster

_REACH = 3.0
"""Distance of two sheets, in usual sides of their triangles, up to which they are one surface."""
_ALIKE = 0.7
"""Cosine of the angle between their normals: the other side of a plate is another surface."""
_OFF = 1e-3
"""Distance from a triangle, in the same sides, at which another one begins to count."""


def lies_on(sheet: Mesh, others: Mesh) -> Mask:
    """Tell which triangles of a sheet lie on other sheets: along these, not beside their rims.

    Args:
        sheet: A surface.
        others: One or more, in the same frame, turned to the same side.
    """
    reach = _REACH * max(_usual_side(sheet), _usual_side(others))
    closest = find_closest(sheet.vertices[sheet.faces].mean(axis=1), others, within=reach)
    over = np.flatnonzero((closest.face >= 0) & ~closest.is_at_rim)
    normals, theirs = face_normals(sheet)[over], face_normals(others)[closest.face[over]]
    is_on = np.zeros(len(sheet.faces), bool)
    is_on[over] = np.einsum("ij,ij->i", normals, theirs) > _ALIKE
    return is_on


def has_another_sheet(mesh: Mesh, some: Indices) -> Mask:
    """Tell which of some triangles have another one of the same surface before or behind them."""
    side = _usual_side(mesh)
    normals = face_normals(mesh)
    middles = mesh.vertices[mesh.faces[some]].mean(axis=1)
    caster = RayCaster(mesh)
    found = np.zeros(len(some), bool)
    for towards in (normals[some], -normals[some]):
        hits = caster.first_hits(Rays(middles + _OFF * side * towards, towards))
        alike = np.einsum("ij,ij->i", normals[hits.face], normals[some]) > _ALIKE
        found |= hits.is_hit & (hits.range < _REACH * side) & alike
    return found


def _usual_side(mesh: Mesh) -> float:
    """Give the longest side of the triangle in the middle of the area, in order of sides [m]."""
    corners = mesh.vertices[mesh.faces]
    along = np.roll(corners, -1, axis=1) - corners
    sides = np.linalg.norm(along, axis=2).max(axis=1)
    order = np.argsort(sides)
    areas = np.cumsum(np.linalg.norm(np.cross(along[:, 0], along[:, 1]), axis=1)[order])
    return float(sides[order[np.searchsorted(areas, areas[-1] / 2)]])
