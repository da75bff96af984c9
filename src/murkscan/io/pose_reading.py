"""From the cells of a log to poses, by the conventions that it follows."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import scipy
from jaxtyping import Float

from ..errors import FormatError, InputError
from ..types.arrays import Mask, Points, Quaternions, Scalars
from ..types.cloud import FARTHEST
from ..types.trajectory import Trajectory
from .clock_times import TICKS, TimeUnit, guess_unit, read_moment, say_moment
from .pose_columns import Angles, Column, angles_of, know_columns, metres_of, time_unit_of
from .text_table import TextTable

Axes = Literal["ned", "enu"]
"""Where x, y and z of the world point: north, east, down or east, north, up."""
QuaternionOrder = Literal["wxyz", "xyzw"]
Columns = dict[str, Column]
Numbers = Float[np.ndarray, "rows columns"]

_FORMS = (
    ("time", "x", "y", "z", "qw", "qx", "qy", "qz"),
    ("time", "north", "east", "depth", "roll", "pitch", "heading"),
    ("time", "x", "y", "z", "roll", "pitch", "heading"),
)
"""Columns that make a pose, in any order."""
_TUM = ("time", "x", "y", "z", "qx", "qy", "qz", "qw")
_SHORTEST, _LONGEST = 0.5, 2.0
"""Lengths between which a quaternion is one that was rounded, not something else."""
_TURN = 6.4
"""Angles above this are no radians: a turn has 6.283."""


@dataclass(frozen=True)
class PoseConvention:
    """What a user says of a log; None: as the file says it, or as its numbers look."""

    time_unit: TimeUnit | None = None
    """What the times count."""
    quaternion: QuaternionOrder | None = None
    """Order of a quaternion's four numbers, in a file without names."""
    axes: Axes | None = None
    """The world's axes, by which roll, pitch and heading turn."""
    angles: Angles | None = None
    """Unit of roll, pitch and heading."""


@dataclass(frozen=True, eq=False)
class PoseFile:
    """A log that was read."""

    log: Trajectory
    """world_from_vehicle, or world_from_camera."""
    understood: str
    """How its numbers were taken, in one line."""
    left_out: tuple[tuple[int, str], ...] = ()
    """Lines that give no pose, and why."""

    def tell_left_out(self) -> str:
        """Say in a sentence which lines are left out and why; empty where none is."""
        if not self.left_out:
            return ""
        reasons = list(dict.fromkeys(why for _, why in self.left_out))
        lines = [str(number) for number, _ in self.left_out[:5]]
        more = " …" if len(self.left_out) > len(lines) else ""
        return (
            f"{len(self.left_out)} lines are left out ({', '.join(lines)}{more}): "
            f"{'; '.join(reasons)}"
        )


def read_poses(path: Path, table: TextTable, convention: PoseConvention) -> PoseFile:
    """Make poses of a table; see `read_pose_log`."""
    columns = _find_columns(path, table, convention)
    form = next((form for form in _FORMS if all(name in columns for name in form)), None)
    if form is None:
        raise FormatError(_say_missing(path, columns))
    rows, lines, cut = _whole_rows(table, [columns[name].number for name in form])
    times, said_times = _read_times(path, rows, lines, columns, convention)
    values = _read_numbers(path, rows, lines, [columns[name] for name in form[1:]])
    attitudes, said_attitudes = _read_attitudes(path, values[:, 3:], form, columns, convention)
    values[:, :3] *= _metres(path, [columns[name] for name in form[1:4]])
    positions, said_places = _read_positions(values[:, :3], form, _axes(form, convention))
    length = np.linalg.norm(attitudes, axis=1, keepdims=True)
    kept, left_out = _choose(times, positions, length[:, 0], lines)
    if not kept.any():
        raise FormatError(f"{path} holds no poses.")
    understood = f"times {said_times}; {said_places}; {said_attitudes}"
    quaternions = attitudes[kept] / length[kept]
    log = _as_trajectory(path, times[kept], positions[kept], quaternions, np.array(lines)[kept])
    return PoseFile(log, understood, (*left_out, *cut))


def _find_columns(path: Path, table: TextTable, convention: PoseConvention) -> Columns:
    if not table.rows:
        raise FormatError(f"{path} holds no poses.")
    if table.names:
        if convention.quaternion is not None:
            raise InputError(
                f"{path} names its columns, so the order of the quaternion is known; leave out "
                "what was said of it."
            )
        return know_columns(table.names)
    if len(table.rows[0]) != len(_TUM):
        raise FormatError(
            f"{path}, line {table.lines[0]} is not a pose: a log without names of columns has "
            "eight numbers a line, as TUM; other logs name their columns in the first line."
        )
    order = convention.quaternion or "xyzw"
    names = (*_TUM[:4], *(f"q{letter}" for letter in order))
    return {name: Column(k, name, "") for k, name in enumerate(names)}


def _say_missing(path: Path, columns: Columns) -> str:
    forms = " or ".join(",".join(form) for form in _FORMS[:2])
    nearest = max(_FORMS, key=lambda form: sum(name in columns for name in form))
    missing = next(name for name in nearest if name not in columns)
    return (
        f"{path} lacks the column {missing}; its first line must name {forms}, with or without "
        "units such as _m, [deg] or (ns)."
    )


def _whole_rows(
    table: TextTable, wanted: Sequence[int]
) -> tuple[list[tuple[str, ...]], list[int], list[tuple[int, str]]]:
    """Leave out a last line that was not written to its end."""
    rows, lines = list(table.rows), list(table.lines)
    if len(rows) > 1 and len(rows[-1]) <= max(wanted):
        rows.pop()
        return rows, lines[:-1], [(lines[-1], "cut off")]
    return rows, lines, []


def _read_times(
    path: Path,
    rows: Sequence[tuple[str, ...]],
    lines: Sequence[int],
    columns: Columns,
    convention: PoseConvention,
) -> tuple[Scalars, str]:
    """Read the times [s], and say what they were."""
    column = columns["time"]
    if "date" in columns or (len(rows[0]) > column.number and ":" in rows[0][column.number]):
        return _read_dates(path, rows, lines, columns), "as dates"
    times = _read_numbers(path, rows, lines, [column])[:, 0]
    unit = convention.time_unit or time_unit_of(column) or guess_unit(times)
    scaled = times / TICKS[unit]
    names = {"s": "seconds", "ms": "milliseconds", "us": "microseconds", "ns": "nanoseconds"}
    finite = scaled[np.isfinite(scaled)]
    begin = f", from {say_moment(float(finite[0]))}" if len(finite) else ""
    return scaled, f"in {names[unit]}{begin}"


def _read_dates(
    path: Path, rows: Sequence[tuple[str, ...]], lines: Sequence[int], columns: Columns
) -> Scalars:
    order = [columns[name].number for name in ("date", "time") if name in columns]
    times = np.empty(len(rows))
    for k, (row, line) in enumerate(zip(rows, lines, strict=True)):
        try:
            times[k] = read_moment(" ".join(row[number] for number in order))
        except (ValueError, IndexError, OverflowError) as error:
            raise FormatError(
                f"{path}, line {line} is not a pose: its time is neither seconds nor a date such "
                "as 2026-05-01T09:30:00.040Z."
            ) from error
    return times


def _read_numbers(
    path: Path, rows: Sequence[tuple[str, ...]], lines: Sequence[int], columns: Sequence[Column]
) -> Numbers:
    values = np.empty((len(rows), len(columns)))
    for k, (row, line) in enumerate(zip(rows, lines, strict=True)):
        try:
            values[k] = [float(row[column.number]) for column in columns]
        except (ValueError, IndexError) as error:
            raise FormatError(
                f"{path}, line {line} is not a pose: it has fewer cells than the first line, or "
                "one that is no number."
            ) from error
    return values


def _metres(path: Path, columns: Sequence[Column]) -> Scalars:
    """Give the lengths of the units of positions [m]."""
    lengths = [metres_of(column) for column in columns]
    for column, length in zip(columns, lengths, strict=True):
        if length is None:
            raise FormatError(
                f"{path} has the column {column.name} in a unit that is not known here; give "
                "metres."
            )
    return np.array(lengths, float)


def _axes(form: Sequence[str], convention: PoseConvention) -> Axes | None:
    """Give the world's axes where angles turn by them; None for quaternions, which need none."""
    if "qw" in form:
        if convention.axes is not None:
            raise InputError(
                "The world's axes are asked for by roll, pitch and heading only; a quaternion "
                "turns by whatever axes its log has: leave them out."
            )
        return None
    return convention.axes or "ned"


def _read_positions(values: Points, form: Sequence[str], axes: Axes | None) -> tuple[Points, str]:
    if "north" not in form:
        return values, "positions x, y, z"
    north, east, depth = values.T
    if axes == "enu":
        return np.stack([east, north, -depth], axis=1), "positions east, north, up (ENU)"
    return np.stack([north, east, depth], axis=1), "positions north, east, down (NED)"


def _read_attitudes(
    path: Path,
    values: Numbers,
    form: Sequence[str],
    columns: Columns,
    convention: PoseConvention,
) -> tuple[Quaternions, str]:
    """Give attitudes, w x y z; of any length where the file has quaternions."""
    axes = _axes(form, convention)
    if axes is None:
        if convention.angles is not None:
            raise InputError(f"{path} has quaternions, no angles; leave out their unit.")
        order = "".join(name[1] for name in sorted(form[4:], key=lambda q: columns[q].number))
        return values, f"quaternions {order}"
    said = convention.angles or angles_of(columns)
    unit, words = said or "deg", {"deg": "degrees", "rad": "radians"}[said or "deg"]
    largest = float(np.abs(values).max(initial=0.0, where=np.isfinite(values)))
    if unit == "rad" and largest > _TURN:
        raise InputError(f"{path} has angles up to {largest:g}, which are no radians.")
    angles = np.where(np.isfinite(values).all(axis=1, keepdims=True), values, 0.0)
    turns = scipy.spatial.transform.Rotation.from_euler(
        "ZYX", angles[:, ::-1], degrees=unit == "deg"
    )
    quaternions = turns.as_quat(scalar_first=True)
    quaternions[~np.isfinite(values).all(axis=1)] = np.nan
    body = "forward, right, down" if axes == "ned" else "forward, left, up"
    words += "" if said else " (the file does not say)"
    return quaternions, (
        f"roll, pitch, heading in {words}, {axes.upper()} (vehicle axes {body}; turned by heading, "
        "then pitch, then roll)"
    )


def _choose(
    times: Scalars, positions: Points, lengths: Scalars, lines: Sequence[int]
) -> tuple[Mask, list[tuple[int, str]]]:
    """Tell which rows are poses, and why others are not."""
    placed = np.isfinite(times) & (np.abs(positions).max(axis=1) < FARTHEST)
    turned = (lengths >= _SHORTEST) & (lengths <= _LONGEST)
    repeats = np.zeros(len(times), bool)
    repeats[1:] = (np.diff(times) == 0) & np.isclose(np.diff(positions, axis=0), 0).all(axis=1)
    found = [
        (np.flatnonzero(~placed), "no finite time and place"),
        (np.flatnonzero(placed & ~turned), "a quaternion whose length is not 1"),
        (np.flatnonzero(placed & turned & repeats), "a repeated pose"),
    ]
    left_out = [(lines[k], why) for which, why in found for k in which.tolist()]
    return placed & turned & ~repeats, sorted(left_out)


def _as_trajectory(
    path: Path, times: Scalars, positions: Points, quaternions: Quaternions, lines: np.ndarray
) -> Trajectory:
    back = np.flatnonzero(np.diff(times) <= 0)
    if len(back):
        k = int(back[0]) + 1
        raise FormatError(
            f"{path}, line {lines[k]}: the times of the poses do not increase "
            f"({say_moment(float(times[k]))} after {say_moment(float(times[k - 1]))}); sort the "
            "log, or cut it where its clock steps back."
        )
    return Trajectory(times, positions, quaternions)
