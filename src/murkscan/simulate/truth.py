"""Measures of a surface: slopes, normals, distances to it, and a mesh of it."""

import numpy as np

from ..types.arrays import Directions, Points, Scalars
from ..types.mesh import Mesh
from .base import AbstractSurface

_STEP = 1e-6
"""Half the base of a difference quotient [m]: both its errors stay below 1e-8."""


def surface_normals(surface: AbstractSurface, x: Scalars, y: Scalars) -> Directions:
    """Give the unit normals at x and y [m], turned towards the camera (- z)."""
    along_x = surface.depth(x + _STEP, y) - surface.depth(x - _STEP, y)
    along_y = surface.depth(x, y + _STEP) - surface.depth(x, y - _STEP)
    normals = np.stack([along_x, along_y, np.full_like(x, -2 * _STEP)], axis=1)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def distance_to_surface(surface: AbstractSurface, points: Points) -> Scalars:
    """Give the signed distance of each point to the surface [m], positive on the camera's side.

    The foot of the perpendicular is found by meeting the tangent plane again and again; this
    settles where the distance is small against the surface's radius of curvature.

    Args:
        surface: The true surface; it also counts where it goes on beyond its painted edge.
        points: Points in the world frame [m].
    """
    foot = points.copy()
    for _ in range(8):
        foot[:, 2] = surface.depth(foot[:, 0], foot[:, 1])
        normals = surface_normals(surface, foot[:, 0], foot[:, 1])
        distance = np.einsum("ij,ij->i", points - foot, normals)
        foot = points - distance[:, None] * normals
    return distance


def sample_mesh(surface: AbstractSurface, *, spacing: float) -> Mesh:
    """Make a mesh of the surface, in the world frame.

    Args:
        surface: The true surface.
        spacing: Distance of neighbouring vertices along x and along y [m].

    Returns:
        Triangles that face the camera; every vertex lies on the surface, and the edge is true to
        one spacing.
    """
    (x0, y0, _), (x1, y1, _) = surface.box()
    x, y = np.arange(x0, x1 + spacing / 2, spacing), np.arange(y0, y1 + spacing / 2, spacing)
    grid_x, grid_y = (g.ravel() for g in np.meshgrid(x, y))
    number = np.arange(len(grid_x)).reshape(len(y), len(x))
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    # Counter-clockwise seen from the camera, for which x is right and y is down.
    faces = np.stack([a, d, b, b, d, c], axis=-1).reshape(-1, 3)
    faces = faces[surface.covers(grid_x, grid_y)[faces].all(axis=1)]
    used, faces = np.unique(faces, return_inverse=True)
    vertices = np.stack([grid_x, grid_y, surface.depth(grid_x, grid_y)], axis=1)[used]
    return Mesh(vertices, faces.reshape(-1, 3))
