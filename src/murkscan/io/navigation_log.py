"""From what instruments measured to a vehicle's poses or to measurements: one line says how."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from ..errors import FormatError
from ..types.arrays import Mask, Scalars
from ..types.navigation import Navigation, NavigationAccuracy, Readings
from ..types.trajectory import Trajectory
from .clock_times import say_moment
from .dive.gather import read_contents
from .dive.names import is_dive
from .dive.series import Series, SeriesKind
from .navigation_csv import read_navigation_csv
from .nmea import is_nmea, read_nmea
from .projection import project_places

_GRAVITY = 9.81
"""Standard gravity, rounded; it varies by 0.3 % on the Earth [m/s²]."""
_SALTY = 10.0
"""Salinity above which water counts as the sea's [PSU]."""
_DENSITY = {False: 998.0, True: 1025.0}
"""Density of fresh and of sea water [kg/m³]."""
_SURFACE = 101_325.0
"""Standard pressure of the air [Pa]; another one shifts all depths alike."""
_HOLES = 3.0
"""Usual steps of positions that are no hole between them."""
_FLU_FROM_FRD = np.diag([1.0, -1.0, -1.0])
_NED_FROM_ENU = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])


@dataclass(frozen=True, eq=False)
class NavigationLog:
    """What a log says of a vehicle's way."""

    poses: Trajectory | None
    """world_from_vehicle, where the log has places and attitudes."""
    navigation: Navigation
    """What was measured: north, east, down, and the vehicle's axes forward, starboard, down."""
    understood: str
    """How it was taken, in one line."""
    unused: tuple[str, ...]
    """Topics of the same kinds that are passed over."""


def read_navigation_log(
    path: Path,
    *,
    crs: str | None = None,
    salinity: float = 35.0,
    gap: float = 0.5,
    accuracy: NavigationAccuracy | None = None,
) -> NavigationLog:
    """Read a log of measurements: an MCAP, a bag, a .tlog, NMEA, or CSV.

    Args:
        path: The file.
        crs: Coordinate system for latitude and longitude, as EPSG:N; UTM's zone unless given.
        salinity: Of the water [PSU], for depths by pressure.
        gap: Longest time between two positions that is bridged [s].
        accuracy: How good the instruments are.

    Raises:
        FormatError: It holds nothing of use.
        MissingDependency: What reads it is not installed.
    """
    series = _read(path)
    return understand_series(path, series, crs=crs, salinity=salinity, gap=gap, accuracy=accuracy)


def understand_series(
    path: Path,
    series: Sequence[Series],
    *,
    crs: str | None,
    salinity: float,
    gap: float,
    accuracy: NavigationAccuracy | None,
) -> NavigationLog:
    """Say what series of measurements tell of a vehicle's way; see `read_navigation_log`.

    Args:
        path: The file that they are of, for messages.
        series: What it holds.
        crs: As of `read_navigation_log`, like all that follow.
        salinity: Of the water [PSU].
        gap: Longest time between two positions that is bridged [s].
        accuracy: How good the instruments are.
    """
    chosen = _choose(series)
    if not chosen:
        raise FormatError(
            f"{path} holds no navigation; `murkscan dive {path}` lists what an MCAP, a bag or a "
            ".tlog holds."
        )
    said: list[str] = []
    attitude, rates = _attitude(chosen, said)
    depth = _depth(chosen, salinity, said)
    position, turn = _position(chosen, depth, crs, said)
    if attitude is not None and turn:
        attitude = Readings(attitude.times, attitude.values - [0.0, 0.0, turn])
    velocity = _velocity(chosen, said)
    navigation = Navigation(
        accuracy=accuracy or NavigationAccuracy(),
        attitude=attitude,
        rates=rates,
        velocity=velocity,
        depth=depth,
        position=position,
    )
    poses = _poses(chosen, said)
    if poses is None and position is not None and attitude is not None:
        poses = _join(position, attitude, gap)
    unused = tuple(one.name for one in series if one.name not in {c.name for c in chosen.values()})
    begin = min(float(one.times[0]) for one in chosen.values())
    end = max(float(one.times[-1]) for one in chosen.values())
    said.append(f"from {say_moment(begin)} to {say_moment(end)}")
    return NavigationLog(poses, navigation, "; ".join(said), unused)


def _read(path: Path) -> tuple[Series, ...]:
    if is_dive(path):
        return read_contents(path).series
    try:
        return read_nmea(path) if is_nmea(path) else read_navigation_csv(path)
    except OSError as error:
        raise FormatError(f"{path} cannot be read: {error.strerror}.") from error


def _choose(series: Sequence[Series]) -> dict[SeriesKind, Series]:
    """Take the longest series of each kind; of poses a topic of its own before a transform."""
    chosen = dict[SeriesKind, Series]()
    for one in sorted(series, key=lambda s: (s.topic.kind.lower() == "tfmessage", -len(s.times))):
        known = _are_known(one)
        if one.kind not in chosen and np.count_nonzero(known) > 1:
            times, first = np.unique(one.times[known], return_index=True)
            if len(times) > 1:
                values = one.values[known][first]
                chosen[one.kind] = Series(one.name, one.kind, times, values, one.topic)
    return chosen


def _are_known(one: Series) -> Mask:
    """Tell which readings say something: a fix that was never there is zeros."""
    needed = {"attitude": 3, "position": 3, "orientation": 4, "twist": 3}.get(one.kind)
    values = one.values[:, :needed]
    known: Mask = np.isfinite(values).all(axis=1)
    if one.kind == "geodetic":
        known &= (np.abs(values[:, 0]) <= 90) & np.any(values[:, :2] != 0, axis=1)
    if one.kind in ("pose", "orientation"):
        length = np.linalg.norm(values[:, -4:], axis=1)
        known &= (length > 0.5) & (length < 2)
    return known


def _attitude(
    chosen: dict[SeriesKind, Series], said: list[str]
) -> tuple[Readings | None, Readings | None]:
    """Give roll, pitch, heading (NED), and turn rates about forward, starboard, down [rad]."""
    one = chosen.get("attitude")
    if one is not None:
        said.append(f"attitude from {one.name} (roll, pitch, heading; NED)")
        rates = one.values[:, 3:6]
        measured = np.isfinite(rates).all(axis=1)
        return (
            Readings(one.times, one.values[:, :3]),
            Readings(one.times[measured], rates[measured]) if measured.any() else None,
        )
    one = chosen.get("orientation")
    if one is None:
        return None, None
    said.append(f"attitude from {one.name} (quaternion; ENU, vehicle axes forward, left, up)")
    turns = Rotation.from_quat(one.values[:, :4], scalar_first=True).as_matrix()
    angles = Rotation.from_matrix(_NED_FROM_ENU @ turns @ _FLU_FROM_FRD).as_euler("ZYX")
    rates = one.values[:, 4:7] @ _FLU_FROM_FRD
    measured = np.isfinite(rates).all(axis=1)
    return (
        Readings(one.times, angles[:, ::-1]),
        Readings(one.times[measured], rates[measured]) if measured.any() else None,
    )


def _depth(chosen: dict[SeriesKind, Series], salinity: float, said: list[str]) -> Readings | None:
    if "depth" in chosen:
        one = chosen["depth"]
        said.append(f"depth from {one.name}")
        return Readings(one.times, one.values[:, :1])
    if "pressure" in chosen:
        one = chosen["pressure"]
        density = _DENSITY[salinity > _SALTY]
        said.append(f"depth from {one.name} (water of {density:g} kg/m³)")
        return Readings(one.times, (one.values[:, :1] - _SURFACE) / (density * _GRAVITY))
    if "height" in chosen:
        one = chosen["height"]
        said.append(f"depth from {one.name} (the autopilot's height)")
        return Readings(one.times, -one.values[:, :1])
    return None


def _position(
    chosen: dict[SeriesKind, Series], depth: Readings | None, crs: str | None, said: list[str]
) -> tuple[Readings | None, float]:
    """Give north, east, down [m], and the angle from true north to theirs [rad]."""
    if "position" in chosen:
        one = chosen["position"]
        said.append(f"position from {one.name} (north, east, down)")
        return Readings(one.times, one.values[:, :3]), 0.0
    if "geodetic" not in chosen:
        return None, 0.0
    one = chosen["geodetic"]
    grid = project_places(one.values[:, 0], one.values[:, 1], crs)
    down = -one.values[:, 2]
    if depth is not None:
        down = np.interp(one.times, depth.times, depth.values[:, 0])
    said.append(
        f"position from {one.name} in {grid.name}, north, east, down; its north is "
        f"{np.degrees(grid.convergence):+.3f}° from true north (taken off the heading), a metre on "
        f"the ground is {grid.scale:.6f} m in it"
    )
    return Readings(one.times, np.stack([grid.north, grid.east, down], axis=1)), grid.convergence


def _velocity(chosen: dict[SeriesKind, Series], said: list[str]) -> Readings | None:
    one = chosen.get("twist")
    if one is None:
        return None
    is_csv = one.topic.encoding == "csv"
    axes = "forward, starboard, down" if is_csv else "forward, left, up"
    said.append(f"velocity from {one.name} (vehicle axes {axes})")
    turn = np.eye(3) if is_csv else _FLU_FROM_FRD
    return Readings(one.times, one.values[:, :3] @ turn)


def _poses(chosen: dict[SeriesKind, Series], said: list[str]) -> Trajectory | None:
    one = chosen.get("pose")
    if one is None:
        return None
    said.append(f"poses from {one.name}, as they stand there")
    quaternions = one.values[:, 3:7]
    return Trajectory(
        one.times,
        one.values[:, :3],
        quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True),
    )


def _join(position: Readings, attitude: Readings, gap: float) -> Trajectory | None:
    """Join positions and attitudes at the times of either; nothing is made up in their holes."""
    times = np.union1d(position.times, attitude.times)
    low = max(position.times[0], attitude.times[0])
    high = min(position.times[-1], attitude.times[-1])
    times = times[(times >= low) & (times <= high)]
    for one in (position, attitude):
        times = times[~_is_in_hole(times, one.times, gap)]
    if len(times) < 2:
        return None
    places = [np.interp(times, position.times, column) for column in position.values.T]
    turns = Rotation.from_euler("ZYX", attitude.values[:, ::-1])
    quaternions = Slerp(attitude.times, turns)(times).as_quat(scalar_first=True)
    return Trajectory(times, np.stack(places, axis=1), quaternions)


def _is_in_hole(times: Scalars, known: Scalars, gap: float) -> Mask:
    """Tell which times lie strictly between two readings that are too far apart."""
    longest = max(gap, _HOLES * float(np.median(np.diff(known))))
    after = np.clip(np.searchsorted(known, times), 1, len(known) - 1)
    begin, end = known[after - 1], known[after]
    inside: Mask = (end - begin > longest) & (times > begin) & (times < end)
    return inside
