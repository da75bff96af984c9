"""Where a plane cuts a surface: lines as on a drawing."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import KDTree

from ..errors import NotEnoughData
from ..geometry.row_keys import row_keys
from ..types.arrays import Faces, Indices, Scalars, Vector
from ..types.measurement import Measurement
from ..types.mesh import Mesh
from ..types.plane import Plane
from ..types.quantity import Quantity
from .noise import noise_at
from .sample import Sample

_LEVEL = 0.95
"""Cosine of the angle between a plane's normal and up from which the plane counts as level."""


@dataclass(frozen=True, eq=False)
class CrossSection:
    """The lines in which a plane cuts a surface."""

    plane: Plane
    """The plane, in the world."""
    lines: tuple[Float[np.ndarray, "_ 3"], ...]
    """Each line's corners in order, in the world [m]; a closed one ends where it begins."""
    up: Vector | None = None
    """The direction that the drawing has upwards, as nearly as it can; None: the world's own."""

    @property
    def origin(self) -> Vector:
        """The place of the plane that is nearest to the middle of the lines [m]."""
        middle = np.concatenate(self.lines).mean(axis=0)
        return middle - self.plane.distance_to(middle[None])[0] * self.plane.normal

    @property
    def axes(self) -> np.ndarray:
        """Directions, in the world, of the drawing's x and y; a row each.

        Where a direction is up, y points there, and x to the right of whom the normal points to.
        Otherwise x lies as nearly as it can along the world's x (or y, where the plane lies across
        x); y points where z points as nearly as it can, or else where y points.
        """
        normal = self.plane.normal
        if self.up is not None and abs(normal @ self.up) < _LEVEL:
            right = np.cross(self.up, normal)
            right /= np.linalg.norm(right)
            return np.stack([right, np.cross(normal, right)])
        return _drawing_axes(normal)

    def as_drawing(self) -> tuple[np.ndarray, ...]:
        """Give each line in the drawing's x and y, from `origin` [m]; n 2 each."""
        return tuple((line - self.origin) @ self.axes.T for line in self.lines)


def cut_section(mesh: Mesh, plane: Plane, *, up: Vector | None = None) -> CrossSection:
    """Cut a surface by a plane.

    Args:
        mesh: The surface.
        plane: The plane, in the same frame.
        up: The direction that the drawing has upwards, of unit length.

    Raises:
        NotEnoughData: The plane does not meet the surface.
    """
    heights = plane.distance_to(mesh.vertices)
    # A corner exactly on the plane would belong to no edge: it counts as above.
    above = heights >= 0
    cut = mesh.faces[above[mesh.faces].any(axis=1) & ~above[mesh.faces].all(axis=1)]
    if len(cut) == 0:
        low, high = (float(h) for h in (heights.min(), heights.max()))
        raise NotEnoughData(
            f"The plane does not meet the surface, which lies {low:g} to {high:g} m from it; give "
            "a point on the surface with --point-m."
        )
    edges, places = _crossings(mesh, heights, above, cut)
    return CrossSection(plane, tuple(places[order] for order in _join(edges)), up)


def measure_section(
    section: CrossSection, sample: Sample
) -> tuple[Measurement, list[Float[np.ndarray, " _"]]]:
    """Give the size of a section, and the standard deviation of each of its corners.

    Returns:
        Width and height of the section in its drawing, each from the outermost corners; and for
        each line the standard deviations of its corners across the surface [m].
    """
    tree = KDTree(sample.cloud.points)
    near = [np.asarray(tree.query(line)[1]) for line in section.lines]
    sigmas = [sample.cloud.sigma[which].astype(float) for which in near]
    numbers = np.concatenate(near)
    flat = np.concatenate(section.as_drawing())
    quantities = [
        _extent(name, flat[:, i], section.axes[i], numbers, sample)
        for i, name in enumerate(("width", "height"))
    ]
    details = {
        "lines": len(section.lines),
        "corners": len(flat),
        "origin_m": section.origin.tolist(),
        "x_axis": section.axes[0].tolist(),
        "y_axis": section.axes[1].tolist(),
    }
    places = {"middle": section.origin}
    return Measurement("section", tuple(quantities), details, places=places), sigmas


def _extent(name: str, values: Scalars, axis: Vector, numbers: Indices, sample: Sample) -> Quantity:
    """Give the distance of the outermost corners along a drawing's axis."""
    ends = numbers[[int(np.argmin(values)), int(np.argmax(values))]]
    # Where nobody knows from where an end was seen, it may err along the axis.
    rays = np.tile(axis, (2, 1)) if sample.sight is None else sample.sight.rays[ends]
    noise = noise_at(sample.cloud, sample.cloud.points[ends])
    # Points err along their rays; smoothing then moves the surface along its normals.
    smoothed = sample.cloud.normals[ends].astype(float) @ axis
    independent = float(np.linalg.norm(np.maximum(np.abs(rays @ axis), np.abs(smoothed)) * noise))
    common = None
    if sample.shifts is not None:
        shifts = sample.shifts(ends)
        common = float(np.linalg.norm(axis @ (shifts[1] - shifts[0])))
    return Quantity(name, float(np.ptp(values)), "m", independent, common)


def _crossings(
    mesh: Mesh, heights: Scalars, above: np.ndarray, faces: Faces
) -> tuple[Int[np.ndarray, "m 2"], Float[np.ndarray, "places 3"]]:
    """Give the two cut edges of each face by number (m 2), and where each edge is cut."""
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)
    crossed = above[sides[..., 0]] != above[sides[..., 1]]
    pairs = np.sort(sides[crossed], axis=1)
    _, first, number = np.unique(row_keys(pairs), return_index=True, return_inverse=True)
    a, b = pairs[first].T
    share = heights[a] / (heights[a] - heights[b])
    places = mesh.vertices[a] + share[:, None] * (mesh.vertices[b] - mesh.vertices[a])
    return number.reshape(-1, 2), places


def _join(edges: np.ndarray) -> list[list[int]]:
    """Join pieces that share an end into lines; each place is the end of two pieces at most.

    Where a damaged surface makes three pieces meet, a line ends.
    """
    pieces: dict[int, list[int]] = {}
    for piece, ends in enumerate(edges.tolist()):
        for end in ends:
            pieces.setdefault(end, []).append(piece)
    unused = set(range(len(edges)))
    starts = [e for e, p in pieces.items() if len(p) == 1] + list(pieces)
    lines = []
    for start in starts:
        while line := _walk(start, pieces, edges, unused):
            lines.append(line)
    return lines


def _walk(
    start: int, pieces: dict[int, list[int]], edges: np.ndarray, unused: set[int]
) -> list[int]:
    """Follow unused pieces from an end; empty where there is none."""
    line = [start]
    while True:
        here = line[-1]
        following = next((piece for piece in pieces[here] if piece in unused), None)
        if following is None:
            return line if len(line) > 1 else []
        unused.remove(following)
        first, second = edges[following].tolist()
        line.append(second if first == here else first)


def _drawing_axes(normal: Vector) -> np.ndarray:
    x, y, z = np.eye(3)
    right = x if abs(normal[0]) < 0.9 else y
    right = right - (right @ normal) * normal
    right /= np.linalg.norm(right)
    up = np.cross(normal, right)
    towards = z if abs(up @ z) > 0.1 else y
    return np.stack([right, up if up @ towards > 0 else -up])
