"""How far a scan lies from a drawing's mesh, an earlier scan, or a smooth one through itself."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..errors import NotEnoughData
from ..geometry.closest import face_normals, find_closest
from ..geometry.correlated_errors import covariance_of_sums
from ..geometry.height_map import MapFrame
from ..geometry.spline_surface import SplineSurface, fit_spline_surface
from ..types.arrays import Directions, Points, Scalars
from ..types.deviation import Deviation
from ..types.mesh import Mesh
from .lengths import require_length
from .sample import Sample

_CELLS = 16
"""Cells of the map, along the largest thing looked for, that its smooth surface is fitted to."""
_LEAST_SHARE = 0.3
"""Share of the usual number of points below which a cell tells no height: the rim's."""

SigmaAlong = Callable[[Points, Directions], Scalars]
"""Standard deviation of a reference's place at points, along directions [m]."""


def deviation_from_mesh(
    sample: Sample, mesh: Mesh, *, within: float, sigma: SigmaAlong | None = None
) -> Deviation:
    """Measure each point's distance from a surface in the same frame.

    The sign does not depend on how the mesh is turned: positive is towards the camera.

    Args:
        sample: The scan's points.
        mesh: The reference.
        within: Distance beyond which a point does not belong to it [m].
        sigma: How well the reference's place is known, such as `Alignment.sigma_along`; None: it
            is exact.

    Raises:
        NotEnoughData: No point lies within that distance of the reference.
        InputError: That distance is none.
    """
    require_length("reach", within)
    points = sample.cloud.points
    closest = find_closest(points, mesh, within=within)
    beside = (closest.face >= 0) & ~closest.is_at_rim
    if not beside.any():
        raise NotEnoughData(
            f"None of the {len(points)} points lies within {within * 1e3:g} mm of the reference; "
            "check its unit and its place, or raise --reach-mm."
        )
    normals = face_normals(mesh)[closest.face]
    towards = np.einsum("ij,ij->i", normals, _towards_camera(sample))
    normals = normals * np.where(towards < 0, -1.0, 1.0)[:, None]
    away = np.einsum("ij,ij->i", points - closest.places, normals)
    values = np.where(beside, np.copysign(closest.distance, away), np.nan)
    normals = np.where(beside[:, None], normals, 0.0)
    known = np.zeros(len(points)) if sigma is None else sigma(points, normals)
    return Deviation(values, normals, known)


def deviation_from_smooth(sample: Sample, *, largest: float) -> Deviation:
    """Measure each point's distance from a smooth surface through the scan itself.

    The surface is a bicubic spline under the scan seen from its mean normal, fitted so that what
    disagrees counts nothing; it follows nothing narrower than `largest`.

    Args:
        sample: The scan's points, of one side of an object.
        largest: Width of the largest dent looked for [m].

    Raises:
        NotEnoughData: There are too few points.
        InputError: The width is none.
    """
    require_length("largest", largest)
    points = sample.cloud.points
    frame = MapFrame.over(points, sample.cloud.normals, largest / _CELLS)
    located = frame.locate(points)
    surface = _fit_smooth(frame, located, largest)
    places = located[:, :2]
    upright = surface.normals(places)
    # The height above a sloping surface is longer than the distance from it.
    values = (located[:, 2] - surface.heights(places)) * upright[:, 2]
    return Deviation(values, upright @ frame.map_from_world, _sigma_of(surface, frame, places))


def _fit_smooth(frame: MapFrame, located: Points, largest: float) -> SplineSurface:
    """Fit a smooth surface to the means of cells."""
    _, count = frame.gather(located, located[:, 2])
    rows, columns = np.nonzero(count >= _LEAST_SHARE * np.median(count[count > 0]))
    number = count[rows, columns]
    # The mean of a cell's points stands at their mean place, not at its middle.
    means = [frame.gather(located, values)[0][rows, columns] / number for values in located.T]
    places, heights = np.stack(means[:2], axis=1), means[2]
    extent = (frame.shape[1] * frame.cell, frame.shape[0] * frame.cell)
    surface = fit_spline_surface(places, heights, spacing=largest, extent=extent)
    # A surface that curves within a cell lies beside the mean of its points there.
    off, _ = frame.gather(located, located[:, 2] - surface.heights(located[:, :2]))
    heights = surface.heights(places) + off[rows, columns] / number
    surface = fit_spline_surface(places, heights, spacing=largest, extent=extent)
    # Cells err together with their neighbours: the surface is known that much less.
    errors, ones = heights - surface.heights(places), np.ones((len(heights), 1))
    together = covariance_of_sums(ones, errors, rows, columns)[0, 0] / max(errors @ errors, 1e-300)
    return replace(surface, covariance=surface.covariance * max(float(together), 1.0))


def _sigma_of(surface: SplineSurface, frame: MapFrame, places: np.ndarray) -> Scalars:
    """Give the surface's deviation at each point, by that of its cell's middle."""
    rows, columns = frame.cells_of(np.concatenate([places, np.zeros((len(places), 1))], axis=1))
    cells, which = np.unique(rows * frame.shape[1] + columns, return_inverse=True)
    middles = np.stack([cells % frame.shape[1], cells // frame.shape[1]], axis=1) + 0.5
    return surface.sigma(middles * frame.cell)[which]


def _towards_camera(sample: Sample) -> Directions:
    if sample.sight is not None:
        return -sample.sight.rays
    return sample.cloud.normals.astype(float)
