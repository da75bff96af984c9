"""Give a surface colours that say something."""

import abc
from typing import ClassVar, Literal

import numpy as np
from jaxtyping import Float32

from ..types.arrays import Colours, Scalars
from ..types.mesh import Mesh

Signal = Float32[np.ndarray, " points"]
"""Of each point of a cloud [grey levels]."""

_SHARE = 0.5
"""Percent of the vertices at each end of the values that may lie beyond the colours."""


class AbstractPaint(abc.ABC):
    """A way to colour a surface. Subclasses are final: wrap one, do not subclass it."""

    column: ClassVar[Literal["signal", "reflectance"]] = "signal"
    """The column of the cloud that it looks at."""

    @abc.abstractmethod
    def paint(self, mesh: Mesh, signal: Signal) -> Colours:
        """Compute a colour for each vertex.

        Args:
            mesh: The surface, with one vertex or more.
            signal: The column's value for each point of the cloud it was made of [grey levels].

        Raises:
            InputError: It does not say which points its vertices are.
        """


def map_colours(values: Scalars, colour_map: str) -> Colours:
    """Give values their colours, from end to end but for the last half percent.

    Args:
        values: One a vertex, in any unit.
        colour_map: Its name in matplotlib.
    """
    import matplotlib as mpl

    low, high = np.percentile(values, [_SHARE, 100 - _SHARE])
    share = (values - low) / (high - low) if high > low else np.full(len(values), 0.5)
    return mpl.colormaps[colour_map](share, bytes=True)[:, :3]
