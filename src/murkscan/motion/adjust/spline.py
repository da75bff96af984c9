"""Uniform cubic B-splines in time: few numbers for a whole smooth way.

Over the interval i from `start + i·step` on, the control values i to i + 3 count::

    value(t) = Σ w_j(s)·c[i + j],   s = (t - start)/step - i,   j = 0 … 3
"""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from ...types.arrays import Indices, Scalars

Weights = Float[np.ndarray, "n 4"]
Matrices = Float[np.ndarray, "n 3 3"]

_BASIS = np.array([[1, 4, 1, 0], [-3, 0, 3, 0], [3, -6, 3, 0], [-1, 3, -3, 1]]) / 6
"""Row p: what s^p adds to each of the four weights.

de Boor, A Practical Guide to Splines, 1978, chapter IX.
"""
_CUMULATIVE = np.array([_BASIS[:, j:].sum(axis=1) for j in range(4)]).T
_DERIVATIVE_STEP = 1e-4
"""Step of the central difference of a reference attitude, in knots."""


@dataclass(frozen=True)
class Knots:
    """Where a spline's pieces join."""

    start: float
    """Where the first piece begins [s]."""
    step: float
    """Length of a piece [s]."""
    num_pieces: int
    margin: float = 0.0
    """How long before what is asked for the first piece begins [s]."""

    @classmethod
    def over(cls, first: float, last: float, step: float, margin: float = 0.0) -> "Knots":
        """Lay knots over an interval of time and a margin on both sides [s], ends included."""
        whole = last - first + 2 * margin
        return cls(first - margin, step, max(math.ceil(whole / step + 1e-9), 1), margin)

    @property
    def first(self) -> float:
        """When what is asked for begins [s]."""
        return self.start + self.margin

    @property
    def num_controls(self) -> int:
        """Count the control values."""
        return self.num_pieces + 3

    @property
    def end(self) -> float:
        """Where the last piece ends [s]."""
        return self.start + self.step * self.num_pieces

    @property
    def quadrature_times(self) -> Scalars:
        """Give two times of each piece [s] at which mean squares of accelerations are exact.

        Middles alone would not see controls that alternate: neither does a log that is read at the
        knots, and such a path would be held by nothing.

        References:
            Gauss's rule of two points; an acceleration is linear over a piece.
        """
        along = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3)
        return self.start + self.step * (np.arange(self.num_pieces)[:, None] + along).ravel()

    @property
    def control_times(self) -> Scalars:
        """Give the time about which each control value counts most [s]."""
        return self.start + self.step * (np.arange(self.num_controls) - 1.0)

    def locate(self, times: Scalars) -> tuple[Indices, Scalars]:
        """Give the piece in which each time lies, and where in it, from 0 to 1."""
        along = (times - self.start) / self.step
        piece = np.clip(np.floor(along).astype(np.int64), 0, self.num_pieces - 1)
        return piece, along - piece

    def weights(self, times: Scalars, *, derivative: int = 0) -> tuple[Indices, Weights]:
        """Give the first control value that counts at each time, and the weights of the four.

        Args:
            times: When [s].
            derivative: How often the spline is differentiated by time, 0 to 2.
        """
        piece, along = self.locate(times)
        return piece, _powers(along, derivative) @ _BASIS / self.step**derivative


def _powers(along: Scalars, derivative: int) -> Weights:
    """Give 1, s, s², s³, or their derivatives."""
    powers = np.zeros((len(along), 4))
    for p in range(derivative, 4):
        factor = math.factorial(p) / math.factorial(p - derivative)
        powers[:, p] = factor * along ** (p - derivative)
    return powers


def evaluate(
    knots: Knots, controls: Float[np.ndarray, "k d"], times: Scalars, *, derivative: int = 0
) -> Float[np.ndarray, "n d"]:
    """Give a spline's value, or its derivative, at each time."""
    first, weights = knots.weights(times, derivative=derivative)
    return np.einsum("nj,njd->nd", weights, controls[first[:, None] + np.arange(4)])


def evaluate_rotation(knots: Knots, controls: Rotation, times: Scalars) -> Rotation:
    """Give a smooth rotation at each time; its turn rate and turn acceleration have no steps.

    References:
        Kim, Kim and Shin, A general construction scheme for unit quaternion curves, SIGGRAPH 1995,
        equation (4), the cumulative form of a B-spline.
    """
    piece, along = knots.locate(times)
    shares = _powers(along, 0) @ _CUMULATIVE
    turns = (controls[:-1].inv() * controls[1:]).as_rotvec()
    value = controls[piece]
    for j in range(1, 4):
        value = value * Rotation.from_rotvec(shares[:, j : j + 1] * turns[piece + j - 1])
    return value


def rotation_rate(knots: Knots, controls: Rotation, times: Scalars) -> Float[np.ndarray, "n 3"]:
    """Give the turn rate of `evaluate_rotation` along the axes that it turns into [rad/s]."""
    half = _DERIVATIVE_STEP * knots.step
    ahead = evaluate_rotation(knots, controls, times + half)
    behind = evaluate_rotation(knots, controls, times - half)
    return (ahead * behind.inv()).as_rotvec() / (2 * half)
