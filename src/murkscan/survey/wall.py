"""Draw a wall's elevation, bend curves through it, and list what stands out of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ..errors import NotEnoughData
from ..geometry.cylinder_fit import fit_cylinder
from ..io.geotiff import save_geotiff
from ..io.images import write_image
from ..io.wall_files import save_table, save_wall_dxf
from ..measure import (
    Anomaly,
    Deflection,
    Sample,
    Selection,
    WallMap,
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

_CURVE_HEAD = (
    "section", "along_m", "height_m", "distance_mm", "sigma_own_mm", "sigma_common_mm",
    "low_95_mm", "high_95_mm", "points",
)  # fmt: skip
_ANOMALY_HEAD = (
    "number", "along_m", "height_m", "distance_mm", "half_width_95_mm", "width_mm", "rise_mm",
    "area_m2",
)  # fmt: skip
_MODEL_HEAD = ("x_m", "y_m", "z_m")


@dataclass(frozen=True)
class WallPlan:
    """What of a wall is drawn."""

    shape: Literal["plane", "cylinder"] = "plane"
    """What distances are taken from, fitted to the scan where no plane is given."""
    plane: Plane | None = None
    """A plane that is given, in the scan's world."""
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


@dataclass(frozen=True, eq=False)
class _Drawn:
    frame: WallFrame
    wall: WallMap
    curves: list[Deflection]
    anomalies: list[tuple[Anomaly, float]]
    """Each with half its 95 % interval [m]."""
    place: Georeference | None


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


def _draw(project: Project, sample: Sample, plan: WallPlan) -> _Drawn:
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
    return _Drawn(frame, shown, known, list(zip(found, half, strict=True)), place)


def _frame(sample: Sample, plan: WallPlan, up: Vector) -> WallFrame:
    points, viewer = sample.cloud.points, sample.cloud.normals.mean(axis=0).astype(float)
    middle = points.mean(axis=0)
    if plan.plane is not None:
        return WallFrame.of_plane(plan.plane, middle, up)
    if plan.shape == "plane":
        return WallFrame.of_plane(trust_plane(sample)[0].shape, middle, up)
    fit = fit_cylinder(points, sample.cloud.normals.astype(float), sight=sample.sight)
    cylinder = fit.shape
    if cylinder.axis @ up < 0:
        cylinder = Cylinder(cylinder.point, -cylinder.axis, cylinder.radius)
    near = points[np.argmin(np.linalg.norm(points - middle, axis=1))]
    return WallFrame.of_cylinder(cylinder, near, viewer)


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


def _tell(drawn: _Drawn, scale: int) -> Measurement:
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
            dict(zip(_heads(drawn, _ANOMALY_HEAD), row, strict=True))
            for row in _anomaly_rows(drawn)
        ],
    }
    return Measurement("wall", tuple(found), details)


def _common_of(drawn: _Drawn) -> float | None:
    if any(curve.sigma_common is None for curve in drawn.curves):
        return None
    return max((_largest_common(curve) for curve in drawn.curves), default=None)


def _write_files(files: StageFiles, name: str, drawn: _Drawn) -> None:
    wall = drawn.wall
    with files.making(f"{name}.tif") as path:
        save_geotiff(
            path,
            wall.values[::-1],
            corner=(wall.low[0], wall.low[1] + wall.cell * len(wall.values)),
            cell=wall.cell,
            system=_system(drawn),
        )
    with files.making(f"{name}-curves.csv") as path:
        save_table(path, _heads(drawn, _CURVE_HEAD), _curve_rows(drawn))
    with files.making(f"{name}-anomalies.csv") as path:
        save_table(path, _heads(drawn, _ANOMALY_HEAD), _anomaly_rows(drawn))
    curves = [(curve.along, _places(curve)) for curve in drawn.curves]
    boxes = [(str(number), _box(one)) for number, (one, _) in enumerate(drawn.anomalies, 1)]
    with files.making(f"{name}.dxf") as path:
        save_wall_dxf(path, curves=curves, boxes=boxes)


def _draw_anomalies(files: StageFiles, name: str, drawn: _Drawn) -> list[str]:
    """Draw the map around each anomaly; gives the names of the pictures."""
    names = []
    for number, (one, _) in enumerate(drawn.anomalies[:MOST_PICTURES], 1):
        picture = draw_anomaly(drawn.wall, one, number, title=f"{name}, anomaly {number}")
        names.append(f"{name}-{number}.png")
        with files.making(names[-1]) as path:
            write_image(path, picture)
    return names


def _system(drawn: _Drawn) -> str:
    """Say in words what the map's system is."""
    what = "elevation of a wall: x along [m], y height [m], values distance out of it [m]"
    if drawn.place is None:
        return what
    if drawn.place.hull is not None:
        start = drawn.place.describe(drawn.frame.place(np.zeros((1, 3)))[0])
        return f"{what}; x = 0 at {start}"
    start = drawn.place.place(drawn.frame.place(np.zeros((1, 3))))[0]
    end = drawn.place.place(drawn.frame.place(np.array([[1.0, 0.0, 0.0]])))[0]
    east, north = (end - start)[:2]
    return (
        f"{what}; x = 0 at easting {start[0]:.3f}, northing {start[1]:.3f}, x runs east "
        f"{east:.6f}, north {north:.6f} a metre; heights and plane of {drawn.place.crs}"
    )


def _places(curve: Deflection) -> Points:
    along = np.full(len(curve.height), curve.along)
    return np.stack([along, curve.height, curve.distance], axis=1)


def _box(one: Anomaly) -> tuple[float, float, float, float]:
    left, low = one.along - one.width / 2, one.height - one.rise / 2
    return left, low, left + one.width, low + one.rise


def _heads(drawn: _Drawn, head: Sequence[str]) -> list[str]:
    return [*head, *_MODEL_HEAD, *(() if drawn.place is None else drawn.place.heads)]


def _where(drawn: _Drawn, located: Points) -> list[list[str | float]]:
    """Give the place of each, in the model's world and in the grid or on the ship."""
    points = drawn.frame.place(located)
    told = [[]] * len(points) if drawn.place is None else drawn.place.tell(points)
    return [[*place, *more] for place, more in zip(np.round(points, 4).tolist(), told, strict=True)]


def _curve_rows(drawn: _Drawn) -> list[list[str | int | float]]:
    rows: list[list[str | int | float]] = []
    for number, curve in enumerate(drawn.curves, 1):
        half, common = curve.half_width, curve.sigma_common
        for k, where in enumerate(_where(drawn, _places(curve))):
            value = float(curve.distance[k])
            ends = (value, value - float(half[k]), value + float(half[k]))
            shared = "" if common is None else round(1e3 * float(common[k]), 4)
            mm = [round(1e3 * one, 4) for one in (*ends, float(curve.sigma_own[k]))]
            rows.append(
                [number, round(curve.along, 4), round(float(curve.height[k]), 4), mm[0], mm[3],
                 shared, mm[1], mm[2], int(curve.points[k]), *where]
            )  # fmt: skip
    return rows


def _anomaly_rows(drawn: _Drawn) -> list[list[str | int | float]]:
    if not drawn.anomalies:
        return []
    places = np.array([(one.along, one.height, one.distance) for one, _ in drawn.anomalies])
    return [
        [number, round(one.along, 4), round(one.height, 4), round(1e3 * one.distance, 2),
         round(1e3 * half, 2), round(1e3 * one.width), round(1e3 * one.rise),
         round(one.area, 4), *where]
        for number, ((one, half), where) in enumerate(
            zip(drawn.anomalies, _where(drawn, places), strict=True), 1
        )
    ]  # fmt: skip
