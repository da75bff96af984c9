"""What the page shows of one scan: vertices, triangles between them, and what is known of each."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import KDTree

from ..errors import InputError
from ..types.arrays import Directions, Faces, Indices, Points, Scalars
from ..types.georeference import Georeference
from ..types.mesh import used_vertices
from ..types.pose import Pose
from .shift_field import ShiftField
from .surface import vertex_normals
from .views import View, standard_views

Rows = Int[np.ndarray, "rows"]
Times = Float[np.ndarray, "profiles"]
Path = Float[np.ndarray, "positions 3"]
Attitudes = Float[np.ndarray, "positions 4"]


@dataclass(frozen=True, eq=False)
class Layer:
    """One number a vertex, to colour by and to read off."""

    name: str
    """What it is, in a word: signal, sigma, deviation."""
    values: Scalars
    """In the unit below; NaN where there is none."""
    unit: str
    """Unit of the values, as it is written beside them."""
    colour_map: str = "cividis"
    """Its name in matplotlib."""
    is_signed: bool = False
    """Whether the colours' middle stands for zero."""


@dataclass(frozen=True, eq=False)
class Model:
    """A scan to be shown, in the world frame. The measured vertices come first, in order of time.

    Vertices after the measured ones belong to the surface only, such as those of a Poisson mesh.
    """

    name: str
    """How people tell it from another."""
    vertices: Points
    """Positions [m]."""
    normals: Directions
    """Unit normals of the vertices; zero where there is none."""
    faces: Faces
    """Triangles between the vertices; none where there is no surface."""
    surface: Points
    """Where the triangles' corners lie [m]: a smoothed surface passes its points by."""
    num_measured: int
    """Vertices that are measured points, which a measurement snaps to and is taken between."""
    rows: Indices
    """Number of the point of the scan that each vertex is or stands for."""
    layers: tuple[Layer, ...]
    """What is known of each vertex; of the one named sigma [mm] a measurement gets its doubt."""
    moments: Indices
    """Which profile each vertex comes from, an index into the times."""
    times: Times
    """Time of each profile [s]; or its number, where the recording has no times."""
    is_timed: bool
    """Whether these are seconds."""
    path: Path
    """Where the camera was at each profile [m]; empty where that is not known."""
    attitudes: Attitudes
    """Rotation from camera axes to world axes at each place of the path, w x y z."""
    views: tuple[View, ...]
    """The isometric view and the six standard ones."""
    spacing: float
    """Usual distance between neighbouring vertices [m]."""
    shift_field: ShiftField | None = None
    """How far points move with the rig's errors; None where the rig states none."""
    pose_errors: Float[np.ndarray, "positions 6 errors"] | None = None
    """Errors of the path's poses, as `Trajectory.errors`; None where the motion states none."""
    place: Georeference | None = None
    """Where the world frame lies, on the Earth or on a ship; None where nobody has said so."""
    note: str = ""
    """What must be said of it in plain words, such as that points were left out."""

    def with_layer(self, layer: Layer, rows: Rows | None = None) -> "Model":
        """Give a model with one more layer, in place of the one of its name.

        Args:
            layer: Its values, one a vertex; or one a row, if rows are given.
            rows: The points of the scan that the values belong to, each once: a vertex takes the
                value of its own, none where that has none.

        Raises:
            InputError: There is not one value a vertex, or a row.
        """
        count = len(self.vertices) if rows is None else len(rows)
        if len(layer.values) != count:
            raise InputError(
                f"The layer {layer.name} has {len(layer.values)} values for {count} places; give "
                "one a place."
            )
        if rows is not None:
            values = np.full(int(max(self.rows.max(), rows.max(initial=0))) + 1, np.nan)
            values[rows] = layer.values
            layer = replace(layer, values=values[self.rows])
        others = tuple(one for one in self.layers if one.name != layer.name)
        return replace(self, layers=(*others, layer))

    def moved(self, target_from_world: Pose, views: tuple[View, ...]) -> "Model":
        """Give a model laid elsewhere, to be shown beside one that is there.

        Args:
            target_from_world: Where it goes.
            views: The views of the other one, in its world.
        """
        known, errors = len(self.attitudes) > 0, self.pose_errors
        turn = np.kron(np.eye(2), target_from_world.rotation)
        return replace(
            self,
            vertices=target_from_world @ self.vertices,
            surface=target_from_world @ self.surface,
            normals=self.normals @ target_from_world.rotation.T,
            path=target_from_world @ self.path,
            attitudes=target_from_world.turn(self.attitudes) if known else self.attitudes,
            pose_errors=None if errors is None else turn @ errors,
            views=views,
            place=None,
        )


def model_of_points(
    name: str, points: Points, *, faces: Faces | None = None, layers: Sequence[Layer] = ()
) -> Model:
    """Make a model of points or of a mesh of which nothing else is known.

    Args:
        name: How people tell it from another.
        points: Vertices in the world frame [m], at least one.
        faces: Triangles between them; None for points alone.
        layers: What is known of each vertex.
    """
    corners = np.zeros((0, 3), int) if faces is None else faces
    count = len(points)
    model = Model(
        name=name,
        vertices=points,
        normals=normals_of(points, corners, np.zeros((count, 3))),
        faces=corners,
        surface=points,
        num_measured=count,
        rows=np.arange(count),
        layers=(),
        moments=np.zeros(count, int),
        times=np.zeros(1),
        is_timed=False,
        path=np.zeros((0, 3)),
        attitudes=np.zeros((0, 4)),
        views=standard_views(),
        spacing=usual_spacing(points),
    )
    for layer in layers:
        model = model.with_layer(layer)
    return model


def normals_of(points: Points, faces: Faces, otherwise: Directions) -> Directions:
    """Give the normals that the surface has at its vertices, and others at those not on it."""
    if len(faces) == 0:
        return otherwise
    normals = np.array(otherwise, float)
    on_surface = used_vertices(faces)
    normals[on_surface] = vertex_normals(points, faces)[on_surface]
    return normals


def usual_spacing(points: Points) -> float:
    """Give the median distance from a point to its fourth neighbour [m], of two thousand points."""
    if len(points) < 5:
        return 1e-3
    some = points[:: max(len(points) // 2000, 1)]
    away = np.asarray(KDTree(points).query(some, k=[5])[0])
    return max(float(np.median(away)), 1e-9)
