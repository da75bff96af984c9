"""Area of a surface, and the volume between it and a plane."""

import math

import numpy as np

from ..errors import NotEnoughData
from ..geometry.clip import clip_mesh
from ..types.arrays import Scalars, Vector
from ..types.measurement import Measurement
from ..types.mesh import Mesh
from ..types.plane import Plane
from ..types.quantity import Quantity
from .height_errors import find_height_errors
from .sample import Sample
from .selection import Selection
from .surface import (
    area_vectors,
    nearest_points,
    require_one_sheet,
    rig_modes,
    rim_lengths,
)
from .trust import FitUncertainty

_TILT = 0.05
"""Standard deviation of a cloud's normals [rad], to which they are smoothed."""
_HALVINGS, _MOST = 3, 20
"""How often the sides of triangles on the border of a selection are halved, and those of huge ones
there at the most."""
_FINE, _FINEST = 4.0, 500.0
"""Shortest side of a part of space over those of triangles that cannot hold it between their
corners; its diagonal over those of the finest."""


def cut_out(mesh: Mesh, selection: Selection | None) -> Mesh:
    """Give the part of a surface that lies in a part of space.

    Triangles on its border are divided into 64, of which those count whose middle lies inside:
    whole ones would leave out half a triangle's width all around.

    Raises:
        NotEnoughData: There is none.
    """
    import trimesh

    if selection is None:
        return mesh
    mesh = _divide_large(mesh, selection)
    corners = selection.contains(mesh.vertices)[mesh.faces]
    inside, cut = corners.all(axis=1), corners.any(axis=1) & ~corners.all(axis=1)
    vertices, small = mesh.vertices, mesh.faces[cut]
    for _ in range(_HALVINGS):
        vertices, small = trimesh.remesh.subdivide(vertices, small)
    small = small[selection.contains(vertices[small].mean(axis=1))]
    if not inside.any() and len(small) == 0:
        raise NotEnoughData(
            f"None of the {len(mesh.faces)} triangles lies in the selection; choose another part."
        )
    return Mesh(vertices, np.concatenate([mesh.faces[inside], small])).compact()


def _divide_large(mesh: Mesh, selection: Selection) -> Mesh:
    """Divide triangles near a part of space that could hold it between their corners."""
    import trimesh

    low, high = selection.bounds
    size = high - low
    longest = max(float(size.min()) / _FINE, float(np.linalg.norm(size)) / _FINEST)
    corners = mesh.vertices[mesh.faces]
    near = ((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    if not (near & (sides > longest)).any():
        return mesh
    part = clip_mesh(Mesh(mesh.vertices, mesh.faces[near]), low, high)
    vertices, faces = trimesh.remesh.subdivide_to_size(part.vertices, part.faces, longest, _MOST)
    return Mesh(np.asarray(vertices), np.asarray(faces, np.int32))


def measure_area(mesh: Mesh, sample: Sample) -> Measurement:
    """Give the area that a scan's triangles cover.

    Triangles of noisy points are crooked and add up to too much: each counts as it is seen along
    the smoothed normal of its corners. What is not covered by triangles is not counted.

    Args:
        mesh: The surface.
        sample: The points it was made of.

    Raises:
        InputError: Sheets of it lie on one another.
    """
    require_one_sheet(mesh)
    vectors = area_vectors(mesh)
    number = nearest_points(sample, mesh.vertices)
    normals = sample.cloud.normals[number].astype(float)[mesh.faces].sum(axis=1)
    length = np.linalg.norm(normals, axis=1)
    flat = np.linalg.norm(vectors, axis=1)
    seen = np.abs(np.einsum("ij,ij->i", vectors, normals)) / np.maximum(length, 1e-12)
    area = float(np.where(length > 0, seen, flat).sum())
    rim = rim_lengths(mesh)
    noise = sample.usual_noise
    own = math.hypot(noise * float(np.sqrt((rim**2).sum())), _TILT**2 / 2 * area / math.sqrt(3))
    unit = vectors / np.maximum(flat, 1e-300)[:, None]
    share = np.where(length > 0, seen, flat)
    common = None
    if (modes := rig_modes(sample)) is not None:
        grow = np.trace(modes[:, :3], axis1=1, axis2=2)
        across = np.einsum("fi,mij,fj,f->m", unit, modes[:, :3], unit, share)
        common = float(np.linalg.norm(grow * area - across))
    found = Quantity("area", area, "m2", own, common)
    return Measurement("area", (found,), {"triangles": len(mesh.faces)})


def measure_volume(
    mesh: Mesh, sample: Sample, plane: Plane, *, trust: tuple[FitUncertainty, Vector] | None = None
) -> Measurement:
    """Give the volume between a surface and a plane: what stands out less what lies behind.

    Args:
        mesh: The surface, open or closed.
        sample: The points it was made of.
        plane: The plane, its normal towards the side that counts positive.
        trust: How far the plane is to be trusted, where it was fitted to the same scan, and the
            mean of the points it was fitted to, about which its tilts are.

    Raises:
        NotEnoughData: The surface stands upright on the plane.
        InputError: Sheets of it lie on one another.
    """
    require_one_sheet(mesh)
    heights = plane.distance_to(mesh.vertices)
    shadows = area_vectors(mesh) @ plane.normal
    shadows = shadows if shadows.sum() >= 0 else -shadows
    base = float(shadows.sum())
    if base <= 0:
        raise NotEnoughData("The surface stands upright on the plane; give another one.")
    volume = float(shadows @ heights[mesh.faces].mean(axis=1))
    variance = _variance_of_volume(mesh, sample, plane.normal, shadows)
    if trust is not None:
        how = _plane_slopes(mesh, plane, shadows, base, trust[1])
        variance += float(how @ trust[0].independent @ how)
    common = _common_volume(mesh, sample, plane, shadows, base, trust)
    found = (
        Quantity("volume", volume, "m3", math.sqrt(variance), common),
        Quantity("mean_height", volume / base, "m", math.sqrt(variance) / base,
                 None if common is None else common / base),
    )  # fmt: skip
    return Measurement(
        "volume", found, {"base_m2": base, "plane_normal": plane.normal.tolist(),
                          "plane_distance_m": plane.distance},
    )  # fmt: skip


def _variance_of_volume(mesh: Mesh, sample: Sample, up: Vector, shadows: Scalars) -> float:
    """Give the variance of a volume that follows from the errors of the points [m⁶]."""
    weights = np.bincount(mesh.faces.ravel(), np.repeat(shadows / 3, 3), len(mesh.vertices))
    # Where triangles of the border are divided, many corners stand for one point.
    number, which = np.unique(nearest_points(sample, mesh.vertices), return_inverse=True)
    noise = sample.usual_noise
    errors = find_height_errors(sample.cloud.points[number], up, noise=noise)
    profile, line = sample.profile[number], sample.line[number]
    return errors.variance_of_sum(np.bincount(which, weights), profile, line, noise=noise)


def _common_volume(
    mesh: Mesh,
    sample: Sample,
    plane: Plane,
    shadows: Scalars,
    base: float,
    trust: tuple[FitUncertainty, Vector] | None,
) -> float | None:
    """Give how the rig's errors change the volume, by a surface that they move as a whole [m³]."""
    if (modes := rig_modes(sample)) is None:
        return None
    volumes = []
    for mode in modes:
        moved = mesh.vertices + mesh.vertices @ mode[:3] + mode[3]
        shifted = Mesh(moved, mesh.faces)
        areas = area_vectors(shifted) @ plane.normal
        areas = areas if areas.sum() >= 0 else -areas
        heights = plane.distance_to(moved)[mesh.faces].mean(axis=1)
        was = plane.distance_to(mesh.vertices)[mesh.faces].mean(axis=1)
        volumes.append(float(areas @ heights - shadows @ was))
    change = np.array(volumes)
    if trust is not None and trust[0].common is not None:
        change = change + _plane_slopes(mesh, plane, shadows, base, trust[1]) @ trust[0].common
    return float(np.linalg.norm(change))


def _plane_slopes(
    mesh: Mesh, plane: Plane, shadows: Scalars, base: float, middle: Vector
) -> Vector:
    """Give the change of the volume with the plane's two tilts and its place."""
    centres = mesh.vertices[mesh.faces].mean(axis=1) - middle
    return shadows @ plane.slopes(centres)
