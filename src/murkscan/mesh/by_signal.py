"""Colour by how bright the stripe was, as it was seen or as the paint alone makes it."""

from dataclasses import dataclass
from typing import final

from ..errors import InputError
from ..types.arrays import Colours
from ..types.mesh import Mesh
from .paint import AbstractPaint, Signal, map_colours


@final
@dataclass(frozen=True)
class BySignal(AbstractPaint):
    """Cividis, bright where the stripe was bright."""

    def paint(self, mesh: Mesh, signal: Signal) -> Colours:
        """Give each vertex the colour of its point's signal; see `AbstractPaint.paint`."""
        return _map_brightness(mesh, signal)


@final
@dataclass(frozen=True)
class ByReflectance(AbstractPaint):
    """Cividis, bright where the paint is bright: without distance, water and slope.

    What is not known is as dark as the darkest.
    """

    column = "reflectance"

    def paint(self, mesh: Mesh, signal: Signal) -> Colours:
        """Give each vertex the colour of its point's reflectance; see `AbstractPaint.paint`."""
        return _map_brightness(mesh, signal)


def _map_brightness(mesh: Mesh, values: Signal) -> Colours:
    if mesh.points is None:
        raise InputError(
            "The surface does not say which points its vertices are, as one from another program "
            "does not; make it from the cloud again."
        )
    return map_colours(values[mesh.points].astype(float), "cividis")
