"""What navigation messages say, as numbers."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from jaxtyping import Float

from ...types.arrays import Scalars
from .messages import Topic, look_up, read_stamp

SeriesKind = Literal[
    "attitude",
    "position",
    "geodetic",
    "pressure",
    "depth",
    "height",
    "pose",
    "twist",
    "orientation",
]
Reading = tuple[str, tuple[float, ...], float]
"""A name for the series, its values, and the time by the autopilot's own clock [s] or NaN."""
_NAN = float("nan")
WORDS: dict[SeriesKind, str] = {
    "attitude": "roll, pitch, heading, turn rates",
    "position": "position north, east, down",
    "geodetic": "latitude, longitude, height",
    "pressure": "depth, by pressure",
    "depth": "depth",
    "height": "depth, by the autopilot",
    "pose": "poses",
    "twist": "velocity",
    "orientation": "attitude and turn rates",
}
"""What each kind is of use for."""


@dataclass(frozen=True, eq=False)
class Series:
    """What one topic measured."""

    name: str
    kind: SeriesKind
    times: Scalars
    """When [s since 1970], steps of the clock taken out; increasing."""
    values: Float[np.ndarray, "n k"]
    topic: Topic


def _numbers(value: Any, *names: str) -> tuple[float, ...]:
    return tuple(float(found) if (found := look_up(value, n)) is not None else _NAN for n in names)


def _xyz(value: Any, path: str) -> tuple[float, ...]:
    return _numbers(look_up(value, path), "x", "y", "z")


def _wxyz(value: Any, path: str) -> tuple[float, ...]:
    return _numbers(look_up(value, path), "w", "x", "y", "z")


def _attitude(m: Any) -> tuple[float, ...]:
    return _numbers(m, "roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed")


def _local(m: Any) -> tuple[float, ...]:
    return _numbers(m, "x", "y", "z", "vx", "vy", "vz")


def _global(m: Any) -> tuple[float, ...]:
    latitude, longitude, height = _numbers(m, "lat", "lon", "alt")
    return latitude * 1e-7, longitude * 1e-7, height * 1e-3


def _pressure(m: Any) -> tuple[float, ...]:
    return (_numbers(m, "press_abs")[0] * 100,)


_MAVLINK: dict[str, tuple[SeriesKind, Callable[[Any], tuple[float, ...]]]] = {
    "ATTITUDE": ("attitude", _attitude),
    "LOCAL_POSITION_NED": ("position", _local),
    "GLOBAL_POSITION_INT": ("geodetic", _global),
    # SCALED_PRESSURE is the one inside the hull on a vehicle of ArduSub.
    "SCALED_PRESSURE2": ("pressure", _pressure),
    "VFR_HUD": ("height", lambda m: _numbers(m, "alt")),
}
_ROS: dict[str, tuple[SeriesKind, Callable[[Any], tuple[float, ...]]]] = {
    "Odometry": (
        "pose",
        lambda m: _xyz(m, "pose.pose.position") + _wxyz(m, "pose.pose.orientation"),
    ),
    "PoseStamped": ("pose", lambda m: _xyz(m, "pose.position") + _wxyz(m, "pose.orientation")),
    "PoseWithCovarianceStamped": (
        "pose",
        lambda m: _xyz(m, "pose.pose.position") + _wxyz(m, "pose.pose.orientation"),
    ),
    "PoseInFrame": ("pose", lambda m: _xyz(m, "pose.position") + _wxyz(m, "pose.orientation")),
    "TwistStamped": ("twist", lambda m: _xyz(m, "twist.linear") + _xyz(m, "twist.angular")),
    "Imu": ("orientation", lambda m: _wxyz(m, "orientation") + _xyz(m, "angular_velocity")),
    "FluidPressure": ("pressure", lambda m: _numbers(m, "fluid_pressure")),
    "NavSatFix": ("geodetic", lambda m: _numbers(m, "latitude", "longitude", "altitude")),
    "LocationFix": ("geodetic", lambda m: _numbers(m, "latitude", "longitude", "altitude")),
}


def series_kind(topic: Topic) -> SeriesKind | None:
    """Tell what a topic's messages measure; None where nothing that is used here."""
    if topic.kind in ("TFMessage", "tfMessage"):
        return "pose"
    last = topic.name.rsplit("/", 1)[-1]
    found = _MAVLINK.get(last) or _ROS.get(topic.kind)
    return None if found is None else found[0]


def read_series(topic: Topic, value: Any) -> tuple[Sequence[Reading], int | None]:
    """Read a decoded message: its readings, and its own time [ns] where it has one."""
    if topic.kind in ("TFMessage", "tfMessage"):
        return _read_transforms(topic, value)
    last = topic.name.rsplit("/", 1)[-1]
    if last in _MAVLINK:
        inner = look_up(value, "message") or value
        boot = look_up(inner, "time_boot_ms")
        own = _NAN if boot is None else float(boot) / 1e3
        return [(topic.name, _MAVLINK[last][1](inner), own)], None
    stamp = read_stamp(look_up(value, "header.stamp") or look_up(value, "timestamp"))
    return [(topic.name, _ROS[topic.kind][1](value), _NAN)], stamp


def _read_transforms(topic: Topic, value: Any) -> tuple[Sequence[Reading], int | None]:
    readings, stamp = list[Reading](), None
    for one in look_up(value, "transforms") or ():
        parent, child = look_up(one, "header.frame_id"), look_up(one, "child_frame_id")
        pose = _xyz(one, "transform.translation") + _wxyz(one, "transform.rotation")
        readings.append((f"{topic.name} {parent} > {child}", pose, _NAN))
        stamp = read_stamp(look_up(one, "header.stamp"))
    return readings, stamp
