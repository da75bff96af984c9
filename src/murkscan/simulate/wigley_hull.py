"""The hull of a ship model, seen from below."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..errors import InputError
from ..types.arrays import Mask, Scalars, Vector
from .base import AbstractSurface

_PAINTED = 0.97
"""Share of the half-breadth that is painted; above it, near the waterline, the side is dark."""
_TALLEST = 0.039
"""Height that keel, bilge keels and bulb of the demo's hull do not exceed together [m]."""
_ROUNDING = 0.004
"""Radius to which the V of the bottom is rounded [m]."""


@final
@dataclass(frozen=True)
class WigleyHull(AbstractSurface):
    """Wigley's parabolic hull with its keel towards the camera, and what a ship has below water.

    Each cross-section is Wigley's parabola. The waterline is Wigley's parabola in the bow half
    (towards + y) and a fuller fourth-degree curve in the stern half, and the keel line rises at
    both ends. A bar keel, two bilge keels and a bulb at the bow are added, all without steps.

    References:
        Wigley, Calculated and measured wave resistance of a series of forms defined
        algebraically, Trans. Institution of Naval Architects 84, 1942.
    """

    length: float = 0.9
    """Along y [m]."""
    beam: float = 0.28
    """Largest breadth, along x [m]."""
    draft: float = 0.11
    """Height of the bottom above the waterline plane, towards the camera [m]."""
    waterline: float = 0.58
    """Depth z of the waterline plane [m]."""
    middle: float = 0.5
    """Where the middle of the length lies along y [m]."""

    def __post_init__(self) -> None:
        """Refuse a hull without size, or one that the camera would stand in."""
        if min(self.length, self.beam, self.draft) <= 0 or self.waterline <= 1.5 * self.draft:
            raise InputError(
                f"A hull needs a length, beam and draft above 0 and a waterline farther than 1.5 "
                f"drafts, got {self.length:g}, {self.beam:g}, {self.draft:g} and "
                f"{self.waterline:g} m."
            )

    def depth(self, x: Scalars, y: Scalars) -> Scalars:
        """Give the hull's z at x and y [m]."""
        along = (y - self.middle) / (self.length / 2)
        share = self._breadth_share(x, along)
        bottom = self.draft * _keel_line(along) * np.sqrt(np.maximum(1.0 - share, 0.01))
        return self.waterline - bottom - self._appendages(x, along)

    def covers(self, x: Scalars, y: Scalars) -> Mask:
        """Tell whether x and y [m] lie within the painted part."""
        along = (y - self.middle) / (self.length / 2)
        return (np.abs(along) < 1.0) & (self._breadth_share(x, along) < _PAINTED)

    def box(self) -> tuple[Vector, Vector]:
        """Give a box from the waterline plane to nearer than the keel [m]."""
        half_beam, half_length = self.beam / 2, self.length / 2
        nearest = self.waterline - self.draft - _TALLEST * self._unit()
        return (
            np.array([-half_beam, self.middle - half_length, nearest]),
            np.array([half_beam, self.middle + half_length, self.waterline]),
        )

    def _unit(self) -> float:
        """Size of the appendages as a multiple of the demo's."""
        return self.beam / 0.28

    def _breadth_share(self, x: Scalars, along: Scalars) -> Scalars:
        """Distance from the centreline as a share of the half-breadth at that station."""
        fullness = 1.0 - np.where(along > 0, 1.0, along * along) * along * along
        half_breadth = np.maximum(self.beam / 2 * fullness, 1e-3)
        return (np.hypot(x, _ROUNDING) - _ROUNDING) / half_breadth

    def _appendages(self, x: Scalars, along: Scalars) -> Scalars:
        """Height of keel, bilge keels and bulb above the bare bottom [m]."""
        unit = self._unit()
        keel = 0.010 * _ridge(x, 0.0045 * unit) * _ridge(along + 0.05, 0.72)
        bilge = 0.007 * _ridge(np.abs(x) - 0.27 * self.beam, 0.0045 * unit) * _ridge(along, 0.38)
        bulb = 0.022 * np.exp(-((x / (0.020 * unit)) ** 2) - ((along - 0.80) / 0.11) ** 2)
        return unit * (keel + bilge + bulb)


def _keel_line(along: Scalars) -> Scalars:
    """Depth of the keel line as a share of the draft: it rises at the stem and at the stern."""
    stem, stern = np.maximum(along - 0.45, 0) / 0.55, np.maximum(-along - 0.55, 0) / 0.45
    return 1.0 - 0.70 * stem**2 - 0.55 * stern**2


def _ridge(offset: Scalars, half_width: float) -> Scalars:
    """A flat-topped bump of height 1."""
    square = (offset / half_width) ** 2
    return np.exp(-square * square)  # numpy's own fourth power takes ten times as long
