"""One colour: the light alone shows the shape."""

from dataclasses import dataclass
from typing import final

import numpy as np

from ..types.arrays import Mask, Points
from .base import AbstractColours, Colours, Legend

_OUTSIDE = (0.89, 0.87, 0.83)
_INSIDE = (0.62, 0.71, 0.83)


@final
@dataclass(frozen=True)
class Plain(AbstractColours):
    """Clay for the side that the camera saw, slate blue for its back."""

    def legend(self, surface: Points) -> Legend | None:
        """Say nothing: these colours have no scale."""
        return None

    def paint(self, points: Points, outside: Mask, legend: Legend | None) -> Colours:
        """Tell the two sides apart."""
        return np.array([_INSIDE, _OUTSIDE], np.float32)[outside.astype(np.intp)]
