"""Colour by signed values, such as how far a scan lies from its reference."""

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from scipy.spatial import KDTree

from ..types.arrays import Mask, Points, Scalars
from .base import AbstractColours, Colours, Legend, look_up_colours
from .model import usual_spacing

_COLOUR_MAP = "RdBu_r"
_UNKNOWN = 0.62
"""Grey of places without a value."""
_SHARE = 1.0
"""Percent of the values, by size, that may lie beyond the colours."""
_REACH = 10.0
"""Usual distances between neighbours beyond which a value says nothing of a place."""
_LEAST = 0.05
"""Half the range of the colours [mm] below which rounding would be shown."""


@final
@dataclass(frozen=True, eq=False)
class SignedValues(AbstractColours):
    """Red where values are above 0, blue below, white at 0, grey where there is none."""

    at: Points
    """Where the values stand, in the world [m]."""
    values: Scalars
    """The values [m]; NaN where there is none."""
    label: str = "deviation\n[mm]"
    """What stands beside the colours; they are in millimetres."""
    limit: float | None = None
    """Value of the strongest colour [m]; None: told from the values."""

    def legend(self, surface: Points) -> Legend | None:
        """Give a range [mm] that is the same to both sides of 0."""
        known = np.abs(self.values[np.isfinite(self.values)])
        if len(known) == 0:
            return None
        limit = np.percentile(known, 100 - _SHARE) if self.limit is None else self.limit
        half = max(float(limit) * 1e3, _LEAST)
        return Legend(self.label, -half, half, _COLOUR_MAP)

    def paint(self, points: Points, outside: Mask, legend: Legend | None) -> Colours:
        """Give each point the colour of the nearest value, unless that is far away."""
        if legend is None:
            return np.full((len(points), 3), _UNKNOWN)
        most = _REACH * usual_spacing(self.at)
        _, nearest = self._tree.query(points, distance_upper_bound=most)
        values = np.append(self.values, np.nan)[nearest] * 1e3
        colours = look_up_colours(values, legend)
        return np.where(np.isfinite(values)[:, None], colours, np.float32(_UNKNOWN))

    @cached_property
    def _tree(self) -> KDTree:
        return KDTree(self.at)
