"""Motions that a surface does not show, in words: a plane slides along itself."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..types.arrays import Vector

Motions = Float[np.ndarray, "6 open"]
"""Small rigid motions, one a column: a turn [rad] times a length [m], then a shift [m]."""
_IS_SHIFT = 0.2
"""Share of turning in a motion up to which it counts as a plain shift."""
_NEAR_AXIS = float(np.cos(np.radians(10)))
"""Cosine of the angle to an axis within which a direction has the axis's name."""


@dataclass(frozen=True, eq=False)
class OpenDirection:
    """A motion of the source that leaves its agreement with the target as it is."""

    is_turn: bool
    """Whether it turns; otherwise it slides."""
    axis: Vector
    """Direction of the shift, or of the axis of the turn; unit length, in the target's frame."""
    through: Vector
    """A point on the axis of the turn [m]; for a shift the middle of the overlap."""

    def __str__(self) -> str:
        """Say it: sliding along x; turning about (0.71, 0.71, 0.00)."""
        return f"{'turning about' if self.is_turn else 'sliding along'} {name_axis(self.axis)}"


def name_axis(axis: Vector) -> str:
    """Name a unit direction: an axis within 10 degrees of it, or its three components."""
    largest = int(np.argmax(np.abs(axis)))
    if abs(axis[largest]) >= _NEAR_AXIS:
        return "xyz"[largest]
    rounded = np.round(axis * np.sign(axis[largest]), 2) + 0.0  # no -0.00
    return "({:.2f}, {:.2f}, {:.2f})".format(*rounded)


def describe_motions(motions: Motions, *, centre: Vector, length: float) -> list[OpenDirection]:
    """Find the plainest words for a space of small motions.

    Args:
        motions: An orthonormal basis, in the target's frame about `centre`.
        centre: The point about which turns are counted [m].
        length: The length by which turns are multiplied [m].

    Returns:
        As many as the space has dimensions: first the shifts, those along axes before others; then
        the turns.
    """
    # Combinations that turn least come last: where they hardly turn at all, they are shifts.
    _, turning, mixes = np.linalg.svd(motions[:3], full_matrices=True)
    turning = np.append(turning, np.zeros(motions.shape[1] - len(turning)))
    mixed = motions @ mixes.T
    shifts, turns = mixed[:, turning <= _IS_SHIFT], mixed[:, turning > _IS_SHIFT]
    found = [OpenDirection(False, _unit(axis), centre) for axis in _along_axes(shifts[3:]).T]
    chosen = _along_axes(turns[:3] / np.linalg.norm(turns[:3], axis=0))
    weights, *_ = np.linalg.lstsq(turns[:3], chosen, rcond=None)
    for turn in (turns @ weights).T:
        spin = turn[:3] / length
        away = np.cross(spin, turn[3:]) / (spin @ spin)
        found.append(OpenDirection(True, _unit(spin), centre + away))
    return found


def _along_axes(basis: Float[np.ndarray, "3 k"]) -> Float[np.ndarray, "3 k"]:
    """Turn a basis of directions within its space until it follows the axes as far as it can."""
    left, found = np.linalg.qr(basis)[0], []
    while left.shape[1]:
        nearest = int(np.argmax(np.linalg.norm(left, axis=1)))
        chosen = _unit(left @ left[nearest])
        found.append(chosen)
        rest, kept, _ = np.linalg.svd(left - np.outer(chosen, chosen @ left), full_matrices=False)
        left = rest[:, kept > 0.5][:, : left.shape[1] - 1]
    return np.stack(found, axis=1) if found else basis[:, :0]


def _unit(vector: Vector) -> Vector:
    return vector / np.linalg.norm(vector)
