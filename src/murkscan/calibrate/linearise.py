"""Residuals of an adjustment and their derivatives by the rig's parameters and the boards' poses.

Residuals are in pixels: two a corner, one a stripe point. What each depends on is known: a corner
on its own board, a stripe point on its board's plane, so that derivatives by the poses follow from
those by a point, whatever the number of boards. Derivatives by the rig's few parameters are central
differences of the very functions that measure later, so that no port or sheet needs its own.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ..optics import perturb_rig
from ..types.arrays import Indices, Scalars
from ..types.rig import Rig
from ..types.rig_covariance import unit_of
from .observed import Boards, Observed, distances_along_rays, index_of, pixels_by_points

_STEPS = {"px": 1e-2, "m": 1e-5, "rad": 1e-5, "": 1e-5}
"""Change of a parameter over which its derivative is taken; errors go with its square."""


Rows = Float[np.ndarray, "..."]
"""One number a residual."""


@dataclass(frozen=True, eq=False)
class State:
    """Where an adjustment is: a rig that differs from the first one, and where the boards are."""

    start: Rig
    names: tuple[str, ...]
    changes: Scalars
    """What has been added to each of the names."""
    boards: Boards

    @property
    def rig(self) -> Rig:
        """The rig as it is now."""
        return perturb_rig(self.start, self.names, self.changes)

    def move(self, changes: Scalars, steps: Float[np.ndarray, "p 6"]) -> "State":
        """Change the parameters, and move the boards."""
        return State(self.start, self.names, self.changes + changes, self.boards.move(steps))

    def rebase(self, names: Sequence[str]) -> "State":
        """Count changes from the rig as it is now, of perhaps other parameters."""
        return State(self.rig, tuple(names), np.zeros(len(names)), self.boards)


@dataclass(frozen=True, eq=False)
class Linearised:
    """Residuals [px], corners first, then stripe points, and what they change with."""

    residuals: Rows
    by_rig: Float[np.ndarray, "r k"]
    by_pose: Float[np.ndarray, "r 6"]
    """By the turn [rad] and the shift [m] of the row's own board."""
    photo: Indices
    """Number of each row's photo."""
    num_corner_rows: int
    """Rows of corners: two each."""


def residuals_of(state: State, observed: Observed, scale: Scalars) -> Rows:
    """Give all residuals [px]; `scale` [m/px] makes pixels of stripe points' distances."""
    rig = state.rig
    corners = observed.corner_residuals(
        rig.camera, observed.place_corners(state.boards), index_of(rig)
    )
    distances = observed.stripe_distances(rig, state.boards, observed.stripe)
    return np.concatenate([corners.ravel(), distances / scale])


def linearise(state: State, observed: Observed, scale: Scalars) -> Linearised:
    """Give the residuals and their derivatives."""
    by_rig = np.zeros((2 * len(observed.corners) + len(observed.stripe), len(state.names)))
    nobody = np.zeros((len(state.boards.translations), 6))
    for column, name in enumerate(state.names):
        step = np.zeros(len(state.names))
        step[column] = _STEPS[unit_of(name)]
        ahead = residuals_of(state.move(step, nobody), observed, scale)
        behind = residuals_of(state.move(-step, nobody), observed, scale)
        by_rig[:, column] = (ahead - behind) / (2 * step[column])
    by_pose = np.concatenate(
        [_corners_by_pose(state, observed), _stripes_by_pose(state, observed) / scale[:, None]]
    )
    return Linearised(
        residuals_of(state, observed, scale),
        by_rig,
        by_pose,
        np.concatenate([np.repeat(observed.corner_photo, 2), observed.stripe_photo]),
        2 * len(observed.corners),
    )


def _corners_by_pose(state: State, observed: Observed) -> Float[np.ndarray, "_ 6"]:
    rig, boards = state.rig, state.boards
    points = observed.place_corners(boards)
    slopes = pixels_by_points(rig.camera, points, index_of(rig)).reshape(-1, 3)
    arms = np.repeat(points - boards.centres[observed.corner_photo], 2, axis=0)
    # Moving a point by ω × arm + τ changes u by slope · (ω × arm + τ).
    return np.concatenate([np.cross(arms, slopes), slopes], axis=1)


def _stripes_by_pose(state: State, observed: Observed) -> Float[np.ndarray, "_ 6"]:
    """Differentiate the distances from the sheet [m]; only the board's plane matters to them."""
    rig, boards = state.rig, state.boards
    points, directions = observed.place_stripes(rig, boards, observed.stripe)
    normals = boards.rotations[observed.stripe_photo, :, 2]
    along = distances_along_rays(observed, rig, points, directions)
    along = along / np.sum(normals * directions, axis=1)
    slopes = along[:, None] * normals
    arms = points - boards.centres[observed.stripe_photo]
    return np.concatenate([np.cross(arms, slopes), slopes], axis=1)
