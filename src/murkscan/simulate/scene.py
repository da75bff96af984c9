"""What is recorded, by which rig, along which way, in which light."""

from dataclasses import dataclass, field

from ..errors import InputError
from ..types.arrays import Scalars
from ..types.rig import Rig
from ..types.trajectory import Trajectory
from .base import AbstractSurface


@dataclass(frozen=True)
class Light:
    """How bright and how wide the stripe is, and what else the sensor adds."""

    brightness: float = 215.0
    """Peak of the stripe where the laser meets the surface at a right angle [grey levels]."""
    width: float = 2.0
    """Standard deviation of the stripe across itself [px]."""
    ambient: float = 6.0
    """Grey level where there is no stripe."""
    noise: float = 0.0
    """Standard deviation of one pixel's white noise [grey levels]."""

    def __post_init__(self) -> None:
        """Refuse a stripe without width and negative light."""
        if self.width <= 0 or min(self.brightness, self.ambient, self.noise) < 0:
            raise InputError(
                f"A stripe needs a width above 0 and light not below 0, got a width of "
                f"{self.width:g} px, brightness {self.brightness:g}, ambient {self.ambient:g} and "
                f"noise {self.noise:g} grey levels."
            )


@dataclass(frozen=True, eq=False)
class Scene:
    """All that a simulated recording depends on; the same scene gives the same bytes."""

    surface: AbstractSurface
    """The object, in the world frame."""
    rig: Rig
    """The camera and its lasers."""
    trajectory: Trajectory
    """world_from_camera."""
    times: Scalars
    """When each frame is exposed [s], within the trajectory."""
    light: Light = field(default_factory=Light)
    seed: int = 0
    """Where the noise starts."""
