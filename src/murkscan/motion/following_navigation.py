"""Where a camera is whose vehicle's instruments are logged while it moves."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Protocol, final, runtime_checkable

import numpy as np

from ..io.dive.series import Series
from ..io.growing_table import GrowingTable
from ..io.navigation_csv import read_measurements
from ..io.navigation_log import NavigationLog, understand_series
from ..io.text_table import TextTable
from ..types.pose import Pose
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from ..types.water import Water
from .base import Direction
from .following import AbstractLogFollower, go_on
from .navigated import find_way

_ROWS = 2000
"""Lines that are looked at together, at most."""
_EARLIER = 500
"""Earlier lines that are among them: the way goes on from there, and a depth is smoothed over some
seconds."""


@runtime_checkable
class RecentReadings(Protocol):
    """Where measurements come from while a vehicle moves."""

    path: Path
    """Where they are written down."""

    def read_recent(self) -> Iterator[tuple[Series, ...]]:
        """Give what is new, together with what was measured in the seconds before it."""
        ...


@final
class TableReadings:
    """A log of measurements that another program writes on: CSV, as of `--navigation`."""

    def __init__(self, path: Path) -> None:
        """Begin at the file's begin."""
        self.path = path
        self._table = GrowingTable(path, "log of navigation")
        self._earlier: TextTable | None = None

    def read_recent(self) -> Iterator[tuple[Series, ...]]:
        """See `RecentReadings.read_recent`."""
        table = self._table.read_new()
        if table is None:
            return
        for first in range(0, len(table.rows), _ROWS):
            some = slice(first, first + _ROWS)
            part = TextTable(table.names, table.rows[some], table.lines[some])
            whole = part if self._earlier is None else _join(self._earlier, part)
            self._earlier = _last(whole)
            yield read_measurements(self.path, whole)


@final
class NavigationFollower(AbstractLogFollower):
    """A vehicle whose instruments are read while it moves."""

    def __init__(
        self,
        readings: RecentReadings,
        rig: Rig,
        *,
        speed: float | None,
        along: Direction,
        crs: str | None,
        start_time: float,
        gap: float,
    ) -> None:
        """Follow readings; the other arguments as of `follow_navigation`."""
        mount = rig.vehicle_from_camera or Pose.identity()
        super().__init__(mount, start_time=start_time, gap=gap)
        self._readings, self._rig, self._speed = readings, rig, speed
        self._along, self._crs = along, crs

    def refresh(self) -> None:
        """See `AbstractFollower.refresh`.

        Raises:
            InputError: The log tells neither places nor velocity, and no speed is given.
        """
        for series in self._readings.read_recent():
            self._add(series)

    def _add(self, series: tuple[Series, ...]) -> None:
        path = self._readings.path
        log = understand_series(
            path,
            series,
            crs=self._crs,
            salinity=(self._rig.water or Water()).salinity_psu,
            gap=self._gap,
            accuracy=self._rig.navigation,
        )
        if log.poses is None and log.navigation.attitude is None and self._log is None:
            return  # the first lines may hold one instrument only
        way = find_way(path, log, self._mount, self._speed, self._along, [])
        self._log = go_on(self._log, way if way is log.poses else self._lay_on(way, log))

    def _lay_on(self, way: Trajectory, log: NavigationLog) -> Trajectory:
        """Let a way that was added up from 0 go on where the one before is."""
        before = self._log
        if before is None or not way.times[0] <= before.times[-1] <= way.times[-1]:
            return way
        at = before.times[-1:]
        shift = before.positions[-1] - way.at(at).positions[0]
        if log.navigation.depth is not None:
            shift = shift * np.array([1.0, 1.0, 0.0])
        return replace(way, positions=way.positions + shift)


def _join(earlier: TextTable, later: TextTable) -> TextTable:
    rows: Sequence[tuple[str, ...]] = [*earlier.rows, *later.rows]
    return TextTable(later.names, rows, [*earlier.lines, *later.lines])


def _last(table: TextTable) -> TextTable:
    return TextTable(table.names, table.rows[-_EARLIER:], table.lines[-_EARLIER:])
