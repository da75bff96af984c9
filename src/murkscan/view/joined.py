"""From a scan's cloud, mesh and motion to what the page shows."""

import numpy as np
from jaxtyping import Int

from ..errors import InputError
from ..types.arrays import Indices, SignedFrameNumbers
from ..types.cloud import PointCloud
from ..types.frame_times import FrameTimes
from ..types.mesh import Mesh
from ..types.trajectory import Trajectory
from .model import Layer, Model, Times, normals_of, usual_spacing
from .shift_field import ShiftField
from .thinned import choose_fairly, cluster_vertices
from .views import standard_views

MOST = 2_000_000
"""Points, and vertices of the surface, that the page holds unless told otherwise."""

Corners = Int[np.ndarray, "corners"]
Sources = Int[np.ndarray, "sources"]
Rows = Int[np.ndarray, "rows"]

_ROUNDING = 1 + 1e-4
"""A surface moves points by their sigma at most, which is kept in single precision."""


def model_of_scan(
    name: str,
    cloud: PointCloud,
    *,
    mesh: Mesh | None = None,
    trajectory: Trajectory | None = None,
    frames: FrameTimes | None = None,
    is_timed: bool = True,
    shift_field: ShiftField | None = None,
    most: int = MOST,
    num_points: int | None = None,
    rows: Rows | None = None,
) -> Model:
    """Join a scan's points with its surface, to be shown together.

    Args:
        name: How people tell it from another.
        cloud: The points, at least one, in the world frame [m].
        mesh: The surface between them, whose vertices know their points.
        trajectory: How the camera went through the world.
        frames: At which time each frame was recorded, for the trajectory.
        is_timed: Whether these times are seconds, and no numbers of pictures.
        shift_field: How far points move with the rig's errors.
        most: Points and vertices that are kept, at most: of more points a fair choice, of more
            vertices one a cell.
        num_points: Points that the scan has, where the cloud is a choice of them already.
        rows: Number of each of the cloud's points among those of the scan; all in their order
            unless given.

    Returns:
        The model. A vertex of the surface that lies within the standard deviation of its own point
        is that point, as the surface has smoothed it; others take what is known from theirs.

    Raises:
        InputError: The surface does not say which points its vertices are, or the cloud lacks them.
    """
    total = num_points or len(cloud)
    rows = np.arange(len(cloud)) if rows is None else rows
    is_kept = np.isin(rows, choose_fairly(total, most))
    order, count = np.lexsort((cloud.frame, ~is_kept)), int(is_kept.sum())
    cloud, rows = cloud[order], rows[order]
    surface = cluster_vertices(_no_surface() if mesh is None else mesh, most)
    spacing = usual_spacing(cloud.points[:count])
    place, source = _find_points(surface, cloud, rows, count, spacing)
    apart = place >= count
    vertices = np.concatenate([cloud.points[:count], surface.vertices[apart]])
    corners = vertices.copy()
    corners[place] = surface.vertices
    faces = place[surface.faces]
    times, moments = np.unique(cloud.frame, return_inverse=True)
    seconds = _seconds(times, frames)
    path = _path(seconds, trajectory) if frames is not None else None
    return Model(
        name=name,
        vertices=vertices,
        normals=normals_of(corners, faces, cloud.normals[source].astype(float)),
        faces=faces,
        surface=corners,
        num_measured=count,
        rows=rows[source],
        layers=_layers(cloud, source),
        moments=moments[source],
        times=seconds,
        is_timed=is_timed and frames is not None,
        path=np.zeros((0, 3)) if path is None else path.positions,
        attitudes=np.zeros((0, 4)) if path is None else path.quaternions,
        views=standard_views(trajectory),
        spacing=spacing,
        shift_field=shift_field,
        pose_errors=None if path is None else path.errors,
        note=_note(total, cloud[:count], mesh, surface),
    )


def _find_points(
    surface: Mesh, cloud: PointCloud, rows: Rows, count: int, spacing: float
) -> tuple[Corners, Sources]:
    """Tell which of the first points each vertex of a surface is, or number it after them.

    Returns:
        The number of each vertex, and for each number the point from which it takes what is known.
    """
    if surface.points is None:
        raise InputError(
            "The surface does not say which points its vertices are; give one made from the cloud."
        )
    by_row = np.argsort(rows)
    slot = np.searchsorted(rows[by_row], surface.points)
    own = by_row[np.minimum(slot, len(rows) - 1)]
    if not np.array_equal(rows[own], surface.points):
        raise InputError("The cloud lacks points that the surface was made from.")
    away = np.linalg.norm(surface.vertices - cloud.points[own], axis=1)
    order = np.lexsort((away, own))
    is_nearest = np.ones(len(order), bool)
    # A point is one vertex, the nearest of those that stand for it.
    is_nearest[order[1:]] = np.diff(own[order]) != 0
    near = away <= np.minimum(cloud.sigma[own] * _ROUNDING, spacing)
    is_point = (own < count) & is_nearest & (near | (away == 0))
    apart = np.flatnonzero(~is_point)
    place = own.copy()
    place[apart] = count + np.arange(len(apart))
    return place, np.concatenate([np.arange(count), own[apart]])


def _no_surface() -> Mesh:
    none = np.zeros((0, 3), int)
    return Mesh(np.zeros((0, 3)), none, points=np.zeros(0, int))


def _layers(cloud: PointCloud, source: Indices) -> tuple[Layer, ...]:
    """Give what the cloud knows, of which the probability and the common part may say nothing."""
    layers = [
        Layer("signal", cloud.signal[source].astype(float), "grey levels"),
        Layer("sigma", cloud.sigma[source] * 1e3, "mm"),
    ]
    if np.any(cloud.reflectance > 0):
        known = np.where(cloud.reflectance > 0, cloud.reflectance, np.nan)[source]
        layers.append(Layer("reflectance", known.astype(float), ""))
    if np.any(cloud.posterior < 1):
        layers.append(Layer("posterior", cloud.posterior[source].astype(float), ""))
    if np.ptp(cloud.laser) > 0:
        layers.append(Layer("laser", cloud.laser[source].astype(float), "", "coolwarm"))
    if np.any(cloud.sigma_common > 0):
        layers.append(Layer("sigma common", cloud.sigma_common[source] * 1e3, "mm"))
    return tuple(layers)


def _seconds(numbers: SignedFrameNumbers, frames: FrameTimes | None) -> Times:
    if frames is None or len(frames.frame) == 0:
        return numbers.astype(float)
    order = np.argsort(frames.frame)
    place = np.searchsorted(frames.frame[order], numbers)
    return frames.time[order][np.minimum(place, len(order) - 1)]


def _path(times: Times, trajectory: Trajectory | None) -> Trajectory | None:
    """Give the poses at the profiles; none where two profiles are of one time."""
    if trajectory is None or not np.all(np.diff(times) > 0):
        return None
    return trajectory.at(np.clip(times, trajectory.times[0], trajectory.times[-1]))


def _note(total: int, kept: PointCloud, mesh: Mesh | None, surface: Mesh) -> str:
    """Say what is left out or not there."""
    said = []
    if len(kept) < total:
        said.append(f"A fair choice of {len(kept):,} of the scan's {total:,} points.")
    if mesh is not None and len(surface.vertices) < len(mesh.vertices):
        said.append(
            f"The surface is drawn with {len(surface.vertices):,} of its "
            f"{len(mesh.vertices):,} vertices."
        )
    if len(surface.faces) == 0:
        one = len(np.unique(kept.frame)) == 1
        said.append(
            "Only one profile was seen: there is no surface, only its points."
            if one
            else "There is no surface, only points."
        )
    return " ".join(said)
