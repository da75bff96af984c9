"""How sure a way is in each direction, by its log alone and with what the scan has seen."""

from dataclasses import dataclass

import numpy as np

from ...types.arrays import Vector
from ...types.trajectory import Trajectory

_TOLD = 0.5
"""Share of the log's own standard deviation from which the log alone tells a direction."""

_INSIDE = 8
"""One part in so many of a way at either end is not looked at: only one of two sheets saw it."""


@dataclass(frozen=True)
class Sureness:
    """One thing that a way may have wrong."""

    name: str
    unit: str
    """m or rad."""
    logged: float
    """Its standard deviation by the log alone."""
    found: float
    """The same with what the scan has seen."""

    @property
    def is_open(self) -> bool:
        """Whether the log alone tells it, as before."""
        return self.found > _TOLD * self.logged


def judge_directions(logged: Trajectory, found: Trajectory, sight: Vector) -> list[Sureness]:
    """Compare the errors that two ways state, of which one is by the log alone.

    Args:
        logged: By the log alone; at the same times as the other.
        found: With what the scan has seen.
        sight: Unit direction in which the camera looked, in the world.
    """
    ways = [_errors_of(way, sight) for way in (logged, found)]
    return [
        Sureness(name, "rad" if name == "twist from end to end" else "m", *sizes)
        for name, sizes in ((name, [way[name] for way in ways]) for name in ways[0])
    ]


def _errors_of(way: Trajectory, sight: Vector) -> dict[str, float]:
    """Compute the deviations of a way's length, of its bends, and of its twist."""
    last = len(way.times) - 1
    ends = way.at(way.times[[last // _INSIDE, last // 2, last - last // _INSIDE]])
    assert ends.errors is not None
    shift, turn = ends.errors[:, :3], ends.errors[:, 3:]
    along = ends.positions[2] - ends.positions[0]
    along = along / max(float(np.linalg.norm(along)), 1e-12)
    up = sight - (sight @ along) * along
    up = up / max(float(np.linalg.norm(up)), 1e-12)
    bend = shift[1] - (shift[0] + shift[2]) / 2
    return {
        "length of the way": float(np.linalg.norm(along @ (shift[2] - shift[0]))),
        "bend towards the surface": float(np.linalg.norm(up @ bend)),
        "bend along the surface": float(np.linalg.norm(np.cross(up, along) @ bend)),
        "twist from end to end": float(np.linalg.norm(along @ (turn[2] - turn[0]))),
    }
