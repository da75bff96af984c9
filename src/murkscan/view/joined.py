"""From a scan's cloud, mesh and motion to what the page shows."""

import numpy as np
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
        The model. A vertex of the surface that is no point takes what is known from the nearest.
    """
    kept = cloud[choose_fairly(len(cloud), most)]
    kept = kept[np.argsort(kept.frame, kind="stable")]
    surface = cluster_vertices(_no_surface() if mesh is None else mesh, most)
    found = KDTree(kept.points).query(surface.vertices)
    apart, nearest = np.flatnonzero(np.asarray(found[0]) > 0), np.asarray(found[1])
    place = nearest.astype(int)
    place[apart] = len(kept) + np.arange(len(apart))
    source = np.concatenate([np.arange(len(kept)), nearest[apart]]).astype(int)
    vertices = np.concatenate([kept.points, surface.vertices[apart]])
    faces = place[surface.faces]
    times, moments = np.unique(kept.frame, return_inverse=True)
    seconds = _seconds(times, frames)
    path = _path(seconds, trajectory) if frames is not None else None
    return Model(
        name=name,
        vertices=vertices,
        normals=normals_of(vertices, faces, kept.normals[source].astype(float)),
        faces=faces,
        num_measured=len(kept),
        layers=_layers(kept, source),
        moments=moments[source],
        times=seconds,
        is_timed=is_timed and frames is not None,
        path=np.zeros((0, 3)) if path is None else path.positions,
        attitudes=np.zeros((0, 4)) if path is None else path.quaternions,
        views=standard_views(trajectory),
        spacing=usual_spacing(kept.points),
        shift_field=shift_field,
        note=_note(num_points or len(cloud), kept, mesh, surface),
    )


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
