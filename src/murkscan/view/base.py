"""What every colouring can do."""

import abc
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from ..types.arrays import Mask, Points, Scalars

Colours = Float[np.ndarray, "n 3"]
"""Red, green and blue from 0 to 1, one a row."""
_STEPS = 256
"""Colours of a map."""


@dataclass(frozen=True)
class Legend:
    """What the colours mean."""

    label: str
    """The quantity and its unit."""
    low: float
    """Value at the colour map's start, in that unit."""
    high: float
    """Value at the colour map's end, in that unit."""
    colour_map: str
    """Its name in matplotlib."""
    top: Literal["low", "high"] = "high"
    """Which value stands on top of the colour bar: the low one for depths, which go down."""


class AbstractColours(abc.ABC):
    """A way to colour a surface. Subclasses are final: wrap one, do not subclass it."""

    @abc.abstractmethod
    def legend(self, surface: Points) -> Legend | None:
        """Say what the colours of a surface with these points mean; None if nothing.

        Args:
            surface: All points of the surface, in the world frame [m].
        """

    @abc.abstractmethod
    def paint(self, points: Points, outside: Mask, legend: Legend | None) -> Colours:
        """Colour points on the surface.

        Args:
            points: The points, in the world frame [m].
            outside: Whether the viewer looks at the side that the camera saw.
            legend: What `legend` gave for the whole surface.
        """


def look_up_colours(values: Scalars, legend: Legend) -> Colours:
    """Give values, in the legend's unit, the colours that the legend shows for them.

    Args:
        values: Beyond the legend's ends they get its last colour; NaN gets that of the low end.
        legend: Their range and colour map.
    """
    from matplotlib import colormaps

    table = colormaps[legend.colour_map](np.arange(_STEPS))[:, :3].astype(np.float32)
    share = (values - legend.low) / (legend.high - legend.low)
    return table[np.clip(np.nan_to_num(share) * _STEPS, 0, _STEPS - 1).astype(np.intp)]
