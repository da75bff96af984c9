"""Marine snow: bright where the sheet cuts it, and gone soon after."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Int, UInt64
from scipy.special import ndtri, pdtr

from ..errors import InputError
from ..types.arrays import Indices, Points, Scalars

_CELL = 0.02
"""Edge of the cubes in which particles are strewn [m]."""
_MOST = 100
"""Particles that a cube may hold."""
_THICKEST = 1000.0
"""Particles that a frame may show: with more, cubes would overflow."""
_STEP = np.uint64(0x9E3779B97F4A7C15)
"""The golden ratio, by which neighbouring numbers are driven apart."""
_SIDE = 2**20
"""Cubes along each axis that can be told apart: 20 km of water."""
_HALF = _SIDE // 2

Cells = Int[np.ndarray, "cells 3"]


@dataclass(frozen=True, eq=False)
class Particles:
    """Snow that drifts with the water; it has no end and no memory.

    Space is divided into cubes, and what each holds follows from its number and the seed alone. So
    a particle stays the same from frame to frame, wherever a recording starts.
    """

    per_frame: float = 0.0
    """How many the sheet cuts before the object, on average, in a frame in the middle."""
    diameter: float = 4e-4
    """Median diameter [m]; a third of them are smaller or larger by half as much again."""
    albedo: float = 0.4
    """Share of light that they throw back."""
    drift: tuple[float, float, float] = (0.003, 0.005, 0.0)
    """How the water carries them, in the world frame [m/s]."""

    def __post_init__(self) -> None:
        """Refuse snow that cannot be."""
        if not 0 <= self.per_frame <= _THICKEST:
            raise InputError(
                f"water.particles_per_frame must lie between 0 and {_THICKEST:g}, got "
                f"{self.per_frame:g}."
            )
        if not (0 < self.diameter < 0.1 and 0 <= self.albedo <= 1):
            raise InputError(
                f"Particles need a diameter above 0 and below 100 mm and an albedo from 0 to 1, "
                f"got {self.diameter * 1e3:g} mm and {self.albedo:g}."
            )


@dataclass(frozen=True, eq=False)
class Snow:
    """Some particles; one a row."""

    points: Points
    """Where they are, in the world frame [m]."""
    diameters: Scalars
    """How large they are [m]."""


def strew(particles: Particles, density: float, near: Points, *, time: float, seed: int) -> Snow:
    """Give the particles in the cubes around some points.

    Args:
        particles: What they are like.
        density: How many there are [1/m³].
        near: Points of the world frame around which they are wanted [m], less than a cube apart.
        time: When [s].
        seed: Which snow it is.
    """
    moved = np.array(particles.drift) * time
    cells = _cells_around(near - moved)
    states = _hash(cells, seed)
    table = _poisson_table(density * _CELL**3)
    count = np.searchsorted(table, _draw(states, 0), side="right")
    which = np.repeat(np.arange(len(cells)), count)
    number = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    drawn = [_draw(states[which], 1 + 4 * number + k) for k in range(4)]
    points = (cells[which] + np.stack(drawn[:3], axis=1)) * _CELL + moved
    return Snow(points, particles.diameter * np.exp(0.4 * _as_normal(drawn[3])))


def _cells_around(points: Points) -> Cells:
    """Number the cubes that hold the points, and those beside them."""
    cells = _distinct(np.floor(points / _CELL).astype(np.int64))
    beside = np.concatenate([np.zeros((1, 3), np.int64), np.eye(3, dtype=np.int64)])
    beside = np.concatenate([beside, -beside[1:]])
    return _distinct((cells[:, None] + beside).reshape(-1, 3))


def _distinct(cells: Int[np.ndarray, "n 3"]) -> Cells:
    """Keep one of each; three numbers are sorted as one, which is many times as fast."""
    packed = (cells + _HALF) @ np.array([_SIDE * _SIDE, _SIDE, 1])
    packed = np.unique(packed)
    return np.stack([packed // _SIDE**2, packed // _SIDE % _SIDE, packed % _SIDE], axis=1) - _HALF


def _hash(cells: Cells, seed: int) -> UInt64[np.ndarray, " cells"]:
    """Give a number that follows from a cube's place and the seed."""
    state = np.full(len(cells), seed % 2**63, np.uint64)
    for column in cells.T:
        state = _mix(state + column.astype(np.uint64) + _STEP)
    return state


def _draw(states: UInt64[np.ndarray, " n"], number: Indices | int) -> Scalars:
    """Give numbers from 0 to 1, each of which follows from a state and its number there.

    References:
        Steele, Lea and Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
    """
    steps = (np.asarray(number) + 1).astype(np.uint64) * _STEP
    return (_mix(states + steps) >> np.uint64(11)).astype(float) * 2.0**-53


def _mix(value: np.ndarray) -> np.ndarray:
    value = (value ^ (value >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    value = (value ^ (value >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return value ^ (value >> np.uint64(31))


def _poisson_table(mean: float) -> Scalars:
    """Give the chance of at most 0, 1, 2 … particles, as many as a cube may hold."""
    return pdtr(np.arange(_MOST), mean)


def _as_normal(chance: Scalars) -> Scalars:
    return ndtri(np.clip(chance, 1e-12, 1 - 1e-12))
