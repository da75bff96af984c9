"""What a vehicle's instruments measured on its way, and how well: a log that is not the truth."""

from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from jaxtyping import Float

from ..errors import InputError
from .arrays import Scalars, Vector
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Readings(ShortRepr):
    """What one instrument measured, each time at its own time."""

    times: Scalars
    """When, by the log's clock [s], in increasing order."""
    values: Float[np.ndarray, "n k"]
    """What, one reading a row."""

    def __post_init__(self) -> None:
        """Refuse readings without a time each, and clocks that run backwards."""
        if len(self.times) != len(self.values):
            raise InputError(f"{len(self.times)} times stand beside {len(self.values)} readings.")
        if not (np.all(np.diff(self.times) >= 0) and np.isfinite(self.values).all()):
            raise InputError("Readings need times that do not run backwards, and finite values.")

    def __len__(self) -> int:
        """Count the readings."""
        return len(self.times)


@dataclass(frozen=True)
class NavigationAccuracy:
    """How good a vehicle's instruments are, one standard deviation; None: not stated, not used.

    A bias keeps its value over a dive; noise differs from reading to reading.
    """

    velocity_noise: float | None = None
    """Of each component of each velocity [m/s]."""
    velocity_bias: float = 0.0
    """Of each component, along the vehicle's axes [m/s]."""
    speed: float | None = None
    """Of a speed that is only about known, as a share of it: of its mean over a dive."""
    attitude_noise: float | None = None
    """Of each roll and pitch [rad]."""
    attitude_bias: float = 0.0
    """Of roll and of pitch [rad]."""
    heading_noise: float | None = None
    """Of each heading [rad]; as the attitude's where it is not stated."""
    heading_drift: float = 0.0
    """How fast the heading drifts [rad/s]."""
    rate_noise: float | None = None
    """Of each turn rate [rad/s]."""
    rate_bias: float = 0.0
    """Of each turn rate [rad/s]."""
    depth_noise: float | None = None
    """Of each depth [m]."""
    position_noise: float | None = None
    """Of each coordinate of each position [m]."""
    clock_offset: float = 0.0
    """Of the log's clock against the recording's [s]."""
    clock_drift: float = 0.0
    """How fast the two clocks drift apart, as a ratio."""

    def __post_init__(self) -> None:
        """Refuse standard deviations that cannot be."""
        for one in fields(self):
            value = getattr(self, one.name)
            if value is not None and not 0 <= value < np.inf:
                raise InputError(f"navigation: {one.name} must be 0 or more, got {value:g}.")
            if value == 0 and one.name.endswith(("noise", "speed")):
                raise InputError(
                    f"navigation: {one.name} must be above 0: no instrument is exact. Leave it out "
                    "where it is not known."
                )


@dataclass(frozen=True, eq=False, repr=False)
class Navigation(ShortRepr):
    """Measurements of a vehicle's way, with their accuracy. What is None was not measured.

    The world is north, east, down; the vehicle's axes are forward, starboard, down.
    """

    accuracy: NavigationAccuracy
    attitude: Readings | None = None
    """Roll, pitch, heading [rad]: world_from_vehicle turns by heading about down, then by pitch
    about starboard, then by roll about forward."""
    rates: Readings | None = None
    """Turn rates about the vehicle's axes [rad/s]."""
    velocity: Readings | None = None
    """Velocity of the vehicle along its own axes [m/s]."""
    depth: Readings | None = None
    """Depth of the vehicle's origin, the world's third coordinate [m]; one column."""
    position: Readings | None = None
    """Position of the vehicle's origin [m]: north, east, down."""
    speed: float | None = None
    """Speed that is about known [m/s]; negative for backwards."""
    course: tuple[float, float, float] = (1.0, 0.0, 0.0)
    """Unit direction of that speed along the vehicle's own axes."""
    instruments: int = field(default=0)
    """Number of the set of instruments: passes of the same dive share their biases."""

    def moved(self, *, seconds: float, shift: Vector) -> "Navigation":
        """Count times and places from elsewhere.

        Args:
            seconds: What is added to all times [s].
            shift: What is added to all places, to depths its third coordinate [m].
        """
        values = {"position": shift, "depth": shift[2:]}
        moved: dict[str, Any] = {
            name: Readings(one.times + seconds, one.values + values.get(name, 0.0))
            for name in ("attitude", "rates", "velocity", "depth", "position")
            if (one := getattr(self, name)) is not None
        }
        return replace(self, **moved)
