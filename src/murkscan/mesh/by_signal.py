"""Colour by signal: how bright the stripe was, which shows paint, growth and writing."""

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.spatial import KDTree

from ..types.arrays import Colours
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .paint import AbstractPaint, map_colours


@final
@dataclass(frozen=True)
class BySignal(AbstractPaint):
    """Cividis, bright where the stripe was bright."""

    def paint(self, mesh: Mesh, cloud: PointCloud) -> Colours:
        """Give each vertex the colour of the signal of the point nearest to it."""
        nearest = np.asarray(KDTree(cloud.points).query(mesh.vertices)[1])
        return map_colours(cloud.signal[nearest].astype(float), "cividis")
