"""Make a surface of a cloud.

Every mesher is a frozen dataclass: its fields are its settings, `mesh` is its one verb. What is
done to a surface afterwards, on request, are functions and paints.
"""

from .base import AbstractMesher as AbstractMesher
from .base import join_tiles as join_tiles
from .by_depth import ByDepth as ByDepth
from .by_signal import ByReflectance as ByReflectance
from .by_signal import BySignal as BySignal
from .decimate import decimate as decimate
from .grid_mesh import GridMesh as GridMesh
from .holes import ClosedHoles as ClosedHoles
from .holes import close_holes as close_holes
from .one_sheet import join_sheets as join_sheets
from .one_sheet import split_by_laser as split_by_laser
from .paint import AbstractPaint as AbstractPaint
from .poisson import Poisson as Poisson
