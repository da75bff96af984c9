"""Colour by depth: how far from the camera."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..types.arrays import Mask, Points, Scalars
from .base import AbstractColours, Colours, Legend, look_up_colours

_COLOUR_MAP = "viridis_r"
_SHARE = 0.5
"""Percent of the points at each end of the depths that may lie beyond the colours."""


@final
@dataclass(frozen=True)
class Depth(AbstractColours):
    """Viridis, bright where it is near: equal steps of depth look equal.

    References:
        Nuñez, Anderton, Renslow, Optimizing colormaps with consideration for color vision
        deficiency, PLoS ONE 13(7), 2018.
    """

    forward: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """The direction in which depth is counted, in the world frame."""
    start: float = 0.0
    """Where along it depth is 0 [m]; the world's origin is at 0."""

    def legend(self, surface: Points) -> Legend | None:
        """Give the range of depths [mm], without the last half percent at either end."""
        if len(surface) == 0:
            return None
        low, high = np.percentile(self._depths(surface), [_SHARE, 100 - _SHARE])
        # A level surface has no range: a tenth of a millimetre keeps its rounding out of sight.
        middle, half = (low + high) / 2, max((high - low) / 2, 0.05)
        ends = float(middle - half), float(middle + half)
        return Legend("depth [mm]", *ends, _COLOUR_MAP, top="low")

    def paint(self, points: Points, outside: Mask, legend: Legend | None) -> Colours:
        """Give each depth its colour; both sides of the surface look alike."""
        if legend is None:
            return np.zeros((len(points), 3))
        return look_up_colours(self._depths(points), legend)

    def _depths(self, points: Points) -> Scalars:
        """Count them [mm]."""
        return 1e3 * (points @ np.array(self.forward) - self.start)
