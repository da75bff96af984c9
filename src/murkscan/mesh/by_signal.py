"""Colour by signal: how bright the stripe was, which shows paint, growth and writing."""

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
        if mesh.points is None:
            raise InputError(
                "The surface does not say which points its vertices are, as one from another "
                "program does not; make it from the cloud again."
            )
        return map_colours(signal[mesh.points].astype(float), "cividis")
