"""Which number of the long vector of unknowns is what."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from jaxtyping import Float
from scipy import sparse

from ...types.arrays import Indices, Scalars
from .path import WIDTH, Path, Poses

SHARED = (
    *("velocity_bias_x", "velocity_bias_y", "velocity_bias_z"),
    "speed_factor",
    *("roll_bias", "pitch_bias"),
    *("rate_bias_x", "rate_bias_y", "rate_bias_z"),
    *("clock_offset", "clock_drift"),
)
"""Errors that passes of one set of instruments share."""
OWN = ("heading_offset", "heading_drift")
"""Errors of one pass."""


@dataclass(frozen=True)
class Layout:
    """Where each unknown stands: all paths, then the errors of instruments, then those of passes.

    ::

        [ path 0 | path 1 | … | SHARED of instruments 0 | … | OWN of pass 0 | OWN of pass 1 | … ]
    """

    sizes: tuple[int, ...]
    """Unknowns of each path."""
    instruments: tuple[int, ...]
    """Which set of instruments each pass has, from 0."""

    @classmethod
    def of(cls, paths: Sequence[Path], instruments: Sequence[int]) -> "Layout":
        """Lay out the unknowns of some passes and their sets of instruments."""
        order = {name: i for i, name in enumerate(dict.fromkeys(instruments))}
        return cls(tuple(p.num_unknowns for p in paths), tuple(order[i] for i in instruments))

    @property
    def starts(self) -> tuple[int, ...]:
        """Give where each path begins."""
        return (0, *accumulate(self.sizes))[:-1]

    @property
    def num_of_paths(self) -> int:
        """Count the unknowns of all paths."""
        return sum(self.sizes)

    @property
    def count(self) -> int:
        """Count all unknowns."""
        shared = len(SHARED) * (max(self.instruments) + 1)
        return self.num_of_paths + shared + len(OWN) * len(self.sizes)

    def of_path(self, number: int, errors: Float[np.ndarray, "u m"]) -> Float[np.ndarray, "k 6 m"]:
        """Pick what some errors of all unknowns are of a pass's control values."""
        start, size = self.starts[number], self.sizes[number]
        return errors[start : start + size].reshape(-1, WIDTH, errors.shape[1])

    def shared(self, number: int, name: str) -> int:
        """Give where an error of a pass's instruments stands."""
        return self.num_of_paths + len(SHARED) * self.instruments[number] + SHARED.index(name)

    def name(self, place: int) -> str:
        """Give the name of an unknown that is no path's."""
        last = place - self.count + len(OWN) * len(self.sizes)
        if last >= 0:
            return OWN[last % len(OWN)]
        return SHARED[(place - self.num_of_paths) % len(SHARED)]

    def own(self, number: int, name: str) -> int:
        """Give where an error of one pass stands."""
        own = len(OWN) * (len(self.sizes) - number)
        return self.count - own + OWN.index(name)


@dataclass(frozen=True, eq=False)
class Equations:
    """Linear equations, each divided by its standard deviation: jacobian · step ≈ -residuals."""

    residuals: Scalars
    jacobian: sparse.csr_matrix

    @classmethod
    def stack(cls, parts: Sequence["Equations"]) -> "Equations":
        """Put equations below one another."""
        return cls(
            np.concatenate([p.residuals for p in parts]),
            sparse.vstack([p.jacobian for p in parts], format="csr"),
        )


def equations_of_path(
    residuals: Float[np.ndarray, "n m"],
    slopes: Float[np.ndarray, "n 4 m 6"],
    first: Indices,
    start: int,
    width: int,
    *,
    errors: Sequence[tuple[int, Float[np.ndarray, "n m"]]] = (),
    sigma: float | Scalars = 1.0,
) -> Equations:
    """Make equations of m readings at each of n times.

    Args:
        residuals: Predicted minus measured.
        slopes: How each prediction changes with the four control values that count.
        first: Number of the first of them.
        start: Where the path's unknowns begin.
        width: Count of all unknowns.
        errors: Other unknowns, and how each residual changes with them.
        sigma: Standard deviation of the readings.
    """
    count, size = residuals.shape
    near = start + WIDTH * first[:, None] + np.arange(4 * WIDTH)
    columns = np.empty((count, size, 4 * WIDTH + len(errors)), np.int32)
    values = np.empty(columns.shape)
    columns[..., : 4 * WIDTH] = near[:, None]
    values[..., : 4 * WIDTH] = slopes.transpose(0, 2, 1, 3).reshape(count, size, -1)
    for k, (place, change) in enumerate(errors):
        columns[..., 4 * WIDTH + k], values[..., 4 * WIDTH + k] = place, change
    scale = 1 / np.broadcast_to(np.asarray(sigma, float).reshape(-1, 1), residuals.shape)
    values *= scale[..., None]
    ends = columns.shape[2] * np.arange(count * size + 1, dtype=np.int32)
    entries = (values.ravel(), columns.ravel(), ends)
    jacobian = sparse.csr_matrix(entries, shape=(count * size, width))
    return Equations((residuals * scale).ravel(), jacobian)


def slopes_of_turn(
    poses: Poses, change: Float[np.ndarray, "n m 3"]
) -> Float[np.ndarray, "n 4 m 6"]:
    """Give slopes of what changes only as the vehicle turns about the world's axes."""
    by_turn = change @ poses.turned_by
    slopes = np.zeros((len(change), 4, change.shape[1], WIDTH))
    slopes[..., 3:] = poses.weights[:, :, None, None] * by_turn[:, None]
    return slopes
