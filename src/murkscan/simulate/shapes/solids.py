"""Closed solids: rings of points joined by triangles, and parts put together to one mesh."""

import math
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int

from ...types.arrays import Directions, Faces, Points
from ...types.mesh import Mesh

Rings = Float[np.ndarray, "rings points 3"]
"""Closed loops of points [m], one behind the other along a tube."""
Line = Float[np.ndarray, "_ axes"]
"""Points of a line, one a row, of any number of coordinates."""
Sections = Float[np.ndarray, "rings points 2"]
"""Flat closed loops, one a stage of a way."""
Cuts = Float[np.ndarray, "_"]
"""Where a grid is cut along one axis [m], growing."""
Blocks = Bool[np.ndarray, "columns rows layers"]
"""Which blocks of a grid are solid."""
VertexGrid = Int[np.ndarray, "rows columns"]
"""Numbers of vertices that lie in a grid."""


def close_tube(rings: Rings) -> Mesh:
    """Make the solid whose cross-sections are rings, with a lid on both ends.

    Args:
        rings: The loops, each of which its middle sees in full. Seen from where the tube leads to,
            they run counter-clockwise.

    Returns:
        A closed surface; each lid is a fan of triangles about the middle of its ring.
    """
    count, points, _ = rings.shape
    number = np.arange(count * points).reshape(count, points)
    around = np.append(number, number[:, :1], axis=1)
    start, end = count * points, count * points + 1
    faces = [grid_faces(around), fan_faces(start, around[0, ::-1]), fan_faces(end, around[-1])]
    middles = rings[[0, -1]].mean(axis=1)
    return Mesh(np.concatenate([rings.reshape(-1, 3), middles]), np.concatenate(faces))


def sweep_section(
    sections: Sections, middles: Points, across: Directions, outwards: Directions
) -> Mesh:
    """Make the solid that a cross-section leaves on its way, with a lid on both ends.

    Args:
        sections: The outline on each stage of the way [m], as coordinates along `across` and
            `outwards`; counter-clockwise.
        middles: Where the coordinates are 0 [m]; one a stage.
        across: Unit directions; across x outwards points along the way.
        outwards: Unit directions at a right angle to `across`.
    """
    rings = sections[..., :1] * across[:, None] + sections[..., 1:] * outwards[:, None]
    return close_tube(middles[:, None] + rings)


def turn_profile(profile: Line, *, step: float) -> Mesh:
    """Make the solid of revolution about z whose outside a profile runs along.

    Args:
        profile: Radius and z [m], so that the outside lies to the right as z grows. Both ends are
            closed by a flat lid.
        step: Side of a triangle [m].
    """
    fine = refine_line(profile, step)
    angles = np.linspace(0, math.tau, round(math.tau * fine[:, 0].max() / step), endpoint=False)
    circle = np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=1)
    return close_tube(fine[:, :1, None] * circle + fine[:, 1:, None] * np.array([0.0, 0.0, 1.0]))


def refine_line(corners: Line, step: float) -> Line:
    """Put points between the corners of a line, none farther apart than a step [m]."""
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    counts = np.maximum(np.ceil(lengths / step), 1).astype(int)
    between = [i + np.arange(count) / count for i, count in enumerate(counts)]
    at = np.append(np.concatenate(between), len(corners) - 1)
    numbers = np.arange(len(corners))
    return np.stack([np.interp(at, numbers, column) for column in corners.T], axis=1)


def rectangle_outline(width: float, low: float, high: float, step: float) -> Line:
    """Give a rectangle's outline, counter-clockwise: across - width/2 to width/2, low to high."""
    half = width / 2
    corners = [(-half, low), (half, low), (half, high), (-half, high), (-half, low)]
    return refine_line(np.array(corners), step)[:-1]


def grid_faces(number: VertexGrid) -> Faces:
    """Halve the cells of a grid: counter-clockwise seen with rows upwards and columns rightwards.

    Along a tube whose rings are the rows that is from outside.
    """
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    return np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


def fan_faces(middle: int, around: np.ndarray) -> Faces:
    """Join each two neighbours of a row of vertices with one vertex."""
    return np.stack([np.full(len(around) - 1, middle), around[:-1], around[1:]], axis=1)


def join_meshes(parts: Sequence[Mesh]) -> Mesh:
    """Put meshes of one frame together; each keeps its own vertices."""
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    faces = [part.faces + start for part, start in zip(parts, starts, strict=True)]
    return Mesh(np.concatenate([part.vertices for part in parts]), np.concatenate(faces))


def enclose_blocks(x: Cuts, y: Cuts, z: Cuts, filled: Blocks) -> Mesh:
    """Make the surface of the filled blocks of a grid.

    Args:
        x: Where the blocks begin and end along x.
        y: The same along y.
        z: The same along z.
        filled: Which blocks are solid, as [x, y, z].

    Returns:
        Two triangles for each side of a block that is open to the outside.
    """
    number = np.arange(len(x) * len(y) * len(z)).reshape(len(x), len(y), len(z))
    solid = np.pad(filled, 1).astype(np.int8)
    faces = []
    for axis in range(3):
        # Seen along this axis, the two that follow it in turn are right and up.
        order = (axis, (axis + 1) % 3, (axis + 2) % 3)
        change = np.diff(np.transpose(solid, order)[:, 1:-1, 1:-1], axis=0)
        corner = np.transpose(number, order)
        a, b, c, d = corner[:, :-1, :-1], corner[:, 1:, :-1], corner[:, 1:, 1:], corner[:, :-1, 1:]
        quads = np.stack([a, b, c, d], axis=-1)
        faces += [quads[change < 0], quads[change > 0][:, ::-1]]
    corners = np.concatenate(faces)
    used, corners = np.unique(corners[:, [0, 1, 2, 0, 2, 3]], return_inverse=True)
    i, j, k = np.unravel_index(used, number.shape)
    return Mesh(np.stack([x[i], y[j], z[k]], axis=1), corners.reshape(-1, 3))
