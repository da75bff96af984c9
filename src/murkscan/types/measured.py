"""How the way of a scan is known: by which measurements, and where its camera sits."""

from dataclasses import dataclass, field

import numpy as np

from .arrays import Vector
from .navigation import Navigation
from .pose import Pose
from .short_repr import ShortRepr


@dataclass(frozen=True, eq=False, repr=False)
class Measured(ShortRepr):
    """A vehicle's instruments, by the recording's clock, and where its camera sits."""

    navigation: Navigation
    vehicle_from_camera: Pose
    is_placed: bool
    """Whether the world is the log's own; otherwise it is the camera's first frame."""
    origin: Vector = field(default_factory=lambda: np.zeros(3))
    """Where in the log's world the measured places count from [m]: near the scan, since a spline
    about coordinates of maps would lose digits."""
