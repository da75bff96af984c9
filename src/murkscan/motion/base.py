"""What every motion can do."""

import abc
from typing import ClassVar, Literal

import numpy as np

from ..errors import InputError
from ..types.arrays import Points, Scalars
from ..types.measured import Measured
from ..types.trajectory import Trajectory

_SLOWEST, _FASTEST = 1e-9, 1e3
"""Sizes of a speed [m/s] or a step [m] that a scan can have."""
Direction = Literal["x", "y", "z"]
"""A camera axis to move along."""


class AbstractMotion(abc.ABC):
    """A way to know how the camera moved. Subclasses are final: wrap one, do not subclass it."""

    needs_times: ClassVar[bool]
    """Whether the recording must have times of its own."""
    carries_mount: ClassVar[bool] = False
    """Whether its poses come through the rig's mount, and so share the mount's errors."""

    @property
    def start(self) -> float:
        """What the log's clock shows when recording time is 0 [s]; 0 where there is no log."""
        return 0.0

    @property
    @abc.abstractmethod
    def accuracy(self) -> str:
        """How well the poses are known, in words; empty where nothing is stated.

        Then `Trajectory.errors` is None, and the motion's error is in no interval.
        """

    @abc.abstractmethod
    def follow(self, times: Scalars, pictures: Scalars) -> Trajectory:
        """Give world_from_camera at the time of each frame.

        Args:
            times: Recording times of the frames [s], strictly increasing, at least one.
            pictures: Number of the recorded picture of each frame; its second field is at half.

        Returns:
            The poses at just these times, but for frames of which the motion says nothing.

        Raises:
            InputError: The settings say nothing about more than half of the times.
        """

    def measure(self) -> Measured | None:
        """Give the measurements behind the poses, which a scan may correct.

        None where nothing is stated of how good they are: then the poses count as they are.
        """
        return None

    def remarks(self, times: Scalars) -> tuple[str, ...]:
        """Tell what was odd, such as frames that have no pose, in sentences.

        Args:
            times: As for `follow`.
        """
        del times
        return ()


def follow_line(
    times: Scalars, distances: Scalars, along: Direction, *, sigma: float
) -> Trajectory:
    """Move without turning: from the camera's first place by distances [m] along one axis.

    Args:
        times: When [s].
        distances: How far [m].
        along: The axis.
        sigma: Standard deviation of the distances' common factor, as a share.
    """
    positions: Points = np.zeros((len(times), 3))
    positions[:, "xyz".index(along)] = distances
    upright = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
    stretched = np.concatenate([sigma * positions, np.zeros_like(positions)], axis=1)[:, :, None]
    return Trajectory(times, positions, upright, stretched)


def check_pace(pace: float, sigma: float, flag: str) -> None:
    """Refuse a speed or a step that moves nothing, and a standard deviation that cannot be."""
    if not 0 <= sigma < 1:
        raise InputError(
            f"{flag} must be known to a standard deviation from 0 to below 100 % of it, got "
            f"{sigma:.0%}."
        )
    if not _SLOWEST <= abs(pace) <= _FASTEST:
        raise InputError(
            f"{flag} must be a number other than 0 and between a nanometre and a kilometre, got "
            f"{pace:g} m: a scan needs motion; a negative number moves the other way."
        )
