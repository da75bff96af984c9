"""How far a piece of surface may lie from where two paths put it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ...types.arrays import Vector
from .path import Path

_SIGMAS = 3.0
"""Standard deviations of its place over which a tile is looked for."""


@dataclass(frozen=True, eq=False)
class Doubt:
    """Errors that two paths may have, drawn: they say how far a tile may lie from its place."""

    one: Path
    other: Path
    one_errors: Float[np.ndarray, "k 6 m"]
    other_errors: Float[np.ndarray, "j 6 m"]
    most: float
    """Farthest that is looked [m]."""

    def reach(
        self,
        place: Vector,
        time: float,
        other_time: float,
        axes: Float[np.ndarray, "2 3"],
        least: float,
    ) -> Float[np.ndarray, "2"]:
        """Give how far to look along two axes [m]."""
        moved = _moves(self.one, self.one_errors, time, place)
        moved -= _moves(self.other, self.other_errors, other_time, place)
        spread = np.sqrt(np.mean((axes @ moved) ** 2, axis=1))
        return np.clip(_SIGMAS * spread, least, self.most)


def _moves(
    path: Path, errors: Float[np.ndarray, "k 6 m"], time: float, place: Vector
) -> Float[np.ndarray, "3 m"]:
    """Give how errors of a path move a point of the world that was seen at a time."""
    poses = path.at(np.array([time]))
    change = np.einsum("j,jdm->dm", poses.weights[0], errors[poses.first[0] + np.arange(4)])
    turn = poses.turned_by[0] @ change[3:]
    return change[:3] + np.cross(turn.T, place - poses.positions[0]).T
