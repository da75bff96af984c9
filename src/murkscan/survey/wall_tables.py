"""The tables of a drawn wall: curves and anomalies, with their places in the model and the grid."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..measure import Anomaly, Deflection, WallMap
from ..types.arrays import Points
from ..types.georeference import Georeference
from ..types.wall import WallFrame

CURVE_HEAD = (
    "section", "along_m", "height_m", "distance_mm", "sigma_own_mm", "sigma_common_mm",
    "low_95_mm", "high_95_mm", "points",
)  # fmt: skip
ANOMALY_HEAD = (
    "number", "along_m", "height_m", "distance_mm", "half_width_95_mm", "width_mm", "rise_mm",
    "area_m2",
)  # fmt: skip
_MODEL_HEAD = ("x_m", "y_m", "z_m")


@dataclass(frozen=True, eq=False)
class DrawnWall:
    """A wall in elevation, as it is written."""

    frame: WallFrame
    """What along, height and distance are of."""
    wall: WallMap
    """The map."""
    curves: list[Deflection]
    """How it bends, from left to right."""
    anomalies: list[tuple[Anomaly, float]]
    """Each with half its 95 % interval [m]."""
    place: Georeference | None
    """Where the model lies on the Earth or a ship, if it is known."""


def name_system(drawn: DrawnWall) -> str:
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


def places_of(curve: Deflection) -> Points:
    """Give along, height and distance of a curve's places [m]."""
    return np.stack([curve.places, curve.height, curve.distance], axis=1)


def box_of(one: Anomaly) -> tuple[float, float, float, float]:
    """Give left, low, right and high of an anomaly on the map [m]."""
    left, low = one.along - one.width / 2, one.height - one.rise / 2
    return left, low, left + one.width, low + one.rise


def column_heads(drawn: DrawnWall, head: Sequence[str]) -> list[str]:
    """Name the columns of a table, and those of the places in it."""
    return [*head, *_MODEL_HEAD, *(() if drawn.place is None else drawn.place.heads)]


def _where(drawn: DrawnWall, located: Points) -> list[list[str | float]]:
    """Give the place of each, in the model's world and in the grid or on the ship."""
    points = drawn.frame.place(located)
    told = [[]] * len(points) if drawn.place is None else drawn.place.tell(points)
    return [[*place, *more] for place, more in zip(np.round(points, 4).tolist(), told, strict=True)]


def curve_rows(drawn: DrawnWall) -> list[list[str | int | float]]:
    """Give the rows below `CURVE_HEAD`."""
    rows: list[list[str | int | float]] = []
    for number, curve in enumerate(drawn.curves, 1):
        half, common = curve.half_width, curve.sigma_common
        for k, where in enumerate(_where(drawn, places_of(curve))):
            value = float(curve.distance[k])
            ends = (value, value - float(half[k]), value + float(half[k]))
            shared = "" if common is None else round(1e3 * float(common[k]), 4)
            place = [round(float(part[k]), 4) for part in (curve.places, curve.height)]
            mm = [round(1e3 * one, 4) for one in (*ends, float(curve.sigma_own[k]))]
            rows.append(
                [number, *place, mm[0], mm[3], shared, mm[1], mm[2], int(curve.points[k]), *where]
            )
    return rows


def anomaly_rows(drawn: DrawnWall) -> list[list[str | int | float]]:
    """Give the rows below `ANOMALY_HEAD`."""
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
