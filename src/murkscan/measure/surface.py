"""What measures of a surface need to know of it, and of the scan it was made of."""

import numpy as np
from jaxtyping import Float
from scipy.spatial import KDTree

from ..errors import InputError
from ..geometry.closest import open_sides
from ..geometry.overlap import has_another_sheet
from ..types.arrays import Indices, Points, Scalars
from ..types.mesh import Mesh
from .sample import Sample

_MOST_SHIFTED = 2000
"""Points for which the rig's errors are traced; over the surface they vary as a linear map."""
_LOOKED_AT = 5000
"""Triangles that are looked at for another sheet over them."""
_MOST_TWICE = 0.02
"""Share of these that seams and folds make: up to 0.004 on scans, where sheets that overlap make
0.5 and more."""

Modes = Float[np.ndarray, "modes 4 3"]
"""Each error of the rig as a linear map of places (three rows), and a shift (the last) [m]."""
AreaVectors = Float[np.ndarray, "m 3"]


def require_one_sheet(mesh: Mesh) -> None:
    """Refuse a surface of sheets that lie on one another: what it amounts to would count twice.

    Raises:
        InputError: It is one.
    """
    some = np.linspace(0, len(mesh.faces) - 1, min(_LOOKED_AT, len(mesh.faces))).astype(int)
    share = float(has_another_sheet(mesh, some).mean())
    if share > _MOST_TWICE:
        raise InputError(
            f"Over {share:.0%} of its triangles the surface has another sheet of the same side, "
            "which would count twice: the passes are not aligned, or one pass went there twice. "
            "Make one surface of them with `murkscan mesh --mesher poisson`."
        )


def area_vectors(mesh: Mesh) -> AreaVectors:
    """Give each triangle's normal, as long as its area [m²]."""
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    return np.cross(b - a, c - a) / 2


def rim_lengths(mesh: Mesh) -> Scalars:
    """Give the lengths of the sides that only one triangle has [m]."""
    corners = mesh.vertices[mesh.faces]
    lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    return lengths[open_sides(mesh.faces)]


def nearest_points(sample: Sample, places: Points) -> Indices:
    """Give the number of the scan's point nearest to each place."""
    return np.asarray(KDTree(sample.cloud.points).query(places)[1])


def rig_modes(sample: Sample) -> Modes | None:
    """Fit a linear map of places to how each of the rig's errors moves the scan; None: unknown."""
    if sample.shifts is None:
        return None
    some = np.arange(len(sample))[:: max(len(sample) // _MOST_SHIFTED, 1)]
    shifts = sample.shifts(some)
    known = np.isfinite(shifts).all(axis=(1, 2))
    points = sample.cloud.points[some][known]
    design = np.column_stack([points, np.ones(len(points))])
    solved, *_ = np.linalg.lstsq(design, shifts[known].reshape(len(points), -1), rcond=None)
    return solved.reshape(4, 3, -1).transpose(2, 0, 1)
