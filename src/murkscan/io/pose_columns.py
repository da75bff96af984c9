"""Which column of a log of poses is what, by the names that loggers give them."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from .clock_times import TimeUnit

Angles = Literal["deg", "rad"]

_UNIT = re.compile(r"[\[(]\s*([^\])]*?)\s*[\])]|_(ns|us|ms|s|mm|cm|m|deg|rad)$")
_NAMES = {
    "time": "time timestamp t stamp secs seconds unixtime epoch datetime utc field.header.stamp",
    "date": "date",
    "x": "x px pos_x position_x tx p_rs_r_x p_x field.pose.pose.position.x field.pose.position.x "
    "pose.position.x position.x pose.pose.position.x",
    "y": "y py pos_y position_y ty p_rs_r_y p_y field.pose.pose.position.y field.pose.position.y "
    "pose.position.y position.y pose.pose.position.y",
    "z": "z pz pos_z position_z tz p_rs_r_z p_z field.pose.pose.position.z field.pose.position.z "
    "pose.position.z position.z pose.pose.position.z",
    "qw": "qw q_w quat_w q_rs_w field.pose.pose.orientation.w field.pose.orientation.w "
    "pose.orientation.w orientation.w pose.pose.orientation.w",
    "qx": "qx q_x quat_x q_rs_x field.pose.pose.orientation.x field.pose.orientation.x "
    "pose.orientation.x orientation.x pose.pose.orientation.x",
    "qy": "qy q_y quat_y q_rs_y field.pose.pose.orientation.y field.pose.orientation.y "
    "pose.orientation.y orientation.y pose.pose.orientation.y",
    "qz": "qz q_z quat_z q_rs_z field.pose.pose.orientation.z field.pose.orientation.z "
    "pose.orientation.z orientation.z pose.pose.orientation.z",
    "north": "north northing n",
    "east": "east easting e",
    "depth": "depth down",
    "height": "height up elevation",
    "roll": "roll phi",
    "pitch": "pitch theta",
    "heading": "heading yaw hdg psi",
}
_MEANING = {name: ours for ours, names in _NAMES.items() for name in names.split()}
_METRES = {
    **{"": 1.0, "m": 1.0, "metre": 1.0, "metres": 1.0, "meters": 1.0},
    **{"cm": 1e-2, "mm": 1e-3, "ft": 0.3048, "feet": 0.3048},
}
_TIME_UNITS: dict[str, TimeUnit] = {
    **{"ns": "ns", "us": "us", "µs": "us", "ms": "ms"},
    **{"s": "s", "sec": "s", "seconds": "s"},
}
_ANGLE_UNITS: dict[str, Angles] = {"deg": "deg", "degrees": "deg", "°": "deg", "rad": "rad"}
_BETTER = ("field.header.stamp",)
"""Names that win over another of the same meaning: when it was, not when it was written."""


@dataclass(frozen=True)
class Column:
    """A column whose name is known."""

    number: int
    """Its place in a row, from 0."""
    name: str
    """What the file calls it."""
    unit: str
    """The unit that the name says; empty where it says none."""


def know_columns(names: tuple[str, ...]) -> dict[str, Column]:
    """Find the columns that make a pose, by our name for each; others are passed over."""
    found: dict[str, Column] = {}
    for number, written in enumerate(names):
        word = written.strip().lower()
        unit = _UNIT.search(word)
        meaning = _MEANING.get(word) or _MEANING.get(_UNIT.sub("", word).strip())
        if meaning is not None and (meaning not in found or word in _BETTER):
            said = "" if unit is None else unit[1] or unit[2] or ""
            found[meaning] = Column(number, written, said)
    return found


def metres_of(column: Column) -> float | None:
    """Give the length of a column's unit [m]; metres where it says none, None where unknown."""
    return _METRES.get(column.unit)


def time_unit_of(column: Column) -> TimeUnit | None:
    """Give the unit that a column of times says."""
    return _TIME_UNITS.get(column.unit)


def angles_of(columns: Mapping[str, Column]) -> Angles | None:
    """Give the unit that the columns of roll, pitch or heading say."""
    said = (_ANGLE_UNITS.get(columns[name].unit) for name in ("roll", "pitch", "heading"))
    return next((unit for unit in said if unit is not None), None)
