"""How far points lie from a surface."""

import math

from ..types.arrays import Points, Scalars
from ..types.mesh import Mesh
from .closest import find_closest


def distance_to_mesh(points: Points, mesh: Mesh, *, within: float = math.inf) -> Scalars:
    """Give the distance of each point to the nearest place of a surface [m], in the same frame.

    Args:
        points: The points [m].
        mesh: The surface.
        within: Distance beyond which none is looked for [m]: it is given as infinite.
    """
    return find_closest(points, mesh, within=within).distance
