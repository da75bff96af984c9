"""Logs of measurements in columns, such as time_s, roll_deg, depth_m."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from ..errors import FormatError
from .clock_times import TICKS, guess_unit
from .dive.messages import Topic
from .dive.series import Series, SeriesKind
from .text_table import TextTable, read_text_table

_COLUMNS: dict[SeriesKind, tuple[tuple[str, ...], ...]] = {
    "attitude": (
        ("roll_deg", "pitch_deg", "heading_deg"),
        ("wx_deg_s", "wy_deg_s", "wz_deg_s"),
    ),
    "position": (("north_m", "east_m", "depth_m"),),
    "geodetic": (("latitude_deg", "longitude_deg"),),
    "depth": (("depth_m",),),
    "twist": (("vx_m_s", "vy_m_s", "vz_m_s"), ("wx_deg_s", "wy_deg_s", "wz_deg_s")),
}
"""Columns of each kind; those of a second group may be absent."""


def read_navigation_csv(path: Path) -> tuple[Series, ...]:
    """Read a log of measurements; an empty cell is no reading.

    Raises:
        FormatError: It has no time_s, or no column of measurements that is known.
    """
    return read_measurements(path, read_text_table(path, "log of navigation"))


def read_measurements(path: Path, table: TextTable) -> tuple[Series, ...]:
    """Read a table of measurements; see `read_navigation_csv`.

    Args:
        path: The file that it is of, for messages.
        table: Its lines, or some of them.
    """
    names = [name.strip().lower() for name in table.names]
    if "time_s" not in names:
        raise FormatError(f"{path} lacks the column time_s; its first line must name its columns.")
    times = _numbers(path, table, [names.index("time_s")])[:, 0]
    times = times / TICKS[guess_unit(times)]
    found = list[Series]()
    for kind, groups in _COLUMNS.items():
        if any(name not in names for name in groups[0]):
            continue
        values = np.hstack([_group(path, table, names, group) for group in groups])
        if kind == "geodetic":
            height = -_group(path, table, names, ("depth_m",))
            values = np.hstack([values, np.nan_to_num(height)])
        known = np.isfinite(values[:, : len(groups[0])]).all(axis=1) & np.isfinite(times)
        order = np.flatnonzero(known)[np.argsort(times[known], kind="stable")]
        if len(order):
            topic = Topic(path.name, "CSV", "csv")
            found.append(Series(f"{path.name} {kind}", kind, times[order], values[order], topic))
    if not found:
        raise FormatError(
            f"{path} has no measurements; it needs some of the columns "
            f"{', '.join(name for groups in _COLUMNS.values() for name in groups[0])}."
        )
    return tuple(found)


def _group(
    path: Path, table: TextTable, names: list[str], group: Sequence[str]
) -> Float[np.ndarray, "n k"]:
    """Read columns, angles in radians; NaN where they are absent."""
    if any(name not in names for name in group):
        return np.full((len(table.rows), len(group)), np.nan)
    values = _numbers(path, table, [names.index(name) for name in group])
    turns = np.array([name.endswith(("_deg", "_deg_s")) for name in group])
    is_place = group[0] == "latitude_deg"
    return values if is_place else np.where(turns, np.radians(values), values)


def _numbers(path: Path, table: TextTable, columns: list[int]) -> Float[np.ndarray, "n k"]:
    values = np.full((len(table.rows), len(columns)), np.nan)
    for k, (row, line) in enumerate(zip(table.rows, table.lines, strict=True)):
        for j, column in enumerate(columns):
            cell = row[column] if column < len(row) else ""
            try:
                values[k, j] = float(cell) if cell else np.nan
            except ValueError as error:
                raise FormatError(f"{path}, line {line}: {cell!r} is no number.") from error
    return values
