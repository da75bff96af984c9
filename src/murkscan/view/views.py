"""From where a picture is taken."""

from dataclasses import dataclass, field

import numpy as np

from ..types.arrays import Matrix3, Vector
from ..types.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class View:
    """A direction to look in, without perspective."""

    name: str
    """What the picture is called."""
    view_from_world: Matrix3
    """Its rows point, in the world frame, right and down in the picture, and away from the
    viewer."""
    eye: Vector = field(default_factory=lambda: np.zeros(3))
    """Where the camera was on average, in the world frame [m]: depth counts from there."""

    @property
    def start(self) -> float:
        """How far the eye lies ahead of the world's origin [m]."""
        return float(self.view_from_world[2] @ self.eye)


_DIRECTIONS: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "isometric": ((-1, 1, 1), (0, -1, 0)),
    "front": ((0, 0, 1), (0, -1, 0)),
    "back": ((0, 0, -1), (0, -1, 0)),
    "left": ((1, 0, 0), (0, -1, 0)),
    "right": ((-1, 0, 0), (0, -1, 0)),
    "top": ((0, 1, 0), (0, 0, 1)),
    "bottom": ((0, -1, 0), (0, 0, -1)),
}
"""Name: where the viewer looks, and what is up for him, in the camera's x right, y down, z forward.
The isometric one stands to the right of the camera and above it."""


def standard_views(trajectory: Trajectory | None = None) -> tuple[View, ...]:
    """Give the isometric view and the six standard ones: front, back, left, right, top, bottom.

    Front is as the camera sees it, x right and y down; left is seen from the left of that, top from
    above, as on an engineer's drawing.

    Args:
        trajectory: How the camera went through the world; its mean attitude is the front. None: the
            world has the camera's axes.
    """
    world_from_front, eye = np.eye(3), np.zeros(3)
    if trajectory is not None:
        eye = trajectory.positions.mean(axis=0)
        attitudes = trajectory.attitudes
        world_from_front = attitudes.mean().as_matrix()
    return tuple(
        View(name, _look(np.array(forward, float), np.array(up, float)) @ world_from_front.T, eye)
        for name, (forward, up) in _DIRECTIONS.items()
    )


def front_view(trajectory: Trajectory | None = None) -> View:
    """Give the view from the front, as the camera sees it; see `standard_views`."""
    return next(view for view in standard_views(trajectory) if view.name == "front")


def _look(forward: np.ndarray, up: np.ndarray) -> Matrix3:
    right = np.cross(forward, up)
    rows = np.stack([right, np.cross(forward, right), forward])
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)
