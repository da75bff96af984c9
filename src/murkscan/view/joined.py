"""From a scan's cloud, mesh and motion to what the page shows."""

import numpy as np
from jaxtyping import Int
from scipy.spatial import KDTree

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
) -> Model:
    """Join a scan's points with its surface, to be shown together.

    Args:
        name: How people tell it from another.
        cloud: The points, at least one, in the world frame [m].
        mesh: The surface between them; its vertices may be points of the cloud or others.
        trajectory: How the camera went through the world.
        frames: At which time each frame was recorded, for the trajectory.
        is_timed: Whether these times are seconds, and no numbers of pictures.
        shift_field: How far points move with the rig's errors.
        most: Points and vertices that are kept, at most: of more points a fair choice, of more
            vertices one a cell.
        num_points: Points that the scan has, where the cloud is a choice of them already.

    Returns:
        The model. A vertex of the surface that lies within a point's own standard deviation is that
        point, as the surface has smoothed it; others take what is known from the nearest.
    """
    kept = cloud[choose_fairly(len(cloud), most)]
    kept = kept[np.argsort(kept.frame, kind="stable")]
    surface = cluster_vertices(_no_surface() if mesh is None else mesh, most)
    place, source = _find_points(surface, kept, spacing := usual_spacing(kept.points))
    apart = place >= len(kept)
    vertices = np.concatenate([kept.points, surface.vertices[apart]])
    corners = vertices.copy()
    corners[place] = surface.vertices
    faces = place[surface.faces]
    times, moments = np.unique(kept.frame, return_inverse=True)
    seconds = _seconds(times, frames)
    path = _path(seconds, trajectory) if frames is not None else None
    return Model(
        name=name,
        vertices=vertices,
        normals=normals_of(corners, faces, kept.normals[source].astype(float)),
        faces=faces,
        surface=corners,
        num_measured=len(kept),
        layers=_layers(kept, source),
        moments=moments[source],
        times=seconds,
        is_timed=is_timed and frames is not None,
        path=np.zeros((0, 3)) if path is None else path.positions,
        attitudes=np.zeros((0, 4)) if path is None else path.quaternions,
        views=standard_views(trajectory),
        spacing=spacing,
        shift_field=shift_field,
        note=_note(num_points or len(cloud), kept, mesh, surface),
    )


def _find_points(surface: Mesh, cloud: PointCloud, spacing: float) -> tuple[Corners, Sources]:
    """Find which point each vertex of a surface is, or number it after the points.

    Returns:
        The number of each vertex, and for each number the point from which it takes what is known.
    """
    found = KDTree(cloud.points).query(surface.vertices)
    away, nearest = np.asarray(found[0]), np.asarray(found[1]).astype(int)
    order = np.lexsort((away, nearest))
    is_nearest = np.ones(len(order), bool)
    # A point is one vertex, the nearest of those that could be it.
    is_nearest[order[1:]] = np.diff(nearest[order]) != 0
    near = away <= np.minimum(cloud.sigma[nearest] * _ROUNDING, spacing)
    apart = np.flatnonzero((away > 0) & ~(near & is_nearest))
    place = nearest.copy()
    place[apart] = len(cloud) + np.arange(len(apart))
    return place, np.concatenate([np.arange(len(cloud)), nearest[apart]])


def _no_surface() -> Mesh:
    return Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))


def _layers(cloud: PointCloud, source: Indices) -> tuple[Layer, ...]:
    """Give what the cloud knows, of which the probability and the common part may say nothing."""
    layers = [
        Layer("signal", cloud.signal[source].astype(float), "grey levels"),
        Layer("sigma", cloud.sigma[source] * 1e3, "mm"),
    ]
    if np.any(cloud.posterior < 1):
        layers.append(Layer("posterior", cloud.posterior[source].astype(float), ""))
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
