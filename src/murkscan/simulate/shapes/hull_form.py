"""The lines of the ship model: where its bare hull lies."""

from dataclasses import dataclass

import numpy as np

from ...types.arrays import Directions, Points, Scalars

_STEP = 1e-5
"""Half the base of a difference quotient; shares of the length and of the draft."""


@dataclass(frozen=True)
class HullForm:
    """Wigley's hull, its waterline fuller in the stern half and its keel line rising at the ends.

    A point is given by its station, from - 1 at the stern to 1 at the bow (+ y), and its depth
    share, from 0 at the waterline (z = 0) to 1 at the keel (towards the camera, - z). This is the
    starboard side, x > 0.

    References:
        Wigley, Calculated and measured wave resistance of a series of forms defined
        algebraically, Trans. Institution of Naval Architects 84, 1942.
    """

    length: float
    """Along y [m]."""
    beam: float
    """Largest breadth, along x [m]."""
    draft: float
    """From the waterline to the keel amidships [m]."""

    @property
    def unit(self) -> float:
        """Size of the appendages, as a multiple of a model's that is 0.28 m broad."""
        return min(self.beam / 0.28, self.draft / 0.11, self.length / 0.9)

    def half_breadth(self, station: Scalars) -> Scalars:
        """Give half the breadth of the waterline [m]."""
        square = station * station
        return self.beam / 2 * (1.0 - np.where(station > 0, 1.0, square) * square)

    def keel_depth(self, station: Scalars) -> Scalars:
        """Give how far the keel line lies below the waterline [m]."""
        stem = np.maximum(station - 0.45, 0) / 0.55
        stern = np.maximum(-station - 0.55, 0) / 0.45
        return self.draft * (1.0 - 0.70 * stem**2 - 0.40 * stern**2)

    def points(self, station: Scalars, share: Scalars) -> Points:
        """Give points of the starboard side [m]."""
        x = self.half_breadth(station) * (1.0 - share * share)
        return np.stack([x, station * (self.length / 2), -self.keel_depth(station) * share], axis=1)

    def normals(self, station: Scalars, share: Scalars) -> Directions:
        """Give the unit normals of the starboard side, outwards."""
        along = self.points(station + _STEP, share) - self.points(station - _STEP, share)
        down = self.points(station, share + _STEP) - self.points(station, share - _STEP)
        normals = np.cross(down, along)
        return normals / np.linalg.norm(normals, axis=1, keepdims=True)
