"""The paper's motion: a vehicle that keeps its speed and its attitude."""

from dataclasses import dataclass
from typing import ClassVar, final

from ..types.arrays import Scalars
from ..types.measured import Measured
from ..types.trajectory import Trajectory
from .base import AbstractMotion, Direction, check_pace, follow_line
from .measured import measure_speed


@final
@dataclass(frozen=True)
class ConstantSpeed(AbstractMotion):
    """The camera moves at one speed along one of its axes.

    References:
        The paper's section "Image capture".
    """

    speed: float
    """Speed [m/s]; negative for the other way, not zero."""
    along: Direction
    """Camera axis along which it moves."""

    sigma: float = 0.1
    """Standard deviation of the speed, as a share of it; unless said, that of a vehicle which a
    pilot holds at a speed by eye."""

    needs_times: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Refuse a speed that moves nothing."""
        check_pace(self.speed, self.sigma, "The speed")

    @property
    def accuracy(self) -> str:
        """See `AbstractMotion.accuracy`."""
        return f"the speed is known to {self.sigma:.2%} (1σ)"

    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory:
        """Give world_from_camera at the time of each frame; see `AbstractMotion.follow`."""
        return follow_line(times, self.speed * (times - times[0]), self.along, sigma=self.sigma)

    def measure(self) -> Measured | None:
        """Give the speed, as far as it is not exact; see `AbstractMotion.measure`."""
        return measure_speed(self.speed, self.sigma, "xyz".index(self.along))
