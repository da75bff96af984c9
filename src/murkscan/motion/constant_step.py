"""A stage or a crawler that moves by the same step from picture to picture."""

from dataclasses import dataclass
from typing import ClassVar, final

from ..types.arrays import Scalars
from ..types.trajectory import Trajectory
from .base import AbstractMotion, Direction, check_pace, follow_line


@final
@dataclass(frozen=True)
class ConstantStep(AbstractMotion):
    """The camera moves by one step a recorded picture along one of its axes."""

    step: float
    """Step [m] a picture, half of it a field; negative for the other way, not zero."""
    along: Direction
    """Camera axis along which it moves."""

    sigma: float = 0.01
    """Standard deviation of the step, as a share of it; unless said, that of a crawler whose wheels
    slip, or of a stage that nobody has calibrated."""

    needs_times: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Refuse a step that moves nothing."""
        check_pace(self.step, self.sigma, "The step")

    @property
    def accuracy(self) -> str:
        """See `AbstractMotion.accuracy`."""
        return f"the step is known to {self.sigma:.2%} (1σ)"

    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory:
        """Give world_from_camera at the time of each frame; see `AbstractMotion.follow`."""
        return follow_line(
            times, self.step * (pictures - pictures[0]), self.along, sigma=self.sigma
        )
