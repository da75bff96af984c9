"""What a scan is compared with: a mesh file, or the surface of an earlier scan."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..errors import Degenerate, FormatError, InputError, NotEnoughData
from ..geometry.alignment import Alignment, align_surfaces
from ..geometry.alignment_fit import no_overlap
from ..geometry.clip import clip_mesh
from ..geometry.surface_points import SurfacePoints
from ..io.mesh_files import load_mesh
from ..types.arrays import Directions, Points, Scalars
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from ..types.pose import Pose

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "ft": 0.3048}
"""Lengths of the units that meshes come in [m]."""

_PILE = 1000
"""Triangles about one middle beyond which they are no surface."""
_SPREAD = (0x1E3779B97F4A7C15, 0x3F58476D1CE4E5B9, 0x14D049BB133111EB)
"""Odd numbers that mix the three coordinates, as Knuth's multiplicative hash does."""
_AROUND = 0.1
"""How far around a scan its place in the reference is looked for, in the size of the scan."""


@dataclass(frozen=True, eq=False)
class Reference:
    """A surface in the scan's world, and how well its place is known."""

    mesh: Mesh
    """The surface [m]."""
    alignment: Alignment | None = None
    """How it was laid on the scan; None: it was taken as it is."""
    name: str = "the reference"
    """The file or folder that it was read from, for messages."""

    @property
    def sigma_along(self) -> Callable[[Points, Directions], Scalars] | None:
        """Standard deviation of its place at points, along directions [m]; None: exact."""
        if self.alignment is None:
            return None
        alignment = self.alignment
        reference_from_scan = alignment.target_from_source

        def sigma(points: Points, directions: Directions) -> Scalars:
            there = reference_from_scan @ points
            return alignment.sigma_along(there, directions @ reference_from_scan.rotation.T)

        return sigma


def check_unit(unit: str) -> None:
    """Refuse a unit that no mesh comes in.

    Raises:
        InputError: It is unknown.
    """
    if unit not in UNITS:
        raise InputError(f"The unit must be one of {', '.join(UNITS)}, got {unit!r}.")


def read_reference(path: Path, *, unit: str = "m") -> Reference:
    """Read a mesh file as it is.

    Args:
        path: A .ply, .stl, .obj or .glb file.
        unit: Unit of the file: m, cm, mm or in.

    Raises:
        InputError: The unit is unknown, or the file is of another format.
        FormatError: The file is no mesh, or has thousands of triangles in one place.
    """
    check_unit(unit)
    mesh = load_mesh(path)
    _require_spread(mesh, path)
    return Reference(replace(mesh, vertices=mesh.vertices * UNITS[unit]), name=str(path))


def _require_spread(mesh: Mesh, path: Path) -> None:
    """Refuse a pile of triangles: of each point all of them would be the nearest."""
    middles = np.ascontiguousarray(mesh.vertices[mesh.faces].mean(axis=1) + 0.0)
    # The product runs over, as it should: equal places have equal numbers, and others hardly ever.
    keys = (middles.view(np.int64) * np.array(_SPREAD)).sum(axis=1)
    most = int(np.unique(keys, return_counts=True)[1].max())
    if most > _PILE:
        raise FormatError(
            f"{path} has {most:,} triangles in one place; it is damaged, or has a part that is "
            "placed as often."
        )


def begin_at(reference: Reference, scan_from_reference: Pose) -> Reference:
    """Bring a reference nearly into place, from where `lay_on` finds the rest."""
    moved = replace(reference.mesh, vertices=scan_from_reference @ reference.mesh.vertices)
    return replace(reference, mesh=moved)


def lay_on(reference: Reference, cloud: PointCloud) -> Reference:
    """Lay a reference on a scan by ICP, as far as their overlap shows how.

    Only what lies around the scan is looked at: of a whole ship's drawing that is little.

    Raises:
        Degenerate: They do not overlap: bring the reference nearly into place first.
        NotEnoughData: One is far too small for the other.
    """
    try:
        alignment = _align(reference, cloud)
    except (Degenerate, NotEnoughData) as error:
        sizes = [_size(points) for points in (reference.mesh.vertices, cloud.points)]
        # What follows the first sentence is the cure for passes that are merged.
        cause = str(error).partition(". ")[0]
        raise type(error)(
            f"{reference.name} cannot be laid on the scan: it measures {sizes[0]:.3g} m and the "
            f"scan {sizes[1]:.3g} m. Check that it lies where the scan does and, of a file, its "
            f"--unit, or say about where it lies with --start. ({cause}.)"
        ) from error
    scan_from_reference = alignment.target_from_source.inverse()
    moved = replace(reference.mesh, vertices=scan_from_reference @ reference.mesh.vertices)
    return replace(reference, mesh=moved, alignment=alignment)


def _align(reference: Reference, cloud: PointCloud) -> Alignment:
    """Find where the scan lies in the reference."""
    scan, size = SurfacePoints.from_cloud(cloud), np.ptp(cloud.points, axis=0)
    margin = _AROUND * float(np.linalg.norm(size))
    low, high = cloud.points.min(axis=0) - margin, cloud.points.max(axis=0) + margin
    part = clip_mesh(reference.mesh, low, high)
    if len(part.faces) == 0:
        raise Degenerate(no_overlap(0, len(scan), margin))
    surface = SurfacePoints.from_mesh(part, spacing=scan.spacing)
    if surface.spacing > scan.spacing:
        scan = SurfacePoints.from_cloud(cloud, spacing=surface.spacing)
    return align_surfaces(scan, surface)


def _size(points: Points) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))
