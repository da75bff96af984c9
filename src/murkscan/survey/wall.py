"""Draw a wall's elevation, bend curves through it, and list what stands out of it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..errors import NotEnoughData
from ..geometry.cylinder_fit import fit_cylinder
from ..io.geotiff import save_geotiff
from ..io.images import write_image
from ..io.wall_files import save_table, save_wall_dxf
from ..measure import (
    Deflection,
    Sample,
    Selection,
    draw_anomaly,
    draw_wall,
    find_anomalies,
    find_deflection,
    map_wall,
    trust_plane,
)
from ..project import Project, StageFiles, find_trajectory, load_georeference
from ..types.arrays import Points, Vector
from ..types.cylinder import Cylinder
from ..types.georeference import Georeference
from ..types.measurement import Measurement
from ..types.plane import Plane
from ..types.quantity import Quantity
from ..types.wall import WallFrame
from .anomalies import MOST_PICTURES
from .measured import keep_measurement, measuring
from .sample import load_sample
from .wall_tables import (
    ANOMALY_HEAD,
    CURVE_HEAD,
    DrawnWall,
    anomaly_rows,
    box_of,
    column_heads,
    curve_rows,
    name_system,
    places_of,
)


@dataclass(frozen=True)
class WallPlan:
    """What of a wall is drawn."""

    shape: Literal["plane", "cylinder"] = "plane"
    """What distances are taken from, fitted to the scan where none is given."""
    given: Plane | Cylinder | None = None
    """A plane or a cylinder that is given, in the scan's world."""
    up: tuple[float, float, float] | None = None
    """A direction that is about upwards; None: that of the grid of a georeferenced scan, else of
    the camera's pictures."""
    cell: float = 0.02
    """Edge of a cell of the map, and height of a piece of a curve [m]."""
    sections: int = 3
    """Curves, evenly along the wall."""
    strip: float = 0.1
    """Width of the strip that a curve is the mean of [m]."""
    is_ribbed: bool = False
    """Whether what repeats along the height is taken off the map: the ribs of sheet piles."""
    least: float = 0.01
    """Distance from which a part is an anomaly [m]."""


def draw_elevation(
    project: Project, plan: WallPlan, *, name: str = "wall", selection: Selection | None = None
) -> Measurement:
    """Draw a wall: map, curves, anomalies, into OUT/measure.

    Args:
        project: A scan with a finished cloud stage.
        plan: What is drawn.
        name: What to call it: NAME.json, .tif, .png, .dxf, -curves.csv, -anomalies.csv.
        selection: Which part of the scan; all of it unless given.

    Raises:
        MissingResult: The cloud stage has not been finished, or made anew since `georeference`.
        NotEnoughData: The points are too few for a wall.
        InputError: The name is none for a file, the wall is level, or cells are too small.
    """
    with measuring(project, name):
        sample = load_sample(project, selection)
        drawn = _draw(project, sample, plan)
        picture, scale = draw_wall(
            drawn.wall, drawn.curves, [one for one, _ in drawn.anomalies], title=name
        )

        def write(files: StageFiles) -> dict[str, object]:
            with files.making(f"{name}.png") as path:
                write_image(path, picture)
            _write_files(files, name, drawn)
            return {"pictures": _draw_anomalies(files, name, drawn)}

        return keep_measurement(project, name, _tell(drawn, scale), write=write)


def _draw(project: Project, sample: Sample, plan: WallPlan) -> DrawnWall:
    place = load_georeference(project)
    frame = _frame(sample, plan, _upwards(project, plan, place))
    located = frame.locate(sample.cloud.points)
    frame, located = _begin_at_corner(frame, located, place)
    wall = map_wall(located, plan.cell)
    shown = wall.without_profile() if plan.is_ribbed else wall
    width = wall.values.shape[1] * plan.cell
    middles = wall.low[0] + width * (np.arange(plan.sections) + 0.5) / max(plan.sections, 1)
    curves = [
        find_deflection(sample, located, frame, along=x, width=plan.strip, cell=plan.cell)
        for x in middles.tolist()
    ]
    known = [curve for curve in curves if curve is not None]
    if plan.sections and not known:
        raise NotEnoughData("No section of the wall has 8 points a piece; give a larger --cell-mm.")
    common = max((_largest_common(curve) for curve in known), default=0.0)
    found = find_anomalies(shown, least=plan.least)
    half = [1.96 * float(np.hypot(wall.noise / one.cells**0.5, common)) for one in found]
    return DrawnWall(frame, shown, known, list(zip(found, half, strict=True)), place)


def _frame(sample: Sample, plan: WallPlan, up: Vector) -> WallFrame:
    points, viewer = sample.cloud.points, sample.cloud.normals.mean(axis=0).astype(float)
    middle = points.mean(axis=0)
    shape = plan.given or _fit(sample, plan.shape)
    if isinstance(shape, Plane):
        return WallFrame.of_plane(shape, middle, up)
    cylinder = shape
    if cylinder.axis @ up < 0:
        cylinder = Cylinder(cylinder.point, -cylinder.axis, cylinder.radius)
    near = points[np.argmin(np.linalg.norm(points - middle, axis=1))]
    return WallFrame.of_cylinder(cylinder, near, viewer)


def _fit(sample: Sample, shape: Literal["plane", "cylinder"]) -> Plane | Cylinder:
    if shape == "plane":
        return trust_plane(sample)[0].shape
    normals = sample.cloud.normals.astype(float)
    return fit_cylinder(sample.cloud.points, normals, sight=sample.sight).shape


def _upwards(project: Project, plan: WallPlan, place: Georeference | None) -> Vector:
    """Tell which way is up: as given, as in the grid, or as in the camera's pictures."""
    if plan.up is not None:
        return np.array(plan.up)
    if place is not None:
        return place.ground_from_model.rotation[2]
    trajectory = find_trajectory(project)
    if trajectory is None:
        return np.array([0.0, -1.0, 0.0])
    return -trajectory.mean_attitude()[:, 1]


def _begin_at_corner(
    frame: WallFrame, located: Points, place: Georeference | None
) -> tuple[WallFrame, Points]:
    """Count along from the left end; heights from the lowest point, or as the grid does."""
    left, low = located[:, :2].min(axis=0).tolist()
    if frame.radius:
        left = 0.0  # along a cylinder from its middle: the origin's direction is its own
    start = np.array([[left, low, 0.0]])
    origin = frame.place(start)[0]
    height = 0.0 if place is None else float(place.place(origin[None])[0, 2])
    moved = WallFrame(origin - height * frame.axes[1], frame.axes, frame.radius)
    return moved, moved.locate(frame.place(located))


def _largest_common(curve: Deflection) -> float:
    return 0.0 if curve.sigma_common is None else float(np.max(curve.sigma_common))


def _tell(drawn: DrawnWall, scale: int) -> Measurement:
    values = drawn.wall.values[np.isfinite(drawn.wall.values)]
    own = drawn.wall.noise
    found = [
        Quantity("farthest_out", float(values.max()), "m", own, _common_of(drawn)),
        Quantity("farthest_in", float(values.min()), "m", own, _common_of(drawn)),
    ]
    details: dict[str, object] = {
        "origin_m": drawn.frame.origin.tolist(),
        "along": drawn.frame.axes[0].tolist(),
        "up": drawn.frame.axes[1].tolist(),
        "out": drawn.frame.axes[2].tolist(),
        "radius_m": drawn.frame.radius or None,
        "cell_m": drawn.wall.cell,
        "scale": scale,
        "crs": None if drawn.place is None else drawn.place.crs,
        "sections_m": [curve.along for curve in drawn.curves],
        "anomalies": [
            dict(zip(column_heads(drawn, ANOMALY_HEAD), row, strict=True))
            for row in anomaly_rows(drawn)
        ],
    }
    return Measurement("wall", tuple(found), details)


def _common_of(drawn: DrawnWall) -> float | None:
    if any(curve.sigma_common is None for curve in drawn.curves):
        return None
    return max((_largest_common(curve) for curve in drawn.curves), default=None)


def _write_files(files: StageFiles, name: str, drawn: DrawnWall) -> None:
    wall = drawn.wall
    with files.making(f"{name}.tif") as path:
        save_geotiff(
            path,
            wall.values[::-1],
            corner=(wall.low[0], wall.low[1] + wall.cell * len(wall.values)),
            cell=wall.cell,
            system=name_system(drawn),
        )
    with files.making(f"{name}-curves.csv") as path:
        save_table(path, column_heads(drawn, CURVE_HEAD), curve_rows(drawn))
    with files.making(f"{name}-anomalies.csv") as path:
        save_table(path, column_heads(drawn, ANOMALY_HEAD), anomaly_rows(drawn))
    curves = [(curve.along, places_of(curve)) for curve in drawn.curves]
    boxes = [(str(number), box_of(one)) for number, (one, _) in enumerate(drawn.anomalies, 1)]
    with files.making(f"{name}.dxf") as path:
        save_wall_dxf(path, curves=curves, boxes=boxes)


def _draw_anomalies(files: StageFiles, name: str, drawn: DrawnWall) -> list[str]:
    """Draw the map around each anomaly; gives the names of the pictures."""
    names = []
    for number, (one, _) in enumerate(drawn.anomalies[:MOST_PICTURES], 1):
        picture = draw_anomaly(drawn.wall, one, number, title=f"{name}, anomaly {number}")
        names.append(f"{name}-{number}.png")
        with files.making(names[-1]) as path:
            write_image(path, picture)
    return names
